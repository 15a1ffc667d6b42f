"""The tracker as a node: plots and own ship in, tracks out. The core does the work.

Input is screened (tracking/intake.py). Bad input is rejected, counted on /diagnostics by a named
reason, and logged once. The tracks stay. intake.py also describes how jumps of the clock and of own
ship are handled.

`tracks` and `extrapolations` show confirmed and coasting tracks; `tracks_cloud` shows all tracks
with their status. In `tracks` each one has the time at which the beam passed it. `targets` and
`markers` show acquired tracks (operator.py). A lost target is once more in `targets`, as STALE.
"""

import time
from functools import partial
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from rclpy.event_handler import SubscriptionEventCallbacks
from sensor_msgs.msg import PointCloud2

from ..arpa.arpa import Picture
from ..arpa.view import Standing
from ..parameters import NODES
from ..service import Service, service_of
from ..tracking import clocks, offsets, own_ship
from ..tracking.lifecycle import COASTING, CONFIRMED, TENTATIVE
from ..tracking.mounting import needs_heading
from ..tracking.own_velocity import AUTO, POSITIONS
from ..tracking.radars import radars_of
from . import convert, diagnostics, messages_of_others, topics
from .ais_in_tracker import AisInTracker
from .base_node import RunnableNode
from .declare import declare, follow
from .diagnostics import FAILED, OK, WARN, Durations, Tally
from .faults import HEADER_REASONS, NO_STAMP, ConversionError, bare, check_frame
from .operator import Operator
from .own_sensors import LOG_REASONS, SensorsInput
from .own_ship_state import sources
from .radar_input import Arrival, RadarInput
from .tracker_output import TrackerOutput

ANOTHER_CLOCK_S = 60.0  # no load makes plots so late


class TrackerNode(RunnableNode):
    """See the module. ValueError where the parameters are wrong."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('tracker', **node_arguments)
        parameters, arpa_parameters, ais_parameters, output_parameters = declare(
            self, *NODES['tracker']
        )
        service = service_of(parameters, arpa_parameters, ais_parameters)
        self._base_ns: int | None = None  # stamps are seconds after this
        self._own_log, self._own_frame = own_ship.empty_log(), topics.OWN_SHIP_FRAME
        self._fallback = own_ship.OWN_NEVER_HEARD
        self._samples = 0
        self._status_count = np.zeros(5, int)
        self._standing = Standing({}, 0, '', np.zeros(0, bool))
        self._left_out, self._left_out_lately = 0, 0  # pairs, in all scans and in the last
        self._processing, self._lateness = Durations(), Durations()
        self.inputs = [
            RadarInput(radar, place, partial(self._tell_of, radar.name))
            for place, radar in enumerate(radars_of(parameters))
        ]
        self.bad_own_ship = Tally((*own_ship.OWN_REASONS, *HEADER_REASONS, *LOG_REASONS), self.tell)
        self._sensors = SensorsInput(
            self,
            lambda reason, detail: self.bad_own_ship.add(reason, time.monotonic(), detail=detail),
        )

        self._operator = Operator(self, service, self._sensors, self.hardware_id)
        self._ais = AisInTracker(self, self._operator, self._own_place, self._seconds)
        follow(self, NODES['tracker'][:3], service_of, self._change)
        self._output = TrackerOutput(self, self.hardware_id, output_parameters)
        p = output_parameters
        self._send_transform = messages_of_others.transforms(self) if p.broadcast_tf else None
        plots_kind: Any = PointCloud2
        if p.plots_type != 'PointCloud2':
            (plots_kind,) = messages_of_others.kinds('plots_type', 'radar_msgs.msg', p.plots_type)
        self._to_diagnostics = self.publisher(
            DiagnosticArray, topics.DIAGNOSTICS, topics.reliable()
        )
        self._to_state = self.publisher(DiagnosticArray, topics.OWN_SHIP_STATE, topics.latched())

        # Own ship first: of messages that wait together it is taken first.
        self._inputs: dict[str, tuple[Any, ...]] = {}
        self._mismatched: set[str] = set()
        self._listen(Odometry, topics.ODOMETRY, self._on_odometry, topics.best_available())
        for heard in self.inputs:
            self._listen(
                plots_kind,
                heard.radar.topic,
                partial(self._on_plots, heard),
                topics.best_available(topics.SECTORS),
            )
        # The wall's second, whatever the node's clock does.
        self.create_timer(1.0, self._on_second, clock=Clock(clock_type=ClockType.STEADY_TIME))
        if output_parameters.managed:
            self.manage()
        self.get_logger().info(
            f'estimator {parameters.estimator}, waiting for '
            + ', '.join(heard.radar.topic for heard in self.inputs)
        )

    def close(self) -> None:
        """A last word on /diagnostics."""
        self._on_second()

    # -- in ------------------------------------------------------------------------------------

    def _listen(self, kind, topic, callback, quality):
        """Subscribe; to be repeated as best effort once a publisher asks for it (_on_second)."""
        events = SubscriptionEventCallbacks(incompatible_qos=lambda _: self._mismatched.add(topic))
        self._inputs[topic] = (
            kind,
            callback,
            self.create_subscription(kind, topic, callback, quality, event_callbacks=events),
        )

    def _on_odometry(self, message: Odometry) -> None:
        self._samples += 1
        wall, came = time.monotonic(), self._arrival()
        try:
            check_frame(message.header.frame_id, (topics.FRAME,))
            time_ns = convert.nanoseconds(message.header.stamp)
        except ConversionError as error:
            self.bad_own_ship.add(error.reason, wall, detail=str(error))
            return
        if not time_ns:
            time_ns = came.now_ns
            self.bad_own_ship.add(NO_STAMP, wall)
        position, velocity = convert.odometry_to_own_ship(message)
        heading = convert.heading_of_odometry(message, doubtful=self._own_log.off > 0)
        self._own_log, reason = own_ship.admit_own_ship(
            self._own_log, self._seconds(time_ns), position, velocity, came.arrival, heading
        )
        if reason:
            self.bad_own_ship.add(reason, wall, detail=f'at {position}')
        placed = reason in ('', own_ship.OWN_REBASED)
        if placed and bare(message.child_frame_id) not in ('', topics.FRAME):
            self._own_frame = bare(message.child_frame_id)
        self._sensors.hear_own_ship(placed, heading)
        if placed and self._send_transform is not None:
            self._send_transform(message)

    def _own_place(self, time: float) -> np.ndarray:
        """Own ship's position [2] m as her odometry tells it, at a time, s; nan: not known."""
        return own_ship.now(self._own_log, time, self._trusted)[0]

    def _arrival(self) -> Arrival:
        """How a message comes that comes now: in simulated time where there is one."""
        clock = self.get_clock()
        now_ns = clock.now().nanoseconds
        simulated = self.get_parameter('use_sim_time').value and now_ns
        arrival = now_ns * 1e-9 if simulated else clocks.steady()
        return Arrival(arrival, now_ns, self._seconds, self._own_frame)

    def _on_plots(self, heard: RadarInput, message: PointCloud2) -> None:
        began, p = time.perf_counter(), self._operator.arpa.parameters
        found = heard.read(
            message,
            self._arrival(),
            self._own_log,
            [other.order for other in self.inputs if other is not heard],
            self._sensors.way(p)[0],
            self._sensors.heading_now(time.monotonic(), p),
        )
        if found is None:
            return
        scan, self._fallback, self._own_log = found
        end_ns = int(self._stamps(heard, scan.end))
        done, output = self._operator.step(scan, end_ns, self._fallback)
        service, stamps = self._operator.service, partial(self._stamps, heard)
        if done is not None:
            self._output.publish_tracks(service, done, heard.revolution, stamps)
        if output is not None:
            status = self._own_ship_status(time.monotonic())
            self._to_state.publish(diagnostics.array(end_ns, [status]))
            self._output.publish_targets(service, output, stamps)
            self._ais.publish(output.ais, end_ns)
            self._status_count = np.bincount(output.report.tracks.status, minlength=5)
            self._standing = output.standing
            self._left_out_lately = output.report.left_out
            self._left_out += output.report.left_out
        now = self.get_clock().now().nanoseconds
        if now:  # 0: no /clock yet
            self._lateness.add((now - end_ns) * 1e-9)
        self._processing.add(time.perf_counter() - began)

    def _change(self, service: Service) -> None:
        """Live parameters were changed: another service takes the tracks over."""
        self._operator.change(service)
        tracker = service.tracker
        for heard, radar in zip(self.inputs, radars_of(tracker.parameters), strict=True):
            heard.radar = radar

    @property
    def picture(self) -> Picture | None:
        """The targets after the last scan; None before the first."""
        return self._operator.picture

    @property
    def period(self) -> float:
        """s of one revolution, of the fastest radar."""
        return min(heard.revolution for heard in self.inputs)

    def _seconds(self, time_ns: int) -> float:
        """s of a stamp after the first stamp that came in."""
        if self._base_ns is None:
            self._base_ns = time_ns
        return (time_ns - self._base_ns) * 1e-9

    def _stamps(self, heard: RadarInput, time):
        """Stamps [N] in ns, on the radar's clock, of the tracker's times [N] s."""
        return self._base_ns + np.round((time - heard.order.shift) * 1e9).astype(np.int64)

    # -- how it fares --------------------------------------------------------------------------

    def _tell_of(self, radar: str, reason: str, detail: str) -> None:
        self.tell(f'{radar}: {reason}' if radar else reason, detail)

    def _on_second(self) -> None:
        for topic in tuple(self._mismatched):
            kind, callback, subscription = self._inputs[topic]
            self.destroy_subscription(subscription)
            self._listen(kind, topic, callback, topics.best_effort())
            self._mismatched.discard(topic)
            self.get_logger().info(f'{topic} is published best effort: taken so')
        wall, now = time.monotonic(), self.get_clock().now().nanoseconds
        self._operator.watch(0.0 if self._trusted == POSITIONS else self._own_log.off)
        self._ais.publish(*self._operator.ais_alone(self._own_log))
        self._to_diagnostics.publish(
            diagnostics.array(
                now,
                [
                    *(self._input_status(heard, wall, now) for heard in self.inputs),
                    self._tracking_status(wall),
                    self._own_ship_status(wall),
                    *self._ais.state(),
                ],
            )
        )

    def _input_status(self, heard: RadarInput, wall: float, now: int) -> DiagnosticStatus:
        level, message, values = heard.state(wall)
        if now == 0:
            level, message = WARN, message + '; use_sim_time is set and /clock is silent'
        radar = self._operator.memory.tracker.radars[self.inputs.index(heard)]
        values = {**values, **offsets.in_words(radar.offsets)}
        return self._status(f'input {heard.radar.name}'.rstrip(), level, message, values)

    def _tracking_status(self, wall: float) -> DiagnosticStatus:
        level, message = OK, f'{self._status_count[[CONFIRMED, COASTING]].sum()} targets'
        slow, worries = self._processing.percentile(99), []
        if slow > 0.5 * self.period:
            worries.append(f'a scan takes up to {slow:.2f} s of {self.period:.2f} s')
        elif self._lateness.percentile(50) > self.period:
            worries.append('plots come more than a revolution late' + self._why_late())
        confirmed, (states, fallen, reason, _) = self._status_count[CONFIRMED], self._standing
        if fallen > 0.5 * confirmed:
            worries.append(f'{fallen} of {confirmed} targets have fallen back: {reason}')
        if self._left_out_lately:
            worries.append(f'a crowd of plots: {self._left_out_lately} pairs left out')
        if worries:
            level, message = WARN, '; '.join(worries)
        fresh = self.failures.fresh(wall)
        if fresh:
            level, message = diagnostics.ERROR, 'lately: ' + ', '.join(fresh)
        service, memory = self._operator.service, self._operator.memory
        parameters = service.tracker.parameters
        values = {
            'estimator': parameters.estimator,
            **{f'confirmed in {state}': count for state, count in states.items()},
            'fallback reason': reason,
            'confirmed': confirmed,
            'coasting': self._status_count[COASTING],
            'tentative': self._status_count[TENTATIVE],
            **({} if parameters.extent == 'none' else {'clusters of land': memory.extents.shores}),
            'at max_tracks': len(memory.tracker.tracks.id) >= parameters.max_tracks,
            'pairs left out': self._left_out,
            'processing_p50_ms': f'{1e3 * self._processing.percentile(50):.1f}',
            'processing_p99_ms': f'{1e3 * slow:.1f}',
            'lateness_p50_ms': f'{1e3 * self._lateness.percentile(50):.1f}',
            'lateness_p99_ms': f'{1e3 * self._lateness.percentile(99):.1f}',
            **self._operator.refused.counts,
            FAILED: sum(self.failures.counts.values()),
            **self.failures.counts,
        }
        return self._status('tracking', level, message, values)

    def _why_late(self) -> str:
        """The cause, where the clock is: plots of another time than this node's."""
        late = self._lateness.percentile(50)
        if self.get_parameter('use_sim_time').value or late < ANOTHER_CLOCK_S:
            return ''
        if self.count_publishers(topics.CLOCK):
            return f': {late:.0f} s; /clock is published: set use_sim_time'
        return f': {late:.0f} s; if they are of a recording, play its /clock and set use_sim_time'

    def _own_ship_status(self, wall: float) -> DiagnosticStatus:
        worries = []
        taken = any(heard.taken for heard in self.inputs)
        if self._fallback and taken or not self._samples:
            worries.append(self._fallback)
        off, source = self._own_log.off, self._trusted
        if source == AUTO:
            source = 'positions' if off else 'twist'
        if off and self._trusted != POSITIONS:
            worries.append(f'twist is {off:.1f} m/s off the positions: velocity from {source}')
        more, known = sources(
            self._operator.picture,
            self._sensors,
            source,
            self._fallback,
            self._operator.arpa.parameters,
            needs_heading(radar.parameters for radar in self._operator.arpa.radars),
        )
        worries += more
        fresh = self.bad_own_ship.fresh(wall)
        if fresh:
            worries.append('lately: ' + ', '.join(fresh))
        level, message = (WARN, '; '.join(worries)) if worries else (OK, 'heard')
        values = {
            'samples': self._samples,
            'velocity from': source,
            **known,
            'twist off positions_mps': f'{off:.2f}',
            **self.bad_own_ship.counts,
        }
        return self._status('own ship', level, message, values)

    @property
    def _trusted(self) -> str:
        """What tells own ship's velocity: the parameter."""
        return self._operator.service.tracker.parameters.own_ship_velocity

    def _status(self, task, level, message, values):
        return diagnostics.status(f'{self.label}: {task}', self.hardware_id, level, message, values)
