"""The PPI in a browser: hears the tracker, serves the page (display/), passes commands on.

Nothing of what it does reaches the tracking but the commands. It only listens to what the tracker
publishes anyway, and to `targets_cloud`, which is made for it.
"""

import math
import queue
import time
from collections import deque
from concurrent.futures import Future
from statistics import median
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import NavSatFix, PointCloud2

from ..display.commands import Command
from ..display.server import DisplayServer
from ..display.trails import Trails
from ..geometry import unit_vector
from ..parameters import PpiDisplayParameters
from . import convert, diagnostics, display_messages, targets_cloud, topics
from .base_node import RunnableNode
from .convert import ConversionError
from .declare import declare
from .diagnostics import FAILED, OK, WARN, Tally
from .display_commands import TrackerCommands

FIX_S = 10.0  # a position that is older is not shown
OWN_EVERY_S = 0.1  # between two positions of own ship sent to the page
SAMPLES = 400  # of own ship, to place plots by
BAD_TARGETS, BAD_OWN, BAD_FIX = 'targets not read', 'own ship not finite', 'fixes not finite'


class PpiDisplayNode(RunnableNode):
    """See the module. ValueError for wrong parameters, OSError where the port is taken."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('ppi_display', **node_arguments)
        (p,) = declare(self, PpiDisplayParameters)
        self._bad = Tally((*convert.CLOUD_REASONS, BAD_TARGETS, BAD_OWN, BAD_FIX), self.tell)
        self._commands = TrackerCommands(self, p.tracker)
        self._waiting: queue.SimpleQueue[tuple[Command, Future[str]]] = queue.SimpleQueue()
        self._wake = self.create_guard_condition(self._guarded(self._run_commands))
        self._own: deque[tuple[int, float, float]] = deque(maxlen=SAMPLES)  # ns, m, m
        self._own_told = -math.inf  # s of the wall
        self._fix: tuple[float, float] | None = None
        self._fixed = -math.inf  # s of the wall, when it was heard
        self._trails = Trails()
        self._scanned: deque[float] = deque(maxlen=6)  # s of the wall
        self._health: dict[str, dict[str, str]] = {}
        self._limits: dict[str, float] = {}
        self._alarmed = False
        self.server = DisplayServer(
            p.address, self._on_command, p.remote_commands, p.token or None, p.names.split()
        )
        for kind, topic, callback, quality in (
            (Odometry, topics.ODOMETRY, self._on_odometry, topics.best_effort()),
            (NavSatFix, topics.FIX, self._on_fix, topics.best_effort(1)),
            (PointCloud2, p.plots_topic, self._on_plots, topics.best_effort()),
            (PointCloud2, topics.TARGETS_CLOUD, self._on_targets, topics.latched()),
            (DiagnosticArray, topics.ALARMS, self._on_alarms, topics.latched()),
            (DiagnosticArray, topics.TRIAL, self._on_trial, topics.latched()),
            (DiagnosticArray, topics.DIAGNOSTICS, self._on_diagnostics, topics.reliable()),
        ):
            self.subscription(kind, topic, callback, quality)
        self._to_diagnostics = self.publisher(
            DiagnosticArray, topics.DIAGNOSTICS, topics.reliable()
        )
        self.create_timer(1.0, self._on_second, clock=Clock(clock_type=ClockType.STEADY_TIME))
        # Printed, not logged: the log is kept on disk and published, and this holds the token.
        print(f'ppi_display: {self.server.url}', flush=True)

    def close(self) -> None:
        """Let the viewers go."""
        self.server.close()

    # -- in ------------------------------------------------------------------------------------

    def _on_odometry(self, message: Odometry) -> None:
        position, velocity = convert.odometry_to_own_ship(message)
        wall = time.monotonic()
        if not np.isfinite(position).all():
            self._bad.add(BAD_OWN, wall)
            return
        time_ns = convert.nanoseconds(message.header.stamp)
        if self._own and time_ns < self._own[-1][0]:  # time went back: another run
            self._own.clear()
        self._own.append((time_ns, *position.tolist()))
        if wall - self._own_told < OWN_EVERY_S:
            return
        self._own_told = wall
        heading = convert.heading_of_odometry(message)
        x, y, vx, vy = display_messages.plain(np.hstack([position, velocity]), 3)
        fresh = wall - self._fixed < FIX_S
        latitude, longitude = (self._fix if fresh else None) or (None, None)
        self.server.publish(
            'own',
            {
                'at': wall,
                'time': time_ns * 1e-9,
                'x': x,
                'y': y,
                'vx': vx,
                'vy': vy,
                'heading': heading if np.isfinite(heading) else None,
                'latitude': latitude,
                'longitude': longitude,
            },
        )

    def _on_fix(self, message: NavSatFix) -> None:
        if math.isfinite(message.latitude) and math.isfinite(message.longitude):
            self._fix = message.latitude, message.longitude
            self._fixed = time.monotonic()
        else:
            self._fix = None
            self._bad.add(BAD_FIX, time.monotonic())

    def _on_plots(self, message: PointCloud2) -> None:
        if not self.server.viewers:
            return
        try:
            plots = convert.cloud_to_plots(message)
        except ConversionError as error:
            self._bad.add(error.reason, time.monotonic(), detail=str(error))
            return
        if not self._own:
            return
        # Each at its own bearing from where own ship was when the beam passed it.
        samples = np.array(self._own)
        when = convert.nanoseconds(message.header.stamp) - samples[0, 0] + plots.time * 1e9
        since = samples[:, 0] - samples[0, 0]
        own = np.stack([np.interp(when, since, samples[:, k]) for k in (1, 2)], 1)
        position = own + plots.range[:, None] * unit_vector(plots.bearing)
        good = np.isfinite(position).all(1)
        self.server.publish(
            'plots',
            {
                'at': time.monotonic(),
                'stamp': convert.nanoseconds(message.header.stamp) * 1e-9,
                'x': display_messages.plain(position[good, 0], 0),
                'y': display_messages.plain(position[good, 1], 0),
                'amplitude': display_messages.plain(plots.amplitude[good], 0),
            },
        )

    def _on_targets(self, message: PointCloud2) -> None:
        wall = time.monotonic()
        try:
            rows = targets_cloud.read(message)
        except ConversionError as error:
            self._bad.add(BAD_TARGETS, wall, detail=str(error))
            return
        self._scanned.append(wall)
        moments = list(self._scanned)
        gaps = [b - a for a, b in zip(moments, moments[1:])]
        seconds = convert.nanoseconds(message.header.stamp) * 1e-9
        self.server.publish(
            'targets',
            {
                'at': wall,
                'time': seconds,
                'period': median(gaps) if gaps else None,
                'columns': display_messages.targets(rows),
                'fixed': display_messages.stationary(rows),
            },
        )
        own = self._own[-1][1:] if self._own else None
        rows = rows[rows['id'] > 0]
        position = np.stack([rows['x'], rows['y']], 1).astype(float)
        if own and self._trails.add(seconds, own, rows['id'], position):
            self.server.publish('trails', self._trails.plain())

    def _on_alarms(self, message: DiagnosticArray) -> None:
        self._alarmed = True
        self.server.publish('alarms', {'alarms': display_messages.alarms(message)})

    def _on_trial(self, message: DiagnosticArray) -> None:
        self._alarmed = True
        self.server.publish('trial', display_messages.trial(message))

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for name, about in display_messages.health(message).items():
            if name in self._health or len(self._health) < 100:
                self._health[name] = about

    # -- commands --------------------------------------------------------------------------------

    def _on_command(self, command: Command) -> Future[str]:
        """In the server's thread: handed over to the executor's."""
        answer: Future[str] = Future()
        self._waiting.put((command, answer))
        self._wake.trigger()
        return answer

    def _run_commands(self) -> None:
        while not self._waiting.empty():
            self._commands.run(*self._waiting.get())

    # -- how it fares ----------------------------------------------------------------------------

    def _on_second(self) -> None:
        self._run_commands()
        self._commands.ask_limits(self._hear_limits)
        self._forget()
        wall = time.monotonic()
        fresh = self._bad.fresh(wall)
        values = {
            'viewers': self.server.viewers,
            'messages replaced by newer ones': self.server.replaced,
            **self.server.counts,
            **self._bad.counts,
            FAILED: sum(self.failures.counts.values()),
            **self.failures.counts,
        }
        status = diagnostics.status(
            f'{self.label}: display',
            self.hardware_id,
            WARN if fresh else OK,
            'lately: ' + ', '.join(fresh) if fresh else f'{self.server.viewers} viewers',
            values,
        )
        self._to_diagnostics.publish(
            diagnostics.array(self.get_clock().now().nanoseconds, [status])
        )
        self.server.publish('health', {'parts': self._health})

    def _forget(self) -> None:
        """Of a tracker that has gone no alarm and no trial is left standing."""
        if self._alarmed and not self.count_publishers(topics.ALARMS):
            self._alarmed = False
            self.server.publish('alarms', {'alarms': []})
            self.server.publish('trial', {'on': False})

    def _hear_limits(self, limits: dict[str, float]) -> None:
        if limits != self._limits:
            self._limits = limits
            self.server.publish('limits', limits)
