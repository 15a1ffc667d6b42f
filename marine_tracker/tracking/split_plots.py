"""Plots of one target: a long ship, or one in a broken echo, may give two of them in a scan.

Two targets in one resolution cell give one plot. So two plots in one cell, or a ship's length more
apart, are of one target if they lie in the gate of one track only. The track takes their mean; and
no new track begins beside a plot of another one.
"""

import numpy as np

from ..geometry import wrap_angle
from ..parameters import TrackerParameters
from ..types import Array, BoolArray, IntArray, Plots
from .equivalent_plot import placed
from .gate import Pairs, window_pairs
from .unresolved import cell

HULL = 3.0  # times glint: so much farther apart than a cell may bow and stern of a ship be
FEW = 0.05  # false plots: where more are expected within reach, one may lie there by chance


def fused(
    pairs: Pairs, plot_of: IntArray, plots: Plots, density: Array, radar: TrackerParameters
) -> Plots:
    """The plots, of which those that tracks took, plot_of [N] or -1, lie at the mean of all that
    are their target's.

    pairs  of the gate, those of tracks only; density [M] of false plots, 1 / m^2 and scan
    """
    if len(pairs.track) == np.count_nonzero(plot_of >= 0):
        return plots
    wanted = np.bincount(pairs.plot, minlength=len(plots.time))
    of_track = plot_of[pairs.track]
    beside = ((of_track >= 0) & (of_track != pairs.plot) & (wanted[pairs.plot] == 1)).nonzero()[0]
    plot, other = of_track[beside], pairs.plot[beside]
    if not len(plot):
        return plots
    depth, width = _reach(plots.range[plot], radar)
    one = np.abs(plots.range[plot] - plots.range[other]) < depth
    one &= np.abs(wrap_angle(plots.bearing[plot] - plots.bearing[other])) < width
    one &= 4 * depth * width * plots.range[plot] * density[plot] < FEW
    one &= wanted[plot] == 1
    plot, other = plot[one], other[one]
    if not len(plot):
        return plots
    rows, at = np.unique(plot, return_inverse=True)
    total, count = plots.position[rows], np.ones(len(rows))
    np.add.at(total, at, plots.position[other])
    np.add.at(count, at, 1)
    return placed(plots, rows, total / count[:, None], plots.covariance[rows])


def _reach(range_: Array, radar: TrackerParameters) -> tuple[float, Array]:
    """How far apart in range, m, and bearing [K], rad, at the ranges [K] m, plots of one target
    may be."""
    hull = HULL * radar.glint_sigma
    depth, width = cell(radar)
    return depth + hull, np.minimum(width + hull / np.maximum(range_, 1.0), np.pi)


def alone(second: IntArray, plot_of: IntArray, plots: Plots, radar: TrackerParameters) -> BoolArray:
    """Mask [B] of the plots `second` that may begin tracks: none in whose cell a track took a plot,
    plot_of [N] or -1, or which another one that begins a track comes before.
    """
    if not len(second):
        return np.ones(0, bool)
    range_, bearing = plots.range[second], plots.bearing[second]
    depth, half = _reach(range_, radar)
    rank = np.full(len(plots.time), len(second))
    rank[second] = np.arange(len(second))
    rank[plot_of[plot_of >= 0]] = -1
    these = (rank < len(second)).nonzero()[0]
    window = range_, range_ - depth, range_ + depth, bearing, half
    mine, other, _ = window_pairs(*window, plots.range[these], plots.bearing[these])
    found = np.ones(len(second), bool)
    found[mine[rank[these[other]] < mine]] = False
    return found
