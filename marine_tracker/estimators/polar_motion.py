"""Motion as seen by a radar at rest (range, radial speed, bearing, bearing rate), and on the
ground.

A velocity (e, n) is v along the line of sight and R omega to its right. Bearings grow clockwise.
"""

import numpy as np

from ..geometry import to_range_bearing, unit_vector
from ..types import Array

NEAREST = 1.0  # m; a bearing has no meaning closer than this


def to_polar(mean: Array, origin: Array) -> tuple[Array, Array]:
    """[K, 4] range m, radial speed m/s, bearing rad, bearing rate rad/s as seen from the origins.

    mean [K, 4] on the ground, origin [K, 2] at rest. Also the derivatives [K, 4, 4] by mean.
    """
    distance, bearing = to_range_bearing(mean[:, :2] - origin)
    distance = np.maximum(distance, NEAREST)
    along, across = axes(bearing)
    speed = (mean[:, 2:] * along).sum(1)
    rate = (mean[:, 2:] * across).sum(1) / distance
    by_mean = np.zeros((len(mean), 4, 4))
    by_mean[:, 0, :2] = by_mean[:, 1, 2:] = along
    by_mean[:, 1, :2] = rate[:, None] * across
    by_mean[:, 2, :2] = by_mean[:, 3, 2:] = across / distance[:, None]
    by_mean[:, 3, :2] = (
        -((speed / distance)[:, None] * across + rate[:, None] * along) / distance[:, None]
    )
    return np.stack([distance, speed, bearing, rate], -1), by_mean


def to_ground(polar: Array, origin: Array) -> tuple[Array, Array]:
    """The inverse of `to_polar`: mean [K, 4], and its derivatives [K, 4, 4] by polar."""
    distance, speed, bearing, rate = polar.T
    along, across = axes(bearing)
    distance, speed, rate = distance[:, None], speed[:, None], rate[:, None]
    mean = np.concatenate([origin + distance * along, speed * along + distance * rate * across], 1)
    by_polar = np.zeros((len(polar), 4, 4))
    by_polar[:, :2, 0] = by_polar[:, 2:, 1] = along
    by_polar[:, 2:, 0] = rate * across
    by_polar[:, :2, 2] = by_polar[:, 2:, 3] = distance * across
    by_polar[:, 2:, 2] = speed * across - distance * rate * along
    return mean, by_polar


def axes(bearing: Array) -> tuple[Array, Array]:
    """Unit vectors [K, 2] along the lines of sight, and to their right."""
    along = unit_vector(bearing)
    return along, np.stack([along[:, 1], -along[:, 0]], -1)
