"""Two filters on the "current" statistical model in parallel, joined by a network (paper 001).

F1 expects any manoeuvre: its variance sigma_a1^2 = (4 - pi) / pi a_max^2 is constant. F2 gives the
estimate. It has sigma_a2^2 = O sigma_a1^2 on each axis. A network computes O in (0, 1] from the
differences of the two predictions (`rough_features`). While the target keeps its course they agree,
O is small and F2 is calm. In a manoeuvre F1 moves ahead, and O lets F2 follow.

Axes are treated separately, as in the paper. The variance of the model belongs to one axis, and a
manoeuvre along one axis should not make the other one noisy.

The inputs of the network are the predictions for the time of the plot, O at the previous plot, and
the plot noise so far. So O is known before the plot comes, and gate and update use the same O.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from ..gaussian.linear import kalman_update
from ..networks import rough_weights
from ..networks.rough_network import forward
from ..types import Array, Extrapolation, IntArray, Plots, append, put, take
from .contract import Estimator, Velocity
from .cs_kalman import (
    POSITION,
    POSITION_VELOCITY,
    RAYLEIGH,
    CsState,
    Manoeuvre,
    cs_kalman,
    model,
    move,
    process_noise,
)
from .rough_features import inputs, quiet_variance

LEAST_SHARE = 0.01
QUIET_SHARE = 0.02  # target value of the training for a target that keeps its course
SHORTEST = 1e-3  # s; at step 0 the share has no effect
DIAGONAL = np.arange(6)


class ParallelState(NamedTuple):
    """One row a track.

    wide, narrow  CsState of F1 and F2, both at the last plot's time
    share         [N, 2]  O of the axes, east and north
    noise         [N, 2]  m^2, plot variance of the axes: weighted log-mean over the plots
    """

    wide: CsState
    narrow: CsState
    share: Array
    noise: Array


@cache
def weights(kind: str) -> rough_weights.Weights:
    """The shipped weights of a `rough` or `bp` network; ValueError where they are damaged."""
    return rough_weights.load(rough_weights.shipped(kind), kind)


def parallel(manoeuvre: Manoeuvre, max_speed: float, weights: rough_weights.Weights) -> Estimator:
    """The two filters and a network; max_speed as for `cs_kalman`."""
    single = cs_kalman(manoeuvre, max_speed)
    frequency, limit = manoeuvre.frequency, manoeuvre.max_acceleration
    variance = RAYLEIGH * limit**2
    neurons = weights.network.inner.shape[1]

    def share_of(apart: Array, wide: Array, narrow: Array, noise: Array, step: Array) -> Array:
        """O [N, 2] of d, p1, p2 [N, 2, 3], plot variances [N, 2] and steps [N]."""
        total = wide + narrow
        total[..., 0] += 2 * noise
        size = np.maximum(np.abs(step), SHORTEST)[:, None]
        gamma = np.sqrt(variance / noise) * size**2
        unit = 1 / np.sqrt(
            total
            * quiet_variance(weights.quiet, gamma, np.broadcast_to(frequency * size, gamma.shape))
        )
        seen = inputs(np.abs(apart) * unit, (np.sqrt(wide) + np.sqrt(narrow)) * unit, neurons)
        share = forward(weights.network, seen.reshape(-1, *seen.shape[2:])).reshape(-1, 2)
        found: Array = np.minimum(np.maximum(share, LEAST_SHARE), 1.0)
        return found

    def predict(state: ParallelState, time: Array) -> tuple[Array, Array, Array]:
        """Means [2 N, 6] and covariances [2 N, 6, 6] of F1, then of F2; O [N, 2] of F2's."""
        step = time - state.narrow.time
        count = len(step)
        phi, q = model(frequency, step)
        both = append(state.wide, state.narrow)
        mean, covariance = move(
            both.mean, both.covariance, np.tile(step, 2), np.tile(phi, 2), limit
        )
        density = 2 * frequency * variance
        covariance[:count] += process_noise(q, np.full((count, 2), density))
        spread = covariance[:, DIAGONAL, DIAGONAL].reshape(2, count, 2, 3)
        before = spread[1] + density * state.share[..., None] * q[[0, 3, 5]].T[:, None]
        apart = (mean[:count] - mean[count:]).reshape(count, 2, 3)
        share = share_of(apart, spread[0], before, state.noise, step)
        covariance[count:] += process_noise(q, density * share)
        return mean, covariance, share

    def init(plots: Plots, velocity: Velocity | None = None) -> ParallelState:
        first = single.init(plots, velocity)
        return ParallelState(
            first,
            first._make(array.copy() for array in first),
            np.full((len(plots.time), 2), QUIET_SHARE),
            np.diagonal(plots.covariance, axis1=1, axis2=2).copy(),
        )

    def extrapolate(state: ParallelState, time: Array) -> Extrapolation:
        mean, covariance, _ = predict(state, time)
        count = len(time)
        mean = mean[count:].take(POSITION_VELOCITY, 1)
        covariance = covariance[count:].take(POSITION_VELOCITY, 1).take(POSITION_VELOCITY, 2)
        return Extrapolation(time, mean[:, :2], mean[:, 2:], covariance)

    def update(state: ParallelState, plots: Plots, rows: IntArray) -> ParallelState:
        before = take(state, rows)
        mean, covariance, share = predict(before, plots.time)
        count = len(plots.time)
        noise = np.diagonal(plots.covariance, axis1=1, axis2=2)
        known = covariance[:count][:, POSITION, POSITION]
        gain = known / (known + noise)
        noise = before.noise * (noise / before.noise) ** gain
        innovation = np.tile(plots.position, (2, 1)) - mean.take(POSITION, 1)
        mean, covariance, _, _ = kalman_update(
            mean, covariance, innovation, np.tile(plots.covariance, (2, 1, 1)), POSITION
        )
        wide, narrow = (
            CsState(plots.time, mean[part], covariance[part])
            for part in (slice(0, count), slice(count, None))
        )
        return put(state, rows, ParallelState(wide, narrow, share, noise))

    return Estimator(init, extrapolate, update)
