"""Where a scan's plots are expected: at the tracks, and around the lone plots of the last scan."""

from typing import NamedTuple

import numpy as np

from ..geometry import own_ship_at
from ..types import Array, Extrapolation, Plots, Scan


class Expected(NamedTuple):
    """Where targets should be when the beam passes them, N rows.

    time        [N]        s
    position    [N, 2]     m, east and north
    velocity    [N, 2]     m/s, east and north
    covariance  [N, 2, 2]  m^2, of the position
    origin      [N, 2]     m, the antenna at that time
    """

    time: Array
    position: Array
    velocity: Array
    covariance: Array
    origin: Array


def expect(ahead: Extrapolation, lone: Plots, scan: Scan, max_speed: float) -> Expected:
    """First the tracks, then the targets of the lone plots, which may be anywhere near them.

    ahead      the tracks, each at the time the beam passes it
    lone       plots of the radar's last scan that belong to no track
    max_speed  m/s, of the targets
    """
    time = np.concatenate([ahead.time, lone.time])
    origin, _ = own_ship_at(scan.measured_from, time)
    return Expected(
        time,
        np.concatenate([ahead.position, lone.position]),
        np.concatenate([ahead.velocity, np.zeros_like(lone.position)]),
        np.concatenate([ahead.covariance[:, :2, :2], reach(lone, scan.end, max_speed)]),
        origin,
    )


def reach(lone: Plots, now: float, max_speed: float) -> Array:
    """Covariance [L, 2, 2] m^2 of the places of lone plots' targets at the time now, s."""
    away = max_speed * (now - lone.time)
    covariance = lone.covariance.copy()
    covariance[:, [0, 1], [0, 1]] += (away * away)[:, None]
    return covariance
