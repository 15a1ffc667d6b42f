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
from ..files import shown
from ..geodesy import LocalFrame
from ..geometry import KNOT, NAUTICAL_MILE, bearing_from_yaw, to_range_bearing
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


def read_origin(text: str) -> LocalFrame | None:
    """The frame `map` by the parameter origin, latitude and longitude; None where it is empty."""
    if not text.strip():
        return None
    try:
        latitude, longitude = map(float, text.replace(',', ' ').split())
        return LocalFrame(latitude, longitude)
    except ValueError as error:
        raise ValueError(
            f'parameter origin is {shown(text)}; it must be latitude and longitude in degrees, '
            'from -90 to 90 and from -180 to 180, as "54.1 10.9"'
        ) from error


class Anchor(NamedTuple):
    """A place known both in `map`, position [2] m, and on Earth: the frame about it."""

    position: Array
    frame: LocalFrame


class OwnShipInput:
    """Own ship as last heard.

    origin  the frame `map`; None: fixes tell where own ship is
    """

    def __init__(self, origin: LocalFrame | None) -> None:
        self._from_fixes = origin is None
        self.anchor = None if origin is None else Anchor(np.zeros(2), origin)
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
            self.anchor = Anchor(at, LocalFrame(message.latitude, message.longitude))
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
        latitude, longitude = self._place(time_ns)
        return OwnShipData(
            float(latitude), float(longitude), float(speed), float(course), self._heading
        )

    def target_places(self, time_ns: int, offset: Array) -> tuple[Array, Array]:
        """Latitude and longitude [...] deg at offsets [..., 2] m from own ship; nan if not known.

        The offset is laid off from own ship over the Earth, with y true north there, and not in
        `map`, where north is true on the meridian of the origin only. So a receiver that lays
        off range and bearing (TTM) from own ship (RMC) finds the target where TLL puts it, however
        far own ship is from the origin. At the origin both ways are the same; a target 10 NM off
        own ship, who is 22 NM east of the origin at 54 N, would stand 160 m aside in `map`.
        """
        own = self._place(time_ns)
        if not np.isfinite(own).all():
            nowhere = np.full(np.shape(offset)[:-1], np.nan)
            return nowhere, nowhere
        return LocalFrame(*own).to_geodetic(offset)

    def _place(self, time_ns: int) -> tuple[Array, Array]:
        """Own ship's latitude and longitude, deg; nan if not known."""
        if self.anchor is None:
            return np.array(np.nan), np.array(np.nan)
        return self.anchor.frame.to_geodetic(self.position(time_ns) - self.anchor.position)
