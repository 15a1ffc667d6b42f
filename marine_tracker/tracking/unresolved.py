"""Two targets in one resolution cell of the radar give one plot: whose is it?

It is both's. The track that took it and the other one share it: the plot lies between them, so it
tells where their middle is, and nothing of how they lie to each other. For the track that has no
plot of its own that scan is no miss.

Whether a plot is of two is one more hypothesis of the joint association. With p_u the probability
that both targets are in one cell, from where they are expected, give or take, and N / lambda as in
existence.py, it weighs

    one plot for both              p_u (1 - (1 - P_D1) (1 - P_D2)) N_middle / lambda
    each its own                   (1 - p_u) P_D1 N_1 / lambda  P_D2 N_2 / lambda
    one of them shows, or other    (1 - p_u) P_D1 N_1 / lambda  (1 - P_D2)

so a track does not take a false plot because another track took the plot of both.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from ..geometry import to_range_bearing, unit_vector
from ..parameters import TrackerParameters
from ..types import Array, BoolArray, Extrapolation, IntArray, Plots, Tracks, append, take
from .equivalent_plot import placed
from .gate import Pairs
from .lifecycle import TENTATIVE
from .surroundings import Evidence

FAR = 3.0  # deviations
CELL = 4.0  # deviations of a plot: a radar that measures so finely has no larger cell


class Shared(NamedTuple):
    """Tracks [U] that share the plot of another track: rows of tracks and plots."""

    track: IntArray
    owner: IntArray
    plot: IntArray


NOBODY = Shared(*np.zeros((3, 0), np.int64))


def shared(
    pairs: Pairs,
    evidence: Evidence,
    plot_of: IntArray,
    tracks: Tracks,
    ahead: Extrapolation,
    origin: Array,
    plots: Plots,
    radar: TrackerParameters,
) -> Shared:
    """The tracks that probably share the plot of another track.

    pairs    of the gate, with their evidence; plot_of [N]: the plot that each track took, -1 for
             none
    ahead    the first of the tracks, expected, and origin [., 2] m, of the radar then
    Both are confirmed, and a track shares with one other at most. A plot that the track itself took
    is none of its target's then.
    """
    owned = np.full(len(plots.time), -1)  # the pair by which a plot was taken
    owning = np.full(len(plot_of), -1)  # and by which a track took one
    own = (plot_of[pairs.track] == pairs.plot).nonzero()[0]
    owned[pairs.plot[own]], owning[pairs.track[own]] = own, own
    held, mate = tracks.status != TENTATIVE, owned[pairs.plot]
    look = (mate >= 0) & held[pairs.track] & held[pairs.track[mate]]
    look &= pairs.track[mate] != pairs.track
    near = look.nonzero()[0]
    near = near[_near(pairs.track[near], pairs.track[mate[near]], ahead, origin, radar)]
    one, mate = pairs.track[near], mate[near]
    other, plot = pairs.track[mate], pairs.plot[near]
    if not len(one):
        return Shared(one, other, plot)
    together = _in_one_cell(one, other, ahead, origin, radar)
    seen, unseen = evidence.detected, 1 - evidence.detected
    alone = np.where(
        owning[one] >= 0, seen[one] * evidence.likelihood[owning[one]], unseen[one]
    )  # what the track shows without this plot
    apart = seen[other] * evidence.likelihood[mate] * alone
    apart += seen[one] * evidence.likelihood[near] * unseen[other]
    both = (1 - unseen[one] * unseen[other]) * _of_middle(one, other, plot, ahead, plots)
    both *= together / evidence.density[plot]
    share = both / np.maximum(both + (1 - together) * apart, 1e-300)
    best = np.zeros(len(plot_of))
    for of in (one, other):
        np.maximum.at(best, of, share)
    found = ((share > 0.5) & (share == best[one]) & (share == best[other])).nonzero()[0]
    found = found[np.unique(np.minimum(one, other)[found], return_index=True)[1]]
    return Shared(one[found], other[found], plot[found])


def cell(radar: TrackerParameters) -> tuple[float, float]:
    """Depth m and width rad of a resolution cell.

    Where depth and beam are left at their defaults the radar may be much finer than these: then its
    noise tells so.
    """
    depth = min(radar.range_resolution_m, CELL * radar.range_sigma_m)
    return depth, float(np.radians(min(radar.beam_width_deg, CELL * radar.bearing_sigma_deg)))


def _near(
    one: IntArray, other: IntArray, ahead: Extrapolation, origin: Array, radar: TrackerParameters
) -> BoolArray:
    """Mask [K] of the tracks that may be in one cell at all: the others are not looked at."""
    apart = ahead.position[one] - ahead.position[other]
    spread = ahead.covariance[one] + ahead.covariance[other]
    range_, (depth, width) = np.hypot(*(ahead.position[one] - origin[one]).T), cell(radar)
    reach = np.hypot(depth, range_ * width)
    found: BoolArray = np.hypot(*apart.T) < reach + FAR * np.sqrt(spread[:, 0, 0] + spread[:, 1, 1])
    return found


def _in_one_cell(
    one: IntArray, other: IntArray, ahead: Extrapolation, origin: Array, radar: TrackerParameters
) -> Array:
    """Probability [K] that the targets of the tracks are in one resolution cell."""
    range_, bearing = to_range_bearing(ahead.position[one] - origin[one])
    away = unit_vector(bearing)
    axes = np.stack([away, away[:, ::-1] * [1.0, -1.0]], 1)  # along, and across
    apart = (axes @ (ahead.position[one] - ahead.position[other])[..., None])[..., 0]
    spread = ahead.covariance[one][:, :2, :2] + ahead.covariance[other][:, :2, :2]
    sigma = np.sqrt((axes @ spread * axes).sum(2))
    depth, width = cell(radar)
    edge = np.stack([np.full_like(range_, depth), range_ * width], 1)
    found: Array = (ndtr((edge - apart) / sigma) - ndtr((-edge - apart) / sigma)).prod(1)
    return found


def _of_middle(
    one: IntArray, other: IntArray, plot: IntArray, ahead: Extrapolation, plots: Plots
) -> Array:
    """Density [K] 1 / m^2 of the plots as those of two targets, which lie between them."""
    later = (plots.time[plot] - ahead.time[one])[:, None]
    middle = 0.5 * (ahead.position[one] + ahead.position[other])
    middle += 0.5 * later * (ahead.velocity[one] + ahead.velocity[other])
    off = plots.position[plot] - middle
    spread = _between(one, other, ahead) + plots.covariance[plot]
    nis = (off * np.linalg.solve(spread, off[..., None])[..., 0]).sum(1)
    found: Array = np.exp(-0.5 * nis) / (2 * np.pi * np.sqrt(np.linalg.det(spread)))
    return found


def _between(one: IntArray, other: IntArray, ahead: Extrapolation) -> Array:
    """Covariance [K, 2, 2] m^2 of the place of a plot of both, about their middle."""
    apart = ahead.position[one] - ahead.position[other]
    doubt = ahead.covariance[one][:, :2, :2] + ahead.covariance[other][:, :2, :2]
    found: Array = doubt / 4 + apart[:, :, None] * apart[:, None, :] / 12
    return found


def split(both: Shared, rows: IntArray, chosen: Plots, ahead: Extrapolation, plots: Plots) -> Plots:
    """The plots [K + U] of the tracks `rows` [K], ascending, and of those that share.

    A shared plot lies halfway between its two tracks, as they are expected, give or take. So their
    middle follows it, and how they lie to each other does not change.
    """
    one, two = both.track, both.owner
    apart = ahead.position[one] - ahead.position[two]
    middle = take(plots, both.plot)
    covariance = middle.covariance + _between(one, two, ahead)
    every = np.arange(len(one))
    return append(
        placed(chosen, rows.searchsorted(two), middle.position - apart / 2, covariance),
        placed(middle, every, middle.position + apart / 2, covariance),
    )
