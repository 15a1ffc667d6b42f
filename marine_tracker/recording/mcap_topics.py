"""What is in an MCAP file for a tracker: plots, own ship, truth, and the tracker's parameters."""

import dataclasses
import json
import re
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from ..files import Place
from ..geodesy import LocalFrame
from ..types import Array, OwnShip, PolarPlots, Scan, Truth
from .mcap_read import McapFiles
from .message_faults import ConversionError
from .ros_messages import (
    cloud_to_gaps,
    cloud_to_plots,
    heading_of_odometry,
    nanoseconds,
    odometry_to_own_ship,
)

PLOTS, OWN_SHIP, TRUTH, FIX = 'radar/plots', 'own_ship/odometry', 'truth', 'own_ship/fix'
CLOUD = 'sensor_msgs/msg/PointCloud2'
CHANGES = '/parameter_events'
TARGET = re.compile(r'target_(\d{1,9})')


class Event(NamedTuple):
    """One message: topic, when it came, ns, and its content."""

    topic: str
    log_ns: int
    message: Any


class Contents(NamedTuple):
    """Where a tracker finds its input in the files.

    namespace   of the tracker, as /radar_1 or ''
    parameters  of the tracker, as it had them; empty if the files do not tell
    """

    files: McapFiles
    namespace: str
    parameters: dict[str, Any]

    def events(self, *topics: str) -> Iterator[Event]:
        """The messages of topics, relative to the namespace, that can be decoded, in order."""
        for message, content in self.files.decoded([self.full(topic) for topic in topics]):
            yield Event(message.topic, message.log_ns, content)

    def of(self, kind: type) -> dict[str, Any]:
        """The recorded parameters that are fields of this class."""
        names = {field.name for field in dataclasses.fields(kind)}
        return {name: value for name, value in self.parameters.items() if name in names}

    def full(self, topic: str) -> str:
        """The full name of a topic."""
        return topic if topic.startswith('/') else f'{self.namespace}/{topic}'


class Revolution(NamedTuple):
    """A scan as it was published, the targets that the simulator told, own ship's samples before
    its end."""

    scan: Scan
    truth: Truth
    own_ship: OwnShip


def contents(path: Place) -> Contents:
    """ValueError if there are no plots in it, or of several radars and it is not told which."""
    files = McapFiles(path)
    told = files.settings.get('tracker')
    if told is not None:
        try:
            parameters = json.loads(told)
        except ValueError as error:
            raise ValueError(f'{path}: the parameters of its tracker: {error}') from error
        if not isinstance(parameters, dict):
            raise ValueError(f'{path}: the parameters of its tracker are no mapping')
        namespace = files.settings.get('tracker_node', '/tracker').rpartition('/')[0]
        return Contents(files, namespace, parameters)
    found = [
        name.removesuffix(f'/{PLOTS}')
        for name, about in files.topics.items()
        if name.endswith(f'/{PLOTS}') and about.kind == CLOUD
    ]
    if not found:
        raise ValueError(
            f'{path} has no plots: no topic {PLOTS} among {len(files.topics)}'
            + ''.join(f'; {remark}' for remark in files.remarks)
        )
    if len(found) > 1:
        raise ValueError(
            f'{path} has plots of several radars ({", ".join(sorted(found))}), and no parameters '
            'of their tracker: record with the tracker running'
        )
    return Contents(files, found[0], {})


def revolutions(inside: Contents, plots: str = PLOTS) -> list[Revolution]:
    """All that a radar and own ship published, as it was; times are s after the first stamp.

    A message that cannot be read is left out. ValueError if no plots can be.
    """
    scans: list[tuple[float, PolarPlots, Array | None]] = []
    own: list[tuple[int, float, Any, Any, float]] = []  # before which scan, s, m, m/s, rad
    truths: list[tuple[int, float, int, Any, Any]] = []  # of which scan
    base: int | None = None
    for event in inside.events(plots, OWN_SHIP, TRUTH):
        try:
            stamp = nanoseconds(event.message.header.stamp)
            base = stamp if base is None else base
            time = (stamp - base) * 1e-9
            if event.topic == inside.full(plots):
                scans.append((time, cloud_to_plots(event.message), cloud_to_gaps(event.message)))
                continue
            position, velocity = odometry_to_own_ship(event.message)
        except ConversionError:
            continue
        if event.topic == inside.full(OWN_SHIP):
            if np.isfinite(position).all():
                heading = heading_of_odometry(event.message)
                own.append((len(scans), time, position, np.nan_to_num(velocity), heading))
        elif scans and (found := TARGET.fullmatch(event.message.child_frame_id)):
            truths.append((len(scans) - 1, time, int(found[1]), position, velocity))
    if not scans:
        raise ValueError(f'{inside.full(plots)}: no message can be read')
    result: list[Revolution] = []
    for k, (start, of_scan, gaps) in enumerate(scans):
        samples = _own_ship([row[1:] for row in own if row[0] == k] or [_last(own, k, start)])
        end = start + float(of_scan.time.max(initial=0.0))
        if k + 1 < len(scans) and scans[k + 1][0] > start:
            end = min(max(end, scans[k + 1][0]), start + 60.0)
        elif k and start > scans[k - 1][0]:
            end = max(end, 2 * start - scans[k - 1][0])
        scan = Scan(start, end, of_scan._replace(time=of_scan.time + start), samples, unswept=gaps)
        result.append(Revolution(scan, _truth([row[1:] for row in truths if row[0] == k]), samples))
    return result


def origin(inside: Contents) -> LocalFrame | None:
    """Where the zero of `map` is on Earth, by the first fix; None without one."""
    position = np.zeros(2)
    for event in inside.events(OWN_SHIP, FIX):
        if event.topic == inside.full(OWN_SHIP):
            position, _ = odometry_to_own_ship(event.message)
        elif abs(event.message.latitude) <= 90 and abs(event.message.longitude) <= 180:
            here = LocalFrame(event.message.latitude, event.message.longitude)
            latitude, longitude = here.to_geodetic(-position)
            return LocalFrame(float(latitude), float(longitude))
    return None


def _last(own: list[Any], k: int, start: float) -> tuple[Any, ...]:
    """Own ship's sample before scan k; at rest at the origin before the first."""
    before = [row[1:] for row in own if row[0] < k]
    return before[-1] if before else (start, np.zeros(2), np.zeros(2), np.nan)


def _own_ship(rows: list[Any]) -> OwnShip:
    time, position, velocity, heading = zip(*rows)
    return OwnShip(np.array(time), np.array(position), np.array(velocity), np.array(heading))


def _truth(rows: list[Any]) -> Truth:
    if not rows:
        return Truth(np.zeros(0), np.zeros(0, np.int64), np.zeros((0, 2)), np.zeros((0, 2)))
    time, target, position, velocity = zip(*rows)
    return Truth(np.array(time), np.array(target), np.array(position), np.array(velocity))
