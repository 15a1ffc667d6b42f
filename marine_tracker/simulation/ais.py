"""Ships driven by AIS reports: a CSV of positions made into smooth ways.

Columns: time_s, vessel, lat_deg, lon_deg; sog_kn, heading_deg, length_m, beam_m and type may be
there too. Times are whole seconds and sometimes late, so a position is metres off along the way:
the way is a cubic smoothing spline, not one through every report.
"""

import csv
import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PPoly, make_smoothing_spline

from ..geodesy import LocalFrame, wrap_longitude
from ..geometry import KNOT
from ..types import Array
from .motion import Piece

COLUMNS = ('time_s', 'vessel', 'lat_deg', 'lon_deg')
SMOOTHED_PERIOD = 40.0  # s: slower motion is followed, faster motion is taken for jitter
MAX_SPEED = 100 * KNOT  # m/s, between two reports
CLOCK_ERROR = 10.0  # s, of a report's time, as seen in recorded traffic


class Reports(NamedTuple):
    """One vessel's reports near the scenario's time.

    time       [R]  s, from the scenario's start, strictly increasing
    latitude   [R]  deg
    longitude  [R]  deg
    length     m, nan where unknown
    max_gap    s; between reports farther apart than this the vessel is not there
    """

    time: Array
    latitude: Array
    longitude: Array
    length: float
    max_gap: float


def read(path: Path, start: float, duration: float, max_gap: float) -> dict[str, Reports]:
    """The vessels that are there from time `start` s of the file on for `duration` s, by name.

    Raises ValueError for a file that is not of this form, naming line, column and value.
    """
    rows: dict[str, list[tuple[float, ...]]] = {}
    try:
        with open(path, newline='') as file:
            table = csv.DictReader(file)
            for column in COLUMNS:
                if column not in (table.fieldnames or ()):
                    raise ValueError(f'AIS file {path} has no column {column}')
            for row in table:
                place = f'AIS file {path} line {table.line_num}'
                time, latitude, longitude = (
                    _number(row, column, place) for column in ('time_s', 'lat_deg', 'lon_deg')
                )
                if abs(latitude) > 90 or abs(longitude) > 180:
                    raise ValueError(
                        f'{place}: no place on Earth: lat_deg {latitude:g}, lon_deg {longitude:g}'
                    )
                rows.setdefault(row['vessel'], []).append(
                    (time - start, latitude, longitude, _length(row))
                )
    except OSError as error:
        raise ValueError(f'AIS file {path} cannot be read: {error.strerror}') from error
    vessels = {}
    for vessel, found in rows.items():
        reports = _reports(np.array(found), duration, max_gap, f'AIS file {path} vessel {vessel}')
        if reports is not None:
            vessels[vessel] = reports
    if not vessels:
        raise ValueError(
            f'AIS file {path} has no vessel between {start:g} s and {start + duration:g} s'
        )
    return vessels


def _number(row, column, place):
    try:
        value = float(row[column])
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f'{place}: {column} is {row[column]!r}; it must be a number')
    return value


def _length(row):
    try:
        return float(row.get('length_m') or 'nan')
    except ValueError:  # '<NA>' and the like
        return math.nan


def _reports(found, duration, max_gap, place):
    """Reports in time order with those of one time averaged; None where none is of use."""
    time, first, which = np.unique(found[:, 0], return_index=True, return_inverse=True)
    count = np.bincount(which)
    latitude = np.bincount(which, found[:, 1]) / count
    about = found[first, 2]  # 179.9 E and 179.9 W are near each other: count from the first one
    beyond = np.bincount(which, wrap_longitude(found[:, 2] - about[which])) / count
    longitude = wrap_longitude(about + beyond)
    useful = (time >= -max_gap) & (time <= duration + max_gap)
    time, latitude, longitude = time[useful], latitude[useful], longitude[useful]
    if len(time) < 2 or time[-1] <= 0 or time[0] >= duration:
        return None
    before = LocalFrame(latitude[:-1], longitude[:-1])
    step = np.hypot(*before.to_local(latitude[1:], longitude[1:]).T)
    jump = step > MAX_SPEED * (np.diff(time) + CLOCK_ERROR)
    if jump.any():
        k = int(np.argmax(jump))
        raise ValueError(
            f'{place} moves {step[k]:.0f} m in {time[k + 1] - time[k]:g} s; that is '
            'more than 100 kn'
        )
    lengths = found[:, 3][np.isfinite(found[:, 3])]
    return Reports(time, latitude, longitude, lengths[0] if len(lengths) else math.nan, max_gap)


def way(reports: Reports, frame: LocalFrame) -> list[Piece]:
    """The vessel's way in the frame: a spline over each run without gaps."""
    position = frame.to_local(reports.latitude, reports.longitude)
    ends = np.flatnonzero(np.diff(reports.time) > reports.max_gap) + 1
    pieces = [Piece(min(0.0, reports.time[0]) - 1.0, tuple(position[0]), exists=False)]
    for time, place in zip(np.split(reports.time, ends), np.split(position, ends), strict=True):
        if len(time) > 1:
            curve = _spline(time, place)
            pieces += [
                Piece(start, tuple(c[3]), cubic=(tuple(c[2]), tuple(c[1]), tuple(c[0])))
                for start, c in zip(curve.x[:-1], np.moveaxis(curve.c, 1, 0), strict=True)
                if start < time[-1]
            ]
        pieces.append(Piece(time[-1], tuple(place[-1]), exists=False))
    return pieces


def _spline(time, place):
    """A piecewise cubic [4, pieces, 2] over the reports of one run."""
    if len(time) < 5:  # too few to smooth: straight from one to the next
        slope = np.diff(place, axis=0) / np.diff(time)[:, None]
        zero = np.zeros_like(slope)
        return PPoly(np.stack([zero, zero, slope, place[:-1]]), time)
    # Reports T apart, smoothed with this weight, pass slow motion w as 1 / (1 + weight T w^4).
    weight = (SMOOTHED_PERIOD / (2 * np.pi)) ** 4 / np.diff(time).mean()
    columns = [
        PPoly.from_spline(make_smoothing_spline(time, column, lam=weight)) for column in place.T
    ]
    curve = PPoly(np.stack([column.c for column in columns], -1), columns[0].x)
    inside = np.flatnonzero(np.diff(curve.x) > 0)  # without the spline's repeated ends
    return PPoly(curve.c[:, inside], np.append(curve.x[inside], curve.x[inside[-1] + 1]))
