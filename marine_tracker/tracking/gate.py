"""Which plots could belong to which tracks.

Plots are sorted once into rings of range, and by bearing within a ring; each track reads the few
stretches of that order which its window covers. Everything is array work, so it costs 5 to 8
times less than a k-d tree's lists of neighbours, and as little per track at 50,000 as at 200.
The windows only bound the search: the exact chi-square test decides.
"""

import numpy as np

from ..geometry import to_range_bearing, wrap_bearing
from ..types import Plots
from .sweep import Sweep

TURN = 2 * np.pi


def gate_size(probability: float) -> float:
    """Chi-square quantile with two degrees of freedom: the gate holds a plot so often."""
    return -2.0 * np.log1p(-probability)


def window_pairs(low, high, bearing, half_width, plot_range, plot_bearing):
    """All pairs (track [P], plot [P]) with the plot inside the track's window.

    low, high [N] m: ranges of the window; bearing, half_width [N] rad: its bearings, periodic.
    plot_range [M] m, plot_bearing [M] rad. Tracks come in ascending order.
    """
    nothing = np.zeros(0, np.int64)
    if not len(bearing) or not len(plot_range):
        return nothing, nothing
    width = max(2 * float((high - low).sum()) / len(low), 1.0)
    first = np.maximum(low / width, 0.0).astype(np.int64)
    last = (np.minimum(high, plot_range.max()) / width).astype(np.int64)
    # A line of 3 turns for each ring, every plot on it twice, a turn apart: no window wraps.
    key = (plot_range / width).astype(np.int64) * (3 * TURN) + wrap_bearing(plot_bearing)
    key = np.concatenate([key, key + TURN])
    order = np.argsort(key)
    key, order = key[order], order % len(plot_range)

    whole = half_width >= np.pi
    start = np.where(whole, 0.0, wrap_bearing(bearing - half_width))
    stop = np.where(whole, np.nextafter(TURN, 0.0), start + 2 * half_width)
    rings = np.maximum(last - first + 1, 0)
    track = np.repeat(np.arange(len(bearing)), rings)
    line = (np.arange(len(track)) - np.repeat(np.cumsum(rings) - rings - first, rings)) * (3 * TURN)
    begin = np.searchsorted(key, line + start[track], 'left')
    count = np.searchsorted(key, line + stop[track], 'right') - begin
    total = int(count.sum())
    if not total:
        return nothing, nothing
    place = np.arange(total) - np.repeat(np.cumsum(count) - count - begin, count)
    track, plot = np.repeat(track, count), order[place]
    inside = (plot_range[plot] >= low[track]) & (plot_range[plot] <= high[track])
    return track[inside], plot[inside]


def gate(time, position, velocity, covariance, sweep: Sweep, plots: Plots, origin,
         range_sigma: float, bearing_sigma: float, size: float):
    """Pairs of tracks and plots inside the chi-square gate.

    time [N] s, position [N, 2] m, velocity [N, 2] m/s, covariance [N, 2, 2] m^2: where the
    tracks are when the beam should pass them, and the covariance of that position
    origin  [N, 2] m, own ship at those times
    size    of the gate, squared Mahalanobis distance

    Returns track [P] (ascending) and plot [P] indices, nis [P] (squared distance) and log_det
    [P] of the innovation covariance. A plot is compared with the track at the plot's own time.
    """
    offset = position - origin
    distance, bearing = to_range_bearing(offset)
    a, b, d = covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]
    sin, cos = offset.T / np.maximum(distance, 1e-9)
    reach = np.sqrt(size)
    along = reach * np.sqrt(sin * sin * a + 2 * sin * cos * b + cos * cos * d + range_sigma ** 2)
    # A plot's noise grows with its own range, at most `along` farther out than the track.
    noise = (distance + along) * bearing_sigma
    across = reach * np.sqrt(cos * cos * a - 2 * sin * cos * b + sin * sin * d + noise * noise)
    if sweep.period:
        # The plot's time may differ from the track's: by little, but where the revolution
        # begins by a whole one.
        speed = np.hypot(*velocity.T)
        turned = np.mod(bearing - sweep.bearing0, TURN)
        angle = across / np.maximum(distance, across)
        seam = (turned < angle) | (turned > TURN - angle)
        slack = speed * sweep.period * np.where(seam, 1.0, angle / TURN)
        along, across = along + slack, across + slack
    nearest = distance - along
    half_width = np.where(nearest > 0, np.arctan2(across, np.maximum(nearest, 1e-9)), np.pi)
    # Sideways offsets lie farther out than the arc, the more the nearer the track is.
    farthest = np.hypot(distance + along, across)

    track, plot = window_pairs(nearest, farthest, bearing, half_width, plots.range, plots.bearing)
    later = (plots.time[plot] - time[track])[:, None]
    apart = plots.position[plot] - position[track] - later * velocity[track]
    de, dn = apart.T
    noise = plots.covariance[plot]
    a, b, d = (noise[:, i, j] + s[track] for i, j, s in ((0, 0, a), (0, 1, b), (1, 1, d)))
    determinant = a * d - b * b
    nis = (d * de * de - 2 * b * de * dn + a * dn * dn) / determinant
    inside = nis < size
    return track[inside], plot[inside], nis[inside], np.log(determinant[inside])
