"""Which track takes which plot: the best assignment of all, found piece by piece."""

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components


def associate(track, plot, gain, tracks: int, plots: int):
    """The assignment with the largest total gain; every track and plot is used at most once.

    track, plot  int [P], the admissible pairs
    gain         [P] > 0, what a pair is worth over leaving its track and plot alone

    Returns plot_of, int [tracks]: the plot of each track, or -1.

    Most pairs compete with nothing, and most others are one track with several plots or one plot
    with several tracks: these are settled at once. What remains falls into connected components;
    each is solved exactly (Jonker-Volgenant), so the whole is the global optimum.
    """
    plot_of = np.full(tracks, -1, np.int64)
    plots_of_track = np.bincount(track, minlength=tracks)
    tracks_of_plot = np.bincount(plot, minlength=plots)
    shared = tracks_of_plot[plot] > 1
    if not shared.any() and len(track) == np.count_nonzero(plots_of_track):
        plot_of[track] = plot
        return plot_of
    torn = plots_of_track[track] > 1
    track_free = np.bincount(track, shared, tracks)[track] == 0     # nobody else wants its plots
    plot_free = np.bincount(plot, torn, plots)[plot] == 0           # its tracks want nothing else
    for free, group in ((track_free, track), (plot_free & ~track_free, plot)):
        best = _best_of_each(group, gain, np.flatnonzero(free))
        plot_of[track[best]] = plot[best]
    hard = np.flatnonzero(~(track_free | plot_free))
    if len(hard):
        best = hard[_solve(track[hard], plot[hard], gain[hard])]
        plot_of[track[best]] = plot[best]
    return plot_of


def _best_of_each(group, gain, pairs):
    """Of the given pairs, the one with the largest gain in each group."""
    pairs = pairs[np.lexsort((-gain[pairs], group[pairs]))]
    first = np.ones(len(pairs), bool)
    first[1:] = group[pairs[1:]] != group[pairs[:-1]]
    return pairs[first]


def _solve(track, plot, gain):
    """The pairs of the optimal assignment, one connected component after the other."""
    rows, row = np.unique(track, return_inverse=True)
    columns, column = np.unique(plot, return_inverse=True)
    size = len(rows) + len(columns)
    graph = coo_array((np.ones(len(row), np.int8), (row, column + len(rows))), (size, size))
    _, label = connected_components(graph, directed=False)
    part = label[row]
    order = np.argsort(part, kind='stable')
    chosen = []
    for pairs in np.split(order, np.flatnonzero(np.diff(part[order])) + 1):
        r, i = np.unique(row[pairs], return_inverse=True)
        c, j = np.unique(column[pairs], return_inverse=True)
        worth = np.zeros((len(r), len(c)))
        which = np.full((len(r), len(c)), -1)
        worth[i, j], which[i, j] = gain[pairs], pairs
        taken = which[linear_sum_assignment(worth, maximize=True)]
        chosen.append(taken[taken >= 0])
    return np.concatenate(chosen)
