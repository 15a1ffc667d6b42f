"""How probable each pair of track and plot is, over all joint associations (JPDA).

A joint association gives every plot to one track at most and every track one plot at most. Its
weight is the product of its pairs' weights, over all tracks without a plot. Most plots are in the
gate of one track only: those need no joint sum. Tracks that contest plots form components. A small
component is summed exactly: over the tracks one after the other, with what is left of the contested
plots as the state. That is what an efficient hypothesis net does (Maskell, Briers and Wright 2004).
All small components go through it together, as arrays. Large ones pass messages between tracks and
plots until these settle (loopy belief propagation, Williams and Lau 2014): on trees that is exact,
else close.
"""

import numpy as np

from ..types import Array, IntArray
from .associate import components, places

MOST_TRACKS, MOST_PLOTS = 8, 6  # contested, of a component that is summed exactly
ROUNDS, SETTLED = 60, 1e-6  # of messages


def marginals(track: IntArray, plot: IntArray, weight: Array, tracks: int, plots: int) -> Array:
    """Probability [P] of each pair.

    track, plot  [P]  rows of tracks and plots, each pair once
    weight       [P]  >= 0, how much likelier the pair is than no plot for its track
    tracks, plots     how many there are
    """
    contested = np.bincount(plot, minlength=plots)[plot] > 1
    alone = 1 + np.bincount(track, weight * ~contested, tracks)  # no contested plot
    found = weight / alone[track]
    if not contested.any():
        return found
    at = contested.nonzero()[0]
    rows, row = np.unique(track[at], return_inverse=True)
    columns, column = np.unique(plot[at], return_inverse=True)
    ratio = found[at]
    of_row, of_column = components(row, column, len(rows), len(columns))
    many_rows, row_place = places(of_row, len(rows))
    many_columns, column_place = places(of_column, len(rows))
    small = ((many_rows <= MOST_TRACKS) & (many_columns <= MOST_PLOTS))[of_row[row]]
    beta = np.empty(len(at))
    if small.any():
        some = small.nonzero()[0]
        _, part = np.unique(of_row[row[some]], return_inverse=True)
        beta[some] = _sum_exactly(
            part, row_place[row[some]], column_place[column[some]], ratio[some]
        )
    if not small.all():
        some = (~small).nonzero()[0]
        beta[some] = _pass_messages(row[some], column[some], ratio[some], len(rows), len(columns))
    found[at] = beta
    left = 1 - np.bincount(track[at], beta, tracks)
    found[~contested] *= left[track[~contested]]
    return found


def _sum_exactly(part: IntArray, row: IntArray, column: IntArray, ratio: Array) -> Array:
    """Probability [P] of the pairs of small components: row and column count within their part."""
    parts, rows, columns = part.max() + 1, row.max() + 1, column.max() + 1
    weight = np.zeros((rows, columns, parts))
    weight[row, column, part] = ratio
    states = np.arange(1 << columns)  # bit k: plot k is taken
    free = [(states >> k & 1 == 0).nonzero()[0] for k in range(columns)]
    ahead = np.zeros((rows + 1, len(states), parts))  # weight of all ways to get to a state
    ahead[0, 0] = 1
    behind = np.ones((rows + 1, len(states), parts))  # and of all ways on from it
    for k in range(rows):
        ahead[k + 1] = ahead[k]
        for j, states_without in enumerate(free):
            ahead[k + 1, states_without | 1 << j] += weight[k, j] * ahead[k, states_without]
    found = np.zeros_like(weight)
    for k in reversed(range(rows)):
        behind[k] = behind[k + 1]
        for j, states_without in enumerate(free):
            after = behind[k + 1, states_without | 1 << j]
            behind[k, states_without] += weight[k, j] * after
            found[k, j] = weight[k, j] * (ahead[k, states_without] * after).sum(0)
    found /= behind[0, 0]
    of_pair: Array = found[row, column, part]
    return of_pair


def _pass_messages(row: IntArray, column: IntArray, ratio: Array, rows: int, columns: int) -> Array:
    """Probability [P] of the pairs, by messages between rows and columns."""
    answer = np.ones(len(row))
    for _ in range(ROUNDS):
        wanted = ratio * answer
        asked = ratio / (1 + np.bincount(row, wanted, rows)[row] - wanted)
        before = answer
        answer = 1 / (1 + np.maximum(np.bincount(column, asked, columns)[column] - asked, 0))
        if np.abs(answer - before).max() < SETTLED:
            break
    wanted = ratio * answer
    found: Array = wanted / (1 + np.bincount(row, wanted, rows)[row])
    return found
