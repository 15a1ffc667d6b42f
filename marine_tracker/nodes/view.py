"""The confirmed targets of one scan as people see them: what `targets` and `markers` show."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import to_range_bearing, wrap_bearing
from ..tracking import lifecycle
from ..types import Array, Extrapolation, Tracks


class View(NamedTuple):
    """N targets at one moment, in the order of their numbers.

    number      [N]     the ARPA's target number
    status      [N]     CONFIRMED, COASTING, or LOST in this scan
    reason      [N]     why a lost one was lost: one of lifecycle.REASONS' numbers
    estimate    N rows, all at the end of the scan
    range       [N]     m, from own ship
    bearing     [N]     rad, true
    course      [N]     rad, over ground
    speed       [N]     m/s, over ground
    hits        [N]     plots in the last 10 scans
    misses      [N]     scans since the last plot
    age         [N]     s since the first plot
    """

    number: NDArray[np.int64]
    status: NDArray[np.int8]
    reason: NDArray[np.int8]
    estimate: Extrapolation
    range: Array
    bearing: Array
    course: Array
    speed: Array
    hits: NDArray[np.int64]
    misses: NDArray[np.int64]
    age: Array


def view(tracks: Tracks, reason, estimate: Extrapolation, own_position) -> View:
    """The targets among tracks [N] with their estimates; own_position [2] m."""
    distance, bearing = to_range_bearing(estimate.position - own_position)
    velocity = estimate.velocity
    return View(
        tracks.number, tracks.status, reason, estimate, distance, bearing,
        wrap_bearing(np.arctan2(velocity[:, 0], velocity[:, 1])),
        np.hypot(velocity[:, 0], velocity[:, 1]), lifecycle.hits(tracks, 10),
        lifecycle.misses_in_a_row(tracks), estimate.time - tracks.first_time)


def names(number) -> list[str]:
    """TT01, TT02, ... as ECDIS and NMEA name tracked targets."""
    return [f'TT{n:02d}' for n in number.tolist()]
