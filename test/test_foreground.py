"""`make demo` in a terminal: Ctrl-C ends the demo in its own way; make returns its exit code."""

import os
import pty
import select
import shutil
import signal
import sys
import time
from pathlib import Path

import pytest

import marine_tracker

HELPER = Path(marine_tracker.__file__).resolve().parents[1] / '.ci' / 'foreground.py'

# Ends well on SIGINT and SIGTERM, as the demo does.
COMMAND = """\
import signal, sys, time
def end(number, frame):
    print('ended by', signal.Signals(number).name)
    sys.exit(int(sys.argv[1]))
signal.signal(signal.SIGINT, end)
signal.signal(signal.SIGTERM, end)
print('ready')
time.sleep(30)
"""


@pytest.fixture
def make_in_terminal(tmp_path):
    """Starts make as a terminal's foreground job, its recipe the helper and a command.

    Returns the process id, the terminal, and what was printed until the command was ready.
    """
    if shutil.which('make') is None:
        pytest.skip('make is not installed')
    started = []

    def start(exit_code):
        (tmp_path / 'command.py').write_text(COMMAND)
        (tmp_path / 'Makefile').write_text(
            f'all:\n\t@exec {sys.executable} {HELPER} {sys.executable} -u command.py {exit_code}\n')
        process, terminal = pty.fork()
        if process == 0:
            os.chdir(tmp_path)
            os.execvp('make', ['make'])
        started.append((process, terminal))
        read_until(terminal, 'ready')
        return process, terminal
    yield start
    for process, terminal in started:
        os.close(terminal)
        try:
            os.kill(process, signal.SIGKILL)
        except ProcessLookupError:
            pass


def read_until(terminal, text, timeout=20.0):
    """Everything a terminal shows until it has shown a text."""
    shown, deadline = '', time.monotonic() + timeout
    while text not in shown:
        assert time.monotonic() < deadline, f'{text!r} not shown, but: {shown}'
        if select.select([terminal], [], [], 0.2)[0]:
            shown += os.read(terminal, 1000).decode()
    return shown


def exit_code(process, timeout=20.0):
    deadline = time.monotonic() + timeout
    while time.monotonic() < deadline:
        ended, status = os.waitpid(process, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.02)
    raise AssertionError('make did not end')


def test_ctrl_c_lets_the_command_end_and_make_returns_zero(make_in_terminal):
    process, terminal = make_in_terminal(exit_code=0)
    os.write(terminal, b'\x03')
    read_until(terminal, 'ended by SIGINT')
    assert exit_code(process) == 0


def test_terminating_make_ends_the_command(make_in_terminal):
    process, terminal = make_in_terminal(exit_code=0)
    os.kill(process, signal.SIGTERM)
    read_until(terminal, 'ended by SIGTERM')
    assert exit_code(process) == -signal.SIGTERM


def test_failure_of_the_command_is_failure_of_make(make_in_terminal):
    process, terminal = make_in_terminal(exit_code=3)
    os.write(terminal, b'\x03')
    read_until(terminal, 'Error 3')
    assert exit_code(process) == 2
