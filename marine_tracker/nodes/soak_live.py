"""What throws faults at running nodes over DDS, and sees what becomes of the targets."""

import copy
import time
from collections.abc import Callable

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import PointCloud2

from ..geometry import unit_vector
from ..types import OwnShip, PolarPlots, Scan
from . import convert, topics
from .base_node import RunnableNode
from .diagnostics import FAILED

FLOOD = 10000  # plots
AHEAD_S = 17.0  # of a bad stamp
PATIENCE_S = 30.0  # for the next scan, and for the targets after it


class SoakListener:
    """A node with a context of its own, beside a tracker and a simulator.

    scans   messages on `targets` so far
    held    targets that are tracked or coast, of the last one
    failed  exceptions in callbacks that the tracker has counted, the most that it said
    """

    def __init__(self) -> None:
        self.scans, self.held, self.failed = 0, 0, 0
        self._context = Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        self._node = RunnableNode('soak', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._cloud: PointCloud2 | None = None
        self._own: Odometry | None = None
        self._to_plots = self._node.publisher(PointCloud2, topics.PLOTS, topics.reliable())
        self._to_own = self._node.publisher(Odometry, topics.ODOMETRY, topics.reliable())
        for kind, topic, callback, quality in (
            (DiagnosticArray, topics.TARGETS, self._on_targets, topics.reliable()),
            (DiagnosticArray, topics.DIAGNOSTICS, self._on_diagnostics, topics.reliable()),
            (PointCloud2, topics.PLOTS, self._on_plots, topics.reliable()),
            (Odometry, topics.ODOMETRY, self._on_own_ship, topics.reliable()),
        ):
            self._node.subscription(kind, topic, callback, quality)

    def close(self) -> None:
        """Ends the node."""
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def spin(self, seconds: float, until: Callable[[], bool] = lambda: False) -> None:
        """Listens for so many seconds, or until the condition holds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and not until():
            self._executor.spin_once(timeout_sec=0.05)

    def until_held(self, enough: float) -> float:
        """How many scans pass, after the first one, until so many targets are held; inf if that
        takes too long."""
        before = self.scans
        self.spin(PATIENCE_S, lambda: self.scans > before)
        first = self.scans
        self.spin(PATIENCE_S, lambda: self.held >= enough)
        return self.scans - first if self.held >= enough else np.inf

    def throw(self, fault: str) -> None:
        """Publishes what a faulty radar or compass would. ValueError for an unknown fault."""
        if self._cloud is None or self._own is None:
            return
        if fault == 'flood':
            self._to_plots.publish(_flood(self._cloud))
        elif fault == 'no plots':
            self._to_plots.publish(_flood(self._cloud, 0))
        elif fault == 'bad stamp':
            cloud = copy.deepcopy(self._cloud)
            cloud.header.stamp.sec += round(AHEAD_S)
            self._to_plots.publish(cloud)
        elif fault == 'teleport':
            own = copy.deepcopy(self._own)
            own.pose.pose.position.x += 8000.0
            self._to_own.publish(own)
        elif fault == 'lost heading':
            own = copy.deepcopy(self._own)
            own.pose.pose.orientation.w = own.pose.pose.orientation.z = 0.0
            self._to_own.publish(own)
        else:
            raise ValueError(f'there is no fault {fault!r}')

    def _on_targets(self, message: DiagnosticArray) -> None:
        self.scans += 1
        self.held = sum(entry.message in ('TRACKING', 'COASTING') for entry in message.status)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for entry in message.status:
            for pair in entry.values:
                if pair.key == FAILED:
                    self.failed = max(self.failed, int(pair.value))

    def _on_plots(self, message: PointCloud2) -> None:
        self._cloud = message

    def _on_own_ship(self, message: Odometry) -> None:
        self._own = message


def _flood(cloud: PointCloud2, count: int = FLOOD) -> PointCloud2:
    """A scan of its own, a tenth of a second after that one, with so many plots in one place."""
    place = 4000.0 * unit_vector(np.ones(count)) + np.random.default_rng(1).normal(
        0, 100.0, (count, 2)
    )
    nothing = np.zeros(count)
    plots = PolarPlots(nothing, np.hypot(*place.T), np.arctan2(*place.T), nothing + 15.0)
    still = OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))
    stamp = convert.nanoseconds(cloud.header.stamp) + 100_000_000
    return convert.plots_to_cloud(Scan(0.0, 0.0, plots, still), stamp)
