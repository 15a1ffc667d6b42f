"""The life of a track, from its first plots to its loss."""

import numpy as np

from ..parameters import TrackerParameters
from ..types import HISTORY, Array, BoolArray, CodeArray, IntArray, Tracks
from .look import Look

TENTATIVE, CONFIRMED, COASTING, LOST, STATIONARY = range(5)
STATUS_NAMES = ('tentative', 'confirmed', 'coasting', 'lost', 'stationary')
MISSED, OUT_OF_RANGE, MERGED = range(1, 4)
REASONS = ('', 'missed', 'out of range', 'merged')
TEN = 10  # scans in which the standards count a target's plots
IN_THE_DARK = 30  # scans without a plot after which even a track in the blind zone is lost


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


def record(
    tracks: Tracks, rows: IntArray, gained: Array, visible: BoolArray, parameters: TrackerParameters
) -> Tracks:
    """Records one scan: the tracks `rows` [K] had a plot; visible [N] were where the radar can see.

    gained [K]: what those plots add to the scores (see score.py). A scan in which a track could not
    be seen, and had no plot, is not recorded for it.
    """
    hit = np.zeros(len(visible), bool)
    hit[rows] = True
    counted = hit | visible
    history = ((tracks.history << 1) | hit) & ((1 << HISTORY) - 1)
    score = tracks.score + np.log(1 - parameters.detection_probability) * (visible & ~hit)
    score[rows] += gained
    return tracks._replace(
        history=np.where(counted, history, tracks.history),
        score=np.minimum(score, parameters.max_score),
        age=tracks.age + counted,
    )


def held_by_another(
    tracks: Tracks, radar: int, time: Array, track: IntArray, held: Array
) -> BoolArray:
    """Mask [N] of the tracks that another radar sees, while this one has no plot in their gate.

    time [N] s of this scan at the track; track: tracks that have a plot in the gate; held [R] s,
    how long a plot of each radar shows that its target is there. Such a scan is not a miss: a
    target hidden by a mast, or too weak for one radar, is not lost. If another track took the plot
    in the gate, it is a miss, so two tracks on one target are still found. For a tentative track
    every miss counts. Otherwise tracks on one radar's clutter would live where the other radar is
    blind.
    """
    if len(held) == 1:
        return np.zeros(len(time), bool)
    empty = np.ones(len(time), bool)
    empty[track] = False
    found: BoolArray = (
        empty
        & (tracks.status != TENTATIVE)
        & (tracks.radar != radar)
        & (time - tracks.last_time < held[tracks.radar])
    )
    return found


def judge(
    tracks: Tracks,
    parameters: TrackerParameters,
    hit: BoolArray,
    beyond: BoolArray,
    drift: Array,
    now: float,
) -> tuple[CodeArray, CodeArray]:
    """Status [N] and reason [N] of a loss, by the named rules.

    hit [N] had a plot in this scan, or of another radar recently; beyond [N] is outside the range
    of every radar; drift [N] is the deviation of the extrapolated position over that of a plot; now
    s.

    M of N: a tentative track is confirmed by `confirm_hits` plots in `confirm_scans` scans, if its
    score also reaches `confirm_score`. It is lost when its plots can no longer reach that. A
    confirmed track is lost when its score falls below 0, when its last 10 scans had fewer plots
    than `hold_hits`, or when it coasts and `drift` exceeds `max_drift`: in such a wide search the
    next plot found would not be the target's.
    """
    needed, window = parameters.confirm_hits, parameters.confirm_scans
    tentative = tracks.status == TENTATIVE
    recent = hits(tracks.history, window)
    confirmed = ~tentative | ((recent >= needed) & (tracks.score >= parameters.confirm_score))
    # Give up when even plots in all remaining scans of the window would be too few.
    remaining = np.maximum(window - tracks.age, 0)
    gone = np.where(
        tentative,
        ~confirmed & (recent + remaining < needed),
        (tracks.score < 0)
        | (~hit & (drift > parameters.max_drift))
        | ((hits(tracks.history, TEN) < parameters.hold_hits) & (tracks.age >= TEN)),
    )
    left = beyond & ~hit
    lost = gone | left | (now - tracks.last_time > IN_THE_DARK * parameters.scan_period_s)
    status = np.where(confirmed, np.where(hit, CONFIRMED, COASTING), TENTATIVE)
    status[lost] = LOST
    reason = lost * MISSED
    reason[left & ~gone] = OUT_OF_RANGE
    return status.astype(np.int8), reason.astype(np.int8)


def step(
    tracks: Tracks,
    seen: Look,
    gained: Array,
    elsewhere: BoolArray,
    radar: TrackerParameters,
    farthest: float,
    now: float,
) -> tuple[Tracks, CodeArray]:
    """The tracks after one scan, recorded and judged, and the reason [N] of each loss.

    gained     [K]  what the plots add to the scores of the tracks that had one (see score.py)
    elsewhere  [N]  held by another radar (see `held_by_another`)
    radar      parameters of the one that scanned
    farthest   m, the largest range of all radars
    now        s, end of the scan
    """
    in_range = (seen.distance >= radar.min_range_m) & (seen.distance <= radar.max_range_m)
    in_range &= seen.swept
    tracks = tracks._replace(bearing=seen.bearing)
    rows = seen.hit.nonzero()[0]
    tracks = record(tracks, rows, gained, in_range & ~elsewhere, radar)
    held = seen.hit | elsewhere
    status, reason = judge(tracks, radar, held, seen.distance > farthest, seen.drift, now)
    return tracks._replace(status=status), reason


def merge(tracks: Tracks, reason: CodeArray, double: BoolArray) -> tuple[Tracks, CodeArray]:
    """The tracks and reasons; those of the mask [N] are lost to another track on their target."""
    status, reason = tracks.status.copy(), reason.copy()
    status[double] = LOST
    reason[double] = MERGED
    return tracks._replace(status=status), reason


def number(tracks: Tracks, next_number: int) -> tuple[Tracks, int]:
    """Gives every confirmed track its target number; also returns the next free number."""
    newly = ((tracks.number == 0) & (tracks.status == CONFIRMED)).nonzero()[0]
    numbers = tracks.number.copy()
    numbers[newly] = next_number + np.arange(len(newly))
    return tracks._replace(number=numbers), next_number + len(newly)
