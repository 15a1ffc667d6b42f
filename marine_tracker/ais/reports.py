"""Reports of ships as they were sent, as arrays. What a message does not tell is nan, -1 or ''."""

import math
from collections.abc import Callable, Mapping, Sequence
from enum import Enum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import m1371
from ..geometry import KNOT
from ..types import Array, BoolArray, CodeArray, IntArray

Text = NDArray[np.str_]

# Message types that are used: of ships, of aircraft, of aids to navigation.
TYPES = (1, 2, 3, 5, 9, 18, 19, 21, 24, 27)
STATIC_ONLY = (5, 24)
LONG_RANGE = 27
NO_TIME = 60  # of the field second: from there on none is told
UNKNOWN_TURN = 720.0  # deg/min; the field tells no more than a direction from there on

NO_IDENTITY = 'without an identity'
NO_PLACE = 'with a place that is not on Earth'
LEFT_OUT = ('speeds', 'courses', 'headings', 'sizes')  # values that cannot be, of reports taken


class Reports(NamedTuple):
    """R reports, one row a message.

    heard      [R]  s, when it came
    time       [R]  s, of the place: by the sender's second where that is known, else as heard
    timed      [R]  whether it is by the second
    mmsi       [R]
    type       [R]  of the message: of TYPES
    latitude, longitude  [R]  deg; nan for none
    accurate   [R]  to 10 m, as the sender says
    speed, course  [R]  m/s, rad over ground; nan for none
    heading    [R]  rad, true; nan for none
    turn       [R]  rad/s, positive to starboard; nan for none
    status     [R]  of m1371.STATUSES; -1 for none
    name, call_sign  [R]  '' for none
    ship_type  [R]  -1 for none
    size       [R, 4]  m from the antenna to bow, stern, port and starboard; nan for none
    """

    heard: Array
    time: Array
    timed: BoolArray
    mmsi: IntArray
    type: CodeArray
    latitude: Array
    longitude: Array
    accurate: BoolArray
    speed: Array
    course: Array
    heading: Array
    turn: Array
    status: CodeArray
    name: Text
    call_sign: Text
    ship_type: IntArray
    size: Array


DTYPES: tuple[Any, ...] = (
    *(np.float64, np.float64, np.bool_, np.int64, np.int8, np.float64, np.float64, np.bool_),
    *(np.float64, np.float64, np.float64, np.float64, np.int8, 'U20', 'U7', np.int64, np.float64),
)
Row = tuple[Any, ...]  # the fields of one report


def table(rows: Sequence[Row]) -> Reports:
    """The reports of rows."""
    if not rows:
        empty: list[Any] = [np.zeros(0, kind) for kind in DTYPES]
        return Reports._make([*empty[:-1], np.zeros((0, 4))])
    return Reports(*(np.array(c, kind) for c, kind in zip(zip(*rows, strict=True), DTYPES)))


def positions(
    mmsi: IntArray,
    time: Array,
    latitude: Array,
    longitude: Array,
    speed: Array,
    course: Array,
    type_: int = 1,
    **more: Any,
) -> Reports:
    """Reports of places that a program has as numbers; units as in Reports.

    more  other columns, or one value for all
    """
    count = len(mmsi)
    nothing = np.full(count, np.nan)
    values: dict[str, Any] = {
        'heard': time,
        'timed': True,
        'type': type_,
        'accurate': False,
        'heading': nothing,
        'turn': nothing,
        'status': m1371.NO_STATUS,
        'name': '',
        'call_sign': '',
        'ship_type': -1,
        'size': np.full((count, 4), np.nan),
        **more,
    }
    values.update(
        time=time, mmsi=mmsi, latitude=latitude, longitude=longitude, speed=speed, course=course
    )
    return Reports(
        *(
            np.broadcast_to(
                np.asarray(values[name], kind), (count, 4) if name == 'size' else (count,)
            ).copy()
            for name, kind in zip(Reports._fields, DTYPES)
        )
    )


def row(
    message: Mapping[str, Any],
    heard: float,
    time: float,
    timed: bool,
    left_out: Callable[[str], None],
) -> Row:
    """The row of a decoded message, as pyais names its fields; knots and degrees.

    left_out  called with the name, of LEFT_OUT, of a value that cannot be
    ValueError, with a reason of NO_IDENTITY and NO_PLACE, for a report that cannot be used.
    """
    mmsi, kind = int(message.get('mmsi') or 0), int(message['msg_type'])
    if not 0 < mmsi <= m1371.MOST:
        raise ValueError(NO_IDENTITY)
    latitude, longitude = _place(message)

    def angle(name: str, none: float, what: str) -> float:
        value = _number(message.get(name))
        if not 0 <= value < 360:
            if not (math.isnan(value) or value == none):
                left_out(what)
            return math.nan
        return math.radians(value)

    return (
        heard,
        time,
        timed,
        mmsi,
        kind,
        latitude,
        longitude,
        bool(message.get('accuracy')),
        _speed(message, kind, left_out),
        angle('course', 511.0 if kind == LONG_RANGE else 360.0, 'courses'),
        angle('heading', 511.0, 'headings'),
        _turn(message),
        _status(message, kind, mmsi),
        _text(message.get('shipname') or message.get('name'), 20),
        _text(message.get('callsign'), 7),
        _ship_type(message),
        _size(message, left_out),
    )


def _number(value: Any) -> float:
    """A finite number; nan for anything else."""
    if value is None or isinstance(value, (str, bytes)):
        return math.nan
    found = float(value)
    return found if math.isfinite(found) else math.nan


def _place(message: Mapping[str, Any]) -> tuple[float, float]:
    latitude, longitude = _number(message.get('lat')), _number(message.get('lon'))
    if math.isnan(latitude) or math.isnan(longitude) or latitude == 91 or longitude == 181:
        return math.nan, math.nan
    if not (abs(latitude) <= 90 and abs(longitude) <= 180):
        raise ValueError(NO_PLACE)
    return latitude, longitude


def _speed(message: Mapping[str, Any], kind: int, left_out: Callable[[str], None]) -> float:
    """m/s. The greatest value of a field says `that much or more`, which no ship makes."""
    value = _number(message.get('speed'))
    none, most = {9: (1023.0, 1022.0), LONG_RANGE: (63.0, 62.5)}.get(kind, (102.3, 102.15))
    if math.isnan(value) or abs(value - none) < 0.01:
        return math.nan
    if not 0 <= value < most:
        left_out('speeds')
        return math.nan
    return value * KNOT


def _turn(message: Mapping[str, Any]) -> float:
    """rad/s; a turn of which only the direction is told is not known."""
    value = message.get('turn')
    if isinstance(value, Enum):  # pyais: not available, or more than 5 deg in 30 s
        return math.nan
    rate = _number(value)
    return math.radians(rate) / 60 if abs(rate) < UNKNOWN_TURN else math.nan


def _status(message: Mapping[str, Any], kind: int, mmsi: int) -> int:
    value = message.get('status')
    status = m1371.NO_STATUS if value is None or kind not in (1, 2, 3, LONG_RANGE) else int(value)
    if status == m1371.TEST and mmsi // 1_000_000 not in (970, 972, 974):
        return m1371.NO_STATUS  # of a ship the same code means "not defined"
    return status if 0 <= status < len(m1371.STATUSES) else m1371.NO_STATUS


def _ship_type(message: Mapping[str, Any]) -> int:
    """As the field has it; of an aid to navigation its type."""
    value = message.get('ship_type', message.get('aid_type'))
    return -1 if value is None or not 0 < int(value) < 256 else int(value)


def _text(value: Any, length: int) -> str:
    text = '' if value is None else str(value)
    return ''.join(c for c in text if ' ' <= c <= '~').strip('@ ')[:length].strip()


def _size(message: Mapping[str, Any], left_out: Callable[[str], None]) -> Row:
    """Bow, stern, port, starboard. Where the antenna is on board may be unknown: then the first and
    third are nan and the others are length and beam."""
    told = [_number(message.get(f'to_{side}')) for side in ('bow', 'stern', 'port', 'starboard')]
    if any(math.isnan(one) for one in told) or not any(told):
        return (math.nan,) * 4
    bow, stern, port, starboard = told
    if bow + stern > 500 or port + starboard > 120:
        left_out('sizes')
        return (math.nan,) * 4
    if not bow and not port:
        return math.nan, stern or math.nan, math.nan, starboard or math.nan
    return bow, stern, port, starboard
