"""Listens to `targets` and `alarms` and gives the last messages as plain values, to show them."""

import math
from typing import NamedTuple

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation as implementation
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import PointCloud2

from ..files import shortened
from ..geometry import KNOT
from . import log_folder, topics
from .base_node import RunnableNode
from .convert import nanoseconds, odometry_to_own_ship
from .diagnostics import ERROR, OK, one_line
from .targets_message import degrees

CELL = 40  # characters of a name or a value, which somebody else may have written


class Picture(NamedTuple):
    """What is known at the moment.

    scans     messages on `targets` so far
    time      s, stamp of the last one
    targets   one mapping a target: name, status, danger (DANGER or nothing), and the values of
              `targets`
    alarms    text and acknowledgement, one line an alarm
    plots     plots in the last revolution
    own_ship  course and speed, as text
    warnings  problems that /diagnostics reports
    """

    scans: int = 0
    time: float = 0.0
    targets: tuple[dict[str, str], ...] = ()
    alarms: tuple[str, ...] = ()
    plots: int = 0
    own_ship: str = 'not heard'
    warnings: tuple[str, ...] = ()


class TargetsListener:
    """A node with a context of its own. The caller spins it and handles the signals."""

    def __init__(self) -> None:
        self.picture = Picture()
        self._context = Context()
        self._others: list[RunnableNode] = []
        log_folder.provide()
        try:
            rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        except implementation.RCLError as error:
            raise ValueError(f'ROS does not start: {shortened(error)}') from error
        self._node = RunnableNode('targets_listener', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        for kind, topic, callback, quality in (
            (DiagnosticArray, topics.TARGETS, self._on_targets, topics.latched()),
            (DiagnosticArray, topics.ALARMS, self._on_alarms, topics.latched()),
            (PointCloud2, topics.PLOTS, self._on_plots, topics.best_effort(1)),
            (Odometry, topics.ODOMETRY, self._on_odometry, topics.best_effort(1)),
            (DiagnosticArray, topics.DIAGNOSTICS, self._on_diagnostics, topics.reliable()),
        ):
            self._node.create_subscription(kind, topic, callback, quality)

    def spin(self, seconds: float) -> None:
        """Takes at most one message; waits at most `seconds` for it."""
        self._executor.spin_once(timeout_sec=seconds)

    def add(self, name: str) -> RunnableNode:
        """Another node, spun with this one."""
        node = RunnableNode(name, context=self._context)
        self._executor.add_node(node)
        self._others.append(node)
        return node

    def forget(self) -> None:
        """What was heard so far: something else comes."""
        self.picture = Picture()

    def close(self) -> None:
        """Leave the network."""
        self._executor.shutdown()
        for node in (self._node, *self._others):
            node.destroy_node()
        self._context.try_shutdown()

    def _on_targets(self, message: DiagnosticArray) -> None:
        targets = tuple(
            {
                'name': one_line(entry.name, CELL),
                'status': one_line(entry.message, CELL),
                **{pair.key: one_line(pair.value, CELL) for pair in entry.values},
                'danger': 'DANGER' if entry.level == ERROR else '',
            }
            for entry in message.status
        )
        self.picture = self.picture._replace(
            scans=self.picture.scans + 1,
            time=nanoseconds(message.header.stamp) * 1e-9,
            targets=targets,
        )

    def _on_alarms(self, message: DiagnosticArray) -> None:
        about = [
            (entry.name, next((pair.value for pair in entry.values if pair.key == 'state'), ''))
            for entry in message.status
            if entry.level != OK
        ]
        self.picture = self.picture._replace(
            alarms=tuple(one_line(f'{name}, {state}') for name, state in about)
        )

    def _on_plots(self, message: PointCloud2) -> None:
        self.picture = self.picture._replace(plots=message.width * message.height)

    def _on_odometry(self, message: Odometry) -> None:
        _, (east, north) = odometry_to_own_ship(message)
        speed = math.hypot(east, north) / KNOT
        course = degrees(math.degrees(math.atan2(east, north)))
        self.picture = self.picture._replace(
            own_ship=f'course {course}, {speed:.1f} kn' if speed >= 0.05 else 'at rest'
        )

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        self.picture = self.picture._replace(
            warnings=tuple(
                one_line(f'{entry.name}: {entry.message}')
                for entry in message.status
                if entry.level != OK
            )
        )
