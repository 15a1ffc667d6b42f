"""A radar that sends sectors, over DDS: tracks come soon after the beam, targets once a
revolution."""

import time

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry

from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.radar_simulator_node import RadarSimulatorNode
from marine_tracker.nodes.tracker_node import TrackerNode
from marine_tracker.simulation import scenario

PERIOD = 60 / 24  # s

SCENE = """
duration_s: 60
radar: {rotation_rpm: 24, max_range_nm: 6, range_sigma_m: 12, bearing_sigma_deg: 0.4, pd_near: 1,
        pd_far: 1, sectors: 16}
clutter: {uniform: 30}
own_ship: {course_deg: 20, speed_kn: 9}
targets:
"""


@pytest.fixture
def scene(tmp_path):
    """Fourteen ships all around, the scenario's path."""
    rng = np.random.default_rng(3)
    file = tmp_path / 'sectors.yaml'
    file.write_text(
        SCENE
        + ''.join(
            f'  - {{start: {{range_nm: {rng.uniform(1, 5):.2f}, bearing_deg: {25 * k + 7}}}, '
            f'course_deg: {rng.uniform(0, 360):.0f}, speed_kn: {rng.uniform(5, 18):.1f}}}\n'
            for k in range(14)
        )
    )
    return str(file)


def parameters_of(scene):
    values = scenario.load(scene).tracker_parameters()
    return {k: float(v) if isinstance(v, int) else v for k, v in values.items()}


def test_targets_come_once_a_revolution_and_the_node_knows_the_rotation(graph, node_helpers, scene):
    wait, listener = node_helpers
    ears = graph.bystander()
    targets = listener(ears, DiagnosticArray, topics.TARGETS, topics.latched(400))
    told = listener(ears, DiagnosticArray, topics.DIAGNOSTICS, topics.reliable())
    values = {**parameters_of(scene), 'scan_period_s': 60 / 22}  # not quite right
    graph.make(TrackerNode, use_sim_time=True, **values)
    wait(lambda: targets.connected)
    simulator = graph.make(RadarSimulatorNode, scenario=scene, rate=4.0)
    wait(lambda: simulator.done)
    wait(lambda: len(targets) >= 20)
    stamps = np.array([convert.nanoseconds(one.header.stamp) for one in targets.messages]) * 1e-9
    assert np.diff(stamps[3:]) == pytest.approx(PERIOD, abs=0.05)
    assert len(targets.messages[-1].status) >= 14
    values = [
        {pair.key: pair.value for pair in status.values}
        for message in told.messages
        for status in message.status
        if status.name.endswith('input')
    ]
    assert float(values[-1]['period_s']) == pytest.approx(PERIOD, rel=2e-3)
    assert values[-1]['sectors'] == '16'


@pytest.mark.slow
def test_a_track_comes_within_an_eighth_of_a_revolution_after_the_beam(
    launch, graph, node_helpers, scene
):
    """The 99th percentile, beam to track, in real time."""
    wait, _ = node_helpers
    ears, late = graph.bystander(), []

    def hear(message):
        late.append(time.time() - convert.nanoseconds(message.header.stamp) * 1e-9)

    ears.create_subscription(Odometry, topics.TRACKS, hear, topics.reliable(5000))
    pairs = [('-p', f'{name}:={value}') for name, value in parameters_of(scene).items()]
    words = [word for pair in pairs for word in pair]
    tracker = launch('nodes.run tracker', '--ros-args', *words)
    assert tracker.says('waiting for')
    simulator = launch('nodes.run radar_simulator', '--ros-args', '-p', f'scenario:={scene}')
    wait(lambda: simulator.process.poll() is not None, 120)
    tracker.stop()
    assert len(late) > 14 * 20
    assert np.percentile(late, 99) < PERIOD / 8
