"""What the tracker node costs, two processes over DDS. Slow: it runs at the radar's own pace."""

import time

import numpy as np
import psutil
import pytest

pytest.importorskip('rclpy')
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2

from marine_tracker import config
from marine_tracker.geometry import to_range_bearing
from marine_tracker.nodes import convert, topics
from marine_tracker.simulation import radar, scenario
from marine_tracker.types import OwnShip, PolarPlots, Scan
from marine_tracker.yaml_file import read_mapping

PERIOD = 60 / 22


def scans(targets, clutter, count):
    """Targets at constant velocity and uniform clutter around an own ship at rest."""
    rng = np.random.default_rng(1)
    position, velocity = rng.uniform(-14e3, 14e3, (targets, 2)), rng.normal(0, 5, (targets, 2))
    own_ship = OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))
    for k in range(count):
        distance, bearing = to_range_bearing(position + k * PERIOD * velocity)
        distance = np.concatenate(
            [distance + rng.normal(0, 10, targets), 20e3 * np.sqrt(rng.uniform(0, 1, clutter))]
        )
        bearing = np.mod(
            np.concatenate(
                [bearing + rng.normal(0, 0.005, targets), rng.uniform(0, 2 * np.pi, clutter)]
            ),
            2 * np.pi,
        )
        plots = PolarPlots(
            bearing / (2 * np.pi) * PERIOD, distance, bearing, np.full(targets + clutter, 15.0)
        )
        yield Scan(0.0, PERIOD, plots, own_ship)


class Load:
    """Feeds a tracker process with scans `spacing` s apart, and own ship at 10 Hz."""

    def __init__(self, graph, launch, node_helpers, **parameters):
        self.wait, listener = node_helpers
        told = [f'{name}:={value}' for name, value in parameters.items()]
        self.process = launch(
            'nodes.run tracker', '--ros-args', *(word for one in told for word in ('-p', one))
        )
        node = graph.bystander()
        self.plots = node.create_publisher(PointCloud2, topics.PLOTS, topics.reliable())
        self.own_ship = node.create_publisher(Odometry, topics.ODOMETRY, topics.reliable())
        self.arrived = []
        node.create_subscription(
            PointCloud2,
            topics.TRACKS_CLOUD,
            lambda message: self.arrived.append((time.perf_counter(), message)),
            10,
        )
        self.wait(lambda: self.plots.get_subscription_count())

    def run(self, scans, spacing):
        """Latency [scans] s of each scan, plots in to tracks out."""
        start_ns, began, latency = time.time_ns(), time.monotonic(), []
        for k, scan in enumerate(scans):
            while time.monotonic() < began + k * spacing:
                now = (time.monotonic() - began) * PERIOD / spacing
                self.own_ship.publish(
                    convert.own_ship_to_odometry(
                        start_ns + round(now * 1e9), [0.0, 0.0], [0.0, 0.0]
                    )
                )
                time.sleep(0.1)
            heard, sent = len(self.arrived), time.perf_counter()
            self.plots.publish(convert.plots_to_cloud(scan, start_ns + round(k * PERIOD * 1e9)))
            self.wait(lambda heard=heard: len(self.arrived) > heard)
            latency.append(self.arrived[-1][0] - sent)
        return np.array(latency)

    def share(self, scans):
        """Part of one core that the tracker takes at the radar's pace."""
        tracker = psutil.Process(self.process.process.pid)
        before, began = tracker.cpu_times(), time.monotonic()
        self.run(scans, PERIOD)
        after, wall = tracker.cpu_times(), time.monotonic() - began
        return (after.user + after.system - before.user - before.system) / wall

    def confirmed(self):
        rows = np.frombuffer(self.arrived[-1][1].data, convert.TRACK_TYPE)
        return int((rows['number'] > 0).sum())


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_forty_targets_and_two_hundred_clutter_plots_cost_little(graph, launch, node_helpers):
    load = Load(graph, launch, node_helpers)
    everything = list(scans(40, 200, 26))
    load.run(everything[:6], PERIOD)
    share = load.share(everything[6:])
    print(f'{100 * share:.2f} % of one core')
    assert load.confirmed() >= 40
    assert share <= 0.03


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_two_hundred_tracks_are_out_within_fifty_milliseconds(graph, launch, node_helpers):
    load = Load(graph, launch, node_helpers)
    latency = load.run(scans(200, 50, 110), 0.4)[10:]
    p50, p99 = np.percentile(latency, [50, 99])
    print(f'plots in to tracks out: p50 {1e3 * p50:.1f} ms, p99 {1e3 * p99:.1f} ms')
    assert load.confirmed() >= 195
    assert p99 <= 0.050


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.parametrize('extent', ['random_matrix', 'gp'])
def test_five_hulls_cost_at_most_fifteen_percent_of_one_core(graph, launch, node_helpers, extent):
    values = read_mapping(config.path('scenarios', 'hulls.yaml'))
    values['own_ship'] = {}
    sea = scenario.build(values, 'hulls')
    hulls = [scan for (scan, _), _ in zip(radar.simulate(sea, 1), range(34))]
    told = sea.tracker_parameters()
    load = Load(
        graph,
        launch,
        node_helpers,
        extent=extent,
        **{
            name: told[name]
            for name in (
                'range_sigma_m',
                'bearing_sigma_deg',
                'range_resolution_m',
                'beam_width_deg',
            )
        },
    )
    load.run(hulls[:14], PERIOD)
    share = load.share(hulls[14:])
    print(f'extent {extent}: {100 * share:.2f} % of one core')
    assert load.confirmed() == 5
    assert share <= 0.15
