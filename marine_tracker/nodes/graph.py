"""What is on the ROS graph: who publishes and who listens, found without sending anything."""

import time
from collections.abc import Iterable
from typing import NamedTuple

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import get_rmw_implementation_identifier

from . import topics

NODE = 'marine_tracker_doctor'
NEEDED = (topics.PLOTS, topics.ODOMETRY, topics.TRACKS)


class Ends(NamedTuple):
    """How many publish a topic and how many listen to it."""

    publishers: int
    subscribers: int


class Graph(NamedTuple):
    """What was seen.

    middleware  the RMW implementation in use
    nodes       names of the other nodes, with their namespaces
    topics      ends by the full names of the topics asked for
    """

    middleware: str
    nodes: tuple[str, ...]
    topics: dict[str, Ends]


def look(seconds: float, namespace: str = '/', names: Iterable[str] = NEEDED) -> Graph:
    """Listen until every topic has a publisher, at most `seconds`; discovery takes 0.1 to 3 s.

    namespace  where relative names stand; `/` for the root
    Raises what rclpy raises where no middleware can be started.
    """
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = Node(NODE, context=context, namespace=namespace, enable_rosout=False,
                    start_parameter_services=False)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        try:
            deadline = time.monotonic() + seconds
            while True:
                ends = {full: Ends(node.count_publishers(full), node.count_subscribers(full))
                        for full in map(node.resolve_topic_name, names)}
                left = deadline - time.monotonic()
                if left <= 0 or all(end.publishers for end in ends.values()):
                    break
                executor.spin_once(timeout_sec=min(0.1, left))
            others = tuple(sorted(
                f'{where.rstrip("/")}/{name}'
                for name, where in node.get_node_names_and_namespaces()
                if name != NODE and not name.startswith('_')))
        finally:
            executor.shutdown()
            node.destroy_node()
    finally:
        context.try_shutdown()
    return Graph(get_rmw_implementation_identifier(), others, ends)
