"""Runs nodes of this package as child processes of a command."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO, Any, NamedTuple

from ..processes import closing, end_with_parent

STOP_S = 4.0  # s for the nodes to end by themselves after SIGINT, then after SIGTERM


class Child(NamedTuple):
    """A node as a process. Its output goes into `log`."""

    name: str
    process: subprocess.Popen
    log: IO[bytes]


class Children(list[Child]):
    """The nodes that run as processes; which they are may change."""

    def __init__(self, logs: contextlib.ExitStack) -> None:
        super().__init__()
        self._logs = logs

    def start(
        self, nodes: dict[str, dict[str, Any]], renamed: Mapping[str, str] | None = None
    ) -> None:
        """Nodes by name with their parameters; renamed: new names of their topics."""
        for name, parameters in nodes.items():
            self.append(_start(name, parameters, self._logs, renamed or {}))

    def end(self, *names: str) -> None:
        """The nodes of these names."""
        ending = [child for child in self if child.name in names]
        _end(ending)
        self[:] = [child for child in self if child not in ending]


@contextlib.contextmanager
def children_of(nodes: dict[str, dict[str, Any]]) -> Iterator[Children]:
    """The nodes, by name with their parameters, as processes. All end with the context, and this
    process is to end soon after them (processes.closing)."""
    with contextlib.ExitStack() as logs:
        children = Children(logs)
        try:
            children.start(nodes)
            yield children
        finally:
            closing()
            _end(children)


@contextlib.contextmanager
def child_of(name: str, parameters: dict[str, Any]) -> Iterator[Child]:
    """One node as a process, which ends with the context; this process goes on."""
    with contextlib.ExitStack() as logs:
        child = _start(name, parameters, logs, {})
        try:
            yield child
        finally:
            _end([child])


def _end(children: list[Child]) -> None:
    for ask in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        for child in children:
            if ask == signal.SIGKILL and child.process.poll() is None:
                print(f'{child.name} does not end, and is killed', file=sys.stderr)
            child.process.send_signal(ask)  # nothing where it has ended
        until = time.monotonic() + STOP_S
        for child in children:
            with contextlib.suppress(subprocess.TimeoutExpired):
                child.process.wait(max(until - time.monotonic(), 0.0))


def _start(
    name: str, parameters: dict[str, Any], logs: contextlib.ExitStack, renamed: Mapping[str, str]
) -> Child:
    log = logs.enter_context(tempfile.TemporaryFile())
    arguments = [sys.executable, '-P', '-m', 'marine_tracker.nodes.run', name, '--ros-args']
    for key, value in parameters.items():
        arguments += ['-p', f'{key}:={json.dumps(value)}']
    for topic, other in renamed.items():
        arguments += ['-r', f'{topic}:={other}']
    package_home = os.fspath(Path(__file__).resolve().parents[2])
    search = os.pathsep.join(filter(None, [package_home, os.environ.get('PYTHONPATH')]))
    # A session of its own: Ctrl-C reaches only this command, which then ends its children.
    process = subprocess.Popen(
        arguments,
        stdin=subprocess.DEVNULL,
        stdout=log,
        stderr=log,
        start_new_session=True,
        env={**os.environ, 'PYTHONPATH': search},
        preexec_fn=end_with_parent,
    )
    return Child(name, process, log)
