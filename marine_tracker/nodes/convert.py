"""Messages from arrays and arrays from messages; every trap of the message packages is here.

The generated setters check nothing by default: an int in a float field, a numpy scalar or a
matrix goes out as garbage. So: plain `float`s, `array.array` for sequences, flat covariances.
Times cross this border as integer nanoseconds, for a float of seconds since 1970 is 0.2 us coarse.
"""

import math
from collections.abc import Sequence

import numpy as np
from builtin_interfaces.msg import Time
from nav_msgs.msg import Odometry
from numpy.typing import NDArray
from sensor_msgs.msg import NavSatFix, NavSatStatus, PointCloud2
from std_msgs.msg import Header

from ..geometry import heading_from, own_ship_at, unit_vector

# The reading half, which needs no ROS; told here as well, so that all of it has one name.
from ..recording.ros_messages import (  # noqa: F401
    BAD_LAYOUT,
    CLOUD_REASONS,
    COVARIANCE,
    FLOATS,
    GAP,
    MISSING_FIELD,
    MISTYPED_FIELD,
    NEEDED,
    NO_HEADING,
    RADIAL_SPEED,
    TRUNCATED,
    ConversionError,
    cloud_to_gaps,
    cloud_to_plots,
    heading_of_odometry,
    nanoseconds,
    odometry_to_own_ship,
    yaw_of,
)
from ..types import Array, IntArray, Scan
from . import cloud_layout
from .topics import FRAME, OWN_SHIP_FRAME

PLOT_FIELDS = ('x', 'y', 'z', 'range', 'bearing', 'amplitude', 'time_offset')

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


def time_message(time_ns: int) -> Time:
    """A stamp from integer nanoseconds, held to what the message can carry."""
    sec, nanosec = divmod(int(time_ns), 1_000_000_000)
    return Time(sec=min(max(sec, -(2**31)), 2**31 - 1), nanosec=nanosec)


def header(time_ns: int, frame: str = FRAME) -> Header:
    """A header with stamp and frame."""
    return Header(stamp=time_message(time_ns), frame_id=frame)


def cloud_message(rows: NDArray[np.void], time_ns: int) -> PointCloud2:
    """A PointCloud2 of a structured array [M] of little-endian fields."""
    return cloud_layout.message(rows, header(time_ns))


def plots_positions(scan: Scan) -> Array:
    """Where the plots [M, 2] lie in the ground-stabilised frame, m."""
    origin, _ = own_ship_at(scan.measured_from, scan.plots.time)
    return origin + scan.plots.range[:, None] * unit_vector(scan.plots.bearing)


def plots_to_cloud(scan: Scan, start_ns: int) -> PointCloud2:
    """One antenna revolution; the stamp is its start.

    A field radial_speed is there where the radar tells it, and xx, xy, yy where plots have a
    covariance of their own. Points with a gap after the plots tell what was not swept.
    """
    plots, position = scan.plots, plots_positions(scan)
    gaps = np.zeros((0, 2)) if scan.unswept is None else scan.unswept
    names: tuple[str, ...] = PLOT_FIELDS
    if plots.radial_speed is not None:
        names += (RADIAL_SPEED,)
    if plots.covariance is not None:
        names += COVARIANCE
    if len(gaps):
        names += (GAP,)
    every = np.zeros(len(plots.time) + len(gaps), [(name, '<f4') for name in names])
    rows = every[: len(plots.time)]
    if len(gaps):
        every['bearing'][len(rows) :], every[GAP][len(rows) :] = gaps.T
    rows['x'], rows['y'] = position.T
    rows['range'], rows['bearing'], rows['amplitude'] = plots.range, plots.bearing, plots.amplitude
    rows['time_offset'] = plots.time - scan.start
    if plots.radial_speed is not None:
        rows[RADIAL_SPEED] = plots.radial_speed
    if plots.covariance is not None:
        for name, (i, j) in zip(COVARIANCE, ((0, 0), (0, 1), (1, 1))):
            rows[name] = plots.covariance[:, i, j]
    return cloud_message(every, start_ns)


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
