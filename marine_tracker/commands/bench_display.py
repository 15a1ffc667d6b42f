"""What the picture costs: frames a second, processor time of the display node, load time, bytes.

A simulator, a tracker and a display as processes, with 200 ships, 1,000 plots and 2,048 spokes in
each turn of 24 a minute, and the page in a headless browser on this machine. Takes about a minute
and a half. Needs ROS 2, aiohttp, psutil, and Chromium or Chrome.
"""

import asyncio
import contextlib
import itertools
import json
import os
import tempfile
import time
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..evaluation import report
from ..recording import spokes_file
from ..simulation import scenario, video
from . import demo_page
from .node_processes import Child, children_of
from .progress_bar import progress_bar

SHIPS, FALSE_PLOTS = 200, 800
TURNS_A_MINUTE = 24
SETTLE_S = 90.0  # s, at most, until the ships are targets
NEARLY_ALL = 0.9  # of the ships
MANY = 10  # viewers
MEASURED_S = 15.0
LOADS = 5
LONGEST_S = 300.0  # s, of all together
VIDEO, VIDEO_TURNS = 'video_coast', 6  # whose spokes are shown again and again
PARTS = 'nodes start', 'ships become targets', '1 viewer', f'{MANY} viewers', 'page loads', 'frames'
Tell = Callable[[str], None]
# The limits that are demanded.
LEAST_FRAMES, LEAST_FRAMES_SOFTWARE = 50.0, 25.0
MOST_CPU, MOST_CPU_MANY = 10.0, 25.0  # % of a core
MOST_LOAD_S = 1.0
MOST_RATE = 300.0  # kB/s to a viewer

COUNT_FRAMES = """(async () => { const first = ppi.frames(), began = performance.now();
  let on = true; (function go() { if (!on) return; ppi.redraw(); requestAnimationFrame(go); })();
  await new Promise(done => setTimeout(done, %d)); on = false;
  return 1000 * (ppi.frames() - first) / (performance.now() - began); })()"""
SOFTWARE = """(() => { const gl = document.createElement('canvas').getContext('webgl2');
  const about = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = about ? gl.getParameter(about.UNMASKED_RENDERER_WEBGL) : '';
  return !name || /swiftshader|llvmpipe|software/i.test(name); })()"""
# From the start of the navigation to the first frame with targets.
LOADED = """new Promise(done => { const look = () => ppi.state.targets.length && ppi.frames() ?
  requestAnimationFrame(() => done(performance.now())) : requestAnimationFrame(look); look(); })"""


def figures(seed: int) -> list[report.Figure]:
    """The figures. OSError without a browser, or where it takes too long; ModuleNotFoundError
    without what is needed else."""
    import aiohttp  # noqa: F401
    import psutil

    from ..display import browser
    from ..nodes import domain

    if browser.program() is None:
        raise OSError(f'none of {", ".join(browser.PROGRAMS)} is installed')
    with contextlib.ExitStack() as stack:
        bar = stack.enter_context(progress_bar(PARTS[0]))
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        scene, spokes = folder / 'crowd.yaml', folder / 'spokes.npz'
        scene.write_text(json.dumps(crowd(seed)))
        _write_spokes(spokes, seed)
        tracker = scenario.load(str(scene)).tracker_parameters()
        domain.set_local(os.environ, stack.enter_context(domain.free_domain()))
        children = stack.enter_context(
            children_of(
                {
                    'tracker': dict(tracker),
                    'ppi_display': {'address': '127.0.0.1:0', 'token': 'bench'},
                    'radar_simulator': {'scenario': str(scene), 'seed': seed},
                }
            )
        )
        children.start(
            {'recording_player': {'folder': str(spokes), 'loop': True}},
            {'own_ship/odometry': 'of_video/odometry'},
        )
        page = next(child for child in children if child.name == 'ppi_display')
        node, part = psutil.Process(page.process.pid), PARTS[0]

        def tell(now: str) -> None:
            nonlocal part
            part = now
            bar(PARTS.index(now), len(PARTS), now)

        async def measured() -> list[report.Figure]:
            try:
                async with asyncio.timeout(LONGEST_S):
                    return await _measure(_address(page), node, tell)
            except TimeoutError as error:
                raise OSError(f'{part}: {error or f"not done after {LONGEST_S:g} s"}') from error

        return asyncio.run(measured())


def _write_spokes(file: Path, seed: int) -> None:
    """A few turns of radar video."""
    chosen = scenario.load(VIDEO)
    turns = itertools.islice(video.simulate(chosen, seed), VIDEO_TURNS)
    time = np.arange(0, VIDEO_TURNS * chosen.radar.scan_period, 0.1)
    spokes_file.write(file, [turn.sweep for turn in turns], chosen.own_ship_at(time))


def crowd(seed: int) -> dict[str, Any]:
    """A scenario of SHIPS ships all around own ship, and FALSE_PLOTS false plots in each turn."""
    rng = np.random.default_rng(seed)
    away, bearing = 11 * np.sqrt(rng.uniform(0.01, 1, SHIPS)), rng.uniform(0, 2 * np.pi, SHIPS)
    course, speed = rng.integers(0, 360, SHIPS), rng.uniform(3, 18, SHIPS)
    return {
        'description': 'a crowd, to measure what its picture costs',
        'duration_s': 3600,
        'radar': {'rotation_rpm': TURNS_A_MINUTE, 'max_range_nm': 12},
        'clutter': {'uniform': FALSE_PLOTS},
        'own_ship': {'course_deg': 40, 'speed_kn': 12},
        'targets': [
            {
                'start': {
                    'north_nm': round(r * float(np.cos(b)), 3),
                    'east_nm': round(r * float(np.sin(b)), 3),
                },
                'course_deg': int(c),
                'speed_kn': round(float(v), 1),
            }
            for r, b, c, v in zip(away, bearing, course, speed)
        ],
    }


def _address(page: Child) -> str:
    until = time.monotonic() + SETTLE_S
    while time.monotonic() < until and page.process.poll() is None:
        if address := demo_page.address_of(page):
            return address
        time.sleep(0.1)
    raise OSError('the display does not start')


async def _measure(address: str, node: Any, tell: Tell) -> list[report.Figure]:
    from ..display import browser

    tell(PARTS[1])
    async with _viewers(address, 1) as (viewer,):
        await viewer.until_crowded()
        tell(PARTS[2])
        cpu_one, rate = await _cpu(node, [viewer])
        tell(PARTS[3])
        async with _viewers(address, MANY - 1) as others:
            cpu_many, _ = await _cpu(node, [viewer, *others])
    tell(PARTS[4])
    loads = []
    with browser.running() as port:
        where = address.replace('/#', '/?range=12#')
        for _ in range(LOADS):
            async with browser.open_tab(port, where) as page:
                loads.append(await page.evaluate(LOADED) / 1000)
        tell(PARTS[5])
        async with browser.open_tab(port, where) as page:
            await page.until('ppi.state.spokes && ppi.state.plots.length > 8')
            software = await page.evaluate(SOFTWARE)
            spent, drawn = _browser_cpu(), await page.evaluate('ppi.frames()')
            frames = await page.evaluate(COUNT_FRAMES % (1000 * MEASURED_S / 2))
            spent, drawn = _browser_cpu() - spent, await page.evaluate('ppi.frames()') - drawn
            plots = await page.evaluate('ppi.state.plots.at(-1).x.length')
            targets = await page.evaluate('ppi.state.targets.length')
    how = 'software rendering' if software else 'with a graphics processor'
    least = LEAST_FRAMES_SOFTWARE if software else LEAST_FRAMES
    return [
        report.Figure('targets shown', targets),
        report.Figure('plots in a scan', plots),
        report.at_least('frames, all drawn anew', frames, least, '1/s', how),
        # Says what a free machine would do, where this one is busy.
        report.Figure('processor time of a frame, whole browser', 1000 * spent / drawn, 'ms'),
        report.at_most('display node, 1 viewer', cpu_one, MOST_CPU, '% of a core'),
        report.at_most(f'display node, {MANY} viewers', cpu_many, MOST_CPU_MANY, '% of a core'),
        report.at_most('page loaded, picture drawn', sorted(loads)[LOADS // 2], MOST_LOAD_S, 's'),
        report.at_most('to a viewer', rate, MOST_RATE, 'kB/s'),
    ]


def _browser_cpu() -> float:
    """s that the processes of the browser have used so far."""
    import psutil

    used = 0.0
    for child in psutil.Process().children(recursive=True):
        with contextlib.suppress(psutil.Error):
            if 'chrom' in child.name():
                times = child.cpu_times()
                used += times.user + times.system
    return used


class _Viewer:
    """A viewer that reads all, and counts the bytes."""

    def __init__(self, link: Any) -> None:
        self._link, self.bytes, self.targets = link, 0, 0
        self.reading = asyncio.ensure_future(self._read())

    async def _read(self) -> None:
        async for message in self._link:
            self.bytes += len(message.data)
            if '"kind":"targets"' in message.data[:40]:
                self.targets = len(json.loads(message.data)['columns']['number'])

    async def until_crowded(self) -> None:
        until = time.monotonic() + SETTLE_S
        while self.targets < NEARLY_ALL * SHIPS:
            if time.monotonic() > until:
                raise OSError(f'after {SETTLE_S:g} s only {self.targets} targets of {SHIPS} ships')
            await asyncio.sleep(0.5)


@contextlib.asynccontextmanager
async def _viewers(address: str, count: int) -> AsyncIterator[list[_Viewer]]:
    import aiohttp

    live = address.split('#')[0].split('?')[0] + 'live'
    async with contextlib.AsyncExitStack() as stack:
        session = await stack.enter_async_context(aiohttp.ClientSession())
        links = [await stack.enter_async_context(session.ws_connect(live)) for _ in range(count)]
        viewers = [_Viewer(link) for link in links]
        yield viewers
        for viewer in viewers:
            viewer.reading.cancel()


async def _cpu(node: Any, viewers: list[_Viewer]) -> tuple[float, float]:
    """The node's share of a core, %, and kB/s to a viewer, with these viewers."""

    def used() -> float:
        spent = node.cpu_times()
        return spent.user + spent.system

    await asyncio.sleep(3)  # the first whole picture is not measured
    before, began = used(), time.monotonic()
    first = sum(viewer.bytes for viewer in viewers)
    await asyncio.sleep(MEASURED_S)
    lasted = time.monotonic() - began
    amount = sum(viewer.bytes for viewer in viewers) - first
    return 100 * (used() - before) / lasted, amount / len(viewers) / lasted / 1000
