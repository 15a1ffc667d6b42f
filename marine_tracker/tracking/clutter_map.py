"""Where false plots come from: their density about own ship, learnt from plots that led nowhere.

Rings grow with range and are cut into sectors, so near own ship, where sea clutter is dense, the
cells are small. The map lies in range and true bearing: clutter goes with own ship.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, IntArray

NEAREST = 50.0  # m, the first ring's inner edge; what is nearer belongs to it
RINGS_AN_OCTAVE = 4
RINGS = 48  # to 200 km
SECTORS = 16
MEMORY = 20  # scans
# One plot in twenty scans over a whole ring: what an empty sea is taken to hold, at least.
LEAST_IN_RING = 0.05

_EDGES = NEAREST * 2.0 ** (np.arange(RINGS + 1) / RINGS_AN_OCTAVE)
_EDGES[0] = 0.0
_RING_AREA = np.pi * np.diff(_EDGES**2)


class ClutterMap(NamedTuple):
    """plots [RINGS * SECTORS]: mean number a scan, begun at 0; scans: how many were learnt from."""

    plots: Array
    scans: int


def empty() -> ClutterMap:
    """Nothing is known: an empty sea."""
    return ClutterMap(np.zeros(RINGS * SECTORS), 0)


def _cell(range_: Array, bearing: Array) -> IntArray:
    octaves = np.log2(np.maximum(range_, NEAREST) / NEAREST)
    ring = np.minimum((octaves * RINGS_AN_OCTAVE).astype(np.int64), RINGS - 1)
    sector = (bearing * (SECTORS / (2 * np.pi))).astype(np.int64) % SECTORS
    return ring * SECTORS + sector


def learn(before: ClutterMap, range_: Array, bearing: Array) -> ClutterMap:
    """The map after one more scan with the plots [M] (m, rad) that led to nothing.

    They belonged to no track and began none in the next scan: a new target's first plots do not
    count against it.
    """
    found = np.bincount(_cell(range_, bearing), minlength=RINGS * SECTORS)
    return ClutterMap(before.plots + (found - before.plots) / MEMORY, before.scans + 1)


def density(clutter: ClutterMap, range_: Array, bearing: Array) -> Array:
    """False plots a scan and m^2 [N] at the places [N] (m, rad).

    The cell's own count or its ring's mean, whichever is more: a cell has seen too few plots to
    be trusted where it is emptier than its ring. The ring's mean is set right for its start
    at 0 (it is known after a few scans), the cell's is not.
    """
    count = clutter.plots.reshape(RINGS, SECTORS)
    known = 1 - (1 - 1 / MEMORY) ** max(clutter.scans, 1)
    ring = np.maximum(count.sum(1) / known, LEAST_IN_RING)
    here = np.maximum(count * SECTORS, ring[:, None]) / _RING_AREA[:, None]
    found: Array = here.ravel()[_cell(range_, bearing)]
    return found
