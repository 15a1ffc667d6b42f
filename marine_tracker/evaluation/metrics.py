"""Scores tracks on a recording whose truth is known.

The rules
- Only confirmed and coasting rows count. A row belongs to its scan. If the file does not name the
  scan, it belongs to the scan nearest in time. If a track has several rows in one scan, the last
  one counts.
- Tracks are moved to the truth's time along their own velocity.
- Known sensor errors do not count against the tracker. A known bearing bias turns the truth about
  own ship. A known lag of the plots moves the truth back along its velocity.
- A truth is scored where the radar saw it: it lies within the ranges that have plots, and at least
  5 of the 11 scans around it had a plot of it (plots are shared out, one to a target, within
  `seen_within`). This rule never looks at the tracks. Tracks on truth that is not scored are set
  aside: they are neither right nor wrong.
- GOSPA has p = 2, alpha = 2. Errors are taken over its pairs. Holding, breaks and switches are
  taken over pairs that persist: a target keeps its track while within the cutoff.
- A track matched to no truth is false. If not every vessel in view has a truth, such a track may be
  right. Then use GOSPA without the false part, and the number of short-lived false tracks.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..files import shown
from ..recording.csv_folder import Recording
from ..recording.track_file import TrackRows
from ..types import Array
from .gospa import assign, assign_sticky, gospa_parts
from .recorded_truth import Truths, as_plotted, by_scan, seen_by_radar

SHORT_LIVED = 20  # scans
CUTOFF = 100.0  # m, if the recording's notes give none
SEEN_WITHIN = 50.0  # m, likewise
LIVE = ('confirmed', 'coasting')

FIGURES = {
    'cutoff_m': ('m', 'a track farther than this from a target is not on it'),
    'scans': ('', 'scans in the recording'),
    'truth_targets': ('', 'targets with at least one scored truth'),
    'truth_rows': ('', 'truths in the recording, one a target and scan'),
    'scored_rows': ('', 'truths that the radar saw'),
    'plot_fraction_on_scored': ('', 'part of the scored truths with a plot'),
    'gospa_mean_m': ('m', 'mean GOSPA over the scans'),
    'gospa_rms_m': ('m', 'root mean square GOSPA'),
    'gospa_localisation_rms_m': ('m', 'its part by distance of track and target'),
    'gospa_missed_rms_m': ('m', 'its part by targets without track'),
    'gospa_false_rms_m': ('m', 'its part by tracks without target'),
    'gospa_without_false_m': ('m', 'mean GOSPA without the false part'),
    'position_rmse_m': ('m', 'root mean square distance of track and target'),
    'position_median_m': ('m', 'median distance of track and target'),
    'velocity_rmse_mps': ('m/s', 'root mean square length of the velocity error'),
    'prediction_rmse_m': ('m', 'error of where the scan before expected the track'),
    'cv_prediction_rmse_m': ('m', 'the same by dead reckoning from the scan before'),
    'held': ('', 'part of the scored truths with a track'),
    'held_within_fifth': ('', 'part with a track nearer than a fifth of the cutoff'),
    'breaks_per_target': ('', 'times a held target lost its track'),
    'switches_per_target': ('', 'times a target passed to another track'),
    'first_confirmation_s': ('s', 'median time from the first scored truth to the first track'),
    'never_confirmed': ('', 'targets that never had a track'),
    'false_per_scan': ('', 'tracks without target'),
    'false_short_lived_per_scan': (
        '',
        f'the same, only tracks never on a target, false in under {SHORT_LIVED} scans',
    ),
    'false_tracks': ('', 'tracks never on a target'),
}
TARGET_FIGURES = {
    'rows': ('', 'scored truths of the target'),
    'held': ('', 'part of them with a track'),
    'breaks': ('', 'times it lost its track'),
    'switches': ('', 'times it passed to another track'),
    'first_confirmation_s': ('s', 'from the first scored truth to the first track'),
}


class Score(NamedTuple):
    """The result of `score`; a value is None where there was no data for it.

    figures             value by name, those of FIGURES in that order
    targets             the same for each scored target, those of TARGET_FIGURES
    counts_strangers    whether tracks on vessels without truth may count as false
    """

    figures: dict[str, float | int | None]
    targets: dict[int, dict[str, float | int | None]]
    counts_strangers: bool


class Live(NamedTuple):
    """The rows [R] of live tracks, in the order of scans, at most one for each track and scan."""

    scan: NDArray[np.int64]  # index of the scan
    track: NDArray[np.int64]  # number of the track in this file
    time: Array
    position: Array
    velocity: Array
    predicted: Array
    before: NDArray[np.int64]  # row of the same track in the scan before, -1 for none


def score(
    recording: Recording,
    tracks: TrackRows,
    cutoff: float | None = None,
    bias_deg: float | None = None,
    lag: float | None = None,
) -> Score:
    """Scores tracks against the truth of a recording, by the rules above.

    cutoff    m; default the notes' cutoff_m, else 100
    bias_deg  how much the bearings of plots and tracks are too large, deg; default the notes'
    azimuth_bias_deg, else 0
    lag       s by which plots are older than their times; default the notes' plot_lag_s, else 0
    ValueError for a recording without truth, for a distance that is not above 0, and for a value
    that is not a finite number.
    """
    cutoff = chosen(recording, 'cutoff_m', cutoff, CUTOFF, above=0.0)
    within = chosen(recording, 'seen_within_m', None, SEEN_WITHIN, above=0.0)
    truth = as_plotted(
        recording,
        chosen(recording, 'azimuth_bias_deg', bias_deg, 0.0),
        chosen(recording, 'plot_lag_s', lag, 0.0),
    )
    if not len(truth.time):
        raise ValueError(f'recording {recording.name} has no truth to score against')
    seen, plotted = seen_by_radar(recording, truth, within)
    live = live_rows(recording, tracks)
    scans = len(recording.scans)
    parts = np.zeros((scans, 3))  # m^2: localisation, missed, false
    pairs: list[NDArray[np.int64]] = []  # rows of truth and live, by GOSPA
    holder = np.full(len(truth.time), -1)  # track on each truth, by pairs that persist
    false = np.zeros(len(live.time), bool)
    last: dict[int, int] = {}  # target -> the track it had last
    for k, (at, rows) in enumerate(zip(by_scan(truth.scan, scans), by_scan(live.scan, scans))):
        moved = (
            live.position[rows]
            + live.velocity[rows] * (truth.time[at][:, None] - live.time[rows])[..., None]
        )
        distance = np.linalg.norm(moved - truth.position[at][:, None], axis=-1)
        matched, column = assign(distance, cutoff)
        aside = column[~seen[at][matched]]
        distance = np.delete(distance[seen[at]], aside, axis=1)
        at, rows = at[seen[at]], np.delete(rows, aside)
        matched, column = assign(distance, cutoff)
        parts[k] = gospa_parts(distance, cutoff)
        pairs.append(np.stack([at[matched], rows[column]], -1))
        matched, column = assign_sticky(
            distance,
            cutoff,
            [
                np.flatnonzero(live.track[rows] == last.get(target, -1)).tolist()
                for target in truth.target[at].tolist()
            ],
        )
        holder[at[matched]] = live.track[rows[column]]
        last.update(zip(truth.target[at[matched]].tolist(), live.track[rows[column]].tolist()))
        false[np.delete(rows, column)] = True
    targets = {
        int(target): _of_target(truth.time[rows], holder[rows])
        for target in dict.fromkeys(truth.target[seen].tolist())
        for rows in [np.flatnonzero(seen & (truth.target == target))]
    }
    figures = {
        'cutoff_m': cutoff,
        'scans': scans,
        'truth_targets': len(targets),
        'truth_rows': len(truth.time),
        'scored_rows': int(seen.sum()),
        'plot_fraction_on_scored': _mean(plotted[seen]),
        **_gospa(parts),
        **_errors(truth, live, np.concatenate(pairs)),
        **_holding(truth, live, np.concatenate(pairs), holder[seen], targets, cutoff),
        **_false(live, false, holder, scans),
    }
    return Score(
        {name: figures[name] for name in FIGURES},
        targets,
        bool(recording.notes.get('uncooperative', True)),
    )


def chosen(
    recording: Recording, name: str, given: float | None, default: float, above: float = -np.inf
) -> float:
    """The given value, else the value in the recording's notes, else the default."""
    value = recording.notes.get(name, default) if given is None else given
    if (
        isinstance(value, bool)
        or not isinstance(value, (int, float))
        or not (above < value < np.inf)
    ):
        limit = 'finite' if above == -np.inf else f'above {above:g} and finite'
        raise ValueError(f'{name} is {shown(value)}; it must be a number, {limit}')
    return float(value)


def live_rows(recording: Recording, tracks: TrackRows) -> Live:
    """The rows that count: of a track in a scan the last one, at the place of the first one."""
    scan, known = _scan_of(recording, tracks)
    rows = np.argsort(tracks.time, kind='stable')
    rows = rows[(np.isin(tracks.status, LIVE) & known)[rows]]
    names, track = np.unique(tracks.track[rows], return_inverse=True)
    slot = scan[rows] * len(names) + track  # one number for each scan and track
    slots, first = np.unique(slot, return_index=True)
    last = len(slot) - 1 - np.unique(slot[::-1], return_index=True)[1]
    scan_before = np.searchsorted(slots, slots - len(names))
    before = np.where(np.isin(slots - len(names), slots), scan_before, -1)
    order = np.lexsort([first, scan[rows[first]]])
    place = np.argsort(order)  # of each slot in that order
    before = np.where(before >= 0, place[before], -1)[order] if len(slots) else before
    rows = rows[last[order]]
    return Live(
        scan[rows],
        track[last[order]],
        tracks.time[rows],
        tracks.position[rows],
        tracks.velocity[rows],
        tracks.predicted[rows],
        before,
    )


def _scan_of(recording: Recording, tracks: TrackRows):
    """Index [R] of each row's scan, and whether the recording has that scan."""
    if tracks.scan is not None:
        scan = np.searchsorted(recording.numbers, tracks.scan)
        scan = np.minimum(scan, len(recording.numbers) - 1)
        return scan, recording.numbers[scan] == tracks.scan
    times = recording.own_ship.time
    scan = np.searchsorted((times[1:] + times[:-1]) / 2, tracks.time)  # the nearest in time
    return scan, np.ones(len(scan), bool)


def _gospa(parts: Array) -> dict:
    localisation, missed, false = np.sqrt(parts.mean(0)).tolist()
    total = np.sqrt(parts.sum(1))
    return {
        'gospa_mean_m': float(total.mean()),
        'gospa_rms_m': _rms(total),
        'gospa_localisation_rms_m': localisation,
        'gospa_missed_rms_m': missed,
        'gospa_false_rms_m': false,
        'gospa_without_false_m': float(np.sqrt(parts[:, :2].sum(1)).mean()),
    }


def _errors(truth: Truths, live: Live, pairs) -> dict:
    """Errors over the pairs [P, 2] of truth and live rows."""
    at, row = pairs.T
    velocity = np.linalg.norm(live.velocity[row] - truth.velocity[at], axis=-1)
    predicted = _error(truth, at, live.predicted[row], live.velocity[row], live.time[row])
    again = live.before[row] >= 0
    old = live.before[row[again]]
    reckoned = _error(truth, at[again], live.position[old], live.velocity[old], live.time[old])
    position = _error(truth, at, live.position[row], live.velocity[row], live.time[row])
    return {
        'position_rmse_m': _rms(position),
        'position_median_m': float(np.median(position)) if len(position) else None,
        'velocity_rmse_mps': _rms(velocity[np.isfinite(velocity)]),
        'prediction_rmse_m': _rms(predicted[np.isfinite(predicted)]),
        'cv_prediction_rmse_m': _rms(reckoned),
    }


def _error(truth: Truths, at, position, velocity, time) -> Array:
    """Distances from the truths `at` of positions moved to their times."""
    moved = position + velocity * (truth.time[at] - time)[:, None]
    return np.linalg.norm(moved - truth.position[at], axis=-1)


def _holding(truth: Truths, live: Live, pairs, holder, targets: dict, cutoff: float) -> dict:
    at, row = pairs.T
    near = _error(truth, at, live.position[row], live.velocity[row], live.time[row]) < cutoff / 5
    waits = [
        t['first_confirmation_s'] for t in targets.values() if t['first_confirmation_s'] is not None
    ]
    count = max(len(targets), 1)
    return {
        'held': _mean(holder >= 0),
        'held_within_fifth': int(near.sum()) / max(len(holder), 1),
        'breaks_per_target': sum(t['breaks'] for t in targets.values()) / count,
        'switches_per_target': sum(t['switches'] for t in targets.values()) / count,
        'first_confirmation_s': float(np.median(waits)) if waits else None,
        'never_confirmed': len(targets) - len(waits),
    }


def _of_target(time: Array, holder) -> dict:
    """Figures of one target from its scored truths: their times and the tracks on them."""
    held = holder >= 0
    return {
        'rows': len(held),
        'held': float(held.mean()),
        'breaks': int((held[:-1] & ~held[1:]).sum()),
        'switches': int((np.diff(holder[held]) != 0).sum()),
        'first_confirmation_s': float(time[held][0] - time[0]) if held.any() else None,
    }


def _false(live: Live, false, holder, scans: int) -> dict:
    count = np.bincount(live.track[false], minlength=live.track.max(initial=-1) + 1)
    count[np.unique(holder[holder >= 0])] = 0  # tracks that were once on a target
    return {
        'false_per_scan': int(false.sum()) / scans,
        'false_short_lived_per_scan': int(count[count < SHORT_LIVED].sum()) / scans,
        'false_tracks': int((count > 0).sum()),
    }


def _mean(values) -> float | None:
    return float(values.mean()) if len(values) else None


def _rms(values) -> float | None:
    return float(np.sqrt(np.mean(values**2))) if len(values) else None
