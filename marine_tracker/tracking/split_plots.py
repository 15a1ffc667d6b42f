"""Plots of one target: a long ship, or one in a broken echo, may give two of them in a scan.

Two targets in one resolution cell give one plot. So two plots in one cell, of which no two tracks
claim one each, are of one target. The track takes their mean; and no new track begins beside it.
"""

import numpy as np

from ..geometry import wrap_angle
from ..parameters import TrackerParameters
from ..types import BoolArray, IntArray, Plots
from .equivalent_plot import placed
from .gate import Pairs, window_pairs

HULL = 2.0  # times glint: so much farther apart than a cell may the plots of a known target be


def fused(pairs: Pairs, plot_of: IntArray, plots: Plots, radar: TrackerParameters) -> Plots:
    """The plots, of which those that tracks took, plot_of [N] or -1, lie at the mean of all that
    are their target's.

    pairs  of the gate, those of tracks only
    """
    if len(pairs.track) == np.count_nonzero(plot_of >= 0):
        return plots
    wanted = np.bincount(pairs.plot, minlength=len(plots.time))
    of_track = plot_of[pairs.track]
    beside = ((of_track >= 0) & (of_track != pairs.plot) & (wanted[pairs.plot] == 1)).nonzero()[0]
    plot, other = of_track[beside], pairs.plot[beside]
    reach = HULL * radar.glint_sigma
    one = _in_one_cell(plots, plot, other, radar, reach) & (wanted[plot] == 1)
    plot, other = plot[one], other[one]
    if not len(plot):
        return plots
    rows, at = np.unique(plot, return_inverse=True)
    total, count = plots.position[rows], np.ones(len(rows))
    np.add.at(total, at, plots.position[other])
    np.add.at(count, at, 1)
    return placed(plots, rows, total / count[:, None], plots.covariance[rows])


def _in_one_cell(
    plots: Plots, one: IntArray, two: IntArray, radar: TrackerParameters, more: float
) -> BoolArray:
    """Mask [K] of the pairs of plots in one resolution cell, which is `more` m larger."""
    range_, bearing = plots.range, plots.bearing
    across = range_[one] * np.radians(radar.beam_width_deg)
    aside = range_[one] * np.abs(wrap_angle(bearing[one] - bearing[two]))
    found: BoolArray = (np.abs(range_[one] - range_[two]) < radar.range_resolution_m + more) & (
        aside < across + more
    )
    return found


def alone(second: IntArray, plot_of: IntArray, plots: Plots, radar: TrackerParameters) -> BoolArray:
    """Mask [B] of the plots `second` that may begin tracks: none in whose cell a track took a plot,
    plot_of [N] or -1, or which another one that begins a track comes before.
    """
    if not len(second):
        return np.ones(0, bool)
    depth, width = radar.range_resolution_m, np.radians(radar.beam_width_deg)
    range_, bearing = plots.range[second], plots.bearing[second]
    half = np.full(len(second), width)
    rank = np.full(len(plots.time), len(second))
    rank[second] = np.arange(len(second))
    rank[plot_of[plot_of >= 0]] = -1
    these = (rank < len(second)).nonzero()[0]
    window = range_, range_ - depth, range_ + depth, bearing, half
    mine, other, _ = window_pairs(*window, plots.range[these], plots.bearing[these])
    found = np.ones(len(second), bool)
    found[mine[rank[these[other]] < mine]] = False
    return found
