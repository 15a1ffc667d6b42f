"""ROS messages as arrays, without ROS: any object that has the fields of the message will do.

So recordings are read on machines without ROS by the same code as the nodes. Times are integer
nanoseconds, for a float of seconds since 1970 is 0.2 us coarse.
"""

import math
from typing import Any

import numpy as np

from ..geometry import AT_REST, bearing_from_yaw
from ..types import Array, PolarPlots
from . import cloud_rows
from .cloud_rows import FLOATS, Wanted
from .message_faults import (
    BAD_LAYOUT,
    BAD_STAMP,
    MISSING_FIELD,
    MISTYPED_FIELD,
    TRUNCATED,
    ConversionError,
    bare,
)

FRAME = 'map'  # ground-stabilised, east and north
NEEDED = ('range', 'bearing', 'amplitude', 'time_offset')
RADIAL_SPEED = 'radial_speed'  # of a radar with Doppler
COVARIANCE = ('xx', 'xy', 'yy')  # m^2, where each plot tells its own
GAP = 'gap'  # rad, of a point that is no plot: nothing was swept from its bearing on so far
CLOUD_REASONS = (MISSING_FIELD, MISTYPED_FIELD, BAD_LAYOUT, TRUNCATED)
NO_HEADING = math.pi**2 / 3  # rad^2, variance of a yaw of which there is no idea at all


def nanoseconds(stamp: Any) -> int:
    """A stamp as integer nanoseconds. ConversionError where it is none."""
    if stamp.nanosec >= 1_000_000_000:
        raise ConversionError(BAD_STAMP, f'nanosec is {stamp.nanosec}; it must be below 1000000000')
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def cloud_to_plots(message: Any) -> PolarPlots:
    """The plots of a cloud, their time counted from the stamp; values are not judged here.

    Takes any order of fields, float32 or float64, either byte order, organised clouds, padding
    and fields beyond those needed (range, bearing, amplitude, time_offset); of those, radial_speed
    and the covariance xx, xy, yy are read; points with a gap are no plots (cloud_to_gaps).
    ConversionError else.
    """
    count = message.width * message.height
    if count == 0:
        if len(message.data):
            raise ConversionError(BAD_LAYOUT, f'no points, but {len(message.data)} bytes')
        none = np.empty(0)
        return PolarPlots(none, none, none, none)
    optional = (RADIAL_SPEED, *COVARIANCE, GAP)
    rows = cloud_rows.rows(
        message,
        [Wanted(name, FLOATS) for name in NEEDED]
        + [Wanted(name, FLOATS, needed=False) for name in optional],
    )
    there = rows.dtype.names or ()
    if GAP in there:
        rows = rows[~(rows[GAP] > 0)]
    with np.errstate(invalid='ignore'):  # signalling NaNs from a torn buffer
        range_, bearing, amplitude, offset = (rows[name].astype(float) for name in NEEDED)
        speed = rows[RADIAL_SPEED].astype(float) if RADIAL_SPEED in there else None
        covariance = None
        if set(COVARIANCE) <= set(there):
            xx, xy, yy = (rows[name].astype(float) for name in COVARIANCE)
            covariance = np.stack([xx, xy, xy, yy], -1).reshape(-1, 2, 2)
    return PolarPlots(offset, range_, bearing, amplitude, speed, covariance)


def cloud_to_gaps(message: Any) -> Array | None:
    """What was not swept, as in Scan.unswept, of a cloud that cloud_to_plots has read; None where
    it tells none."""
    if not message.width * message.height or GAP not in {field.name for field in message.fields}:
        return None
    rows = cloud_rows.rows(message, [Wanted(name, FLOATS) for name in ('bearing', GAP)])
    gaps = np.stack([rows['bearing'], rows[GAP]], 1).astype(float)
    gaps = gaps[np.isfinite(gaps).all(1) & (gaps[:, 1] > 0)]
    return gaps if len(gaps) else None


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
