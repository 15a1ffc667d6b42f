"""What a demo shows, heard and chosen by the PPI through the parameters of the demo's node."""

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.parameter import Parameter, parameter_value_to_python

from ..display.commands import Command
from .base_node import RunnableNode
from .demo_choice import CHOSEN, NAME
from .display_calls import call, settle

ASKED = (*CHOSEN, 'scenarios', 'recordings', 'run')
SHOW = 'show'  # the command
PATIENCE = 10  # s until an answer counts as lost


class DemoLink:
    """Of one display node. Everything runs in the node's executor."""

    def __init__(self, node: RunnableNode) -> None:
        self._get = node.create_client(GetParameters, f'{NAME}/get_parameters')
        self._set = node.create_client(SetParametersAtomically, f'{NAME}/set_parameters_atomically')
        self._asked: Any = None
        self._patience = 0

    def choose(self, command: Command, answer: Future[str]) -> None:
        """What is to be shown; the answer, or the ValueError that says why not, comes later."""
        request = SetParametersAtomically.Request(
            parameters=[
                Parameter(name, value=value).to_parameter_msg()
                for name, value in command.values.items()
            ]
        )
        try:
            call(self._set, request, answer, _chosen)
        except ValueError:
            settle(answer, ValueError('no demo runs here'))

    def ask(self, hear: Callable[[dict[str, Any]], None]) -> None:
        """hear(what the demo shows and offers), later, if there is one; to be called every second.

        An empty mapping where there is none.
        """
        self._patience -= 1
        if self._asked is not None and not self._asked.done():
            if self._patience > 0:
                return
            self._get.remove_pending_request(self._asked)
        self._asked = None
        if not self._get.service_is_ready():
            hear({})
            return
        self._asked = self._get.call_async(GetParameters.Request(names=list(ASKED)))
        self._patience = PATIENCE
        self._asked.add_done_callback(lambda done: hear(_plain(done.result().values)))


def _plain(values: Any) -> dict[str, Any]:
    if len(values) != len(ASKED):
        return {}  # another node of that name
    found = {name: parameter_value_to_python(value) for name, value in zip(ASKED, values)}
    found['recordings'] = [name for name in found['recordings'] or () if name]
    return found


def _chosen(response: Any) -> str:
    if not response.result.successful:
        raise ValueError(response.result.reason)
    return 'starting'
