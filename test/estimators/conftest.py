import numpy as np
import pytest

from marine_tracker.geometry import polar_to_position, to_range_bearing
from marine_tracker.types import Plots


@pytest.fixture(scope='session')
def plots_at():
    """Plots of targets at `position` [M, 2] m at the times [M] s, seen from `origin` [2] or [M, 2].

    Without rng they lie on the targets; with it the radar's noise is drawn from it.
    """

    def make(position, time, origin=(0.0, 0.0), rng=None, range_sigma=15.0, bearing_sigma=0.0087):
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
        return Plots(
            np.asarray(time, float),
            distance,
            bearing,
            np.zeros(len(position)),
            np.zeros_like(position),
            position,
            np.asarray(covariance, float),
        )

    return make
