"""Pairs of targets and tracks, and GOSPA with p = 2, alpha = 2.

Rahmathullah, Garcia-Fernandez, Svensson, "Generalized optimal sub-pattern assignment metric",
FUSION 2017.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from ..types import Array


def assign(distance: Array, cutoff: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows and columns of the pairs with the least sum of squared distances [A, B], all below
    cutoff.
    """
    row, column = linear_sum_assignment(np.minimum(distance, cutoff) ** 2)
    near = distance[row, column] < cutoff
    return row[near], column[near]


def gospa_parts(distance: Array, cutoff: float) -> tuple[float, float, float]:
    """Squared GOSPA split into localisation, missed and false, m^2, from distances [A, B] m.

    A are targets, B are tracks. Each target without a track, and each track without a target, costs
    cutoff^2 / 2.
    """
    row, column = assign(distance, cutoff)
    targets, tracks = distance.shape
    alone = cutoff**2 / 2
    return (
        float((distance[row, column] ** 2).sum()),
        (targets - len(row)) * alone,
        (tracks - len(row)) * alone,
    )


def assign_sticky(
    distance: Array, cutoff: float, last: Sequence[Sequence[int]]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs where each row first keeps its last column if within the cutoff; then the best pairs of
    the rest.

    last  for each row its last column, in a list; an empty list for none
    """
    kept = np.array(
        [
            (row, column)
            for row, columns in enumerate(last)
            for column in columns
            if distance[row, column] < cutoff
        ],
        np.int64,
    ).reshape(-1, 2)
    free = distance.copy()
    free[kept[:, 0]] = cutoff
    free[:, kept[:, 1]] = cutoff
    row, column = assign(free, cutoff)
    return np.append(kept[:, 0], row), np.append(kept[:, 1], column)
