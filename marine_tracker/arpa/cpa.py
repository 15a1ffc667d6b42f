"""What the navigator reads of each target: where, which way, how near, when, and how surely."""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing, unit_vector
from ..types import Array
from .directions import polar_sigma
from .miss_distance import cpa_sigma, danger_probability
from .motion import Motion

LEAST_SPEED = 0.25  # m/s: of relative motion, below which nothing approaches
HAIR = 1e-9  # m^2, m^2/s^2: keeps covariances regular where all is known exactly


class OwnMotion(NamedTuple):
    """Own ship at the time of the targets' motion.

    position    [2]     m, east and north
    velocity    [2]     m/s, over ground or through the water, as the targets' motion is
    heading     rad, clockwise from true north
    covariance  [4, 4]  of position and velocity, as far as they err against the positions from
                        which the plots were placed; an error common to both (a wrong log by which
                        own ship is reckoned) leaves range, relative motion and CPA as they are
    north       whether the heading is known; else it is the last one, right only to tell what is
                relative to the bow
    """

    position: Array
    velocity: Array
    heading: float
    covariance: Array
    north: bool = True


class Approach(NamedTuple):
    """N targets; every value has its standard deviation, in its own unit, as `<name>_sigma`.

    range            m
    bearing          rad in [0, 2 pi), true
    course, speed    rad, m/s: over ground or through the water, as the motion was given
    relative_course, relative_speed    rad, m/s: of the motion relative to own ship
    cpa              m, of the straight relative track, be it ahead or past
    tcpa             s, negative when past; nan where there is next to no relative motion
    bow_range        m, where the target will cross own ship's bow
    bow_time         s, when; both nan where it will not
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


def cpa_of(position, velocity):
    """CPA [...] m and TCPA [...] s of relative positions [..., 2] m and velocities [..., 2] m/s.

    Without relative motion the CPA is the range and the TCPA nan.
    """
    e, n = position[..., 0], position[..., 1]
    ve, vn = velocity[..., 0], velocity[..., 1]
    speed = np.hypot(ve, vn)
    moving = speed > 0
    divisor = np.where(moving, speed, 1.0)
    cpa = np.where(moving, np.abs(e * vn - n * ve) / divisor, np.hypot(e, n))
    tcpa = np.where(moving, -(e * ve + n * vn) / divisor / divisor, np.nan)
    return cpa, tcpa


def bow_crossing(position, velocity, heading):
    """Range [...] m at which the line of own ship's keel is crossed and time [...] s of it.

    Relative positions and velocities as in `cpa_of`. A range below 0 is astern, a time below 0
    past; not finite where the target moves along the line.
    """
    ahead = unit_vector(heading)
    abeam = position[..., 0] * ahead[1] - position[..., 1] * ahead[0]
    drift = velocity[..., 0] * ahead[1] - velocity[..., 1] * ahead[0]
    with np.errstate(divide='ignore', invalid='ignore'):
        time = -abeam / drift
        return position @ ahead + time * (velocity @ ahead), time


def approach(motion: Motion, own: OwnMotion, cpa_limit: float, tcpa_limit: float) -> Approach:
    """Everything of `Approach` for the targets' motion [N]; limits in m and s, above 0.

    Deviations of range, bearing, courses, speeds and CPA are exact for Gaussian errors (see
    `directions`); those of TCPA and bow crossing come from a quadrature of degree 5 (`spread`) and
    say no more than "large" where the relative speed is but a few times its own deviation: there
    they have no variance. Rows whose motion is not known (nan) are nan, their probability 0.
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
    position, velocity, covariance, true_velocity, true_covariance, heading, cpa_limit, tcpa_limit
):
    """The fields of Approach, in their order, of targets relative to own ship."""

    def polar(vector, covariance):
        length, angle = to_range_bearing(vector)
        length_sigma, angle_sigma = polar_sigma(vector, covariance)
        return length, length_sigma, angle, angle_sigma

    def swapped(length, length_sigma, angle, angle_sigma):
        return angle, angle_sigma, length, length_sigma

    moving = np.hypot(*velocity.T) >= LEAST_SPEED
    cpa, tcpa = cpa_of(position, velocity)
    bow_range, bow_time = bow_crossing(position, velocity, heading)
    crosses = moving & (bow_range > 0) & (bow_time >= 0) & np.isfinite(bow_range)

    def timed(position, velocity):
        return np.stack([cpa_of(position, velocity)[1], *bow_crossing(position, velocity, heading)])

    tcpa_sigma, bow_range_sigma, bow_time_sigma = spread(
        timed, position, velocity, covariance, np.stack([tcpa, bow_range, bow_time])
    )

    def where(mask, value):
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


def _points():
    """Points [24, 4] of the degree-5 rule for a standard normal law of four dimensions.

    McNamee and Stenger, Numerische Mathematik 10, 1967: at sqrt(3) along every pair of axes, of
    weight 1/36 each. In four dimensions the points on the axes have none; the centre has the rest,
    and no deviation.
    """
    i, j = np.triu_indices(4, 1)
    points = np.zeros((len(i), 4, 4))
    for k, (a, b) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1))):
        points[np.arange(len(i)), k, i] = a * np.sqrt(3)
        points[np.arange(len(i)), k, j] = b * np.sqrt(3)
    return points.reshape(-1, 4)


POINTS = _points()


def spread(function, position, velocity, covariance, shown):
    """RMS deviations [K, N] of function(position, velocity) [K, ...] from what is shown [K, N].

    Not finite where what is shown is not.
    """
    factor = np.linalg.cholesky(covariance)
    off = POINTS @ factor.swapaxes(1, 2)  # [N, 24, 4]
    found = function(position[:, None] + off[..., :2], velocity[:, None] + off[..., 2:])
    with np.errstate(invalid='ignore', over='ignore'):
        return np.sqrt(np.square(found - shown[..., None]).sum(-1) / 36)
