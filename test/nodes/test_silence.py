"""Pauses of plots, stopped processes and single wrong stamps: tracks are kept, none is wrong."""

import signal
import time

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2

from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.radar_simulator_node import RadarSimulatorNode
from marine_tracker.nodes.tracker_node import TrackerNode
from marine_tracker.simulation import scenario
from marine_tracker.tracking import intake, own_ship

STRAIT = 'busy_strait'
SECOND, NEAR = 1_000_000_000, 400.0  # ns; m
RATE = 8.0


@pytest.fixture(scope='module')
def strait():
    return scenario.load(STRAIT)


def parameters(strait):
    values = strait.tracker_parameters()
    return {k: float(v) if isinstance(v, int) else v for k, v in values.items()}


class Shown:
    """What is on `tracks`: for each number the scenario's ship that is nearest to its track."""

    def __init__(self, strait, listener, node):
        self._strait = strait
        self.tracks = listener(node, Odometry, topics.TRACKS, topics.reliable(5000))

    def ships(self):
        """{number: ship} by the last message of each track of late; 0 for none."""
        found, newest = {}, convert.nanoseconds(self.tracks[-1].header.stamp)
        for message in self.tracks.messages[-400:]:
            stamp = convert.nanoseconds(message.header.stamp)
            if stamp < newest - 6 * SECOND:  # two revolutions: the last may not be whole yet
                continue
            at = stamp * 1e-9 - 1.0  # simulated time begins at 1 s
            truth, position = self._strait.truth_at(at), message.pose.pose.position
            away = np.hypot(*(truth.position - [position.x, position.y]).T)
            near = int(truth.target[away.argmin()]) if away.min() < NEAR else 0
            found[message.child_frame_id] = near
        return found


class Strait:
    """Simulator and tracker at 8 times real speed, and between them a relay that can be deaf."""

    def __init__(self, graph, node_helpers, strait):
        self.wait, listener = node_helpers
        self.tracker = graph.make(TrackerNode, use_sim_time=True, **parameters(strait))
        node = graph.bystander()
        self.shown = Shown(strait, listener, node)
        self._out = node.create_publisher(PointCloud2, topics.PLOTS, topics.reliable())
        self._own = node.create_publisher(Odometry, topics.ODOMETRY, topics.reliable(50))
        node.create_subscription(PointCloud2, 'sim/plots', self._relay, topics.reliable())
        node.create_subscription(Odometry, 'sim/own_ship', self._relay_own, topics.reliable(50))
        self.wait(lambda: self._out.get_subscription_count() and self.shown.tracks.connected)
        self.time, self._deaf, self._wrong, self._wrong_own = 0.0, (0.0, 0.0), [], []
        self.simulator = graph.make(
            RadarSimulatorNode,
            ('-r', f'{topics.PLOTS}:=sim/plots', '-r', f'{topics.ODOMETRY}:=sim/own_ship'),
            scenario=STRAIT,
            rate=RATE,
            seed=6,
        )

    def _relay(self, message):
        self.time = convert.nanoseconds(message.header.stamp) * 1e-9
        if self._wrong:
            ahead, full = self._wrong.pop()
            message.header.stamp = convert.time_message(round((self.time + ahead) * 1e9))
            if not full:
                message.width = message.row_step = 0
                message.data = []
        if not self._deaf[0] < self.time <= self._deaf[1]:
            self._out.publish(message)

    def _relay_own(self, message):
        if self._wrong_own:
            stamp = convert.nanoseconds(message.header.stamp)
            message.header.stamp = convert.time_message(stamp + self._wrong_own.pop() * SECOND)
        self._own.publish(message)

    def until(self, seconds):
        self.wait(lambda: self.time >= seconds)

    def silent(self, seconds):
        self._deaf = (self.time, self.time + seconds)
        self.until(self._deaf[1] + 20)


@pytest.fixture
def sailing(graph, node_helpers, strait):
    return Strait(graph, node_helpers, strait)


@pytest.mark.slow
def test_a_pause_above_rate_1_is_extrapolated_over(sailing):
    sailing.until(110)
    before = {name: ship for name, ship in sailing.shown.ships().items() if ship}
    taken = sailing.tracker.inputs[0].taken
    sailing.silent(41)
    after = sailing.shown.ships()
    assert len(before) >= 38
    assert sum(after.get(name) == ship for name, ship in before.items()) >= 0.9 * len(before)
    assert not [name for name, ship in before.items() if after.get(name, 0) not in (0, ship)]
    assert sailing.tracker.inputs[0].taken >= taken + 5
    assert not sailing.tracker.inputs[0].bad.counts[intake.REBASED]


@pytest.mark.slow
def test_single_stamps_ahead_of_plots_or_own_ship_cost_no_track(sailing):
    sailing.until(110)
    before = {name: ship for name, ship in sailing.shown.ships().items() if ship}
    for k, (ahead, full) in enumerate([(6, True), (14, False), (19, True), (29, True)]):
        sailing._wrong.append((ahead, full))
        sailing.until(125 + 25 * k)
        sailing._wrong_own.append(ahead)
        sailing.until(135 + 25 * k)
    after = sailing.shown.ships()
    assert {name: after.get(name) for name in before} == before and len(before) >= 38
    assert sailing.tracker.inputs[0].bad.counts[intake.JUMPED_AHEAD] == 4
    assert sailing.tracker.bad_own_ship.counts[own_ship.OWN_JUMPED_AHEAD] == 4


@pytest.mark.slow
@pytest.mark.parametrize('stopped', ['tracker', 'radar_simulator'])
def test_a_stopped_process_goes_on_at_the_next_scan_with_its_tracks(
    launch, graph, node_helpers, strait, stopped
):
    wait, listener = node_helpers
    node = graph.bystander()
    shown = Shown(strait, listener, node)
    targets = listener(node, DiagnosticArray, topics.TARGETS, topics.latched(50))

    def arguments(**values):
        pairs = [('-p', f'{name}:={value}') for name, value in values.items()]
        return ['--ros-args', *(word for pair in pairs for word in pair)]

    processes = {
        'tracker': launch(
            'nodes.run tracker', *arguments(use_sim_time='true', **parameters(strait))
        )
    }
    assert processes['tracker'].says('waiting for')
    wait(lambda: targets.connected and shown.tracks.connected)
    rate = 5.0
    processes['radar_simulator'] = launch(
        'nodes.run radar_simulator', *arguments(scenario=STRAIT, rate=rate, seed=9)
    )

    def now():
        return convert.nanoseconds(targets[-1].header.stamp) * 1e-9 if len(targets) else 0.0

    wait(lambda: now() > 80)
    before = {name: ship for name, ship in shown.ships().items() if ship}
    processes[stopped].send(signal.SIGSTOP)
    time.sleep(34 / rate)
    heard, stood = len(targets), now()
    processes[stopped].send(signal.SIGCONT)
    woken = time.monotonic()
    wait(lambda: len(targets) > heard)
    assert time.monotonic() - woken < 3.0  # s; a revolution takes 0.55 s
    wait(lambda: now() > stood + (50 if stopped == 'tracker' else 15))
    after = shown.ships()
    kept = sum(after.get(name) == ship for name, ship in before.items())
    assert len(before) >= 35 and kept >= 0.9 * len(before)
    assert not [name for name, ship in before.items() if after.get(name, 0) not in (0, ship)]
