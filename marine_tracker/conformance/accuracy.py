"""Accuracy of course, speed and CPA under the IMO's test conditions, compared with their limits.

The four scenarios and the sensor errors are those of resolution A.823(19), appendices 2 and 3. The
limits are those of A.823 and of MSC.192(79). An error figure is the one that 95 of 100 runs do not
exceed. The radar's plots go through the whole service (service.py). Also, a straight line is fitted
to the same plots. The fit knows that the target keeps its course, so no tracker can do much better.

Relative figures come from the radar. True course and speed are the relative ones plus own ship's,
from a gyro and a log with the errors of the standard. Own ship's position is dead-reckoned from the
same gyro and log. Tracks drift with it, so their motion relative to own ship has no error from it.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..arpa.cpa import cpa_of
from ..evaluation import parallel
from ..evaluation.result import Progress, silent
from ..geometry import KNOT, NAUTICAL_MILE, locate, wrap_angle
from ..service import Output, service_for
from ..simulation import radar, scenario, standard_scenarios
from ..types import Array, Scan
from .ring_of_ships import shown

FIGURES = ('relative course', 'relative speed', 'CPA', 'TCPA', 'true course', 'true speed')
UNITS = ('deg', 'kn', 'NM', 'min', 'deg', 'kn')
IN_UNITS = 1 / np.array([np.radians(1), KNOT, NAUTICAL_MILE, 60.0, np.radians(1), KNOT])
ANGLES = np.array([True, False, False, False, True, False])
MINUTES = (1, 3)
NONE = np.nan  # no limit

# A823: limits of A.823 by minutes of steady tracking and scenario. MSC192: limits for any target.
A823: dict[int, dict[int, tuple[float, ...]]] = {
    1: {
        1: (11, 2.8, 1.6, NONE, NONE, NONE),
        2: (7, 0.6, NONE, NONE, NONE, NONE),
        3: (14, 2.2, 1.8, NONE, NONE, NONE),
        4: (15, 1.5, 2.0, NONE, NONE, NONE),
    },
    3: {
        1: (3.0, 0.8, 0.5, 1.0, 7.4, 1.2),
        2: (2.3, 0.3, NONE, NONE, 2.8, 0.8),
        3: (4.4, 0.9, 0.7, 1.0, 3.3, 1.0),
        4: (4.6, 0.8, 0.7, 1.0, 2.6, 1.2),
    },
}
MSC192 = {1: (11, 1.5, 1.0, NONE, NONE, NONE), 3: (3, 0.8, 0.3, 0.5, 5, 0.5)}
MSC192_SHARE = {1: 0.10, 3: 0.01}  # of the speed; used where that is more than the limit in knots

CHUNK = 10  # runs a job


class Outcome(NamedTuple):
    """R runs of one scenario with W methods: the straight-line fit, then each estimator.

    truth   [6]        of FIGURES, in rad, m/s, m, s
    found   [R, W, 6]  likewise; nan without a track
    """

    truth: Array
    found: Array

    @property
    def errors(self) -> Array:
        """[R, W, 6] in UNITS; infinite without a track."""
        off = self.found - self.truth
        off = np.abs(np.where(ANGLES, wrap_angle(off), off)) * IN_UNITS
        return np.where(np.isnan(off), np.inf, off)

    @property
    def in_95(self) -> Array:
        """[W, 6]: the value that 95 % of the errors do not exceed."""
        return np.quantile(self.errors, 0.95, axis=0, method='inverted_cdf')


def a823_limits(number: int, minutes: int) -> Array:
    """[6] in UNITS, nan where A.823 has no limit."""
    return np.array(A823[minutes][number])


def msc192_limits(truth: Array, minutes: int) -> Array:
    """[6] in UNITS for the true figures [6], nan where there is no limit.

    Limits of speeds are a share of the speed if that is more.
    """
    limits = np.array(MSC192[minutes], dtype=float)
    speeds = [1, 5]
    limits[speeds] = np.maximum(limits[speeds], MSC192_SHARE[minutes] * (truth * IN_UNITS)[speeds])
    return limits


def figures_of(position: Array, velocity: Array, true_velocity: Array) -> Array:
    """FIGURES [..., 6] from relative position [..., 2] m and relative and true velocity [..., 2]
    m/s.
    """
    return np.stack(
        [
            np.arctan2(velocity[..., 0], velocity[..., 1]),
            np.hypot(velocity[..., 0], velocity[..., 1]),
            *cpa_of(position, velocity),
            np.arctan2(true_velocity[..., 0], true_velocity[..., 1]),
            np.hypot(true_velocity[..., 0], true_velocity[..., 1]),
        ],
        -1,
    )


def told(output: Output, place: Array) -> Array:
    """FIGURES [6] of the shown target nearest to `place` [2] m from own ship, or nan."""
    approach, place_of = output.picture.approach, shown(output)
    if np.isnan(place_of).all():
        return np.full(6, np.nan)
    row = np.nanargmin(np.hypot(*(place_of - place).T))
    return np.array(
        [
            column[row]
            for column in (
                approach.relative_course,
                approach.relative_speed,
                approach.cpa,
                approach.tcpa,
                approach.course,
                approach.speed,
            )
        ]
    )


class AccuracyTrial(NamedTuple):
    """One trial: a scenario's mapping, and when its target is judged.

    moment        s, the end of a revolution
    steady_since  s, own ship's course is steady from here on
    """

    values: dict[str, Any]
    moment: float
    steady_since: float = 0.0


def a823_trial(number: int, judged_after: float, own_turn_deg: float = 0.0) -> AccuracyTrial:
    """A scenario of A.823 judged some seconds after acquisition, or after own ship's turn."""
    moment = standard_scenarios.judged_at(judged_after, own_turn_deg)
    return AccuracyTrial(
        standard_scenarios.a823(number, judged_after, own_turn_deg, moment),
        moment,
        standard_scenarios.judged_at(0.0, own_turn_deg) if own_turn_deg else 0.0,
    )


def judged(trial: AccuracyTrial) -> Array:
    """The true FIGURES [6] of a trial's only target when it is judged."""
    loaded = scenario.build(trial.values, 'trial')
    truth, own = loaded.truth_at(trial.moment), loaded.own_ship_at(trial.moment)
    return figures_of(
        truth.position[0] - own.position[0], truth.velocity[0] - own.velocity[0], truth.velocity[0]
    )


def follow(trial: AccuracyTrial, estimators: Sequence[str], seeds: Sequence[int]) -> Array:
    """FIGURES [R, W, 6] of the fit, and of the service with each estimator, in R runs."""
    loaded = scenario.build(trial.values, 'trial')
    services = [service_for(loaded.tracker_parameters(), estimator=name) for name in estimators]
    truth = loaded.truth_at(trial.moment)
    place = truth.position[0] - loaded.own_ship_at(trial.moment).position[0]
    found = np.full((len(seeds), 1 + len(services), 6), np.nan)
    for run, seed in enumerate(seeds):
        scans = [scan for scan, _ in radar.simulate(loaded, seed)]
        found[run, 0] = fit(scans, trial.steady_since)
        for column, service in enumerate(services, 1):
            memory = service.start()
            for scan in scans:
                memory, output = service.step(memory, scan)
            found[run, column] = told(output, place)
    return found


def fit(scans: Sequence[Scan], steady_since: float) -> Array:
    """FIGURES [6] at the end of the last scan by a straight line through all plots.

    The plots are placed by the reckoned own ship, whose velocity is its mean since `steady_since`.
    """
    plots = [locate(scan.plots, scan.own_ship, 1.0, 0.0) for scan in scans]
    time = np.concatenate([p.time for p in plots]) - scans[-1].end
    place = np.concatenate([p.position for p in plots])
    (at, velocity), *_ = np.linalg.lstsq(np.stack([np.ones_like(time), time], 1), place)
    own = [scan.own_ship for scan in scans if scan.start >= steady_since - 1e-6]
    went = own[-1].position[-1] - own[0].position[0]
    own_velocity = went / (own[-1].time[-1] - own[0].time[0])
    return figures_of(at - own[-1].position[-1], velocity - own_velocity, velocity)


def run(
    trials: Sequence[AccuracyTrial],
    estimators: Sequence[str],
    runs: int,
    seed: int,
    progress: Progress = silent,
    workers: parallel.Workers = None,
) -> list[Outcome]:
    """Runs each trial `runs` times. The result depends on seed and runs only."""
    work, whose = [], []
    for number, trial in enumerate(trials):
        seeds = np.random.SeedSequence([seed, number]).generate_state(runs, np.uint64).tolist()
        for first in range(0, runs, CHUNK):
            work.append(parallel.Job(follow, (trial, estimators, seeds[first : first + CHUNK])))
            whose.append(number)
    found = parallel.run(work, workers, progress)
    return [
        Outcome(
            judged(trial),
            np.concatenate([part for part, number in zip(found, whose) if number == one]),
        )
        for one, trial in enumerate(trials)
    ]
