"""How many pairs one scan may cost, and which are left out beyond that.

In a crowd the pairs grow with the square of the plots: ten thousand plots within a few hundred
metres, twice in a row, make a hundred million. So a list of pairs has a budget. Where it does not
suffice, the fullest windows give way: of each no more plots are compared than there are to keep all
lists together within the budget, and those are the nearest ones, which fit best. A window that
holds fewer loses none, so a crowd costs targets elsewhere nothing. What is left out is counted.
"""

import numpy as np
from scipy.spatial import cKDTree

from ..types import Array, BoolArray, IntArray

PAIRS, A_WINDOW = 200_000, 32  # the budget: so many, and so many more for each window
EVEN = 1e-3  # of a window: by so little plots at one place differ, or a tree could not part them


def budget(windows: int) -> int:
    """The most pairs that so many windows may make together."""
    return PAIRS + A_WINDOW * windows


def fullest(count: IntArray) -> tuple[BoolArray, int]:
    """Mask [N] of the windows that must give way, and how many plots each of them keeps.

    count  [N]  plots in each window
    """
    if count.sum() <= budget(len(count)):
        return np.zeros(len(count), bool), 0
    rising = np.sort(count)
    before = np.append(0, rising.cumsum()[:-1])
    share = (budget(len(count)) - before) // np.arange(
        len(count), 0, -1
    )  # if these and all fuller ones share
    most = int(share[(rising > share).argmax()])
    return count > most, most


def nearest(
    distance: Array,
    bearing: Array,
    along: Array,
    aside: Array,
    plot_range: Array,
    plot_bearing: Array,
    most: int,
) -> tuple[IntArray, IntArray]:
    """The pairs (window [P], plot [P]) of each window with the `most` plots nearest its middle.

    distance, bearing [W] m, rad: the middles; along, aside [W] m, rad: how far the windows reach in
    range and in bearing. plot_range, plot_bearing [M] m, rad. Distances count in the size of a
    typical window, so that one tree serves all: in range and bearing far off, as on a map near own
    ship.
    """
    depth, width = np.median(along), np.median(aside)

    def places(range_: Array, bearing: Array) -> Array:
        scaled = range_ / depth
        around = np.minimum(scaled, 1 / width)
        order = np.linspace(0, EVEN, len(range_))
        return np.column_stack([scaled, around * np.sin(bearing), around * np.cos(bearing), order])

    tree = cKDTree(places(plot_range, plot_bearing))
    _, plot = tree.query(places(distance, bearing), most)
    plot = plot.reshape(len(distance), -1)
    return np.arange(len(plot)).repeat(plot.shape[1]), plot.ravel()
