"""Cells over the threshold put together: ship-sized pieces, split where two maxima stand apart."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from ..types import Array, BoolArray, IntArray, StrengthArray
from .lobes import Lobe

DIP = 0.9  # of a factor e in power, 4 dB: a valley that deep parts two maxima
LINE = 3  # maxima in a row, one behind the other: one long ship
ALONG = np.linspace(0.0, 1.0, 9)[1:-1]  # where the way between two maxima is looked at
TOUCH = np.ones((3, 3), bool)


class Pieces(NamedTuple):
    """Cells [n], and the piece of each.

    row, sample  [n]  of the stack of spokes
    piece        [n]  0 to number - 1
    number       how many pieces
    peak         [number, 2]  row and sample of the strongest place of each, smoothed
    origin       [number]     the component that each was a part of
    """

    row: IntArray
    sample: IntArray
    piece: IntArray
    number: int
    peak: IntArray
    origin: IntArray


def label(hits: BoolArray, lobe: Lobe) -> NDArray[np.int32]:
    """[rows, samples] the component of each cell that is a hit, from 1; 0 elsewhere, and also in
    the gaps that a component bridges: a quarter of a beam, and one sample."""
    joined = hits.copy()
    for gap in range(1, lobe.gap + 1):
        joined[gap:] |= hits[:-gap]
    joined[:, 1:] |= joined[:, :-1]
    labels, _ = ndimage.label(joined, TOUCH)
    return labels


def split(
    row: IntArray,
    sample: IntArray,
    component: IntArray,
    whole: BoolArray,
    strength: StrengthArray,
    lobe: Lobe,
    slope: Array,
) -> Pieces:
    """Pieces of the components [n] of the cells, which are in the order of their components.

    whole     [count]          components that are not split
    strength  [rows, samples]  of the stack
    slope     [count]          steps in a factor e of power where each component is
    """
    count = len(whole)
    edge = np.searchsorted(component, np.arange(count + 1))
    first, cells = edge[:-1], np.diff(edge)
    low = np.stack([np.minimum.reduceat(a, first) for a in (row, sample)], 1)
    high = np.stack([np.maximum.reduceat(a, first) for a in (row, sample)], 1) + 1
    wide = ((high - low) > lobe.single).any(1) & ~whole
    value = strength[row, sample].astype(np.int64)
    top = np.lexsort((value, component))[edge[1:] - 1]
    peak = np.stack([row[top], sample[top]], 1)
    piece = component.copy()
    peaks, origins, total = [peak], [np.arange(count)], count
    for k in np.flatnonzero(wide & (cells > 3)).tolist():
        its = slice(edge[k], edge[k + 1])
        found, which = _maxima(row[its], sample[its], low[k], high[k], strength, lobe, slope[k])
        peaks[0][k] = found[0]
        if len(found) > 1:
            piece[its] = np.where(which == 0, k, total + which - 1)
            peaks.append(found[1:])
            origins.append(np.full(len(found) - 1, k))
            total += len(found) - 1
    return Pieces(row, sample, piece, total, np.concatenate(peaks), np.concatenate(origins))


def _maxima(row, sample, low, high, strength, lobe: Lobe, slope):
    """The maxima [P, 2] of a component, strongest first, and the maximum [n] of each cell."""
    patch = strength[low[0] : high[0], low[1] : high[1]].astype(np.float32)
    smooth = ndimage.uniform_filter(patch, lobe.smooth, mode='nearest')
    at = (row - low[0], sample - low[1])
    inside = np.zeros(patch.shape, bool)
    inside[at] = True
    peaked = inside & (smooth >= ndimage.maximum_filter(smooth, lobe.apart) - 1e-4)
    if not peaked.any():  # its maxima belong to a neighbour that is stronger: it has one piece
        return np.array([low + np.argwhere(inside)[smooth[inside].argmax()]]), np.zeros(
            len(row), np.int64
        )
    places = np.argwhere(peaked)
    plateau, count = ndimage.label(peaked, TOUCH) if len(places) > 1 else (peaked, 1)
    if count == 1:
        middle = np.rint(places.mean(0)).astype(np.int64)
        return (middle + low)[None], np.zeros(len(row), np.int64)
    owner = plateau[peaked] - 1
    sums = np.stack([np.bincount(owner, column, count) for column in places.T], 1)
    centre = sums / np.bincount(owner, minlength=count)[:, None]
    height = np.zeros(count)
    height[owner] = smooth[peaked]
    group = _merged(smooth, centre, height, lobe, DIP * slope)
    order = np.argsort(-height, kind='stable')
    _, start = np.unique(group[order], return_index=True)
    chosen = order[np.sort(start)]  # the strongest of each group
    span = np.ptp(centre[chosen], axis=0)
    if len(chosen) >= LINE and span[0] < lobe.shape[0] and span[1] < lobe.ship:
        chosen, group = chosen[:1], np.zeros(count, np.int64)
    rank = np.zeros(count, np.int64)
    rank[chosen] = np.arange(len(chosen))
    rank = rank[chosen[np.argsort(group[chosen])]][group]
    which = np.zeros(len(row), np.int64)
    if len(chosen) > 1:
        _, nearest = cKDTree(places / lobe.shape).query(np.stack(at, 1) / lobe.shape)
        which = rank[owner[nearest]]
    return np.rint(centre[chosen]).astype(np.int64) + low, which


def _merged(smooth, centre, height, lobe: Lobe, dip) -> IntArray:
    """The group [P] of each maximum: those without a valley in between are one."""
    parent = np.arange(len(centre))
    if len(centre) == 1:
        return parent
    pairs = cKDTree(centre / lobe.shape).query_pairs(4.0, output_type='ndarray')
    one, other = pairs.T
    way = centre[one, None] + ALONG[:, None] * (centre[other] - centre[one])[:, None]
    place = np.rint(way).astype(np.int64)
    valley = smooth[place[..., 0], place[..., 1]].min(1)
    joined = np.minimum(height[one], height[other]) - valley < dip
    return _grouped(len(centre), one[joined], other[joined])


def _grouped(count: int, one: IntArray, other: IntArray) -> IntArray:
    """[count] the group of each thing, from 0, where pairs of one and other are of one group."""
    group = np.arange(count)
    while True:
        least = np.minimum(group[one], group[other])
        if (group[one] == group[other]).all():
            return np.unique(group, return_inverse=True)[1]
        np.minimum.at(group, group[one], least)
        np.minimum.at(group, group[other], least)
        group = group[group]
