"""Imazu's 22 encounters through the whole service: is each target acquired and warned of in time?

Every target is on a collision course: the true CPA is 0, and the true TCPA is the time left. Two
things are judged: the CPA and TCPA shown three minutes after a target was acquired, and the time of
its danger alarm. At the alarm more than six minutes must be left.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..arpa.alarms import DANGER
from ..arpa.alerts import ACTIVE_UNACKNOWLEDGED
from ..evaluation import parallel
from ..evaluation.result import Progress, silent
from ..geometry import NAUTICAL_MILE
from ..service import service_for
from ..simulation import radar, scenario
from ..simulation.standard_scenarios import IMAZU
from ..types import Array
from .ring_of_ships import owners

JUDGED_AFTER = 180.0  # s after acquisition
WARNED_BEFORE = 360.0  # s of TCPA


class Encounter(NamedTuple):
    """Results for T targets in R runs with E estimators.

    acquired  [E, R, T]  s, when it became a target; infinite for never
    warned    [E, R, T]  s of true TCPA left when its alarm was raised; -inf if never or too late
    cpa       [E, R, T]  NM, error after 3 minutes; infinite if it was not a target then
    tcpa      [E, R, T]  min, likewise
    """

    number: int
    acquired: Array
    warned: Array
    cpa: Array
    tcpa: Array


def run(
    estimators: Sequence[str],
    runs: int,
    seed: int,
    progress: Progress = silent,
    workers: parallel.Workers = None,
) -> list[Encounter]:
    """Runs every encounter `runs` times."""
    numbers = range(1, len(IMAZU) + 1)
    work = [
        parallel.Job(follow, (number, estimators, int(of_run)))
        for number in numbers
        for of_run in np.random.SeedSequence([seed, 2, number]).generate_state(runs)
    ]
    found = parallel.run(work, workers, progress)
    return [
        Encounter(number, *np.stack(found[first : first + runs], 2))
        for number, first in zip(numbers, range(0, len(found), runs))
    ]


def follow(number: int, estimators: Sequence[str], seed: int) -> Array:
    """[4, E, T]: the arrays of Encounter, of one run."""
    loaded = scenario.load(f'imazu_{number:02d}')
    services = [service_for(loaded.tracker_parameters(), estimator=name) for name in estimators]
    memories = [service.start() for service in services]
    shape = (len(services), len(loaded.fleet.names))
    acquired, cpa, tcpa = np.full((3, *shape), np.inf)
    warned = np.full(shape, -np.inf)
    for scan, _ in radar.simulate(loaded, seed):
        left = loaded.duration - scan.end
        if left < WARNED_BEFORE:
            break
        place = loaded.truth_at(scan.end).position - loaded.own_ship_at(scan.end).position
        for e, service in enumerate(services):
            memories[e], output = service.step(memories[e], scan)
            picture = output.picture
            row, found = owners(output, place)
            new = found & np.isinf(acquired[e])
            acquired[e, new] = picture.targets.since[row[new]]
            alarms = picture.alerts.id[
                (picture.alerts.kind == DANGER) & (picture.alerts.state == ACTIVE_UNACKNOWLEDGED)
            ]
            now = found & np.isinf(warned[e])
            now[now] = np.isin(picture.targets.id[row[now]], alarms)
            warned[e, now] = left
            now = found & (scan.end >= acquired[e] + JUDGED_AFTER) & np.isinf(cpa[e])
            cpa[e, now] = picture.approach.cpa[row[now]] / NAUTICAL_MILE
            tcpa[e, now] = np.abs(picture.approach.tcpa[row[now]] - left) / 60
    return np.stack([acquired, warned, cpa, tcpa])
