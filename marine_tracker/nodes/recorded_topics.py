"""What the recorder hears: the topics of this package with their own quality of service, and others
by the quality that their publishers have now."""

import importlib
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, TwistStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log, ParameterEvent
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image, NavSatFix, PointCloud, PointCloud2
from std_msgs.msg import String, UInt32
from visualization_msgs.msg import MarkerArray

from . import topics
from .topics import latched, reliable

DEPTH = 200
SILENT_S = 10.0


class Wanted(NamedTuple):
    """A topic to record.

    kind     the class of its messages
    quality  as it is asked for
    steady   whether silence of a publisher is a fault
    """

    name: str
    kind: type[Any]
    quality: QoSProfile
    steady: bool = False


def of_this_package(plots: list[str], without: list[str]) -> list[Wanted]:
    """The topics of all nodes here; plots: those of plots; without: those that are left out."""
    deep = reliable(DEPTH)
    burst = reliable(5 * topics.BURST)
    found = [
        *(Wanted(name, PointCloud2, deep, True) for name in plots),
        Wanted(topics.SPOKES, PointCloud2, deep),
        Wanted(topics.IMAGE, Image, deep),
        Wanted(topics.PLOTS_READABLE, PointCloud, deep),
        Wanted(topics.ODOMETRY, Odometry, deep, True),
        Wanted(topics.FIX, NavSatFix, deep),
        Wanted(topics.LOG, TwistStamped, deep),
        Wanted(topics.OWN_SHIP_STATE, DiagnosticArray, latched(DEPTH)),
        Wanted(topics.TRUTH, Odometry, burst),
        Wanted(topics.AIS_SIMULATED, String, burst),
        Wanted(topics.AIS_SENTENCES, String, burst),
        Wanted(topics.AIS_REPORTS, PointCloud2, deep),
        Wanted(topics.AIS_TARGETS, PointCloud2, latched(DEPTH)),
        Wanted(topics.TRACKS, Odometry, burst),
        Wanted(topics.EXTRAPOLATIONS, Odometry, burst),
        Wanted(topics.TRACKS_CLOUD, PointCloud2, deep, True),
        Wanted(topics.TARGETS, DiagnosticArray, latched(DEPTH)),
        Wanted(topics.TARGETS_CLOUD, PointCloud2, latched(DEPTH), True),
        Wanted(topics.MARKERS, MarkerArray, deep),
        Wanted(topics.ALARMS, DiagnosticArray, latched(DEPTH)),
        Wanted(topics.ALARMS_PAST, DiagnosticArray, latched(DEPTH)),
        Wanted(topics.TRIAL, DiagnosticArray, latched(DEPTH)),
        Wanted(topics.DANGER_AREAS, PointCloud2, latched(DEPTH)),
        Wanted(topics.ACQUIRE, PointStamped, deep),
        Wanted(topics.CLICKED_POINT, PointStamped, deep),
        *(Wanted(name, UInt32, deep) for name in topics.NUMBERS),
        Wanted(topics.EXPLAIN, PointStamped, deep),
        Wanted(topics.EXPLANATION, DiagnosticArray, deep),
        Wanted(topics.VIDEO_EXPLANATION, DiagnosticArray, deep),
        Wanted(topics.NMEA, String, burst),
        Wanted(topics.DIAGNOSTICS, DiagnosticArray, deep),
        Wanted('/rosout', Log, reliable(1000)),
        Wanted('/parameter_events', ParameterEvent, reliable(1000)),
        Wanted(topics.CLOCK, Clock, reliable(DEPTH)),
    ]
    names = {one.name for one in found}
    unknown = [name for name in without if name not in names]
    if unknown:
        raise ValueError(
            f'parameter without has {unknown[0]!r}; it must be of {", ".join(sorted(names))}'
        )
    return [one for one in found if one.name not in without]


def of_others(node: Node, name: str) -> Wanted | None:
    """A topic of somebody else, as it is published now; None while nobody publishes it.

    ValueError if its type is not installed here.
    """
    publishers = node.get_publishers_info_by_topic(node.resolve_topic_name(name))
    if not publishers:
        return None
    kind = publishers[0].topic_type
    package, _, short = kind.partition('/msg/')
    try:
        found = getattr(importlib.import_module(f'{package}.msg'), short)
    except (ImportError, AttributeError, ValueError):
        raise ValueError(f'{name}: its type {kind} is not installed here') from None
    return Wanted(name, found, matched([one.qos_profile for one in publishers]))


def matched(offered: list[QoSProfile]) -> QoSProfile:
    """The best quality that all publishers offer."""
    sure = all(one.reliability == ReliabilityPolicy.RELIABLE for one in offered)
    kept = all(one.durability == DurabilityPolicy.TRANSIENT_LOCAL for one in offered)
    return QoSProfile(
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if sure else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE,
    )


def hears(quality: QoSProfile, offered: list[QoSProfile]) -> bool:
    """Whether a subscription of that quality hears all these publishers."""
    best = matched(offered)
    return not (
        (
            quality.reliability == ReliabilityPolicy.RELIABLE
            and best.reliability != ReliabilityPolicy.RELIABLE
        )
        or (
            quality.durability == DurabilityPolicy.TRANSIENT_LOCAL
            and best.durability != DurabilityPolicy.TRANSIENT_LOCAL
        )
    )


def described(quality: QoSProfile) -> str:
    """As rosbag2 writes it: YAML."""
    forever = '{sec: 9223372036, nsec: 854775807}'
    lines = [
        'history: keep_last',
        f'depth: {quality.depth}',
        f'reliability: {quality.reliability.short_key}',
        f'durability: {quality.durability.short_key}',
        f'deadline: {forever}',
        f'lifespan: {forever}',
        'liveliness: automatic',
        f'liveliness_lease_duration: {forever}',
        'avoid_ros_namespace_conventions: false',
    ]
    return '- ' + '\n  '.join(lines) + '\n'
