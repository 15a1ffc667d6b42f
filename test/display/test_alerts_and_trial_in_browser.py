"""Alerts, their history and a trial manoeuvre beside the picture, in a real browser."""

import asyncio
import math
import time

import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
from marine_tracker.display import browser

from .scene import DANGER, OWN, SEEN, TRACKED, on_scene, told_of

if not browser.program():
    pytest.skip('no Chromium: the page is not tried in a browser', allow_module_level=True)

TEXT = "document.getElementById('%s').textContent"
LISTED = (
    "[...document.querySelectorAll('#alarms li')].map(li => [li.children[1].textContent,"
    ' li.children[2].hidden, li.children[0].type, li.children[0].silenced])'
)


async def given(scene, count):
    while len(scene.commands) < count:
        await asyncio.sleep(0.05)
    return scene.commands[-1]


def test_alerts_are_listed_in_the_order_of_the_tracker_each_with_its_own_acknowledgement():
    async def act(scene):
        alerts = [
            ('danger', 'alarm', 'active silenced', DANGER, (0, 0)),
            ('danger', 'alarm', 'rectified unacknowledged', SEEN, (0, 0)),
            ('danger', 'alarm', 'active acknowledged', TRACKED, (0, 0)),
            ('heading missing', 'warning', 'active unacknowledged', 0, (0, 0)),
            ('swap risk', 'caution', 'active acknowledged', 0, (0, 0)),
        ]
        scene.server.publish('alarms', {'alarms': told_of(alerts)})
        await scene.page.until(LISTED + '.length == 5')
        listed = await scene.page.evaluate(LISTED)
        assert [one[0] for one in listed] == [
            f'silenced: danger {DANGER}',
            f'over: danger {SEEN}',
            f'acknowledged: danger {TRACKED}',
            'heading missing 0',
            'acknowledged: swap risk 0',
        ]
        assert [one[1] for one in listed] == [False, False, True, False, True]
        assert [one[2] for one in listed] == ['alarm'] * 3 + ['warning', 'caution']
        assert [one[3] for one in listed] == [True] + [False] * 4
        await scene.page.until('ppi.state.role.commands')
        await scene.page.until("!document.querySelectorAll('#alarms obc-button')[3].disabled")
        await scene.page.evaluate("document.querySelectorAll('#alarms obc-button')[3].click()")
        command = await given(scene, 1)
        assert (command.name, command.values) == ('acknowledge_alert', {'instance': 4})
        await scene.page.call('Input.dispatchKeyEvent', type='keyDown', key='s')
        assert (await given(scene, 2)).name == 'silence'
        assert await scene.page.evaluate('document.title') == '(3) alarms - PPI'

    on_scene(act, 'north-up')


def test_settled_alerts_are_listed_with_their_times_also_after_the_connection_was_lost():
    async def act(scene):
        times = {'raised': 1_700_000_050, 'acknowledged': 1_700_000_090, 'ended': 1_700_000_400}
        settled = [
            {'name': 'TT31: danger', 'text': 'TT31 dangerous', 'priority': 'alarm', **times},
            {'name': 'x', 'text': 'no log for 12 s', 'priority': 'warning', **times}
            | {'acknowledged': None},
        ]
        scene.server.publish('alarms_past', {'alarms': settled})
        await scene.page.until(TEXT % 'past-count' + "== '2'")
        expected = (
            '22:14:10 alarm: TT31 dangerous (ack 22:14:50, over 22:20:00)'
            '22:14:10 warning: no log for 12 s (never acknowledged, over 22:20:00)'
        )
        assert await scene.page.evaluate(TEXT % 'past') == expected
        await scene.page.evaluate('location.reload()')
        await scene.page.until('window.ppi?.state?.settled.length == 2')
        await scene.page.until(TEXT % 'past-count' + "== '2'")
        assert await scene.page.evaluate(TEXT % 'past') == expected
        await scene.page.until(LISTED + '.length == 4')

    on_scene(act, 'north-up')


def test_a_trial_shows_its_letter_its_countdown_and_every_target_while_real_data_go_on():
    async def act(scene):
        await scene.page.until('ppi.state.role.commands')
        trial = {'on': True, 'text': 'TRIAL', 'course_deg': 285.0, 'speed_kn': 9.5}
        trial |= {'countdown_min': 1.6, 'safe_deg': [[350, 80], [130, 260]]}
        trial['targets'] = [
            {'name': 'TT21', 'cpa_nm': 1.93, 'tcpa_min': 14.2, 'danger': False},
            {'name': 'TT22', 'cpa_nm': 0.21, 'tcpa_min': 7.4, 'danger': True},
            {'name': 'TT23', 'cpa_nm': 0.88, 'tcpa_min': -3.0, 'danger': False},
        ]
        x, y = scene.middle[0], scene.middle[1] + scene.radius - 34
        letter = [(x - 7, y - 12), (x + 7, y - 12), (x, y), (x, y + 10)]  # T
        assert not any(await scene.drawn('danger', *letter))
        scene.server.publish('trial', {'at': time.monotonic(), **trial})
        await scene.shows('danger', *letter, reach=4)
        # Own ship goes on, 2 m/s east and 1 m/s north, for 1.6 minutes; then on the new course.
        begin, turned = (2 * 96, 96), math.radians(285)
        for way in (150, 400, 700):
            there = begin[0] + way * math.sin(turned), begin[1] + way * math.cos(turned)
            assert any(await scene.drawn('safe', scene.place(*there), reach=4))
        assert not any(await scene.drawn('safe', scene.place(-580, 155), reach=4))
        await scene.page.until("!document.getElementById('trial-targets').hidden")
        rows = await scene.page.evaluate(
            "[...document.querySelectorAll('#trial-targets tbody tr')].map(row =>"
            ' [row.className, ...[...row.children].map(cell => cell.textContent)])'
        )
        now = ['0.00', '0.0']  # 1 m in 1 s, as the scene has it
        assert rows == [
            ['danger', 'TT22 !', *now, '0.21', '7.4'],
            ['', 'TT21', *now, '1.93', '14.2'],
            ['', 'TT23', *now, '0.88', '-3.0'],
        ]
        said = await scene.page.evaluate(TEXT % 'trial-says')
        assert said.startswith('TRIAL 285°, 9.5 kn, begins in 1:3')
        assert 'Safe courses: 350–80, 130–260' in said.replace('080', '80')
        # It counts down between two scans; targets go on moving meanwhile.
        await scene.page.until(TEXT % 'trial-says' + ".includes('begins in 1:33')")
        before = await scene.page.evaluate('ppi.state.scan.at')
        await scene.page.until(f'ppi.state.scan.at > {before}')
        trial |= {'countdown_min': None}
        scene.server.publish('trial', {'at': time.monotonic(), **trial})
        await scene.page.until(TEXT % 'trial-says' + ".includes('has begun')")
        await scene.page.evaluate("document.getElementById('trial-off').click()")
        assert (await given(scene, 1)).name == 'trial_off'
        scene.server.publish('trial', {'on': False})
        await scene.hides('danger', *letter)
        await scene.page.until("document.getElementById('trial-targets').hidden")

    on_scene(act, 'north-up', own={'wx': 2.0, 'wy': 1.0})
    assert OWN['wx'] == 0.0
