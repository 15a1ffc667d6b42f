"""The operator's side of the tracker node: targets, alarms, acquisition, trial manoeuvre.

Commands come as topics and services. A service answers if a command is not possible. For a topic
this is logged once and counted on /diagnostics; a click that finds no track is counted too.
Commands take effect at the next scan. `alarms` is published on change: every alert that is not
normal, and those that have just become normal. `alarms_past` has the last that are settled.

Time is that of the plots' stamps. It stops at the end of the last scan. If the next scan is late,
it continues with the wall clock, so that messages in the meantime have a stamp.
"""

import time
from collections import deque
from statistics import median_low

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from std_msgs.msg import UInt32
from std_srvs.srv import SetBool, Trigger

from ..ais.ais import AisPicture
from ..ais.reports import Reports
from ..arpa import acquisition, alarms, alert_list, alerts, sounding
from ..arpa.acquisition import Acquisition
from ..arpa.alerts import NORMAL, Alerts
from ..arpa.arpa import Arpa, Picture
from ..arpa.own_motion import lately, own_motion
from ..arpa.targets import EVENTS, NO_ROOM, NOTHING_THERE, Events
from ..service import Output, Service, Tracking
from ..tracking.own_ship import OwnShipLog
from ..tracking.own_velocity import chosen
from ..types import Array, OwnShip, Scan, append, take
from . import diagnostics, topics
from .alarm_log import AlarmLog
from .arpa_messages import alarms_message, alarms_past_message, trial_message
from .base_node import RunnableNode
from .diagnostics import Tally, answered
from .explanations import Explanations
from .own_sensors import SensorsInput

REFUSED = 'commands refused'
OVERDUE = 3  # revolutions without plots: they are missing, not just to come


class Operator:
    """Of one tracker node: the service, its memory, and what the operator does to it.

    service  what is running
    sensors  own ship's, as heard
    memory   all that it knows; kept nowhere else
    picture  of the last scan; None before the first
    """

    def __init__(
        self, node: RunnableNode, service: Service, sensors: SensorsInput, hardware_id: str
    ) -> None:
        self._node = node
        self._hardware_id = hardware_id
        self.sensors = sensors
        self.service = service
        self.memory = service.start()
        self._settled = alerts.begin()
        self._trial_since: float | None = None  # s, when the trial manoeuvre was switched on
        self.refused = Tally((REFUSED,), node.tell)
        # Of the wall, s: when each was last heard, and between the last plots of each radar.
        self._heard_plots = [time.monotonic()] * len(self.arpa.radars)
        self._revolved = list(self._heard_plots)
        self._spacing = [
            deque([radar.parameters.scan_period_s], maxlen=9) for radar in self.arpa.radars
        ]
        self._scanned = [False] * len(self.arpa.radars)
        self._end, self._end_ns = 0.0, 0  # s, and stamp, of the last scan's end
        self.picture: Picture | None = None

        self._to_alarms = node.publisher(DiagnosticArray, topics.ALARMS, topics.latched())
        self._to_past = node.publisher(DiagnosticArray, topics.ALARMS_PAST, topics.latched())
        self._alarm_log = AlarmLog(node.get_logger())
        self._to_trial = node.publisher(DiagnosticArray, topics.TRIAL, topics.latched())
        for kind, topic, callback in (
            (PointStamped, topics.ACQUIRE, self._on_acquire),
            (PointStamped, topics.CLICKED_POINT, self._on_acquire),
            (UInt32, topics.CANCEL, self._on_cancel),
            (UInt32, f'~/{topics.CANCEL}', self._on_cancel),
            (UInt32, topics.ACKNOWLEDGE_TARGET, self._on_acknowledge_target),
            (UInt32, topics.ACKNOWLEDGE_ALERT, self._on_acknowledge_alert),
        ):
            node.subscription(kind, topic, callback, topics.reliable())
        for own in ('', '~/'):
            node.create_service(Trigger, own + topics.CANCEL_ALL, self._on_cancel_all)
            node.create_service(Trigger, own + topics.ACKNOWLEDGE, self._on_acknowledge)
            node.create_service(Trigger, own + topics.SILENCE, self._on_silence)
        self._explanations = Explanations(
            node, lambda: (self.service, self.memory, self._since_end()), self._point, hardware_id
        )
        node.create_service(SetBool, topics.TRIAL_MANOEUVRE, self._on_trial)

    # -- in ------------------------------------------------------------------------------------

    @property
    def arpa(self) -> Arpa:
        """That of the service."""
        return self.service.arpa

    def change(self, service: Service) -> None:
        """Another service takes over; no target is lost by it."""
        self.memory = service.adopt(self.memory, self.service)
        self.service = service

    def step(self, scan: Scan, end_ns: int, fallback: str) -> tuple[Tracking | None, Output | None]:
        """One scan or sector, which ends at the stamp end_ns, as Service.take; fallback: of own
        ship's place in it.

        Once a revolution the alarms that changed are published, and the trial manoeuvre while it is
        on.
        """
        wall = time.monotonic()
        heading, sensors = self.sensors.told(self.arpa.parameters, self.arpa.radars, fallback)
        self.memory, done, output = self.service.take(self.memory, scan, heading, sensors)
        self._heard_plots[scan.radar] = wall
        if output is None:
            return done, None
        if self._scanned[scan.radar]:
            self._spacing[scan.radar].append(wall - self._revolved[scan.radar])
        self._revolved[scan.radar], self._scanned[scan.radar] = wall, True
        if scan.end >= self._end or self.picture is None:  # of a slow radar they come later
            self._end, self._end_ns = scan.end, end_ns
        self.picture = output.picture
        self._explanations.take(output)
        self._publish_alarms(self.picture.changed)
        self._tell_of_clicks(self.picture.events)
        if self._trial_since is not None:
            self._to_trial.publish(
                trial_message(
                    self.arpa,
                    self.picture,
                    output.ais,
                    scan.end - self._trial_since,
                    end_ns,
                    self._hardware_id,
                )
            )
        return done, output

    def hear_ais(self, reports: Reports, position: Array) -> None:
        """Reports of AIS, as Service.hear."""
        self.memory = self.service.hear(self.memory, reports, position)

    def activate_ais(self, mmsi: int, awake: bool) -> None:
        """Activates a ship of AIS, or puts it to sleep. ValueError if there is none."""
        ais = self.service.ais.activate(self.memory.ais, mmsi, awake)
        self.memory = self.memory._replace(ais=ais)

    def ais_alone(self, own: OwnShipLog) -> tuple[AisPicture | None, int]:
        """The ships of AIS, and the stamp, where radar is silent; None where it is not, or where
        own ship was not heard either."""
        now, heard = self._now(), bool(len(self.memory.ais.ships.id))
        if not heard or not self._since_end() or not len(own.taken.time):
            return None, 0
        told = own.taken
        velocity, _ = chosen(told, own.off, self.arpa.radars[0].parameters.own_ship_velocity)
        samples = lately(self.memory.arpa.own, OwnShip(told.time, told.position, velocity), now)
        heading, sensors = self.sensors.told(self.arpa.parameters, self.arpa.radars, '')
        at = own_motion(samples, now, heading)._replace(north=sensors.north)
        self.memory, ships, changed = self.service.without_radar(self.memory, at, now, sensors)
        self._publish_alarms(changed)
        return ships, self._stamp()

    def watch(self, speed_off: float) -> None:
        """To be called every second: are heading, position and plots still heard?

        speed_off  m/s, how far own ship's velocity as told is off that of her positions
        """
        wall = time.monotonic()
        heading, position, log = self.sensors.silent(wall, self.arpa.parameters)
        bow_only = not self.sensors.told(self.arpa.parameters, self.arpa.radars, '')[1].north
        silence = alarms.Silence(heading, position, self._overdue(wall), speed_off, log, bow_only)
        found, changed = alarms.watch(
            self.memory.arpa.alerts, self.arpa.alarms, silence, self._now()
        )
        self._put(alerts=found)
        self._publish_alarms(changed)

    def _put(self, **parts) -> None:
        """Replace parts of the ARPA's memory."""
        self.memory = self.memory._replace(arpa=self.memory.arpa._replace(**parts))

    def _overdue(self, wall: float) -> tuple[float, ...]:
        """s without plots of each radar; 0 while the next may still be to come: antennas and
        replays differ."""
        return tuple(
            wall - heard if wall - heard > OVERDUE * median_low(spacing) else 0.0
            for heard, spacing in zip(self._heard_plots, self._spacing, strict=True)
        )

    def _since_end(self) -> float:
        """s since the last scan's end, once the next of every radar is overdue."""
        return min(self._overdue(time.monotonic()))

    def _now(self) -> float:
        return self._end + self._since_end()

    # -- commands ------------------------------------------------------------------------------

    def _on_acquire(self, message: PointStamped) -> None:
        try:
            acquired = acquisition.acquire(
                self.memory.arpa.acquisition, self._point(message), self._end
            )
        except ValueError as error:
            self._refuse(str(error))
        else:
            self._put(acquisition=acquired)

    def _point(self, message: PointStamped) -> Array:
        """Position [2] m in the frame `map`."""
        frame, point = message.header.frame_id, np.array([message.point.x, message.point.y])
        if frame in ('', topics.FRAME):
            return point
        if frame != topics.OWN_SHIP_FRAME:
            raise ValueError(
                f'the point is in frame {frame!r}; it must be '
                f'{topics.FRAME} or {topics.OWN_SHIP_FRAME}'
            )
        heading = self.sensors.heading
        if self.picture is None or not np.isfinite(heading):
            raise ValueError(
                f'a point in {topics.OWN_SHIP_FRAME} cannot be taken before '
                "plots came, or without own ship's heading"
            )
        ahead = np.array([np.sin(heading), np.cos(heading)])
        port = np.array([-ahead[1], ahead[0]])
        return self.picture.own.position + point[0] * ahead + point[1] * port

    def _on_cancel(self, message: UInt32) -> None:
        try:
            acquired, events = acquisition.cancel(self.memory.arpa.acquisition, message.data)
        except ValueError as error:
            self._refuse(str(error))
        else:
            self._cancelled(acquired, events)

    @answered
    def _on_cancel_all(self, _: Trigger.Request) -> str:
        acquired, events = acquisition.cancel_all(self.memory.arpa.acquisition)
        self._cancelled(acquired, events)
        return f'{len(events.id)} targets cancelled'

    def _cancelled(self, acquired: Acquisition, events: Events) -> None:
        found, changed = alerts.dismiss(self.memory.arpa.alerts, events.id, self._now())
        self._put(acquisition=acquired, alerts=found)
        self._publish_alarms(changed)

    @answered
    def _on_acknowledge(self, _: Trigger.Request) -> str:
        return f'{self._acknowledge()} alerts acknowledged'

    def _on_acknowledge_target(self, message: UInt32) -> None:
        self._acknowledge_one(number=message.data)

    def _on_acknowledge_alert(self, message: UInt32) -> None:
        self._acknowledge_one(instance=message.data)

    def _acknowledge_one(self, **which: int) -> None:
        try:
            self._acknowledge(**which)
        except ValueError as error:
            self._refuse(str(error))

    @answered
    def _on_silence(self, _: Trigger.Request) -> str:
        found, changed = sounding.silence(self.memory.arpa.alerts, self._now())
        self._put(alerts=found)
        self._publish_alarms(changed)
        return f'{len(changed.kind)} alerts silenced for {sounding.SILENT:.0f} s'

    def _acknowledge(self, **which: int) -> int:
        found, changed = alarms.acknowledge(
            self.memory.arpa.alerts,
            self._now(),
            duration=60 * self.arpa.parameters.acknowledge_for_min,
            **which,
        )
        self._put(alerts=found)
        self._publish_alarms(changed)
        return len(changed.kind)

    @answered
    def _on_trial(self, request: SetBool.Request) -> str:
        if request.data:
            self._trial_since = self._end
            return f'trial manoeuvre on; see the topic {topics.TRIAL}'
        self._trial_since = None
        self._to_trial.publish(diagnostics.array(self._stamp(), []))
        return 'trial manoeuvre off'

    def _tell_of_clicks(self, events: Events) -> None:
        for kind, position in zip(events.kind.tolist(), events.position.tolist()):
            if kind in (NOTHING_THERE, NO_ROOM):
                self._refuse(
                    f'acquire at east {position[0]:.0f} m, north {position[1]:.0f} m: '
                    f'{EVENTS[kind]}'
                )

    def _refuse(self, reason: str) -> None:
        self.refused.add(REFUSED, time.monotonic(), detail=reason)

    # -- out -----------------------------------------------------------------------------------

    def _publish_alarms(self, changed: Alerts) -> None:
        if len(changed.kind):
            present = self.memory.arpa.alerts
            shown = append(
                take(present, present.state != NORMAL), take(changed, changed.state == NORMAL)
            )
            radars = [radar.name for radar in self.arpa.radars]
            self._alarm_log.tell(changed, self.arpa.zones, radars)
            about = self.arpa.zones, radars, self._now(), self._stamp(), self._hardware_id
            self._to_alarms.publish(alarms_message(alert_list.in_order(shown, alarms.RANK), *about))
            if (changed.state == NORMAL).any():
                self._settled = alert_list.settled(self._settled, changed)
                self._to_past.publish(alarms_past_message(self._settled, *about))

    def _stamp(self) -> int:
        """ns of now; of the node's clock before the first scan."""
        if not self._end_ns:
            return self._node.get_clock().now().nanoseconds
        return self._end_ns + round(self._since_end() * 1e9)
