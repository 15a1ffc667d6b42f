"""Commands of the page, given to the tracker by its topics, services and parameters."""

from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from typing import Any

from geometry_msgs.msg import PointStamped
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.parameter import Parameter
from std_msgs.msg import UInt32
from std_srvs.srv import SetBool, Trigger

from ..display.commands import Command
from . import topics
from .base_node import RunnableNode
from .convert import header

PATIENCE = 10  # s until an answer about the limits counts as lost
LIMITS = ('cpa_limit_nm', 'tcpa_limit_min', 'vector_time_min')


class TrackerCommands:
    """Of one display node; `tracker` is the tracker's name, in the node's namespace or full.

    Everything here runs in the node's executor.
    """

    def __init__(self, node: RunnableNode, tracker: str) -> None:
        self._node, self._tracker = node, tracker
        self._acquire = node.publisher(PointStamped, topics.ACQUIRE, topics.reliable())
        self._numbers = {
            name: node.publisher(UInt32, topic, topics.reliable())
            for name, topic in (
                ('cancel', topics.CANCEL),
                ('acknowledge', topics.ACKNOWLEDGE_TARGET),
                ('acknowledge_alert', topics.ACKNOWLEDGE_ALERT),
            )
        }
        self._triggers = {
            name: node.create_client(Trigger, service)
            for name, service in (
                ('cancel_all', topics.CANCEL_ALL),
                ('acknowledge_all', topics.ACKNOWLEDGE),
                ('silence', topics.SILENCE),
            )
        }
        self._trial = node.create_client(SetBool, topics.TRIAL_MANOEUVRE)
        self._set = node.create_client(SetParameters, f'{tracker}/set_parameters')
        self._get = node.create_client(GetParameters, f'{tracker}/get_parameters')
        self._asked: Any = None  # the future of its last answer
        self._patience = 0

    def run(self, command: Command, answer: Future[str]) -> None:
        """Give one command; the answer, or the ValueError that says why not, comes later."""
        try:
            self._run(command, answer)
        except ValueError as error:
            _settle(answer, error)

    def _run(self, command: Command, answer: Future[str]) -> None:
        name, values = command.name, command.values
        if name == 'acquire':
            point = PointStamped(header=header(0))
            point.point.x, point.point.y = values['x'], values['y']
            self._publish(self._acquire, point, answer, 'acquiring at the next scan')
        elif name in self._numbers:
            ((what, number),) = values.items()
            said = 'cancelled' if name == 'cancel' else 'acknowledged'
            which = 'alert' if what == 'instance' else 'target'
            message = UInt32(data=number)
            self._publish(self._numbers[name], message, answer, f'{which} {number} {said}')
        elif name in self._triggers:
            self._call(self._triggers[name], Trigger.Request(), answer, _told)
        elif name == 'trial_off':
            self._call(self._trial, SetBool.Request(data=False), answer, _told)
        elif name == 'limits':
            self._put(
                {'cpa_limit_nm': values['cpa_nm'], 'tcpa_limit_min': values['tcpa_min']}, answer
            )
        else:  # a trial: its values first, then it is switched on
            self._try(values, answer)

    def _try(self, values: dict[str, Any], answer: Future[str]) -> None:
        taken: Future[str] = Future()

        def go_on(done: Future[str]) -> None:
            try:
                done.result()
                self._call(self._trial, SetBool.Request(data=True), answer, _told)
            except (ValueError, CancelledError) as error:
                _settle(answer, error)

        taken.add_done_callback(go_on)
        answer.add_done_callback(lambda done: taken.cancel() if done.cancelled() else None)
        self._put({f'trial_{key}': value for key, value in values.items()}, taken)

    def ask_limits(self, hear: Callable[[dict[str, float]], None]) -> None:
        """hear(the tracker's LIMITS), later, if the tracker is there; to be called every second."""
        self._patience -= 1
        if self._asked is not None and not self._asked.done():
            if self._patience > 0:
                return
            self._get.remove_pending_request(self._asked)  # that tracker has gone
        self._asked = None
        if not self._get.service_is_ready():
            return
        self._asked = future = self._get.call_async(GetParameters.Request(names=list(LIMITS)))
        self._patience = PATIENCE
        future.add_done_callback(
            lambda done: hear(
                {name: value.double_value for name, value in zip(LIMITS, done.result().values)}
            )
        )

    def _publish(self, publisher, message, answer: Future[str], said: str) -> None:
        if not publisher.get_subscription_count():
            raise ValueError(f'no tracker listens to {publisher.topic_name}')
        publisher.publish(message)
        _settle(answer, said)

    def _put(self, values: dict[str, float], answer: Future[str]) -> None:
        request = SetParameters.Request(
            parameters=[
                Parameter(name, value=value).to_parameter_msg() for name, value in values.items()
            ]
        )
        self._call(self._set, request, answer, _taken)

    def _call(self, client, request, answer: Future[str], read: Callable[[Any], str]) -> None:
        """read(response) gives the answer, or raises ValueError."""
        if not client.service_is_ready():
            raise ValueError(f'no tracker serves {client.srv_name}')

        def finish(done) -> None:
            try:
                _settle(answer, read(done.result()))
            except ValueError as error:
                _settle(answer, error)

        asked = client.call_async(request)
        asked.add_done_callback(finish)
        # Who asked does not wait for ever: what is not answered by then is forgotten.
        answer.add_done_callback(
            lambda done: client.remove_pending_request(asked) if done.cancelled() else None
        )


def _settle(answer: Future[str], result: str | BaseException) -> None:
    """The answer, unless whoever asked has given up meanwhile."""
    if not answer.set_running_or_notify_cancel():
        return
    if isinstance(result, BaseException):
        answer.set_exception(result)
    else:
        answer.set_result(result)


def _told(response) -> str:
    if not response.success:
        raise ValueError(response.message)
    return response.message


def _taken(response) -> str:
    for result in response.results:
        if not result.successful:
            raise ValueError(result.reason)
    return 'taken'
