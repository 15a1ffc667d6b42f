"""The lit edge of clusters: the nearest cell in each beam, moved back by the radar's smear.

Cells fill a hull unevenly and spread beyond its edges. The first echo in a beam shows where the
near side is. These cells are used to measure an outline.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import unit_vector, wrap_angle
from ..types import Array, IntArray, Plots
from .smear import ACROSS, ALONG

FRINGE = 1.1  # in deviations of a cell; echoes reach this far beyond a hull
NOISE = 0.36  # of a cell's R: variance of an edge cell, which is known to within one cell


class Edge(NamedTuple):
    """Where the edges of C hulls are, E points ordered by cluster.

    cluster   [E]
    position  [E, 2]     m, east and north
    noise     [C, 2, 2]  m^2, of one point of each cluster
    """

    cluster: IntArray
    position: Array
    noise: Array


def lit_edge(
    cells: Plots, of_cell: IntArray, noise: Array, range_resolution: float, beam_width: float
) -> Edge:
    """The edges of all clusters; of_cell [M] is the cluster of each cell.

    noise [C, 2, 2] m^2, R of a cell of each cluster; range_resolution m, beam_width rad.
    """
    count = int(of_cell.max(initial=-1)) + 1
    middle = np.arctan2(*(np.bincount(of_cell, f(cells.bearing), count) for f in (np.sin, np.cos)))
    off = wrap_angle(cells.bearing - middle[of_cell])
    column = np.rint(off / beam_width).astype(np.int64)
    order = np.lexsort((cells.range, column, of_cell))
    first = np.ones(len(order), bool)
    first[1:] = (np.diff(of_cell[order]) != 0) | (np.diff(column[order]) != 0)
    nearest = order[first]
    cluster, off = of_cell[nearest], off[nearest]
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, cluster, off)
    np.maximum.at(high, cluster, off)
    centre, span = 0.5 * (low + high), np.maximum(high - low, beam_width)
    shrink = np.maximum(1 - 2 * FRINGE * ACROSS * beam_width / span, 0.0)
    bearing = (middle + centre)[cluster] + (off - centre[cluster]) * shrink[cluster]
    distance = cells.range[nearest] + FRINGE * ALONG * range_resolution
    return Edge(
        cluster, cells.origin[nearest] + distance[:, None] * unit_vector(bearing), NOISE * noise
    )
