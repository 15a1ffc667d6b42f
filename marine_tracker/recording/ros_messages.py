"""ROS messages as arrays, without ROS: any object that has the fields of the message will do.

So recordings are read on machines without ROS by the same code as the nodes. Times are integer
nanoseconds, for a float of seconds since 1970 is 0.2 us coarse.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..geometry import AT_REST, bearing_from_yaw
from ..types import Array, PolarPlots

FRAME = 'map'  # ground-stabilised, east and north
NEEDED = ('range', 'bearing', 'amplitude', 'time_offset')
RADIAL_SPEED = 'radial_speed'  # of a radar with Doppler
FLOAT32, FLOAT64 = 7, 8  # PointField.datatype
FLOATS = {FLOAT32: 'f4', FLOAT64: 'f8'}
NO_HEADING = math.pi**2 / 3  # rad^2, variance of a yaw of which there is no idea at all


class ConversionError(ValueError):
    """A message that cannot be read; `reason` is the name of its counter."""

    def __init__(self, reason: str, text: str) -> None:
        super().__init__(f'{reason}: {text}')
        self.reason = reason


MISSING_FIELD = 'clouds with a missing field'
MISTYPED_FIELD = 'clouds with a mistyped field'
BAD_LAYOUT = 'clouds with a wrong layout'
TRUNCATED = 'clouds with a truncated buffer'
WRONG_FRAME = 'messages in a wrong frame'
BAD_STAMP = 'messages with a wrong stamp'
CLOUD_REASONS = (MISSING_FIELD, MISTYPED_FIELD, BAD_LAYOUT, TRUNCATED)
HEADER_REASONS = (WRONG_FRAME, BAD_STAMP)


def check_frame(frame: str, allowed: Sequence[str]) -> None:
    """ConversionError unless the frame is one of those allowed; an empty one counts as `map`."""
    if frame and bare(frame) not in allowed:
        may = ' or '.join(dict.fromkeys(allowed))
        raise ConversionError(
            WRONG_FRAME, f'frame_id is {frame[:80]!r}; it must be {may}, or empty'
        )


def bare(frame: str) -> str:
    """The frame without the slash that ROS 1 put before it."""
    return frame.removeprefix('/')


def nanoseconds(stamp: Any) -> int:
    """A stamp as integer nanoseconds. ConversionError where it is none."""
    if stamp.nanosec >= 1_000_000_000:
        raise ConversionError(BAD_STAMP, f'nanosec is {stamp.nanosec}; it must be below 1000000000')
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def cloud_to_plots(message: Any) -> PolarPlots:
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


def odometry_to_own_ship(message: Any) -> tuple[Array, Array]:
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


def heading_of_odometry(message: Any, doubtful: bool = False) -> float:
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


def yaw_of(q: Any) -> float:
    """Yaw, rad counter-clockwise from east; nan for an orientation that is none."""
    norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z)
    return yaw if norm > 0 else math.nan
