"""The ROS graph: who publishes and who listens, found without sending anything.

`python -m marine_tracker.nodes.graph SECONDS NAMESPACE` prints it as JSON. It runs as a process of
its own, because a middleware that cannot start may end the process or hang instead of raising.
"""

import json
import sys
import time
from collections.abc import Iterable
from typing import NamedTuple

from rclpy.node import Node
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rclpy.utilities import get_rmw_implementation_identifier

from . import topics
from .visitor import visitor

NODE = 'marine_tracker_doctor'
NEEDED = (topics.PLOTS, topics.ODOMETRY, topics.TRACKS)
CLOUD = 'sensor_msgs/msg/PointCloud2'
NOT_YET_NAMED = '_NODE_NAME_UNKNOWN_'  # of an endpoint whose node is not discovered yet


class Ends(NamedTuple):
    """Number of publishers and of listeners of a topic."""

    publishers: int
    subscribers: int


class Graph(NamedTuple):
    """The graph as seen.

    middleware  the RMW implementation in use
    nodes       names of the other nodes, with their namespaces
    topics      endpoints by the full names of the requested topics
    """

    middleware: str
    nodes: tuple[str, ...]
    topics: dict[str, Ends]


def look(seconds: float, namespace: str = '/', names: Iterable[str] = NEEDED) -> Graph:
    """Listens until every topic has a publisher, at most `seconds`; discovery takes 0.1 to 3 s.

    namespace  of relative names; `/` for the root
    names      `radar/plots` means any topic of plots that a tracker there listens to
    Raises the exceptions of rclpy if no middleware can be started.
    """
    with visitor(NODE, namespace) as (node, executor):
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0 and not _all_published(
            node, _full_names(node, names)
        ):
            executor.spin_once(timeout_sec=min(0.1, left))
        return Graph(
            get_rmw_implementation_identifier(),
            tuple(
                sorted(
                    f'{where.rstrip("/")}/{name}'
                    for name, where in node.get_node_names_and_namespaces()
                    if name != NODE and not name.startswith('_')
                )
            ),
            {
                name: Ends(node.count_publishers(name), node.count_subscribers(name))
                for name in _full_names(node, names)
            },
        )


def _full_names(node: Node, names: Iterable[str]) -> list[str]:
    full: list[str] = []
    for name in names:
        heard = _heard_by_trackers(node) if name == topics.PLOTS else []
        full += heard or [node.resolve_topic_name(name)]
    return full


def _heard_by_trackers(node: Node) -> list[str]:
    """Cloud topics that the publishers of tracks listen to: one for each radar."""
    trackers = {
        _name(end)
        for end in node.get_publishers_info_by_topic(node.resolve_topic_name(topics.TRACKS))
    }
    return sorted(
        topic
        for topic, kinds in node.get_topic_names_and_types()
        if CLOUD in kinds
        and any(
            _name(end) in trackers and end.node_name != NOT_YET_NAMED
            for end in node.get_subscriptions_info_by_topic(topic)
        )
    )


def _name(end: TopicEndpointInfo) -> tuple[str, str]:
    return end.node_namespace, end.node_name


def _all_published(node: Node, names: list[str]) -> bool:
    publishers = [node.get_publishers_info_by_topic(name) for name in names]
    return all(publishers) and all(
        end.node_name != NOT_YET_NAMED for ends in publishers for end in ends
    )


if __name__ == '__main__':
    print(json.dumps(look(float(sys.argv[1]), sys.argv[2])._asdict()))
