"""Crossings: two ships that meet at one place and time. How often are their tracks swapped?

The scene is the simulator's (simulation/crossings.py), with courses 5 to 90 degrees apart. Before
they meet each ship has a track; a run whose ships have not is told as such. It is a swap if, at the
end, a ship has the track that the other had; it is a loss if it has none or a new one. Every way of
association sees the same plots.

What `joint` told of the swap risk (tracking/meetings.py), the most in a run, is compared with what
happened: in bins, over the runs in which both tracks live.
"""

from dataclasses import fields
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...evaluation import parallel, report
from ...evaluation.gospa import assign
from ...evaluation.result import Picture, Progress, Result, silent
from ...parameters import TrackerParameters
from ...service import Service, service_for
from ...simulation import radar, scenario
from ...simulation.crossings import ANGLES, crossing
from ...tracking import meetings
from ...tracking.lifecycle import COASTING, CONFIRMED
from ...types import Array, IntArray, Scan, take

HELP = 'two ships that meet at 5 to 90 degrees: swapped and lost tracks, by way of association'
RUNS = 100
OPTIONS = {
    'estimator': {'default': 'gwnn', 'help': 'filter of the tracker (default gwnn)'},
    'angles': {
        'nargs': '+',
        'type': float,
        'default': list(ANGLES),
        'help': f'degrees between the courses (default {" ".join(map(str, ANGLES))})',
    },
}
# Ways of association, the parameter's choices; none: the parameter has not been made yet.
WAYS: tuple[str, ...] = next(
    (one.metadata['choices'] for one in fields(TrackerParameters) if one.name == 'association'), ()
)
WITHIN = 250.0  # m; a track at most this far from a ship is its track
BEFORE = 0.3  # of the duration: each ship has a track, and they are well apart
CLEAN, SWAPPED, LOST, NOT_READY = range(4)
BINS = 0.0, 0.02, 0.1, 0.2, 0.5  # of the told swap risk
CALIBRATED = 0.05  # mean distance of what was told from what happened
MOST = 0.5  # swaps of `joint`, of those of `nearest`


class Outcome(NamedTuple):
    """what: CLEAN, SWAPPED, LOST or NOT_READY; risk: the greatest swap risk that was told."""

    what: int
    risk: float = 0.0


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    estimator: str = 'gwnn',
    angles: list[float] | None = None,
    workers: parallel.Workers = None,
) -> Result:
    """Every angle `runs` times. ValueError for an angle that is not above 0 and below 180."""
    angles = angles or list(ANGLES)
    for angle in angles:
        if not 0 < angle < 180:
            raise ValueError(f'--angles has {angle:g}; it must be above 0 and below 180 degrees')
    jobs = [
        parallel.Job(follow, (angle, estimator, seed + k)) for angle in angles for k in range(runs)
    ]
    every = np.array(parallel.run(jobs, workers, progress)).reshape(len(angles), runs, -1, 2)
    found, risk = every[..., 0], every[..., 1]
    swaps, losses = (found == SWAPPED).mean(1), (found == LOST).mean(1)  # [angle, way]
    ways = WAYS or ('as shipped',)
    figures = []
    for k, angle in enumerate(angles):
        for j, way in enumerate(ways):
            figures += [
                report.Figure(f'{angle:g} deg, {way}: swapped', float(swaps[k, j])),
                report.Figure(f'{angle:g} deg, {way}: lost', float(losses[k, j])),
            ]
    figures.append(report.Figure('no two tracks before', int((found == NOT_READY).sum())))
    if {'joint', 'nearest'} <= set(ways):
        joint, nearest = (float(swaps[:, ways.index(way)].sum()) for way in ('joint', 'nearest'))
        ratio = joint / nearest if nearest else float(joint > 0)
        figures.append(report.at_most('swaps of joint, of those of nearest', ratio, MOST))
        at = ways.index('joint')
        figures += calibration(risk[..., at].ravel(), found[..., at].ravel())
    picture = Picture('crossings', (6, 4), partial(_paint, angles, swaps, losses, ways))
    return Result(figures, pictures=[picture])


def calibration(risk: Array, what: IntArray) -> list[report.Figure]:
    """What was told and what happened in the runs [K], bin by bin."""
    alive = (what == CLEAN) | (what == SWAPPED)
    told, swapped = risk[alive], what[alive] == SWAPPED
    figures, wrong = [], 0.0
    for low, high in zip(BINS[:-1], BINS[1:]):
        here = (told >= low) & ((told < high) | (high == BINS[-1]))
        if not here.any():
            continue
        mean, share = float(told[here].mean()), float(swapped[here].mean())
        wrong += abs(mean - share) * here.mean()
        name = f'swap risk {low:g} to {high:g}: swapped'
        of = f'{mean:.3f} told, {int(here.sum())} runs'
        figures.append(report.Figure(name, share, against=of))
    name = 'swap risk: told and happened differ by'
    return [*figures, report.at_most(name, float(wrong), CALIBRATED)]


def follow(angle: float, estimator: str, seed: int) -> list[Outcome]:
    """What became of the two tracks of one run, by way."""
    scene = scenario.build(crossing(angle), f'crossing at {angle:g}')
    scans = [scan for scan, _ in radar.simulate(scene, seed)]
    chosen: list[dict[str, Any]] = [{'association': way} for way in WAYS] or [{}]
    return [
        _outcome(service_for(scene.tracker_parameters(), estimator=estimator, **way), scans, scene)
        for way in chosen
    ]


def _outcome(service: Service, scans: list[Scan], scene: scenario.Scenario) -> Outcome:
    memory, risk = service.start(), 0.0
    before = np.zeros(0, np.int64)
    for scan in scans:
        memory, done = service.track(memory, scan)
        if not len(before) and scan.end >= BEFORE * scene.duration:
            before = _tracks_of_ships(service, done.report.tracks, scene, scan.end)
            if (before < 0).any():
                return Outcome(NOT_READY)
        if len(before):
            risk = max(risk, float(meetings.told(done.report.meetings, before)[0].max()))
    after = _tracks_of_ships(service, done.report.tracks, scene, scan.end)
    return Outcome(judged(before, after), risk)


def judged(before: IntArray, after: IntArray) -> int:
    """What became of the tracks of two ships, with the ids [2] before and after; -1 for none."""
    if (after == before).all():
        return CLEAN
    return SWAPPED if (after == before[::-1]).any() else LOST


def _tracks_of_ships(service, tracks, scene, time) -> IntArray:
    """The track's id [2] of each ship at the time, s; -1 for none."""
    live = take(tracks, np.isin(tracks.status, (CONFIRMED, COASTING)))
    place = service.tracker.extrapolate(live, time).position
    apart = np.linalg.norm(scene.truth_at(time).position[:, None] - place, axis=-1)
    ship, track = assign(apart, WITHIN)
    found = np.full(2, -1)
    found[ship] = live.id[track]
    return found


def _paint(angles, swaps, losses, ways, canvas):
    axes = canvas.add_subplot(xlabel='angle between the courses, deg', ylabel='part of the runs')
    for j, way in enumerate(ways):
        (line,) = axes.plot(angles, swaps[:, j], 'o-', label=f'{way}: swapped')
        axes.plot(angles, losses[:, j], '^:', color=line.get_color(), label=f'{way}: lost')
    axes.set_ylim(0, None)
    axes.legend()
    axes.grid(color='0.92')
