"""What every node of this package is."""

from rclpy.node import Node


class RunnableNode(Node):
    """A node as run.py takes it. Its constructor raises ValueError where it cannot start."""

    @property
    def done(self) -> bool:
        """True once the node has nothing left to do, by itself."""
        return False

    def close(self) -> None:
        """Last messages; called before the executor stops."""
