"""From the first plots to the loss of a target."""

import numpy as np

from ..parameters import TrackerParameters
from ..types import HISTORY, Tracks

TENTATIVE, CONFIRMED, COASTING, LOST = range(4)
STATUS_NAMES = ('tentative', 'confirmed', 'coasting', 'lost')
NOT_LOST, MISSED, OUT_OF_RANGE, MERGED = range(4)
REASONS = ('', 'missed', 'out of range', 'merged')
MATURE = 10         # scans; the standards' "5 of 10" needs that many
IN_THE_DARK = 30    # scans without a plot after which even a track in the blind zone is lost


def _tables():
    """Set bits of every history, and scans since the last set one."""
    histories = np.arange(1 << HISTORY, dtype=np.int32)
    count = np.zeros(len(histories), np.int8)
    for k in range(HISTORY):
        count += ((histories >> k) & 1).astype(np.int8)
    since = np.full(len(histories), HISTORY, np.int8)
    for k in reversed(range(HISTORY)):
        since[(histories >> k) & 1 == 1] = k
    return count, since


_COUNT, _SINCE = _tables()


def hits(tracks: Tracks, scans: int):
    """Plots [N] of each track in its last `scans` scans (at most types.HISTORY)."""
    return _COUNT[tracks.history & ((1 << scans) - 1)]


def misses_in_a_row(tracks: Tracks):
    """Scans [N] since the last plot, at most types.HISTORY."""
    return _SINCE[tracks.history]


def record(tracks: Tracks, hit, visible) -> Tracks:
    """Enter one scan: hit [N] had a plot; visible [N] lay where the radar can see.

    A scan in which the track could not be seen and was not is left out of its history.
    """
    counted = hit | visible
    history = ((tracks.history << 1) | hit) & ((1 << HISTORY) - 1)
    return tracks._replace(history=np.where(counted, history, tracks.history),
                           age=tracks.age + counted)


def judge(tracks: Tracks, parameters: TrackerParameters, hit, beyond, drift, now: float):
    """Status [N] and reason [N] of a loss, by the named rules.

    hit [N] had a plot in this scan; beyond [N] lies outside the radar's range; now s.

    M of N: a tentative track is confirmed by `confirm_hits` plots in `confirm_scans` scans and
    lost once it cannot get there. A young confirmed track is lost after `delete_misses` misses
    in a row; a mature one, older than 10 scans, when its last 10 scans held fewer plots than
    `hold_hits`.
    """
    needed, window = parameters.confirm_hits, parameters.confirm_scans
    tentative = tracks.status == TENTATIVE
    recent = hits(tracks, window)
    confirmed = ~tentative | (recent >= needed)
    run = misses_in_a_row(tracks)
    young = tracks.age < MATURE
    # Of the window's scans still to come none may be missing more than it can.
    hopeless = tentative & ~confirmed & (tracks.age + needed - recent > window)
    gone = (~tentative & ~hit & (drift > parameters.max_drift)) | ~tentative & np.where(young, run >= parameters.delete_misses,
                                 hits(tracks, MATURE) < parameters.hold_hits)
    left = beyond & ~hit
    dark = now - tracks.last_time > IN_THE_DARK * parameters.scan_period_s
    lost = hopeless | gone | left | dark
    status = np.where(confirmed, np.where(hit, CONFIRMED, COASTING), TENTATIVE)
    status = np.where(lost, LOST, status).astype(np.int8)
    reason = np.where(lost, np.where(left & ~(hopeless | gone), OUT_OF_RANGE, MISSED), NOT_LOST)
    return status, reason.astype(np.int8)
