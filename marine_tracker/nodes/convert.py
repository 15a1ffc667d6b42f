"""Messages from arrays and arrays from messages; every trap of the message packages is here.

The generated setters check nothing by default: an int in a float field, a numpy scalar or a
matrix goes out as garbage. So: plain `float`s, `array.array` for sequences, flat covariances.
Times cross this border as integer nanoseconds, for a float of seconds since 1970 is 0.2 us coarse.
"""

import array
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion
from nav_msgs.msg import Odometry
from numpy.typing import NDArray
from sensor_msgs.msg import NavSatFix, NavSatStatus, PointCloud2, PointField
from std_msgs.msg import Header

from ..geometry import AT_REST, bearing_from_yaw, heading_from, own_ship_at, unit_vector
from ..types import Array, IntArray, PolarPlots, Scan
from .faults import (
    BAD_LAYOUT,
    BAD_STAMP,
    MISSING_FIELD,
    MISTYPED_FIELD,
    TRUNCATED,
    ConversionError,
    bare,
)
from .topics import FRAME, OWN_SHIP_FRAME

PLOT_FIELDS = ('x', 'y', 'z', 'range', 'bearing', 'amplitude', 'time_offset')
NEEDED = ('range', 'bearing', 'amplitude', 'time_offset')
RADIAL_SPEED = 'radial_speed'  # of a radar with Doppler
FLOATS = {PointField.FLOAT32: 'f4', PointField.FLOAT64: 'f8'}
KINDS = {**FLOATS, PointField.UINT8: 'u1', PointField.UINT32: 'u4'}

TRACK_TYPE = np.dtype(
    [('id', '<u4'), ('number', '<u4'), ('status', '<u4'), ('time_offset', '<f4')]
    + [
        (name, '<f4')
        for name in (
            'x',
            'y',
            'z',
            'vx',
            'vy',
            'xx',
            'xy',
            'yy',
            'vxvx',
            'vxvy',
            'vyvy',
            'xvx',
            'xvy',
            'yvx',
            'yvy',
            'course',
            'speed',
        )
    ]
)


CLOUD_REASONS = (MISSING_FIELD, MISTYPED_FIELD, BAD_LAYOUT, TRUNCATED)
NO_HEADING = math.pi**2 / 3  # rad^2, variance of a yaw of which there is no idea at all


def nanoseconds(stamp: Time) -> int:
    """A stamp as integer nanoseconds. ConversionError where it is none."""
    if stamp.nanosec >= 1_000_000_000:
        raise ConversionError(BAD_STAMP, f'nanosec is {stamp.nanosec}; it must be below 1000000000')
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def time_message(time_ns: int) -> Time:
    """A stamp from integer nanoseconds, held to what the message can carry."""
    sec, nanosec = divmod(int(time_ns), 1_000_000_000)
    return Time(sec=min(max(sec, -(2**31)), 2**31 - 1), nanosec=nanosec)


def header(time_ns: int, frame: str = FRAME) -> Header:
    """A header with stamp and frame."""
    return Header(stamp=time_message(time_ns), frame_id=frame)


def cloud_message(rows: NDArray[np.void], time_ns: int) -> PointCloud2:
    """A PointCloud2 of a structured array [M] of little-endian fields."""
    kinds = {kind: datatype for datatype, kind in KINDS.items()}
    layout: Any = rows.dtype
    fields = []
    for name in layout.names:
        kind, offset = layout.fields[name]
        fields.append(PointField(name=name, offset=offset, datatype=kinds[kind.str[1:]], count=1))
    return PointCloud2(
        header=header(time_ns),
        height=1,
        width=len(rows),
        fields=fields,
        is_bigendian=False,
        point_step=rows.dtype.itemsize,
        row_step=rows.nbytes,
        is_dense=True,
        data=array.array('B', rows.tobytes()),
    )


def plots_positions(scan: Scan) -> Array:
    """Where the plots [M, 2] lie in the ground-stabilised frame, m."""
    origin, _ = own_ship_at(scan.measured_from, scan.plots.time)
    return origin + scan.plots.range[:, None] * unit_vector(scan.plots.bearing)


def plots_to_cloud(scan: Scan, start_ns: int) -> PointCloud2:
    """One antenna revolution; the stamp is its start.

    A field radial_speed is there where the radar tells it.
    """
    plots, position = scan.plots, plots_positions(scan)
    names = PLOT_FIELDS if plots.radial_speed is None else (*PLOT_FIELDS, RADIAL_SPEED)
    rows = np.zeros(len(plots.time), [(name, '<f4') for name in names])
    rows['x'], rows['y'] = position.T
    rows['range'], rows['bearing'], rows['amplitude'] = plots.range, plots.bearing, plots.amplitude
    rows['time_offset'] = plots.time - scan.start
    if plots.radial_speed is not None:
        rows[RADIAL_SPEED] = plots.radial_speed
    return cloud_message(rows, start_ns)


def cloud_to_plots(message: PointCloud2) -> PolarPlots:
    """The plots of a cloud, their time counted from the stamp; values are not judged here.

    Takes any order of fields, float32 or float64, either byte order, organised clouds, padding
    and fields beyond those needed (range, bearing, amplitude, time_offset); of those, radial_speed
    is read. ConversionError else.
    """
    count = message.width * message.height
    if count == 0:
        if len(message.data):
            raise ConversionError(BAD_LAYOUT, f'no points, but {len(message.data)} bytes')
        none = np.empty(0)
        return PolarPlots(none, none, none, none)
    fields = {field.name: field for field in message.fields}
    if len(fields) < len(message.fields):
        raise ConversionError(BAD_LAYOUT, 'a field name stands twice')
    order = '>' if message.is_bigendian else '<'
    kinds, offsets = [], []
    names = (*NEEDED, RADIAL_SPEED) if RADIAL_SPEED in fields else NEEDED
    for name in names:
        if name not in fields:
            raise ConversionError(MISSING_FIELD, name)
        field = fields[name]
        if field.datatype not in FLOATS or field.count > 1:
            raise ConversionError(
                MISTYPED_FIELD,
                f'{name} has datatype {field.datatype}, count '
                f'{field.count}; it must be one FLOAT32 or FLOAT64',
            )
        kind = np.dtype(order + FLOATS[field.datatype])
        if field.offset + kind.itemsize > message.point_step:
            raise ConversionError(
                BAD_LAYOUT,
                f'{name} ends at byte {field.offset + kind.itemsize}'
                f' of a point of {message.point_step}',
            )
        kinds.append(kind)
        offsets.append(field.offset)
    used = message.width * message.point_step
    if message.row_step < used:
        raise ConversionError(
            BAD_LAYOUT,
            f'row_step is {message.row_step}; {message.width} points '
            f'of {message.point_step} bytes need {used}',
        )
    whole = message.row_step * message.height
    if len(message.data) < whole:
        raise ConversionError(TRUNCATED, f'{len(message.data)} bytes of {whole}')
    if len(message.data) > whole:
        raise ConversionError(BAD_LAYOUT, f'{len(message.data)} bytes; {whole} announced')
    raw = np.frombuffer(message.data, np.uint8).reshape(message.height, message.row_step)[:, :used]
    point = np.dtype(
        {'names': list(names), 'formats': kinds, 'offsets': offsets, 'itemsize': message.point_step}
    )
    rows = np.ascontiguousarray(raw).reshape(-1).view(point)
    with np.errstate(invalid='ignore'):  # signalling NaNs from a torn buffer
        range_, bearing, amplitude, offset, *speed = (rows[name].astype(float) for name in names)
    return PolarPlots(offset, range_, bearing, amplitude, *speed)


def own_ship_to_odometry(
    time_ns: int, position: Array, velocity: Array, heading: float | None = None
) -> Odometry:
    """Own ship's position and velocity [2], m and m/s east and north, and heading, rad.

    heading  None: her course, if she makes way; nan: not known, which the variance of the yaw tells
    """
    heading = (
        float(heading_from(np.asarray(velocity), np.array(np.nan))) if heading is None else heading
    )
    known = math.isfinite(heading)
    yaw = math.pi / 2 - heading if known else 0.0
    cos, sin = math.cos(yaw), math.sin(yaw)
    east, north = map(float, velocity)
    message = Odometry(header=header(time_ns), child_frame_id=OWN_SHIP_FRAME)
    pose, twist = message.pose.pose, message.twist.twist.linear
    pose.position.x, pose.position.y = map(float, position)
    pose.orientation.z, pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    twist.x, twist.y = cos * east + sin * north, cos * north - sin * east
    message.pose.covariance[35] = 0.0 if known else NO_HEADING
    return message


def odometry_to_own_ship(message: Odometry) -> tuple[Array, Array]:
    """Position [2] m and velocity [2] m/s over ground, east and north; not judged here.

    The twist is in the ship's own frame, turned into the ground's by the orientation; where
    child_frame_id says so it is in the ground's. nan where the orientation does not tell.
    """
    pose, twist = message.pose.pose, message.twist.twist.linear
    position = np.array([pose.position.x, pose.position.y])
    velocity = np.array([twist.x, twist.y])
    child = message.child_frame_id
    if child and bare(child) == bare(message.header.frame_id or FRAME):
        return position, velocity
    yaw = yaw_of(pose.orientation)
    if not message.pose.covariance[35] < NO_HEADING and np.hypot(*velocity) >= AT_REST:
        yaw = math.nan
    cos, sin = math.cos(yaw), math.sin(yaw)
    return position, np.array([[cos, -sin], [sin, cos]]) @ velocity


def heading_of_odometry(message: Odometry, doubtful: bool = False) -> float:
    """rad, true; nan where it is not known: the orientation is none, its variance that of no idea,
    or it is the unit quaternion as those leave it who know nothing but a position: without
    variance beside a position that has some, or `doubtful`, for the twist is not the way made, and
    without a twist."""
    q, covariance = message.pose.pose.orientation, message.pose.covariance
    unset, twist = (q.x, q.y, q.z, q.w) == (0.0, 0.0, 0.0, 1.0), message.twist.twist.linear
    bare_position = (covariance[0] > 0 and not covariance[35]) or (
        doubtful and twist.x == 0 and twist.y == 0
    )
    if not covariance[35] < NO_HEADING or (unset and bare_position):
        return math.nan
    return float(bearing_from_yaw(yaw_of(q)))


def yaw_of(q: Quaternion) -> float:
    """Yaw, rad counter-clockwise from east; nan for an orientation that is none."""
    norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z)
    return yaw if norm > 0 else math.nan


def fix_message(time_ns: int, latitude_deg: float, longitude_deg: float) -> NavSatFix:
    """Own ship's geodetic position."""
    fix = NavSatFix(
        header=header(time_ns, OWN_SHIP_FRAME),
        latitude=float(latitude_deg),
        longitude=float(longitude_deg),
    )
    fix.status.status = NavSatStatus.STATUS_FIX
    fix.status.service = NavSatStatus.SERVICE_GPS
    return fix


class OdometryPool:
    """Odometry messages that are used again: new ones cost thirty times as much.

    What `fill` returns is valid until the next `fill`.
    """

    def __init__(self) -> None:
        self._messages: list[Odometry] = []

    def fill(
        self,
        times_ns: Sequence[int] | IntArray,
        child_frames: Sequence[str],
        position: Array,
        velocity: Array,
        covariance: Array,
    ) -> list[Odometry]:
        """N messages.

        times_ns [N] int; child_frames N strings; position, velocity [N, 2] m, m/s;
        covariance [N, 4, 4] of [position, velocity].

        Yaw is the course over ground, twist.linear.x the speed over ground. The pose covariance
        has the position's terms and the course's variance; the twist covariance is that of the
        velocity along and across the course. Height, roll and pitch are 0 by definition.
        """
        count = len(times_ns)
        while len(self._messages) < count:
            self._messages.append(Odometry(header=Header(frame_id=FRAME)))
        messages = self._messages[:count]
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        yaw = np.nan_to_num(np.arctan2(velocity[:, 1], velocity[:, 0]))
        turn = np.empty((count, 2, 2))
        turn[:, 0, 0] = turn[:, 1, 1] = np.cos(yaw)
        turn[:, 0, 1] = np.sin(yaw)
        turn[:, 1, 0] = -turn[:, 0, 1]
        twist = turn @ covariance[:, 2:, 2:] @ turn.transpose(0, 2, 1)
        course_variance = twist[:, 1, 1] / np.maximum(speed, 1e-3) ** 2
        pose_rows, twist_rows = np.zeros((count, 36)), np.zeros((count, 36))
        pose_rows[:, [0, 1, 6, 7]] = covariance[:, :2, :2].reshape(count, 4)
        pose_rows[:, 35] = np.minimum(course_variance, NO_HEADING)
        twist_rows[:, [0, 1, 6, 7]] = twist.reshape(count, 4)
        columns = np.column_stack([position, np.sin(yaw / 2), np.cos(yaw / 2), speed]).tolist()
        for message, time_ns, child, (x, y, z, w, v), of_pose, of_twist in zip(
            messages, np.asarray(times_ns).tolist(), child_frames, columns, pose_rows, twist_rows
        ):
            stamp = message.header.stamp
            stamp.sec, stamp.nanosec = divmod(time_ns, 1_000_000_000)
            message.child_frame_id = child
            pose = message.pose.pose
            pose.position.x, pose.position.y = x, y
            pose.orientation.z, pose.orientation.w = z, w
            message.twist.twist.linear.x = v
            message.pose.covariance[:] = of_pose
            message.twist.covariance[:] = of_twist
        return messages
