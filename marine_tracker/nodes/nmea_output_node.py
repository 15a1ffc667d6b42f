"""NMEA 0183 out: targets and own ship as sentences on the topic `nmea`, over UDP and TCP; targets
also as NMEA 2000 and to Signal K.

Each message on `targets_cloud` gives own ship's sentences first, then one TTM for each target, all
for the moment of its stamp. Between scans, own ship's sentences are sent alone. A target that was
lost or has gone is sent once more as lost. A slow receiver never delays the others.
"""

import time
import uuid
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import NavSatFix, PointCloud2
from std_msgs.msg import String

from ..arpa import nmea, nmea2000, nmea_fields, signalk
from ..arpa.nmea_targets import nothing_told, word
from ..files import shown
from ..geometry import NAUTICAL_MILE, unit_vector
from ..parameters import NmeaOutputParameters
from ..tracking import clocks, own_ship
from ..tracking.own_velocity import POSITIONS, TWIST
from . import diagnostics, topics
from .base_node import RunnableNode
from .convert import CLOUD_REASONS, nanoseconds
from .declare import declare
from .diagnostics import ERROR, FAILED, OK, WARN, one_line
from .faults import HEADER_REASONS, ConversionError
from .nmea_output_ais import NO_SENTENCE, AisOutput, contexts
from .nmea_output_input import (
    BAD_FIX,
    FIX_BY_ARRIVAL,
    TIME_BY_ARRIVAL,
    OwnShipInput,
    named,
    own_ship_told,
    read_alerts,
    read_origin,
    read_targets,
)
from .nmea_output_links import Clients, Datagrams

SENTENCES = ('RMC', 'HDT', 'OSD', 'RSD', 'TTM', 'TLL', 'VHW')
SILENT_S = 10.0  # s of the wall without own ship or targets: they count as missing
SERVE_S = 0.2  # s between two looks for new TCP clients
NOT_SENT, REFUSED = 'datagrams not sent', 'datagrams refused, for nobody listens there'
NO_ROOM, TOO_SLOW = 'TCP clients refused for want of room', 'TCP clients dropped as too slow'


class NmeaOutputNode(RunnableNode):
    """See the module. ValueError where the parameters are wrong or a port is taken."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('nmea_output', **node_arguments)
        (p,) = declare(self, NmeaOutputParameters)
        self._settings = p
        self._wanted = p.sentences.split()
        for kind in self._wanted:
            if kind not in SENTENCES:
                raise ValueError(
                    f'parameter sentences has {shown(kind)}; it must be of {", ".join(SENTENCES)}'
                )
        for talker in (p.talker, p.own_ship_talker):
            nmea_fields.sentence(talker, 'HDT', ())  # ValueError for a wrong one
        self._own = OwnShipInput(
            read_origin(p.origin),
            p.own_ship_velocity,
            p.fix_timeout_s,
            (p.gps_ahead_m, p.gps_starboard_m),
            lambda reason, detail: self._bad.add(reason, time.monotonic(), detail=detail),
        )
        self._udp, self._signalk = Datagrams('udp', p.udp), Datagrams('signalk_udp', p.signalk_udp)
        self._bus, self._frames = Datagrams('nmea2000_udp', p.nmea2000_udp), None
        if p.nmea2000_udp:
            self._frames = _encoder()
        self._tcp = Clients('tcp', p.tcp)
        self._told = nothing_told()
        self._heard = {topics.ODOMETRY: -np.inf, topics.TARGETS_CLOUD: -np.inf}  # s of the wall
        self._state, self._state_heard = DiagnosticArray(), -np.inf
        self._said_own = -np.inf
        self._last_ns: int | None = None  # stamp of the last targets
        self._count = {'targets': 0, 'targets waiting for a number': 0, 'sentences': 0}
        self._bad = diagnostics.Tally(
            (
                *map(named, own_ship.OWN_REASONS),
                *HEADER_REASONS,
                *CLOUD_REASONS,
                BAD_FIX,
                FIX_BY_ARRIVAL,
                TIME_BY_ARRIVAL,
                NOT_SENT,
                REFUSED,
                NO_ROOM,
                TOO_SLOW,
                NO_SENTENCE,
            ),
            self.tell,
        )
        # Targets of two radars, or of two runs of different nodes, are different vessels.
        self._vessels = uuid.uuid5(uuid.NAMESPACE_OID, self.get_fully_qualified_name())

        self._mmsi: dict[int, int] = {}  # of the targets by their own numbers
        self._ais = AisOutput(
            self, self._bad, p.pass_ais, self._send, self._tell_vessels if p.signalk_udp else None
        )
        self._topic = self.publisher(String, topics.NMEA, topics.reliable(topics.BURST))
        self._diagnostics = self.publisher(DiagnosticArray, topics.DIAGNOSTICS, topics.reliable())
        for kind, topic, callback, quality in (
            (Odometry, topics.ODOMETRY, self._on_odometry, topics.best_effort()),
            (NavSatFix, topics.FIX, self._on_fix, topics.best_effort()),
            (DiagnosticArray, topics.OWN_SHIP_STATE, self._on_state, topics.best_effort(1)),
            (PointCloud2, topics.TARGETS_CLOUD, self._on_targets, topics.latched(10)),
            (DiagnosticArray, topics.ALARMS, self._on_alarms, topics.latched(10)),
        ):
            self.create_subscription(kind, topic, callback, quality)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(1.0, self._on_second, clock=steady)
        if p.tcp:
            self.create_timer(SERVE_S, self._serve, clock=steady)
        self.get_logger().info(
            one_line(f'{p.sentences} to {p.udp or "no"} UDP, {p.tcp or "no"} TCP')
        )

    def close(self) -> None:
        """A last word on /diagnostics; the clients are let go."""
        self._on_second()
        for link in (self._udp, self._signalk, self._bus, self._tcp):
            link.close()

    # -- in ------------------------------------------------------------------------------------

    def _on_odometry(self, message: Odometry) -> None:
        wall = time.monotonic()
        if not self._own.hear_odometry(message, *self._arrival()):
            return
        self._heard[topics.ODOMETRY] = wall
        if wall - self._said_own >= self._settings.own_ship_period_s:
            self._send(self._own_ship(nanoseconds(message.header.stamp)))

    def _on_state(self, message: DiagnosticArray) -> None:
        self._state, self._state_heard = message, time.monotonic()

    def _on_fix(self, message: NavSatFix) -> None:
        self._own.hear_fix(message, self._arrival()[1])

    def _arrival(self) -> tuple[float, int]:
        """s, ns: now by a clock of ours, simulated where time is, and by the clock of stamps."""
        now_ns = self.get_clock().now().nanoseconds
        simulated = self.get_parameter('use_sim_time').value and now_ns
        return now_ns * 1e-9 if simulated else clocks.steady(), now_ns

    def _on_targets(self, message: PointCloud2) -> None:
        try:
            time_ns = nanoseconds(message.header.stamp)
            heard = read_targets(message)
        except ConversionError as error:
            self._bad.add(error.reason, time.monotonic(), detail=str(error))
            return
        if time_ns == self._last_ns:  # the same once more
            return
        self._last_ns = time_ns
        self._heard[topics.TARGETS_CLOUD] = time.monotonic()
        targets = heard.targets._replace(name=self._ais.named(heard.targets.name, heard.mmsi))
        self._mmsi.update(zip(targets.number.tolist(), heard.mmsi.tolist()))
        self._told, now = word(self._told, targets, self._settings.target_numbers)
        numbers = now.numbers.tolist()
        self._mmsi = {number: self._mmsi.get(number, 0) for number in numbers}
        self._count['targets'] = len(self._told.numbers)
        self._count['targets waiting for a number'] = now.waiting
        p, seconds = self._settings, time_ns * 1e-9
        lines = self._own_ship(time_ns)
        if 'OSD' in self._wanted:
            lines.append(nmea.osd(self._as_told(self._own_data(time_ns)), p.talker))
        relative, slot = heard.relative, self._told.slots.get(heard.reference, 0)
        if 'RSD' in self._wanted:
            up = nmea.HEAD_UP if relative else nmea.NORTH_UP
            lines.append(nmea.rsd(p.range_scale_nm * NAUTICAL_MILE, up, talker=p.talker))
        if 'TTM' in self._wanted:
            lines += nmea.ttm(now.targets, seconds, p.talker, reference=slot, relative=relative)
        bearing = np.full_like(now.targets.range, np.nan) if relative else now.targets.bearing
        latitude, longitude = self._own.target_places(
            time_ns, now.targets.range[:, None] * unit_vector(bearing)
        )
        if 'TLL' in self._wanted:
            lines += nmea.tll(now.targets, latitude, longitude, seconds, p.talker, slot)
        self._send(lines)
        if self._frames:
            frames = self._frames(now.targets._replace(bearing=bearing), seconds, slot)
            self._send_datagrams(self._bus, [f'{frame}\r\n'.encode() for frame in frames])
        if self._signalk.destinations:
            mmsi = [self._mmsi[number] for number in numbers]
            placed = now.targets._replace(bearing=bearing)
            self._tell_vessels(placed, numbers, mmsi, time_ns)

    def _tell_vessels(
        self, targets: nmea.Targets, numbers: list[int], mmsi: list[int], time_ns: int
    ) -> None:
        """Signal K deltas of targets, or of ships of AIS."""
        offset = targets.range[:, None] * unit_vector(targets.bearing)
        latitude, longitude = self._own.target_places(time_ns, offset)
        who = contexts(numbers, mmsi, self._vessels)
        told = signalk.deltas(targets, who, latitude, longitude, time_ns * 1e-9)
        self._send_datagrams(self._signalk, [delta.encode() for delta in told])

    def _on_alarms(self, message: DiagnosticArray) -> None:
        if not self._signalk.destinations:
            return
        alerts = read_alerts(message)
        seconds = self._arrival()[1] * 1e-9
        told = signalk.notifications(alerts, self.get_name(), seconds)
        self._send_datagrams(self._signalk, [delta.encode() for delta in told])

    # -- out -----------------------------------------------------------------------------------

    def _own_data(self, time_ns: int) -> nmea.OwnShipData:
        """Own ship at a time; nothing of her when she was not heard for long."""
        if time.monotonic() - self._heard[topics.ODOMETRY] > SILENT_S:
            return nmea.OwnShipData()
        return self._own.at(time_ns)

    def _as_told(self, own: nmea.OwnShipData) -> nmea.OwnShipData:
        """The same with what the tracker says of her motion."""
        late = time.monotonic() - self._state_heard > SILENT_S
        return own if late else own_ship_told(self._state, own)

    def _own_ship(self, time_ns: int) -> list[str]:
        """RMC and HDT; a void RMC tells that there is no position, HDT is left out then."""
        self._said_own = time.monotonic()
        own, talker = self._own_data(time_ns), self._settings.own_ship_talker
        lines = []
        if 'RMC' in self._wanted:
            lines.append(nmea.rmc(own, time_ns * 1e-9, talker))
        if 'HDT' in self._wanted and np.isfinite(own.heading):
            lines.append(nmea.hdt(own, talker))
        if 'VHW' in self._wanted:
            lines.append(nmea.vhw(self._as_told(own), talker))
        return lines

    def _send(self, lines: list[str]) -> None:
        self._count['sentences'] += len(lines)
        for line in lines:
            self._topic.publish(String(data=line))
        data = [f'{line}\r\n'.encode('ascii') for line in lines]
        self._send_datagrams(self._udp, data)
        self._tcp.send(data)

    def _send_datagrams(self, link: Datagrams, data: list[bytes]) -> None:
        refused = link.refused
        failed = link.send(data)
        if failed:
            self._bad.add(NOT_SENT, time.monotonic(), failed, link.error)
        if link.refused > refused:
            self._bad.add(
                REFUSED,
                time.monotonic(),
                link.refused - refused,
                ' '.join(destination.text for destination in link.destinations),
            )

    def _serve(self) -> None:
        self._tcp.serve()
        for reason, count in ((NO_ROOM, self._tcp.refused), (TOO_SLOW, self._tcp.dropped)):
            if count > self._bad.counts[reason]:
                self._bad.add(reason, time.monotonic(), count - self._bad.counts[reason])

    # -- how it fares --------------------------------------------------------------------------

    def _on_second(self) -> None:
        wall = time.monotonic()
        worries = [
            f'nothing on {topic}: {then}'
            for topic, then in (
                (topics.ODOMETRY, 'RMC void, no HDT'),
                (topics.TARGETS_CLOUD, 'no TTM'),
            )
            if wall - self._heard[topic] > SILENT_S
        ]
        if not worries and self._own.anchor is None:
            worries.append(f'nothing on {topics.FIX} and no parameter origin: RMC void, no TLL')
        age, timeout = self._own.fix_age, self._settings.fix_timeout_s
        if self._own.anchor is not None and age > timeout:
            worries.append(
                f'no good fix for {age:.0f} s: RMC void'
                + (', position estimated (mode E)' if self._own.placed else ', no TLL')
            )
        if self._own.log.off and self._settings.own_ship_velocity != POSITIONS:
            worries.append(
                f"own ship's twist is {self._own.log.off:.1f} m/s off her positions: speed and "
                f'course from {"twist" if self._settings.own_ship_velocity == TWIST else POSITIONS}'
            )
        worries += [f'lately: {reason}' for reason in self._bad.fresh(wall)]
        if self._count['targets waiting for a number']:
            worries.append(
                f'more than {self._settings.target_numbers} targets: some are not told '
                '(parameter target_numbers)'
            )
        values = {
            **self._count,
            'datagrams': self._udp.sent,
            'Signal K datagrams': self._signalk.sent,
            'NMEA 2000 datagrams': self._bus.sent,
            'TCP clients': len(self._tcp),
            **self._bad.counts,
            FAILED: sum(self.failures.counts.values()),
            **self.failures.counts,
        }
        level = WARN if worries else OK
        failing = self.failures.fresh(wall)
        if failing:
            level, worries = ERROR, [f'lately: {", ".join(failing)}']
        self._diagnostics.publish(
            diagnostics.array(
                self.get_clock().now().nanoseconds,
                [
                    diagnostics.status(
                        f'{self.label}: output',
                        self.hardware_id,
                        level,
                        '; '.join(worries) or f'{self._count["targets"]} targets',
                        values,
                    )
                ],
            )
        )


def _encoder() -> nmea2000.Lines:
    try:
        return nmea2000.encoder()
    except ImportError as error:
        raise ValueError(
            'parameter nmea2000_udp asks for the package nmea2000, which is not installed here '
            f'({error}): pip install "marine_tracker[nmea2000]"'
        ) from error
