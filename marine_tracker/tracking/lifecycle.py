"""The life of a track, from its first plots to its loss."""

import numpy as np

from ..parameters import TrackerParameters
from ..types import HISTORY, Array, BoolArray, CodeArray, IntArray, Tracks
from . import existence
from .history import hits
from .look import Look

TENTATIVE, CONFIRMED, COASTING, LOST, STATIONARY = range(5)
STATUS_NAMES = ('tentative', 'confirmed', 'coasting', 'lost', 'stationary')
MISSED, OUT_OF_RANGE, MERGED = range(1, 4)
REASONS = ('', 'missed', 'out of range', 'merged')
TEN, SHOWS = 10, 5  # a target that shows in so many scans of ten is kept (IMO A.823)
SURE, SURE_PLOTS = 20, 10  # scans, or plots in the last 20 of them, that leave no doubt
IN_THE_DARK = 30  # scans without a plot after which even a track in the blind zone is lost


def record(tracks: Tracks, hit: BoolArray, visible: BoolArray, ratio: Array) -> Tracks:
    """Records one scan: the tracks `hit` [N] had a plot; visible [N] were where the radar can see.

    ratio [N]: likelihood ratios of what the scan showed (existence.py). A scan in which a track
    could not be seen, and had no plot, is not recorded for it.
    """
    counted = hit | visible
    history = ((tracks.history << 1) | hit) & ((1 << HISTORY) - 1)
    return tracks._replace(
        history=np.where(counted, history, tracks.history),
        existence=existence.after(tracks.existence, ratio, counted),
        age=tracks.age + counted,
    )


def sure(tracks: Tracks) -> BoolArray:
    """Mask [N] of the targets that have been followed long enough to be beyond doubt."""
    known = (tracks.age >= SURE) | (hits(tracks.history, HISTORY) >= SURE_PLOTS)
    found: BoolArray = (tracks.status != TENTATIVE) & known
    return found


def given_up(tracks: Tracks, reason: CodeArray) -> IntArray:
    """Plots [N] of each track that ends, with its reason [N], before its target was beyond doubt:
    they were clutter's. 0 for all others."""
    none = (reason == MISSED) & (tracks.age < SURE)
    found: IntArray = np.where(none, hits(tracks.history, HISTORY), 0)
    return found


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

    hit [N] had a plot in this scan, or of another radar or track; beyond [N] is outside the range
    of every radar; drift [N] is the deviation of the extrapolated position over that of a plot; now
    s.

    M of N: a tentative track is confirmed by `confirm_hits` plots in `confirm_scans` scans, if its
    existence also reaches `confirm_existence`. It is lost when its plots can no longer reach that.
    A confirmed track is lost when its existence falls below `lose_existence` (a sure one not while
    it shows in 5 of 10 scans), when its last 10 scans had fewer plots than `hold_hits`, or when it
    coasts and `drift` exceeds `max_drift`: in such a wide search the next plot found would not be
    the target's.
    """
    needed, window = parameters.confirm_hits, parameters.confirm_scans
    tentative = tracks.status == TENTATIVE
    recent = hits(tracks.history, window)
    confirmed = ~tentative | (
        (recent >= needed) & (tracks.existence >= parameters.confirm_existence)
    )
    # Give up when even plots in all remaining scans of the window would be too few.
    remaining = np.maximum(window - tracks.age, 0)
    ten = recent if window == TEN else hits(tracks.history, TEN)
    held = sure(tracks) & (ten >= SHOWS)
    gone = np.where(
        tentative,
        ~confirmed & (recent + remaining < needed),
        ((tracks.existence < parameters.lose_existence) & ~held)
        | (~hit & (drift > parameters.max_drift))
        | ((ten < parameters.hold_hits) & (tracks.age >= TEN)),
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
    ratio: Array,
    elsewhere: BoolArray,
    sharing: IntArray,
    radar: TrackerParameters,
    farthest: float,
    now: float,
) -> tuple[Tracks, CodeArray]:
    """The tracks after one scan, recorded and judged, and the reason [N] of each loss.

    ratio      [N]  likelihood ratios of what the scan showed of the tracks (existence.py)
    elsewhere  [N]  held by another radar (see `held_by_another`)
    sharing    [U]  rows of tracks that share the plot of another track (unresolved.py)
    radar      parameters of the one that scanned
    farthest   m, the largest range of all radars
    now        s, end of the scan
    """
    in_range = (seen.distance >= radar.min_range_m) & (seen.distance <= radar.max_range_m)
    in_range &= seen.swept
    tracks = tracks._replace(bearing=seen.bearing)
    held, ratio = seen.hit | elsewhere, ratio.copy()
    held[sharing], ratio[sharing] = True, 1.0
    tracks = record(tracks, seen.hit, in_range & ~elsewhere, ratio)
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
