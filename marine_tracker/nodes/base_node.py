"""What every node of this package is."""

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.subscription import Subscription


class RunnableNode(Node):
    """A node as run.py takes it. Its constructor raises ValueError where it cannot start."""

    @property
    def done(self) -> bool:
        """True once the node has nothing left to do, by itself."""
        return False

    def close(self) -> None:
        """Last messages; called before the executor stops."""

    def publisher(self, kind, topic: str, quality) -> Publisher:
        """A publisher without event handlers.

        rclpy looks at every handler each time it wakes; those of six publishers cost more than
        the tracking of forty ships. A subscriber that asks for too much is told on its own side.
        """
        return self.create_publisher(
            kind,
            topic,
            quality,
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
        )

    def subscription(self, kind, topic: str, callback, quality) -> Subscription:
        """A subscription without event handlers, for the same reason."""
        return self.create_subscription(
            kind,
            topic,
            callback,
            quality,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
        )
