"""Where the ships of AIS are at any time, and how sure that is."""

from typing import NamedTuple

import numpy as np

from .. import m1371
from ..geometry import KNOT, unit_vector
from ..types import Array, BoolArray
from .ship_table import Ships

ACCURATE, INACCURATE = 5.0, 10.0  # m, deviation of a place, each axis
COARSE = 54.0  # m, of message 27: 0.1 minute of latitude, evenly
TIMED, UNTIMED = 0.3, 2.0  # s, deviation of the moment of a place
UNKNOWN_SPEED = 5.0  # m/s, deviation of each component where no speed is told
LONGEST_TURN = 30.0  # s; a turn is expected to last so long
# By kind: deviation of the velocity m/s each axis, and density of acceleration m^2/s^3.
VELOCITY = np.array([0.3, 0.5, 3.0, 0.1, 0.5])
ACCELERATION = np.array([0.03, 0.3, 3.0, 1e-6, 0.05])
RESTING = 1e-4  # m^2/s^3, of a ship at anchor or moored
OFFSET_SHARE = 0.25  # of the length: where the antenna is on board is not known
UNKNOWN_LENGTH = 60.0  # m


class Moving(NamedTuple):
    """Ships at a time: of the middle of each.

    position    [S, 2]     m; nan where it is not known
    velocity    [S, 2]     m/s over ground; 0 where none is told
    covariance  [S, 4, 4]  of both
    told        [S]        whether a speed is told
    """

    position: Array
    velocity: Array
    covariance: Array
    told: BoolArray


def at(ships: Ships, time: float | Array) -> Moving:
    """The ships at the time, s: one for all, or of each [S].

    Course and speed are kept, and a turn for at most LONGEST_TURN. The covariance is that of the
    last place, of the moment it was of, of the motion since then, and of where on board it was
    measured, if nobody knows.
    """
    after = np.broadcast_to(time, ships.time.shape) - ships.time
    told = np.isfinite(ships.velocity[:, 0])
    velocity = np.where(told[:, None], ships.velocity, 0.0)
    bend = np.nan_to_num(ships.turn) * np.clip(after, 0.0, LONGEST_TURN)
    position, velocity, heading = _turned(ships, velocity, bend, after)
    step, unsure = to_middle(ships, heading)
    position = position + step
    covariance = _covariance(ships, velocity, told, np.abs(after))
    covariance[:, 0, 0] += unsure**2
    covariance[:, 1, 1] += unsure**2
    return Moving(position, velocity, covariance, told)


def _turned(ships: Ships, velocity: Array, bend: Array, after: Array) -> tuple[Array, Array, Array]:
    """Position, velocity [S, 2] and heading [S] after a turn through `bend` [S] rad, then straight
    on; in all `after` [S] s."""
    turning = np.minimum(np.maximum(after, 0.0), LONGEST_TURN)
    mean, end = _rotated(velocity, 0.5 * bend), _rotated(velocity, bend)
    chord = np.sinc(0.5 * bend / np.pi)
    way = mean * (chord * turning)[:, None] + end * (after - turning)[:, None]
    return ships.position + way, end, ships.heading + bend


def _rotated(vector: Array, angle: Array) -> Array:
    """The vectors [S, 2] turned clockwise by the angles [S]."""
    cosine, sine = np.cos(angle), np.sin(angle)
    east, north = vector.T
    return np.stack([east * cosine + north * sine, north * cosine - east * sine], -1)


def to_middle(ships: Ships, heading: Array) -> tuple[Array, Array]:
    """m [S, 2] from the antenna to the middle of the ship, and the deviation m [S] of what is not
    known of it."""
    bow, stern, port, starboard = ships.size.T
    ahead, right = 0.5 * (bow - stern), 0.5 * (starboard - port)
    # Without a heading she is taken to go where she heads, if she makes way.
    way = np.where(ships.speed > 2 * KNOT, ships.course, np.nan)
    heading = np.where(np.isnan(heading), way, heading)
    known = np.isfinite(ahead + right + heading)
    unit = unit_vector(np.where(known, heading, 0.0))
    starboard_of = np.stack([unit[:, 1], -unit[:, 0]], -1)
    step = np.where(known, ahead, 0.0)[:, None] * unit
    step += np.where(known, right, 0.0)[:, None] * starboard_of
    length = np.where(np.isnan(ships.length), UNKNOWN_LENGTH, ships.length)
    lever = np.hypot(ahead, right)
    unsure = np.where(np.isfinite(lever), lever, OFFSET_SHARE * length)
    no_ship = np.isin(ships.kind, (m1371.AID, m1371.SART, m1371.AIRCRAFT))
    return step, np.where(known | no_ship, 0.0, unsure)


def _covariance(ships: Ships, velocity: Array, told: BoolArray, after: Array) -> Array:
    """[S, 4, 4]: of the place told, of its moment, and of the motion in `after` [S] s since."""
    place = np.where(ships.accurate, ACCURATE, INACCURATE)
    place = np.where(ships.coarse, COARSE, place) ** 2
    moment = np.where(ships.timed, TIMED, UNTIMED) ** 2
    speed = np.hypot(*velocity.T)
    rests = m1371.at_rest(ships.status, ships.speed)
    spread = np.where(told, VELOCITY[ships.kind] + 0.01 * speed, UNKNOWN_SPEED)
    spread = np.where(rests, 0.1, spread) ** 2
    density = np.where(rests, RESTING, ACCELERATION[ships.kind])
    found = np.zeros((len(speed), 4, 4))
    found[:, :2, :2] = moment[:, None, None] * velocity[:, :, None] * velocity[:, None, :]
    for axis in (0, 1):
        found[:, axis, axis] += place + after**2 * spread + density * after**3 / 3
        found[:, axis, axis + 2] = found[:, axis + 2, axis] = (
            after * spread + 0.5 * density * after**2
        )
        found[:, axis + 2, axis + 2] = spread + density * after
    return found
