"""What the navigator reads of each target: position, course, CPA and TCPA, with deviations."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing, unit_vector
from ..types import Array, BoolArray
from .directions import polar_sigma
from .miss_distance import cpa_sigma, danger_probability
from .motion import Motion

LEAST_SPEED = 0.25  # m/s of relative motion; below this nothing approaches
HAIR = 1e-9  # m^2, m^2/s^2: keeps covariances invertible if all is known exactly


class OwnMotion(NamedTuple):
    """Own ship at the time of the targets' motion.

    position    [2]     m, east and north
    velocity    [2]     m/s, over ground or through the water, as the targets' motion
    heading     rad, clockwise from true north
    covariance  [4, 4]  of position and velocity, relative to the positions from which the plots
                        were placed. An error common to both (a wrong log, for example) does not
                        change range, relative motion and CPA
    north       whether the heading is known. If not, it is the last one, and is right only for what
                is relative to the bow
    """

    position: Array
    velocity: Array
    heading: float
    covariance: Array
    north: bool = True


class Approach(NamedTuple):
    """N targets. Every value has its standard deviation, in the same unit, as `<name>_sigma`.

    range            m
    bearing          rad in [0, 2 pi), true
    course, speed    rad, m/s: over ground or through the water, as the motion was given
    relative_course, relative_speed    rad, m/s: of the motion relative to own ship
    cpa              m, of the straight relative track, ahead or past
    tcpa             s, negative when past; nan if there is almost no relative motion
    bow_range        m, where the target will cross own ship's bow
    bow_time         s, when; both nan if it will not
    danger_probability  P(CPA < limit and 0 <= TCPA < limit); 0 without relative motion
    """

    range: Array
    range_sigma: Array
    bearing: Array
    bearing_sigma: Array
    course: Array
    course_sigma: Array
    speed: Array
    speed_sigma: Array
    relative_course: Array
    relative_course_sigma: Array
    relative_speed: Array
    relative_speed_sigma: Array
    cpa: Array
    cpa_sigma: Array
    tcpa: Array
    tcpa_sigma: Array
    bow_range: Array
    bow_range_sigma: Array
    bow_time: Array
    bow_time_sigma: Array
    danger_probability: Array


def cpa_of(position: Array, velocity: Array) -> tuple[Array, Array]:
    """CPA [...] m and TCPA [...] s from relative positions [..., 2] m and velocities [..., 2] m/s.

    Without relative motion the CPA is the range and the TCPA is nan.
    """
    e, n = position[..., 0], position[..., 1]
    ve, vn = velocity[..., 0], velocity[..., 1]
    speed = np.hypot(ve, vn)
    moving = speed > 0
    divisor = np.where(moving, speed, 1.0)
    cpa = np.where(moving, np.abs(e * vn - n * ve) / divisor, np.hypot(e, n))
    tcpa = np.where(moving, -(e * ve + n * vn) / divisor / divisor, np.nan)
    return cpa, tcpa


def bow_crossing(position: Array, velocity: Array, heading: float) -> tuple[Array, Array]:
    """Range [...] m at which the target crosses own ship's keel line, and time [...] s of the
    crossing.

    Relative positions and velocities as in `cpa_of`. A negative range is astern, a negative time is
    past. Not finite if the target moves along the line.
    """
    ahead = unit_vector(heading)
    abeam = position[..., 0] * ahead[1] - position[..., 1] * ahead[0]
    drift = velocity[..., 0] * ahead[1] - velocity[..., 1] * ahead[0]
    with np.errstate(divide='ignore', invalid='ignore'):
        time = -abeam / drift
        return position @ ahead + time * (velocity @ ahead), time


def approach(motion: Motion, own: OwnMotion, cpa_limit: float, tcpa_limit: float) -> Approach:
    """All fields of `Approach` for the targets' motion [N]; limits in m and s, above 0.

    Deviations of range, bearing, courses, speeds and CPA are exact for Gaussian errors (see
    `directions`). Those of TCPA and bow crossing come from a quadrature of degree 5 (`spread`). If
    the relative speed is only a few times its own deviation, these have no variance, and the result
    means only "large". Rows with unknown motion (nan) are nan, with probability 0.
    """
    for name, limit, unit in (('cpa_limit', cpa_limit, 'm'), ('tcpa_limit', tcpa_limit, 's')):
        if not 0 < limit < np.inf:
            raise ValueError(f'{name} is {limit} {unit}; it must be finite and above 0')
    position, velocity = motion.position - own.position, motion.velocity - own.velocity
    covariance = motion.covariance + own.covariance + HAIR * np.eye(4)
    known = np.isfinite(position).all(1)
    values = np.full((len(Approach._fields), len(position)), np.nan)
    values[-1] = 0.0
    if known.any():
        values[:, known] = _values(
            position[known],
            velocity[known],
            covariance[known],
            motion.velocity[known],
            motion.covariance[known, 2:, 2:],
            own.heading,
            cpa_limit,
            tcpa_limit,
        )
    return Approach(*values)


def _values(
    position: Array,
    velocity: Array,
    covariance: Array,
    true_velocity: Array,
    true_covariance: Array,
    heading: float,
    cpa_limit: float,
    tcpa_limit: float,
) -> Array:
    """The fields of Approach, in their order, of targets relative to own ship."""

    def polar(vector: Array, covariance: Array) -> tuple[Array, Array, Array, Array]:
        length, angle = to_range_bearing(vector)
        length_sigma, angle_sigma = polar_sigma(vector, covariance)
        return length, length_sigma, angle, angle_sigma

    def swapped(
        length: Array, length_sigma: Array, angle: Array, angle_sigma: Array
    ) -> tuple[Array, Array, Array, Array]:
        return angle, angle_sigma, length, length_sigma

    moving = np.hypot(*velocity.T) >= LEAST_SPEED
    cpa, tcpa = cpa_of(position, velocity)
    bow_range, bow_time = bow_crossing(position, velocity, heading)
    crosses = moving & (bow_range > 0) & (bow_time >= 0) & np.isfinite(bow_range)

    def timed(position: Array, velocity: Array) -> Array:
        return np.stack([cpa_of(position, velocity)[1], *bow_crossing(position, velocity, heading)])

    tcpa_sigma, bow_range_sigma, bow_time_sigma = spread(
        timed, position, velocity, covariance, np.stack([tcpa, bow_range, bow_time])
    )

    def where(mask: BoolArray, value: Array) -> Array:
        return np.where(mask, value, np.nan)

    return np.stack(
        [
            *polar(position, covariance[:, :2, :2]),
            *swapped(*polar(true_velocity, true_covariance + HAIR * np.eye(2))),
            *swapped(*polar(velocity, covariance[:, 2:, 2:])),
            cpa,
            cpa_sigma(position, velocity, covariance, cpa),
            where(moving, tcpa),
            where(moving, tcpa_sigma),
            where(crosses, bow_range),
            where(crosses, bow_range_sigma),
            where(crosses, bow_time),
            where(crosses, bow_time_sigma),
            np.where(
                moving,
                danger_probability(position, velocity, covariance, cpa_limit, tcpa_limit),
                0.0,
            ),
        ]
    )


def _points() -> Array:
    """Points [24, 4] of the degree-5 rule for a standard normal distribution in four dimensions.

    McNamee and Stenger, Numerische Mathematik 10, 1967: at sqrt(3) along every pair of axes, with
    weight 1/36 each. In four dimensions the points on the axes have weight 0. The centre has the
    rest, and no deviation.
    """
    i, j = np.triu_indices(4, 1)
    points = np.zeros((len(i), 4, 4))
    for k, (a, b) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1))):
        points[np.arange(len(i)), k, i] = a * np.sqrt(3)
        points[np.arange(len(i)), k, j] = b * np.sqrt(3)
    return points.reshape(-1, 4)


POINTS = _points()


def spread(
    function: Callable[[Array, Array], Array],
    position: Array,
    velocity: Array,
    covariance: Array,
    shown: Array,
) -> Array:
    """RMS deviations [K, N] of function(position, velocity) [K, ...] from the shown values [K, N].

    Not finite where the shown value is not finite.
    """
    factor = np.linalg.cholesky(covariance)
    off = POINTS @ factor.swapaxes(1, 2)  # [N, 24, 4]
    found = function(position[:, None] + off[..., :2], velocity[:, None] + off[..., 2:])
    with np.errstate(invalid='ignore', over='ignore'):
        value: Array = np.sqrt(np.square(found - shown[..., None]).sum(-1) / 36)
        return value
