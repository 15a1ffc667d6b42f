"""Predicted areas of danger: where own ship, on a steady course at her present speed, would pass a
target within the CPA limit; and the courses that avoid them all.

Each course of own ship has a probability of danger with each target: that of a trial manoeuvre
which turns at once. A target's area has the courses on which it is at least the risk, and on each
of them the stretch of own ship's way on which the target is within the limit. So a course is
dangerous where it crosses an area. Both ships' motion is that of the picture, over ground or
through the water; where the water moves, the areas move with it, as own ship does.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import unit_vector
from ..types import Array, BoolArray, IntArray
from .cpa import HAIR, LEAST_SPEED, OwnMotion, cpa_of
from .miss_distance import danger_probability
from .motion import Motion
from .trial_manoeuvre import check_limits, may_meet

RISK = 0.05  # the probability of danger from which a course counts as dangerous
STEP = np.radians(0.5)
COURSES = STEP * np.arange(720)  # where areas are looked for
POINTS = 24  # courses of an area's outline
HALVINGS = 6  # of STEP, to find the edges of an area
WIDE = 2.0  # deviations of the time of passing by which an area is longer
AT_ONCE = 2000  # integrals at once, to fit into a cache


class DangerAreas(NamedTuple):
    """A areas, one for each target and run of dangerous courses.

    row          [A]      of the target
    course       [A, P]   rad, ascending from one edge of the area to the other; may exceed 2 pi
    near, far    [A, P]   m from own ship: the stretch of each course that is in the area
    probability  [A, P]   of passing within the limit, on each course
    """

    row: IntArray
    course: Array
    near: Array
    far: Array
    probability: Array


class Dangers(NamedTuple):
    """What lies ahead of own ship on every course.

    course       [C]  rad, COURSES
    probability  [C]  that at least one target passes within the limit
    safe         [C]  whether it is below the risk
    areas        one or more for each target that can be met
    """

    course: Array
    probability: Array
    safe: BoolArray
    areas: DangerAreas


def dangers(
    motion: Motion, own: OwnMotion, cpa_limit: float, tcpa_limit: float, risk: float = RISK
) -> Dangers:
    """The areas of N targets and the safe courses of own ship at her present speed.

    cpa_limit m, tcpa_limit s: those of the alarm; risk: a probability. Targets with unknown motion,
    and own ship while she makes no way, have no areas. A target that only goes away is no danger.
    ValueError names what is not possible.
    """
    check_limits(cpa_limit, tcpa_limit)
    if not 0 < risk < 1:
        raise ValueError(f'risk is {risk:g}; it must be between 0 and 1')
    if not np.isfinite(own.velocity).all():
        raise ValueError(f'own ship makes {own.velocity} m/s; areas of danger need her velocity')
    meeting = _Meeting(motion, own, cpa_limit, tcpa_limit)
    found = meeting.everywhere()  # [C, N]
    probability = 1 - np.prod(1 - found, 1)
    if meeting.speed < LEAST_SPEED:
        row, first, last = np.zeros(0, np.int64), np.zeros(0), np.zeros(0)
    else:
        row, first, last = meeting.edges(found >= risk, risk)
    course = first[:, None] + (last - first)[:, None] * np.linspace(0, 1, POINTS)
    rows = np.repeat(row, POINTS)
    near, far = meeting.stretch(course.ravel(), rows)
    areas = DangerAreas(
        row,
        course,
        near.reshape(course.shape),
        far.reshape(course.shape),
        meeting.probability(course.ravel(), rows).reshape(course.shape),
    )
    return Dangers(COURSES, probability, probability < risk, areas)


class _Meeting:
    """Own ship on any course, and the targets; positions and velocities are relative to her now."""

    def __init__(self, motion: Motion, own: OwnMotion, limit: float, within: float) -> None:
        self.limit, self.within = limit, within
        self.speed = float(np.hypot(*own.velocity))
        self.known = np.flatnonzero(np.isfinite(motion.position).all(1))
        self.position = motion.position - own.position
        self.velocity = motion.velocity
        self.covariance = motion.covariance + own.covariance + HAIR * np.eye(4)

    def relative(self, course: Array, row: IntArray) -> Array:
        """Relative velocities [..., 2] m/s of targets at the rows while own ship is on a course."""
        found: Array = self.velocity[row] - self.speed * unit_vector(course)
        return found

    def probability(self, course: Array, row: IntArray) -> Array:
        """[K] of danger with the targets at the rows [K], on the courses [K] rad."""
        velocity, out = self.relative(course, row), np.zeros(len(row))
        moves = np.flatnonzero(np.hypot(*velocity.T) >= LEAST_SPEED)
        for k in range(0, len(moves), AT_ONCE):
            some = moves[k : k + AT_ONCE]
            its = row[some]
            out[some] = danger_probability(
                self.position[its], velocity[some], self.covariance[its], self.limit, self.within
            )
        return out

    def everywhere(self) -> Array:
        """[C, N] probability on every one of COURSES."""
        found = np.zeros((len(COURSES), len(self.position)))
        position, covariance = self.position[self.known], self.covariance[self.known]
        velocity = self.relative(COURSES[:, None], self.known)  # [C, K, 2]
        course, target = may_meet(
            np.broadcast_to(position, velocity.shape), velocity, covariance, self.limit
        ).nonzero()
        row = self.known[target]
        found[course, row] = self.probability(COURSES[course], row)
        return found

    def edges(self, inside: BoolArray, risk: float) -> tuple[IntArray, Array, Array]:
        """Rows [A] of the targets, first and last course [A] rad of each run of courses [C, N]."""
        row, first = (inside & ~np.roll(inside, 1, 0)).T.nonzero()
        other, last = (inside & ~np.roll(inside, -1, 0)).T.nonzero()
        # A run that goes through north ends with the first end of its target, not the next.
        begins = np.searchsorted(row, row)
        through = last[begins] < first[begins]
        place = np.arange(len(row)) - begins
        last = last[begins + (place + through) % np.bincount(row, minlength=1)[row]]
        last = last + len(COURSES) * (last < first)
        whole = np.flatnonzero(inside.all(0))
        return (
            np.append(row, whole),
            np.append(self._edge(first * STEP, -STEP, row, risk), 0 * whole),
            np.append(self._edge(last * STEP, STEP, row, risk), np.full(len(whole), 2 * np.pi)),
        )

    def _edge(self, inside: Array, outwards: float, row: IntArray, risk: float) -> Array:
        """Courses [A] rad where the probability is the risk, from those inside, by halving."""
        low, high = inside, inside + outwards
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            within = self.probability(middle, row) >= risk
            low, high = np.where(within, middle, low), np.where(within, high, middle)
        return low

    def stretch(self, course: Array, row: IntArray) -> tuple[Array, Array]:
        """Own ship's way [K], [K] m to the beginning and the end of the area, on the courses [K].

        The target is within the limit while its mean track is; earlier and later by WIDE deviations
        of the time at which it is nearest.
        """
        velocity, position = self.relative(course, row), self.position[row]
        cpa, tcpa = cpa_of(position, velocity)
        speed = np.hypot(*velocity.T)
        moves = speed >= LEAST_SPEED
        speed, tcpa = np.where(moves, speed, 1.0), np.where(moves, tcpa, 0.0)
        along, covariance = velocity / speed[:, None], self.covariance[row]
        ahead = np.clip(tcpa, 0.0, self.within)[:, None]
        error = np.concatenate([along, ahead * along], 1)  # of the place along the track, then
        variance = np.einsum('ki,kij,kj->k', error, covariance, error)
        half = np.sqrt(np.maximum(self.limit**2 - cpa**2, 0.0) + WIDE**2 * variance) / speed
        half = np.where(moves, half, self.within)
        return (
            self.speed * np.clip(tcpa - half, 0.0, self.within),
            self.speed * np.clip(tcpa + half, 0.0, self.within),
        )
