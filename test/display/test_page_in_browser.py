"""The page in a real browser, headless, over a real server."""

import asyncio
import math
import time
from concurrent.futures import Future

import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
from marine_tracker.display import browser
from marine_tracker.display.server import DisplayServer


@pytest.fixture(autouse=True)
def one_browser_for_all(chromium):
    """on_stage opens tabs of it."""
    on_stage.port = chromium


HEADING = math.radians(37)
OWN = {'x': 900.0, 'y': -400.0, 'vx': 3.0, 'vy': 4.0, 'heading': HEADING}
OWN |= {'latitude': 54.1, 'longitude': -10.9, 'time': 1000.0}
SHIPS = [  # number, id, x, y, status, alarm
    (4, 104, 3900.0, 2600.0, 1, 0),
    (9, 109, -1100.0, -2400.0, 1, 2),
    (12, 112, 700.0, 3600.0, 2, 0),
    (0, 113, -2100.0, 1600.0, 0, 0),
]
FIGURES = {
    'vx': -2.0,
    'vy': 1.0,
    'xx': 400.0,
    'xy': 100.0,
    'yy': 200.0,
    'range': 5000,
    'bearing': 1.1,
}
FIGURES |= {'course': 5.17, 'speed': 2.24, 'cpa': 700, 'tcpa': 610, 'danger_probability': 0.25}
UNKNOWN = ('bow_range', 'bow_time', 'length', 'length_sd', 'beam', 'heading', 'heading_sd')


def columns():
    names = ('number', 'id', 'x', 'y', 'status', 'alarm')
    rows = {name: [ship[k] for ship in SHIPS] for k, name in enumerate(names)}
    for name, value in FIGURES.items():
        rows[name] = [value] * len(SHIPS)
    for name in ('range', 'bearing', 'course', 'speed', 'cpa', 'tcpa', 'bow_range', 'bow_time'):
        rows[name + '_sd'] = [1] * len(SHIPS)
    for name in UNKNOWN:
        rows[name] = [None] * len(SHIPS)
    return rows | {'acquired': [0] * len(SHIPS), 'motion': [0] * len(SHIPS)}


class Stage:
    """A server that tells of a scene which stands still, as long as it is live."""

    def __init__(self):
        self.commands = []
        self.live = True
        self.serve('127.0.0.1:0', None)

    def serve(self, address, token):
        self.server = DisplayServer(address, self._run, token=token)

    def _run(self, command):
        self.commands.append(command)
        answer = Future()
        answer.set_result(f'{command.name} done')
        return answer

    async def play(self):
        while True:
            if self.live:
                at = time.monotonic()
                self.server.publish('own', OWN | {'at': at})
                self.server.publish(
                    'targets', {'at': at, 'time': 1000.0, 'period': 1.0, 'columns': columns()}
                )
                self.server.publish(
                    'plots', {'at': at, 'stamp': 999.0, 'x': [3905], 'y': [2590], 'amplitude': [20]}
                )
            await asyncio.sleep(0.3)

    def tell(self):
        self.server.publish(
            'alarms',
            {
                'alarms': [
                    {
                        'name': 'TT09: danger',
                        'text': 'TT09 dangerous: CPA 0.31 NM',
                        'kind': 'danger',
                        'priority': 'alarm',
                        'state': 'active unacknowledged',
                        'number': 9,
                        'in_state_s': 3,
                        'x': -1100,
                        'y': -2400,
                    }
                ]
            },
        )
        self.server.publish('limits', {'cpa_limit_nm': 0.7, 'tcpa_limit_min': 15.0})


def on_stage(act, query=''):
    """Runs act(page, stage) with the page open and live; the page must have no errors."""

    async def run():
        stage = Stage()
        stage.tell()
        address = stage.server.url.replace('/#', f'/{query}#')
        player = asyncio.ensure_future(stage.play())
        try:
            async with browser.open_tab(on_stage.port, address, 1100, 760) as page:
                await page.until('ppi.state.targets.length == 4 && ppi.state.role.commands')
                await page.until("document.getElementById('stale').hidden")
                await act(page, stage)
                assert page.errors == []
                here = f'//127.0.0.1:{stage.server.port}/'
                ours = 'http:' + here, 'ws:' + here
                assert [url for url in page.requests if not url.startswith(ours)] == []
        finally:
            player.cancel()
            stage.server.close()

    asyncio.run(run())


ON_SCREEN = """(() => { const t = ppi.state.targets.find(t => t.id == %d);
  const box = document.getElementById('picture').getBoundingClientRect();
  const [x, y] = ppi.toScreen(ppi.scopeNow().view, t.x, t.y); return [box.x + x, box.y + y]; })()"""


@pytest.mark.parametrize('orientation', ['north-up', 'head-up', 'course-up'])
def test_targets_show_where_they_are_and_a_click_selects_them(orientation):
    async def act(page, stage):
        box = await page.evaluate(
            '(({x, y, width, height}) => [x, y, width, height])'
            "(document.getElementById('picture').getBoundingClientRect())"
        )
        await page.evaluate(
            f"while (ppi.settings.orientation != '{orientation}')"
            " document.querySelector('[data-next=orientation]').click()"
        )
        up = 0 if orientation == 'north-up' else HEADING
        radius = min(box[2], box[3]) / 2 - 40
        for _, id, x, y, *_ in SHIPS:
            # By hand: the offset turned by what is up, 6 NM to the radius.
            right = (x - OWN['x']) * math.cos(up) - (y - OWN['y']) * math.sin(up)
            ahead = (x - OWN['x']) * math.sin(up) + (y - OWN['y']) * math.cos(up)
            scale = radius / (6 * 1852)
            place = (box[0] + box[2] / 2 + right * scale, box[1] + box[3] / 2 - ahead * scale)
            assert await page.evaluate(ON_SCREEN % id) == pytest.approx(place, abs=0.5)
            await page.click(*place)
            await page.until(f'ppi.marks.id == {id}')
        await page.click(box[0] + box[2] / 2, box[1] + 60)
        await page.until('ppi.marks.id === null')

    on_stage(act, '?range=6')


def test_symbols_are_drawn_in_their_colours_at_their_places():
    async def act(page, stage):
        # The colour of the target's circle, on its rim to the left of it, over one second.
        rim = """(() => { const pen = document.getElementById('picture').getContext('2d');
          const t = ppi.state.targets.find(t => t.id == %d);
          const [x, y] = ppi.toScreen(ppi.scopeNow().view, t.x, t.y);
          const {data} = pen.getImageData(x - 10, y - 1, 6, 3);
          let best = [0, 0, 0];
          for (let k = 0; k < data.length; k += 4)
            if (data[k] + data[k+1] + data[k+2] > best[0] + best[1] + best[2])
              best = [data[k], data[k+1], data[k+2]];
          return best; })()"""
        red, green, _ = await page.evaluate(rim % 104)
        assert green > 150 and green > red  # tracked
        seen = []
        for _ in range(25):
            seen.append((await page.evaluate(rim % 109))[0] > 150)
            await asyncio.sleep(0.1)
        assert True in seen and False in seen  # dangerous: flashes until acknowledged

    on_stage(act, '?range=6')


def test_data_alarms_and_commands():
    async def act(page, stage):
        text = "document.getElementById('%s').textContent"
        await page.until(text % 'alarms' + ".includes('TT09 dangerous')")
        await page.until(text % 'targets' + ".includes('TT12')")
        assert await page.evaluate('document.title') == '(1) alarm - PPI'
        first = await page.evaluate("document.querySelector('#targets tbody tr').textContent")
        assert first.startswith('TT09')  # dangerous ones stand first
        await page.click(*await page.evaluate(ON_SCREEN % 109))
        await page.until(text % 'selected-name' + ".startsWith('TT09')")
        data = await page.evaluate(text % 'selected')
        assert '2.70 NM' in data and '±' in data and '25 %' in data and 'NaN' not in data
        await page.evaluate("document.querySelector('#alarms obc-button').click()")
        await page.evaluate("document.getElementById('cancel').click()")
        for key in ('Escape', 'q', 'a'):
            await page.call('Input.dispatchKeyEvent', type='keyDown', key=key)
        await page.evaluate("document.querySelector('#trial .submit').click()")
        await page.evaluate("document.querySelector('#limits .submit').click()")
        await page.until(text % 'said' + ".includes('limits done')")
        names = [command.name for command in stage.commands]
        assert names == ['acknowledge', 'cancel', 'acquire', 'acknowledge_all', 'trial', 'limits']
        assert stage.commands[0].values == stage.commands[1].values == {'number': 9}
        acquire = stage.commands[2].values
        assert math.hypot(acquire['x'] + 1100, acquire['y'] + 2400) < 30  # where was clicked
        assert stage.commands[5].values == {'cpa_nm': 0.7, 'tcpa_min': 15.0}

    on_stage(act)


def test_dragging_own_ships_vector_tries_a_manoeuvre():
    async def act(page, stage):
        # Own ship: 5 m/s on 037, vectors of 6 min; the radius is 3 NM.
        box = await page.evaluate(
            '(({x, y, width, height}) => [x, y, width, height])'
            "(document.getElementById('picture').getBoundingClientRect())"
        )
        scale = (min(box[2], box[3]) / 2 - 40) / (3 * 1852)
        middle = (box[0] + box[2] / 2, box[1] + box[3] / 2)

        def place(course_deg, speed_mps):
            length, course = speed_mps * 360 * scale, math.radians(course_deg)
            x = middle[0] + length * math.sin(course)
            return {'x': x, 'y': middle[1] - length * math.cos(course)}

        async def mouse(kind, at):
            await page.call('Input.dispatchMouseEvent', type=kind, button='left', **at)

        await mouse('mousePressed', place(37, 5))
        for course in (60, 90, 121):
            await mouse('mouseMoved', place(course, 7))
        await mouse('mouseReleased', place(121, 7))
        while not stage.commands:
            await asyncio.sleep(0.05)
        (trial,) = stage.commands
        assert trial.name == 'trial' and trial.values['delay_min'] == 0
        assert trial.values['course_deg'] == pytest.approx(121, abs=1)
        assert trial.values['speed_kn'] == pytest.approx(7 * 3600 / 1852, abs=0.15)
        # What is not on the handle is a click, and no trial.
        await page.click(*place(250, 5).values())
        await page.until('ppi.marks.cursor')
        assert len(stage.commands) == 1

    on_stage(act, '?range=3')


@pytest.mark.parametrize('palette', ['day', 'dusk', 'night'])
def test_the_page_is_accessible(palette, web):
    axe = web / 'node_modules/axe-core/axe.min.js'

    async def act(page, stage):
        await page.evaluate(
            "for (const one of document.querySelectorAll('details')) one.open = true;"
            'ppi.marks.id = 104'
        )
        await page.until("document.getElementById('selected-name').textContent.startsWith('TT04')")
        await page.evaluate(axe.read_text() + '; 1')
        found = await page.evaluate(
            'axe.run().then(({violations}) => violations.map(one =>'
            ' [one.id, ...one.nodes.map(node => node.failureSummary)]))'
        )
        assert found == []

    on_stage(act, f'?palette={palette}')


def test_a_silent_server_gets_the_red_cross_until_it_speaks_again():
    async def act(page, stage):
        stage.live = False
        began = time.monotonic()
        await page.until("!document.getElementById('stale').hidden")
        assert time.monotonic() - began > 1.5
        assert 'No own ship' in await page.evaluate("document.getElementById('stale').textContent")
        stage.live = True
        await page.until("document.getElementById('stale').hidden")

    on_stage(act)


def test_the_page_finds_a_server_that_was_started_again():
    async def act(page, stage):
        address, token = f'127.0.0.1:{stage.server.port}', stage.server.token
        stage.live = False
        await asyncio.to_thread(stage.server.close)
        await page.until(
            "document.getElementById('stale').textContent.startsWith('No connection for')"
        )
        await asyncio.to_thread(stage.serve, address, token)
        stage.live = True
        await page.until("document.getElementById('stale').hidden && ppi.state.role.commands")
        # What the browser itself says of a server that is away.
        page.errors[:] = [error for error in page.errors if 'ERR_CONNECTION_REFUSED' not in error]

    on_stage(act)


def test_a_clock_that_is_off_is_told_and_changes_no_age():
    async def act(page, stage):
        await page.evaluate('(now => { Date.now = () => now() - 7200_000; })(Date.now)')
        await page.until("document.getElementById('role').textContent.includes('-7200 s off')")
        assert await page.evaluate("document.getElementById('stale').hidden")

    on_stage(act)


def test_alarms_sound_where_sound_is_on_until_silenced():
    async def act(page, stage):
        await page.until('ppi.sound.played > 0')
        await page.evaluate("document.getElementById('silence').click()")
        while not stage.commands:
            await asyncio.sleep(0.05)
        assert [command.name for command in stage.commands] == ['silence']  # for all viewers
        await page.evaluate('ppi.state.role.commands = false')
        await page.evaluate("document.getElementById('silence').click()")  # here alone
        assert await page.evaluate('ppi.sound.until > performance.now() / 1000 + 25')
        assert len(stage.commands) == 1

    on_stage(act, '?sound=on')


def test_night_has_no_bright_pixel():
    async def act(page, stage):
        brightest = """(() => { const c = document.getElementById('picture');
          const {data} = c.getContext('2d').getImageData(0, 0, c.width, c.height);
          let best = 0;
          for (let k = 0; k < data.length; k += 4)
            best = Math.max(best, 0.21 * data[k] + 0.72 * data[k+1] + 0.07 * data[k+2]);
          return best; })()"""
        assert 20 < await page.evaluate(brightest) < 128
        assert (
            await page.evaluate('getComputedStyle(document.body).backgroundColor') == 'rgb(0, 0, 0)'
        )

    on_stage(act, '?palette=night')
