"""The density of false plots around own ship, learnt from plots that led to nothing.

They belonged to no track and began none in the next scan, or only a track that was given up soon.
So the first plots of a target do not count as clutter, however many targets there are; and the
plots of a coast, which make one short track after another, do.

Rings grow with range and are divided into sectors. So the cells are small near own ship, where sea
clutter is dense. The map is in range and true bearing, because clutter moves with own ship.
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
WEIGHT = 2.0  # plots that what is known of the surroundings weighs as much as

_EDGES = NEAREST * 2.0 ** (np.arange(RINGS + 1) / RINGS_AN_OCTAVE)
_EDGES[0] = 0.0
_AREA = np.pi * np.diff(_EDGES**2) / SECTORS  # m^2, of a small cell
_AROUND = SECTORS // LARGE_SECTORS  # large cells in a ring
_LARGE_AREA = _AREA.reshape(-1, LARGE_RINGS).sum(1) * LARGE_SECTORS
_LEAST = LEAST_IN_RING / (_AROUND * _LARGE_AREA)  # 1 / m^2


class ClutterMap(NamedTuple):
    """plots [RINGS * SECTORS]: mean number a scan; scans: number of scans learnt from."""

    plots: Array
    scans: int


def empty() -> ClutterMap:
    """An empty map: an empty sea."""
    return ClutterMap(np.zeros(RINGS * SECTORS), 0)


def _ring(range_: Array) -> IntArray:
    octaves = np.log2(np.maximum(range_, NEAREST) / NEAREST)
    return np.minimum((octaves * RINGS_AN_OCTAVE).astype(np.int64), RINGS - 1)


def _cell(range_: Array, bearing: Array) -> IntArray:
    sector = (bearing * (SECTORS / (2 * np.pi))).astype(np.int64) % SECTORS
    return _ring(range_) * SECTORS + sector


def learn(before: ClutterMap, range_: Array, bearing: Array) -> ClutterMap:
    """The map after one more scan, from the plots [M] (m, rad) of which it has become known that
    they led to nothing.

    Of the first scan these are all plots: nothing is known of them yet. The second scan replaces
    it. Then scans count alike at first; later they are forgotten over MEMORY scans.
    """
    found = np.bincount(_cell(range_, bearing), minlength=RINGS * SECTORS)
    weight = 1 / min(max(before.scans, 1), MEMORY)
    return ClutterMap(before.plots + (found - before.plots) * weight, before.scans + 1)


def density(clutter: ClutterMap, range_: Array, bearing: Array) -> Array:
    """Density of false plots [N], per scan and m^2, at the places [N] (m, rad).

    A cell of area A with n plots in T scans, in surroundings of density l that weigh w plots, has
    the density (n + w) / (T A + w / l): the mean of a Poisson rate with a gamma prior. It is taken
    four times: of a large cell in its ring, of the small cell and the eight around it in the large
    one, of the small cell in these. A large cell adds at most CROWD plots to its ring's mean: a
    crowd in one place, such as a rain cell, says nothing of the other side of the ring.
    """
    scans = min(max(clutter.scans - 1, 1), MEMORY)
    a, b, c, d = clutter.plots.reshape(-1, LARGE_SECTORS).T
    first, second = (a + b + c + d).reshape(-1, LARGE_RINGS, _AROUND).swapaxes(0, 1)
    count = first + second  # plots in the large cells
    area = _LARGE_AREA[:, None]
    ring = np.maximum(np.minimum(count, CROWD).sum(1), LEAST_IN_RING)[:, None] / (_AROUND * area)
    large = (scans * count + 1.0) / (scans * area + 1.0 / ring)
    cell = _cell(range_, bearing)
    row = cell // SECTORS
    sector = cell - row * SECTORS
    found: Array = large[row // LARGE_RINGS, sector // LARGE_SECTORS]
    if clutter.scans < 2:  # a target's own first plot would make its small cell one of clutter
        return found
    area = scans * _AREA[row]
    for plots, cells in ((_block(clutter.plots)[cell], 9), (clutter.plots[cell], 1)):
        found = (scans * plots + WEIGHT) / (cells * area + WEIGHT / found)
    return found


def _block(plots: Array) -> Array:
    """Sum [RINGS * SECTORS] of the plots in each small cell and the eight around it."""
    grid = plots.reshape(RINGS, SECTORS)
    ringed = np.zeros((RINGS + 2) * SECTORS)
    three = ringed[SECTORS:-SECTORS]
    three[1:] = plots[1:] + plots[:-1]
    three[:-1] += plots[1:]
    of_ring = three.reshape(RINGS, SECTORS)  # its first and last sector are neighbours
    of_ring[:, 0] = grid[:, 0] + grid[:, 1] + grid[:, -1]
    of_ring[:, -1] = grid[:, -1] + grid[:, -2] + grid[:, 0]
    found: Array = ringed[: -2 * SECTORS] + three + ringed[2 * SECTORS :]
    return found


def least(range_: Array) -> Array:
    """Density [N] of an empty sea, per scan and m^2, at the ranges [N] m."""
    found: Array = _LEAST[_ring(range_) // LARGE_RINGS]
    return found
