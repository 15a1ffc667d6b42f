"""How much of a plot's difference the alpha-beta filter takes over: four modes (paper 002)."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..types import Array

WINDOW = 10  # plots over which method1 judges its prediction error
SOFT_SPEED, SOFT_BEARING = 4.0, 6.0  # sigma at which hf_soft moves half the way
GATE_BEARING = 6.0  # c_a: the association gate of the bearing, sigma


class Misfit(NamedTuple):
    """Differences of K plots to the expectation, and the deviations of such differences by noise.

    range, speed, bearing              [K]  m, m/s, rad
    range_sigma, speed_sigma, bearing_sigma  [K]  likewise
    plots        [K]     plots of the track, this one included
    mean_square  [K, 2]  m^2, rad^2 over the last plots, this one included
    """

    range: Array
    speed: Array
    bearing: Array
    range_sigma: Array
    speed_sigma: Array
    bearing_sigma: Array
    plots: Array
    mean_square: Array


def rate_gain(position_gain: Array) -> Array:
    """beta from alpha by Benedict and Bordner's relation: alpha^2 / (2 - alpha)."""
    return position_gain**2 / (2 - position_gain)


def position_gain(rate_gain: Array) -> Array:
    """alpha from beta by the same relation, solved for alpha."""
    return 0.5 * (np.sqrt(rate_gain**2 + 8 * rate_gain) - rate_gain)


def _hf(m: Misfit) -> tuple[Array, Array, Array, Array]:
    """Paper 002, eq 4 to 6: the speed's share first, because it is measured best."""
    beta_v = -np.expm1(-np.abs(m.speed) / m.speed_sigma)
    alpha_a = -np.expm1(-np.abs(m.bearing) / (GATE_BEARING * m.bearing_sigma))
    return position_gain(beta_v), beta_v, alpha_a, rate_gain(alpha_a)


def _hf_soft(m: Misfit) -> tuple[Array, Array, Array, Array]:
    """The same with r / (1 + r) over wider scales, so noise alone has less effect."""
    beta_v, alpha_a = (
        ratio / (1 + ratio)
        for ratio in (
            np.abs(m.speed) / (SOFT_SPEED * m.speed_sigma),
            np.abs(m.bearing) / (SOFT_BEARING * m.bearing_sigma),
        )
    )
    return position_gain(beta_v), beta_v, alpha_a, rate_gain(alpha_a)


def _method1(m: Misfit) -> tuple[Array, Array, Array, Array]:
    """Paper 002's first rival: the prediction variance divided by the sum of it and the plot's."""
    alpha_r, alpha_a = (
        square / (square + sigma**2)
        for square, sigma in zip(m.mean_square.T, (m.range_sigma, m.bearing_sigma), strict=True)
    )
    return alpha_r, rate_gain(alpha_r), alpha_a, rate_gain(alpha_a)


def _method2(m: Misfit) -> tuple[Array, Array, Array, Array]:
    """Paper 002's second rival: a straight line through all k plots, without adaptation."""
    k = m.plots
    alpha, beta = 2 * (2 * k - 1) / (k * (k + 1)), 6 / (k * (k + 1))
    return alpha, beta, alpha, beta


# alpha_r, beta_v, alpha_a, beta_w [K each] of a Misfit, from a track's third plot on.
GAINS: dict[str, Callable[[Misfit], tuple[Array, Array, Array, Array]]] = {
    'hf_soft': _hf_soft,
    'hf': _hf,
    'method1': _method1,
    'method2': _method2,
}
