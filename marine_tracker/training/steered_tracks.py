"""True tracks of vessels that are steered: by rudder, by stick, or by wind and anchor.

`ship_tracks` draws circles and straight lines. Real vessels swing into a turn and out of it, lose
speed there, and are pushed about. The forms of motion (`Steered.form`):

    rudder  a ship whose turn follows its rudder with a delay (Nomoto 1957), steered by an autopilot
            or by hand, with engine, drift angle, stream and sea
    stick   a boat whose turn and thrust follow a stick that somebody moves about
    moored  a vessel that swings at anchor, or is adrift
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..geometry import unit_vector
from ..types import Array, BoolArray
from .ship_tracks import Ships

SUB_STEPS = 6  # of the motion, a scan
TURNING = 0.04  # m/s^2, acceleration that counts as a manoeuvre
RUDDER = float(np.radians(35))  # at most
GRAVITY = 9.81


class Steered(NamedTuple):
    """How vessels of a kind move. Pairs are minimum and maximum.

    form    'rudder', 'stick' or 'moored'
    length  m, of the hull; drawn by the logarithm
    speed   m/s; of a moored vessel: of the stream and wind that move it
    calm    s, mean time between two orders to helm, stick or engine
    hull    share of the length over which the plots wander
    """

    form: str
    length: tuple[float, float]
    speed: tuple[float, float]
    calm: tuple[float, float]
    hull: float = 0.0


SHIPS = {
    'rudder': Steered('rudder', (20.0, 330.0), (2.0, 16.0), (100.0, 600.0)),
    'stick': Steered('stick', (5.0, 30.0), (0.0, 18.0), (5.0, 40.0)),
    'moored': Steered('moored', (10.0, 250.0), (0.0, 1.5), (60.0, 400.0)),
    'long hull': Steered('rudder', (60.0, 330.0), (2.0, 14.0), (150.0, 900.0), hull=0.12),
}
SMALL_CRAFT = {
    'rudder': Steered('rudder', (6.0, 40.0), (0.5, 9.0), (20.0, 200.0)),
    'stick': Steered('stick', (4.0, 12.0), (0.0, 18.0), (2.0, 25.0)),
    'moored': Steered('moored', (4.0, 30.0), (0.0, 1.0), (30.0, 200.0)),
}


class Motion(NamedTuple):
    """What a form of motion gives: velocity [B, 2] m/s at a moment, and the next state."""

    state: tuple[Array, ...]
    velocity: Array


def sail(
    kind: Steered,
    ranges: Array,
    steps: Array,
    rng: np.random.Generator,
    fastest: float | Array = np.inf,
) -> tuple[Ships, Array]:
    """Vessels that begin at the ranges [B] m, and how far [B] m their plots wander over the hull.

    steps [B, K] s: time since the previous scan; fastest m/s, of all or of each [B]
    """
    count, scans = steps.shape
    low, high = kind.speed
    high = np.maximum(np.minimum(np.full(count, high), fastest), low)
    length, calm = (_by_log(rng, *pair, count) for pair in (kind.length, kind.calm))
    begin, move = FORMS[kind.form]
    own, state = begin(length, low, high, calm, rng)
    position = ranges[:, None] * unit_vector(rng.uniform(0, 2 * np.pi, count))
    positions, velocities = np.empty((2, count, scans, 2))
    for k in range(scans):
        dt = steps[:, min(k + 1, scans - 1)] / SUB_STEPS
        positions[:, k], velocities[:, k] = position, move(own, state, 0 * dt, rng).velocity
        for _ in range(SUB_STEPS):
            state, velocity = move(own, state, dt, rng)
            position = position + dt[:, None] * velocity
    time = np.cumsum(steps, 1) - steps[:, :1]
    acceleration = np.gradient(velocities, axis=1) / steps[..., None]
    manoeuvre = np.hypot(*np.moveaxis(acceleration, -1, 0)) > TURNING
    return Ships(time, positions, velocities, manoeuvre), kind.hull * length


def _by_log(rng: np.random.Generator, low: float, high: float, count: int) -> Array:
    return np.exp(rng.uniform(np.log(low), np.log(high), count))


def _due(mean: Array, dt: Array, rng: np.random.Generator) -> BoolArray:
    """Whether something that happens every `mean` [B] s happens within dt [B] s."""
    return rng.random(len(mean)) < -np.expm1(-dt / mean)


def _wander(value: Array, sigma: float | Array, last: float | Array, dt: Array, rng) -> Array:
    """A mean of 0, the deviation sigma, forgotten within `last` s; values [B] or [B, 2]."""
    keep = np.exp(-dt / last)
    keep, sigma = (
        np.reshape(one, np.shape(one) + (1,) * (value.ndim - 1)) for one in (keep, sigma)
    )
    found: Array = keep * value + sigma * np.sqrt(1 - keep * keep) * rng.standard_normal(
        value.shape
    )
    return found


def _begin_rudder(length, low, high, calm, rng):
    count = len(length)
    # A ship is driven at most to a share of the speed at which its own wave holds it.
    high = np.maximum(np.minimum(high, 0.4 * np.sqrt(GRAVITY * length)), low)
    speed, course = rng.uniform(low, high), rng.uniform(0, 2 * np.pi, count)
    own = {
        'length': length,
        'range': (low, high),
        'calm': calm,
        'by_hand': rng.random(count) < 0.3,
        'gain': _by_log(rng, 0.4, 2.5, count),  # K' of Nomoto
        'lag': _by_log(rng, 0.3, 4.0, count),  # T'
        'rudder_rate': np.radians(rng.uniform(2, 7, count)),
        'most': np.radians(rng.uniform(5, 35, count)),
        'firm': rng.uniform(0.5, 2.5, count),
        'damping': rng.uniform(0.5, 1.5, count),
        'engine': rng.uniform(15, 200, count),
        'slip': rng.uniform(0.0, 0.5, count),
        'loss': rng.uniform(0.0, 1.0, count),
        'stream': rng.normal(0, 0.4, (count, 2)),
        'sea': np.radians(_by_log(rng, 0.003, 0.25, count)),
        'swell': rng.uniform(4, 20, count),
    }
    zero = np.zeros(count)
    return own, (course, zero, zero, speed, speed, course, zero, zero)


def _move_rudder(own, state, dt, rng) -> Motion:
    course, rate, rudder, speed, ordered_speed, ordered, helm, push = state
    count = len(course)
    new = _due(own['calm'], dt, rng)
    side = np.where(rng.random(count) < 0.5, -1.0, 1.0)
    ordered = np.where(new, ordered + side * np.radians(rng.uniform(5, 130, count)), ordered)
    # By hand: the rudder is laid over, and met again after a while.
    helm = np.where(new, side * rng.uniform(0.1, 1.0, count) * RUDDER, helm)
    helm = np.where(_due(own['calm'] / 4, dt, rng) & ~new, 0.0, helm)
    new = _due(3 * own['calm'], dt, rng)
    ordered_speed = np.where(new, rng.uniform(*own['range']), ordered_speed)
    pace = np.maximum(speed, 0.5) / own['length']
    gain, lag = own['gain'] * pace, own['lag'] / pace
    wanted = own['firm'] * (ordered - course) - own['damping'] * own['firm'] * lag * rate
    wanted = np.where(own['by_hand'], helm, np.clip(wanted, -own['most'], own['most']))
    turn = own['rudder_rate'] * dt
    rudder = rudder + np.clip(wanted - rudder, -turn, turn)
    push = _wander(push, own['sea'], own['swell'], dt, rng)
    rate = rate + (1 - np.exp(-dt / lag)) * (gain * rudder - rate)
    course = course + dt * (rate + push)
    bend = rate / pace
    goal = ordered_speed / (1 + own['loss'] * np.abs(bend))
    speed = speed + (1 - np.exp(-dt / own['engine'])) * (goal - speed)
    velocity = speed[:, None] * unit_vector(course - own['slip'] * bend) + own['stream']
    return Motion((course, rate, rudder, speed, ordered_speed, ordered, helm, push), velocity)


def _begin_stick(length, low, high, calm, rng):
    count = len(length)
    speed = rng.uniform(low, high)
    own = {
        'range': (low, high),
        'calm': calm,
        'fastest_turn': np.radians(_by_log(rng, 3.0, 30.0, count)),
        'lateral': _by_log(rng, 0.5, 5.0, count),
        'thrust': _by_log(rng, 0.1, 2.0, count),
        'lag': rng.uniform(0.5, 4.0, count),
        'idle': rng.uniform(0.2, 0.7, count),
    }
    zero = np.zeros(count)
    return own, (rng.uniform(0, 2 * np.pi, count), zero, speed, zero, speed)


def _move_stick(own, state, dt, rng) -> Motion:
    course, rate, speed, stick, ordered = state
    count = len(course)
    new = _due(own['calm'], dt, rng)
    held = rng.uniform(-1, 1, count) * (rng.random(count) > own['idle'])
    stick = np.where(new, held, stick)
    ordered = np.where(_due(2 * own['calm'], dt, rng), rng.uniform(*own['range']), ordered)
    wanted = stick * np.minimum(own['fastest_turn'], own['lateral'] / np.maximum(speed, 0.5))
    rate = rate + (1 - np.exp(-dt / own['lag'])) * (wanted - rate)
    course = course + dt * rate
    speed = speed + np.clip(ordered - speed, -own['thrust'] * dt, own['thrust'] * dt)
    return Motion((course, rate, speed, stick, ordered), speed[:, None] * unit_vector(course))


def _begin_moored(length, low, high, calm, rng):
    count = len(length)
    stream = rng.uniform(low, high)[:, None] * unit_vector(rng.uniform(0, 2 * np.pi, count))
    anchored = rng.random(count) < 0.5
    swing = rng.uniform(0.1, 0.8, count)
    own = {
        'stream': np.where(anchored[:, None], 0.0, stream),
        'wind': np.where(anchored, 0.02, rng.uniform(0.02, 0.25, count)),
        'last': calm,
        # At anchor: the hull swings on its chain.
        'radius': anchored * (length + rng.uniform(10, 150, count)),
        'swing': swing,
        'turn': 2 * np.pi / (rng.uniform(3, 12, count) * np.maximum(calm, 60)),
        'way': rng.uniform(0, 2 * np.pi, count),
    }
    return own, (rng.uniform(0, 2 * np.pi, count), np.zeros((count, 2)))


def _move_moored(own, state, dt, rng) -> Motion:
    clock, wind = state
    clock = clock + own['turn'] * dt
    wind = _wander(wind, own['wind'], own['last'], dt, rng)
    angle = own['way'] + own['swing'] * np.sin(clock)
    along = own['radius'] * own['swing'] * own['turn'] * np.cos(clock)
    sideways = unit_vector(angle + np.pi / 2)
    return Motion((clock, wind), own['stream'] + wind + along[:, None] * sideways)


FORMS: dict[str, tuple[Callable[..., tuple], Callable[..., Motion]]] = {
    'rudder': (_begin_rudder, _move_rudder),
    'stick': (_begin_stick, _move_stick),
    'moored': (_begin_moored, _move_moored),
}
