"""Target loss: a target seen in five of ten scans is kept; one that disappears is soon called lost.

In every ten scans the target has five plots. Which scans these are is drawn again each time, so it
can be missing for ten scans in a row. After ten minutes it disappears.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..evaluation import parallel
from ..evaluation.result import Progress, silent
from ..service import service_for
from ..simulation import radar, scenario
from ..simulation.standard_scenarios import REVOLUTION, ROTATION
from ..tracking.lifecycle import LOST
from ..types import Array, BoolArray, take
from . import ring_of_ships

BEGIN, MINUTES, AFTER = 10, 10, 14  # scans seen; minutes of gaps; scans unseen
SHOWN, OF = 5, 10


class Kept(NamedTuple):
    """R targets: kept [E, R] for ten minutes, and the scan [E, R] without a plot that ended it.

    ended is infinite if the target was never called lost, nan if it was not kept for ten minutes
    """

    kept: Array
    ended: Array


def run(
    estimators: Sequence[str],
    runs: int,
    seed: int,
    progress: Progress = silent,
    workers: parallel.Workers = None,
) -> Kept:
    """Runs at least `runs` targets."""
    scenes = -(-runs // ring_of_ships.SHIPS)
    work = [
        parallel.Job(_follow, (estimators, int(of_scene)))
        for of_scene in np.random.SeedSequence([seed, 3]).generate_state(scenes)
    ]
    found = parallel.run(work, workers, progress)
    return Kept(*(np.concatenate(column, axis=1) for column in zip(*found)))


def pattern(scans: int, count: int, rng: np.random.Generator) -> BoolArray:
    """[scans, count] whether each target has a plot: SHOWN times in every OF scans."""
    blocks = -(-scans // OF)
    shows = np.tile(np.arange(OF) < SHOWN, (blocks, count, 1))
    return rng.permuted(shows, axis=2).transpose(0, 2, 1).reshape(-1, count)[:scans]


def _follow(estimators, seed):
    """kept and ended [E, SHIPS] of one scene."""
    gaps = round(MINUTES * 60 / REVOLUTION)
    scans = BEGIN + gaps + AFTER
    loaded = scenario.build(
        ring_of_ships.ring(
            scans * REVOLUTION, {'rotation_rpm': ROTATION, 'pd_near': 1, 'pd_far': 1}, []
        ),
        'gaps',
    )
    ships = ring_of_ships.SHIPS
    shows = np.concatenate(
        [
            np.ones((BEGIN, ships), bool),
            pattern(gaps, ships, np.random.default_rng(seed)),
            np.zeros((AFTER, ships), bool),
        ]
    )
    services = [service_for(loaded.tracker_parameters(), estimator=name) for name in estimators]
    memories = [service.start() for service in services]
    numbers = np.zeros((len(services), ships), np.int64)  # the ships' target numbers
    kept = np.ones((len(services), ships), bool)
    last = np.zeros(ships, np.int64)
    ended = np.full((len(services), ships), np.inf)
    for k, (scan, truth) in enumerate(radar.simulate(loaded, seed)):
        last[shows[k]] = k
        # Ships lie 15 degrees apart and plots have errors of half a degree: the nearest ship owns
        # the plot.
        apart = np.abs(scan.plots.bearing[:, None] - np.arctan2(*truth.position.T)) % (2 * np.pi)
        whose = np.minimum(apart, 2 * np.pi - apart).argmin(1)
        scan = scan._replace(plots=take(scan.plots, shows[k, whose]))
        for e, service in enumerate(services):
            memories[e], output = service.step(memories[e], scan)
            tracks = output.report.tracks
            if k == BEGIN - 1:
                numbers[e] = _numbers(output, truth, loaded)
                kept[e] = numbers[e] > 0
            alive = np.isin(numbers[e], tracks.number[tracks.status != LOST])
            if k < BEGIN + gaps:
                kept[e] &= alive | (k < BEGIN)
            else:
                gone = np.isin(numbers[e], tracks.number[tracks.status == LOST])
                ended[e, gone] = k - last[gone]
    return kept, np.where(kept, ended, np.nan)


def _numbers(output, truth, loaded):
    """[SHIPS] number of each ship's target, 0 if it has none."""
    row, found = ring_of_ships.owners(
        output, truth.position - loaded.own_ship_at(truth.time).position
    )
    number = output.picture.targets.number
    return np.where(found, np.append(number, 0)[np.where(found, row, -1)], 0)
