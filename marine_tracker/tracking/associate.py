"""Which track takes which plot: the best assignment of all, solved in parts."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..types import Array, IntArray
from .gate import Pairs
from .sparse_assignment import best_pairs

FEW = 32  # tracks; so small a matrix is solved faster than it is split
WIDE = 6  # the other side of a component of two tracks, or two plots, that is solved with the rest
# Tracks times plots of a component beyond which it is solved as a graph; and, should that take more
# than so many looks at a pair, as a matrix after all, unless it had more than so many places.
LARGE, PATIENCE, HUGE = 250_000, 10, 25_000_000


def gain(pairs: Pairs, size: float) -> Array:
    """Gain of each pair [P] compared with leaving its track and plot alone: > 0, log-likelihood.

    size  of the gate, squared Mahalanobis distance
    """
    found: Array = size - pairs.nis + (pairs.log_det.max(initial=0.0) - pairs.log_det) + 1e-9
    return found


def associate(track: IntArray, plot: IntArray, gain: Array, tracks: int, plots: int) -> IntArray:
    """The assignment with the largest total gain; every track and plot is used at most once.

    track, plot  int [P], the admissible pairs
    gain         [P] > 0, what a pair is worth over leaving its track and plot alone

    Returns plot_of, int [tracks]: the plot of each track, or -1.

    Most pairs compete with nothing, and most others are one track with several plots or one plot
    with several tracks: these are settled at once. What remains falls into connected components;
    each is solved exactly, the small ones as matrices (Jonker-Volgenant), the large ones as graphs,
    so the whole is the global optimum.
    """
    plot_of = np.full(tracks, -1, np.int64)
    plots_of_track = np.bincount(track, minlength=tracks)
    tracks_of_plot = np.bincount(plot, minlength=plots)
    shared = tracks_of_plot[plot] > 1
    if not shared.any() and len(track) == np.count_nonzero(plots_of_track):
        plot_of[track] = plot
        return plot_of
    torn = plots_of_track[track] > 1
    track_free = np.bincount(track, shared, tracks)[track] == 0  # no other track wants its plots
    plot_free = np.bincount(plot, torn, plots)[plot] == 0  # its tracks want no other plot
    for free, group in ((track_free, track), (plot_free & ~track_free, plot)):
        best = _best_of_each(group, gain, free.nonzero()[0])
        plot_of[track[best]] = plot[best]
    hard = (~(track_free | plot_free)).nonzero()[0]
    if len(hard):
        best = hard[_solve(track[hard], plot[hard], gain[hard])]
        plot_of[track[best]] = plot[best]
    return plot_of


def _best_of_each(group: IntArray, gain: Array, pairs: IntArray) -> IntArray:
    """Of the given pairs, the one with the largest gain in each group."""
    pairs = pairs[np.lexsort((-gain[pairs], group[pairs]))]
    first = np.ones(len(pairs), bool)
    first[1:] = group[pairs[1:]] != group[pairs[:-1]]
    return pairs[first]


def _solve(track: IntArray, plot: IntArray, gain: Array) -> IntArray:
    """The pairs of the optimal assignment; many are solved one connected component at a time."""
    tracks, row = np.unique(track, return_inverse=True)
    plots, column = np.unique(plot, return_inverse=True)
    if len(tracks) <= FEW:
        return _assign(row, column, gain, np.arange(len(row)), len(tracks), len(plots))
    track_part, plot_part = components(row, column, len(tracks), len(plots))
    height, row_place = places(track_part, len(tracks))
    width, column_place = places(plot_part, len(tracks))
    row, column, part = row_place[row], column_place[column], track_part[row]
    two_rows, two_columns = (height == 2) & (width <= WIDE), (width == 2) & (height <= WIDE)
    of_two, of_two_columns = two_rows[part], (two_columns & ~two_rows)[part]
    order = part.argsort(kind='stable')
    order = order[~(of_two | of_two_columns)[order]]
    parts = (height.astype(bool) & ~two_rows & ~two_columns).nonzero()[0]
    return np.concatenate(
        [
            _of_two(row, column, gain, part, of_two.nonzero()[0]),
            _of_two(column, row, gain, part, of_two_columns.nonzero()[0]),
            *(
                _assign(row[pairs], column[pairs], gain[pairs], pairs, height[c], width[c])
                for c, pairs in zip(parts, np.split(order, part[order].searchsorted(parts[1:])))
            ),
        ]
    )


def _of_two(
    row: IntArray, column: IntArray, gain: Array, part: IntArray, pairs: IntArray
) -> IntArray:
    """Of the given pairs of components with two rows each, and at least two columns, those of the
    optimal assignments: the best of all choices of two columns, for all components at once."""
    if not len(pairs):
        return pairs
    parts, part = np.unique(part[pairs], return_inverse=True)
    row, column, columns = row[pairs], column[pairs], int(column[pairs].max()) + 1
    worth = np.zeros((2, len(parts), columns))
    which = np.full((2, len(parts), columns), -1)
    worth[row, part, column], which[row, part, column] = gain[pairs], pairs
    total = worth[0][:, :, None] + worth[1][:, None, :]
    total[:, np.arange(columns), np.arange(columns)] = -1.0  # one column for both
    first, second = np.divmod(total.reshape(len(parts), -1).argmax(1), columns)
    every = np.arange(len(parts))
    taken = np.append(which[0, every, first], which[1, every, second])
    return taken[taken >= 0]


def _assign(
    row: IntArray, column: IntArray, gain: Array, pairs: IntArray, height: int, width: int
) -> IntArray:
    """Of the pairs of one component, those of the optimal assignment."""
    if height * width > LARGE:
        patience = PATIENCE if height * width <= HUGE else np.inf
        best = best_pairs(row, column, gain, height, width, patience)
        if best is not None:
            return pairs[best]
    worth = np.zeros((height, width))
    which = np.full((height, width), -1, np.int32)
    worth[row, column], which[row, column] = gain, pairs
    taken = which[linear_sum_assignment(worth, maximize=True)]
    found: IntArray = taken[taken >= 0]
    return found


def components(
    row: IntArray, column: IntArray, rows: int, columns: int
) -> tuple[IntArray, IntArray]:
    """Connected components of a bipartite graph with the edges (row [P], column [P]).

    Returns the smallest row of its component for each row and each column, by passing it on
    until nothing changes; a row also takes over what the row it points to points to, so long chains
    take few rounds too. The graphs here are many and tiny: a sixth of the time that a sparse-graph
    routine spends on its set-up.
    """
    of_row = np.arange(rows)
    while True:
        of_column = np.full(columns, rows)
        np.minimum.at(of_column, column, of_row[row])
        lower = of_row.copy()
        np.minimum.at(lower, row, of_column[column])
        lower = lower[lower]
        if np.array_equal(lower, of_row):
            return of_row, of_column
        of_row = lower


def places(part: IntArray, parts: int) -> tuple[IntArray, IntArray]:
    """Members of each part [parts], and each member's place within its part."""
    size = np.bincount(part, minlength=parts)
    place = np.empty(len(part), np.int64)
    place[np.argsort(part, kind='stable')] = np.arange(len(part)) - np.repeat(
        np.cumsum(size) - size, size
    )
    return size, place
