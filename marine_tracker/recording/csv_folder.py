"""Recordings as folders of CSV files: what was plotted, where own ship was, where targets were.

A folder holds
  plots.csv      scan, time_s, range_m, bearing_deg [, amplitude_db] [, radial_speed_mps]; true
                 bearing from own ship; radial speed over ground, positive when opening, empty where
                 a plot tells none
  own_ship.csv   scan, time_s, north_m, east_m [, vel_north_mps, vel_east_mps] [, end_s]
                 [, heading_deg], true, empty where it is not known;
                 one row for every scan, also those without plots
  truth.csv      scan, time_s, target, north_m, east_m, vel_north_mps, vel_east_mps; may be left
                 out; velocities may be nan
  radar.yaml     tracker parameters that belong to this radar and its waters; may be left out
  notes.json     what is known of the recording (plot lag, cutoff for scoring); may be left out

`end_s` is when the revolution that began at `time_s` ended. Without it, where plots carry times of
their own, a revolution is taken to last from its row's time to the next row's, if its plots lie
between them, else from its first plot to its last one. A scan whose plots all carry one time, as
most recordings have them, has no length.
"""

import contextlib
import csv
import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import tables, yaml_file
from ..files import Place, written
from ..geometry import heading_at, own_ship_at, wrap_bearing
from ..types import Array, OwnShip, PolarPlots, Scan, Truth, take

PLOTS = ('scan', 'time_s', 'range_m', 'bearing_deg')
OWN_SHIP = ('scan', 'time_s', 'north_m', 'east_m')
TRUTH = ('scan', 'time_s', 'target', 'north_m', 'east_m')
VELOCITY = ('vel_north_mps', 'vel_east_mps')
RADIAL_SPEED = 'radial_speed_mps'
HEADING = 'heading_deg'
MAX_TIME = 1e11  # s, either way: beyond all clocks


class Recording(NamedTuple):
    """A recording: K scans in time order.

    name                the folder's name
    scans               K scans; each knows own ship at its own, the last and the next scan
    truths              K truths, one a scan; without rows where the recording has none
    tracker_parameters  names and values for TrackerParameters
    notes               what notes.json says
    numbers             [K] the source's scan numbers, increasing
    own_ship            own ship's K samples, one a scan
    """

    name: str
    scans: tuple[Scan, ...]
    truths: tuple[Truth, ...]
    tracker_parameters: dict[str, Any]
    notes: dict[str, Any]
    numbers: NDArray[np.int64]
    own_ship: OwnShip


def read(folder: Place) -> Recording:
    """The recording in a folder; ValueError names the file, the line and what is wrong with it."""
    folder = Path(folder)
    if not folder.is_dir():
        raise ValueError(f'recording {folder} is not a folder')
    numbers, own_ship, end = _read_own_ship(folder / 'own_ship.csv')
    plots = _read_plots(folder / 'plots.csv', numbers)
    has_truth = (folder / 'truth.csv').exists()
    truths = (
        _read_truth(folder / 'truth.csv', numbers) if has_truth else (_no_truth(),) * len(numbers)
    )
    scans: list[Scan] = []
    spans = _spans(own_ship.time, end, [of_scan.time for of_scan in plots])
    for k, (of_scan, (start, last)) in enumerate(zip(plots, spans)):
        around = slice(max(k - 1, 0), k + 2)
        if scans and start < scans[-1].start:
            raise ValueError(
                f'{folder / "plots.csv"}: scan {numbers[k]} begins at {start:g} s, '
                f'before the scan ahead of it, {scans[-1].start:g} s'
            )
        scans.append(Scan(float(start), float(last), of_scan, take(own_ship, around)))
    radar, notes = folder / 'radar.yaml', folder / 'notes.json'
    return Recording(
        folder.resolve().name,
        tuple(scans),
        truths,
        yaml_file.read_mapping(radar) if radar.exists() else {},
        yaml_file.read_json(notes) if notes.exists() else {},
        numbers,
        own_ship,
    )


def write(
    folder: Place,
    name: str,
    pairs: Iterable[tuple[Scan, Truth]],
    tracker_parameters: dict[str, Any],
    notes: dict[str, Any] | None = None,
) -> None:
    """Scans with their truth as a recording folder, made where it does not exist.

    name   goes into notes.json, for people
    notes  what else does, e.g. {'cutoff_m': 500.0, 'seen_within_m': 250.0, 'uncooperative': False}
    Own ship stands where it was when the scan began. ValueError where the folder cannot be made.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ValueError(f'recording folder {folder} cannot be made: {error}') from error
    plots, own_ship, truth, speeds = [], [], [], []
    for k, (scan, targets) in enumerate(pairs):
        position, velocity = own_ship_at(scan.own_ship, scan.start)
        heading = np.degrees(heading_at(scan.own_ship, scan.start))
        row = (k, *_metres(scan.start, *position[::-1], *velocity[::-1], scan.end))
        own_ship.append((*row, '' if np.isnan(heading) else f'{heading:.6f}'))
        degrees = np.degrees(scan.plots.bearing)
        plots += [
            (k, *_metres(time, range_), f'{bearing:.9f}', f'{amplitude:.3f}')
            for time, range_, bearing, amplitude in zip(
                scan.plots.time, scan.plots.range, degrees, scan.plots.amplitude
            )
        ]
        speeds.append(
            np.full(len(degrees), np.nan)
            if scan.plots.radial_speed is None
            else scan.plots.radial_speed
        )
        truth += [
            (k, *_metres(time), target, *_metres(*position[::-1], *velocity[::-1]))
            for time, target, position, velocity in zip(*targets)
        ]
    header: tuple[str, ...] = (*PLOTS, 'amplitude_db')
    told = np.concatenate([np.empty(0), *speeds])
    if np.isfinite(told).any():
        header = (*header, RADIAL_SPEED)
        plots = [
            (*plot, '' if np.isnan(speed) else f'{speed:.6f}')
            for plot, speed in zip(plots, told.tolist())
        ]
    # All of them take their places when the last one is whole; own_ship.csv, without which it is
    # no recording, last of all.
    with contextlib.ExitStack() as stack:

        def begin(file):
            return stack.enter_context(written(folder / file, newline=''))

        _write_table(begin('own_ship.csv'), (*OWN_SHIP, *VELOCITY, 'end_s', HEADING), own_ship)
        _write_table(begin('plots.csv'), header, plots)
        _write_table(begin('truth.csv'), (*TRUTH, *VELOCITY), truth)
        lines = [f'{key}: {json.dumps(value)}\n' for key, value in tracker_parameters.items()]
        begin('radar.yaml').write(''.join(lines))
        begin('notes.json').write(json.dumps({'name': name, **(notes or {})}) + '\n')


def _read_own_ship(path) -> tuple[NDArray[np.int64], OwnShip, Array]:
    """Scan numbers [K], own ship's K samples, and the scans' ends [K], nan where unknown."""
    table = tables.read(path, OWN_SHIP)
    if not len(table):
        raise ValueError(f'{path} has no rows; it must have one for every scan')
    numbers = table.integers('scan')
    time = table.numbers('time_s', low=-MAX_TIME, high=MAX_TIME)
    for column, steps in (('scan', np.diff(numbers)), ('time_s', np.diff(time))):
        back = np.flatnonzero(steps <= 0)
        if len(back):
            row = int(back[0]) + 1
            cells = table.columns[column]
            raise ValueError(
                f'{table.where(row)}: {column} is {cells[row]} after '
                f'{cells[row - 1]}; it must increase'
            )
    position = np.stack([table.numbers('east_m'), table.numbers('north_m')], -1)
    velocity = np.zeros_like(position)
    if len(time) > 1:
        velocity = np.gradient(position, time, axis=0)
    recorded = _velocity(table)
    velocity = np.where(np.isnan(recorded).any(axis=1, keepdims=True), velocity, recorded)
    end = np.full(len(time), np.nan)
    if 'end_s' in table.columns:
        end = table.numbers('end_s', missing=True, low=-MAX_TIME, high=MAX_TIME)
        early = np.flatnonzero(end < time)
        if len(early):
            row = int(early[0])
            raise ValueError(
                f'{table.where(row)}: end_s is {end[row]:g}; it must not lie before '
                f'time_s, {time[row]:g}'
            )
    heading = None
    if HEADING in table.columns:
        heading = np.radians(table.numbers(HEADING, low=-360.0, high=360.0, missing=True))
        heading = wrap_bearing(heading)
    return numbers, OwnShip(time, position, velocity, heading), end


def _spans(begin: Array, end: Array, plots: list[Array]) -> Iterator[tuple[float, float]]:
    """Start and end of each scan, from the rows' times, known ends, and the plots' times."""
    swept = any(np.ptp(times) > 0 for times in plots if len(times))
    step = np.diff(begin, append=2 * begin[-1] - begin[-2] if len(begin) > 1 else begin[-1])
    for start, known, following, times in zip(begin, end, begin + step, plots):
        first, last = times.min(initial=np.inf), times.max(initial=-np.inf)
        if not np.isnan(known):
            yield start, known
        elif swept and start <= first and last <= following:
            yield start, following
        elif len(times):
            yield first, last
        else:
            yield start, start


def _read_plots(path, numbers) -> tuple[PolarPlots, ...]:
    table = tables.read(path, PLOTS)
    amplitude = (
        table.numbers('amplitude_db', missing=True)
        if 'amplitude_db' in table.columns
        else np.zeros(len(table))
    )
    bearing = wrap_bearing(np.radians(table.numbers('bearing_deg', low=-360.0, high=360.0)))
    plots = PolarPlots(
        table.numbers('time_s', low=-MAX_TIME, high=MAX_TIME),
        table.numbers('range_m', low=0.0),
        bearing,
        np.nan_to_num(amplitude),
        (table.numbers(RADIAL_SPEED, missing=True) if RADIAL_SPEED in table.columns else None),
    )
    return tuple(take(plots, rows) for rows in _rows_of_scans(table, numbers))


def _read_truth(path, numbers) -> tuple[Truth, ...]:
    table = tables.read(path, TRUTH)
    position = np.stack([table.numbers('east_m'), table.numbers('north_m')], -1)
    truth = Truth(table.numbers('time_s'), table.integers('target'), position, _velocity(table))
    for target in np.unique(truth.target):
        rows = np.flatnonzero(truth.target == target)
        back = np.flatnonzero(np.diff(truth.time[rows]) <= 0)
        if len(back):
            before, row = rows[back[0]], rows[back[0] + 1]
            raise ValueError(
                f'{table.where(row)}: target {target} is at {truth.time[row]:g} s '
                f'after {truth.time[before]:g} s; its time must increase'
            )
    return tuple(take(truth, rows) for rows in _rows_of_scans(table, numbers))


def _rows_of_scans(table: tables.Table, numbers) -> list[NDArray[np.intp]]:
    """The rows of each scan, in the file's order."""
    scan = table.integers('scan')
    unknown = ~np.isin(scan, numbers)
    if unknown.any():
        row = int(unknown.argmax())
        raise ValueError(f'{table.where(row)}: scan {scan[row]} is not in own_ship.csv')
    order = np.argsort(scan, kind='stable')
    return np.split(order, np.searchsorted(scan[order], numbers[1:]))


def _velocity(table: tables.Table) -> Array:
    """[R, 2] m/s, east and north; nan where the table does not tell."""
    return np.stack(
        [
            table.numbers(name, missing=True)
            if name in table.columns
            else np.full(len(table), np.nan)
            for name in reversed(VELOCITY)
        ],
        -1,
    )


def _no_truth() -> Truth:
    return Truth(np.empty(0), np.empty(0, np.int64), np.empty((0, 2)), np.empty((0, 2)))


def _metres(*values) -> list[str]:
    return [f'{value:.6f}' for value in values]


def _write_table(file, header, rows) -> None:
    csv.writer(file, lineterminator='\n').writerows([header, *rows])
