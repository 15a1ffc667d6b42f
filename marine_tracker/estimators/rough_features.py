"""The inputs of the networks of `cs_rough_nn` and `cs_bp_nn`: differences between two filters.

Paper 001, section 4. d is the difference of two predictions (position, velocity, acceleration of
one axis), p1 and p2 are their variances, and s is their sum (for the position: of the innovation
variances):

    u = d^2 / s                                          the plain network's input,
    e = lambda (sqrt p1 + sqrt p2)                       possible part of noise in d,
    max(0, |d| - e)^2 / s,  (|d| + e)^2 / s              the rough one's lower and upper input.

If the target does not manoeuvre, u is a chi-square variable times its mean c. c depends only, and
little, on gamma = sigma_a1 T^2 / sigma_plot and alpha T. Inputs are scaled so that c times the
median of chi-square becomes 0, and c times KAPPA 95 % quantiles becomes 1. So the networks do not
depend on the accuracy of the plots, nor on the period of the scans.
"""

import numpy as np
from scipy.special import gammaincinv

from ..networks.rough_weights import Quiet
from ..types import Array, IntArray

LAMBDA = 0.3
KAPPA = 3.0
# Quantiles of chi-square with one degree of freedom.
LOW = 2 * float(gammaincinv(0.5, 0.5))
HIGH = KAPPA * 2 * float(gammaincinv(0.5, 0.95))
MOST = HIGH**0.5  # of |d|; harder manoeuvres were not in the training


def inputs(apart: Array, deviation: Array | None, neurons: int) -> Array:
    """Inputs [..., K] for |d| / sqrt(c s) and (sqrt p1 + sqrt p2) / sqrt(c s), both [...]."""
    apart = np.minimum(apart, MOST)
    if deviation is None or neurons == 1:
        bounds = apart[..., None]
    else:
        e = LAMBDA * deviation
        bounds = np.stack([np.maximum(apart - e, 0.0), apart + e], -1)
    return (bounds * bounds - LOW) / (HIGH - LOW)


def quiet_variance(quiet: Quiet, gamma: Array, y: Array) -> Array:
    """c [..., 3] for gamma and alpha T [...]. Outside the table the value at its edge is used."""
    i, across = _place(np.log(gamma), quiet.log_gamma)
    j, along = _place(np.log(y), quiet.log_y)
    table = quiet.variance
    near = table[i, j] * (1 - along) + table[i, j + 1] * along
    far = table[i + 1, j] * (1 - along) + table[i + 1, j + 1] * along
    return near * (1 - across) + far * across


def _place(value: Array, grid: Array) -> tuple[IntArray, Array]:
    """Index of the grid's interval and how far along it, [...] and [..., 1]."""
    # nan also gets a place. Its row is lost anyway.
    place = np.nan_to_num(np.interp(value, grid, np.arange(len(grid))))
    index = np.minimum(place.astype(int), len(grid) - 2)
    return index, (place - index)[..., None]
