"""A node that stays for one question, in a context of its own."""

import contextlib
from collections.abc import Iterator

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from . import log_folder


@contextlib.contextmanager
def visitor(name: str, namespace: str) -> Iterator[tuple[Node, SingleThreadedExecutor]]:
    """The node, without parameters and log topic, and its executor; both end with the context.

    Raises the exceptions of rclpy if no middleware can be started.
    """
    context = Context()
    log_folder.provide()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = Node(
            name,
            context=context,
            namespace=namespace,
            enable_rosout=False,
            start_parameter_services=False,
        )
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        try:
            yield node, executor
        finally:
            executor.shutdown()
            node.destroy_node()
    finally:
        context.try_shutdown()
