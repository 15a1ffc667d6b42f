"""Zones that a page draws, into the tracker's parameter `zones`: read, changed, set, one by one."""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.parameter import Parameter

from ..arpa import zone_text
from ..display.commands import Command
from .display_calls import call, chain, settle, taken

NAME = 'zones'


class ZoneCommands:
    """zone_put and zone_delete, by the clients `get` and `put` of the tracker's parameters.

    Each is read from the tracker, changed and set before the next one begins: of two viewers who
    save at the same time, neither loses a zone. wake() has `go_on` called soon in the executor.
    """

    def __init__(self, get: Any, put: Any, wake: Callable[[], None]) -> None:
        self._get, self._put, self._wake = get, put, wake
        self._waiting: deque[tuple[Command, Future[str]]] = deque()
        self._busy = False

    def run(self, command: Command, answer: Future[str]) -> None:
        """In its turn."""
        self._waiting.append((command, answer))
        self.go_on()

    def go_on(self) -> None:
        """Begins what waits, once nothing else is under way."""
        while self._waiting and not self._busy:
            command, answer = self._waiting.popleft()
            if answer.cancelled():
                continue
            self._busy = True
            answer.add_done_callback(self._done)
            try:
                self._change(command, answer)
            except ValueError as error:
                settle(answer, error)

    def _done(self, _: Future[str]) -> None:
        """In whatever thread settled or cancelled the answer."""
        self._busy = False
        self._wake()

    def _change(self, command: Command, answer: Future[str]) -> None:
        values = command.values

        def go_on(text: str) -> None:
            if command.name == 'zone_put':
                text = zone_text.put(text, values['zone'], values['was'])
                said = f'zone {values["zone"].get("name", "")} saved'
            else:
                text = zone_text.without(text, values['name'])
                said = f'zone {values["name"]} deleted'
            request = SetParameters.Request(
                parameters=[Parameter(NAME, value=text).to_parameter_msg()]
            )
            call(self._put, request, answer, lambda done: taken(done) and said)

        chain(self._read, answer, go_on)

    def _read(self, answer: Future[str]) -> None:
        request = GetParameters.Request(names=[NAME])
        call(self._get, request, answer, lambda done: done.values[0].string_value)
