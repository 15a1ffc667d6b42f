"""Commands of the page, given to the tracker by its topics, services and parameters."""

from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from typing import Any

from geometry_msgs.msg import PointStamped
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.parameter import Parameter, parameter_value_to_python
from std_msgs.msg import UInt32
from std_srvs.srv import SetBool, Trigger

from ..display.commands import Command
from . import topics
from .base_node import RunnableNode
from .convert import header
from .display_calls import call, chain, settle, taken, told
from .display_zones import NAME as ZONES
from .display_zones import ZoneCommands
from .explanations import Asker

PATIENCE = 10  # s until an answer about the parameters counts as lost
LIMITS = ('cpa_limit_nm', 'tcpa_limit_min', 'vector_time_min')
MOUNTING = (
    'radars',
    'gps_ahead_m',
    'gps_starboard_m',
    'antenna_ahead_m',
    'antenna_starboard_m',
    'bearing_offset_deg',
    'bearings',
)
AIS = (
    *('ais_symbol', 'ais_join', 'ais_kinds', 'ais_range_nm', 'ais_cpa_nm', 'ais_activation'),
    *('ais_activation_range_nm', 'ais_lost_alarm', 'ais_lost_range_nm', 'ais_sleeping_danger'),
)
ASKED = (*LIMITS, *MOUNTING, ZONES, *AIS)


class TrackerCommands:
    """Of one display node; `tracker` is the tracker's name, in the node's namespace or full.

    Everything here runs in the node's executor. wake() has `go_on` called there soon, from any
    thread.
    """

    def __init__(self, node: RunnableNode, tracker: str, wake: Callable[[], None]) -> None:
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
        self._awake = [
            node.publisher(UInt32, topic, topics.reliable())
            for topic in (topics.AIS_SLEEP, topics.AIS_ACTIVATE)
        ]
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
        self._zones = ZoneCommands(self._get, self._set, wake)
        self._asker = Asker(node)
        self._asked: Any = None  # the future of its last answer
        self._patience = 0

    def run(self, command: Command, answer: Future[str]) -> None:
        """Give one command; the answer, or the ValueError that says why not, comes later."""
        try:
            self._run(command, answer)
        except ValueError as error:
            settle(answer, error)

    def go_on(self) -> None:
        """What waits for its turn."""
        self._zones.go_on()

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
            call(self._triggers[name], Trigger.Request(), answer, told)
        elif name == 'trial_off':
            call(self._trial, SetBool.Request(data=False), answer, told)
        elif name in ('zone_put', 'zone_delete'):
            self._zones.run(command, answer)
        elif name == 'explain':
            self._asker.ask(values['x'], values['y'], partial(settle, answer))
        elif name == 'ais_awake':
            mmsi, awake = values['mmsi'], values['awake']
            said = f'AIS {mmsi:09d} {"is activated" if awake else "goes to sleep"} at the next scan'
            self._publish(self._awake[awake], UInt32(data=mmsi), answer, said)
        elif name == 'ais':
            flags = ('lost_alarm', 'sleeping_danger', 'join')
            self._put(
                {f'ais_{key}': bool(v) if key in flags else v for key, v in values.items()}, answer
            )
        elif name == 'limits':
            self._put(
                {'cpa_limit_nm': values['cpa_nm'], 'tcpa_limit_min': values['tcpa_min']}, answer
            )
        else:  # a trial: its values first, then it is switched on
            self._try(values, answer)

    def _try(self, values: dict[str, Any], answer: Future[str]) -> None:
        chain(
            lambda taken: self._put(
                {f'trial_{key}': value for key, value in values.items()}, taken
            ),
            answer,
            lambda _: call(self._trial, SetBool.Request(data=True), answer, told),
        )

    def ask(self, hear: Callable[[dict[str, Any]], None]) -> None:
        """hear(the tracker's parameters ASKED), later, if the tracker is there; to be called every
        second."""
        self._patience -= 1
        if self._asked is not None and not self._asked.done():
            if self._patience > 0:
                return
            self._get.remove_pending_request(self._asked)  # that tracker has gone
        self._asked = None
        if not self._get.service_is_ready():
            return
        self._asked = future = self._get.call_async(GetParameters.Request(names=list(ASKED)))
        self._patience = PATIENCE
        future.add_done_callback(
            lambda done: hear(
                {
                    name: parameter_value_to_python(value)
                    for name, value in zip(ASKED, done.result().values)
                }
            )
        )

    def _publish(self, publisher, message, answer: Future[str], said: str) -> None:
        if not publisher.get_subscription_count():
            raise ValueError(f'no tracker listens to {publisher.topic_name}')
        publisher.publish(message)
        settle(answer, said)

    def _put(self, values: dict[str, Any], answer: Future[str]) -> None:
        request = SetParameters.Request(
            parameters=[
                Parameter(name, value=value).to_parameter_msg() for name, value in values.items()
            ]
        )
        call(self._set, request, answer, taken)
