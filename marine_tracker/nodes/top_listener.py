"""Listens to what the terminal view shows: the targets as numbers, own ship, the alarms."""

import time
from typing import NamedTuple

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation as implementation
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

from ..files import shortened
from . import convert, log_folder, targets_cloud, topics
from .base_node import RunnableNode
from .convert import ConversionError
from .diagnostics import OK, one_line

SILENT_S = 3.0  # without a word for so long the picture is not live


class Seen(NamedTuple):
    """What is known at the moment.

    targets  [T] of TARGET_TYPE
    own      x, y, m; vx, vy, m/s; heading, rad, nan where unknown; None before the first word
    alarms   text of each alert that is not normal
    time     s, stamp of the last targets
    """

    targets: np.ndarray = np.zeros(0, targets_cloud.TARGET_TYPE)
    own: tuple[float, float, float, float, float] | None = None
    alarms: tuple[str, ...] = ()
    time: float = 0.0


class TopListener:
    """A node with a context of its own, spun by the caller. ValueError where ROS does not start."""

    def __init__(self) -> None:
        self.seen = Seen()
        self._own_at = self._scan_at = -np.inf  # s of the steady clock
        self._period = 0.0
        self._context = Context()
        log_folder.provide()
        try:
            rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        except implementation.RCLError as error:
            raise ValueError(f'ROS does not start: {shortened(error)}') from error
        self._node = RunnableNode('top', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        for kind, topic, callback, quality in (
            (PointCloud2, topics.TARGETS_CLOUD, self._on_targets, topics.latched()),
            (Odometry, topics.ODOMETRY, self._on_odometry, topics.best_effort(1)),
            (DiagnosticArray, topics.ALARMS, self._on_alarms, topics.latched()),
        ):
            self._node.create_subscription(kind, topic, callback, quality)
        self._acknowledge = self._node.create_client(Trigger, topics.ACKNOWLEDGE)

    def spin(self) -> None:
        """Takes in what has come; does not wait for more."""
        for _ in range(20):
            self._executor.spin_once(timeout_sec=0.0)

    def stale(self) -> str:
        """Why the picture is not live; empty while it is."""
        now = time.monotonic()
        if self.seen.own is None:
            return 'no own ship yet'
        if now - self._own_at >= SILENT_S:
            return f'no own ship for {now - self._own_at:.0f} s'
        if not np.isfinite(self._scan_at):
            return 'no targets yet: is a tracker running?'
        if now - self._scan_at - self._period >= SILENT_S:
            return f'no scan for {now - self._scan_at:.0f} s'
        return ''

    def acknowledge_all(self) -> str:
        """Acknowledge all alarms; what is to be said about it."""
        if not self._acknowledge.service_is_ready():
            return 'no tracker to acknowledge to'
        self._acknowledge.call_async(Trigger.Request())
        return 'all acknowledged'

    def close(self) -> None:
        """Leave the network."""
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def _on_targets(self, message: PointCloud2) -> None:
        try:
            rows = targets_cloud.read(message)
        except ConversionError:
            return
        now = time.monotonic()
        if np.isfinite(self._scan_at):
            self._period = min(now - self._scan_at, 60.0)
        self._scan_at = now
        seconds = convert.nanoseconds(message.header.stamp) * 1e-9
        self.seen = self.seen._replace(targets=rows, time=seconds)

    def _on_odometry(self, message: Odometry) -> None:
        (x, y), (vx, vy) = convert.odometry_to_own_ship(message)
        if np.isfinite([x, y, vx, vy]).all():
            heading = convert.heading_of_odometry(message)
            own = float(x), float(y), float(vx), float(vy), float(heading)
            self._own_at = time.monotonic()
            self.seen = self.seen._replace(own=own)

    def _on_alarms(self, message: DiagnosticArray) -> None:
        self.seen = self.seen._replace(
            alarms=tuple(
                one_line(entry.message or entry.name, 100)
                for entry in message.status
                if entry.level != OK
            )
        )
