"""The effect of a manoeuvre of own ship on every target at once.

Targets keep course and speed; own ship follows the path of own_path.py. Nothing here affects the
tracking, which continues with the real motion.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing, wrap_angle
from ..types import Array, BoolArray, IntArray, take
from .cpa import HAIR, LEAST_SPEED, OwnMotion, cpa_of
from .miss_distance import danger_probability
from .motion import Motion
from .own_path import Path, TrialManoeuvre, paths

AT_ONCE = 100_000  # distances computed at once, to fit into a cache
COURSES = np.radians(np.arange(360.0))


class TrialApproach(NamedTuple):
    """How N targets pass under a trial.

    cpa                 [N]  m
    tcpa                [N]  s from now; negative for a target that only moves away (its CPA is then
                             that of the present motion); nan with almost no relative motion
    danger_probability  [N]  P(CPA < its limit and 0 <= TCPA < its limit)

    For a target with unknown motion: nan, nan, 0. A trial without any change gives the same as
    `cpa.approach`.
    """

    cpa: Array
    tcpa: Array
    danger_probability: Array


class SafeCourses(NamedTuple):
    """Which of 360 courses are safe.

    course       [360]     rad, every whole degree
    probability  [360]     that at least one target passes within the limits
    cpa          [360]     m, of the target that passes nearest; inf without targets
    nearest      [360]     row of that target; -1 without targets
    safe         [360]     whether the probability is below the risk
    sectors      [S, 2]    rad, first and last course of each safe sector, clockwise
    """

    course: Array
    probability: Array
    cpa: Array
    nearest: IntArray
    safe: BoolArray
    sectors: Array


def trial_approach(
    motion: Motion, own: OwnMotion, trial: TrialManoeuvre, cpa_limit: float, tcpa_limit: float
) -> TrialApproach:
    """CPA, TCPA and danger of the N targets under the trial; limits in m and s (inf for none).

    ValueError names the value of the trial, or the limit, that is not possible.
    """
    every = _approaches(motion, own, trial, np.array([trial.course]), cpa_limit, tcpa_limit)
    return TrialApproach(*(values[0] for values in every))


def safe_courses(
    motion: Motion,
    own: OwnMotion,
    trial: TrialManoeuvre,
    cpa_limit: float,
    tcpa_limit: float = np.inf,
    risk: float = 0.05,
) -> SafeCourses:
    """The courses that keep the probability of danger below the risk; all else as in the trial.

    Targets with unknown motion are left out. The dangers of several targets count as independent.
    """
    if not 0 < risk < 1:
        raise ValueError(f'risk is {risk:g}; it must be between 0 and 1')
    every = _approaches(motion, own, trial, COURSES, cpa_limit, tcpa_limit)
    probability = 1 - np.prod(1 - every.danger_probability, 1)
    nearest, cpa = np.full(len(COURSES), -1), np.full(len(COURSES), np.inf)
    known = np.flatnonzero(~np.isnan(every.cpa).any(0))
    if len(known):
        # A target that only moves away is nearest now, whatever its CPA was.
        now = np.hypot(*(motion.position - own.position).T)
        ahead = np.where(every.tcpa < 0, now, every.cpa)[:, known]
        nearest, cpa = known[ahead.argmin(1)], ahead.min(1)
    safe = probability < risk
    return SafeCourses(COURSES, probability, cpa, nearest, safe, _sectors(safe))


def check_limits(cpa_limit: float, tcpa_limit: float) -> None:
    """ValueError for a limit, m or s, that is not above 0; inf is no limit."""
    for name, limit, unit in (('CPA', cpa_limit, 'm'), ('TCPA', tcpa_limit, 's')):
        if not limit > 0:
            raise ValueError(f'{name} limit is {limit:g} {unit}; it must be above 0')


def _approaches(
    motion: Motion,
    own: OwnMotion,
    trial: TrialManoeuvre,
    courses: Array,
    cpa_limit: float,
    tcpa_limit: float,
) -> TrialApproach:
    """[C, N] of each course and target."""
    check_limits(cpa_limit, tcpa_limit)
    path = paths(own, trial, courses)
    known = np.flatnonzero(np.isfinite(motion.position).all(1))
    count = max(AT_ONCE // (path.time.shape[1] * max(len(known), 1)), 1)
    parts = [
        _nearest(
            take(motion, known),
            own,
            Path(*(part[k : k + count] for part in path)),
            cpa_limit,
            tcpa_limit,
        )
        for k in range(0, len(courses), count)
    ]
    every = []
    for unknown, columns in zip((np.nan, np.nan, 0.0), zip(*parts)):
        values = np.full((len(courses), len(motion.position)), unknown)
        values[:, known] = np.concatenate(columns)
        every.append(values)
    return TrialApproach(*every)


def _nearest(
    motion: Motion, own: OwnMotion, path: Path, cpa_limit: float, tcpa_limit: float
) -> TrialApproach:
    """[C, N]: the nearest point of each of C paths to each target."""
    shape = len(path.time), len(motion.position)
    # East and north first, [2, C, N, K]: sums of whole arrays cost a third of sums along the last
    # axis.
    time = path.time[:, None]  # [C, 1, K]
    position, velocity = motion.position.T[..., None], motion.velocity.T[..., None]
    offset = (
        position[:, None] + time * velocity[:, None] - path.position.transpose(2, 0, 1)[:, :, None]
    )
    length = np.diff(path.time, append=np.inf)[:, None]  # [C, 1, K]
    relative = np.zeros_like(offset)
    np.divide(np.diff(offset), length[..., :-1], out=relative[..., :-1], where=length[..., :-1] > 0)
    relative[..., -1] = velocity.transpose(0, 2, 1) - path.velocity.T[..., None]
    squared = _dot(relative, relative)
    into = np.divide(
        -_dot(offset, relative), squared, out=np.zeros_like(squared), where=squared > 0
    )
    into = np.minimum(np.maximum(into, 0), length)
    reached = offset + into * relative
    best = np.where(length > 0, _dot(reached, reached), np.inf).argmin(-1)  # [C, N]
    course, target = np.ogrid[: shape[0], : shape[1]]

    def at(moment: int | IntArray, values: Array) -> Array:
        """[C, N, 2] of values [2, C, N, K] at the moments [C, N]."""
        moved: Array = values[:, course, target, moment]
        return moved.transpose(1, 2, 0)

    there, moving = at(best, reached), at(best, relative)
    tcpa = path.time[course, best] + into[course, target, best]
    # Nearest now: the target only goes away, and the past tells when it was nearer.
    gone = tcpa == 0
    moving = np.where(gone[..., None], at((length > 0).argmax(-1), relative), _abeam(moving, there))
    before = np.where(gone[..., None], at(0, offset), there - tcpa[..., None] * moving)
    cpa, past = cpa_of(before, moving)
    tcpa = np.where(gone, past, tcpa)
    fastest = np.sqrt(np.where(length > 0, squared, 0.0).max(-1))
    moves = np.where(gone, np.hypot(moving[..., 0], moving[..., 1]), fastest) >= LEAST_SPEED
    covariance = motion.covariance + own.covariance + HAIR * np.eye(4)
    c, n = np.nonzero(moves & may_meet(before, moving, covariance, cpa_limit))
    danger = np.zeros(shape)
    danger[c, n] = danger_probability(
        before[c, n], moving[c, n], covariance[n], cpa_limit, tcpa_limit
    )
    return TrialApproach(cpa, np.where(moves, tcpa, np.nan), danger)


def _dot(first: Array, second: Array) -> Array:
    """Products [...] of vectors [2, ...]."""
    found: Array = first[0] * second[0] + first[1] * second[1]
    return found


def may_meet(position: Array, velocity: Array, covariance: Array, cpa_limit: float) -> BoolArray:
    """Whether [C, N] a target may pass within the limit, with a margin of 6 deviations of all
    errors.

    position, velocity [C, N, 2] relative to own ship, covariance [N, 4, 4]. Few courses meet few
    targets. So this saves nine tenths of the integrals of `danger_probability`.
    """
    place, speed = (6 * np.sqrt(covariance[:, [k, k + 1], [k, k + 1]].sum(1)) for k in (0, 2))
    distance, from_own = to_range_bearing(position)
    length, course = to_range_bearing(velocity)
    off = np.abs(wrap_angle(from_own + np.pi - course))
    found: BoolArray = off <= (
        np.arcsin(np.minimum((cpa_limit + place) / np.maximum(distance, 1e-9), 1))
        + np.arcsin(np.minimum(speed / np.maximum(length, 1e-9), 1))
        + np.where((cpa_limit + place >= distance) | (speed >= length), np.pi, 0)
    )
    return found


def _abeam(moving: Array, there: Array) -> Array:
    """Relative motion [..., 2] m/s at the nearest point [..., 2] m, turned to be abeam of it.

    On a straight piece it is abeam already. If the nearest point is a corner of the path, the
    straight track with that closest approach replaces the path, also for its errors.
    """
    speed, distance = (np.hypot(v[..., 0], v[..., 1])[..., None] for v in (moving, there))
    speed = np.maximum(speed, LEAST_SPEED)  # it came there and stays
    across = np.stack([there[..., 1], -there[..., 0]], -1) / np.maximum(distance, 1e-9)
    side = np.where((moving * across).sum(-1, keepdims=True) < 0, -1.0, 1.0)
    return np.where(distance > 1.0, side * speed * across, moving)


def _sectors(safe: BoolArray) -> Array:
    """[S, 2] rad: first and last course of each run of safe ones around the circle."""
    if safe.all():
        return np.array([[COURSES[0], COURSES[-1]]])
    first = np.flatnonzero(safe & ~np.roll(safe, 1))
    last = np.flatnonzero(safe & ~np.roll(safe, -1))
    if len(first) and last[0] < first[0]:
        last = np.roll(last, -1)  # the run across north
    return np.stack([COURSES[first], COURSES[last]], -1)
