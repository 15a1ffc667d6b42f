"""The tracker node over DDS and `replay` of the same scenario tell the same tracks and alarms."""

import csv

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry

from marine_tracker import cli, config
from marine_tracker.nodes import convert, topics
from marine_tracker.simulation import scenario

# Plots go over DDS as float32: 1 mm at 10 NM. What a filter makes of that stays below these.
PLACE, SPEED = 0.05, 0.01  # m, m/s


def arguments(**parameters):
    pairs = [('-p', f'{name}:={value}') for name, value in parameters.items()]
    return ['--ros-args', *(word for pair in pairs for word in pair)]


def parameters_of(file):
    values = scenario.load(file).tracker_parameters()
    return {k: float(v) if isinstance(v, int) else v for k, v in values.items()}


def rows_of(path):
    with open(path, newline='') as file:
        return list(csv.DictReader(file))


def test_the_node_tells_what_a_replay_tells(launch, graph, node_helpers, tmp_path):
    wait, listener = node_helpers
    whole = config.path('scenarios', 'encounters.yaml').read_text()
    short = tmp_path / 'encounters.yaml'
    short.write_text(whole.replace('duration_s: 1500', 'duration_s: 800'))
    ears = graph.bystander()
    tracks = listener(ears, Odometry, topics.TRACKS, topics.reliable(5000))
    alarms = listener(ears, DiagnosticArray, topics.ALARMS, topics.latched(100))
    tracker = launch('nodes.run tracker', *arguments(use_sim_time='true', **parameters_of(short)))
    assert tracker.says('waiting for')
    wait(lambda: tracks.connected and alarms.connected)
    simulator = launch('nodes.run radar_simulator', *arguments(scenario=short, rate=40.0, seed=3))
    wait(lambda: simulator.process.poll() is not None)

    replayed, told = tmp_path / 'tracks.csv', tmp_path / 'alarms.csv'
    words = ['replay', str(short), '--seed', '3', '--out', str(replayed), '--alarms', str(told)]
    assert cli.main(words) == 0
    expected = [row for row in rows_of(replayed) if row['target'] and row['status'] != 'lost']
    wait(lambda: len(tracks) >= len(expected))
    tracker.stop()

    first_ns = None
    heard = []
    for message in tracks.messages:
        stamp = convert.nanoseconds(message.header.stamp)
        number = message.child_frame_id.removeprefix('track_').lstrip('0')
        position = message.pose.pose.position
        speed = message.twist.twist.linear.x
        first_ns = stamp if first_ns is None else first_ns
        heard.append((number, (stamp - first_ns) * 1e-9, position.x, position.y, speed))
    begin = float(expected[0]['time_s'])
    assert [one[0] for one in heard] == [row['target'] for row in expected]
    wanted = np.array(
        [
            (
                float(row['time_s']) - begin,
                float(row['east_m']),
                float(row['north_m']),
                np.hypot(float(row['vel_east_mps']), float(row['vel_north_mps'])),
            )
            for row in expected
        ]
    )
    found = np.array([one[1:] for one in heard])
    np.testing.assert_allclose(found[:, 0], wanted[:, 0], atol=2e-4)
    np.testing.assert_allclose(found[:, 1:3], wanted[:, 1:3], atol=PLACE)
    np.testing.assert_allclose(found[:, 3], wanted[:, 3], atol=SPEED)

    # The node tells all alerts that are not normal each time that one changes.
    changes, states = [], {}
    for message in alarms.messages:
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            key = values['kind'], values['target']
            if values['kind'].endswith(' missing'):
                continue  # plots, at the end: a replay ends with them
            if states.get(key) != values['state']:
                changes.append((*key, values['state'], status.message))
            states[key] = values['state']
    assert changes == [
        (row['alarm'], row['target'], row['state'], row['text']) for row in rows_of(told)
    ]
    assert len(changes) >= 4
