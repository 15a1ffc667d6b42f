"""Posterior Cramer-Rao lower bound of the outline filter.

Source: Tichavsky, Muravchik, Nehorai, IEEE T-SP 46(5), 1998; paper 004, eq 48-52:

    J+ = (F J^-1 F' + Q)^-1 + E[sum H' (p' R p + V)^-1 H]

The bound is kept as a covariance, J^-1, because Q is singular. The expectation is the mean over N
targets whose truth is known. V is the noise of the variant: a filter that counts more noise has a
wider bound. The bound of gp counts only the noise of the cells.
"""

import numpy as np

from ...extent.gaussian_process import GpState, Model, measure, predict
from ...types import Array, FloatArray, IntArray


def bound_step(
    bound: Array,
    time: float,
    truth: GpState,
    cells: Array,
    count: IntArray,
    noise: Array,
    model: Model,
    rng: np.random.Generator | None = None,
) -> FloatArray:
    """The bound [n, n] one scan later.

    bound is the bound at `time`. truth has N rows at the scan's time; only their mean and semi_axes
    are used. cells [N, C, 2] m, of which the first count [N] of each row are used; noise [N, 2, 2]
    m^2.
    """
    one = GpState(np.array([time]), truth.mean[:1], bound[None], truth.semi_axes[:1])
    bound = predict(one, truth.time[:1], model).covariance[0]
    known = truth._replace(covariance=np.broadcast_to(bound, (len(truth.time), *bound.shape)))
    information = np.zeros_like(bound)
    for j in range(int(count.max(initial=0))):
        seen = measure(known, cells[:, j], noise, model, rng)
        weight = (count > j) / seen.noise
        information += (weight * seen.jacobian.T) @ seen.jacobian
    return np.linalg.inv(np.linalg.inv(bound) + information / len(truth.time))
