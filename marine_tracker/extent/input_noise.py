"""Radii at uncertain angles: paper 004, eq 30-47 as reconstructed.

The angle b at which a cell meets the outline depends on the cell's noise and on the target's
estimated position and heading. Its variance Sigma is `input_variance`. The variants use it in
different ways:

    gp      not at all: V = v(b)
    gp_ts   first order:                   V = v(b) + mu'(b)^2 Sigma
    gp_ss   three sigma points b, b +- sqrt(3 Sigma), weights 2/3 1/6 1/6
    gp_mc   100 draws of N(b, Sigma)
    gp_q15  15 even nodes over +- 2.8 sigma with Gaussian weights: gp_mc without random draws

With nodes b_i, means replace mu, mu', h and v, and V = mean v + var mu(b_i).
"""

import numpy as np

from ..types import Array
from .radial_function import Contour, Radius, radius

VARIANTS = ('gp', 'gp_ts', 'gp_ss', 'gp_mc', 'gp_q15')
DRAWS = 100
MOST = (np.pi / 3) ** 2  # rad^2; the moments do not hold for a larger variance


def _even_nodes() -> tuple[Array, Array]:
    nodes = np.linspace(-2.8, 2.8, 15)
    weights = np.exp(-0.5 * nodes**2)
    weights /= weights.sum()
    return nodes / np.sqrt(weights @ nodes**2), weights


POINT = (np.zeros(1), np.ones(1))
NODES = {
    'gp': POINT,
    'gp_ts': POINT,
    'gp_ss': (np.sqrt(3) * np.array([0.0, 1.0, -1.0]), np.array([2 / 3, 1 / 6, 1 / 6])),
    'gp_q15': _even_nodes(),
}


def input_variance(
    across: Array, distance: Array, noise: Array, covariance: Array | None = None
) -> Array:
    """Sigma [N] rad^2 of the angles at which cells meet outlines, at most MOST.

    across [N, 2] unit vectors, distance [N] m of the cells from the centres; noise [N, 2, 2] m^2
    of the cells; covariance [N, 3, 3] of centre and heading, None to count the noise only.
    """
    lever = across / distance[:, None]
    found = _square(lever, noise)
    if covariance is not None:
        found = found + _square(np.column_stack([lever, np.ones(len(lever))]), covariance)
    return np.minimum(found, MOST)


def noisy_radius(
    prior: Contour,
    semi_axes: Array,
    f: Array,
    angle: Array,
    variance: Array,
    variant: str,
    rng: np.random.Generator | None = None,
) -> Radius:
    """Radii [N] at the angles [N] rad with the variances [N] rad^2; other arguments as in `radius`.

    `variance` of the result is V. Only gp_mc draws from rng.
    """
    if variant == 'gp_mc':
        assert rng is not None
        nodes, weights = rng.standard_normal((len(angle), DRAWS)), np.full(DRAWS, 1 / DRAWS)
    else:
        nodes, weights = NODES[variant]
    at = radius(prior, semi_axes, f, angle[:, None] + np.sqrt(variance)[:, None] * nodes)
    mean, slope = at.mean @ weights, at.slope @ weights
    left = at.variance @ weights + np.square(at.mean - mean[:, None]) @ weights
    if variant == 'gp_ts':
        left = left + slope * slope * variance
    return Radius(mean, slope, weights @ at.weight, left)


def _square(vector: Array, matrix: Array) -> Array:
    """a' M a [N]."""
    found: Array = ((vector[:, None] @ matrix)[:, 0] * vector).sum(-1)
    return found
