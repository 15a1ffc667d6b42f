"""The hits and misses that a track remembers, as bits: bit k tells of the scan k scans ago."""

import numpy as np

from ..types import HISTORY, IntArray

_HALF = HISTORY // 2
_BITS = (np.arange(1 << _HALF)[:, None] >> np.arange(_HALF)) & 1  # of every half history
_COUNT = _BITS.sum(1)
_SINCE = np.where(_BITS.any(1), _BITS.argmax(1), _HALF)


def hits(history: IntArray, scans: int) -> IntArray:
    """Plots [N] of each history [N] in its last `scans` scans (at most types.HISTORY)."""
    recent = history & ((1 << scans) - 1)
    count = _COUNT[recent & (len(_COUNT) - 1)]
    found: IntArray = count if scans <= _HALF else count + _COUNT[recent >> _HALF]
    return found


def misses_in_a_row(history: IntArray) -> IntArray:
    """Scans [N] since the last plot of each history [N], at most types.HISTORY."""
    since = _SINCE[history & (len(_SINCE) - 1)]
    found: IntArray = np.where(since < _HALF, since, _HALF + _SINCE[history >> _HALF])
    return found
