"""Commands of the page, given to the tracker by its topics, services and parameters."""

from collections.abc import Callable
from concurrent.futures import Future
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
            )
        }
        self._triggers = {
            name: node.create_client(Trigger, service)
            for name, service in (
                ('cancel_all', topics.CANCEL_ALL),
                ('acknowledge_all', topics.ACKNOWLEDGE),
            )
        }
        self._trial = node.create_client(SetBool, topics.TRIAL_MANOEUVRE)
        self._set = node.create_client(SetParameters, f'{tracker}/set_parameters')
        self._get = node.create_client(GetParameters, f'{tracker}/get_parameters')

    def run(self, command: Command, answer: Future[str]) -> None:
        """Give one command; the answer, or the ValueError that says why not, comes later."""
        try:
            self._run(command, answer)
        except ValueError as error:
            answer.set_exception(error)

    def _run(self, command: Command, answer: Future[str]) -> None:
        name, values = command.name, command.values
        if name == 'acquire':
            point = PointStamped(header=header(0))
            point.point.x, point.point.y = values['x'], values['y']
            self._publish(self._acquire, point, answer, 'acquiring at the next scan')
        elif name in self._numbers:
            number = UInt32(data=values['number'])
            said = 'cancelled' if name == 'cancel' else 'acknowledged'
            self._publish(self._numbers[name], number, answer, f'target {values["number"]} {said}')
        elif name in self._triggers:
            self._call(self._triggers[name], Trigger.Request(), answer, _told)
        elif name == 'trial_off':
            self._call(self._trial, SetBool.Request(data=False), answer, _told)
        elif name == 'limits':
            self._put(
                {'cpa_limit_nm': values['cpa_nm'], 'tcpa_limit_min': values['tcpa_min']}, answer
            )
        else:  # a trial: its values first, then it is switched on
            values_set: Future[str] = Future()
            values_set.add_done_callback(
                lambda done: (
                    self._call(self._trial, SetBool.Request(data=True), answer, _told)
                    if done.exception() is None
                    else answer.set_exception(done.exception())
                )
            )
            self._put({f'trial_{key}': value for key, value in values.items()}, values_set)

    def ask_limits(self, hear: Callable[[dict[str, float]], None]) -> None:
        """hear(the tracker's LIMITS), later, if the tracker is there."""
        if self._get.service_is_ready():
            future = self._get.call_async(GetParameters.Request(names=list(LIMITS)))
            future.add_done_callback(
                lambda done: hear(
                    {name: value.double_value for name, value in zip(LIMITS, done.result().values)}
                )
            )

    def _publish(self, publisher, message, answer: Future[str], said: str) -> None:
        if not publisher.get_subscription_count():
            raise ValueError(f'no tracker listens to {publisher.topic_name}')
        publisher.publish(message)
        answer.set_result(said)

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
                answer.set_result(read(done.result()))
            except ValueError as error:
                answer.set_exception(error)

        client.call_async(request).add_done_callback(finish)


def _told(response) -> str:
    if not response.success:
        raise ValueError(response.message)
    return response.message


def _taken(response) -> str:
    for result in response.results:
        if not result.successful:
            raise ValueError(result.reason)
    return 'taken'
