"""What one scan shows of every track, with or without a plot."""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing
from ..types import Array, BoolArray, Extrapolation, IntArray, Plots, Scan, Tracks
from .expected import Expected
from .noise import Noise
from .sweep import swept


class Look(NamedTuple):
    """What one scan showed of the tracks, one row a track.

    time       [N]     s, when the beam passed the track (its plot's time where it had one); or
                       its last plot's, where another radar's was later
    predicted  [N, 2]  m, where the track was expected at `time`; nan for a new track
    distance   [N]     m, from own ship: of its plot, or else of where it was expected
    bearing    [N]     rad, likewise
    drift      [N]     deviation of the expected position over that of a plot; 0 where it had one
    hit        [N]     it had a plot
    swept      [N]     the beam swept the place
    """

    time: Array
    predicted: Array
    distance: Array
    bearing: Array
    drift: Array
    hit: BoolArray
    swept: BoolArray


def look(
    tracks: Tracks,
    plot_of: IntArray,
    plots: Plots,
    ahead: Extrapolation,
    expected: Expected,
    noise: Noise,
    scan: Scan,
) -> Look:
    """What the scan showed: of the tracks that took a plot, plot_of [N] >= 0, that plot; of the
    others the expectation.

    tracks           N, with their new `last_time`; those that `ahead` lacks are new and have a plot
    ahead, expected  the tracks before the update; `expected` may have more rows after them
    """
    count, before = len(tracks.id), len(ahead.time)
    hit = plot_of >= 0
    rows, missed = hit.nonzero()[0], (~hit).nonzero()[0]
    time = tracks.last_time.copy()
    time[missed] = np.maximum(ahead.time[missed], time[missed])
    predicted = np.full((count, 2), np.nan)
    later = time[:before] - ahead.time
    predicted[:before] = ahead.position + later[:, None] * ahead.velocity
    distance, bearing, drift = np.zeros((3, count))
    distance[rows] = plots.range[plot_of[rows]]
    bearing[rows] = plots.bearing[plot_of[rows]]
    distance[missed], bearing[missed] = to_range_bearing(
        ahead.position.take(missed, 0) - expected.origin.take(missed, 0)
    )
    spread = (ahead.covariance[:, 0, 0] + ahead.covariance[:, 1, 1])[missed]
    drift[missed] = np.sqrt(spread / noise.variance(distance[missed]))
    return Look(time, predicted, distance, bearing, drift, hit, swept(scan, bearing))
