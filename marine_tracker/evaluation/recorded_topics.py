"""Recorded topics as the scans that the tracker node made of them: the same screen, the same clock.

A recorder keeps when each message came. So the scans, and the tracks on them, are those of the live
run. Where the parameters were changed meanwhile, the tracks are those with the parameters at the
beginning; a remark tells it.
"""

from collections import Counter
from functools import partial

import numpy as np

from ..files import Place
from ..geometry import own_ship_at
from ..parameters import ArpaParameters, TrackerParameters, from_mapping
from ..recording import mcap_topics
from ..recording.csv_folder import Recording
from ..recording.mcap_topics import CHANGES, OWN_SHIP, TRUTH, Contents, Event
from ..recording.message_faults import ConversionError, bare, check_frame
from ..recording.ros_messages import (
    FRAME,
    cloud_to_gaps,
    cloud_to_plots,
    heading_of_odometry,
    nanoseconds,
    odometry_to_own_ship,
)
from ..tracking import own_ship
from ..tracking.radars import Radar, radars_of
from ..tracking.scan_input import Came, ScanInput
from ..types import OwnShip, Scan, Truth, append

NOT_KNOWN = np.full(2, np.nan)
OWN_FRAME = 'base_link'


def read(path: Place) -> tuple[Recording, tuple[str, ...]]:
    """A recording of one radar or several, and what people should know of it.

    ValueError if there are no plots in it.
    """
    inside = mcap_topics.contents(path)
    parameters = inside.of(TrackerParameters)
    heard = _Heard(inside, from_mapping(TrackerParameters, parameters))
    for event in inside.events(OWN_SHIP, TRUTH, CHANGES, *heard.inputs):
        heard.take(event)
    if not heard.scans:
        raise ValueError(f'{path}: no scan can be taken; {heard.rejected or "no plots"}')
    samples = [own_ship_at(scan.own_ship, scan.start) for scan in heard.scans]
    position, velocity = (np.array(part) for part in zip(*samples))
    remarks = [*inside.files.remarks]
    if heard.rejected:
        remarks.append(f'recording {path}; rejected: {heard.rejected}')
    if heard.changed:
        remarks.append(
            f"recording {path}: the tracker's parameters were changed {heard.changed} times; "
            'here they stay as they were first'
        )
    return (
        Recording(
            str(path).rstrip('/').rpartition('/')[2],
            tuple(heard.scans),
            tuple(_truth(rows) for rows in heard.truths),
            parameters,
            {'begin_s': heard.begin_ns * 1e-9, 'arpa': inside.of(ArpaParameters)},
            np.arange(len(heard.scans)),
            OwnShip(np.array([scan.start for scan in heard.scans]), position, velocity),
        ),
        tuple(remarks),
    )


class _Heard:
    """What a tracker node would have taken, message by message."""

    def __init__(self, inside: Contents, parameters: TrackerParameters) -> None:
        self._inside, self._counts = inside, Counter[str]()
        self.inputs = {
            radar.topic: ScanInput(radar, place, partial(self._count, radar))
            for place, radar in enumerate(radars_of(parameters))
        }
        self._by_topic = {inside.full(topic): one for topic, one in self.inputs.items()}
        self._log, self._own_frame = own_ship.empty_log(), OWN_FRAME
        self._base: int | None = None
        self._heading = np.nan
        self.scans: list[Scan] = []
        self.truths: list[list[Truth]] = []
        self.changed = 0

    @property
    def rejected(self) -> str:
        """How many of what; '' for none."""
        return ', '.join(f'{count} {reason}' for reason, count in self._counts.items())

    @property
    def begin_ns(self) -> int:
        """The stamp of time 0."""
        return self._base or 0

    def take(self, event: Event) -> None:
        """The next message."""
        try:
            if event.topic in self._by_topic:
                self._plots(event, self._by_topic[event.topic])
            elif event.topic == self._inside.full(OWN_SHIP):
                self._own_ship(event)
            elif event.topic == CHANGES:
                node = self._inside.files.settings.get('tracker_node', '')
                names = {one.name for one in event.message.changed_parameters}
                self.changed += event.message.node == node and bool(names)
            elif self.truths:
                self._truth(event)
        except ConversionError as error:
            self._counts[error.reason] += 1

    def _count(self, radar: Radar, reason: str, count: int, detail: str) -> None:
        self._counts[f'{radar.name}: {reason}' if radar.name else reason] += count

    def _seconds(self, time_ns: int) -> float:
        if self._base is None:
            self._base = time_ns
        return (time_ns - self._base) * 1e-9

    def _own_ship(self, event: Event) -> None:
        message = event.message
        check_frame(message.header.frame_id, (FRAME,))
        time_ns = nanoseconds(message.header.stamp) or event.log_ns
        position, velocity = odometry_to_own_ship(message)
        heading = heading_of_odometry(message, doubtful=self._log.off > 0)
        self._log, reason = own_ship.admit_own_ship(
            self._log, self._seconds(time_ns), position, velocity, event.log_ns * 1e-9, heading
        )
        if reason:
            self._counts[reason] += 1
        if reason in ('', own_ship.OWN_REBASED) and bare(message.child_frame_id) not in ('', FRAME):
            self._own_frame = bare(message.child_frame_id)
        if np.isfinite(heading):
            self._heading = heading

    def _plots(self, event: Event, heard: ScanInput) -> None:
        message = event.message
        check_frame(message.header.frame_id, (FRAME, OWN_FRAME, self._own_frame))
        stamp, plots = nanoseconds(message.header.stamp), cloud_to_plots(message)
        found = heard.scan_of(
            plots,
            Came(event.log_ns * 1e-9, event.log_ns, stamp, self._seconds),
            self._log,
            [other.order for other in self.inputs.values() if other is not heard],
            NOT_KNOWN,
            self._heading,
            cloud_to_gaps(message),
        )
        if found is not None:
            scan, _, self._log = found
            self.scans.append(scan)
            self.truths.append([])

    def _truth(self, event: Event) -> None:
        found = mcap_topics.TARGET.fullmatch(event.message.child_frame_id)
        if found is None:
            return
        position, velocity = odometry_to_own_ship(event.message)
        time = self._seconds(nanoseconds(event.message.header.stamp))
        self.truths[-1].append(
            Truth(np.array([time]), np.array([int(found[1])]), position[None], velocity[None])
        )


def _truth(rows: list[Truth]) -> Truth:
    together = Truth(np.zeros(0), np.zeros(0, np.int64), np.zeros((0, 2)), np.zeros((0, 2)))
    for row in rows:
        together = append(together, row)
    return together
