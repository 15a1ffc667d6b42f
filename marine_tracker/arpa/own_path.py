"""Own ship's path under a trial manoeuvre: delay, then turn and change of speed, then straight."""

from typing import NamedTuple

import numpy as np

from ..geometry import KNOT, to_range_bearing, unit_vector, wrap_angle
from ..types import Array
from .cpa import OwnMotion

MAX_SPEED = 100 * KNOT
STRETCHES = 32  # pieces while course and speed change, and again while one still does


class TrialManoeuvre(NamedTuple):
    """The trial manoeuvre.

    course        rad, true, over ground; reached by the shorter turn
    speed         m/s over ground, to be reached
    delay         s from now until the manoeuvre begins
    turn_rate     rad/s; inf turns at once
    acceleration  m/s^2, gaining and losing speed; inf changes it at once
    """

    course: float
    speed: float
    delay: float = 0.0
    turn_rate: float = np.radians(1.0)
    acceleration: float = 0.02


class Path(NamedTuple):
    """C paths, each as K moments with own ship's positions; straight between moments.

    After the last moment the ship continues with `velocity`.

    time      [C, K]     s from now, ascending, the first 0
    position  [C, K, 2]  m, east and north
    velocity  [C, 2]     m/s
    """

    time: Array
    position: Array
    velocity: Array


def check(trial: TrialManoeuvre) -> None:
    """ValueError for the first value that is not possible."""
    for name, unit, low, high in (
        ('course', 'rad', -np.inf, np.inf),
        ('speed', 'm/s', 0.0, MAX_SPEED),
        ('delay', 's', 0.0, 3600.0),
    ):
        value = getattr(trial, name)
        if not (np.isfinite(value) and low <= value <= high):
            limits = f'between {low:g} and {high:g} {unit}' if np.isfinite(low) else 'finite'
            raise ValueError(f'trial {name} is {value:g} {unit}; it must be {limits}')
    for name, unit in (('turn_rate', 'rad/s'), ('acceleration', 'm/s^2')):
        value = getattr(trial, name)
        if not value > 0:
            raise ValueError(f'trial {name} is {value:g} {unit}; it must be above 0')


def countdown(trial: TrialManoeuvre, elapsed: float) -> TrialManoeuvre:
    """The same trial `elapsed` s later: the remaining delay, 0 once it has begun."""
    if not elapsed >= 0:
        raise ValueError(f'elapsed is {elapsed:g} s; a countdown does not run backwards')
    return trial._replace(delay=max(trial.delay - elapsed, 0.0))


def paths(own: OwnMotion, trial: TrialManoeuvre, courses: Array) -> Path:
    """Own ship's path for each of the courses [C] rad, which replace the trial's own.

    Course and speed change together, each at its constant rate, starting from own ship's course
    over ground (from its heading if it is at rest). The position at each moment is exact. Between
    moments the path is a chord, which differs from the arc by at most .12 % of the turning circle's
    radius.
    """
    check(trial)
    if not (np.isfinite(own.position).all() and np.isfinite(own.velocity).all()):
        raise ValueError(
            f'own ship is at {own.position} m with {own.velocity} m/s; a trial needs both'
        )
    speed, made_good = to_range_bearing(own.velocity)
    course: float | Array = made_good if speed > 0 else own.heading
    turn, gain = wrap_angle(courses - course), np.broadcast_to(trial.speed - speed, courses.shape)
    turning, gaining = np.abs(turn) / trial.turn_rate, np.abs(gain) / trial.acceleration
    first, last = np.minimum(turning, gaining), np.maximum(turning, gaining)
    steps = np.arange(1, STRETCHES + 1) / STRETCHES
    after = np.concatenate(
        [
            np.zeros((len(courses), 1)),
            first[:, None] * steps,
            first[:, None] + (last - first)[:, None] * steps,
        ],
        1,
    )
    step = np.diff(after)

    def velocity_at(after_delay: Array) -> Array:
        now = course + turn[:, None] * _share(after_delay, turning)
        return (speed + gain[:, None] * _share(after_delay, gaining))[..., None] * unit_vector(now)

    # Gauss's two points: exact to 1e-6 of a piece.
    middle, off = after[:, :-1] + step / 2, step / np.sqrt(12)
    moved = (velocity_at(middle - off) + velocity_at(middle + off)) * step[..., None] / 2
    begins = own.position + trial.delay * own.velocity
    position = begins + np.concatenate([np.zeros_like(moved[:, :1]), moved.cumsum(1)], 1)
    now = np.broadcast_to(own.position, (len(courses), 1, 2))
    return Path(
        np.concatenate([np.zeros((len(courses), 1)), trial.delay + after], 1),
        np.concatenate([now, position], 1),
        trial.speed * unit_vector(courses),
    )


def _share(time: Array, duration: Array) -> Array:
    """The share [C, K] of a change lasting `duration` [C] s that is done by the time [C, K]."""
    duration = np.broadcast_to(duration[:, None], time.shape)
    return np.divide(time, duration, out=np.ones_like(time), where=duration > 0).clip(0, 1)
