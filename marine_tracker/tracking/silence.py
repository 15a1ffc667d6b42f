"""After a long silence of the radar: which tracks surely go on.

For minutes the gates grow to kilometres, and the plot of another ship lies in them as well as the
right one. A track goes on then where nobody can mistake it: a plot near where it was to be, and no
other plot nor track nearly as near. The others end, for they have drifted too far (lifecycle.py).
"""

import numpy as np

from ..types import Array, BoolArray, Extrapolation, IntArray, Plots, take
from .gate import Pairs

LONG_S, LONG_SCANS = 180.0, 10  # without a plot of any track: shorter is no silence
REACH, SIGMAS = 500.0, 3.0  # how far a plot may lie from a track: m, and its own deviations
CLEAR = 2.0  # times as far away as the nearest plot, or track, the next one must be


def unmistakable(
    pairs: Pairs, ahead: Extrapolation, plots: Plots, last_time: Array, start: float, period: float
) -> Pairs:
    """The pairs of a scan that begins at `start` s; after a long silence those left of them.

    ahead      the N tracks, with last plots at last_time [N] s; pairs.track counts lone plots after
               them
    period     s, of a revolution
    """
    count = len(last_time)
    if not count or start - last_time.max() < max(LONG_S, LONG_SCANS * period):
        return pairs
    pairs = take(pairs, pairs.track < count)
    off = np.hypot(*(plots.position[pairs.plot] - ahead.position[pairs.track]).T)
    sigma = np.sqrt(np.trace(plots.covariance[pairs.plot], axis1=1, axis2=2))
    near = off <= REACH + SIGMAS * sigma
    pairs = take(pairs, near)
    off = off[near]
    return take(pairs, _clear(off, pairs.track) & _clear(off, pairs.plot))


def _clear(off: Array, of: IntArray) -> BoolArray:
    """Mask [P] of the pairs that are the nearest of their track or plot `of` [P], by far."""
    order = np.lexsort((off, of))
    first = np.append(True, of[order][1:] != of[order][:-1])
    following = np.append(off[order][1:], np.inf)
    following[np.append(first[1:], True)] = np.inf  # there is no second
    clear = np.zeros(len(off), bool)
    clear[order] = first & (following > CLEAR * off[order])
    return clear
