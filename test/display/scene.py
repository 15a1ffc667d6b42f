"""A scene that stands still, shown by a real page in a real browser; and what is drawn where."""

import asyncio
import atexit
import contextlib
import functools
import math
import time
from concurrent.futures import Future

from marine_tracker.display import browser
from marine_tracker.display.server import DisplayServer

HEADING = math.radians(52)
OWN = {'x': -3100.0, 'y': 1750.0, 'vx': 0.0, 'vy': 0.0, 'heading': HEADING, 'latitude': None}
OWN |= {'longitude': None, 'time': 500.0, 'wx': 0.0, 'wy': 0.0, 'stabilised': 'ground'}
OWN |= {'by': 'positions', 'reference': 30}
TRACKED, DANGER, SEEN, COASTS, CLICKED, CAUGHT, HULL, CHOSEN, REFERENCE = range(21, 30)
PLACES = {  # from own ship, m east and north
    TRACKED: (500, 700),
    DANGER: (-700, 500),
    SEEN: (300, -900),
    COASTS: (-400, -800),
    CLICKED: (900, -200),
    CAUGHT: (-1050, -250),
    HULL: (-200, 950),
    CHOSEN: (950, 400),
    REFERENCE: (-850, -850),
}
LOST_AT = (250, 1150)
LENGTH, BEAM, HULL_HEADING = 160, 34, math.radians(111)
ALARMS = [
    ('danger', 'alarm', 'active unacknowledged', DANGER, (0, 0)),
    ('danger', 'alarm', 'active acknowledged', SEEN, (0, 0)),
    ('new target', 'warning', 'active unacknowledged', CAUGHT, (0, 0)),
    ('lost target', 'warning', 'active unacknowledged', 19, LOST_AT),
]


def columns(**changed):
    """The rows of the targets; what is given is changed in that of TRACKED."""
    count = len(PLACES)
    values = {name: [0] * count for name in ('vx', 'vy', 'danger_probability', 'acquired')}
    values |= {name: [None] * count for name in ('length', 'beam', 'heading')}
    for name in ('range', 'bearing', 'course', 'speed', 'cpa', 'tcpa', 'bow_range', 'bow_time'):
        values[name] = values[name + '_sd'] = [1] * count
    numbers = list(PLACES)
    row = numbers.index
    values['number'] = [0 if n == CLICKED else 30 if n == REFERENCE else n for n in numbers]
    values['id'] = [n + 400 for n in numbers]
    values['x'] = [OWN['x'] + PLACES[n][0] for n in numbers]
    values['y'] = [OWN['y'] + PLACES[n][1] for n in numbers]
    values['status'] = [{CLICKED: 0, COASTS: 2}.get(n, 1) for n in numbers]
    values['alarm'] = [{DANGER: 2, SEEN: 1}.get(n, 0) for n in numbers]
    values['motion'] = values['length_sd'] = values['heading_sd'] = [0] * count
    values['xx'], values['xy'], values['yy'] = [3600.0] * count, [0.0] * count, [400.0] * count
    values['length'][row(HULL)], values['beam'][row(HULL)] = LENGTH, BEAM
    values['heading'][row(HULL)] = HULL_HEADING
    for name, value in changed.items():
        values[name][row(TRACKED)] = value
    return values


def told_of(alarms):
    """Alerts as the server tells them: of kind, priority, state, number, place from own ship."""
    return [
        {
            'name': f'{kind} {number}',
            'text': '',
            'kind': kind,
            'priority': priority,
            'category': 'A',
            'identifier': '10001',
            'state': state,
            'number': number,
            'instance': k + 1,
            'sounds': 1,
            'x': OWN['x'] + x,
            'y': OWN['y'] + y,
        }
        for k, (kind, priority, state, number, (x, y)) in enumerate(alarms)
    ]


class Scene:
    """The page of a server that tells of a scene, turned as asked; and what is drawn where.

    commands  those that the page has given
    """

    def __init__(self, page, server, commands, orientation):
        self.page, self.server, self.commands = page, server, commands
        self.up = 0.0 if orientation == 'north-up' else HEADING

    async def look(self):
        """Where the picture lies, and the colours."""
        box = await self.page.evaluate(
            "(({width, height}) => [width, height])(document.getElementById('picture')"
            '.getBoundingClientRect())'
        )
        self.middle = box[0] / 2, box[1] / 2
        self.radius = min(box) / 2 - 40
        self.scale = self.radius / (0.75 * 1852)
        self.colors = await self.page.evaluate('ppi.app.colors')

    def place(self, east, north):
        """The pixel of a place from own ship, m."""
        right = east * math.cos(self.up) - north * math.sin(self.up)
        ahead = east * math.sin(self.up) + north * math.cos(self.up)
        return self.middle[0] + right * self.scale, self.middle[1] - ahead * self.scale

    async def drawn(self, color, *pixels, reach=2, off=45):
        """Of each pixel whether the colour is drawn at most `reach` px away from it.

        off  how far each component may be off: thin lines are half sea
        """
        return await self.page.evaluate(
            f"""(() => {{ const pen = document.getElementById('picture').getContext('2d');
            const hex = ppi.app.colors['{color}'];
            const want = [1, 3, 5].map(k => parseInt(hex.slice(k, k + 2), 16));
            return {[list(pixel) for pixel in pixels]}.map(([x, y]) => {{
              const side = 2 * {reach} + 1;
              const left = Math.round(x - 0.5) - {reach}, top = Math.round(y - 0.5) - {reach};
              const {{data}} = pen.getImageData(left, top, side, side);
              for (let k = 0; k < data.length; k += 4)
                if (want.every((value, c) => Math.abs(data[k + c] - value) < {off})) return true;
              return false; }}); }})()"""
        )

    async def shows(self, color, *pixels, patience=4.0, **about):
        """Waited for: what flashes is looked at while it is there."""
        until = time.monotonic() + patience
        while not all(found := await self.drawn(color, *pixels, **about)):
            assert time.monotonic() < until, (color, dict(zip(pixels, found)))
            await asyncio.sleep(0.1)

    async def hides(self, color, *pixels, patience=4.0):
        """Waited for: none of it is there, as between two flashes."""
        until = time.monotonic() + patience
        while any(found := await self.drawn(color, *pixels, reach=1)):
            assert time.monotonic() < until, (color, dict(zip(pixels, found)))
            await asyncio.sleep(0.1)


@functools.cache
def one_browser():
    """The browser of all scenes; its port."""
    running = contextlib.ExitStack()
    atexit.register(running.close)
    return running.enter_context(browser.running())


def on_scene(act, orientation, own=None, ship=None, alarms=ALARMS, query='', **changed):
    async def run():
        commands = []

        def answer(command):
            commands.append(command)
            done = Future()
            done.set_result('')
            return done

        server = DisplayServer('127.0.0.1:0', answer)
        server.publish('ship', {'length': 0, 'beam': 0, 'bow': 0, 'source': 'radar'} | (ship or {}))
        server.publish('alarms', {'alarms': told_of(alarms)})

        async def play():
            while True:
                at = time.monotonic()
                server.publish('own', OWN | (own or {}) | {'at': at})
                told = {'at': at, 'time': 500.0, 'period': 2.0, 'columns': columns(**changed)}
                server.publish('targets', told)
                await asyncio.sleep(0.3)

        player = asyncio.ensure_future(play())
        address = server.url.replace('/#', f'/?range=0.75&labels=off&rings=off{query}#')
        try:
            async with browser.open_tab(one_browser(), address, 1150, 900) as page:
                await page.until(f'ppi.state.targets.length == {len(PLACES)}')
                await page.until("document.getElementById('stale').hidden")
                await page.evaluate(
                    f"while (ppi.settings.orientation != '{orientation}')"
                    " document.querySelector('[data-next=orientation]').click()"
                )
                scene = Scene(page, server, commands, orientation)
                await scene.look()
                await act(scene)
                assert page.errors == []
        finally:
            player.cancel()
            server.close()

    asyncio.run(run())
