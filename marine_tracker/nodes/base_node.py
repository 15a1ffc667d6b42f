"""The base class of all nodes of this package."""

import functools
import time
from collections.abc import Callable, Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.lifecycle import LifecycleNodeMixin, LifecycleState, TransitionCallbackReturn
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Timer

from . import diagnostics, topics
from .diagnostics import FAILED, Tally, one_line

State = tuple[bytes, str, Mapping[str, Any]]  # level, message and values on /diagnostics


class RunnableNode(LifecycleNodeMixin, Node):
    """A node as run.py expects it. Its constructor raises ValueError if it cannot start.

    An exception never leaves a callback of its subscriptions, timers, services and parameters,
    including those that rclpy itself adds. It is logged once for each kind and callback, and
    counted.

    failures  the counted exceptions, for /diagnostics
    idle      managed, and not active: nothing is heard, nothing is done
    """

    def __init__(self, name: str, **node_arguments: Any) -> None:
        self.failures = Tally((), self.tell)
        self.idle = self._begun = False
        Node.__init__(self, name, **node_arguments)
        self._begun = True  # what rclpy makes for itself never rests

    @property
    def done(self) -> bool:
        """True once the node has nothing left to do, by itself."""
        return False

    def close(self) -> None:
        """Sends the last messages. Called before the executor stops."""

    # -- managed ---------------------------------------------------------------------------------

    def manage(self) -> None:
        """From now on a lifecycle node: it waits until somebody configures and activates it."""
        self.idle = True
        LifecycleNodeMixin.__init__(self)
        # rclpy lets a transition that is not possible end the executor.
        change = self._service_change_state
        change.callback = self._guarded(change.callback, _not_done, busy=False)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """It works."""
        self.idle = False
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """It waits, with all that it knows."""
        self.idle = True
        return super().on_deactivate(state)

    # -- callbacks, guarded ----------------------------------------------------------------------

    def create_subscription(
        self,
        msg_type: type[Any],
        topic: str,
        callback: Callable[..., Any],
        *arguments: Any,
        **named: Any,
    ) -> Subscription:
        """As in rclpy."""
        return super().create_subscription(
            msg_type, topic, self._guarded(callback), *arguments, **named
        )

    def create_timer(
        self, timer_period_sec: float, callback: Callable[..., Any], *arguments: Any, **named: Any
    ) -> Timer:
        """As in rclpy."""
        return super().create_timer(timer_period_sec, self._guarded(callback), *arguments, **named)

    def create_service(
        self, srv_type: type[Any], srv_name: str, callback: Callable[..., Any], **named: Any
    ) -> Service:
        """As in rclpy. If the callback fails, the response says so."""
        return super().create_service(
            srv_type, srv_name, self._guarded(callback, _not_done), **named
        )

    def add_on_set_parameters_callback(self, callback: Callable[..., SetParametersResult]) -> None:
        """As in rclpy. If the callback fails, the change is refused."""
        super().add_on_set_parameters_callback(self._guarded(callback, _refused, busy=False))

    def add_post_set_parameters_callback(self, callback: Callable[..., None]) -> None:
        """As in rclpy."""
        super().add_post_set_parameters_callback(self._guarded(callback, busy=False))

    def _guarded(
        self, callback: Callable, otherwise: Callable = lambda error, *_: None, busy: bool = True
    ):
        """The callback; if it raises, otherwise(error, *its arguments) is returned.

        busy  whether it rests while the node is idle
        """
        name = getattr(getattr(callback, 'func', callback), '__name__', 'a callback')
        busy = busy and self._begun

        @functools.wraps(callback)
        def run_guarded(*arguments):
            if self.idle and busy:
                return otherwise(ValueError('the node is not active'), *arguments)
            try:
                return callback(*arguments)
            except Exception as error:
                self.failures.add(
                    f'{FAILED}: {type(error).__name__} in {name}',
                    time.monotonic(),
                    detail=str(error),
                )
                return otherwise(error, *arguments)

        return run_guarded

    # -- how it fares ----------------------------------------------------------------------------

    def tell(self, reason: str, detail: str) -> None:
        """Logs the first of its kind. /diagnostics counts the rest."""
        self.get_logger().warning(
            f'{reason}{": " + detail if detail else ""} (told once; counted on /diagnostics)'
        )

    @property
    def label(self) -> str:
        """The node with its namespace, as in radar_1/tracker."""
        return f'{self.get_namespace()}/{self.get_name()}'.strip('/')

    @property
    def hardware_id(self) -> str:
        """The node that tells it, as in radar_1/tracker."""
        return self.label

    def watch(self, clock: Clock, task: str, state: Callable[[], State]) -> None:
        """Tells the state of a task on /diagnostics each second, or that callbacks fail."""
        publisher = self.publisher(DiagnosticArray, topics.DIAGNOSTICS, topics.reliable())
        self.create_timer(
            1.0, functools.partial(self._tell_state, publisher, task, state), clock=clock
        )

    def _tell_state(self, publisher: Publisher, task: str, state: Callable[[], State]) -> None:
        level, message, values = state()
        fresh, counts = self.failures.fresh(time.monotonic()), self.failures.counts
        if fresh:
            level, message = diagnostics.ERROR, 'lately: ' + ', '.join(fresh)
        values = {**values, FAILED: sum(counts.values()), **counts}
        status = diagnostics.status(
            f'{self.label}: {task}', self.hardware_id, level, message, values
        )
        publisher.publish(diagnostics.array(self.get_clock().now().nanoseconds, [status]))

    # -- under two names -------------------------------------------------------------------------

    def publisher_of_both(
        self, kind: type[Any], topic: str, quality: QoSProfile
    ) -> Callable[[Any], None]:
        """Publishes on the topic and on `~/topic`: the second is of this node alone, where others
        use the first name as well."""
        both = [self.publisher(kind, name, quality) for name in (topic, f'~/{topic}')]

        def publish(message: Any) -> None:
            data = serialize_message(message)  # once: the dear part
            for publisher in both:
                publisher.publish(data)

        return publish

    # -- without event handlers ------------------------------------------------------------------

    def publisher(self, kind: type[Any], topic: str, quality: QoSProfile) -> Publisher:
        """A publisher without event handlers.

        rclpy checks every handler each time it wakes. The handlers of six publishers cost more than
        tracking forty ships. A subscriber that asks for too much is told on its own side.
        """
        return self.create_publisher(
            kind,
            topic,
            quality,
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
        )

    def subscription(
        self, kind: type[Any], topic: str, callback: Callable[..., Any], quality: QoSProfile
    ) -> Subscription:
        """A subscription without event handlers, for the same reason."""
        return self.create_subscription(
            kind,
            topic,
            callback,
            quality,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
        )


def _why(error: Exception) -> str:
    """A reason that names the kind of error if its text was not written for users."""
    return one_line(error if isinstance(error, ValueError) else f'{type(error).__name__}: {error}')


def _refused(error: Exception, changed: list) -> SetParametersResult:
    """Names the parameters that were to be changed."""
    names = ', '.join(one_line(parameter.name) for parameter in changed)
    return SetParametersResult(
        successful=False, reason=one_line(f'parameter {names}: {_why(error)}')
    )


def _not_done(error: Exception, request, response: Any) -> Any:
    """Every request gets a response. If the response has a field for a reason, it is filled."""
    if hasattr(response, 'success'):
        response.success = False
    if hasattr(response, 'message'):
        response.message = _why(error)
    return response
