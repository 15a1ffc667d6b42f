"""The command `marine_tracker demo`, as a process with processes of its own."""

import signal
import subprocess
import sys
import time

import psutil
import pytest

pytest.importorskip('rclpy')
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.context import Context

from marine_tracker.nodes import domain as domains
from marine_tracker.nodes import topics
from marine_tracker.processes import LATE

IN_TIME_S = 12.0  # from a signal to the end


@pytest.fixture
def demo(launch):
    with domains.free_domain() as number:

        def start(*arguments):
            return launch('__main__', 'demo', '--domain', str(number), *arguments)

        yield start


def children(process):
    try:
        return psutil.Process(process.process.pid).children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def nodes(process):
    """The node processes by name."""
    found = {}
    for child in children(process):
        words = child.cmdline()
        for name in ('tracker', 'radar_simulator', 'recording_player'):
            if 'marine_tracker.nodes.run' in words and name in words:
                found[name] = child
    return found


def gone(processes):
    return not [
        one for one in processes if one.is_running() and one.status() != psutil.STATUS_ZOMBIE
    ]


def test_targets_show_and_ctrl_c_ends_it_all(demo, node_helpers):
    wait, _ = node_helpers
    process = demo('--scenario', 'clean', '--rate', '25')
    assert process.says('TT06'), process.said
    started = nodes(process)
    assert set(started) == {'tracker', 'radar_simulator'}
    process.stop(signal.SIGINT)
    wait(lambda: gone(started.values()))
    assert 'own ship course 020.0, 10.0 kn' in process.said
    assert 'Traceback' not in process.said


def test_dangers_are_marked_and_listed_below(demo):
    process = demo('--scenario', 'encounters', '--rate', '25')
    assert process.says('TT02: danger, active unacknowledged'), process.said
    process.stop(signal.SIGINT)
    lines = process.said.splitlines()
    heads = next(line for line in lines if line.split()[:1] == ['target'])
    assert 'CPA NM    TCPA min' in heads
    assert [line for line in lines if line.split()[:1] == ['TT02'] and line.endswith('DANGER')]


def test_a_recording_is_shown_with_the_parameters_of_its_radar(demo, node_helpers, recordings):
    wait, _ = node_helpers
    process = demo(
        '--recording', str(recordings / 'autosea_joyride'), '--rate', '25', '--estimator', 'imm'
    )
    assert process.says('TRACKING'), process.said  # the boat; its number may have changed
    words = ' '.join(nodes(process)['tracker'].cmdline())
    for assignment in (
        'range_sigma_m:=12.0',
        'bearing_sigma_deg:=0.8',
        'vessel_class:="small_craft"',
        'estimator:="imm"',
        'use_sim_time:=true',
    ):
        assert assignment in words
    process.stop(signal.SIGTERM)


def test_hulls_are_tracked_as_targets_with_an_extent(demo):
    process = demo('--scenario', 'hulls', '--extent', 'gp', '--rate', '20')
    assert process.says('TT05'), process.said
    words = ' '.join(nodes(process)['tracker'].cmdline())
    for assignment in ('extent:="gp"', 'range_resolution_m:=10.0', 'beam_width_deg:=0.75'):
        assert assignment in words
    assert 'TT06' not in process.said
    process.stop(signal.SIGTERM)


def test_it_ends_by_itself_after_its_duration(demo):
    process = demo('--duration', '1')
    assert process.ends() == 0, process.said


def test_it_ends_with_the_scenario(demo, tmp_path):
    file = tmp_path / 'short.yaml'
    file.write_text(
        'duration_s: 20\nown_ship: {course_deg: 0, speed_kn: 0}\ntargets:\n'
        '  - {start: {range_nm: 2, bearing_deg: 10}, course_deg: 0, speed_kn: 9}\n'
    )
    process = demo('--scenario', str(file), '--rate', '20')
    assert process.ends() == 0, process.said


def test_a_node_that_dies_ends_the_demo_which_says_so(demo, node_helpers):
    wait, _ = node_helpers
    process = demo('--scenario', 'clean', '--rate', '25')
    started = wait(lambda: len(nodes(process)) == 2 and nodes(process))
    started['tracker'].kill()
    assert process.ends() == 1
    assert 'tracker ended with code -9' in process.said
    wait(lambda: gone(started.values()))


@pytest.mark.parametrize(
    'number', [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)]
)
def test_nodes_that_do_not_answer_are_killed_and_the_demo_ends_in_time(demo, node_helpers, number):
    wait, _ = node_helpers
    process = demo('--scenario', 'clean', '--rate', '25')
    assert process.says('TT04'), process.said
    started = nodes(process)
    for node in started.values():
        node.suspend()
    began = time.monotonic()
    process.send(number)
    assert process.ends() == 0, process.said
    assert time.monotonic() - began < IN_TIME_S
    wait(lambda: gone(started.values()))
    assert 'tracker does not end, and is killed' in process.said


@pytest.mark.slow
def test_a_demo_that_hangs_while_it_leaves_the_network_ends_in_time():
    script = (
        'import ctypes, sys\n'
        'from marine_tracker import cli\n'
        'from marine_tracker.nodes import targets_listener\n'
        'hold = lambda self: ctypes.PyDLL(None).sleep(37)\n'
        'targets_listener.TargetsListener.close = hold\n'
        "sys.exit(cli.main(['demo', '--duration', '1']))\n"
    )
    process = subprocess.Popen([sys.executable, '-c', script], stderr=subprocess.PIPE, text=True)
    _, said = process.communicate(timeout=60)
    assert process.returncode == LATE and 'most recent call first' in said


@pytest.mark.parametrize(
    'number', [signal.SIGTERM, pytest.param(signal.SIGINT, marks=pytest.mark.slow)]
)
def test_no_name_breaks_the_table_or_keeps_the_demo_from_ending(launch, node_helpers, number):
    wait, _ = node_helpers
    with domains.free_domain() as domain:
        process = launch('__main__', 'demo', '--domain', str(domain), '--scenario', 'clean')
        context = Context()
        rclpy.init(context=context, domain_id=domain)
        node = rclpy.create_node('other', context=context)
        sender = node.create_publisher(DiagnosticArray, topics.TARGETS, topics.latched())
        names = ('[/bold]', 'N' * 120_000, 'two\nlines', '\x1b[2J', 'ß' * 700, '')
        wait(sender.get_subscription_count)
        sender.publish(
            DiagnosticArray(
                status=[
                    DiagnosticStatus(
                        name=name, message=name, values=[KeyValue(key=name, value=name)]
                    )
                    for name in names
                ]
            )
        )
        assert process.says('[/bold]'), process.said
        assert 'N' * 100 not in process.said and '\x1b[2J' not in process.said
        began = time.monotonic()
        process.stop(number)
        assert time.monotonic() - began < IN_TIME_S
        node.destroy_node()
        context.try_shutdown()


def test_nodes_do_not_outlive_a_demo_that_is_killed(demo, node_helpers):
    wait, _ = node_helpers
    process = demo('--scenario', 'clean', '--rate', '25')
    started = wait(lambda: len(nodes(process)) == 2 and nodes(process))
    process.send(signal.SIGKILL)
    wait(lambda: gone(started.values()))


@pytest.mark.parametrize(
    'arguments, said',
    [
        (('--scenario', 'atlantis'), 'atlantis'),
        (('--rate', '0'), 'parameter rate is 0'),
        (('--recording', '/nowhere'), '/nowhere'),
        (('--seed', '-3'), 'parameter seed is -3'),
    ],
)
def test_wrong_arguments_are_told_before_anything_starts(demo, arguments, said):
    process = demo(*arguments)
    assert process.ends() == 2
    assert said in process.said and len(process.said.splitlines()) == 1
