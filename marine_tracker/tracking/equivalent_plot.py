"""One plot a track that stands for all plots in its gate, each with its probability.

Probabilistic data association leaves a track with a mixture: for each plot the place that a Kalman
update with it gives, and the expected place for "none of them". Its mean and covariance are those
of one update with an *equivalent plot*. So estimators never see the mixture: they take that plot.
"""

import numpy as np

from ..geometry import to_range_bearing, wrap_bearing
from ..types import Array, Extrapolation, IntArray, Plots, take
from .gate import Pairs

SURE = 0.999  # probability of a plot from which it stands for itself
LEAST = 0.1  # least information of an equivalent plot along an axis, in that of the expectation


def equivalents(
    pairs: Pairs,
    probability: Array,
    plot_of: IntArray,
    rows: IntArray,
    chosen: Plots,
    ahead: Extrapolation,
    plots: Plots,
) -> Plots:
    """The plots [K] that the tracks `rows` [K], ascending, take: those chosen, or equivalents.

    pairs, probability  [P]  some of the gate, and how probable each is; for each track at most 1 in
                             all, and what is missing is the probability of none
    plot_of             [N]  the plot that each track took, -1 for none
    chosen              [K]  those plots; a track keeps its own where that is not among its pairs,
                             or hardly in doubt
    ahead                    the tracks, expected
    """
    own = (plot_of[pairs.track] == pairs.plot) & (probability < SURE)
    soft = pairs.track[own]
    if not len(soft):
        return chosen
    place = np.full(len(plot_of), -1)
    place[soft] = np.arange(len(soft))
    these = (place[pairs.track] >= 0).nonzero()[0]
    at, beta = place[pairs.track[these]], probability[these]
    middle, spread = _mixture(take(pairs, these), beta, at, len(soft), ahead, plots)
    off, covariance = _as_one_plot(middle, spread, ahead.covariance[soft][:, :2, :2])
    of_plot = plot_of[soft]
    later = (plots.time[of_plot] - ahead.time[soft])[:, None]
    position = ahead.position[soft] + later * ahead.velocity[soft] + off
    return placed(chosen, rows.searchsorted(soft), position, covariance)


def placed(plots: Plots, rows: IntArray, position: Array, covariance: Array) -> Plots:
    """The plots, of which those of the rows [K] lie elsewhere: [K, 2] m and [K, 2, 2] m^2."""
    positions, covariances = plots.position.copy(), plots.covariance.copy()
    ranges, bearings = plots.range.copy(), plots.bearing.copy()
    positions[rows], covariances[rows] = position, covariance
    ranges[rows], bearing = to_range_bearing(position - plots.origin[rows])
    bearings[rows] = wrap_bearing(bearing)
    return plots._replace(
        position=positions, covariance=covariances, range=ranges, bearing=bearings
    )


def _mixture(
    pairs: Pairs, beta: Array, at: IntArray, count: int, ahead: Extrapolation, plots: Plots
) -> tuple[Array, Array]:
    """Mean [count, 2] m, from the expected place, and covariance [count, 2, 2] m^2 of the mixtures.

    at, beta  [P]  the mixture of each pair, and its weight there
    """
    track, plot = pairs.track, pairs.plot
    later = (plots.time[plot] - ahead.time[track])[:, None]
    off = plots.position[plot] - ahead.position[track] - later * ahead.velocity[track]
    before = ahead.covariance[track][:, :2, :2]
    gain = before @ np.linalg.inv(before + plots.covariance[plot])
    moved = (gain @ off[..., None])[..., 0]
    second = before - gain @ before + moved[:, :, None] * moved[:, None, :]
    middle, spread = np.zeros((count, 2)), np.zeros((count, 2, 2))
    np.add.at(middle, at, beta[:, None] * moved)
    np.add.at(spread, at, beta[:, None, None] * second)
    first = np.zeros(count, np.int64)
    first[at] = track
    none = 1 - np.bincount(at, beta, count)
    spread += none[:, None, None] * ahead.covariance[first][:, :2, :2]
    return middle, spread - middle[:, :, None] * middle[:, None, :]


def _as_one_plot(middle: Array, spread: Array, before: Array) -> tuple[Array, Array]:
    """Place [K, 2] m, from the expected one, and covariance [K, 2, 2] m^2 of the plots by which a
    Kalman update leads from the covariances `before` to the means and covariances of the mixtures.

    Along an axis where the mixture is no narrower than what was expected no plot does that. There
    the plot tells next to nothing, and moves the mean all the same.
    """
    root = np.linalg.cholesky(before)
    inverse = np.linalg.inv(root)
    values, vectors = np.linalg.eigh(inverse @ spread @ inverse.swapaxes(1, 2))
    tells = np.maximum(1 / np.maximum(values, 1e-9) - 1, LEAST)
    along = (vectors.swapaxes(1, 2) @ inverse @ middle[..., None])[..., 0]
    axes = root @ vectors
    off = (axes @ (along * (1 + tells) / tells)[..., None])[..., 0]
    return off, (axes / tells[:, None]) @ axes.swapaxes(1, 2)
