"""AIS reports from CSV files: in the project's own columns, or as others publish them.

| file of | time | vessel | place | length |
|---|---|---|---|---|
| marine_tracker | time_s | vessel | lat_deg, lon_deg | length_m |
| MarineCadastre, to 2024 | BaseDateTime | MMSI | LAT, LON | Length |
| MarineCadastre, from 2025 | base_date_time | mmsi | latitude, longitude | length |
| Danish Maritime Authority | # Timestamp | MMSI | Latitude, Longitude | Length |
| Stone Soup's Solent | Time | MMSI | Latitude_degrees, Longitude_degrees | |

Length is optional; other columns are ignored. A time is a number of seconds, or date and time of
day: 2022-06-20T00:00:04 (with or without T, fraction, zone) or 31/12/2015 23:59:59. Dates become
Unix time, as UTC if no zone is given.

Rows that cannot be used are left out and counted, for all vessels and times: damaged rows; rows
without a place (91 and 181 degrees mean "not available"); and rows that need more than 100 kn to be
reached from the rows that most others agree with.
"""

import math
from array import array
from collections import Counter
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import tables
from ..files import shortened
from ..geodesy import LocalFrame, wrap_longitude
from ..geometry import KNOT
from ..types import Array
from .ais import Reports

COLUMNS = ('time_s', 'vessel', 'lat_deg', 'lon_deg')
# Other names of each, in small letters and without '#'.
TIME = ('time_s', 'basedatetime', 'base_date_time', 'timestamp', 'time')
VESSEL = ('vessel', 'mmsi')
LATITUDE = ('lat_deg', 'lat', 'latitude', 'latitude_degrees')
LONGITUDE = ('lon_deg', 'lon', 'longitude', 'longitude_degrees')
LENGTH = ('length_m', 'length')

MAX_SPEED = 100 * KNOT  # m/s, between two reports
CLOCK_ERROR = 10.0  # s, of a report's time, as seen in recorded traffic
MAX_CHAINS = 20  # groups of rows that agree, of one vessel
MAX_LENGTH = 500.0  # m

CELLS = 'with too few or too many cells'
NO_VESSEL = 'without a vessel'
NO_TIME = 'without a time that is understood'
NO_PLACE = 'without a place on Earth'
JUMP = 'that jump faster than 100 kn'


class Traffic(NamedTuple):
    """The content of a file for a stretch of time.

    vessels  reports by the vessel's name
    start    s, of the file's own time, at which the stretch begins
    skipped  number of rows of the whole file that were left out, by reason
    """

    vessels: dict[str, Reports]
    start: float
    skipped: dict[str, int]


class _Columns(NamedTuple):
    """The columns of the cells of one report; length -1 if there is none."""

    time: int
    vessel: int
    latitude: int
    longitude: int
    length: int


class _Vessel(NamedTuple):
    """The rows of one vessel: a number a row, in the file's order."""

    time: array
    latitude: array
    longitude: array
    length: array


def read(path: Path, start: float | None, duration: float, max_gap: float) -> Traffic:
    """The vessels that exist from time `start` s of the file on for `duration` s.

    start    None: time 0, or the first report if times are dates
    max_gap  s; in a longer gap between reports a vessel does not exist
    Raises ValueError for a file that does not have this form, and if no vessel exists then.
    """
    try:
        vessels, dated, skipped = _rows(path)
        first = min((min(rows.time) for rows in vessels.values()), default=0.0)
        last = max((max(rows.time) for rows in vessels.values()), default=0.0)
        if start is None:
            start = first if dated else 0.0
        found = {}
        for name, rows in vessels.items():
            reports = _reports(rows, start, duration, max_gap, skipped)
            if reports is not None:
                found[name] = reports
    except ValueError as error:
        raise ValueError(f'AIS file {error}') from None
    if not found:
        raise ValueError(
            f'AIS file {shortened(path)} has no vessel between {start:.14g} s '
            f'and {start + duration:.14g} s; '
            f'its times are {first:.14g} s to {last:.14g} s{told(skipped)}'
        )
    return Traffic(found, start, dict(skipped))


def told(skipped: dict[str, int]) -> str:
    """Text about the rows that were left out; '' if there are none."""
    reasons = ', '.join(f'{count} {reason}' for reason, count in skipped.items())
    return f'; rows left out: {reasons}' if reasons else ''


def _rows(path: Path) -> tuple[dict[str, _Vessel], bool, Counter]:
    """All usable rows by vessel, whether times are dates, and what was left out."""
    names, rows = tables.rows(path, broken='replace')
    columns = _columns(path, names)
    vessels: dict[str, _Vessel] = {}
    skipped: Counter = Counter()
    seconds: Callable[[str], float] | None = None
    dated = False
    for _, cells in rows:
        if len(cells) != len(names):
            skipped[CELLS] += 1
            continue
        name = cells[columns.vessel].removesuffix('.0')
        if not name or len(name) > 60:
            skipped[NO_VESSEL] += 1
            continue
        text = cells[columns.time]
        if seconds is None:
            dated = math.isnan(_number(text)) and not math.isnan(_date(text))
            seconds = _date if dated else None if math.isnan(_number(text)) else _number
        time = seconds(text) if seconds else math.nan
        if not abs(time) < 1e11:
            skipped[NO_TIME] += 1
            continue
        latitude, longitude = _number(cells[columns.latitude]), _number(cells[columns.longitude])
        if not (abs(latitude) <= 90 and abs(longitude) <= 180):
            skipped[NO_PLACE] += 1
            continue
        found = vessels.get(name)
        if found is None:
            found = vessels[name] = _Vessel(*(array('d') for _ in range(4)))
        found.time.append(time)
        found.latitude.append(latitude)
        found.longitude.append(longitude)
        length = _number(cells[columns.length]) if columns.length >= 0 else math.nan
        if 0 < length <= MAX_LENGTH and not found.length:
            found.length.append(length)
    return vessels, dated, skipped


def _columns(path: Path, names: list[str]) -> _Columns:
    known = [name.lstrip('# ').lower() for name in names]

    def place(choices) -> int:
        return next((known.index(name) for name in choices if name in known), -1)

    columns = _Columns(*map(place, (TIME, VESSEL, LATITUDE, LONGITUDE, LENGTH)))
    for name, found in zip(COLUMNS, columns):
        if found < 0:
            raise ValueError(
                f'{shortened(path)} has no column {name}; it has {shortened(", ".join(names))}'
            )
    return columns


def _number(text: str) -> float:
    """A finite number; nan for anything else."""
    try:
        value = float(text)
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan


def _date(text: str) -> float:
    """Unix time of date and time of day; nan for anything else."""
    if text[2:3] == '/' == text[5:6]:  # 31/12/2015 23:59:59
        text = f'{text[6:10]}-{text[3:5]}-{text[:2]}{text[10:]}'
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        return math.nan
    if moment.tzinfo is None:
        moment = moment.replace(tzinfo=UTC)
    return moment.timestamp()


def _reports(
    rows: _Vessel, start: float, duration: float, max_gap: float, skipped: Counter
) -> Reports | None:
    """Reports in time order, with those of one time averaged; None if none can be used."""
    time, latitude, longitude = (np.array(column) for column in rows[:3])
    order = np.argsort(time, kind='stable')
    order = order[_agreeing(time[order], latitude[order], longitude[order])]
    if len(order) < len(time):
        skipped[JUMP] += len(time) - len(order)
    longitude = np.unwrap(longitude[order], period=360.0)  # 180 E and 180 W are near each other
    time, which = np.unique(time[order] - start, return_inverse=True)
    count = np.bincount(which)
    latitude = np.bincount(which, latitude[order]) / count
    longitude = wrap_longitude(np.bincount(which, longitude) / count)
    useful = (time >= -max_gap) & (time <= duration + max_gap)
    time, latitude, longitude = time[useful], latitude[useful], longitude[useful]
    if len(time) < 2 or time[-1] <= 0 or time[0] >= duration:
        return None
    length = rows.length[0] if rows.length else math.nan
    return Reports(time, latitude, longitude, length, max_gap)


def _agreeing(time: Array, latitude: Array, longitude: Array) -> NDArray[np.bool_]:
    """[R] the rows, in time order, that most others agree with: each can be reached from the
    previous one.
    """
    kept = np.ones(len(time), bool)
    apart = _distance(latitude[1:], longitude[1:], latitude[:-1], longitude[:-1])
    if (apart <= _reach(np.diff(time))).all():
        return kept
    chains: list[list[int]] = []
    for row in range(len(time)):
        ends = np.array([chain[-1] for chain in chains], np.intp)
        far = _distance(latitude[ends], longitude[ends], latitude[row], longitude[row])
        fits = np.flatnonzero(far <= _reach(time[row] - time[ends]))
        if len(fits):
            chains[max(fits, key=lambda k: chains[k][-1])].append(row)
        elif len(chains) < MAX_CHAINS:
            chains.append([row])
    kept[:] = False
    kept[max(chains, key=len)] = True
    return kept


def _reach(step):
    """Largest distance, m, that a vessel can move in steps s."""
    return MAX_SPEED * (step + CLOCK_ERROR)


def _distance(latitude, longitude, from_latitude, from_longitude) -> Array:
    """m between places in degrees."""
    frame = LocalFrame(from_latitude, from_longitude)
    return np.hypot(*frame.to_local(latitude, longitude).T)
