"""Scores tracks by the AIS reports of the ships in view, as paper 002 does.

The rules
- Registration in time. Each vessel's AIS reports come at irregular times, sometimes late. They are
  turned into one smooth path (simulation/ais.py). The path gives the vessel's position at the time
  of each track row. In a gap longer than `max_gap` the vessel is unknown and is not scored.
- Registration in space. Positions on Earth become local ones about the recording's origin. Tracks
  and vessels are both seen from own ship, over ground: range, bearing, radial speed.
- Only confirmed and coasting rows count. In each scan vessels and tracks are paired within the
  cutoff. A vessel keeps the track it had.
- A vessel is in view while its range lies within the ranges of the recording's plots. If the radar
  does not see it, it counts as not held. The figure does not separate radar from tracker.
- A vessel in view for `LEAST_SCANS` is lost if it has no track in the last `LOST_SCANS` of them.
  With several track files (runs), the lost are a share of all vessels and runs.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geodesy import LocalFrame
from ..geometry import own_ship_at, to_range_bearing, unit_vector, wrap_angle
from ..recording.csv_folder import Recording
from ..recording.track_file import TrackRows
from ..simulation import ais, ais_file, motion
from ..types import Array
from .gospa import assign_sticky
from .metrics import CUTOFF, Live, chosen, live_rows
from .recorded_truth import by_scan

MAX_GAP = 120.0  # s
LEAST_SCANS, LOST_SCANS = 16, 8
CLASSES = (1, 10, 20, 50)  # scans; each class of track lengths begins at one of these

_ERRORS = {
    'radial_speed': ('mps', 'm/s', 'radial speed'),
    'range': ('m', 'm', 'range'),
    'bearing': ('deg', 'deg', 'bearing'),
}
_CLASS_NAMES = [
    f'tracks_of_{low}_to_{high - 1}_scans' for low, high in zip(CLASSES, CLASSES[1:])
] + [f'tracks_of_{CLASSES[-1]}_scans_or_more']
FIGURES = {
    'runs': ('', 'track files'),
    'vessels': ('', f'vessels in view for {LEAST_SCANS} scans or more'),
    'rows_left_out': ('', 'rows of the AIS file that could not be used'),
    'held': ('', 'part of their scans in view with a track, all vessels'),
    'lost_percent': ('%', f'vessels and runs without track in the last {LOST_SCANS} scans in view'),
    **{
        f'{name}_error_{what}_{suffix}': (unit, f'{text} of the error in {words}')
        for name, (suffix, unit, words) in _ERRORS.items()
        for what, text in (('mean', 'mean'), ('sd', 'standard deviation'), ('max', 'greatest size'))
    },
    'ahead_s': ('s', 'time by which tracks run ahead of AIS along its way; late reports show here'),
    'tracks': ('', 'tracks, per run'),
    **{name: ('', 'of them, by length') for name in _CLASS_NAMES},
    'strangers': ('', 'of them, those never on a vessel with AIS'),
    'mean_length_scans': ('', 'mean length of a track in scans'),
    'mean_length_s': ('s', 'mean time from first to last row of a track'),
    'roughness_m': ('m', 'RMS second difference of the place of paired tracks, scan to scan'),
}


class _Fleet(NamedTuple):
    """names of V vessels, their ways, and how many rows of the file could not be used."""

    names: list[str]
    paths: motion.Paths
    skipped: int

    def at(self, time: Array):
        """Place [R, V, 2] m, velocity m/s, and existence [R, V], each row at its own time [R]."""
        vessel = np.tile(np.arange(len(self.names)), len(time))
        at = np.repeat(time, len(self.names))
        position, velocity = motion.locate_ships(self.paths, vessel, at)
        shape = (len(time), len(self.names))
        return (
            position.reshape(*shape, 2),
            velocity.reshape(*shape, 2),
            motion.exist(self.paths, vessel, at).reshape(shape),
        )


class _Run(NamedTuple):
    """One track file against AIS.

    live   R rows of live tracks
    pairs  [P, 2]  rows of them, and the vessels they are paired with
    held   [K, V]  whether each vessel has a track in each scan
    """

    live: Live
    pairs: NDArray[np.int64]
    held: NDArray[np.bool_]


def score(
    recording: Recording,
    runs: Sequence[TrackRows],
    ais_file: Path,
    origin: Sequence[float] | None = None,
    start: float | None = None,
    cutoff: float | None = None,
    max_gap: float = MAX_GAP,
) -> dict[str, float | int | None]:
    """The figures of FIGURES; None where there was no data for one.

    runs    track files of the same scans
    origin  latitude and longitude in degrees of the recording's [0, 0]; default the notes' origin
    start   s, the AIS file's time at the recording's time 0; default the notes' ais_start_s, else 0
    cutoff  m; a track farther from a vessel is not on it; default the notes' cutoff_m, else 100
    max_gap s; between reports farther apart the vessel is unknown
    ValueError for a value that is not a finite number, for a recording without a position on Earth,
    and for an AIS file that is wrong or has no vessel at that time.
    """
    cutoff = chosen(recording, 'cutoff_m', cutoff, CUTOFF, above=0.0)
    start = chosen(recording, 'ais_start_s', start, 0.0)
    if not 0 < max_gap < np.inf:
        raise ValueError(f'max_gap is {max_gap:g} s; it must be above 0 and finite')
    fleet = _fleet(recording, ais_file, _origin(recording, origin), start, max_gap)
    in_view = _in_view(recording, fleet)
    done = [_pair(recording, live_rows(recording, rows), fleet, in_view, cutoff) for rows in runs]
    long = in_view.sum(0) >= LEAST_SCANS
    lost = [
        not run.held[np.flatnonzero(in_view[:, v])[-LOST_SCANS:], v].any()
        for run in done
        for v in np.flatnonzero(long)
    ]
    of_long = [run.held[:, long][in_view[:, long]] for run in done]
    figures: dict[str, float | int | None] = {
        'runs': len(runs),
        'vessels': int(long.sum()),
        'held': _mean(np.concatenate(of_long)),
        'rows_left_out': fleet.skipped,
        'lost_percent': _mean(100.0 * np.array(lost)),
        **_errors(recording, done, fleet),
        **_lengths(done),
    }
    return {name: figures[name] for name in FIGURES}


def _origin(recording: Recording, given: Sequence[float] | None) -> LocalFrame:
    origin = recording.notes.get('origin') if given is None else given
    if origin is None:
        raise ValueError(
            f'recording {recording.name} does not tell where on Earth it is: give '
            'its origin, here or in notes.json'
        )
    if not (
        isinstance(origin, (list, tuple))
        and len(origin) == 2
        and all(
            type(degrees) in (int, float) and abs(degrees) <= most
            for degrees, most in zip(origin, (90, 180))
        )
    ):
        raise ValueError(
            f'origin is {origin}; it must be latitude and longitude in degrees, '
            'from -90 to 90 and from -180 to 180'
        )
    return LocalFrame(float(origin[0]), float(origin[1]))


def _fleet(recording, file, frame, start, max_gap) -> _Fleet:
    end = float(recording.scans[-1].end)
    traffic = ais_file.read(file, start, end, max_gap)
    vessels = traffic.vessels
    ways = [ais.way(reports, frame) for reports in vessels.values()]
    return _Fleet(list(vessels), motion.table(ways, end), sum(traffic.skipped.values()))


def _in_view(recording: Recording, fleet: _Fleet) -> NDArray[np.bool_]:
    """[K, V] whether each vessel is known and within the ranges of the plots."""
    middle = np.array([0.5 * (scan.start + scan.end) for scan in recording.scans])
    position, _, known = fleet.at(middle)
    own, _ = own_ship_at(recording.own_ship, middle)
    distance = np.linalg.norm(position - own[:, None], axis=-1)
    ranges = np.concatenate([scan.plots.range for scan in recording.scans])
    return (
        known & (distance >= ranges.min(initial=np.inf)) & (distance <= ranges.max(initial=-np.inf))
    )


def _pair(recording: Recording, live: Live, fleet: _Fleet, in_view, cutoff: float) -> _Run:
    position, _, known = fleet.at(live.time)
    apart = np.linalg.norm(position - live.position[:, None], axis=-1)
    apart[~known] = np.inf
    held = np.zeros(in_view.shape, bool)
    last = np.full(len(fleet.names), -1)
    pairs = [np.zeros((0, 2), np.int64)]
    for k, rows in enumerate(by_scan(live.scan, len(recording.scans))):
        near = np.flatnonzero((apart[rows] < cutoff).any(0))
        distance = np.minimum(apart[rows][:, near].T, 2 * cutoff)
        vessel, column = assign_sticky(
            distance, cutoff, [np.flatnonzero(live.track[rows] == last[v]).tolist() for v in near]
        )
        held[k, near[vessel]] = True
        last[near[vessel]] = live.track[rows[column]]
        pairs.append(np.stack([rows[column], near[vessel]], -1))
    return _Run(live, np.concatenate(pairs), held)


def _errors(recording: Recording, done: list[_Run], fleet: _Fleet) -> dict:
    """Of all pairs of all runs: track minus AIS, both seen from own ship as if at rest at that
    moment.
    """
    parts = []
    for run in done:
        row, vessel = run.pairs.T
        time = run.live.time[row]
        position, velocity, _ = (values[np.arange(len(row)), vessel] for values in fleet.at(time))
        own, _ = own_ship_at(recording.own_ship, time)
        seen, true = (
            _seen(place - own, speed)
            for place, speed in (
                (run.live.position[row], run.live.velocity[row]),
                (position, velocity),
            )
        )
        ahead = ((run.live.position[row] - position) * velocity).sum(1)
        parts.append(
            np.column_stack(
                [
                    seen[0] - true[0],
                    seen[1] - true[1],
                    np.degrees(wrap_angle(seen[2] - true[2])),
                    ahead,
                    (velocity**2).sum(1),
                ]
            )
        )
    errors = np.concatenate(parts)
    figures: dict[str, float | None] = {}
    for column, (name, (suffix, _, _)) in enumerate(_ERRORS.items()):
        off = errors[:, column]
        some = len(off) > 0
        figures[f'{name}_error_mean_{suffix}'] = float(off.mean()) if some else None
        figures[f'{name}_error_sd_{suffix}'] = float(off.std()) if some else None
        figures[f'{name}_error_max_{suffix}'] = float(np.abs(off).max()) if some else None
    # The time shift for which the positions along the paths fit best, by least squares.
    moved = errors[:, 4].sum()
    figures['ahead_s'] = float(errors[:, 3].sum() / moved) if moved > 0 else None
    return figures


def _seen(offset, velocity):
    """Radial speed m/s, range m and bearing rad [P] of offsets from own ship [P, 2]."""
    distance, bearing = to_range_bearing(offset)
    return (velocity * unit_vector(bearing)).sum(1), distance, bearing


def _lengths(done: list[_Run]) -> dict:
    """Number of tracks a run, by length; their mean length and roughness."""
    scans, seconds, strange, bends = [], [], 0, []
    for run in done:
        live = run.live
        count = int(live.track.max(initial=-1)) + 1
        length = np.bincount(live.track, minlength=count)
        first, last = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(first, live.track, live.time)
        np.maximum.at(last, live.track, live.time)
        scans.append(length)
        seconds.append(last - first)
        strange += count - len(np.unique(live.track[run.pairs[:, 0]]))
        row = run.pairs[:, 0]
        before = live.before[row]
        row, before = row[before >= 0], before[before >= 0]
        earlier = live.before[before]
        row, before, earlier = (rows[earlier >= 0] for rows in (row, before, earlier))
        bends.append(live.position[row] - 2 * live.position[before] + live.position[earlier])
    length, bend = np.concatenate(scans), np.concatenate(bends)
    which = np.searchsorted(CLASSES, length, 'right') - 1
    runs = len(done)
    return {
        'tracks': len(length) / runs,
        **{name: int((which == k).sum()) / runs for k, name in enumerate(_CLASS_NAMES)},
        'strangers': strange / runs,
        'mean_length_scans': _mean(length),
        'mean_length_s': _mean(np.concatenate(seconds)),
        'roughness_m': float(np.sqrt((bend**2).sum(1).mean())) if len(bend) else None,
    }


def _mean(values) -> float | None:
    return float(np.mean(values)) if len(values) else None
