"""Messages of packages that may not be installed: radar_msgs in and out, and transforms.

Each is asked for by a parameter. ValueError where its package is not there: what runs and does
nothing would be worse.
"""

import importlib
import math
import uuid
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import Point, TransformStamped, Vector3
from nav_msgs.msg import Odometry
from rclpy.node import Node

from ..service import Tracking
from ..tracking.lifecycle import LOST
from ..types import Array, Extrapolation, PolarPlots, take
from .convert import header, heading_of_odometry
from .faults import BAD_LAYOUT, WRONG_FRAME, ConversionError, bare
from .topics import FRAME, OWN_SHIP_FRAME

UNKNOWN = 32_000  # radar_msgs/RadarTrack: NO_CLASSIFICATION begins here
BOW = 'bow'  # of the parameter bearings


def kinds(parameter: str, package: str, *names: str) -> list[type[Any]]:
    """The classes of a package, for which a parameter asks."""
    try:
        module = importlib.import_module(package)
        return [getattr(module, name) for name in names]
    except (ImportError, AttributeError) as error:
        raise ValueError(
            f'parameter {parameter} asks for {package}, which is not installed here ({error})'
        ) from error


def transforms(node: Node) -> Callable[[Odometry], None]:
    """Sends `map` -> `base_link` for each odometry of own ship that has a heading."""
    (kind,) = kinds('broadcast_tf', 'tf2_ros', 'TransformBroadcaster')
    broadcaster = kind(node)

    def send(message: Odometry) -> None:
        if math.isfinite(heading_of_odometry(message)):
            broadcaster.sendTransform(transform(message))

    return send


def transform(message: Odometry) -> TransformStamped:
    """The pose of an odometry as a transform of own ship's frame."""
    sent = TransformStamped(child_frame_id=bare(message.child_frame_id) or OWN_SHIP_FRAME)
    sent.header.stamp = message.header.stamp
    sent.header.frame_id = FRAME
    place, pose = sent.transform.translation, message.pose.pose.position
    place.x, place.y, place.z = pose.x, pose.y, pose.z
    sent.transform.rotation = message.pose.pose.orientation
    return sent


def radar_tracks(kinds: Sequence[type[Any]], done: Tracking, node: str, time_ns: int) -> Any:
    """radar_msgs/RadarTracks of the tracks with a number, in `map`.

    kinds  RadarTracks and RadarTrack
    node   of the tracker: with the track's id it makes the UUID, the same for the track's life
    """
    tracks = done.report.tracks
    alive = np.flatnonzero((tracks.number > 0) & (tracks.status != LOST))
    estimate = take(done.estimate, alive)
    kind, track_kind = kinds
    message = kind(header=header(time_ns))
    namespace = uuid.uuid5(uuid.NAMESPACE_OID, node)
    shapes = done.shapes
    for row, (n, id_) in enumerate(zip(alive.tolist(), tracks.id[alive].tolist())):
        track = track_kind(classification=UNKNOWN)
        track.uuid.uuid = np.frombuffer(uuid.uuid5(namespace, str(id_)).bytes, np.uint8)
        (x, y), (vx, vy) = estimate.position[row].tolist(), estimate.velocity[row].tolist()
        track.position, track.velocity = Point(x=x, y=y), Vector3(x=vx, y=vy)
        if shapes is not None and shapes.extended[n]:
            track.size = Vector3(x=float(shapes.length[n]), y=float(shapes.beam[n]))
        track.position_covariance = _six(estimate, row, 0)
        track.velocity_covariance = _six(estimate, row, 2)
        message.tracks.append(track)
    return message


def _six(estimate: Extrapolation, row: int, first: int) -> Array:
    """xx, xy, xz, yy, yz, zz of position (first 0) or velocity (2)."""
    part = estimate.covariance[row, first : first + 2, first : first + 2]
    return np.array([part[0, 0], part[0, 1], 0.0, part[1, 1], 0.0, 0.0], np.float32)


def scan_to_plots(message: Any, bearings: str) -> PolarPlots:
    """The plots of a radar_msgs/RadarScan; all have the time of the stamp.

    bearings  the radar's parameter: `bow` where azimuths count from own ship's bow

    Azimuths go anticlockwise: from east in `map`, else from ahead. The Doppler velocities are
    relative to the antenna; they are not used.
    """
    found = [(one.range, one.azimuth, one.amplitude) for one in message.returns]
    range_, azimuth, amplitude = np.array(found, float).reshape(-1, 3).T
    in_map = bare(message.header.frame_id) in ('', FRAME)
    if in_map == (bearings == BOW):
        wanted = 'own ship' if bearings == BOW else FRAME
        raise ConversionError(
            WRONG_FRAME,
            f'a RadarScan in {message.header.frame_id!r}; with bearings {bearings} it must be in '
            f'that of {wanted}',
        )
    if not np.isfinite(azimuth).all():
        raise ConversionError(BAD_LAYOUT, 'an azimuth is not finite')
    turned = (np.pi / 2 - azimuth if in_map else -azimuth) % (2 * np.pi)
    return PolarPlots(np.zeros(len(range_)), range_, turned, np.nan_to_num(amplitude))
