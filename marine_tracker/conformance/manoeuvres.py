"""How turns of own ship or of a target affect course, speed and CPA, under the IMO's errors.

Own ship turns by 45 degrees to either side in one minute, in the four scenarios of A.823. A third
of a minute later the 3-minute limits must be met again. Targets turn at three rates, to measure how
long their course stays wrong after the turn.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..evaluation import parallel
from ..evaluation.result import Progress, silent
from ..geometry import wrap_angle
from ..service import service_for
from ..simulation import radar, scenario
from ..simulation.standard_scenarios import A823_RADAR, REVOLUTION
from ..types import Array
from . import ring_of_ships
from .accuracy import AccuracyTrial, a823_trial

OWN_TURNS = (-45.0, 45.0)  # deg
MET_AGAIN = 20.0  # s after own ship's turn
TURNS = ((0.5, 45.0), (1.0, 60.0), (2.0, 90.0))  # deg/s, deg
BEFORE = 60  # scans before the target's turn
AFTER = 90.0  # s watched after it
RIGHT = 5.0  # deg: the course is right again below this


def own_turns(number: int, after: float = MET_AGAIN) -> list[AccuracyTrial]:
    """The scenario of A.823 judged `after` s after own ship's turn to port, and to starboard."""
    return [a823_trial(number, after, turn) for turn in OWN_TURNS]


class Turn(NamedTuple):
    """Errors of the shown course of R ships that turn, deg; infinite without a track.

    after   [K]        s since the end of the turn
    errors  [E, R, K]  of each estimator
    """

    rate: float
    angle: float
    after: Array
    errors: Array

    @property
    def in_95(self) -> Array:
        """[E, K]: the value that 95 % of the errors do not exceed."""
        return np.quantile(self.errors, 0.95, axis=1, method='inverted_cdf')

    @property
    def right_again(self) -> Array:
        """[E] s from the turn's end until in_95 stays below RIGHT; infinite if never."""
        wrong = (self.in_95 >= RIGHT) & (self.after > 0)
        last = np.where(wrong, np.arange(len(self.after)), -1).max(1)
        first = np.flatnonzero(self.after > 0)[0]
        ended = np.append(self.after, np.inf)
        return ended[np.maximum(last + 1, first)]

    @property
    def before(self) -> Array:
        """[E] deg: in_95 in the last scan before the turn."""
        return self.in_95[:, np.flatnonzero(self.after < -self.angle / self.rate)[-1]]


def target_turns(
    estimators: Sequence[str],
    runs: int,
    seed: int,
    progress: Progress = silent,
    workers: parallel.Workers = None,
) -> list[Turn]:
    """Runs at least `runs` ships for each of TURNS."""
    scenes = -(-runs // ring_of_ships.SHIPS)
    work = [
        parallel.Job(_turn, (rate, angle, estimators, int(number)))
        for kind, (rate, angle) in enumerate(TURNS)
        for number in np.random.SeedSequence([seed, 1, kind]).generate_state(scenes)
    ]
    found = parallel.run(work, workers, progress)
    turns = []
    for kind, (rate, angle) in enumerate(TURNS):
        parts = found[kind * scenes : (kind + 1) * scenes]
        errors = np.concatenate([errors for _, errors in parts], axis=1)
        turns.append(Turn(rate, angle, parts[0][0], errors))
    return turns


def _turn(rate, angle, estimators, seed):
    """Times [K] s after the end of the turn, and errors [E, SHIPS, K] of the relative course."""
    end = BEFORE * REVOLUTION + angle / rate
    loaded = scenario.build(
        ring_of_ships.ring(
            end + AFTER,
            A823_RADAR,
            [
                {'straight': {'duration_s': BEFORE * REVOLUTION}},
                {'turn': {'angle_deg': angle, 'rate_deg_per_s': rate}},
            ],
        ),
        'turning',
    )
    services = [service_for(loaded.tracker_parameters(), estimator=name) for name in estimators]
    memories = [service.start() for service in services]
    errors = np.full((len(services), ring_of_ships.SHIPS, loaded.scans), np.inf)
    times = np.zeros(loaded.scans)
    for k, (scan, _) in enumerate(radar.simulate(loaded, seed)):
        truth = loaded.truth_at(scan.end)
        place = truth.position - loaded.own_ship_at(scan.end).position
        course = np.arctan2(*truth.velocity.T)
        times[k] = scan.end - end
        for row, service in enumerate(services):
            memories[row], output = service.step(memories[row], scan)
            if k < BEFORE // 2:
                continue
            whose = ring_of_ships.owners(output, place)
            off = (
                output.picture.approach.relative_course[whose.row[whose.found]]
                - course[whose.found]
            )
            errors[row, whose.found, k] = np.degrees(np.abs(wrap_angle(off)))
    return times, errors
