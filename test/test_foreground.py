"""`make demo` in a terminal: Ctrl-C ends the demo in its own way; make returns its exit code."""

import os
import pty
import select
import shutil
import signal
import subprocess
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


# Makes standard input the terminal that Ctrl-C belongs to, then becomes make.
MAKE = """\
import fcntl, os, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
os.execvp('make', ['make'])
"""


@pytest.fixture
def make_in_terminal(tmp_path):
    """Starts make as a terminal's foreground job, its recipe the helper and a command.

    Returns the process and the terminal, once the command is ready.
    """
    if shutil.which('make') is None:
        pytest.skip('make is not installed')
    started = []

    def start(exit_code):
        (tmp_path / 'command.py').write_text(COMMAND)
        (tmp_path / 'Makefile').write_text(
            f'all:\n\t@exec {sys.executable} {HELPER} {sys.executable} -u command.py {exit_code}\n'
        )
        terminal, inside = pty.openpty()
        process = subprocess.Popen(
            [sys.executable, '-c', MAKE],
            cwd=tmp_path,
            stdin=inside,
            stdout=inside,
            stderr=inside,
            start_new_session=True,
        )
        os.close(inside)
        started.append((process, terminal))
        read_until(terminal, 'ready')
        return process, terminal

    yield start
    for process, terminal in started:
        os.close(terminal)
        process.kill()
        process.wait()


def read_until(terminal, text, timeout=20.0):
    """Everything a terminal shows until it has shown a text."""
    shown, deadline = '', time.monotonic() + timeout
    while text not in shown:
        assert time.monotonic() < deadline, f'{text!r} not shown, but: {shown}'
        if select.select([terminal], [], [], 0.2)[0]:
            shown += os.read(terminal, 1000).decode()
    return shown


def test_ctrl_c_lets_the_command_end_and_make_returns_zero(make_in_terminal):
    process, terminal = make_in_terminal(exit_code=0)
    os.write(terminal, b'\x03')
    read_until(terminal, 'ended by SIGINT')
    assert process.wait(20) == 0


def test_terminating_make_ends_the_command(make_in_terminal):
    process, terminal = make_in_terminal(exit_code=0)
    process.terminate()
    read_until(terminal, 'ended by SIGTERM')
    assert process.wait(20) == -signal.SIGTERM


def test_failure_of_the_command_is_failure_of_make(make_in_terminal):
    process, terminal = make_in_terminal(exit_code=3)
    os.write(terminal, b'\x03')
    read_until(terminal, 'Error 3')
    assert process.wait(20) == 2
