"""Two targets in one resolution cell of the radar give one plot: whose is it?

It is both's. The track that took it and the one that went without share it: the plot lies between
them, so it tells where their middle is, and nothing of how they lie to each other. For the track
that went without that scan is no miss.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing, wrap_angle
from ..parameters import TrackerParameters
from ..types import Array, Extrapolation, IntArray, Plots, Tracks, append, take
from .equivalent_plot import placed
from .gate import Pairs
from .lifecycle import TENTATIVE


class Shared(NamedTuple):
    """Tracks [U] without a plot that share the plot of another track: rows of tracks and plots."""

    track: IntArray
    owner: IntArray
    plot: IntArray


def shared(
    pairs: Pairs,
    plot_of: IntArray,
    tracks: Tracks,
    ahead: Extrapolation,
    origin: Array,
    radar: TrackerParameters,
) -> Shared:
    """The tracks that got no plot because they are in one cell with a track that got it.

    pairs    of the gate; plot_of [N]: the plot that each track took, -1 for none
    ahead    the first of the tracks, expected, and origin [., 2] m, of the radar then
    Both are confirmed, and a plot is shared by two tracks at most.
    """
    owner = np.full(pairs.plot.max(initial=-1) + 1, -1)
    has = ((plot_of >= 0) & (plot_of < len(owner))).nonzero()[0]
    owner[plot_of[has]] = has
    held = tracks.status != TENTATIVE
    look = (plot_of < 0)[pairs.track] & held[pairs.track] & (owner[pairs.plot] >= 0)
    look &= held[owner[pairs.plot]]
    near = look.nonzero()[0]
    one, plot = pairs.track[near], pairs.plot[near]
    other = owner[plot]
    if not len(one):
        return Shared(one, other, plot)
    range_, bearing = to_range_bearing(ahead.position - origin[: len(ahead.time)])
    width = range_[one] * np.radians(radar.beam_width_deg)
    aside = np.abs(wrap_angle(bearing[one] - bearing[other])) * range_[one]
    depth = np.abs(range_[one] - range_[other])
    same = (depth < radar.range_resolution_m) & (aside < width)
    one, other, plot, nis = one[same], other[same], plot[same], pairs.nis[near[same]]
    best = _best(one, nis)
    best = best[_best(plot[best], nis[best])]
    return Shared(one[best], other[best], plot[best])


def _best(of: IntArray, nis: Array) -> IntArray:
    """Rows of the least nis for each different value of `of`."""
    order = np.lexsort((nis, of))
    found: IntArray = order[np.append(True, np.diff(of[order]) > 0)[: len(order)]]
    return found


def split(both: Shared, rows: IntArray, chosen: Plots, ahead: Extrapolation, plots: Plots) -> Plots:
    """The plots [K + U] of the tracks `rows` [K], ascending, and of those that share.

    A shared plot lies halfway between its two tracks, as they are expected, give or take. So their
    middle follows it, and how they lie to each other does not change.
    """
    one, two = both.track, both.owner
    apart = ahead.position[one] - ahead.position[two]
    doubt = ahead.covariance[one][:, :2, :2] + ahead.covariance[two][:, :2, :2]
    middle = take(plots, both.plot)
    covariance = middle.covariance + doubt / 4 + apart[:, :, None] * apart[:, None, :] / 12
    every = np.arange(len(one))
    return append(
        placed(chosen, rows.searchsorted(two), middle.position - apart / 2, covariance),
        placed(middle, every, middle.position + apart / 2, covariance),
    )
