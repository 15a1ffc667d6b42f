import numpy as np
import pytest

from marine_tracker.geometry import polar_to_position, to_range_bearing
from marine_tracker.types import Plots


@pytest.fixture(scope='session')
def plots_at():
    """Plots of targets at `position` [M, 2] m at the times [M] s, seen from `origin` [2] or [M, 2].

    Without rng they lie on the targets; with it the radar's noise is drawn from it.
    """
    def make(position, time, origin=(0.0, 0.0), rng=None, range_sigma=15.0,
             bearing_sigma=0.0087):
        position = np.atleast_2d(np.asarray(position, float))
        count = len(position)
        origin = np.broadcast_to(np.asarray(origin, float), (count, 2)).copy()
        time = np.broadcast_to(np.asarray(time, float), (count,)).copy()
        distance, bearing = to_range_bearing(position - origin)
        if rng is not None:
            distance = distance + rng.normal(0, range_sigma, count)
            bearing = bearing + rng.normal(0, bearing_sigma, count)
        offset, covariance = polar_to_position(distance, bearing, range_sigma, bearing_sigma)
        if rng is None:
            offset = position - origin
        return Plots(time, distance, bearing, np.zeros(count), origin, origin + offset, covariance)
    return make


@pytest.fixture(scope='session')
def gaussian_plots():
    """Plots with any position [M, 2] and covariance [M, 2, 2] at the times [M]."""
    def make(position, covariance, time):
        position = np.asarray(position, float)
        distance, bearing = to_range_bearing(position)
        return Plots(np.asarray(time, float), distance, bearing, np.zeros(len(position)),
                     np.zeros_like(position), position, np.asarray(covariance, float))
    return make


@pytest.fixture(scope='session')
def condition():
    """Mean and covariance of the last state of a linear-Gaussian chain, given all its plots.

    The whole trajectory is one Gaussian: x_0 ~ (mean, covariance), x_k = F_k x_{k-1} + u_k + w_k,
    z_k = H x_k + v_k. Its joint covariance is written out and conditioned on all z at once:
    no recursion over plots.
    """
    def solve(mean, covariance, steps, observe, plots):
        """steps: (F, u, Q) per plot; plots: (z, R) per plot."""
        n, m, count = len(mean), len(observe), len(steps)
        # Every state as a linear map of the sources [x_0, w_1, ..., w_K], plus an offset.
        source = np.zeros((n * (count + 1), n * (count + 1)))
        source[:n, :n] = covariance
        weight, offset = np.zeros((n, n * (count + 1))), np.array(mean, float)
        weight[:, :n] = np.eye(n)
        rows, centres = [], []
        for k, (transition, drive, noise) in enumerate(steps, 1):
            at = slice(n * k, n * (k + 1))
            weight, offset = transition @ weight, transition @ offset + drive
            weight[:, at] = np.eye(n)
            source[at, at] = noise
            rows.append(observe @ weight)
            centres.append(observe @ offset)
        seen, centre = np.concatenate(rows), np.concatenate(centres)
        spread = seen @ source @ seen.T
        for k, (_, noise) in enumerate(plots):
            at = slice(m * k, m * (k + 1))
            spread[at, at] += noise
        cross = weight @ source @ seen.T
        gain = np.linalg.solve(spread, cross.T).T
        measured = np.concatenate([z for z, _ in plots])
        return offset + gain @ (measured - centre), weight @ source @ weight.T - gain @ cross.T
    return solve
