"""Past positions of the targets at equal intervals of time, true and relative."""

from typing import NamedTuple

import numpy as np

from ..types import Array, IntArray, row_of
from .cpa import OwnMotion
from .motion import Motion


class PastPositions(NamedTuple):
    """The last K moments, newest first, the same for all tracks: whole multiples of `interval`.

    interval  s
    time      [K]        s
    own       [K, 2]     m, own ship's true positions
    id        [N]        the tracks
    position  [N, K, 2]  m, true (ground-stabilised) positions; nan before the track's first plot
    """

    interval: float
    time: Array
    own: Array
    id: IntArray
    position: Array


def begin(count: int, interval: float) -> PastPositions:
    """An empty memory. count: how many to keep; interval s between them.

    ValueError for less than 1, or an interval that is not above 0. The standards require at least
    4.
    """
    if count < 1:
        raise ValueError(f'the number of past positions is {count}; it must be at least 1')
    if not 0 < interval < np.inf:
        raise ValueError(
            f'the interval of past positions is {interval:g} s; it must be finite and above 0'
        )
    unknown = np.full((count, 2), np.nan)
    return PastPositions(
        interval, unknown[:, 0], unknown, np.zeros(0, np.int64), np.zeros((0, count, 2))
    )


def step(
    past: PastPositions, id: IntArray, first_time: Array, moving: Motion, own: OwnMotion, now: float
) -> PastPositions:
    """Follows the tracks id [N] to `now` s. The rows of the result are theirs.

    first_time  [N] s, of the tracks' first plots
    moving      the tracks at `now`, N rows; uses position and velocity of them and of own ship

    A moment since the last step gets the position at `now`, moved back along the velocity by at
    most one scan. After a gap longer than the whole span of moments, nothing is invented: the
    memory starts again. It also starts again if time goes back.
    """
    count, interval = len(past.time), past.interval
    time, own_before = past.time, past.own
    positions = np.full((len(id), count, 2), np.nan)
    row = row_of(past.id, id)
    positions[row >= 0] = past.position[row[row >= 0]]
    latest = np.floor(now / interval) * interval
    due = round((latest - time[0]) / interval) if np.isfinite(time[0]) else 1
    if not 0 <= due <= count:
        due = 1
        time = np.full_like(time, np.nan)
        own_before = np.full_like(own_before, np.nan)
        positions[:] = np.nan
    if due:
        moments = latest - interval * np.arange(due)
        back = moments - now
        was = moving.position[:, None] + back[:, None] * moving.velocity[:, None]
        was[moments < first_time[:, None]] = np.nan
        time = np.concatenate([moments, time])[:count]
        own_before = np.concatenate([own.position + back[:, None] * own.velocity, own_before])[
            :count
        ]
        positions = np.concatenate([was, positions], 1)[:, :count]
    return PastPositions(interval, time, own_before, np.array(id), positions)


def relative(past: PastPositions) -> Array:
    """Offsets [N, K, 2] m of the tracks from own ship's positions at the same moments."""
    return past.position - past.own
