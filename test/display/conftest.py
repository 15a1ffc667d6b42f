"""A sea that is made up, a server that tells of it, and a browser that shows it."""

import asyncio
import contextlib
import fcntl
import math
import random
import re
import shutil
import subprocess
import tempfile
import time
from concurrent.futures import Future
from pathlib import Path

import pytest

COLUMNS = (
    'number id x y vx vy xx xy yy status alarm acquired motion danger_probability length length_sd '
    'beam heading heading_sd range range_sd bearing bearing_sd course course_sd speed speed_sd cpa '
    'cpa_sd tcpa tcpa_sd bow_range bow_range_sd bow_time bow_time_sd'
).split()
WEB = Path(__file__).resolve().parents[2] / 'web'
UNREACHABLE = re.compile('ENOTFOUND|EAI_AGAIN|ECONN|ETIMEDOUT|ENETUNREACH|EHOSTUNREACH|ERR_SOCKET')
TRACKED, DANGER_UNACKNOWLEDGED = 1, 2


class Sea:
    """Own ship and ships around her, all on straight courses, told to viewers while it is live.

    ships: how many; dangers: how many of them are dangerous and wait to be acknowledged;
    plots: in a scan; own: what own ship is to be beside the default.
    """

    def __init__(self, server, ships=17, dangers=1, plots=60, period=1.3, **own):
        self.server = server
        self.live, self.period = True, period
        self.began = time.monotonic()
        self.own = {'x': -730.0, 'y': 2410.0, 'vx': 2.0, 'vy': -5.5, 'heading': 2.79} | own
        self.own |= {'latitude': 58.3, 'longitude': 17.6}
        chance = random.Random(23)
        self.ships = [
            {
                'number': k + 1,
                'id': 500 + k,
                'x': self.own['x'] + chance.uniform(-9000, 9000),
                'y': self.own['y'] + chance.uniform(-9000, 9000),
                'vx': chance.gauss(0, 5),
                'vy': chance.gauss(0, 5),
                'status': TRACKED,
                'alarm': DANGER_UNACKNOWLEDGED if k < dangers else 0,
            }
            for k in range(ships)
        ]
        self.plots = [(chance.uniform(-9e3, 9e3), chance.uniform(-9e3, 9e3)) for _ in range(plots)]
        self.count = 0

    def columns(self, moment):
        rows = {name: [] for name in COLUMNS}
        for ship in self.ships:
            dx = ship['x'] + ship['vx'] * moment - self.own['x'] - self.own['vx'] * moment
            dy = ship['y'] + ship['vy'] * moment - self.own['y'] - self.own['vy'] * moment
            known = ship | {
                'x': round(ship['x'] + ship['vx'] * moment, 1),
                'y': round(ship['y'] + ship['vy'] * moment, 1),
                'range': round(math.hypot(dx, dy)),
                'bearing': math.atan2(dx, dy) % (2 * math.pi),
                'course': math.atan2(ship['vx'], ship['vy']) % (2 * math.pi),
                'speed': math.hypot(ship['vx'], ship['vy']),
                'cpa': 640 + ship['id'],
                'tcpa': 900 - ship['number'],
                'danger_probability': 0.9 if ship['alarm'] else 0.02,
            }
            for name in COLUMNS:
                rows[name].append(known.get(name, 0 if name in ('acquired', 'motion') else 30))
        for name in ('length', 'length_sd', 'beam', 'heading', 'heading_sd'):
            rows[name] = [None] * len(self.ships)
        return rows

    def tell_own(self):
        at = time.monotonic()
        moment = at - self.began
        place = {
            'x': round(self.own['x'] + self.own['vx'] * moment, 3),
            'y': round(self.own['y'] + self.own['vy'] * moment, 3),
        }
        self.server.publish('own', {**self.own, **place, 'at': at, 'time': 7e8 + moment})

    def tell_scan(self):
        """Targets, plots, alarms; `time` counts the scans since 7e8."""
        at = time.monotonic()
        self.count += 1
        scan = {'at': at, 'time': 7e8 + self.count, 'period': self.period}
        self.server.publish('targets', {**scan, 'columns': self.columns(at - self.began)})
        plots = {
            'x': [round(self.own['x'] + x + self.count) for x, _ in self.plots],
            'y': [round(self.own['y'] + y) for _, y in self.plots],
        }
        self.server.publish('plots', {'at': at, 'stamp': 7e8 + self.count, **plots})

    def tell_alarms(self, *numbers, priority='alarm'):
        """Targets of these numbers are dangerous, and nobody has acknowledged it."""
        told = [
            {
                'name': f'TT{number:02}: danger',
                'text': f'TT{number:02} dangerous: CPA 0.17 NM',
                'kind': 'danger',
                'priority': priority,
                'state': 'active unacknowledged',
                'number': number,
                'in_state_s': 4,
                'x': 10,
                'y': 20,
            }
            for number in numbers
        ]
        self.server.publish('alarms', {'alarms': told})

    async def play(self):
        """Own ship ten times a second, a scan each period."""
        scanned = -math.inf
        while True:
            if self.live:
                self.tell_own()
                if time.monotonic() - scanned >= self.period:
                    scanned = time.monotonic()
                    self.tell_scan()
            await asyncio.sleep(0.1)


class Commands:
    """Answers every command with `NAME done`, and remembers them."""

    def __init__(self):
        self.given = []

    def __call__(self, command):
        self.given.append(command)
        answer = Future()
        answer.set_result(f'{command.name} done')
        return answer


@pytest.fixture
def sea_server():
    """sea_server(**of Sea) -> Sea with a server on a free port; `sea.commands` were given."""
    from marine_tracker.display.server import DisplayServer

    with contextlib.ExitStack() as stack:

        def start(address='127.0.0.1:0', token=None, **options):
            commands = Commands()
            sea = Sea(DisplayServer(address, commands, token=token), **options)
            sea.commands = commands
            stack.callback(lambda: sea.server.close())
            return sea

        yield start


@pytest.fixture(scope='session')
def chromium():
    """A headless browser for all tests; the port of its DevTools."""
    pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
    from marine_tracker.display import browser

    if not browser.program():
        pytest.skip('no Chromium: the page is not tried in a browser')
    with browser.running() as port:
        yield port


@pytest.fixture
def visit(chromium, sea_server):
    """visit(act, query='', **of Sea): act(page, sea) with the page open and live.

    address(sea) may give another address than the server's. Whatever act allows stands in
    page.allowed; other errors of the page, and requests to other places than its server, fail.
    """
    from marine_tracker.display import browser

    def run(act, query='', address=None, width=1180, height=790, **options):
        async def go():
            sea = sea_server(**options)
            playing = asyncio.ensure_future(sea.play())
            where = address(sea) if address else sea.server.url
            where = where.replace('/#', f'/{query}#')
            try:
                async with browser.open_tab(chromium, where, width, height) as page:
                    page.allowed = []
                    await page.until(f'ppi.state.targets.length == {len(sea.ships)}')
                    await page.until("document.getElementById('stale').hidden")
                    await act(page, sea)
                    assert [one for one in page.errors if one not in page.allowed] == []
                    here = where.split('/')[2]
                    ours = f'http://{here}/', f'ws://{here}/'
                    assert [url for url in page.requests if not url.startswith(ours)] == []
            finally:
                playing.cancel()

        asyncio.run(asyncio.wait_for(go(), 100))

    return run


@pytest.fixture(scope='session')
def web():
    """The folder web/ with the tools that its lock file names, fetched where they are not there."""
    if not shutil.which('npm'):
        pytest.skip('no npm: what is built and checked by Node.js is not')
    lock, done = WEB / 'package-lock.json', WEB / 'node_modules' / '.package-lock.json'
    with open(Path(tempfile.gettempdir()) / f'marine_tracker_web_{WEB.stat().st_ino}', 'w') as turn:
        fcntl.flock(turn, fcntl.LOCK_EX)  # tests run in several processes
        if not done.exists() or done.stat().st_mtime < lock.stat().st_mtime:
            fetched = subprocess.run(
                ['npm', 'ci', '--no-audit', '--no-fund', '--ignore-scripts'],
                cwd=WEB,
                capture_output=True,
                text=True,
                timeout=110,
            )
            if fetched.returncode and UNREACHABLE.search(fetched.stderr):
                pytest.skip('the npm registry cannot be reached')
            assert fetched.returncode == 0, fetched.stderr
            done.touch()
    return WEB
