"""Maps land: echoes that stay at one place, in a piece longer than any ship.

The ground is divided into squares. For each square the map keeps the share of scans with an echo in
it. Squares that keep echoing and touch each other form one piece. A piece longer than LONGEST is
land, and so is everything on it or next to it. A broken coast is recognised by its length. A ship
at anchor keeps echoing too, but it is too short. Quays and moles belong to their coast. An islet no
longer than a ship stays a target.
"""

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..types import Array, BoolArray, IntArray

SQUARE = 50.0  # m
LONGEST = 450.0  # m, longer than any ship
MEMORY = 20  # scans
KEEPS = 0.4  # share of scans with an echo from which on a square counts as one that keeps echoing
SMEARED = np.linspace(-0.75, 0.75, 7)  # beam widths
FORGOTTEN = 0.02  # likewise; below this a square is forgotten


class LandMap(NamedTuple):
    """G squares that echoed.

    square  [G, 2]  east and north, in SQUAREs
    share   [G]     of the scans; starts at 0
    land    [G]     it is part of a piece longer than a ship
    scans   number of scans learnt from
    """

    square: IntArray
    share: Array
    land: BoolArray
    scans: int


def empty() -> LandMap:
    """An empty map: open sea."""
    return LandMap(np.zeros((0, 2), np.int64), np.zeros(0), np.zeros(0, bool), 0)


def learn(before: LandMap, position: Array, width: Array) -> LandMap:
    """The map after one more scan.

    position [M, 2] m; width [M, 2] m: across the line of sight, the width of the beam there. An
    echo fills all squares over which it may be smeared, so a far shore has no gaps.
    """
    hit = np.unique(
        _square(position[:, None] + SMEARED[:, None] * width[:, None]).reshape(-1, 2), axis=0
    )
    square, where = np.unique(np.concatenate([before.square, hit]), axis=0, return_inverse=True)
    where = where.reshape(-1)
    share = np.zeros(len(square))
    share[where[: len(before.share)]] = before.share * (1 - 1 / MEMORY)
    share[where[len(before.share) :]] += 1 / MEMORY
    kept = share >= FORGOTTEN
    square, share, scans = square[kept], share[kept], before.scans + 1
    known = 1 - (1 - 1 / MEMORY) ** scans
    return LandMap(square, share, _long(square, share >= KEEPS * known), scans)


def on_land(land: LandMap, position: Array) -> BoolArray:
    """Whether positions [M, 2] m lie on a square of land, or next to one."""
    squares = land.square[land.land]
    if not len(squares) or not len(position):
        return np.zeros(len(position), bool)
    near, _ = cKDTree(squares).query(_square(position), p=np.inf, distance_upper_bound=1.5)
    found: BoolArray = np.isfinite(near)
    return found


def _square(position: Array) -> IntArray:
    return np.floor(np.asarray(position) / SQUARE).astype(np.int64)


def _long(square: IntArray, keeps: BoolArray) -> BoolArray:
    """Which squares [G] keep echoing and are part of a piece longer than a ship."""
    rows = keeps.nonzero()[0]
    long = np.zeros(len(square), bool)
    if not len(rows):
        return long
    chosen = square[rows]
    pairs = cKDTree(chosen).query_pairs(1.5, p=np.inf, output_type='ndarray').T
    pieces, piece = connected_components(
        coo_array((np.ones(pairs.shape[1], np.int8), tuple(pairs)), shape=(len(rows),) * 2),
        directed=False,
    )
    # The longest extent along eight directions, at most 2 % less than the piece's length.
    turn = np.pi / 8 * np.arange(8)
    along = chosen @ np.array([np.cos(turn), np.sin(turn)])
    ends = np.full((2, pieces, 8), -np.inf)
    np.maximum.at(ends[0], piece, along)
    np.maximum.at(ends[1], piece, -along)
    long[rows] = (ends.sum(0).max(1) * SQUARE > LONGEST)[piece]
    return long
