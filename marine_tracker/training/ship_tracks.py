"""True tracks of ships by kind of motion, and a radar's plots of them, for training and judging.

The radar is at rest at [0, 0]. B tracks of K scans are made at once. Each rotation of the antenna
takes SUB_STEPS steps of straight motion, which is fine enough for every turn here.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import polar_to_position, to_range_bearing, unit_vector
from ..types import Array, BoolArray, Plots

SUB_STEPS = 4
LONGEST_PHASE = 8  # scans; a manoeuvre's phase lasts this long after its end
# Where on a hull the plot lies: a slow wander, and jumps to another part or to something beside it.
WANDER, WANDER_KEEP = 0.7, 0.85  # deviation, in hull sizes; share kept from scan to scan
JUMP, FAR, BACK = 0.07, 2.5, 0.6  # probability; deviation, in hull sizes; probability of return


class Ships(NamedTuple):
    """B tracks of K scans.

    time        [B, K]     s
    position    [B, K, 2]  m, east and north
    velocity    [B, K, 2]  m/s
    manoeuvre   [B, K]     whether the ship turns or changes speed
    """

    time: Array
    position: Array
    velocity: Array
    manoeuvre: NDArray[np.bool_]


class Kind(NamedTuple):
    """How ships of a kind move. Pairs are minimum and maximum.

    begin    probability in a scan that a manoeuvre begins
    turns    share of the manoeuvres that are turns; the others change speed
    speed    m/s
    radius   m, of a turn
    lateral  m/s^2, maximum in a turn
    angle    deg, maximum of a turn
    thrust   m/s^2, of a change of speed
    weave    s, periods in which the course swings all the time; None: it does not
    drift    share of the ships whose speed and course wander slowly
    """

    begin: float
    turns: float = 0.75
    speed: tuple[float, float] = (2.0, 18.0)
    radius: tuple[float, float] = (150.0, 2000.0)
    lateral: float = 1.2
    angle: float = 150.0
    thrust: tuple[float, float] = (0.03, 0.3)
    weave: tuple[float, float] | None = None
    drift: float = 0.5


KINDS = {
    'steady': Kind(0.0, drift=0.0),
    'mix': Kind(1 / 80),
    'frequent': Kind(1 / 35),
    'sharp': Kind(1 / 45, turns=0.95, radius=(150.0, 450.0)),
    'weave': Kind(0.0, weave=(60.0, 240.0)),
    'agile': Kind(1 / 10, radius=(15.0, 150.0), lateral=4.0, angle=240.0, thrust=(0.12, 1.2)),
    'drift': Kind(0.0, drift=1.0),
}
# Boats: from one that hardly moves to one that is turned about for fun.
SMALL_CRAFT = {
    'idle': Kind(1 / 120, speed=(0.0, 1.0), radius=(3.0, 20.0), lateral=0.5, thrust=(0.02, 0.1)),
    'steady': Kind(0.0, speed=(0.5, 12.0), drift=0.3),
    'cruise': Kind(
        1 / 40, speed=(1.0, 15.0), radius=(30.0, 500.0), lateral=2.5, thrust=(0.05, 0.8)
    ),
    'ferry': Kind(
        1 / 25, turns=0.6, speed=(0.0, 6.0), radius=(5.0, 80.0), lateral=1.0, thrust=(0.05, 0.5)
    ),
    'weave': Kind(0.0, speed=(2.0, 12.0), lateral=3.0, weave=(12.0, 80.0)),
    'sharp': Kind(
        1 / 30,
        turns=0.9,
        speed=(2.0, 12.0),
        radius=(15.0, 120.0),
        lateral=4.0,
        angle=200.0,
        thrust=(0.1, 1.5),
    ),
    'rib': Kind(
        1 / 8,
        turns=0.7,
        speed=(2.0, 20.0),
        radius=(12.0, 100.0),
        lateral=4.0,
        angle=300.0,
        thrust=(0.3, 2.0),
    ),
}


def sail(
    names: Sequence[str],
    ranges: Array,
    steps: Array,
    rng: np.random.Generator,
    fastest: float | Array = np.inf,
    kinds: Mapping[str, Kind] = KINDS,
) -> Ships:
    """Ships of the kinds [B] (names) that begin at the ranges [B] m.

    steps [B, K] s: time since the previous scan; fastest m/s, of all or of each [B]; kinds: the
    kinds by name.
    """
    count, scans = steps.shape
    every = [kinds[name] for name in names]
    begin, turns, lateral, angle, drift = (
        np.array([getattr(kind, name) for kind in every])
        for name in ('begin', 'turns', 'lateral', 'angle', 'drift')
    )
    angle = np.radians(angle)
    tight, wide = np.log(np.array([kind.radius for kind in every])).T
    low, high = np.array([kind.speed for kind in every]).T
    high = np.maximum(np.minimum(high, fastest), low)
    gentle, hard = np.array([kind.thrust for kind in every]).T
    short, long = np.array([kind.weave or (0.0, 0.0) for kind in every]).T
    weave = long > 0

    position = ranges[:, None] * unit_vector(rng.uniform(0, 2 * np.pi, count))
    course, speed = rng.uniform(0, 2 * np.pi, count), rng.uniform(low, high)
    wander = rng.random(count) < drift
    speed_swing = wander * rng.uniform(0.2, 1.5, count)
    speed_rate = 2 * np.pi / rng.uniform(300, 1500, count)
    course_rate = 2 * np.pi / rng.uniform(200, 900, count)
    course_swing = wander * np.minimum(
        np.radians(rng.uniform(1, 8, count)), 0.03 / (np.maximum(speed, 0.1) * course_rate)
    )
    weave_rate = 2 * np.pi / np.where(weave, rng.uniform(short, long), 1.0)
    weave_swing = weave * np.minimum(
        np.radians(rng.uniform(10, 45, count)), lateral / (np.maximum(speed, 0.1) * weave_rate)
    )
    phases = rng.uniform(0, 2 * np.pi, (3, count))
    stop = np.minimum(low, 0.3)

    rate, left = np.zeros(count), np.zeros(count)  # of turns: rad/s, rad left
    push, goal = np.zeros(count), speed.copy()  # m/s^2 and m/s
    positions, velocities = np.empty((2, scans, count, 2))
    manoeuvre = np.empty((scans, count), bool)
    clock = np.zeros(count)
    for k in range(scans):
        start = (rng.random(count) < begin) & (left <= 0) & (push == 0)
        turning = start & (rng.random(count) < turns)
        changing = start & ~turning
        radius = np.maximum(np.exp(rng.uniform(tight, wide)), speed**2 / lateral)
        side = np.where(rng.random(count) < 0.5, -1.0, 1.0)
        rate = np.where(turning, side * speed / radius, rate)
        left = np.where(turning, rng.uniform(np.radians(15), angle), left)
        goal = np.where(changing, rng.uniform(low, high), goal)
        push = np.where(changing, np.sign(goal - speed) * rng.uniform(gentle, hard), push)

        positions[k], velocities[k] = position, speed[:, None] * unit_vector(course)
        manoeuvre[k] = (left > 0) | (push != 0) | weave
        dt = steps[:, min(k + 1, scans - 1)] / SUB_STEPS
        for _ in range(SUB_STEPS):
            in_turn = left > 0
            course = course + dt * (
                np.where(in_turn, rate, 0.0)
                + weave_swing * weave_rate * np.cos(weave_rate * clock + phases[0])
                + course_swing * course_rate * np.cos(course_rate * clock + phases[1])
            )
            left = np.where(in_turn, left - np.abs(rate) * dt, 0.0)
            drifted = speed + dt * speed_swing * speed_rate * np.cos(speed_rate * clock + phases[2])
            pushed = np.maximum(drifted, stop) + push * dt
            done = (push != 0) & ((pushed - goal) * np.sign(push) >= 0)
            speed, push = np.where(done, goal, pushed), np.where(done, 0.0, push)
            position = position + (dt * speed)[:, None] * unit_vector(course)
            clock = clock + dt
    time = np.cumsum(steps, 1) - steps[:, :1]
    return Ships(time, positions.swapaxes(0, 1), velocities.swapaxes(0, 1), manoeuvre.T)


def phase(manoeuvre: BoolArray) -> BoolArray:
    """Whether each scan [B, K] lies in a manoeuvre, or so shortly after it that it still has an
    effect.
    """
    out = manoeuvre.copy()
    for after in range(1, LONGEST_PHASE + 1):
        out[:, after:] |= manoeuvre[:, :-after]
    return out


class RunRadar(NamedTuple):
    """The radar of each track, [B] each.

    range_sigma m, bearing_sigma rad: as stated to the tracker
    detection   probability of a plot in a scan
    outliers    share of the plots with additional noise of five times the deviation
    truly       true deviation over the stated one
    period      s, as stated to the tracker
    """

    range_sigma: Array
    bearing_sigma: Array
    detection: Array
    outliers: Array
    truly: Array
    period: Array


def observe(
    ships: Ships, radar: RunRadar, rng: np.random.Generator, hull: Array | None = None
) -> tuple[list[Plots], NDArray[np.bool_]]:
    """Plots of every ship, a list over the scans, and which were detected [B, K].

    The first two scans are always detected. hull [B] m: how far the plots wander and jump over the
    ship, along and across the line of sight; by default not at all.
    """
    shape = ships.time.shape
    distance, bearing = to_range_bearing(ships.position)
    rare = rng.random(shape) < radar.outliers[:, None]

    def noise(sigma):
        wild = rng.standard_normal(shape) + rare * 5 * rng.standard_normal(shape)
        return (sigma * radar.truly)[:, None] * wild

    if hull is not None:
        along, across = hull[:, None] * _on_hull(shape, rng)
        bearing = bearing + across / np.maximum(distance, 1.0)
        distance = distance + along
    distance = np.maximum(distance + noise(radar.range_sigma), 1.0)
    bearing = bearing + noise(radar.bearing_sigma)
    position, covariance = polar_to_position(
        distance, bearing, radar.range_sigma[:, None], radar.bearing_sigma[:, None]
    )
    zero, origin = np.zeros(shape[0]), np.zeros((shape[0], 2))
    plots = [
        Plots(
            ships.time[:, k],
            distance[:, k],
            bearing[:, k],
            zero,
            origin,
            position[:, k],
            covariance[:, k],
        )
        for k in range(shape[1])
    ]
    seen = rng.random(shape) < radar.detection[:, None]
    seen[:, :2] = True
    return plots, seen


def _on_hull(shape, rng):
    """Where the plots [B, K] lie, [2, B, K], in units of the hull's size."""
    wander = rng.standard_normal((2, *shape))
    jumps = rng.random(shape) < JUMP
    place = FAR * rng.standard_normal((2, *shape)) * (rng.random(shape) > BACK)
    place[..., 0] = 0.0
    for k in range(1, shape[1]):
        wander[..., k] = (
            WANDER_KEEP * wander[..., k - 1] + np.sqrt(1 - WANDER_KEEP**2) * wander[..., k]
        )
        place[..., k] = np.where(jumps[:, k], place[..., k], place[..., k - 1])
    return WANDER * wander + place
