"""Track files: the tracks after each scan, one row for each track and scan, as CSV."""

from typing import IO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import tables
from ..files import Place
from ..geometry import KNOT, own_ship_at, to_range_bearing, wrap_bearing
from ..types import Array, Extrapolation, IntArray, OwnShip

COLUMNS = (
    'time_s',
    'track',
    'status',
    'north_m',
    'east_m',
    'vel_north_mps',
    'vel_east_mps',
    'pred_north_m',
    'pred_east_m',
    'scan',
    'sd_north_m',
    'sd_east_m',
    'course_deg',
    'speed_kn',
    'range_m',
    'bearing_deg',
    'plot',
    'estimator',
    'target',
    'cpa_nm',
    'tcpa_min',
    'danger',
    'danger_probability',
    'length_m',
    'beam_m',
    'heading_deg',
)
REQUIRED = COLUMNS[:7]


class TargetColumns(NamedTuple):
    """The ARPA's values for N tracks; nan or '' if there is none.

    number              [N]  of the target, 0 for none
    cpa, tcpa           [N]  NM, min
    danger              [N]  safe, nearly or dangerous
    danger_probability  [N]
    length, beam        [N]  m
    heading             [N]  rad, of the hull
    """

    number: NDArray[np.int64]
    cpa: Array
    tcpa: Array
    danger: NDArray[np.str_]
    danger_probability: Array
    length: Array
    beam: Array
    heading: Array


class TrackRows(NamedTuple):
    """R rows of a track file, in the file's order.

    time       [R]     s
    track      [R]     the track's name, text
    status     [R]     tentative, confirmed, coasting or lost
    position   [R, 2]  m, east and north
    velocity   [R, 2]  m/s, east and north
    predicted  [R, 2]  m, where the scan before expected the track at `time`; nan where unknown
    scan       [R]     the source's scan number; None where the file does not tell
    """

    time: Array
    track: NDArray[np.str_]
    status: NDArray[np.str_]
    position: Array
    velocity: Array
    predicted: Array
    scan: NDArray[np.int64] | None


def write_header(file: IO[str]) -> None:
    """The line that names the columns."""
    file.write(','.join(COLUMNS) + '\n')


def write_scan(
    file: IO[str],
    scan: int,
    tracks: Extrapolation,
    track: IntArray,
    status: NDArray[np.str_],
    predicted: Array,
    plot: IntArray,
    own_ship: OwnShip,
    estimator: str,
    targets: TargetColumns,
) -> None:
    """One row for each of N tracks.

    tracks     where they are, N rows        track      [N] id
    status     [N] name                      predicted  [N, 2] m, nan where unknown
    plot       [N] row of the scan's plots that the track took, -1 for none
    own_ship   gives range and bearing
    targets    N rows
    """
    origin, _ = own_ship_at(own_ship, tracks.time)
    range_, bearing = to_range_bearing(tracks.position - origin)
    speed, course = to_range_bearing(tracks.velocity)
    sd = np.sqrt(np.einsum('nii->ni', tracks.covariance))
    for n, time in enumerate(tracks.time):
        (east, north), (vel_east, vel_north) = tracks.position[n], tracks.velocity[n]
        pred_east, pred_north = predicted[n]
        expected = ',' if np.isnan(pred_east) else f'{pred_north:.4f},{pred_east:.4f}'
        taken = '' if plot[n] < 0 else plot[n]
        file.write(
            f'{time:.4f},{track[n]},{status[n]},{north:.4f},{east:.4f},'
            f'{vel_north:.4f},{vel_east:.4f},{expected},{scan},{sd[n, 1]:.3f},{sd[n, 0]:.3f},'
            f'{_degrees(course[n])},{speed[n] / KNOT:.3f},{range_[n]:.2f},'
            f'{_degrees(bearing[n])},{taken},{estimator},{_told(targets, n)}\n'
        )


def read(path: Place) -> TrackRows:
    """The rows of a track file, of this or of another tracker. Only the first seven columns are
    required.

    ValueError names the file, the line and the error.
    """
    table = tables.read(path, REQUIRED)

    def east_north(prefix, unit):
        return np.stack([table.numbers(f'{prefix}{way}_{unit}') for way in ('east', 'north')], -1)

    predicted = np.full((len(table), 2), np.nan)
    for axis, name in enumerate(('pred_east_m', 'pred_north_m')):
        if name in table.columns:
            predicted[:, axis] = table.numbers(name, missing=True)
    return TrackRows(
        table.numbers('time_s'),
        np.array(table.columns['track'], dtype=np.str_),
        np.array(table.columns['status'], dtype=np.str_),
        east_north('', 'm'),
        east_north('vel_', 'mps'),
        predicted,
        table.integers('scan') if 'scan' in table.columns else None,
    )


def _degrees(bearing) -> str:
    """Degrees with two decimals; 0.00 for what rounds to 360."""
    return f'{np.degrees(wrap_bearing(bearing)) % 359.995:.2f}'


def _told(targets: TargetColumns, n: int) -> str:
    """The cells of TargetColumns; empty if there is no value."""
    heading = targets.heading[n]
    return ','.join(
        (
            str(targets.number[n] or ''),
            _number(targets.cpa[n], 4),
            _number(targets.tcpa[n], 3),
            targets.danger[n],
            _number(targets.danger_probability[n], 3),
            _number(targets.length[n], 1),
            _number(targets.beam[n], 1),
            '' if np.isnan(heading) else _degrees(heading),
        )
    )


def _number(value: float, digits: int) -> str:
    return f'{value:.{digits}f}' if np.isfinite(value) else ''
