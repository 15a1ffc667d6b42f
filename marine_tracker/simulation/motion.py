"""Exact positions of ships at any time: every leg has a closed form, nothing is integrated.

A ship's path is a list of pieces. On each piece the ship follows a circle (or a straight line, the
circle of curvature 0) with the speed  v + a t + A sin(w t + p).  So its distance run d(t) and its
position have a closed form. A ship driven by reports follows a cubic instead. All pieces of all
ships are in one table, so hundreds of ships are placed by a few array operations.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from ..geometry import unit_vector
from ..types import Array, FloatArray, Numbers

MAX_TURN_RATE = np.radians(45.0)  # rad/s
MAX_ACCELERATION = 10.0  # m/s^2


class Straight(NamedTuple):
    """Course and speed kept for `duration` s; None: to the end."""

    duration: float | None


class Turn(NamedTuple):
    """A turn through `angle` rad (positive to starboard) on a circle of `radius` m.

    If `rate` rad/s is given instead, the radius gives that rate at the mean speed.
    """

    angle: float
    radius: float | None = None
    rate: float | None = None


class SpeedChange(NamedTuple):
    """The speed changes evenly to `speed` m/s, in `duration` s or at `acceleration` m/s^2 > 0."""

    speed: float
    duration: float | None = None
    acceleration: float | None = None


Leg = Straight | Turn | SpeedChange


class Wave(NamedTuple):
    """A sinusoidal part of the speed, over the whole path: amplitude m/s, period s."""

    amplitude: float
    period: float


class Piece(NamedTuple):
    """One piece of one ship's path, from time `start` to the start of the next piece.

    With t since `start`, the ship runs the distance
    d = speed t + acceleration t^2 / 2 + wave / wave_rate (cos wave_phase - cos(wave_rate t +
    wave_phase))
    on a circle of `curvature` (rad/m, positive to starboard). It leaves `position` on `course`
    (rad). `cubic` [3][2] (m/s, m/s^2, m/s^3) adds its powers of t.
    """

    start: float
    position: tuple[float, float]
    course: float = 0.0
    curvature: float = 0.0
    speed: float = 0.0
    acceleration: float = 0.0
    wave: float = 0.0
    wave_rate: float = 1.0
    wave_phase: float = 0.0
    cubic: tuple[tuple[float, float], ...] = ((0.0, 0.0),) * 3
    exists: bool = True


class Paths(NamedTuple):
    """The pieces of S ships in one table, one row a piece, sorted by ship and then by time.

    The columns are those of Piece. `key` [P] orders rows by ship and start; `span` s is the part of
    the key that belongs to one ship; `ships` is S.
    """

    start: Array
    position: Array
    course: Array
    curvature: Array
    speed: Array
    acceleration: Array
    wave: Array
    wave_rate: Array
    wave_phase: Array
    cubic: Array
    exists: NDArray[np.bool_]
    key: Array
    span: float
    ships: int


def table(ways: Sequence[Sequence[Piece]], duration: float) -> Paths:
    """The table of the paths of S ships, S > 0. The first piece of each starts at 0 s or before."""
    pieces = [piece for way in ways for piece in way]
    columns: list[Any] = [np.array(column) for column in zip(*pieces, strict=True)]
    ship = np.repeat(np.arange(len(ways)), [len(way) for way in ways])
    span = float(duration) + 1.0
    key = ship * span + np.clip(columns[0], 0.0, span)
    return Paths._make([*columns, key, span, len(ways)])


def locate_ships(
    paths: Paths, ship: NDArray[np.int64], time: float | FloatArray
) -> tuple[Array, Array]:
    """Position [..., 2] m and velocity [..., 2] m/s of the numbered ships [...] at times [...]."""
    row = _row(paths, ship, time)
    t = time - paths.start[row]
    speed, acceleration = paths.speed[row], paths.acceleration[row]
    wave, rate, phase = paths.wave[row], paths.wave_rate[row], paths.wave_phase[row]
    run = _run(paths, row, t)
    now = speed + acceleration * t + wave * np.sin(rate * t + phase)
    half_turn = 0.5 * paths.curvature[row] * run
    course = paths.course[row]
    chord = run * np.sinc(half_turn / np.pi)
    first, second, third = np.moveaxis(paths.cubic[row], -2, 0)
    t = t[..., None]
    position = (
        paths.position[row]
        + chord[..., None] * unit_vector(course + half_turn)
        + t * (first + t * (second + t * third))
    )
    velocity = (
        now[..., None] * unit_vector(course + 2 * half_turn)
        + first
        + t * (2 * second + 3 * t * third)
    )
    return position, velocity


def courses(paths: Paths, ship: NDArray[np.int64], time: float | FloatArray) -> Array:
    """Course [...] rad that the numbered ships [...] steer at times [...], also at rest; 0 of one
    that is driven by reports."""
    row = _row(paths, ship, time)
    return paths.course[row] + paths.curvature[row] * _run(paths, row, time - paths.start[row])


def exist(paths: Paths, ship: NDArray[np.int64], time: float | FloatArray) -> NDArray[np.bool_]:
    """Whether the numbered ships [...] exist at times [...]."""
    return paths.exists[_row(paths, ship, time)]


def _run(paths, row, t):
    """Distance run, m, on the pieces `row` in the t s since they began."""
    wave, rate, phase = paths.wave[row], paths.wave_rate[row], paths.wave_phase[row]
    return t * (paths.speed[row] + 0.5 * paths.acceleration[row] * t) + wave / rate * (
        np.cos(phase) - np.cos(rate * t + phase)
    )


def _row(paths, ship, time):
    inside = np.clip(time, 0.0, paths.span - 0.5)
    return np.searchsorted(paths.key, ship * paths.span + inside, 'right') - 1


def sail(
    position: Numbers,
    course: float,
    speed: float,
    legs: Sequence[Leg] = (),
    wave: Wave | None = None,
) -> list[Piece]:
    """The pieces of a ship that starts at time 0 and runs its legs, then keeps course and speed.

    position [2] m, east and north; course rad; speed m/s, the mean if there is a wave. Raises
    ValueError for legs that are not possible; it begins with the leg's place: `legs[2]...`.
    """
    way = []
    time = 0.0
    # The wave continues through all legs: its phase counts from the start.
    amplitude, wave_rate = (wave.amplitude, 2 * np.pi / wave.period) if wave else (0.0, 1.0)
    if speed < amplitude:
        raise ValueError(
            f'speed_wave has an amplitude of {amplitude:g} m/s; it must not exceed '
            f'the speed, {speed:g} m/s'
        )
    for number, leg in enumerate(legs):
        here = f'legs[{number}]'
        curvature = acceleration = 0.0
        after = speed
        if isinstance(leg, Straight):
            if leg.duration is None:
                if number + 1 < len(legs):
                    raise ValueError(
                        f'{here}.straight has no duration_s; only the last leg may go on to the end'
                    )
                break
            duration = leg.duration
        elif isinstance(leg, SpeedChange):
            after = leg.speed
            if after < amplitude:
                raise ValueError(
                    f'{here}.speed ends at {after:g} m/s; it must not be below the '
                    f'amplitude of speed_wave, {amplitude:g} m/s'
                )
            duration = (
                abs(after - speed) / leg.acceleration if leg.acceleration else leg.duration or 0.0
            )
            acceleration = (after - speed) / duration if duration else 0.0
            if abs(acceleration) > MAX_ACCELERATION:
                raise ValueError(
                    f'{here}.speed changes by {abs(acceleration):.3g} m/s each '
                    f'second; it must not exceed {MAX_ACCELERATION:g}'
                )
        else:
            if speed <= amplitude:
                raise ValueError(
                    f'{here}.turn begins at a mean speed of {speed:g} m/s; a ship '
                    'that stops cannot turn'
                )
            radius = leg.radius if leg.radius else speed / leg.rate  # type: ignore[operator]
            if speed / radius > MAX_TURN_RATE:
                raise ValueError(
                    f'{here}.turn has a radius of {radius:g} m; at {speed:.3g} m/s '
                    f'that is {np.degrees(speed / radius):.3g} deg/s, more than '
                    f'{np.degrees(MAX_TURN_RATE):g}'
                )
            curvature = np.sign(leg.angle) / radius
            duration = _time_to_run(
                radius * abs(leg.angle), speed, amplitude, wave_rate, wave_rate * time
            )
        piece = Piece(
            time,
            tuple(position),
            course,
            curvature,
            speed,
            acceleration,
            amplitude,
            wave_rate,
            wave_rate * time,
        )
        way.append(piece)
        if isinstance(leg, Turn):
            course += leg.angle
        time, speed = time + duration, after
        ended = locate_ships(table([[piece]], time), np.array(0), time)
        position = ended[0]
    way.append(
        Piece(
            time, tuple(position), course, 0.0, speed, 0.0, amplitude, wave_rate, wave_rate * time
        )
    )
    return way


def _time_to_run(distance, speed, amplitude, wave_rate, phase):
    """Time in which the ship runs the distance at `speed` plus the wave."""
    if amplitude == 0.0:
        return distance / speed
    return brentq(
        lambda t: (
            speed * t
            + amplitude / wave_rate * (np.cos(phase) - np.cos(wave_rate * t + phase))
            - distance
        ),
        0.0,
        (distance + 2 * amplitude / wave_rate) / speed,
        xtol=1e-12,
        rtol=1e-14,
    )
