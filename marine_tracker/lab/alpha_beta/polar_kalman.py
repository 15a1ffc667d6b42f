"""A polar Kalman filter with Doppler: the reference for the filters of paper 002.

Two pairs of a value and its rate: range and radial speed, bearing and bearing rate. The rates have
white process noise. The model is the paper's, with the gains that make the error smallest. It is
for a radar at rest. Plots must have radial speeds.
"""

from typing import NamedTuple

import numpy as np

from ...estimators.contract import Estimator
from ...estimators.polar_motion import to_ground
from ...gaussian.linear import sandwich
from ...geometry import wrap_angle
from ...types import Array, Extrapolation, put, take

SPEED_NOISE = 20 / 3.6**2 / 3600  # m^2/s^3: 20 (km/h)^2 an hour
RATE_NOISE = 40 * np.radians(1) ** 2 / 3600**3  # rad^2/s^3: 40 (deg/h)^2 an hour
MEASURED = np.array([0, 1, 2])  # of range, radial speed, bearing, bearing rate


class PolarState(NamedTuple):
    """time [N]; mean [N, 4] range, radial speed, bearing, bearing rate; covariance [N, 4, 4];
    origin [N, 2].
    """

    time: Array
    mean: Array
    covariance: Array
    origin: Array


def polar_kalman(
    max_speed: float, range_sigma: float, speed_sigma: float, bearing_sigma: float
) -> Estimator:
    """The filter for a radar with these deviations (m, m/s, rad); max_speed m/s of the targets."""
    noise = np.diag([range_sigma, speed_sigma, bearing_sigma]) ** 2

    def init(plots, velocity=None):
        assert velocity is None and plots.radial_speed is not None
        count = len(plots.time)
        mean = np.stack([plots.range, plots.radial_speed, plots.bearing, np.zeros(count)], -1)
        covariance = np.zeros((count, 4, 4))
        covariance[:, :3, :3] = noise
        covariance[:, 3, 3] = (0.5 * max_speed / plots.range) ** 2
        return PolarState(plots.time, mean, covariance, plots.origin)

    def predict(state, time):
        step = time - state.time
        mean, transition = state.mean.copy(), np.tile(np.eye(4), (len(step), 1, 1))
        covariance = np.zeros((len(step), 4, 4))
        for value, density in ((0, SPEED_NOISE), (2, RATE_NOISE)):
            mean[:, value] += step * mean[:, value + 1]
            transition[:, value, value + 1] = step
            covariance[:, value, value] = density * step**3 / 3
            covariance[:, value + 1, value + 1] = density * step
            covariance[:, value, value + 1] = density * step**2 / 2
            covariance[:, value + 1, value] = density * step**2 / 2
        return mean, covariance + sandwich(transition, state.covariance)

    def extrapolate(state, time):
        mean, covariance = predict(state, time)
        ground, by_polar = to_ground(mean, state.origin)
        return Extrapolation(time, ground[:, :2], ground[:, 2:], sandwich(by_polar, covariance))

    def update(state, plots, rows):
        before = take(state, rows)
        mean, covariance = predict(before, plots.time)
        off = np.stack([plots.range, plots.radial_speed, plots.bearing], -1) - mean[:, :3]
        off[:, 2] = wrap_angle(off[:, 2])
        cross = covariance[:, MEASURED]
        gain = np.matmul(np.linalg.inv(cross[:, :, MEASURED] + noise), cross)
        mean = mean + np.matmul(off[:, None], gain)[:, 0]
        covariance = covariance - np.matmul(gain.swapaxes(1, 2), cross)
        return put(state, rows, PolarState(plots.time, mean, covariance, plots.origin))

    return Estimator(init, extrapolate, update)
