"""Which plots could belong to which tracks.

Plots are sorted once into rings of range, and by bearing within a ring. Each track reads the few
parts of that order that its window covers. All of it is array work: at 200 to 1,000 tracks it takes
a fifth of the time of a k-d tree's lists of neighbours. The windows only limit the search. The
exact chi-square test decides.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing, wrap_angle, wrap_bearing
from ..types import Array, IntArray, Plots, take
from .expected import Expected
from .noise import Noise
from .pair_budget import budget, fullest, nearest
from .sweep import Sweep

TURN = 2 * np.pi
HAIR = 1e-8  # rad
OBLIQUE = 0.07  # sin^2 of the widest angle, asin(1/4), between a plot and a distant track
PLOTS_A_RING = 256


class Pairs(NamedTuple):
    """Tracks and plots that may belong together, P rows.

    track    [P]  row of the track, ascending
    plot     [P]  row of the plot
    nis      [P]  squared Mahalanobis distance between them
    log_det  [P]  of the covariance [2, 2] of that distance, m^4
    """

    track: IntArray
    plot: IntArray
    nis: Array
    log_det: Array


def split(pairs: Pairs, count: int) -> tuple[Pairs, Pairs]:
    """The pairs of the first `count` rows, and those of the rows beyond, counted from 0 again."""
    seam = pairs.track.searchsorted(count)
    beyond = take(pairs, slice(seam, None))
    return take(pairs, slice(seam)), beyond._replace(track=beyond.track - count)


def gate_size(probability: float) -> float:
    """Chi-square quantile with two degrees of freedom, for the given probability to hold a plot."""
    found: float = -2.0 * np.log1p(-probability)
    return found


def window_pairs(
    distance: Array,
    low: Array,
    high: Array,
    bearing: Array,
    half_width: Array,
    plot_range: Array,
    plot_bearing: Array,
) -> tuple[IntArray, IntArray, int]:
    """All pairs (track [P], plot [P]) with the plot inside the track's window; how many are left
    out, because they are beyond the budget (see pair_budget.py).

    distance, bearing [N] m, rad: the middle of the window; low, high [N] m: its ranges;
    half_width [N] rad: its bearings, periodic. plot_range [M] m, plot_bearing [M] rad in [0, 2 pi).
    Tracks come in ascending order.
    """
    if not len(bearing) or not len(plot_range):
        return np.zeros(0, np.int64), np.zeros(0, np.int64), 0
    # Every plot is there twice, one turn apart, so no window wraps around. A window of a whole turn
    # ends where no plot is; otherwise it would meet the first plot again.
    whole = half_width > np.pi - HAIR
    start = np.where(whole, 0.0, wrap_bearing(bearing - half_width))
    stop = np.where(whole, TURN - HAIR, start + 2 * half_width)
    track, key = np.arange(len(bearing)), np.minimum(plot_bearing, TURN - 2 * HAIR)
    if len(plot_range) > PLOTS_A_RING:
        # Rings are as wide as two windows, but not so many that most are nearly empty. Each has its
        # own line for bearings, 3 turns long.
        most = plot_range.max()
        width = max(2 * (high - low).sum() / len(low), most * (PLOTS_A_RING / len(plot_range)))
        first = np.maximum(low / width, 0.0).astype(np.int64)
        rings = np.maximum((np.minimum(high, most) / width).astype(np.int64) - first + 1, 0)
        track = track.repeat(rings)
        line = (np.arange(len(track)) - (rings.cumsum() - rings - first).repeat(rings)) * (3 * TURN)
        start, stop = line + start[track], line + stop[track]
        key = (plot_range / width).astype(np.int64) * (3 * TURN) + key
        key = np.concatenate([key, key + TURN])
        order = key.argsort()
        key, order = key[order], order % len(plot_range)
    else:
        order = key.argsort()
        key = key[order]
        key, order = np.concatenate([key, key + TURN]), np.concatenate([order, order])
    begin = key.searchsorted(start, 'left')
    count = key.searchsorted(stop, 'right') - begin
    rows, most, left_out = np.zeros(0, np.int64), 0, 0
    if count.sum() > budget(len(bearing)):
        of_track = np.bincount(track, count, len(bearing)).astype(np.int64)
        full, most = fullest(of_track)
        rows, left_out = full.nonzero()[0], int((of_track[full] - most).sum())
        count = np.where(full[track], 0, count)
    track = track.repeat(count)
    place = np.arange(len(track)) - (count.cumsum() - count - begin).repeat(count)
    plot = order[place]
    if len(rows):
        middles = distance[rows], bearing[rows], 0.5 * (high - low)[rows], half_width[rows]
        few, near = nearest(*middles, plot_range, plot_bearing, most)
        few = rows[few]
        ahead = np.abs(wrap_angle(plot_bearing[near] - bearing[few])) <= half_width[few]
        track, plot = np.append(track, few[ahead]), np.append(plot, near[ahead])
        ascending = track.argsort(kind='stable')
        track, plot = track[ascending], plot[ascending]
    range_ = plot_range[plot]
    inside = ((range_ >= low[track]) & (range_ <= high[track])).nonzero()[0]
    return track[inside], plot[inside], left_out


def gate(
    expected: Expected, plots: Plots, sweep: Sweep, noise: Noise, size: float
) -> tuple[Pairs, int]:
    """Pairs of expected targets and plots inside the chi-square gate; and how many are left out,
    beyond the budget.

    noise  of the plots: bounds the search; the test itself takes the covariances as they are
    size   of the gate, squared Mahalanobis distance

    A plot is compared with the target at the plot's own time.
    """
    at = windows(expected, plots, sweep, noise, np.sqrt(size))
    track, plot, left_out = window_pairs(*at, plots.range, plots.bearing)
    nis, determinant = _distance(expected, plots, track, plot)
    inside = (nis < size).nonzero()[0]
    pairs = Pairs(track[inside], plot[inside], nis[inside], np.log(determinant[inside]))
    return pairs, left_out


def windows(
    expected: Expected, plots: Plots, sweep: Sweep, noise: Noise, reach: float
) -> tuple[Array, Array, Array, Array, Array]:
    """The arguments of `window_pairs`: windows that hold every plot within `reach` deviations."""
    offset, covariance = expected.position - expected.origin, expected.covariance
    distance, bearing = to_range_bearing(offset)
    range_sigma, bearing_sigma = max(noise.range_sigma, noise.widest), noise.bearing_sigma
    a, b, d = covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]
    sin, cos = offset.T / np.maximum(distance, 1e-9)
    spread = sin * sin * a + 2 * sin * cos * b + cos * cos * d
    # What grows with a plot's range is taken at the largest range: its noise across; and the second
    # order of a coarse bearing along, shift and spread (geometry.polar_to_position).
    most = distance + reach * np.sqrt(spread + range_sigma**2)
    second = most * bearing_sigma**2
    along = reach * np.sqrt(spread + range_sigma**2 + 1.5 * second * second) + 0.5 * second
    sideways = np.maximum(((distance + along) * bearing_sigma) ** 2, noise.widest**2)
    across = reach * np.sqrt(a + d - spread + sideways + OBLIQUE * range_sigma**2)
    # Near own ship plots may be in any direction, each with its own direction of noise.
    radius = along + reach * np.sqrt(a + d + sideways)
    near = distance < 4 * radius
    if near.any():
        along, across = np.where(near, radius, along), np.where(near, radius, across)
    half_width = _half_width(distance, along, across)
    if sweep.period and len(distance):
        # The plot's time may differ from the track's: by little, but by a whole revolution where
        # the revolution begins.
        turned = np.mod(bearing - sweep.bearing0, TURN)
        seam = (turned < half_width) | (turned > TURN - half_width)
        share = np.where(seam | (half_width > np.pi / 4), 1.0, half_width / TURN)
        # Own ship also moves meanwhile, and ranges are counted from her.
        moved = np.hypot(*np.ptp(np.concatenate([expected.origin, plots.origin]), axis=0))
        slack = (np.hypot(*expected.velocity.T) * sweep.period + moved) * share
        along, across = along + slack, across + slack
        half_width = _half_width(distance, along, across)
    # Sideways offsets are farther out than the arc, more so for near tracks.
    return distance, distance - along, np.hypot(distance + along, across), bearing, half_width


def _half_width(distance: Array, along: Array, across: Array) -> Array:
    """Bearings [N] rad either side within which offsets along and across [N] m lie."""
    nearest = distance - along
    return np.where(nearest > 0, np.arctan2(across, np.maximum(nearest, 1e-9)), np.pi)


def _distance(
    expected: Expected, plots: Plots, track: IntArray, plot: IntArray
) -> tuple[Array, Array]:
    """Squared Mahalanobis distance [P] of the pairs, and determinant [P] m^4 of its covariance."""
    later = (plots.time[plot] - expected.time[track])[:, None]
    drifted = later * expected.velocity.take(track, 0)
    apart = plots.position.take(plot, 0) - expected.position.take(track, 0) - drifted
    de, dn = apart.T
    of_plot, of_track = plots.covariance.take(plot, 0), expected.covariance
    a, b, d = (of_plot[:, i, j] + of_track[:, i, j][track] for i, j in ((0, 0), (0, 1), (1, 1)))
    determinant = a * d - b * b
    return (d * de * de - 2 * b * de * dn + a * dn * dn) / determinant, determinant
