"""Many equal ships at once, far from each other, for statistics of single ships.

They lie on a circle around own ship, which is at rest. Each moves at right angles to the line of
sight, clockwise, so they stay on a circle.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..service import Output
from ..tracking.lifecycle import LOST
from ..types import Array

SHIPS = 24
DISTANCE, SPEED = 5000.0, 8.0  # m, m/s
REACH = 500.0  # m; a track farther from a ship is not on it


def ring(duration: float, radar: dict[str, Any], legs: list[dict[str, Any]]) -> dict[str, Any]:
    """The scenario's mapping. All ships run the same legs."""
    return {
        'duration_s': duration,
        'radar': radar,
        'targets': [
            {
                'start': {'range_m': DISTANCE, 'bearing_deg': float(bearing)},
                'course_deg': float(bearing + 90) % 360,
                'speed_mps': SPEED,
                'legs': legs,
            }
            for bearing in (np.arange(SHIPS) + 0.5) * (360 / SHIPS)
        ],
    }


class Owners(NamedTuple):
    """row [S] of each ship's target, and whether it has one [S]."""

    row: NDArray[np.int64]
    found: NDArray[np.bool_]


def owners(output: Output, place: Array) -> Owners:
    """The targets of the picture that belong to ships at `place` [S, 2] m from own ship: the
    nearest.
    """
    where = shown(output)
    if not len(where):
        return Owners(np.zeros(len(place), np.int64), np.zeros(len(place), bool))
    apart = where - place[:, None]
    distance = np.hypot(apart[..., 0], apart[..., 1])
    distance = np.where(np.isnan(distance), np.inf, distance)
    row = distance.argmin(1)
    return Owners(row, distance[np.arange(len(row)), row] < REACH)


def shown(output: Output) -> Array:
    """[T, 2] m from own ship of the picture's targets; nan for targets that were just lost."""
    picture = output.picture
    lost = output.report.tracks.status[picture.row] == LOST
    return np.where(lost[:, None], np.nan, picture.motion.position - picture.own.position)
