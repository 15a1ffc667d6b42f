"""Ships of AIS on the page: seen, selected, read, filtered, set; in a real browser."""

import asyncio
import time

import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')

WORDS = {
    'statuses': ['under way using engine', 'at anchor', 'not under command'],
    'kinds': ['class A', 'class B', 'SAR aircraft', 'aid to navigation', 'AIS-SART'],
}
SETTINGS = {
    **{'ais_symbol': 'ais', 'ais_join': True, 'ais_kinds': 'a b aircraft aid sart'},
    **{'ais_range_nm': 37.5, 'ais_cpa_nm': 200.0, 'ais_activation': 'danger zones'},
    **{'ais_activation_range_nm': 2.5, 'ais_lost_alarm': True, 'ais_lost_range_nm': 7.0},
    'ais_sleeping_danger': True,
}
ONLY, JOINED, MISMATCH = 0, 2, 3
ACTIVATED, SLEEPING = 0, 1
ALONE, ASLEEP, TANKER, LIAR, LOST = 219018272, 244660123, 311000456, 636012345, 257801234
JOINED_TRACK = 502  # of the sea's ships


def ship(mmsi, east, north, **given):
    """From own ship's place, m."""
    told = {
        **{'id': mmsi % 1000, 'mmsi': mmsi, 'track': 0, 'kind': 0, 'state': ONLY, 'nav': 0},
        **{'shown': ACTIVATED, 'danger': 0, 'lost': 0, 'double': 0, 'accurate': 1, 'coarse': 0},
        **{'x': -730.0 + east, 'y': 2410.0 + north, 'vx': 3.0, 'vy': 4.0, 'heading': 0.61},
        **{'course': 0.6435, 'speed': 5.0, 'turn': None, 'length': 80, 'beam': 14, 'age': 6},
        **{'range': 4200, 'bearing': 1.2, 'cpa': 1300, 'tcpa': 500, 'cpa_sd': 60, 'tcpa_sd': 30},
        **{'probability': 0.0, 'danger_probability': 0.04, 'name': 'HANNE', 'call_sign': 'OWAB2'},
    }
    return told | given


FLEET = [
    ship(ALONE, 4100, 900),
    ship(ASLEEP, -3900, 2700, kind=1, shown=SLEEPING, name='', call_sign='', heading=None),
    ship(TANKER, 0, 0, state=JOINED, track=JOINED_TRACK, probability=0.972, name='BIG ONE'),
    ship(LIAR, -2500, -3000, state=MISMATCH, track=503, name='ELSEWHERE', nav=1),
    ship(LOST, 2100, -4100, lost=1, name='QUIET'),
]
ALARM = {
    **{'name': 'AIS 257801234: AIS lost', 'text': 'AIS 257801234 lost', 'kind': 'AIS lost'},
    **{'priority': 'warning', 'state': 'active unacknowledged', 'number': 0, 'mmsi': LOST},
    **{'in_state_s': 3, 'x': None, 'y': None, 'instance': 4, 'sounds': 1},
}
AT = """(() => {{ const {{view}} = ppi.scopeNow();
  const one = ppi.state.ships.find(ship => ship.mmsi === {0}) ?? ppi.state.targets.find(
    target => target.id === {0});
  const box = document.getElementById('picture').getBoundingClientRect();
  const [x, y] = ppi.toScreen(view, one.x, one.y); return [box.x + x, box.y + y]; }})()"""
TEXT = "document.getElementById('{}').textContent"


def tell(sea, fleet, **changed):
    columns = {name: [one[name] for one in fleet] for name in fleet[0]}
    sea.server.publish('ships', {'at': time.monotonic(), 'columns': columns, **WORDS})
    sea.server.publish('ais', SETTINGS | changed)


def test_ships_of_ais_are_selected_read_filtered_woken_and_set(visit):
    async def act(page, sea):
        async def read(part):
            await asyncio.sleep(0.22)  # the panel's own pace
            return await page.evaluate(TEXT.format(part))

        async def click_on(one):
            await page.click(*await page.evaluate(AT.format(one)))

        tell(sea, FLEET)
        sea.server.publish('alarms', {'alarms': [ALARM]})
        await page.until(f'ppi.state.ships.length == {len(FLEET)} && ppi.state.role.commands')

        # A ship that radar does not see: what she tells, how she passes.
        await click_on(ALONE)
        assert await read('selected-name') == 'AIS HANNE, activated'
        said = await read('selected-ship')
        for part in ('219018272', 'OWAB2', 'class A', 'under way', '036.9°, 9.7 kn', '80 × 14 m'):
            assert part in said, (part, said)
        assert 'not joined' in said and 'missing' in said and '58°18' in said
        assert '0.70 NM' in await read('selected') and '8.3 min' in await read('selected')

        # Asleep: no vector, little known; the operator wakes her.
        await click_on(ASLEEP)
        assert await read('selected-name') == 'AIS 244660123, sleeping'
        assert 'class B' in await read('selected-ship')
        await page.evaluate("document.getElementById('awake').click()")
        await page.until("document.getElementById('said').textContent == 'ais_awake done'")
        assert sea.commands.given[-1].values == {'mmsi': ASLEEP, 'awake': 1}

        # Joined: one symbol, the data of both; radar's first where it has priority.
        await click_on(JOINED_TRACK)
        assert 'TT03, tracking' in await read('selected-name')
        assert 'radar and AIS' in await read('selected-name')
        assert 'BIG ONE' in await read('selected-ship') and '97 %' in await read('selected-ship')
        assert 'P(danger)' in await read('selected')
        order = (
            "document.getElementById('selected-ship').getBoundingClientRect().top < "
            "document.getElementById('selected').getBoundingClientRect().top"
        )
        assert await page.evaluate(order)
        tell(sea, FLEET, ais_symbol='radar')
        await page.until("ppi.state.ais.ais_symbol == 'radar'")
        await asyncio.sleep(0.3)
        assert not await page.evaluate(order)
        assert 'joined shown as radar' in await read('ais-is')

        # A mismatch says so. What is selected stays so when it becomes a radar target.
        await click_on(LIAR)
        assert 'MISMATCH' in await read('selected-ship') and 'at anchor' in await read(
            'selected-ship'
        )
        found = [one | {'state': JOINED} if one['mmsi'] == LIAR else one for one in FLEET]
        tell(sea, found)
        await page.until(TEXT.format('selected-name') + ".startsWith('TT04')")
        tell(sea, FLEET)

        # Filters: on the page by key, in the tracker by its form.
        shown = "ppi.chosen() && document.getElementById('count').textContent"
        radar = len(sea.ships)
        await page.until(f"{shown} == '{radar + 3}'")  # activated ones are in the table
        await page.evaluate("document.querySelector('[data-next=ships]').click()")
        await page.evaluate('ppi.choose(null)')
        await click_on(ASLEEP)
        assert await read('selected-name') == 'No target selected'
        assert 'AIS activated' in await read('modes')
        await page.evaluate("document.querySelector('[data-next=ships]').click()")
        await click_on(ALONE)
        assert await read('selected-name') == 'No target selected'
        await click_on(LIAR)
        assert 'ELSEWHERE' in await read('selected-name')
        await page.evaluate("document.querySelector('[data-next=ships]').click()")
        await page.evaluate("document.getElementById('ais-box').open = true; document.body.focus()")
        await page.evaluate(
            "const form = document.getElementById('ais'); form.elements.range_nm.value = 12;"
            "form.elements.lost_alarm.checked = false; form.querySelector('[value=b]').click();"
            "form.querySelector('.submit').click()"
        )
        await page.until("document.getElementById('said').textContent == 'ais done'")
        assert sea.commands.given[-1].values == {
            **{'symbol': 'ais', 'kinds': 'a aircraft aid sart', 'activation': 'danger zones'},
            **{'range_nm': 12.0, 'cpa_nm': 200.0, 'activation_range_nm': 2.5},
            **{'lost_range_nm': 7.0, 'lost_alarm': 0, 'sleeping_danger': 1, 'join': 1},
        }

        # Lost: her last place until that is acknowledged.
        await click_on(LOST)
        assert await read('selected-name') == 'AIS QUIET, lost'
        sea.server.publish('alarms', {'alarms': [ALARM | {'state': 'active acknowledged'}]})
        await page.until('ppi.state.alarms[0].state.endsWith(" acknowledged")')
        await page.evaluate('ppi.choose(null)')
        await click_on(LOST)
        assert await read('selected-name') == 'No target selected'

    visit(act, '?range=6', ships=5, dangers=0)
