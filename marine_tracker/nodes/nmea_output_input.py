"""What nmea_output hears: targets as numbers, own ship, and where on earth that is."""

import math
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from sensor_msgs.msg import NavSatFix, NavSatStatus, PointCloud2

from ..arpa.nmea import (
    ACQUIRING,
    AUTOMATIC,
    BY_HAND,
    FIXED_TARGET,
    LOST,
    MANUAL,
    TRACKING,
    WATER,
    OwnShipData,
    Targets,
    as_acquired,
)
from ..arpa.signalk import Alert
from ..arpa.stabilisation import CURRENT, HAND, LOG, POSITIONS
from ..arpa.targets import MANUAL as MANUALLY
from ..arpa.targets import label
from ..files import shown
from ..geodesy import LocalFrame
from ..geometry import AT_REST, KNOT, on_deck, to_range_bearing
from ..tracking import lifecycle, own_ship
from ..types import Array, IntArray
from . import targets_cloud
from .convert import heading_of_odometry, nanoseconds, odometry_to_own_ship
from .diagnostics import one_line
from .faults import NO_STAMP, ConversionError, check_frame
from .topics import FRAME

BAD_FIX = 'fixes without a position'
FIX_BY_ARRIVAL = 'fixes with stamps far from those of own ship: paired as they arrived'
TIME_BY_ARRIVAL = 'own ship told for stamps far from hers: as she was last'
LOST_AFTER = 6  # timeouts without a fix: nobody knows where she is
FIGURES = ('range', 'bearing', 'speed', 'course', 'cpa', 'tcpa')


class Heard(NamedTuple):
    """Of a message on `targets_cloud`.

    targets    with their own numbers: TT07 has 7; Q123, which is being acquired, -123
    relative   whether bearings count from the bow, without a heading
    reference  number of the stationary target that tells the motion of the ground, 0 for none
    mmsi       [T]  of the ships of AIS that they are, 0 for none
    """

    targets: Targets
    relative: bool
    reference: int
    mmsi: IntArray


def read_targets(message: PointCloud2) -> Heard:
    """The targets as numbers; nan for what is not known. ConversionError if it cannot be read."""
    rows = targets_cloud.read(message)
    number, id_ = (rows[name].astype(np.int64) for name in ('number', 'id'))
    figures = {name: np.where(np.isfinite(rows[name]), rows[name], np.nan) for name in FIGURES}
    bow = rows['relative_bearing']
    from_bow = np.isnan(figures['bearing']) & np.isfinite(bow)
    figures['bearing'] = np.where(from_bow, bow, figures['bearing'])
    status = np.full(len(rows), TRACKING)
    status[rows['status'] == lifecycle.TENTATIVE] = ACQUIRING
    status[rows['status'] == lifecycle.LOST] = LOST
    by_hand = rows['acquired'] == MANUALLY
    targets = Targets(
        np.where(number > 0, number, -id_),
        status,
        np.where(by_hand, MANUAL, AUTOMATIC),
        np.array(label(id_, number), str),
        *figures.values(),
    )
    fixed = number[rows['reference'] > 0]
    told = as_acquired(targets), bool(from_bow.any()), int(fixed[-1]) if len(fixed) else 0
    return Heard(*told, rows['mmsi'].astype(np.int64))


def read_alerts(message: DiagnosticArray) -> list[Alert]:
    """The alerts of a message on `alarms`."""
    found = []
    for entry in message.status:
        values = {pair.key: pair.value for pair in entry.values}
        found.append(
            Alert(
                one_line(entry.name),
                one_line(entry.message),
                values.get('priority', ''),
                values.get('state', ''),
            )
        )
    return found


def own_ship_told(message: DiagnosticArray, own: OwnShipData) -> OwnShipData:
    """Own ship with what the tracker says on `own_ship/state` of her motion: what course and speed
    are measured against, and by what. By positions, course and speed are those of `own`."""
    values = {pair.key: pair.value for entry in message.status[:1] for pair in entry.values}
    number = {
        key: _figure(values.get(key, ''), unit)
        for key, unit in (
            ('course_deg', math.radians(1)),
            ('speed_kn', KNOT),
            ('water_speed_kn', KNOT),
            ('set_deg', math.radians(1)),
            ('drift_kn', KNOT),
        )
    }
    own = own._replace(water=number['water_speed_kn'])
    by = values.get('stabilised by', POSITIONS)
    if by == POSITIONS:
        return own
    own = own._replace(course=number['course_deg'], speed=number['speed_kn'])
    if by == CURRENT:
        return own._replace(reference=WATER, set=number['set_deg'], drift=number['drift_kn'])
    codes = {LOG: WATER, HAND: BY_HAND}
    return own._replace(reference=codes.get(by, FIXED_TARGET))


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


def named(reason: str) -> str:
    """The reason to count an own-ship sample, beside those of other messages."""
    return reason.replace('samples', 'own-ship messages')


class Anchor(NamedTuple):
    """A place known both in `map`, position [2] m, and on Earth: the frame about it."""

    position: Array
    frame: LocalFrame


class OwnShipInput:
    """Own ship as last heard.

    origin   the frame `map`; None: fixes tell where own ship is
    trust    what tells her velocity (own_velocity.chosen)
    timeout  s without a fix, after which the position is an estimate; six of them: is not known
    gps      m ahead and to starboard of the reference point, the place that odometry tells
    count    count(reason, detail) of what is wrong with a message
    """

    def __init__(
        self,
        origin: LocalFrame | None,
        trust: str,
        timeout: float,
        gps: tuple[float, float],
        count: Callable[[str, str], None],
    ) -> None:
        self._from_fixes = origin is None
        self.anchor = None if origin is None else Anchor(np.zeros(2), origin)
        self._trust, self._timeout, self._gps, self._count = trust, timeout, gps, count
        self.log = own_ship.empty_log()
        self._base_ns: int | None = None  # the log's times are seconds after this
        self.time_ns: int | None = None  # of the last odometry
        self._heading = self._last_heading = math.nan
        self._fixed = -math.inf  # s of the wall, the last good fix

    def hear_odometry(self, message: Odometry, arrival: float, now_ns: int) -> bool:
        """Whether it could be taken.

        arrival  s, when it came, by a clock of ours; now_ns: by that of stamps
        """
        try:
            check_frame(message.header.frame_id, (FRAME,))
            time_ns = self._time(message, now_ns)
        except ConversionError as error:
            self._count(error.reason, str(error))
            return False
        self.time_ns = time_ns
        if self._base_ns is None:
            self._base_ns = time_ns
        position, velocity = odometry_to_own_ship(message)
        self.log, reason = own_ship.admit_own_ship(
            self.log, (time_ns - self._base_ns) * 1e-9, position, velocity, arrival
        )
        if reason == own_ship.OWN_REPEATED and np.all(self.log.taken.position[-1] == position):
            return True  # the same message once more
        if reason:
            self._count(named(reason), f'at {position}')
        if reason not in ('', own_ship.OWN_REBASED):
            return False
        self._heading = heading_of_odometry(message, doubtful=self.log.off > 0)
        if math.isfinite(self._heading):
            self._last_heading = self._heading
        return True

    def hear_fix(self, message: NavSatFix, now_ns: int) -> None:
        """Before the first odometry a fix cannot be placed, yet is good."""
        try:
            time_ns = self._time(message, now_ns)
        except ConversionError as error:
            self._count(error.reason, str(error))
            return
        if message.status.status < NavSatStatus.STATUS_FIX or not (
            abs(message.latitude) <= 90 and abs(message.longitude) <= 180
        ):
            self._count(BAD_FIX, '')
            return
        self._fixed = time.monotonic()
        if self._from_fixes and self.log.number:
            at, _, told = self._now(time_ns)
            if not told:
                self._count(FIX_BY_ARRIVAL, '')
            self.anchor = Anchor(at, LocalFrame(message.latitude, message.longitude))

    @property
    def fix_age(self) -> float:
        """s since the last good fix; 0 where the origin is a parameter and none is needed."""
        return time.monotonic() - self._fixed if self._from_fixes else 0.0

    def position(self, time_ns: int) -> Array:
        """Position [2] m of own ship's reference point at a time; the last one where that is far
        from her stamps. Before the first heading it is that of the GPS antenna."""
        antenna = self._now(time_ns)[0]
        if math.isnan(self._last_heading):
            return antenna
        return antenna - on_deck(*self._gps, self._last_heading)

    @property
    def placed(self) -> bool:
        """Whether it is known, or can be estimated, where on earth she is."""
        return self.anchor is not None and self.fix_age <= LOST_AFTER * self._timeout

    def at(self, time_ns: int) -> OwnShipData:
        """Own ship as the sentences tell her."""
        _, velocity, told = self._now(time_ns)
        if not told:
            self._count(TIME_BY_ARRIVAL, '')
        speed, course = to_range_bearing(velocity)
        latitude, longitude = self._place(time_ns)
        return OwnShipData(
            float(latitude),
            float(longitude),
            float(speed),
            float(course) if speed >= AT_REST else math.nan,
            self._heading,
            estimated=self.fix_age > self._timeout,
        )

    def _now(self, time_ns: int) -> tuple[Array, Array, bool]:
        return own_ship.now(self.log, (time_ns - (self._base_ns or 0)) * 1e-9, self._trust)

    def _time(self, message: Odometry | NavSatFix, now_ns: int) -> int:
        """ns of its stamp; of a message without one, of its arrival."""
        time_ns = nanoseconds(message.header.stamp)
        if not time_ns:
            self._count(NO_STAMP, '')
        return time_ns or now_ns

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
        if self.anchor is None or not self.placed:
            return np.array(np.nan), np.array(np.nan)
        return self.anchor.frame.to_geodetic(self.position(time_ns) - self.anchor.position)
