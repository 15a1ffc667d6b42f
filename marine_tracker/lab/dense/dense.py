"""A crowd of plots: memory and time of a scan, and whether targets elsewhere are kept.

38 ships are tracked; then 1,000 to 10,000 false plots come in one of eight patterns, in a few scans
one after the other, and go again. Each case has a process of its own, whose greatest memory is
told; so is the CPU time of its slowest scan, and how many ships still have the track they had.
"""

import time
from typing import NamedTuple

import numpy as np

from ...evaluation import parallel, report
from ...evaluation.result import Progress, Result, silent
from ...geometry import unit_vector
from ...processes import keep_freed_memory, peak_memory_mb
from ...service import Service, service_for
from ...tracking.lifecycle import LOST
from ...types import Array, OwnShip, PolarPlots, Scan
from .patterns import PATTERNS, polar

HELP = 'up to 10,000 false plots in one place: memory, time of a scan, targets elsewhere kept'
RUNS = 1
OPTIONS = {
    'estimator': {'default': 'gwnn', 'help': 'filter of the tracker (default gwnn)'},
    'extent': {'default': 'none', 'help': 'none, random_matrix or gp (default none)'},
    'scans': {'type': int, 'default': 2, 'help': 'scans with a crowd, one after another'},
}
COUNTS = 1000, 2000, 5000, 10000
SHIPS = 38
PERIOD = 60 / 22  # s
RANGE_SIGMA, BEARING_SIGMA = 15.0, float(np.radians(0.5))
BEFORE, AFTER = 15, 3  # scans without a crowd
MOST_MB, MOST_S = 1000.0, 0.5 * PERIOD
CLEAR = 1000.0  # m: no ship is nearer to the crowd
WITHIN = 300.0  # m, a track no farther from its ship is kept


class Case(NamedTuple):
    """memory_mb: greatest of the process; cpu_s: of the slowest scan; kept: ships that have the
    track they had before; left_out: pairs, in all scans."""

    memory_mb: float
    cpu_s: float
    kept: int
    left_out: int


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    estimator: str = 'gwnn',
    extent: str = 'none',
    scans: int = 2,
    counts: tuple[int, ...] = COUNTS,
) -> Result:
    """Every pattern with every number of plots, `runs` times; the worst run counts."""
    if scans < 1:
        raise ValueError(f'--scans is {scans}; it must be at least 1')
    cases = [(name, count) for name in PATTERNS for count in counts]
    found: list[list[Case]] = []
    for done, (name, count) in enumerate(cases):
        progress(done, len(cases))
        of_case: list[Case] = []
        for one in range(seed, seed + runs):
            # One process after the other: they would take the time from each other.
            job = parallel.Job(measure, (name, count, one, estimator, extent, scans))
            of_case += parallel.run([job], 1, silent)
        found.append(of_case)
    progress(len(cases), len(cases))
    figures = []
    for (name, count), of_case in zip(cases, found, strict=True):
        title = f'{count} plots, {name}'
        figures += [
            report.at_most(
                f'{title}: memory', max(case.memory_mb for case in of_case), MOST_MB, 'MB'
            ),
            report.at_most(
                f'{title}: CPU time of a scan', max(case.cpu_s for case in of_case), MOST_S, 's'
            ),
            report.at_least(f'{title}: ships kept', min(case.kept for case in of_case), SHIPS),
            report.Figure(f'{title}: pairs left out', max(case.left_out for case in of_case)),
        ]
    return Result(figures)


def measure(
    name: str, count: int, seed: int, estimator: str = 'gwnn', extent: str = 'none', scans: int = 2
) -> Case:
    """One case, in this process: its greatest memory is that of all it has ever done."""
    keep_freed_memory()
    rng = np.random.default_rng(seed)
    service = service_for(
        {'range_sigma_m': RANGE_SIGMA, 'bearing_sigma_deg': 0.5, 'scan_period_s': PERIOD},
        estimator=estimator,
        extent=extent,
    )
    crowd = PATTERNS[name]
    place, velocity = _ships(rng, crowd(count, rng))
    memory, numbers = service.start(), np.zeros(0)
    slowest, left_out = 0.0, 0
    for k in range(BEFORE + scans + AFTER):
        if k == BEFORE:
            numbers = _tracks_of(service, memory, place, k * PERIOD)
        false = crowd(count, rng) if BEFORE <= k < BEFORE + scans else np.zeros((0, 2))
        scan = _scan(k, place, false, rng)
        begin = time.process_time()
        memory, output = service.step(memory, scan)
        if len(false):
            slowest = max(slowest, time.process_time() - begin)
        left_out += output.report.left_out
        place = place + PERIOD * velocity
    now = _tracks_of(service, memory, place, (BEFORE + scans + AFTER) * PERIOD)
    return Case(peak_memory_mb(), slowest, int(np.sum((now == numbers) & (now > 0))), left_out)


def _ships(rng: np.random.Generator, crowd: Array) -> tuple[Array, Array]:
    """Ships clear of the crowd and of each other: places and velocities [SHIPS, 2] m, m/s."""
    place = np.zeros((0, 2))
    while len(place) < SHIPS:
        one = rng.uniform(1500, 15000) * unit_vector(rng.uniform(0, 2 * np.pi))
        others = np.concatenate([crowd, place])
        if np.linalg.norm(others - one, axis=1).min() > CLEAR:
            place = np.vstack([place, one])
    return place, rng.uniform(1, 10, (SHIPS, 1)) * unit_vector(rng.uniform(0, 2 * np.pi, SHIPS))


def _scan(k: int, ships: Array, false: Array, rng: np.random.Generator) -> Scan:
    """A revolution: every ship and false plot once, the beam from north on."""
    range_, bearing = polar(ships)
    range_ = np.append(range_ + rng.normal(0, RANGE_SIGMA, SHIPS), polar(false)[0])
    bearing = np.append(bearing + rng.normal(0, BEARING_SIGMA, SHIPS), polar(false)[1])
    bearing = np.mod(bearing, 2 * np.pi)
    start, own = k * PERIOD, np.zeros((1, 2))
    at = start + PERIOD * bearing / (2 * np.pi)
    amplitude = rng.uniform(10, 30, len(range_))
    plots = PolarPlots(at, range_, bearing, amplitude)
    return Scan(start, start + PERIOD, plots, OwnShip(np.array([start]), own, own))


def _tracks_of(service: Service, memory, ships: Array, now: float) -> Array:
    """Number of the confirmed track nearest to each ship; 0 where none is within reach."""
    tracks = memory.tracker.tracks
    shown = (tracks.number > 0) & (tracks.status != LOST)
    at = service.tracker.extrapolate(tracks, now).position[shown]
    if not len(at):
        return np.zeros(len(ships))
    apart = np.linalg.norm(ships[:, None] - at, axis=-1)
    return np.where(apart.min(1) < WITHIN, tracks.number[shown][apart.argmin(1)], 0)
