"""Takes pictures of the page, each of a scene that runs behind it: for documents, and to judge.

Simulator, tracker and display run as processes, faster than real time; a headless Chromium or
Chrome shows the page. Returns 1 where a page says an error on its console, or a scene does not come
about.
"""

import asyncio
import contextlib
import os
import sys
import time
from argparse import ArgumentParser, Namespace
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any, NamedTuple

from ..simulation import scenario
from . import demo_page
from .node_processes import Children, children_of

HELP = 'take pictures of the page, each of a scene that runs behind it'
START_S = 60.0
PATIENCE_S = 240.0
LIT = 'performance.now() % 1000 < 250'  # what flashes shows at that moment
DANGER = "ppi.state.alarms.some(a => a.kind === 'danger' && a.state === 'active unacknowledged')"
SETTLED = f'{DANGER} && ppi.state.plots.length > 8 && (ppi.state.trails?.count ?? 0) > 12'


class Shot(NamedTuple):
    """One picture.

    name   of the file
    query  what the address asks for
    until  JavaScript: the scene has come about
    act    what is done in the page before the picture; it gets the page and the processes
    looks  the viewer has no token
    size   px
    """

    name: str
    query: str
    until: str
    act: Callable[[Any, Children], Awaitable[None]] | None = None
    looks: bool = False
    size: tuple[int, int] = (1280, 800)


async def _choose_danger(page: Any, children: Children) -> None:
    await page.evaluate('ppi.app.choose(ppi.state.targets.find(t => t.alarm > 0).id)')


async def _try(page: Any, children: Children) -> None:
    """A trial manoeuvre: 40 degrees to starboard."""
    await page.evaluate("document.getElementById('trial-box').open = true")
    await asyncio.sleep(0.5)  # the form is filled with what own ship does
    await page.evaluate(
        '(() => {'
        "const form = document.getElementById('trial');"
        'const heading = (ppi.state.own.heading * 180 / Math.PI + 40) % 360;'
        'form.elements.course_deg.value = Math.round(heading);'
        "form.elements.speed_kn.value = 14; form.querySelector('.submit').click(); })()"
    )
    await page.until('ppi.state.trial.on && ppi.state.trial.safe_deg', PATIENCE_S)
    await page.evaluate("document.getElementById('trial-box').scrollIntoView()")


async def _draw_zone(page: Any, children: Children) -> None:
    """A guard zone by own ship's bow, not saved yet: its handles show."""
    await page.evaluate("document.getElementById('zones-box').open = true")
    await page.evaluate("document.querySelector('[data-zone=sector]').click()")
    await page.evaluate("document.getElementById('zones-box').scrollIntoView()")


async def _end_trial(page: Any, children: Children) -> None:
    await page.evaluate("document.getElementById('trial-off').click()")
    await page.until('!ppi.state.trial.on')


async def _silence(page: Any, children: Children) -> None:
    """The radar falls silent."""
    children.end('radar_simulator')
    await page.until("!document.getElementById('stale').hidden", PATIENCE_S)
    await asyncio.sleep(2)


# Of each scenario its rate and its pictures, in the order in which they are taken.
SCENES: dict[str, tuple[float, list[Shot]]] = {
    'encounters': (
        6.0,
        [
            Shot('ppi_day', 'range=3', SETTLED, _choose_danger),
            Shot('ppi_dusk', 'range=3&palette=dusk', SETTLED, _choose_danger),
            Shot('ppi_night', 'range=3&palette=night&orientation=head-up', SETTLED, _choose_danger),
            Shot(
                'ppi_danger_areas',
                'range=6&areas=on&safeCourses=on&offCentre=ahead',
                f'{SETTLED} && ppi.state.areas?.areas.length > 2',
            ),
            Shot('ppi_zones', 'range=6', SETTLED, _draw_zone),
            Shot('ppi_trial', 'range=6&orientation=head-up', SETTLED, _try),
            Shot('ppi_viewer_commands', 'range=6', SETTLED, _end_trial, size=(1024, 700)),
            Shot('ppi_viewer_looks', 'range=12', SETTLED, looks=True, size=(480, 900)),
            Shot('ppi_no_data', 'range=3', SETTLED, _silence),
        ],
    ),
    'busy_strait': (
        10.0,
        [
            Shot(
                'ppi_head_up',
                'range=12&palette=dusk&orientation=head-up&trailMinutes=6',
                'ppi.state.targets.length > 35 && ppi.state.trails?.count > 24',
            )
        ],
    ),
    'coast': (5.0, [Shot('ppi_coast', 'range=6', 'ppi.state.plots.length > 10')]),
    'hulls': (
        4.0,
        [
            Shot(
                'ppi_hulls',
                'range=1.5',
                'ppi.state.targets.filter(t => t.length !== null).length > 3',
            )
        ],
    ),
}


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the options of the command."""
    parser.add_argument('folder', type=Path, metavar='DIR', help='where the pictures go')
    parser.add_argument(
        '--only',
        metavar='NAME',
        help='one of them, or those of one scenario: '
        + ', '.join(shot.name for _, shots in SCENES.values() for shot in shots),
    )
    parser.add_argument('--seed', type=int, default=1, help='of the simulator (default: 1)')


def run(args: Namespace) -> int:
    """Returns 1 if a picture could not be taken, or its page had errors."""
    try:
        from ..display import browser
        from ..nodes import domain
    except ModuleNotFoundError as error:
        raise ValueError(f'screenshots need ROS 2 and aiohttp: {error}') from error
    if browser.program() is None:
        raise OSError(f'none of {", ".join(browser.PROGRAMS)} is installed')
    wanted = {
        name: (rate, [shot for shot in shots if args.only in (None, name, shot.name)])
        for name, (rate, shots) in SCENES.items()
    }
    if not any(shots for _, shots in wanted.values()):
        raise ValueError(f'--only is {args.only}; there is no such picture or scenario')
    args.folder.mkdir(parents=True, exist_ok=True)
    failed = 0
    with contextlib.ExitStack() as stack:
        domain.set_local(os.environ, stack.enter_context(domain.free_domain()))
        children = stack.enter_context(children_of({}))
        port = stack.enter_context(browser.running())
        for name, (rate, shots) in wanted.items():
            if shots:
                children.start(_nodes(name, rate, args.seed))
                failed += asyncio.run(_take(port, children, shots, args.folder))
                children.end('tracker', 'ppi_display', 'radar_simulator')
    return 1 if failed else 0


def _nodes(name: str, rate: float, seed: int) -> dict[str, dict[str, Any]]:
    tracker = dict(scenario.load(name).tracker_parameters())
    if name in ('hulls', 'coast'):
        tracker['extent'] = 'random_matrix'
    return {
        'ppi_display': {'address': '127.0.0.1:0'},
        'tracker': {**tracker, 'use_sim_time': True},
        'radar_simulator': {'scenario': name, 'rate': rate, 'seed': seed},
    }


async def _take(port: int, children: Children, shots: list[Shot], folder: Path) -> int:
    """How many failed."""
    from ..display import browser

    node = next(child for child in children if child.name == 'ppi_display')
    until = time.monotonic() + START_S
    while not (address := demo_page.address_of(node)):
        if time.monotonic() > until:
            raise OSError('the display does not start')
        await asyncio.sleep(0.1)
    failed = 0
    for shot in shots:
        where = address.replace('/#', f'/?{shot.query}#')
        where = where.partition('#')[0] if shot.looks else where
        file = folder / f'{shot.name}.png'
        try:
            async with browser.open_tab(port, where, *shot.size) as page:
                await page.until('window.ppi')
                await page.until(shot.until, PATIENCE_S)
                if shot.act:
                    await shot.act(page, children)
                await asyncio.sleep(1)
                await page.until(LIT)
                file.write_bytes(await page.screenshot())
                wrong = page.errors
        except (TimeoutError, RuntimeError) as error:
            wrong = [str(error)]
        for line in wrong:
            print(f'{shot.name}: {line}', file=sys.stderr)
        failed += bool(wrong)
        print(file if not wrong else f'{file}: failed', flush=True)
    return failed
