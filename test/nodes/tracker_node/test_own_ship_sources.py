"""Own ship told badly: no collision picture is wrong without a word, on any output."""

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import String

from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.nmea_output_node import NmeaOutputNode
from marine_tracker.nodes.radar_simulator_node import RadarSimulatorNode
from marine_tracker.nodes.tracker_node import TrackerNode
from marine_tracker.recording.message_faults import BAD_STAMP, WRONG_FRAME
from marine_tracker.tracking import own_ship
from marine_tracker.tracking.scan_input import NO_STAMP

SPEED, SECOND = 13.0, 1_000_000_000  # kn, of own ship; ns
ANCHORED, CROSSING = (2.3, 0, 0, 0), (3, 60, 270, 9)
DOUBTFUL = 'own speed doubtful'


@pytest.fixture(scope='module')
def sea(simulated):
    """Own ship goes north at 13 knots; one ship at anchor dead ahead, one that crosses."""
    return simulated([ANCHORED, CROSSING], 500, SPEED)


@pytest.fixture
def watch(bridge, graph, node_helpers, sea):
    """A bridge with NMEA output: `nmea` and `diagnostics` hear what is said."""

    def make(**parameters):
        here = bridge(sea, sensor_timeout_s=1.0, **parameters)
        _, listener = node_helpers
        here.output = graph.make(NmeaOutputNode, udp='', origin='54.2 8.1', own_ship_period_s=0.1)
        here.nmea = listener(here.other, String, topics.NMEA, topics.reliable(topics.BURST))
        here.diagnostics = here.listen(DiagnosticArray, topics.DIAGNOSTICS)
        here.wait(lambda: here.nmea.connected and here.own_ship.get_subscription_count() == 2)
        return here

    return make


def said(here, kind):
    """Fields of the last sentence of this kind after the scan played last."""
    here.wait(lambda: abs((here.output._last_ns or 0) - here.stamp(here.last.end)) < 9)
    before = len(here.nmea)
    here.wait(
        lambda: len(here.nmea) >= before and len(here.nmea) == here.output._count['sentences']
    )
    for message in reversed(here.nmea.messages):
        if message.data[3:6] == 'TTM' and kind != 'TTM':
            continue
        if message.data[3:6] == kind:
            return message.data.split(',')
        if message.data[3:6] == 'RMC':  # the scan's first: it has none
            return None
    return None


def status(here, name):
    """The last word of /diagnostics under this name."""
    return here.wait(
        lambda: next(
            (
                entry
                for message in reversed(here.diagnostics.messages)
                for entry in message.status
                if entry.name == name
            ),
            None,
        )
    )


def right(here):
    """The picture is that of own ship at 13 knots, north: the ship at anchor is a danger."""
    row = here.rows()[here.name_of(1)]
    assert row['level'] == DiagnosticStatus.ERROR
    assert float(row['speed_kn']) < 1.5
    assert float(row['relative_speed_kn']) == pytest.approx(SPEED, abs=1.5)
    assert any(name.endswith(': danger') for name in here.standing())
    rmc = said(here, 'RMC')
    assert rmc[2] == 'A' and float(rmc[7]) == pytest.approx(SPEED, abs=0.5)
    assert abs((float(rmc[8]) + 180) % 360 - 180) < 5


def pose_only(stamp, position, velocity):
    """As a GPS alone gives it: no orientation, no twist."""
    message = convert.own_ship_to_odometry(stamp, position, (0.0, 0.0), np.pi / 2)
    assert message.pose.pose.orientation.w == 1.0
    return message


def twist_in_map_axes(stamp, position, velocity):
    message = convert.own_ship_to_odometry(stamp, position, velocity)
    message.twist.twist.linear.x, message.twist.twist.linear.y = map(float, velocity)
    return message


@pytest.mark.parametrize('wrong, heads', [(pose_only, False), (twist_in_map_axes, True)])
def test_a_twist_that_contradicts_the_positions_hides_no_danger_and_is_told(watch, wrong, heads):
    here = watch()
    here.odometry = wrong
    here.sail(20)
    right(here)
    here.awaits(DOUBTFUL, 'active unacknowledged')
    assert here.about(here.alarm(DOUBTFUL))['priority'] == 'warning'
    hdt = said(here, 'HDT')
    assert (hdt is not None) is heads and (not heads or hdt[1] == '000.0')
    here.wait(lambda: 'off the positions' in status(here, 'tracker: own ship').message)
    here.wait(lambda: 'off her positions' in status(here, 'nmea_output: output').message)


def test_whoever_says_so_has_the_twist_or_the_positions_without_being_asked(watch):
    here = watch(own_ship_velocity='positions')
    here.odometry = pose_only
    here.sail(20)
    right(here)
    assert DOUBTFUL not in here.standing()


@pytest.mark.parametrize('orientation', [(0.0, 0.0), (float('nan'), float('nan'))])
def test_a_lost_heading_leaves_position_and_speed_and_is_told(watch, orientation):
    here = watch()

    def headless(stamp, position, velocity):
        message = convert.own_ship_to_odometry(stamp, position, velocity)
        message.pose.pose.orientation.z, message.pose.pose.orientation.w = orientation
        return message

    here.sail(8)
    assert said(here, 'HDT')[1] == '000.0'
    here.odometry = headless
    here.sail(12)
    right(here)
    assert said(here, 'HDT') is None
    here.awaits('heading missing', 'active unacknowledged')
    assert not here.tracker.bad_own_ship.counts[own_ship.OWN_NOT_FINITE]


@pytest.mark.parametrize('apart_s', [-37, 43, -7200])
def test_own_ship_on_another_clock_is_paired_by_arrival(watch, apart_s):
    here = watch()
    here.odometry = lambda stamp, *rest: convert.own_ship_to_odometry(
        stamp + apart_s * SECOND, *rest
    )
    here.sail(32)
    right(here)
    assert here.told(own_ship.OWN_BY_ARRIVAL) > 10


def test_own_ship_without_stamps_is_timed_as_she_arrives(watch):
    here = watch()
    here.odometry = lambda stamp, *rest: convert.own_ship_to_odometry(0, *rest)
    here.sail(20)
    row = here.rows()[here.name_of(1)]
    assert float(row['range_nm']) < 2.2  # she follows: not at rest where she began
    assert here.tracker.bad_own_ship.counts[NO_STAMP] == 20
    here.wait(lambda: 'without a stamp' in status(here, 'tracker: own ship').message)


@pytest.mark.parametrize(
    'frame',
    ['lidar_link', *(pytest.param(one, marks=pytest.mark.slow) for one in ('radar', 'odom'))],
)
def test_plots_in_a_frame_of_nobody_are_refused_by_name(watch, frame):
    here = watch()
    for scan in here.scans[:3]:
        message = convert.plots_to_cloud(scan, here.stamp(scan.start))
        message.header.frame_id = frame
        here.radar.publish(message)
    here.wait(lambda: here.told(WRONG_FRAME) == 3)
    assert here.tracker.inputs[0].taken == 0
    here.wait(lambda: WRONG_FRAME in status(here, 'tracker: input').message)
    here.awaits('plots missing', 'active unacknowledged')


@pytest.mark.parametrize('frame', ['', 'map', '/map', 'base_link', 'barge_2'])
def test_plots_in_map_or_own_ships_frame_are_taken(watch, frame):
    here = watch()

    def barge(*told):
        message = convert.own_ship_to_odometry(*told)
        message.child_frame_id = 'barge_2'
        return message

    here.odometry = barge
    here.sail(1)
    for scan in here.scans[1:4]:
        message = convert.plots_to_cloud(scan, here.stamp(scan.start))
        message.header.frame_id = frame
        here.radar.publish(message)
    here.wait(lambda: here.tracker.inputs[0].taken == 4)
    assert not here.told(WRONG_FRAME)


def test_odometry_in_another_frame_is_refused_by_name_and_missed(watch):
    here = watch()

    def adrift(*told):
        message = convert.own_ship_to_odometry(*told)
        message.header.frame_id = 'odom'
        return message

    here.odometry = adrift
    here.sail(4)
    assert here.tracker.bad_own_ship.counts[WRONG_FRAME] == 4
    assert here.output._bad.counts[WRONG_FRAME] == 4
    here.awaits('position missing', 'active unacknowledged')
    assert said(here, 'RMC')[2] == 'V'


def test_stamps_with_too_many_nanoseconds_are_refused_and_tracks_live_on(watch):
    here = watch()
    here.sail(8)
    before, scan = here.names(), here.scans[8]
    cloud = convert.plots_to_cloud(scan, here.stamp(scan.start))
    odometry = convert.own_ship_to_odometry(here.stamp(scan.end), (0.0, 0.0), (0.0, 0.0))
    cloud.header.stamp.nanosec = odometry.header.stamp.nanosec = 3_000_000_001
    here.own_ship.publish(odometry)
    here.radar.publish(cloud)
    here.wait(lambda: here.told(BAD_STAMP) == 2)
    here.sail(3)
    assert here.names() == before
    assert [entry.message for entry in here.targets[-1].status] == ['TRACKING'] * len(before)
    assert not here.tracker.failures.counts


ANCHORAGE = """\
duration_s: 60
own_ship: {speed_kn: 0%s}
targets:
  - {name: ahead, start: {range_nm: 2.1, bearing_deg: 215}, course_deg: 35, speed_kn: 8}
  - {name: abeam, start: {range_nm: 2.1, bearing_deg: 90}, course_deg: 270, speed_kn: 8}
"""
AHEAD = '[{name: ahead, kind: guard, range_nm: [1.5, 2.5], bearing_deg: [330, 30]}]'


@pytest.mark.parametrize('course, found', [(', course_deg: 215', ['ahead']), ('', [])])
def test_own_ship_at_rest_heads_as_the_scenario_says_and_else_nowhere(
    graph, node_helpers, tmp_path, course, found
):
    wait, listener = node_helpers
    path = tmp_path / 'anchorage.yaml'
    path.write_text(ANCHORAGE % course)
    tracker = graph.make(TrackerNode, use_sim_time=True, zones=AHEAD)
    output = graph.make(NmeaOutputNode, udp='', use_sim_time=True)
    node = graph.bystander()
    nmea = listener(node, String, topics.NMEA, topics.reliable(topics.BURST))
    simulator = graph.make(RadarSimulatorNode, scenario=str(path), rate=30.0, seed=4)
    wait(lambda: simulator.done)
    wait(lambda: output._count['sentences'] == len(nmea) > 20)
    alive = tracker._operator.memory.arpa.alerts
    inside = alive.position[alive.zone > 0]
    assert len(inside) == len(found)
    if found:
        bearing = np.degrees(np.arctan2(*inside[0])) % 360
        assert bearing == pytest.approx(215, abs=3)
    told = {message.data.split(',')[1] for message in nmea.messages if message.data[3:6] == 'HDT'}
    assert told == ({'215.0'} if found else set())
