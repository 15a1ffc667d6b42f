"""Clutter: is the picture clean, and are the ships in it?

Scenes of the simulator (config/scenarios), so the truth is known: a harbour and a canal full of
plots that are always there, straits, small craft, false plots. Tracks that are confirmed or coast
count. A track is false if no ship is within the scene's cutoff; moored craft, quays and buoys are
no ships here, so tracks on them are false. A ship is held while a track is within the cutoff; one
at rest also while a stationary object is.
Confirmation time counts from a ship's first scan in range to its first track; its median is over
all ships of all runs.
"""

from typing import Any, NamedTuple

import numpy as np

from ...evaluation import parallel, report
from ...evaluation.gospa import assign, gospa_parts
from ...evaluation.result import Progress, Result, silent
from ...service import Tracking, service_for
from ...simulation import radar, scenario
from ...tracking.lifecycle import COASTING, CONFIRMED
from ...types import Array, Truth

HELP = 'scenes with truth: GOSPA, ships held, time of confirmation, false tracks'
RUNS = 10
OPTIONS = {
    'estimator': {'default': 'gwnn', 'help': 'filter of the tracker (default gwnn)'},
    'scenes': {'nargs': '+', 'help': 'only these scenes (default: all)'},
}
# Cutoff of each scene, m: some four deviations of a plot at half the range.
SCENES = {
    'busy_harbour': 50.0,
    'canal': 25.0,
    'busy_strait': 200.0,
    'crowded_strait': 150.0,
    'agile_boat': 100.0,
    'two_boats': 25.0,
    'false_plots': 200.0,
}
STILL = 0.3  # m/s; a ship slower than this may be shown as a stationary object
# Of a scene: what must be reached.
FALSE_ALIVE = {'false_plots': 0.1, 'busy_strait': 0.5}
HELD = {'false_plots': 0.97, 'busy_strait': 0.989}
CONFIRMED_AFTER = {'false_plots': 5.0}  # scans


class Run(NamedTuple):
    """One run of a scene.

    gospa, without_false  m, means over the scans
    held       [S]  part of its scans in range in which each ship S was held
    confirmed  [S]  scans from the first in range to the first track, both counted; nan: never
    false      mean number of false tracks alive
    numbers    target numbers ever given
    rmse       m, of the positions of ships that were held
    """

    gospa: float
    without_false: float
    held: Array
    confirmed: Array
    false: float
    numbers: int
    rmse: float = np.nan


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    estimator: str = 'gwnn',
    scenes: list[str] | None = None,
    workers: parallel.Workers = None,
) -> Result:
    """Every scene `runs` times with the shipped defaults. ValueError for an unknown scene."""
    names = chosen(scenes)
    jobs = [
        parallel.Job(follow, (name, estimator, seed + k)) for name in names for k in range(runs)
    ]
    found = parallel.run(jobs, workers, progress)
    figures: list[report.Figure] = []
    for k, name in enumerate(names):
        figures += _figures(name, found[k * runs : (k + 1) * runs])
    return Result(figures)


def chosen(scenes: list[str] | None) -> list[str]:
    """The scenes, or all. ValueError for an unknown one."""
    for name in scenes or []:
        if name not in SCENES:
            raise ValueError(f'there is no scene {name}; there are {", ".join(SCENES)}')
    return list(SCENES) if scenes is None else scenes


def follow(name: str, estimator: str, seed: int, **values: Any) -> Run:
    """One run of a scene, with these values of tracker parameters."""
    scene = scenario.load(name)
    cutoff = SCENES[name]
    service = service_for(scene.tracker_parameters(), estimator=estimator, **values)
    memory = service.start()
    ships = len(scene.fleet.names)
    in_range, held, first = np.zeros(ships, int), np.zeros(ships, int), np.full(ships, np.nan)
    parts, false, squared = [], [], []
    for scan, truth in radar.simulate(scene, seed):
        memory, done = service.track(memory, scan)
        distance = apart(truth, done, cutoff)
        seen = scenario.detectable(scene, truth)
        row, column = assign(distance, cutoff)
        aside = column[~seen[row]]  # on ships just out of range: neither right nor wrong
        distance = np.delete(distance[seen], aside, 1)
        row, column = assign(distance, cutoff)
        parts.append(gospa_parts(distance, cutoff))
        false.append(distance.shape[1] - len(column))
        ship = truth.target[seen] - 1
        in_range[ship] += 1
        held[ship[row]] += 1
        squared.append(np.square(distance[row, column]))
        first[ship[row]] = np.fmin(first[ship[row]], in_range[ship[row]])
    squares = np.array(parts)
    there = in_range > 0
    return Run(
        float(np.sqrt(squares.sum(1)).mean()),
        float(np.sqrt(squares[:, :2].sum(1)).mean()),
        held[there] / in_range[there],
        first[there],
        float(np.mean(false)),
        memory.tracker.next_number - 1,
        float(np.sqrt(np.concatenate(squared).mean())),
    )


def apart(truth: Truth, done: Tracking, cutoff: float) -> Array:
    """Distances [ships, live tracks] m, at the times of the truth; then those of the stationary
    objects that stand for a ship at rest."""
    live = np.isin(done.report.tracks.status, (CONFIRMED, COASTING))
    later = truth.time[:, None] - done.estimate.time[live]
    moved = done.estimate.position[live] + later[..., None] * done.estimate.velocity[live]
    distance: Array = np.linalg.norm(moved - truth.position[:, None], axis=-1)
    fixed = np.linalg.norm(done.report.places.position - truth.position[:, None], axis=-1)
    fixed[np.hypot(*truth.velocity.T) > STILL] = np.inf
    without = distance.min(1, initial=np.inf) >= cutoff
    row, column = assign(fixed[without], cutoff)
    return np.append(distance, fixed[:, column], 1)


def _figures(name: str, runs: list[Run]) -> list[report.Figure]:
    ships = np.concatenate([run.held for run in runs])
    waits = np.concatenate([run.confirmed for run in runs])

    def mean(what: str) -> float:
        return float(np.mean([getattr(run, what) for run in runs]))

    def demanded(what: str, value: float, unit: str, limits: dict[str, float], judge):
        title = f'{name}: {what}'
        if name not in limits:
            return report.Figure(title, value, unit)
        return judge(title, value, limits[name], unit)

    return [
        report.Figure(f'{name}: GOSPA', mean('gospa'), 'm'),
        report.Figure(f'{name}: GOSPA without its false part', mean('without_false'), 'm'),
        demanded('false tracks alive', mean('false'), '', FALSE_ALIVE, report.at_most),
        demanded('held, mean of the ships', float(ships.mean()), '', HELD, report.at_least),
        report.Figure(f'{name}: held, the worst ship', float(ships.min())),
        report.Figure(f'{name}: ships never held', int(np.isnan(waits).sum())),
        demanded(
            'confirmation, median',
            float(np.nanmedian(waits)),
            'scans',
            CONFIRMED_AFTER,
            report.at_most,
        ),
        report.Figure(f'{name}: target numbers given', mean('numbers'), 'a run'),
    ]
