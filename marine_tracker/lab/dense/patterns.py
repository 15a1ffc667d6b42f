"""Plots in a crowd, in eight patterns; one scan after the other, each with noise of its own."""

from collections.abc import Callable

import numpy as np

from ...geometry import to_range_bearing, unit_vector, wrap_bearing
from ...types import Array

# Where the patterns lie, m east and north of own ship, and how large they are, m.
HERE, THERE = np.array([3500.0, 2000.0]), np.array([-9000.0, -6000.0])
SMALL, RAIN, WINDING = 100.0, 600.0, 500.0
RING, DEPTH = 6000.0, 20.0
COAST = np.array([[2000.0, -9000.0], [3500, -7000], [3000, -5500], [5000, -4000], [8000, -4500]])

Pattern = Callable[[int, np.random.Generator], Array]


def _ball(count: int, rng: np.random.Generator) -> Array:
    distance = SMALL * np.sqrt(rng.random(count))
    return HERE + distance[:, None] * unit_vector(rng.uniform(0, 2 * np.pi, count))


def _ring(count: int, rng: np.random.Generator) -> Array:
    distance = RING + rng.normal(0, DEPTH, count)
    return distance[:, None] * unit_vector(rng.uniform(0, 2 * np.pi, count))


def _line(count: int, rng: np.random.Generator) -> Array:
    return HERE + rng.uniform(-0.3, 0.3, count)[:, None] * HERE + rng.normal(0, 2.0, (count, 2))


def _rain(count: int, rng: np.random.Generator) -> Array:
    return HERE + rng.normal(0, RAIN, (count, 2))


def _same(count: int, rng: np.random.Generator) -> Array:
    return np.tile(HERE, (count, 1))


def _spiral(count: int, rng: np.random.Generator) -> Array:
    turned = 8 * np.pi * np.sqrt(np.linspace(0, 1, count))
    arms = WINDING * turned / turned[-1]
    return HERE + arms[:, None] * unit_vector(turned) + rng.normal(0, 2.0, (count, 2))


def _land(count: int, rng: np.random.Generator) -> Array:
    along = np.linspace(0, len(COAST) - 1, count)
    shore = np.column_stack([np.interp(along, range(len(COAST)), c) for c in COAST.T])
    inland = np.random.default_rng(1).exponential(150.0, count)  # every scan the same
    return shore + inland[:, None] * [0.0, -1.0] + rng.normal(0, 10.0, (count, 2))


def _two(count: int, rng: np.random.Generator) -> Array:
    half = _ball(count, rng)
    half[::2] += THERE - HERE
    return half


PATTERNS: dict[str, Pattern] = {
    'ball': _ball,
    'ring': _ring,
    'line': _line,
    'rain cell': _rain,
    'all the same': _same,
    'spiral': _spiral,
    'land': _land,
    'two clouds': _two,
}


def polar(place: Array) -> tuple[Array, Array]:
    """Range [M] m and bearing [M] rad of places [M, 2] m about own ship at the origin."""
    range_, bearing = to_range_bearing(place)
    return range_, wrap_bearing(bearing)
