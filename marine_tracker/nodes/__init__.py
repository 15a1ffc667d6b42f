"""The ROS 2 nodes: they convert, call the core and publish. Only this package imports rclpy."""

from ..processes import one_thread

one_thread()
