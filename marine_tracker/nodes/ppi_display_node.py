"""The PPI in a browser: hears the tracker, serves the page (display/), passes commands on.

Nothing of what it does reaches the tracking but the commands. It only listens to what the tracker
publishes anyway, and to `targets_cloud`, which is made for it.
"""

import math
import queue
import time
from collections import deque
from concurrent.futures import Future
from functools import partial
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
from ..parameters import PpiDisplayParameters
from . import convert, diagnostics, display_messages, targets_cloud, topics
from .base_node import RunnableNode
from .convert import ConversionError
from .declare import declare
from .diagnostics import FAILED, OK, WARN, Tally
from .display_ais import BAD_SHIPS, DisplayAis
from .display_commands import AIS, LIMITS, TrackerCommands
from .display_danger_areas import DangerAreas
from .display_demo import SHOW, DemoLink
from .display_own import OwnShipHeard
from .display_own_ship import OwnWay, ship
from .display_spokes import DisplaySpokes
from .display_tracker import radars_told, zones_told

OWN_EVERY_S = 0.1  # between two positions of own ship sent to the page
BAD_TARGETS, BAD_OWN, BAD_FIX = 'targets not read', 'own ship not finite', 'fixes without a place'


class PpiDisplayNode(RunnableNode):
    """See the module. ValueError for wrong parameters, OSError where the port is taken."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('ppi_display', **node_arguments)
        (p,) = declare(self, PpiDisplayParameters)
        self._bad = Tally(
            (*convert.CLOUD_REASONS, BAD_TARGETS, BAD_SHIPS, BAD_OWN, BAD_FIX), self.tell
        )
        self._demo = DemoLink(self)
        self._shown: dict[str, Any] = {}  # by the demo, where there is one
        self._waiting: queue.SimpleQueue[tuple[Command, Future[str]]] = queue.SimpleQueue()
        self._wake = self.create_guard_condition(self._guarded(self._run_commands))
        self._commands = TrackerCommands(self, p.tracker, self._wake.trigger)
        self._own = OwnShipHeard()
        self._own_told = -math.inf  # s of the wall
        self._plots_topic = p.plots_topic  # of a tracker with one radar
        self._plots: dict[str, Any] = {}  # the subscriptions, by topic
        self._names = ['']  # of the radars
        self._trails = Trails()
        self._scanned: deque[float] = deque(maxlen=6)  # s of the wall
        self._health: dict[str, dict[str, str]] = {}
        self._told: dict[str, dict[str, Any]] = {}  # of the tracker's parameters, to the page
        self._alarmed = False
        self.server = DisplayServer(
            p.address, self._on_command, p.remote_commands, p.token or None, p.names.split()
        )
        self._given = p
        self._ship: dict[str, Any] = {}
        self._way = OwnWay()
        self._areas = DangerAreas(self, self.server)
        DisplaySpokes(self, self.server, self._own, self._bad)
        self._ais = DisplayAis(self, self.server, self._bad)
        for kind, topic, callback, quality in (
            (Odometry, topics.ODOMETRY, self._on_odometry, topics.best_effort()),
            (NavSatFix, topics.FIX, self._on_fix, topics.best_effort(1)),
            (PointCloud2, topics.TARGETS_CLOUD, self._on_targets, topics.latched()),
            (DiagnosticArray, topics.ALARMS, self._on_alarms, topics.latched()),
            (DiagnosticArray, topics.ALARMS_PAST, self._on_alarms_past, topics.latched()),
            (DiagnosticArray, topics.OWN_SHIP_STATE, self._way.hear, topics.latched()),
            (DiagnosticArray, topics.TRIAL, self._on_trial, topics.latched()),
            (DiagnosticArray, topics.DIAGNOSTICS, self._on_diagnostics, topics.reliable()),
        ):
            self.subscription(kind, topic, callback, quality)
        self._hear_radars([self._plots_topic])
        self._to_diagnostics = self.publisher(
            DiagnosticArray, topics.DIAGNOSTICS, topics.reliable()
        )
        self.create_timer(1.0, self._on_second, clock=Clock(clock_type=ClockType.STEADY_TIME))
        if p.managed:
            self.manage()
        # Printed, not logged: the log is kept on disk and published, and this holds the token.
        print(f'ppi_display: {self.server.url}', flush=True)

    def close(self) -> None:
        """Let the viewers go."""
        self.server.close()

    # -- in ------------------------------------------------------------------------------------

    def _on_odometry(self, message: Odometry) -> None:
        wall = time.monotonic()
        if not self._own.hear(message):
            self._bad.add(BAD_OWN, wall)
        elif wall - self._own_told >= OWN_EVERY_S:
            self._own_told = wall
            own = self._own.plain(wall)
            self.server.publish('own', {**own, **self._way.told(own['vx'], own['vy'])})

    def _on_fix(self, message: NavSatFix) -> None:
        wall = time.monotonic()
        if not self._own.hear_fix(message, wall):
            self._bad.add(BAD_FIX, wall)

    def _on_plots(self, radar: int, message: PointCloud2) -> None:
        if not self.server.viewers:
            return
        try:
            plots = convert.cloud_to_plots(message)
            stamp_ns = convert.nanoseconds(message.header.stamp)
        except ConversionError as error:
            self._bad.add(error.reason, time.monotonic(), detail=str(error))
            return
        position = self._own.place(plots, stamp_ns, radar)
        if position is None:
            return
        good = np.isfinite(position).all(1)
        self.server.publish(
            _kind_of(radar),
            {
                'at': time.monotonic(),
                'stamp': stamp_ns * 1e-9,
                'radar': radar,
                'name': self._names[radar],
                'x': display_messages.plain(position[good, 0], 0),
                'y': display_messages.plain(position[good, 1], 0),
                'amplitude': display_messages.plain(plots.amplitude[good], 0),
            },
        )

    def _hear_radars(self, radars: list[str]) -> None:
        """Listen to the plots of the tracker's radars, on these topics."""
        if list(self._plots) == radars:
            return
        for old in self._plots.values():
            self.destroy_subscription(old)
        self._plots = {
            topic: self.subscription(
                PointCloud2, topic, partial(self._on_plots, place), topics.best_effort()
            )
            for place, topic in enumerate(radars)
        }

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
        rows = rows[rows['id'] > 0]
        own = self._own.position
        ships, places = self._ais.places()
        ids = np.concatenate([rows['id'].astype(int), ships])
        position = np.concatenate([np.stack([rows['x'], rows['y']], 1).astype(float), places])
        if own is not None and self._trails.add(seconds, own, ids, position):
            self.server.publish('trails', self._trails.plain())

    def _on_alarms(self, message: DiagnosticArray) -> None:
        self._alarmed = True
        self.server.publish('alarms', {'alarms': display_messages.alarms(message)})

    def _on_trial(self, message: DiagnosticArray) -> None:
        self._alarmed = True
        trial = display_messages.trial(message)
        self.server.publish('trial', {'at': time.monotonic(), **trial})

    def _on_alarms_past(self, message: DiagnosticArray) -> None:
        self.server.publish('alarms_past', {'alarms': display_messages.alarms_past(message)})

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
            command, answer = self._waiting.get()
            to = self._demo.choose if command.name == SHOW else self._commands.run
            to(command, answer)
        self._commands.go_on()

    # -- how it fares ----------------------------------------------------------------------------

    def _on_second(self) -> None:
        self._run_commands()
        self._commands.ask(self._hear_parameters)
        self._demo.ask(self._hear_demo)
        self._forget()
        self._areas.look()
        about = ship(self._given, self)
        if about != self._ship:
            self._ship = about
            self.server.publish('ship', about)
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

    def _hear_parameters(self, values: dict[str, Any]) -> None:
        """The tracker's parameters: what changed goes to the page."""
        radars = radars_told(values, self._plots_topic)
        self._own.radars = [radar.parameters for radar in radars]
        self._names = [radar.name for radar in radars]
        self._hear_radars([radar.topic for radar in radars])
        for kind, told in (
            ('limits', {name: values[name] for name in LIMITS}),
            ('ais', {name: values[name] for name in AIS}),
            ('zones', zones_told(values)),
        ):
            if told != self._told.get(kind):
                self._told[kind] = told
                self.server.publish(kind, told)

    def _hear_demo(self, shown: dict[str, Any]) -> None:
        if shown == self._shown:
            return
        if shown.get('run') != self._shown.get('run'):  # what was seen so far is of another run
            self._trails = Trails()
            self._own.begin_anew()
            self._scanned.clear()
            plots = (_kind_of(radar) for radar in range(len(self._plots)))
            self.server.forget('targets', 'ships', 'trails', 'spokes', *plots)
        self._shown = shown
        self.server.publish('demo', {'demo': shown})


def _kind_of(radar: int) -> str:
    """The kind of message of a radar's plots: a newer one of another radar replaces none."""
    return f'plots{radar or ""}'
