"""Nodes as processes of their own, found by each other over DDS."""

import random
import signal
import time

import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from sensor_msgs.msg import PointCloud2

from marine_tracker.nodes import topics
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.recording import csv_folder
from marine_tracker.simulation import scenario
from marine_tracker.tracking.tracker import Tracker

SIMULATOR, TRACKER, PLAYER = (
    f'nodes.run {name}' for name in ('radar_simulator', 'tracker', 'recording_player')
)
STATUS = ('', 'TRACKING', 'COASTING', 'LOST')  # tentative ones have no number
READY = {SIMULATOR: 'scenario', TRACKER: 'waiting for', PLAYER: 'recording'}


def p(**parameters):
    """Command-line parameters."""
    assignments = [('-p', f'{name}:={value}') for name, value in parameters.items()]
    return ['--ros-args', *(word for pair in assignments for word in pair)]


def for_clean():
    return {
        name: float(value)
        for name, value in scenario.load('clean').tracker_parameters().items()
        if not isinstance(value, str)
    }


@pytest.fixture
def targets(graph, node_helpers):
    """Listens to `targets`; targets.now() gives the last message as {name: values}."""
    _, listener = node_helpers
    ears = listener(graph.bystander(), DiagnosticArray, topics.TARGETS, topics.latched(50))

    def now():
        return {
            entry.name: {'status': entry.message, **{pair.key: pair.value for pair in entry.values}}
            for entry in (ears[-1].status if len(ears) else ())
        }

    ears.now = now
    return ears


def test_parameters_from_a_file_confirm_all_targets_and_the_estimator_may_change(
    launch, targets, graph, node_helpers, tmp_path
):
    wait, _ = node_helpers
    file = tmp_path / 'mine.yaml'
    file.write_text(
        '/**:\n  ros__parameters:\n    use_sim_time: true\n'
        + ''.join(
            f'    {name}: {value}\n'
            for name, value in {'estimator': 'cs_kalman', **for_clean()}.items()
        )
    )
    tracker = launch(TRACKER, '--ros-args', '--params-file', str(file))
    simulator = launch(SIMULATOR, *p(scenario='clean', rate=30.0))
    wait(lambda: len(targets.now()) == 6)
    assert set(targets.now()) == {f'TT{n:02d}' for n in range(1, 7)}
    wait(lambda: {values['estimator'] for values in targets.now().values()} == {'cs_kalman'})

    client = graph.nodes[0].create_client(SetParameters, '/tracker/set_parameters')
    wait(client.service_is_ready)
    future = client.call_async(
        SetParameters.Request(parameters=[Parameter('estimator', value='imm').to_parameter_msg()])
    )
    wait(future.done)
    assert future.result().results[0].successful
    wait(lambda: {values['estimator'] for values in targets.now().values()} == {'imm'})
    heard = len(targets)
    wait(lambda: len(targets) >= heard + 10)
    assert set(targets.now()) == {f'TT{n:02d}' for n in range(1, 7)}
    simulator.stop()
    tracker.stop(signal.SIGTERM)


def test_a_recording_over_dds_gives_the_tracks_of_a_replay(
    launch, targets, node_helpers, recordings
):
    wait, _ = node_helpers
    recording = csv_folder.read(recordings / 'autoferry_03')
    parameters = {**recording.tracker_parameters, 'scan_period_s': 1.68}  # as it turned
    core = Tracker(from_mapping(TrackerParameters, parameters))
    memory, expected = core.start(), []
    for scan in recording.scans:
        memory, report = core.step(memory, scan)
        tracks = report.tracks
        expected.append(
            sorted(
                (f'TT{number:02d}', STATUS[status])
                for number, status in zip(tracks.number.tolist(), tracks.status.tolist())
                if number
            )
        )
    tracker = launch(TRACKER, *p(use_sim_time='true', **parameters))
    assert tracker.says('waiting for')  # a player waits 3 s for a tracker, and then begins
    wait(lambda: targets.connected)
    player = launch(PLAYER, *p(folder=recordings / 'autoferry_03', rate=25.0))
    assert player.ends() == 0
    wait(lambda: len(targets) >= len(recording.scans))
    assert [
        [(one.name, one.message) for one in message.status if one.name.startswith('TT')]
        for message in targets.messages
    ] == expected  # beside them the stationary objects
    tracker.stop()


@pytest.mark.parametrize(
    'module, content, said',
    [
        (TRACKER, 'estimatr: imm', 'tracker: unknown parameter estimatr; did you mean estimator?'),
        (PLAYER, 'folder: 7', 'recording_player: parameter folder is 7, an integer'),
    ],
)
def test_a_wrong_parameter_in_a_file_stops_the_start_in_one_line(
    launch, tmp_path, module, content, said
):
    file = tmp_path / 'wrong.yaml'
    file.write_text(f'/**:\n  ros__parameters:\n    {content}\n')
    process = launch(module, '--ros-args', '--params-file', str(file))
    assert process.ends() == 1
    assert process.said.startswith(said) and len(process.said.splitlines()) == 1


def test_two_radars_side_by_side_do_not_hear_each_other(launch, graph, node_helpers):
    wait, listener = node_helpers
    node = graph.bystander()
    tracks = {n: listener(node, Odometry, f'/radar_{n}/tracks') for n in (1, 2)}
    plots = {n: listener(node, PointCloud2, f'/radar_{n}/radar/plots') for n in (1, 2)}
    diagnostics = listener(node, DiagnosticArray, topics.DIAGNOSTICS)
    processes = []
    for n, name in ((1, 'clean'), (2, 'paper_track')):
        where = ['-r', f'__ns:=/radar_{n}']
        processes += [
            launch(TRACKER, *p(max_plots=100 * n), *where),
            # Their clocks would clash; the trackers go by the stamps alone.
            launch(SIMULATOR, *p(scenario=name, rate=20.0), *where, '-r', '/clock:=clock'),
        ]
    wait(lambda: len(tracks[1]) and len(tracks[2]))
    assert {message.child_frame_id for message in tracks[2].messages} == {'track_01'}
    wait(
        lambda: (
            {message.child_frame_id for message in tracks[1].messages}
            >= {f'track_{k:02d}' for k in range(1, 6)}
        )
    )
    assert max(message.width for message in plots[2].messages) < 6
    wait(
        lambda: (
            {
                f'radar_{k}/{task}'
                for k in (1, 2)
                for task in ('tracker: input', 'radar_simulator: playback')
            }
            <= {entry.name for message in diagnostics.messages for entry in message.status}
        )
    )
    ids = {entry.hardware_id for message in diagnostics.messages for entry in message.status}
    assert ids == {f'radar_{k}/{node}' for k in (1, 2) for node in ('tracker', 'radar_simulator')}
    for process in processes:
        process.stop()


def signalled(launch, number, rounds):
    """In each round start two trackers and a simulator, and signal them at a random moment."""
    rng = random.Random(number)
    for _ in range(rounds):
        started = [
            (launch(TRACKER, *p(use_sim_time='true')), TRACKER),
            (launch(SIMULATOR, *p(scenario='clean', rate=20.0)), SIMULATOR),
            (launch(TRACKER, *p(use_sim_time='true')), TRACKER),
        ]
        for process, module in started:
            assert process.says(READY[module]), process.said
        time.sleep(rng.uniform(0.0, 0.5))
        for process, _ in started:
            process.send(number)
        for process, _ in started:
            assert process.ends() == 0, process.said
            assert 'Traceback' not in process.said and 'Error' not in process.said


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_node_well(launch, number):
    signalled(launch, number, 1)


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_node_well_twenty_times(launch, number):
    signalled(launch, number, 20)
