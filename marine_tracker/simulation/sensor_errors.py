"""The sensor errors of the IMO's ARPA test conditions (resolution A.823(19), appendix 3)."""

from typing import NamedTuple

import numpy as np

from ..geometry import KNOT, NAUTICAL_MILE, heading_from, unit_vector
from ..types import Array, OwnShip

ROLL_BEARING = np.radians(0.22)  # mean and sine of the quadrantal error at 10 deg of roll
ROLL_PERIODS = (8.0, 15.0)  # s, drawn for each run
BEAM_SHAPE = np.radians(0.05)  # sigma
PULSE_SHAPE = 20.0  # m, sigma
BACKLASH = np.radians(0.05)  # +-, rectangular
ENCODER = np.radians(0.03)  # sigma
BEARING_STEP = np.radians(0.1)  # +-, rectangular
RANGE_STEP = 0.01 * NAUTICAL_MILE  # +-, rectangular
GLINT_ALONG = 30.0 / 200.0  # sigma along the ship, of its length
GLINT_ACROSS = 1.0  # m, sigma
GYRO_BIAS = np.radians(0.5)  # of either sign, drawn for each run
GYRO = np.radians(0.12)  # sigma
LOG_BIAS = 0.5 * KNOT  # of either sign, drawn for each run
LOG = 0.2 * KNOT / 3  # sigma

# What a tracker may be told: the part of the range (m) and bearing (rad) errors that changes from
# scan to scan, without glint; for rolling the mean over all bearings.
IMO_SIGMAS = (
    float(np.sqrt(PULSE_SHAPE**2 + RANGE_STEP**2 / 3)),
    float(
        np.sqrt(
            BEAM_SHAPE**2
            + BACKLASH**2 / 3
            + ENCODER**2
            + BEARING_STEP**2 / 3
            + GYRO**2
            + ROLL_BEARING**2 / 4
        )
    ),
)


class ImoErrors(NamedTuple):
    """The values that are drawn once for a run.

    roll_period s, roll_phase rad; gyro_bias rad; log_bias m/s
    """

    roll_period: float
    roll_phase: float
    gyro_bias: float
    log_bias: float


def draw(random: np.random.Generator) -> ImoErrors:
    """Draws the errors that stay the same during a run."""
    return ImoErrors(
        random.uniform(*ROLL_PERIODS),
        random.uniform(0, 2 * np.pi),
        random.choice([-GYRO_BIAS, GYRO_BIAS]),
        random.choice([-LOG_BIAS, LOG_BIAS]),
    )


def glint(velocity: Array, length: Array, random: np.random.Generator) -> Array:
    """Offsets [..., 2] m of the echoing point, for ships of velocity [..., 2] and length [...].

    The ship lies along its course. At rest it lies north-south.
    """
    along = unit_vector(np.arctan2(velocity[..., 0], velocity[..., 1]))
    across = np.stack([along[..., 1], -along[..., 0]], -1)
    draws = random.standard_normal(velocity.shape)
    return (
        draws[..., :1] * (GLINT_ALONG * length)[..., None] * along
        + draws[..., 1:] * GLINT_ACROSS * across
    )


def measurement_errors(
    errors: ImoErrors, time: Array, relative_bearing: Array, random: np.random.Generator
) -> tuple[Array, Array]:
    """Errors of range m and bearing rad [...] of plots at time [...] s.

    relative_bearing [...] rad is counted from own ship's heading. Rolling tilts the antenna's
    plane; its error is zero ahead, astern and abeam.
    """
    shape = relative_bearing.shape
    roll = (
        ROLL_BEARING
        * np.sin(2 * relative_bearing)
        * (1 + np.sin(4 * np.pi * time / errors.roll_period + errors.roll_phase))
    )
    bearing = (
        roll
        + errors.gyro_bias
        + random.normal(0, np.hypot(np.hypot(BEAM_SHAPE, ENCODER), GYRO), shape)
        + random.uniform(-BACKLASH, BACKLASH, shape)
        + random.uniform(-BEARING_STEP, BEARING_STEP, shape)
    )
    distance = random.normal(0, PULSE_SHAPE, shape) + random.uniform(-RANGE_STEP, RANGE_STEP, shape)
    return distance, bearing


def reckon(
    errors: ImoErrors, true: OwnShip, drift: Array, random: np.random.Generator
) -> tuple[OwnShip, Array]:
    """Own ship from gyro and log: its velocity has errors, and its position is dead-reckoned.

    true   K samples of the true motion
    drift  [2] m, error of the reckoned position at the first sample
    Returns the reckoned samples and the drift at the last one.
    """
    count = len(true.time)
    course = np.arctan2(true.velocity[:, 0], true.velocity[:, 1])
    speed = np.hypot(*true.velocity.T)
    velocity = (speed + errors.log_bias + random.normal(0, LOG, count))[:, None] * unit_vector(
        course + errors.gyro_bias + random.normal(0, GYRO, count)
    )
    wrong = velocity - true.velocity
    steps = 0.5 * (wrong[1:] + wrong[:-1]) * np.diff(true.time)[:, None]
    drifts = drift + np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    stated = np.full(count, np.nan) if true.heading is None else true.heading
    heading = heading_from(velocity, stated)
    return OwnShip(true.time, true.position + drifts, velocity, heading), drifts[-1]
