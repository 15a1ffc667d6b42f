"""The density of false plots around own ship, learnt from plots that led to no track.

Rings grow with range and are divided into sectors. So the cells are small near own ship, where sea
clutter is dense. The map is in range and true bearing, because clutter moves with own ship.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, IntArray

NEAREST = 50.0  # m, inner edge of the first ring, which also takes closer plots
RINGS_AN_OCTAVE = 4
RINGS = 48  # to 200 km
SECTORS = 16
MEMORY = 20  # scans
# One plot in twenty scans over a whole ring: the least density assumed, for an empty sea.
LEAST_IN_RING = 0.05
CROWD = 50.0  # plots a scan in one cell, beyond which they are no sample of its ring

_EDGES = NEAREST * 2.0 ** (np.arange(RINGS + 1) / RINGS_AN_OCTAVE)
_EDGES[0] = 0.0
_RING_AREA = np.pi * np.diff(_EDGES**2)


class ClutterMap(NamedTuple):
    """plots [RINGS * SECTORS]: mean number a scan, starting at 0; scans: number of scans learnt
    from.
    """

    plots: Array
    scans: int


def empty() -> ClutterMap:
    """An empty map: an empty sea."""
    return ClutterMap(np.zeros(RINGS * SECTORS), 0)


def _cell(range_: Array, bearing: Array) -> IntArray:
    octaves = np.log2(np.maximum(range_, NEAREST) / NEAREST)
    ring = np.minimum((octaves * RINGS_AN_OCTAVE).astype(np.int64), RINGS - 1)
    sector = (bearing * (SECTORS / (2 * np.pi))).astype(np.int64) % SECTORS
    return ring * SECTORS + sector


def learn(before: ClutterMap, range_: Array, bearing: Array) -> ClutterMap:
    """The map after one more scan with the plots [M] (m, rad) that led to nothing.

    They belonged to no track and began none in the next scan. So the first plots of a new target do
    not count as clutter.
    """
    found = np.bincount(_cell(range_, bearing), minlength=RINGS * SECTORS)
    return ClutterMap(before.plots + (found - before.plots) / MEMORY, before.scans + 1)


def density(clutter: ClutterMap, range_: Array, bearing: Array) -> Array:
    """Density of false plots [N], per scan and m^2, at the places [N] (m, rad).

    It is the cell's own count or its ring's mean, whichever is larger: if a cell is emptier than
    its ring, it has too few plots to be trusted. The ring's mean is corrected for its start at 0
    (it is known after a few scans); the cell's is not.
    A cell adds at most CROWD plots to its ring's mean: a crowd in one place, such as a rain cell,
    says nothing of the other side of the ring.
    """
    count = clutter.plots.reshape(RINGS, SECTORS)
    known = 1 - (1 - 1 / MEMORY) ** max(clutter.scans, 1)
    ring = np.maximum(np.minimum(count, CROWD).sum(1) / known, LEAST_IN_RING)
    here = np.maximum(count * SECTORS, ring[:, None]) / _RING_AREA[:, None]
    found: Array = here.ravel()[_cell(range_, bearing)]
    return found
