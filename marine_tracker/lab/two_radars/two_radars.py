"""Two radars on one ship: is the fused track better than each alone, and does it survive a failure?

Each run is the shipped scene `two_radars_x` / `two_radars_s` with its own noise: seven ships, three
of which turn, clutter, and a boat that only the X band radar sees. Ways to track it: each radar
alone; both with all scans; both with the S band radar silent for five minutes; and both with late
plots taken as they come instead of in the order of their times. Errors are those of the tracker's
positions and of the course and speed that the ARPA shows. They are taken every 5 s from the second
minute on, for the six ships that both radars see. Ratios have a 95 % interval over the runs.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ...arpa import motion
from ...evaluation import parallel, report
from ...evaluation.gospa import assign
from ...evaluation.result import BORNE_OUT, NOT_BORNE_OUT, Progress, Result, silent
from ...service import Service, service_for
from ...simulation import radar, scenario
from ...tracking.lifecycle import LOST
from ...tracking.radars import fused, merged
from ...types import Array, Scan, take

HELP = 'the fused track of two radars against that of each alone, with one of them failing'
RUNS = 100
SETTLED, EVERY = 120.0, 5.0  # s
WITHIN = 300.0  # m; a track at most this far from a ship is its track
SILENT = 300.0, 600.0  # s, of the S band radar
SEEN_BY_BOTH = 6  # ships; the seventh is the boat
WAYS = 'X band', 'S band', 'both', 'both, S band silent', 'both, as plots come'


class Course(NamedTuple):
    """Errors of position [K, T] m and velocity [K, T] m/s; nan where a ship has no track.

    changes  number of times that a ship's track was replaced by another
    false    tracks that were never on a ship
    """

    position: Array
    velocity: Array
    changes: int
    false: int


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    estimator: str = 'imm',
    workers: parallel.Workers = None,
) -> Result:
    """The scene `runs` times in every way."""
    seeds = np.random.SeedSequence([seed, 5]).generate_state(runs)
    work = [parallel.Job(scene, (estimator, int(one))) for one in seeds]
    found = parallel.run(work, workers, progress)
    by_way = dict(zip(WAYS, zip(*found), strict=True))
    rng = np.random.default_rng(seed)
    figures = []
    for what, unit in (('position', 'm'), ('velocity', 'm/s')):
        squares = {
            way: np.array(
                [
                    np.nanmean(np.square(getattr(course, what)[:, :SEEN_BY_BOTH]))
                    for course in courses
                ]
            )
            for way, courses in by_way.items()
        }
        figures += [
            report.Figure(f'{way}: {what}, RMS', float(np.sqrt(square.mean())), unit)
            for way, square in squares.items()
        ]
        for way, against in (
            ('both', 'X band'),
            ('both', 'S band'),
            ('both, S band silent', 'X band'),
        ):
            value, low, high = _ratio(squares[way], squares[against], rng)
            name = f'{way} over {against}: {what}'
            figures += [
                report.Figure(name, value),
                report.Figure(f'{name}, 95 % from', low),
                report.at_most(f'{name}, 95 % to', high, 1.0),
            ]
    for way, courses in by_way.items():
        ships = SEEN_BY_BOTH if way == 'S band' else SEEN_BY_BOTH + 1
        gone = np.mean([np.isnan(course.position[:, :ships]).mean() for course in courses])
        name = f'{way}: of the time without a track'
        figures.append(
            report.at_most(name, float(gone), 0.001)
            if way.startswith('both')
            else report.Figure(name, float(gone))
        )
        figures += [
            report.Figure(f'{way}: changes of track', sum(c.changes for c in courses)),
            report.Figure(
                f'{way}: false tracks a run', float(np.mean([course.false for course in courses]))
            ),
        ]
    return Result(figures, [_claim(figures)])


def scene(estimator: str, seed: int, until: float = np.inf) -> list[Course]:
    """One run, in every way; its scans that end before `until` s."""
    x, s = scenario.load('two_radars_x'), scenario.load('two_radars_s')
    first, second = np.random.SeedSequence(seed).generate_state(2).tolist()
    of_x, of_s = (
        [scan for scan, _ in radar.simulate(one, noise) if scan.end < until]
        for one, noise in ((x, first), (s, second))
    )
    fails = [scan for scan in of_s if not SILENT[0] < scan.end < SILENT[1]]
    both = fused([x.tracker_parameters(), s.tracker_parameters()], ['x', 's'])
    of_radar_x, of_radar_s = (
        service_for(one.tracker_parameters(), estimator=estimator) for one in (x, s)
    )
    of_both = service_for({**x.tracker_parameters(), **both}, estimator=estimator)
    as_they_come = service_for({**x.tracker_parameters(), **both}, estimator=estimator)
    as_they_come.tracker.updates = 0  # no update is kept, so none can be undone
    return [
        follow(of_radar_x, of_x, x),
        follow(of_radar_s, of_s, s),
        follow(of_both, merged(of_x, of_s), x),
        follow(of_both, merged(of_x, fails), x),
        follow(as_they_come, merged(of_x, of_s), x),
    ]


def follow(service: Service, scans: Iterable[Scan], truth: scenario.Scenario) -> Course:
    """Runs the service on the scans and takes its errors."""
    memory, output, due = service.start(), None, SETTLED
    errors: list[Array] = []
    last: dict[int, int] = {}
    changes, false, true = 0, set(), set()
    for scan in scans:
        while output is not None and scan.end > due:
            ships = truth.truth_at(due)
            tracks = output.report.tracks
            shown = (tracks.number > 0) & (tracks.status != LOST)
            moving = motion.at(take(memory.arpa.motion, np.flatnonzero(shown)), due)
            place = service.tracker.extrapolate(tracks, due).position[shown]
            apart = np.linalg.norm(ships.position[:, None] - place, axis=-1)
            ship, track = assign(apart, WITHIN)
            off = np.full((2, len(ships.target)), np.nan)
            off[0, ship] = apart[ship, track]
            off[1, ship] = np.hypot(*(moving.velocity[track] - ships.velocity[ship]).T)
            errors.append(off)
            numbers = tracks.number[shown]
            for one, number in zip(ship.tolist(), numbers[track].tolist()):
                changes += last.get(one, number) != number
                last[one] = number
            true |= set(numbers[track].tolist())
            false |= set(numbers.tolist())
            due += EVERY
        memory, output = service.step(memory, scan)
    position, velocity = np.stack(errors, 1)
    return Course(position, velocity, changes, len(false - true))


def _ratio(square, against, rng, resamples: int = 2000):
    """Ratio of the RMS of the runs [R], and its 95 % interval by resampling the runs in pairs."""
    pick = rng.integers(0, len(square), (resamples, len(square)))
    spread = np.sqrt(square[pick].mean(1) / against[pick].mean(1))
    return (
        float(np.sqrt(square.mean() / against.mean())),
        *(float(limit) for limit in np.percentile(spread, [2.5, 97.5])),
    )


def _claim(figures) -> report.Claim:
    named = {figure.name: figure.value for figure in figures}
    highest = max(named[f'both over {one}: position, 95 % to'] for one in WAYS[:2])
    found = ', '.join(f'{named[f"{way}: position, RMS"]:.1f} m {way}' for way in WAYS[:4])
    late = named['both, as plots come: position, RMS'] / named['both: position, RMS'] - 1
    return report.Claim(
        'two radars',
        'the fused track is better than that of each radar alone',
        f'{found}. Late plots taken as they come cost {100 * late:+.1f} %.',
        BORNE_OUT if highest < 1 else NOT_BORNE_OUT,
    )
