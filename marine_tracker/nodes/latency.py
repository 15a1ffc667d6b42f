"""Listens to tracks over DDS: how long after the beam each one comes."""

import time

import rclpy
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from . import convert, topics
from .base_node import RunnableNode


class LatencyListener:
    """A node with a context of its own, beside a tracker whose stamps are of this machine's clock.

    late  s from the stamp of each track, when the beam passed it, to its arrival
    """

    def __init__(self) -> None:
        self.late: list[float] = []
        self._context = Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        self._node = RunnableNode('latency', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._node.subscription(Odometry, topics.TRACKS, self._on_track, topics.reliable(5000))

    def close(self) -> None:
        """Ends the node."""
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def spin(self, seconds: float) -> None:
        """Listens for so many seconds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._executor.spin_once(timeout_sec=0.05)

    def _on_track(self, message: Odometry) -> None:
        self.late.append(time.time() - convert.nanoseconds(message.header.stamp) * 1e-9)
