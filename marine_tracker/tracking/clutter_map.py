"""The density of false plots around own ship, learnt from the plots themselves.

Rings grow with range and are divided into sectors. So the cells are small near own ship, where sea
clutter is dense. The map is in range and true bearing, because clutter moves with own ship.

Large cells count the plots that led to nothing: they neither belonged to a track nor began one.
That tells the sea, and the first plots of a new target do not count as clutter. Small cells count
all plots but those of sure targets. That tells the places where plots come again and again: quays
and marks, which also make tracks.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, IntArray

NEAREST = 50.0  # m, inner edge of the first ring, which also takes closer plots
RINGS_AN_OCTAVE, SECTORS = 8, 64  # of the small cells
RINGS = 96  # to 200 km
LARGE_RINGS, LARGE_SECTORS = 2, 4  # small cells in a large one
MEMORY = 20  # scans
# One plot in twenty scans over a whole ring of large cells: the least density, for an empty sea.
LEAST_IN_RING = 0.05
CROWD = 50.0  # plots a scan in one large cell, beyond which they are no sample of its ring
# Plots that what is known of the surroundings weighs as much as: for a large cell its ring, for a
# small cell the large one.
RING_WEIGHS, LARGE_WEIGHS = 1.0, 0.1
import os
W1=float(os.environ.get('W1','1'));W2=float(os.environ.get('W2','1'))
A_TRACK, FEW = 3.0, 5  # plots that confirm a track; scans that tell little

_EDGES = NEAREST * 2.0 ** (np.arange(RINGS + 1) / RINGS_AN_OCTAVE)
_EDGES[0] = 0.0
_AREA = np.pi * np.diff(_EDGES**2) / SECTORS  # m^2, of a small cell
_AROUND = SECTORS // LARGE_SECTORS  # large cells in a ring
_LARGE_AREA = _AREA.reshape(-1, LARGE_RINGS).sum(1) * LARGE_SECTORS
_LEAST = LEAST_IN_RING / (_AROUND * _LARGE_AREA)  # 1 / m^2


class ClutterMap(NamedTuple):
    """Mean numbers a scan [RINGS * SECTORS], and the number of scans learnt from.

    doubtful  plots of no sure target
    lone      plots that led to nothing
    """

    doubtful: Array
    lone: Array
    scans: int


def empty() -> ClutterMap:
    """An empty map: an empty sea."""
    none = np.zeros(RINGS * SECTORS)
    return ClutterMap(none, none, 0)


def _ring(range_: Array) -> IntArray:
    octaves = np.log2(np.maximum(range_, NEAREST) / NEAREST)
    return np.minimum((octaves * RINGS_AN_OCTAVE).astype(np.int64), RINGS - 1)


def _cell(range_: Array, bearing: Array) -> IntArray:
    sector = (bearing * (SECTORS / (2 * np.pi))).astype(np.int64) % SECTORS
    return _ring(range_) * SECTORS + sector


def learn(
    before: ClutterMap, doubtful: tuple[Array, Array], lone: tuple[Array, Array]
) -> ClutterMap:
    """The map after one more scan with the plots that are of no sure target, and with those of the
    scan before that led to nothing: their ranges [M] m and bearings [M] rad.

    The first scans count alike; later ones are forgotten over MEMORY scans.
    """
    scans = before.scans + 1

    def mean(known: Array, places: tuple[Array, Array], of: int) -> Array:
        found = np.bincount(_cell(*places), minlength=RINGS * SECTORS)
        return known + (found - known) / min(of, MEMORY)

    seen = mean(before.doubtful, doubtful, scans)
    # In the first scan nothing has led to anything yet.
    nowhere = mean(before.lone, lone, scans - 1) if before.scans else seen
    return ClutterMap(seen, nowhere, scans)


def density(clutter: ClutterMap, range_: Array, bearing: Array) -> Array:
    """Density of false plots [N], per scan and m^2, at the places [N] (m, rad).

    A cell of area A with n plots in T scans, in surroundings of density l that weigh w plots, has
    the density (n + w) / (T A + w / l): the mean of a Poisson rate with a gamma prior. A small cell
    in which plots come again and again, or in which with the eight around it they do, is not of its
    surroundings: their count, without the first plots of one track, is then the density, if that
    is larger. A large cell adds at most CROWD plots to its ring's mean: a crowd in one place, such
    as a rain cell, says nothing of the other side of the ring.
    """
    scans = min(clutter.scans, MEMORY)
    shape = RINGS // LARGE_RINGS, LARGE_RINGS, _AROUND, LARGE_SECTORS
    count = clutter.lone.reshape(shape).sum((1, 3))
    area = _LARGE_AREA[:, None]
    ring = np.maximum(np.minimum(count, CROWD).sum(1), LEAST_IN_RING)[:, None] / (_AROUND * area)
    large = (scans * count + RING_WEIGHS) / (scans * area + RING_WEIGHS / ring)
    cell = _cell(range_, bearing)
    row, sector = np.divmod(cell, SECTORS)
    here: Array = large[row // LARGE_RINGS, sector // LARGE_SECTORS]
    area = _AREA[row]
    block = scans * _block(clutter.lone)[cell]
    here = (block + W1) / (scans * 9 * area + W1 / here)
    found: Array = (scans * clutter.lone[cell] + W2) / (scans * area + W2 / here)
    return found


def _block(count: Array) -> Array:
    """Sum [RINGS * SECTORS] over each small cell and the eight around it."""
    grid = count.reshape(RINGS, SECTORS)
    three = np.pad(grid + np.roll(grid, 1, 1) + np.roll(grid, -1, 1), ((1, 1), (0, 0)))
    found: Array = (three[:-2] + three[1:-1] + three[2:]).ravel()
    return found


def least(range_: Array) -> Array:
    """Density [N] of an empty sea, per scan and m^2, at the ranges [N] m."""
    found: Array = _LEAST[_ring(range_) // LARGE_RINGS]
    return found
