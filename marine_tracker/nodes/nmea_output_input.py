"""What nmea_output hears: targets as readable text, own ship, and where on earth that is."""

import math
import re
from typing import NamedTuple

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from sensor_msgs.msg import NavSatFix, NavSatStatus

from ..arpa.nmea import (
    ACQUIRING,
    AUTOMATIC,
    LOST,
    MANUAL,
    TRACKING,
    OwnShipData,
    Targets,
    as_acquired,
)
from ..geometry import KNOT, NAUTICAL_MILE, bearing_from_yaw, geodetic_from_local, to_range_bearing
from ..types import Array
from .convert import nanoseconds, odometry_to_own_ship, yaw_of

NAMED = re.compile(r'(TT|Q)([0-9]{1,9})')
LONGEST_NAME = 80  # characters; no sentence holds more
STATUS = {'LOST': LOST, 'ACQUIRING': ACQUIRING}  # all others are tracked
FIGURES = {
    'range_nm': NAUTICAL_MILE,
    'bearing_deg': math.radians(1),
    'speed_kn': KNOT,
    'course_deg': math.radians(1),
    'cpa_nm': NAUTICAL_MILE,
    'tcpa_min': 60.0,
}


def read_targets(message: DiagnosticArray) -> Targets:
    """The targets of a message on `targets`, with their own numbers; nan for what it lacks.

    TT07 has the number 7; Q123, which is being acquired and has none yet, -123. Entries that are
    no target are passed over. Names are cut to LONGEST_NAME: all rows of an array of texts take
    the room of the longest.
    """
    rows = []
    for entry in message.status:
        named = NAMED.fullmatch(entry.name)
        if named is None:
            continue
        values = {pair.key: pair.value for pair in entry.values}
        rows.append(
            (
                int(named[2]) * (1 if named[1] == 'TT' else -1),
                STATUS.get(entry.message, TRACKING),
                MANUAL if values.get('acquired') == MANUAL else AUTOMATIC,
                values.get('name', '')[:LONGEST_NAME] or entry.name,
                *(_figure(values.get(key, ''), unit) for key, unit in FIGURES.items()),
            )
        )
    number, status, acquired, name, *figures = zip(*rows) if rows else ((),) * 10
    return as_acquired(
        Targets(
            np.array(number, np.int64),
            np.array(status, 'U1'),
            np.array(acquired, 'U1'),
            np.array(name, str),
            *(np.array(column, float) for column in figures),
        )
    )


def _figure(text: str, unit: float) -> float:
    """The number in SI units; nan where the text is no finite one."""
    try:
        value = float(text) * unit
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan


def read_origin(text: str) -> tuple[float, float] | None:
    """The parameter origin: latitude and longitude in degrees; None where it is empty."""
    if not text.strip():
        return None
    try:
        latitude, longitude = map(float, text.replace(',', ' ').split())
    except ValueError:
        latitude = longitude = math.nan
    if not (abs(latitude) <= 90 and abs(longitude) <= 180):
        raise ValueError(
            f'parameter origin is {text!r}; it must be latitude and longitude in '
            'degrees, as "54.1 10.9"'
        )
    return latitude, longitude


class Anchor(NamedTuple):
    """A place known both in `map`, position [2] m, and on earth, degrees."""

    position: Array
    latitude: float
    longitude: float


class OwnShipInput:
    """Own ship as last heard.

    origin  latitude and longitude of the origin of `map`; None: fixes tell where own ship is
    """

    def __init__(self, origin: tuple[float, float] | None):
        self._from_fixes = origin is None
        self.anchor = None if origin is None else Anchor(np.zeros(2), *origin)
        self.time_ns: int | None = None  # of the last odometry
        self._position = self._velocity = np.full(2, np.nan)
        self._heading = math.nan

    def hear_odometry(self, message: Odometry) -> bool:
        """Whether it could be taken."""
        position, velocity = odometry_to_own_ship(message)
        if not (np.isfinite(position).all() and np.isfinite(velocity).all()):
            return False
        self.time_ns = nanoseconds(message.header.stamp)
        self._position, self._velocity = position, velocity
        self._heading = float(bearing_from_yaw(yaw_of(message.pose.pose.orientation)))
        return True

    def hear_fix(self, message: NavSatFix) -> bool:
        """Whether it could be taken; before the first odometry it cannot be placed, yet is good."""
        if message.status.status < NavSatStatus.STATUS_FIX or not (
            abs(message.latitude) <= 90 and abs(message.longitude) <= 180
        ):
            return False
        if self._from_fixes and self.time_ns is not None:
            at = self.position(nanoseconds(message.header.stamp))
            self.anchor = Anchor(at, message.latitude, message.longitude)
        return True

    def position(self, time_ns: int) -> Array:
        """Own ship's position [2] m at a time, from the last odometry on."""
        if self.time_ns is None:
            return np.full(2, np.nan)
        return self._position + (time_ns - self.time_ns) * 1e-9 * self._velocity

    def at(self, time_ns: int) -> OwnShipData:
        """Own ship as the sentences tell her."""
        if self.time_ns is None:
            return OwnShipData()
        speed, course = to_range_bearing(self._velocity)
        latitude, longitude = self.place(self.position(time_ns))
        return OwnShipData(
            float(latitude), float(longitude), float(speed), float(course), self._heading
        )

    def place(self, position) -> tuple[Array, Array]:
        """Degrees of latitude and longitude [...] of positions [..., 2] m; nan if not known."""
        if self.anchor is None:
            nowhere = np.full(np.shape(position)[:-1], np.nan)
            return nowhere, nowhere
        return geodetic_from_local(
            position - self.anchor.position, self.anchor.latitude, self.anchor.longitude
        )
