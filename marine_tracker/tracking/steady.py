"""Which tracks go steadily: a straight line in time through their last plots.

A track that hops from plot to plot along a quay also gets far, and a filter gives it a speed. But
its plots lie on no line. Those of a ship under way do, to within their noise.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, BoolArray

MEMORY = 12  # plots
LEAST = 5  # plots
SURE = 36.0  # squared deviations of the slope from rest
SCATTER = 1.5  # times the variance of a plot: more is no line
SLOWEST = 0.5  # m/s


class Line(NamedTuple):
    """Sums over the last plots of A tracks; older ones count less.

    plots     [A]     number
    time      [A]     s, mean; spread [A] s^2, sum of the squares about it
    position  [A, 2]  m, mean; scatter [A] m^2, sum of the squares about it
    slope     [A, 2]  m s, sum of the products of time and position about their means
    """

    plots: Array
    time: Array
    spread: Array
    position: Array
    scatter: Array
    slope: Array


def begin(position: Array, time: Array) -> Line:
    """Lines of one plot each: position [A, 2] m, time [A] s."""
    none = np.zeros(len(time))
    return Line(none + 1, time, none, position, none, np.zeros((len(time), 2)))


def follow(before: Line, hit: BoolArray, position: Array, time: Array) -> Line:
    """With one more plot for the tracks `hit` [A]: position [A, 2] m, time [A] s."""
    keeps = 1 - 1 / MEMORY
    old = keeps * before.plots
    count = old + 1
    late, off = time - before.time, position - before.position
    weight = old / count
    now = Line(
        count,
        before.time + late / count,
        keeps * before.spread + weight * late**2,
        before.position + off / count[:, None],
        keeps * before.scatter + weight * _squares(off),
        keeps * before.slope + (weight * late)[:, None] * off,
    )
    return Line(
        *(
            np.where(hit.reshape((-1,) + (1,) * (a.ndim - 1)), a, b)
            for a, b in zip(now, before, strict=True)
        )
    )


def speed(line: Line) -> Array:
    """m/s [A], of the line."""
    found: Array = np.hypot(*line.slope.T) / np.maximum(line.spread, 1e-9)
    return found


def under_way(line: Line, variance: Array) -> BoolArray:
    """Mask [A] of the tracks that surely move along a line; variance [A] m^2 of their plots."""
    spread = np.maximum(line.spread, 1e-9)
    explained = _squares(line.slope) / spread
    rest = (line.scatter - explained) / np.maximum(2 * (line.plots - 2), 1e-9)
    found: BoolArray = (
        (line.plots >= LEAST - 1)  # older ones count less
        & (explained > SURE * variance)
        & (rest < SCATTER * variance)
        & (speed(line) > SLOWEST)
    )
    return found


def _squares(vector: Array) -> Array:
    """Squared length [A] of vectors [A, 2]."""
    east, north = vector.T
    found: Array = east * east + north * north
    return found
