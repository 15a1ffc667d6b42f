"""A command line is understood or refused; a process without a home logs somewhere else."""

import os
import subprocess
import sys

import pytest

pytest.importorskip('rclpy')
from marine_tracker import parameter_files
from marine_tracker.nodes import arguments, log_folder
from marine_tracker.parameters import NODES


def run(*words, **how):
    return subprocess.run(
        [sys.executable, '-m', *words], capture_output=True, text=True, timeout=100, **how
    )


@pytest.mark.parametrize(
    'words',
    [['--verbose'], ['-p', 'seed:=2'], ['estimator:=imm'], ['--ros-args', '-p', 'a:=1', '--', 'x']],
)
@pytest.mark.parametrize('name', ['tracker', 'radar_simulator'])
def test_a_node_refuses_what_ros_would_pass_over(name, words):
    done = run('marine_tracker.nodes.run', name, *words)
    odd = words[-1] if '--' in words else words[0]
    assert done.returncode == 2 and not done.stdout
    assert done.stderr.startswith(f'{name}: {odd} is not understood')
    assert '--ros-args' in done.stderr and done.stderr.count('\n') == 1


@pytest.mark.parametrize('name', NODES)
def test_help_tells_every_parameter(name, capsys):
    assert arguments.answer(name, ['--help']) == arguments.answer(name, ['-h']) == 0
    told = capsys.readouterr().out
    for field in parameter_files.fields(name):
        assert f'  {field.name}: {parameter_files.yaml_value(field.default)}\n' in told


def test_help_comes_from_the_command_line():
    done = run('marine_tracker.nodes.run', 'nmea_output', '--help')
    assert done.returncode == 0 and not done.stderr
    assert 'usage: nmea_output' in done.stdout and 'talker: RA' in done.stdout


def test_arguments_for_ros_start_the_node():
    for words in ([], ['--ros-args'], ['--ros-args', '-p', 'estimator:=imm', '--'], ['--']):
        assert arguments.answer('tracker', words) is None


def test_a_long_argument_is_cut(capsys):
    assert arguments.answer('tracker', ['z' * 10_000]) == 2
    assert len(capsys.readouterr().err) < 600


def test_where_ros_finds_no_place_for_logs_it_gets_one(tmp_path):
    for environment in ({}, {'HOME': '/proc/none'}, {'HOME': ''}, {'ROS_HOME': '/proc/none'}):
        log_folder.provide(environment)
        assert os.access(environment['ROS_LOG_DIR'], os.W_OK)


def test_where_there_is_a_place_for_logs_it_is_taken(tmp_path):
    for given in (
        {'HOME': str(tmp_path)},
        {'ROS_HOME': str(tmp_path / 'ros')},
        {'ROS_LOG_DIR': '/proc/none'},
    ):
        environment = dict(given)
        log_folder.provide(environment)
        assert environment == given


HOMELESS = {name: value for name, value in os.environ.items() if name != 'HOME'}


def test_demo_runs_without_a_home():
    done = run('marine_tracker', 'demo', '--duration', '6', env=HOMELESS)
    assert done.returncode == 0, done.stderr
    assert 'Traceback' not in done.stderr


def test_doctor_finds_the_middleware_without_a_home():
    done = run('marine_tracker', 'doctor', '--listen', '0.5', env=HOMELESS)
    assert done.returncode == 0 and 'ok     ROS middleware' in done.stdout, done.stdout


@pytest.mark.parametrize('command', [['demo', '--duration', '3'], ['doctor', '--listen', '0.5']])
def test_a_folder_for_logs_that_cannot_be_written_is_told_in_one_line(command):
    environment = {**os.environ, 'ROS_LOG_DIR': '/proc/none'}
    done = run('marine_tracker', *command, env=environment)
    assert 'Traceback' not in done.stderr + done.stdout
    if command[0] == 'demo':
        assert done.returncode == 2 and done.stderr.count('\n') == 1
        assert 'ROS does not start' in done.stderr and 'logging' in done.stderr
    else:
        assert 'set ROS_LOG_DIR to a folder that can be written' in done.stdout
        assert 'pip install' not in done.stdout.split('ROS middleware')[1]
