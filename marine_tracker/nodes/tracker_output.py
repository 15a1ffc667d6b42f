"""Publishes the results of each scan: tracks, extrapolations, targets, markers.

Of a radar that sends sectors the tracks come as the beam sweeps them, targets once a revolution.

Tracks that have no number yet are in `tracks_cloud` only. A message without listeners is not made,
unless it is latched: who comes late is told the last scan, and none before.
"""

from collections.abc import Callable

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import MarkerArray

from ..ais.join import joined_to
from ..arpa.view import view
from ..geometry import wrap_bearing
from ..parameters import TrackerOutputParameters
from ..service import Output, Service, Tracking
from ..tracking.lifecycle import LOST
from ..types import Extrapolation, take
from . import convert, danger_areas_cloud, messages_of_others, targets_cloud, topics
from .base_node import RunnableNode
from .convert import OdometryPool
from .markers import MarkersWriter
from .paced import Paced
from .targets_message import TargetsWriter


class TrackerOutput:
    """The publishers of one tracker node."""

    def __init__(self, node: RunnableNode, hardware_id: str, p: TrackerOutputParameters) -> None:
        burst = topics.reliable(topics.BURST)
        self._to_tracks = node.publisher(Odometry, topics.TRACKS, burst)
        self._to_extrapolations = node.publisher(Odometry, topics.EXTRAPOLATIONS, burst)
        self._to_cloud = node.publisher(PointCloud2, topics.TRACKS_CLOUD, topics.reliable())
        self._to_numeric = node.publisher(PointCloud2, topics.TARGETS_CLOUD, topics.latched())
        self._tell_targets = node.publisher_of_both(
            DiagnosticArray, topics.TARGETS, topics.latched()
        )
        self._to_markers = node.publisher(MarkerArray, topics.MARKERS, topics.reliable(1))
        self._to_areas = node.publisher(PointCloud2, topics.DANGER_AREAS, topics.latched())
        self._pool = OdometryPool()
        self._paced = Paced(node, self._to_tracks) if p.tracks_paced else None
        self._name, self._kinds = node.label, []
        if p.radar_tracks:
            self._kinds = messages_of_others.kinds(
                'radar_tracks', 'radar_msgs.msg', 'RadarTracks', 'RadarTrack'
            )
            self._to_radar_tracks = node.publisher(
                self._kinds[0], topics.RADAR_TRACKS, topics.reliable()
            )
        self._targets = TargetsWriter(hardware_id)
        self._markers = MarkersWriter()

    def publish_tracks(
        self, service: Service, done: Tracking, period: float, stamps: Callable[..., np.ndarray]
    ) -> None:
        """Publishes the tracks that a scan or sector has swept.

        period  s, of the radar's revolution
        stamps  ns, on the radar's clock, of the tracker's times [N] s
        """
        if self._to_cloud.get_subscription_count():  # one message, so first
            self._to_cloud.publish(_cloud(done, int(stamps(done.scan.start))))
        if self._kinds:
            end_ns = int(stamps(done.scan.end))
            self._to_radar_tracks.publish(
                messages_of_others.radar_tracks(self._kinds, done, self._name, end_ns)
            )
        self._publish_tracks(service, done, period, stamps)

    def publish_targets(
        self, service: Service, output: Output, stamps: Callable[..., np.ndarray]
    ) -> None:
        """Publishes the targets after a revolution."""
        end_ns = int(stamps(output.scan.end))
        name = service.tracker.parameters.estimator
        arpa = service.arpa
        seen = view(output.picture, output.report, service.tracker.estimator, output.shapes)
        ships, mmsi = output.ais, None
        if ships is not None:
            row = joined_to(ships.joined, ships.ships, seen.id)
            mmsi = np.where(row >= 0, np.append(ships.ships.mmsi, 0)[row], 0)
        self._to_numeric.publish(targets_cloud.message(seen, output.picture.alerts, end_ns, mmsi))
        symbol = service.ais.parameters.ais_symbol
        end = output.scan.end
        self._tell_targets(self._targets.message(seen, name, end, end_ns, ships, symbol))
        if self._to_areas.get_subscription_count():
            self._to_areas.publish(danger_areas_cloud.message(arpa, output.picture, ships, end_ns))
        if self._to_markers.get_subscription_count():
            self._to_markers.publish(
                self._markers.message(seen, output.picture, arpa.zones, arpa.parameters, end_ns)
            )

    def _publish_tracks(self, service, done, period, stamps) -> None:
        tracks = done.report.tracks
        alive = np.flatnonzero((tracks.number > 0) & (tracks.status != LOST))
        alive = alive[np.argsort(tracks.number[alive])]
        frames = [f'track_{n:02d}' for n in tracks.number[alive].tolist()]
        if self._to_tracks.get_subscription_count():
            estimate = take(done.estimate, alive)
            if self._paced is None:
                self._publish_each(self._to_tracks, stamps, frames, estimate)
            else:
                self._paced.publish(stamps, frames, estimate, period)
        if self._to_extrapolations.get_subscription_count():
            ahead = service.tracker.extrapolate(
                take(tracks, alive), done.report.time[alive] + period
            )
            self._publish_each(self._to_extrapolations, stamps, frames, ahead)

    def _publish_each(self, publisher, stamps, frames, estimate: Extrapolation) -> None:
        for message in self._pool.fill(
            stamps(estimate.time), frames, estimate.position, estimate.velocity, estimate.covariance
        ):
            publisher.publish(message)


def _cloud(done: Tracking, start_ns: int) -> PointCloud2:
    tracks, estimate = done.report.tracks, done.estimate
    velocity = estimate.velocity
    rows = np.zeros(len(tracks.id), convert.TRACK_TYPE)
    rows['id'] = tracks.id
    rows['number'] = tracks.number
    rows['status'] = tracks.status
    rows['time_offset'] = estimate.time - done.scan.start
    rows['x'], rows['y'] = estimate.position.T
    rows['vx'], rows['vy'] = velocity.T
    for name, (row, column) in targets_cloud.COVARIANCE.items():
        rows[name] = estimate.covariance[:, row, column]
    rows['course'] = wrap_bearing(np.arctan2(velocity[:, 0], velocity[:, 1]))
    rows['speed'] = np.hypot(velocity[:, 0], velocity[:, 1])
    return convert.cloud_message(rows, start_ns)
