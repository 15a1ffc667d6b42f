"""AIS as another sensor of the tracks it is joined to, on demand.

A place of AIS updates a track as the plot of another radar would, with its own covariance, put into
its place in time (tracking.late_plots). It is laid where the radar would see the ship: with the
radar's errors. Only a ship that keeps her place beside her echo counts, so a wrong AIS moves no
track away from its echoes: one that walks off is out before the track is a deviation off.
"""

import numpy as np

from ..geometry import to_range_bearing, unit_vector
from ..tracking.lifecycle import LOST
from ..types import Array, IntArray, Plots, Tracks, row_of
from .join import Joined
from .registration import Registration
from .ship_motion import at
from .ship_table import Ships

AMPLITUDE = 0.0  # dB; AIS has no echo


def plots_of(
    ships: Ships, joined: Joined, errors: Registration, tracks: Tracks, own: Array, since: float
) -> tuple[Plots, IntArray]:
    """Places of AIS as plots [K], and the rows [K] of the tracks that they update.

    own    [2]  m, own ship's position
    since  s; only reports that were heard after it count
    """
    row = row_of(tracks.id, np.where(joined.agrees, joined.track, -1))
    chosen = (joined.agrees & (row >= 0) & (ships.heard > since) & ~ships.lost).nonzero()[0]
    chosen = chosen[tracks.status[row[chosen]] != LOST]
    rows = row[chosen]
    # An estimator goes forward in time: a place from before the last plot is moved on to it.
    time = ships.time.copy()
    time[chosen] = np.maximum(time[chosen], tracks.last_time[rows])
    moving = at(ships, time)
    offset = moving.position[chosen] + errors.value[2:] - own
    range_, bearing = to_range_bearing(offset)
    range_, bearing = range_ + errors.value[0], bearing + errors.value[1]
    covariance = moving.covariance[chosen][:, :2, :2]
    count = len(chosen)
    plots = Plots(
        time[chosen],
        range_,
        bearing,
        np.full(count, AMPLITUDE),
        np.broadcast_to(own, (count, 2)).copy(),
        own + range_[:, None] * unit_vector(bearing),
        covariance,
    )
    return plots, rows
