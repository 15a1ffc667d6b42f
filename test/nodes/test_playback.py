import time

import numpy as np
import pytest
from pyproj import Geod

pytest.importorskip('rclpy')
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import NavSatFix, PointCloud, PointCloud2

from marine_tracker.geodesy import LocalFrame
from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.playback import Revolution, _repeat, own_ship_period
from marine_tracker.nodes.radar_simulator_node import RadarSimulatorNode
from marine_tracker.nodes.recording_player_node import RecordingPlayerNode
from marine_tracker.recording import csv_folder
from marine_tracker.simulation import radar, scenario

PERIOD_NS = round(60e9 / 22)


def stamps(messages):
    return np.array([convert.nanoseconds(message.header.stamp) for message in messages])


@pytest.fixture
def ears(graph, node_helpers):
    """Listeners on all that a playback publishes."""
    _, listener = node_helpers
    node = graph.bystander()
    return {
        topic: listener(node, kind, topic, topics.reliable(2000))
        for kind, topic in (
            (PointCloud2, topics.PLOTS),
            (PointCloud, topics.PLOTS_READABLE),
            (Odometry, topics.ODOMETRY),
            (Odometry, topics.TRUTH),
            (NavSatFix, topics.FIX),
            (Clock, '/clock'),
        )
    }


@pytest.fixture(scope='module')
def short(tmp_path_factory):
    """A scenario of 30 s with a place on earth."""
    path = tmp_path_factory.mktemp('scenario') / 'short.yaml'
    path.write_text("""\
duration_s: 30
origin: {lat_deg: 54.0, lon_deg: 8.0}
own_ship: {course_deg: 90, speed_kn: 12}
targets:
  - {name: one, start: {range_nm: 3, bearing_deg: 10}, course_deg: 180, speed_kn: 10}
  - {name: two, start: {range_nm: 4, bearing_deg: 200}, course_deg: 0, speed_kn: 15}
""")
    return str(path)


def test_a_scenario_is_published_as_it_is_simulated(graph, node_helpers, ears, short):
    wait, _ = node_helpers
    node = graph.make(RadarSimulatorNode, scenario=short, rate=30.0, seed=7)
    wait(lambda: node.done)
    pairs = list(radar.simulate(scenario.load(short), 7))
    plots = ears[topics.PLOTS]
    wait(lambda: len(plots) == len(ears[topics.PLOTS_READABLE]) == len(pairs))
    # Simulated time begins at 1 s; the scenario's at 0.
    assert stamps(plots.messages) == pytest.approx(
        [1e9 * (1 + scan.start) for scan, _ in pairs], abs=2
    )
    for message, (scan, _) in zip(plots.messages, pairs):
        got = convert.cloud_to_plots(message)
        assert got.range == pytest.approx(scan.plots.range, rel=1e-6)
        assert got.bearing == pytest.approx(scan.plots.bearing, abs=1e-6)
    truth = ears[topics.TRUTH]
    wait(lambda: len(truth) == sum(len(truth.time) for _, truth in pairs))
    told = iter(truth.messages)
    for _, exact in pairs:
        for target, at, position in zip(exact.target, exact.time, exact.position):
            message = next(told)
            assert message.child_frame_id == f'target_{target}'
            assert convert.nanoseconds(message.header.stamp) == pytest.approx(1e9 * (1 + at), abs=2)
            assert convert.odometry_to_own_ship(message)[0] == pytest.approx(position)
    assert not graph.errors


def test_own_ship_its_fix_and_the_clock_cover_each_scan_in_order(graph, node_helpers, ears, short):
    wait, _ = node_helpers
    node = graph.make(RadarSimulatorNode, scenario=short, rate=30.0)
    wait(lambda: node.done)
    own, fixes, clock = ears[topics.ODOMETRY], ears[topics.FIX], ears['/clock']
    wait(lambda: len(ears[topics.PLOTS]) >= 11 and len(own) == len(fixes) >= 22)
    at = stamps(own.messages)
    assert (np.diff(at) > 0).all()
    assert np.diff(at).max() * 1e-9 <= 1.3 * own_ship_period(30.0)
    ends = 1e9 + np.arange(1, 12) * PERIOD_NS  # each known before its plots are out
    assert np.abs(ends[:, None] - at).min(1).max() < 100
    for message, fix in zip(own.messages, fixes.messages):
        position, velocity = convert.odometry_to_own_ship(message)
        assert velocity == pytest.approx([12 * 1852 / 3600, 0.0], abs=1e-6)
        assert (fix.latitude, fix.longitude) == pytest.approx(
            LocalFrame(54.0, 8.0).to_geodetic(position)
        )
    ticks = np.array([convert.nanoseconds(message.clock) for message in clock.messages])
    assert (np.diff(ticks) >= 0).all() and ticks[0] >= 1e9 and len(ticks) > 20


@pytest.mark.parametrize(
    ('place', 'course'), [((-17.0, 179.9995), 90.0), ((81.5, -179.998), 270.0)]
)
def test_fixes_follow_own_ship_over_the_date_line(
    graph, node_helpers, ears, tmp_path, place, course
):
    """20 kn for 16 s, by the geodesic of pyproj."""
    path = tmp_path / 'line.yaml'
    path.write_text(
        'duration_s: 16\n'
        f'own_ship: {{start: {{lat_deg: {place[0]}, lon_deg: {place[1]}}}, '
        f'course_deg: {course}, speed_kn: 20}}\n'
        'targets:\n  - {start: {range_nm: 3, bearing_deg: 10}, course_deg: 180, speed_kn: 10}\n'
    )
    wait, _ = node_helpers
    node = graph.make(RadarSimulatorNode, scenario=str(path), rate=30.0)
    wait(lambda: node.done)
    own, fixes = ears[topics.ODOMETRY], ears[topics.FIX]
    wait(lambda: len(ears[topics.PLOTS]) >= 5 and len(own) == len(fixes) >= 10)
    earth = Geod(ellps='WGS84')
    for message, fix in zip(own.messages, fixes.messages):
        sailed = np.hypot(*convert.odometry_to_own_ship(message)[0])
        lon, lat, _ = earth.fwd(*place[::-1], course, sailed)
        assert earth.inv(fix.longitude, fix.latitude, lon, lat)[2] < 0.1
        assert -180 <= fix.longitude < 180
    assert np.sign(fixes.messages[0].longitude) == -np.sign(fixes.messages[-1].longitude)


def test_the_period_is_kept_within_one_percent_by_the_wall(launch, graph, node_helpers):
    wait, listener = node_helpers
    arrivals, node = [], graph.bystander()
    node.create_subscription(
        PointCloud2,
        topics.PLOTS,
        lambda message: arrivals.append((time.monotonic(), message.header.stamp)),
        topics.best_available(),
    )
    own_ship = listener(node, Odometry, topics.ODOMETRY)
    process = launch('nodes.run radar_simulator', '--ros-args', '-p', 'scenario:=clean')
    wait(lambda: len(arrivals) >= 3)
    process.stop()
    wall = np.array([at for at, _ in arrivals])
    sent = np.array([convert.nanoseconds(stamp) for _, stamp in arrivals])
    assert (wall[2] - wall[0]) / 2 == pytest.approx(60 / 22, rel=0.01)
    assert np.diff(sent) == pytest.approx(PERIOD_NS, abs=2)
    # At rate 1 the stamps are the node's clock: a scan arrives when it has ended.
    late = time.time() - (time.monotonic() - wall[2]) - (sent[2] + PERIOD_NS) * 1e-9
    assert abs(late) < 0.5
    assert len(own_ship) >= 2 * 27  # 10 Hz


def test_a_rate_of_forty_is_forty_times_as_fast(graph, node_helpers, ears):
    wait, _ = node_helpers
    graph.make(RadarSimulatorNode, scenario='clean', rate=40.0)
    wait(lambda: len(ears[topics.PLOTS]) >= 2)
    began, count = time.monotonic(), len(ears[topics.PLOTS])
    wait(lambda: len(ears[topics.PLOTS]) >= count + 22)
    assert time.monotonic() - began == pytest.approx(1.5, rel=0.2)


def test_a_machine_too_slow_for_the_rate_loses_nothing(graph, node_helpers, ears, short):
    wait, _ = node_helpers
    node = graph.make(RadarSimulatorNode, scenario=short, rate=1000.0)
    wait(lambda: node.done)
    wait(lambda: len(ears[topics.PLOTS]) == 11)
    assert np.diff(stamps(ears[topics.PLOTS].messages)) == pytest.approx(PERIOD_NS, abs=2)


def test_a_recording_is_published_as_it_was_recorded(graph, node_helpers, ears, short, tmp_path):
    wait, _ = node_helpers
    chosen = scenario.load(short)
    csv_folder.write(
        tmp_path / 'rec', 'short', radar.simulate(chosen, 2), chosen.tracker_parameters()
    )
    recording = csv_folder.read(tmp_path / 'rec')
    node = graph.make(RecordingPlayerNode, folder=str(tmp_path / 'rec'), rate=30.0)
    wait(lambda: node.done)
    plots, own = ears[topics.PLOTS], ears[topics.ODOMETRY]
    wait(lambda: len(plots) == len(own) == len(recording.scans))
    for k, scan in enumerate(recording.scans):
        assert convert.nanoseconds(plots[k].header.stamp) == pytest.approx(
            1e9 * (1 + scan.start), abs=2
        )
        got = convert.cloud_to_plots(plots[k])
        assert got.range == pytest.approx(scan.plots.range, rel=1e-6)
        position, velocity = convert.odometry_to_own_ship(own[k])
        assert position == pytest.approx(recording.own_ship.position[k])
        assert velocity == pytest.approx(recording.own_ship.velocity[k])
    wait(lambda: len(ears[topics.TRUTH]) == sum(len(t.time) for t in recording.truths))
    assert len(ears[topics.FIX]) == 0


def test_the_real_recording_is_published_whole(graph, node_helpers, ears, recordings):
    wait, _ = node_helpers
    folder = recordings / 'autosea_joyride'
    node = graph.make(RecordingPlayerNode, folder=str(folder), rate=600.0)
    wait(lambda: node.done)
    recording = csv_folder.read(folder)
    wait(lambda: len(ears[topics.PLOTS]) == len(recording.scans) == 238)
    assert sum(message.width for message in ears[topics.PLOTS].messages) == 432


def test_a_loop_follows_on_and_never_ends(graph, node_helpers, ears, short):
    wait, _ = node_helpers
    node = graph.make(RadarSimulatorNode, scenario=short, rate=60.0, loop=True)
    wait(lambda: len(ears[topics.PLOTS]) >= 26)
    assert np.diff(stamps(ears[topics.PLOTS].messages)) == pytest.approx(PERIOD_NS, abs=5)
    assert (np.diff(stamps(ears[topics.ODOMETRY].messages)) > 0).all()
    assert not node.done


def test_a_recording_of_one_scan_can_loop(short):
    scan, truth = next(radar.simulate(scenario.load(short), 1))
    rounds = _repeat(lambda: iter([Revolution(scan, truth, scan.own_ship)]))
    starts = [next(rounds).scan.start for _ in range(4)]
    assert np.diff(starts) == pytest.approx(scan.end - scan.start)


@pytest.mark.parametrize(
    'kind, parameters, said',
    [
        (RadarSimulatorNode, {'scenario': 'atlantis'}, 'atlantis'),
        (RadarSimulatorNode, {'rate': 0.0}, 'parameter rate is 0'),
        (RadarSimulatorNode, {'seed': -1}, 'parameter seed is -1'),
        (RecordingPlayerNode, {}, 'parameter folder is empty'),
        (RecordingPlayerNode, {'folder': '/nowhere'}, '/nowhere'),
        (RecordingPlayerNode, {'speed': 2.0}, 'unknown parameter speed'),
    ],
)
def test_a_wrong_parameter_stops_the_start(graph, kind, parameters, said):
    with pytest.raises(ValueError, match=said):
        graph.make(kind, **parameters)
