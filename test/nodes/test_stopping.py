"""Every node ends soon after SIGINT or SIGTERM, whatever it does; its exit code tells how."""

import itertools
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import pytest

pytest.importorskip('rclpy')
from marine_tracker.processes import GRACE_S, LATE, end_with_parent
from marine_tracker.recording import csv_folder
from marine_tracker.simulation import radar, scenario

CHECKOUT = Path(__file__).resolve().parents[2]
IN_TIME_S = 12.0  # from the signal to the end of the process
AT_ONCE = 3  # processes: nodes start slowly where more share a processor
BEFORE_PYTHON_S = 2.0  # a signal this early may come before the first line of Python

# A node of run.py that hangs with the interpreter's lock held: no Python runs any more.
HOLDING = """
import atexit, ctypes, sys, types
from marine_tracker.nodes import run
from marine_tracker.nodes.base_node import RunnableNode

mutex = ctypes.create_string_buffer(64)


def hold():
    lock = ctypes.PyDLL(None).pthread_mutex_lock
    lock(mutex), lock(mutex)  # nobody ever gives it back, and no signal interrupts it


def sleep():
    print('asleep', flush=True)
    ctypes.PyDLL(None).sleep(33)


class HoldingNode(RunnableNode):
    over = False

    def __init__(self):
        super().__init__('holding')
        self.create_timer(0.1, self.tick)

    @property
    def done(self):
        return self.over

    def tick(self):
        print('up', flush=True)
        if when == 'callback':
            hold()
        if when == 'fail':
            self.over = True
            raise RuntimeError('the recording has a hole')

    def close(self):
        if when == 'close':
            hold()
        if when == 'asleep':
            sleep()
        if when == 'raise':
            raise RuntimeError('the port does not close')

    def destroy_node(self):
        if when == 'destroy':
            hold()
        super().destroy_node()


when = sys.argv.pop(1)
if when == 'exit':
    atexit.register(hold)
module = types.ModuleType('marine_tracker.nodes.holding_node')
module.HoldingNode = HoldingNode
sys.modules[module.__name__] = module
run.NODES['holding'] = 'HoldingNode'
run.main('holding')
"""


class Stop(NamedTuple):
    """How one process ended: s from the signal to the end, its exit code, what it said."""

    seconds: float
    code: int
    said: str


def as_from_a_terminal():
    """A shell's job in the background, and so what a test starts there, ignores SIGINT."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    end_with_parent()


def start(*arguments):
    return subprocess.Popen(
        [sys.executable, *arguments],
        cwd=CHECKOUT,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        preexec_fn=as_from_a_terminal,
    )


def stopped(process, number, again=()):
    """Signal it once, and once more after each of the seconds `again`."""
    began = time.monotonic()
    process.send_signal(number)
    for seconds in again:
        time.sleep(max(began + seconds - time.monotonic(), 0.0))
        process.send_signal(number)
    try:
        said, _ = process.communicate(timeout=IN_TIME_S + 10)
    except subprocess.TimeoutExpired:
        process.kill()
        said, _ = process.communicate()
    return Stop(time.monotonic() - began, process.returncode, said)


@pytest.mark.slow
def test_a_node_that_holds_the_interpreter_for_ever_ends_in_time(domain):
    """In each of the ways, all side by side, for each takes the whole time of grace."""
    whens = ('callback', 'close', 'asleep', 'destroy')
    processes = {when: start('-c', HOLDING, when) for when in whens}
    for process in processes.values():
        assert process.stdout.readline() == 'up\n'
    time.sleep(0.5)  # in `callback` the lock is held by now
    with ThreadPoolExecutor(len(whens)) as pool:
        stops = {
            when: pool.submit(
                stopped, process, signal.SIGTERM, (1.5, 4.0) if when == 'destroy' else ()
            )
            for when, process in processes.items()
        }
        stops = {when: stop.result() for when, stop in stops.items()}
    for when, stop in stops.items():
        assert stop.code == LATE and stop.seconds < IN_TIME_S, (when, stop)
        assert stop.seconds > GRACE_S - 1.5, (when, stop)  # alarm() counts whole seconds
        assert 'most recent call first' in stop.said, (when, stop)
        assert f'in {"sleep" if when == "asleep" else "hold"}\n' in stop.said


def test_what_waits_at_the_end_of_python_itself_holds_up_no_node_that_is_closed(domain):
    process = start('-c', HOLDING, 'exit')
    assert process.stdout.readline() == 'up\n'
    stop = stopped(process, signal.SIGINT)
    assert stop.code == 0 and stop.seconds < GRACE_S - 1.5, stop


def test_a_node_that_cannot_close_says_so_and_its_exit_code_is_1(domain):
    process = start('-c', HOLDING, 'raise')
    assert process.stdout.readline() == 'up\n'
    stop = stopped(process, signal.SIGINT)
    assert stop.code == 1 and 'RuntimeError: the port does not close' in stop.said


def test_a_node_that_ends_by_itself_after_a_failure_has_the_exit_code_1(domain):
    said, _ = (process := start('-c', HOLDING, 'fail')).communicate(timeout=60)
    assert process.returncode == 1 and 'RuntimeError in tick: the recording has a hole' in said


@pytest.fixture(scope='module')
def arguments(tmp_path_factory):
    """ROS arguments by node, with which it runs on and on."""
    chosen = scenario.load('clean')
    folder = tmp_path_factory.mktemp('recording')
    scans = itertools.islice(radar.simulate(chosen, 5), 8)
    csv_folder.write(folder, 'eight', scans, chosen.tracker_parameters())
    given = {
        'tracker': {'use_sim_time': 'true'},
        'radar_simulator': {'scenario': 'clean', 'rate': '10.0', 'loop': 'true'},
        'recording_player': {'folder': str(folder), 'rate': '10.0', 'loop': 'true'},
        'nmea_output': {'udp': '127.0.0.1:29117', 'use_sim_time': 'true'},
        'ppi_display': {'address': '127.0.0.1:0', 'use_sim_time': 'true'},
    }
    return {
        name: [word for key, value in values.items() for word in ('-p', f'{key}:={value}')]
        for name, values in given.items()
    }


def stop_many(arguments, times, latest_s):
    """Each node is sent each signal so many times, spread evenly over its first seconds.

    Returns rows of node, signal, s from start to signal, and the Stop.
    """
    rng = random.Random(times)
    cases = [
        (name, number, latest_s * (k + rng.random()) / times)
        for name in arguments
        for number in (signal.SIGINT, signal.SIGTERM)
        for k in range(times)
    ]
    rng.shuffle(cases)

    def one(case):
        name, number, delay = case
        process = start('-m', 'marine_tracker.nodes.run', name, '--ros-args', *arguments[name])
        time.sleep(delay)
        return *case, stopped(process, number)

    with ThreadPoolExecutor(AT_ONCE) as pool:
        return list(pool.map(one, cases))


def check(rows):
    late = [row for row in rows if row[-1].seconds > IN_TIME_S]
    assert not late, late
    for name, number, delay, stop in rows:
        early = delay < BEFORE_PYTHON_S and (
            stop.code == -number or (stop.code == 1 and 'KeyboardInterrupt' in stop.said)
        )
        assert stop.code == 0 or early, (name, number, delay, stop)
        assert early or 'Traceback' not in stop.said, (name, number, delay, stop)


def test_each_node_ends_in_time_by_each_signal(domain, arguments):
    check(stop_many(arguments, 2, 4.0))


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_each_node_ends_in_time_by_fifty_signals_of_each_kind(domain, arguments):
    rows = stop_many(arguments, 50, 10.0)
    codes = {code: sum(row[-1].code == code for row in rows) for code in {r[-1].code for r in rows}}
    worst = sorted((row[-1].seconds, row[0], row[1].name, row[2]) for row in rows)[-3:]
    print(f'{len(rows)} stops, by exit code {codes}; the longest {worst}')
    check(rows)
