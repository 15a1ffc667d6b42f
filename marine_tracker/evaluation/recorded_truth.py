"""The truth of a recording as its radar saw it, and which of it tracks can be scored against."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import unit_vector
from ..recording.csv_folder import Recording
from ..types import Array, IntArray
from .gospa import assign

WINDOW = 11  # scans around a truth ...
NEEDED = 5  # ... of which this many need a plot; landmarks alone can give 3 by chance


class Truths(NamedTuple):
    """All truths [T] of a recording, in the order of its scans.

    scan      [T]     index of the scan         target    [T]     number of the target
    time      [T]     s                         range     [T]     m from own ship
    position  [T, 2]  m, east and north         velocity  [T, 2]  m/s; nan where unknown
    """

    scan: NDArray[np.int64]
    target: NDArray[np.int64]
    time: Array
    position: Array
    velocity: Array
    range: Array


def as_plotted(recording: Recording, bias_deg: float, lag: float) -> Truths:
    """The recording's truth as its plots show it: `lag` s late, and turned clockwise by the bias.

    If the recording gives no velocity, it is taken from the positions two scans before and after.
    """
    scan = np.repeat(np.arange(len(recording.scans)), [len(t.time) for t in recording.truths])
    time, target, position, velocity = (np.concatenate(column) for column in zip(*recording.truths))
    for one in np.unique(target):
        rows = np.flatnonzero(target == one)
        if len(rows) > 1:
            place = np.arange(len(rows))
            first, after = rows[np.maximum(place - 2, 0)], rows[np.minimum(place + 2, place[-1])]
            differences = (position[after] - position[first]) / (time[after] - time[first])[:, None]
            known = np.isfinite(velocity[rows]).all(1)[:, None]
            velocity[rows] = np.where(known, velocity[rows], differences)
    origin = _own_ship_at(recording, time)
    offset = position - lag * np.nan_to_num(velocity) - origin
    # Clockwise, as bearings grow: [east, north] of the old north and of the old east.
    east, north = unit_vector(np.radians([bias_deg + 90.0, bias_deg]))
    turn = np.stack([east, north])
    return Truths(scan, target, time, origin + offset @ turn, velocity @ turn, np.hypot(*offset.T))


def seen_by_radar(
    recording: Recording, truth: Truths, within: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """[T] whether the radar saw each truth, and whether it had a plot of it in that scan.

    within  m; a plot at most this far from a truth may be its plot
    """
    plotted = np.zeros(len(truth.time), bool)
    for rows, scan in zip(by_scan(truth.scan, len(recording.scans)), recording.scans):
        plots = _own_ship_at(recording, scan.plots.time) + (
            scan.plots.range[:, None] * unit_vector(scan.plots.bearing)
        )
        distance = np.linalg.norm(truth.position[rows][:, None] - plots, axis=-1)
        plotted[rows[assign(distance, within)[0]]] = True
    ranges = np.concatenate([scan.plots.range for scan in recording.scans])
    seen = (truth.range >= ranges.min(initial=np.inf)) & (
        truth.range <= ranges.max(initial=-np.inf)
    )
    number = recording.numbers[truth.scan]
    for target in np.unique(truth.target):
        rows = np.flatnonzero(truth.target == target)
        hits = np.append(0, np.cumsum(plotted[rows]))
        begin = np.searchsorted(number[rows], number[rows] - WINDOW // 2, 'left')
        end = np.searchsorted(number[rows], number[rows] + WINDOW // 2, 'right')
        seen[rows] &= hits[end] - hits[begin] >= NEEDED
    return seen, plotted


def by_scan(scan: IntArray, count: int) -> list[NDArray[np.intp]]:
    """Rows of each scan, from the sorted scan index of each row."""
    return np.split(np.arange(len(scan)), np.searchsorted(scan, np.arange(1, count)))


def _own_ship_at(recording: Recording, time) -> Array:
    """Own ship's position [..., 2] m from the whole recording; at rest before and after it."""
    own_ship = recording.own_ship
    return np.stack([np.interp(time, own_ship.time, column) for column in own_ship.position.T], -1)
