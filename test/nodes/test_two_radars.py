"""Two radar simulators of one scene and one tracker: as nodes here, and as processes."""

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rclpy.parameter import Parameter
from sensor_msgs.msg import PointCloud2

from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.radar_simulator_node import RadarSimulatorNode
from marine_tracker.nodes.tracker_node import TrackerNode
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking.lifecycle import LOST
from marine_tracker.tracking.radars import fused, merged
from marine_tracker.tracking.tracker import Tracker

X, S = scenario.load('two_radars_x'), scenario.load('two_radars_s')
TOGETHER = fused([X.tracker_parameters(), S.tracker_parameters()], ['radar_x', 'radar_s'])
NAMES = [f'TT{number:02d}' for number in range(1, 7)]


def p(**parameters):
    return [
        '--ros-args',
        *(word for name, value in parameters.items() for word in ('-p', f'{name}:={value}')),
    ]


def statuses(ears):
    """The last status of each name."""
    return {entry.name: entry for message in ears.messages for entry in message.status}


class Bridge:
    """A tracker of both radars, a bystander that plays them, and ears."""

    def __init__(self, graph, node_helpers, **parameters):
        self.wait, listener = node_helpers
        self.told = -np.inf  # s, of own ship
        self.tracker = graph.make(TrackerNode, **{**TOGETHER, **parameters})
        other = graph.bystander()
        self.plots = [
            other.create_publisher(PointCloud2, heard.radar.topic, topics.reliable(50))
            for heard in self.tracker.inputs
        ]
        self.own = other.create_publisher(Odometry, topics.ODOMETRY, topics.reliable(500))
        self.targets = listener(other, DiagnosticArray, topics.TARGETS, topics.latched(50))
        self.alarms = listener(other, DiagnosticArray, topics.ALARMS, topics.latched(100))
        self.diagnostics = listener(other, DiagnosticArray, topics.DIAGNOSTICS)
        self.wait(
            lambda: (
                all(one.get_subscription_count() for one in (*self.plots, self.own))
                and self.targets.connected
            )
        )

    def play(self, scans, shift=0.0):
        for scan in scans:
            heard = self.tracker.inputs[scan.radar]
            before = heard.taken + sum(heard.bad.counts.values())
            for time, position, velocity in zip(*scan.own_ship[:3]):
                if time > self.told:
                    self.own.publish(
                        convert.own_ship_to_odometry(round((1000 + time) * 1e9), position, velocity)
                    )
                    self.told = time
            self.plots[scan.radar].publish(
                convert.plots_to_cloud(scan, round((1000 + scan.start + shift) * 1e9))
            )
            self.wait(lambda b=before, h=heard: h.taken + sum(h.bad.counts.values()) > b)

    def names(self):
        taken = sum(heard.taken for heard in self.tracker.inputs)
        self.wait(lambda: len(self.targets) >= taken)
        return {entry.name for entry in self.targets[-1].status if entry.message != 'LOST'}


@pytest.fixture
def bridge(graph, node_helpers):
    return lambda **parameters: Bridge(graph, node_helpers, **parameters)


def scans_of(seconds):
    return [
        [scan for scan, _ in radar.simulate(one, seed) if scan.end < seconds]
        for seed, one in enumerate((X, S))
    ]


def test_one_radar_fails_and_returns_and_no_target_is_lost(bridge):
    here = bridge(sensor_timeout_s=0.5)
    x, s = scans_of(200)
    here.play(merged(x, [scan for scan in s if scan.end < 60]))
    assert set(NAMES) <= here.names()

    def missing():
        """the alarm names the radar that is silent"""
        return 'plots missing of radar_s' in statuses(here.alarms)

    here.wait(missing)
    said = statuses(here.alarms)['plots missing of radar_s']
    assert said.message.startswith('no plots of radar radar_s for')
    late = [scan for scan in s if scan.end > 190]
    here.play(scan._replace(radar=1) for scan in late)
    assert set(NAMES) <= here.names()
    assert here.tracker.inputs[1].taken == len([scan for scan in s if scan.end < 60]) + len(late)
    assert not here.tracker.inputs[1].bad.counts['clock re-based']


def test_over_dds_the_tracks_are_those_of_the_core(bridge, graph, node_helpers):
    """So what the Monte Carlo runs show of the core holds for the node."""
    here = bridge()
    ears = node_helpers[1](graph.nodes[-1], Odometry, topics.TRACKS)
    here.wait(lambda: here.tracker.count_subscribers('/tracks') and ears.connected)
    scans = list(merged(*scans_of(90)))
    core = Tracker(from_mapping(TrackerParameters, TOGETHER))
    memory, expected = core.start(), []
    for scan in scans:
        memory, report = core.step(memory, scan)
        shown = np.flatnonzero((report.tracks.number > 0) & (report.tracks.status != LOST))
        now = core.extrapolate(report.tracks, report.time)
        expected += [
            (f'track_{report.tracks.number[row]:02d}', now.position[row])
            for row in shown[np.argsort(report.tracks.number[shown])]
        ]
    here.play(scans)
    here.wait(lambda: len(ears) >= len(expected))
    assert [message.child_frame_id for message in ears.messages] == [n for n, _ in expected]
    found = [[m.pose.pose.position.x, m.pose.pose.position.y] for m in ears.messages]
    # Plots go as float32; own ship between her samples is a straight line both times.
    np.testing.assert_allclose(found, [position for _, position in expected], atol=0.5)


def test_diagnostics_tell_of_each_radar_by_its_name(bridge):
    here = bridge()
    x, _ = scans_of(20)
    here.play(x)

    def told():
        """one status a radar"""
        return {'tracker: input radar_x', 'tracker: input radar_s'} <= set(
            statuses(here.diagnostics)
        )

    here.wait(told)
    here.wait(
        lambda: statuses(here.diagnostics)['tracker: input radar_x'].message == 'plots come in'
    )
    assert statuses(here.diagnostics)['tracker: input radar_s'].message == (
        'no plots yet on radar_s/radar/plots'
    )


def test_a_parameter_that_no_radar_has_of_its_own_changes_for_both(bridge):
    here = bridge()
    (answer,) = here.tracker.set_parameters([Parameter('max_plots', value=5)])
    assert answer.successful
    here.play(merged(*scans_of(10)))
    for heard in here.tracker.inputs:
        assert heard.bad.counts['plots over max_plots'] > 0
        assert heard.radar.parameters.range_sigma_m != 15.0  # its own stays


def test_a_radar_whose_clock_differs_is_told_of_and_does_not_move_the_tracks(bridge):
    here = bridge()
    x, s = scans_of(60)
    here.play(x)
    here.play((scan._replace(radar=1) for scan in s[:6]), shift=5000.0)
    assert here.tracker.inputs[1].taken == 0
    assert here.tracker.inputs[1].bad.counts['scans with a time far from other radars'] == 6
    assert set(NAMES) <= here.names()


def test_a_radar_that_comes_up_later_joins_the_scene_where_it_is(graph, node_helpers):
    wait, listener = node_helpers
    node = graph.bystander()
    ears = listener(node, PointCloud2, '/radar_s/radar/plots')
    listener(node, Odometry, '/radar_s/own_ship/odometry')
    now = node.get_clock().now().nanoseconds * 1e-9
    graph.make(
        RadarSimulatorNode,
        ('-r', '__ns:=/radar_s'),
        scenario='two_radars_s',
        seed=3,
        begin_at_s=now - 300.0,
    )
    wait(lambda: len(ears) > 0)
    offset = convert.nanoseconds(ears[0].header.stamp) * 1e-9 - (now - 300.0)
    whole = offset / S.radar.scan_period
    assert 295 < offset < 330 and whole == pytest.approx(round(whole), abs=1e-3)
    expected = next(scan for scan, _ in radar.simulate(S, 3) if scan.start > offset - 1e-3)
    np.testing.assert_allclose(
        convert.cloud_to_plots(ears[0]).range, expected.plots.range, rtol=1e-6
    )


@pytest.mark.slow
def test_two_simulators_and_a_tracker_as_processes(launch, graph, node_helpers, tmp_path):
    wait, listener = node_helpers
    ears = listener(graph.bystander(), DiagnosticArray, topics.TARGETS, topics.latched(50))
    file = tmp_path / 'tracker.yaml'
    file.write_text(
        '/**:\n  ros__parameters:\n    use_sim_time: true\n'
        + ''.join(
            f'    {name}: {float(value) if isinstance(value, float | int) else repr(value)}\n'
            for name, value in TOGETHER.items()
            if name != 'radars'
        )
        + '    radars: |\n'
        + ''.join(f'      {line}\n' for line in TOGETHER['radars'].splitlines())
    )
    tracker = launch('nodes.run tracker', '--ros-args', '--params-file', str(file))
    wait(lambda: ears.connected)
    second = launch(
        'nodes.run radar_simulator',
        *p(scenario='two_radars_s', seed=2, begin_at_s=1.0, use_sim_time='true'),
        '-r',
        '__ns:=/radar_s',
    )
    first = launch(
        'nodes.run radar_simulator',
        *p(scenario='two_radars_x', rate=25.0),
        '-r',
        '__ns:=/radar_x',
        '-r',
        '/radar_x/own_ship/odometry:=/own_ship/odometry',
    )

    def all_held():
        return len(ears) and set(NAMES) <= {
            entry.name for entry in ears[-1].status if entry.message != 'LOST'
        }

    wait(all_held)
    second.stop()  # the S band radar fails ...
    heard = len(ears)
    wait(lambda: len(ears) > heard + 25)
    assert all_held()
    again = launch(
        'nodes.run radar_simulator',
        *p(scenario='two_radars_s', seed=2, begin_at_s=1.0, use_sim_time='true'),
        '-r',
        '__ns:=/radar_s',
    )
    diagnostics = listener(graph.bystander('other'), DiagnosticArray, topics.DIAGNOSTICS)

    def returned():
        """and is heard again"""
        return statuses(diagnostics).get('tracker: input radar_s', tracker) and (
            statuses(diagnostics)['tracker: input radar_s'].message == 'plots come in'
        )

    again.says('scenario')
    heard = len(ears)
    wait(lambda: len(ears) > heard + 20)
    wait(lambda: 'tracker: input radar_s' in statuses(diagnostics) and returned())
    assert all_held()
    for process in (first, again, tracker):
        process.stop()
