"""Own ship's sensors over DDS: offsets, the log, a heading and positions that are lost."""

import math
import time

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import TwistStamped
from std_msgs.msg import String

from marine_tracker.geometry import KNOT, NAUTICAL_MILE, own_ship_at, to_range_bearing
from marine_tracker.nodes import convert, own_sensors, topics
from marine_tracker.nodes.nmea_output_node import NmeaOutputNode

SPEED = 12.0  # kn, of own ship, to the north
AHEAD, ABEAM = (2.2, 0, 180, 8), (2.6, 285, 0, 0)
TIMEOUT = 0.7  # s of the wall


@pytest.fixture(scope='module')
def sea(simulated):
    return simulated([AHEAD, ABEAM], 460, SPEED)


@pytest.fixture
def watch(bridge, graph, node_helpers, sea):
    """A bridge with a log, NMEA output, and ears for own ship's state."""

    def make(gps=(0.0, 0.0), **parameters):
        here = bridge(sea, sensor_timeout_s=TIMEOUT, own_ship_timeout_s=TIMEOUT, **parameters)
        _, listener = node_helpers
        here.output = graph.make(
            NmeaOutputNode,
            udp='',
            origin='-33.9 18.3',
            sentences='RMC HDT OSD TTM TLL VHW RSD',
            own_ship_period_s=0.1,
            gps_ahead_m=gps[0],
            gps_starboard_m=gps[1],
        )
        here.nmea = listener(here.other, String, topics.NMEA, topics.reliable(topics.BURST))
        here.states = listener(here.other, DiagnosticArray, topics.OWN_SHIP_STATE, topics.latched())
        here.log = here.other.create_publisher(TwistStamped, topics.LOG, topics.reliable())
        here.wait(
            lambda: (
                here.nmea.connected
                and here.states.connected
                and here.log.get_subscription_count()
                and here.own_ship.get_subscription_count() == 2
                and here.output.count_publishers('own_ship/state')
            )
        )
        return here

    return make


def say(here, ahead, port=0.0, frame='base_link'):
    message = TwistStamped()
    message.header.frame_id = frame
    message.twist.linear.x, message.twist.linear.y = float(ahead), float(port)
    here.log.publish(message)


def state(here):
    """Own ship's state after the scan played last: the entry's message, and its values."""
    stamp = here.stamp(here.last.end)
    here.wait(
        lambda: (
            len(here.states) and abs(convert.nanoseconds(here.states[-1].header.stamp) - stamp) < 9
        )
    )
    entry = here.states[-1].status[0]
    return entry, here.about(entry)


def sentence(here, kind, number='01'):
    """Fields of the last such sentence of the scan played last; of TTM and TLL that of a target."""
    here.wait(lambda: abs((here.output._last_ns or 0) - here.stamp(here.last.end)) < 9)
    here.wait(lambda: len(here.nmea) == here.output._count['sentences'])
    said = [message.data.split('*')[0].split(',') for message in here.nmea.messages]
    kinds = [fields[0][3:] for fields in said]
    middle = len(kinds) - 1 - kinds[::-1].index('OSD')  # RMC and others before it, targets after
    first = middle - 1 - kinds[:middle][::-1].index('RMC')
    after = kinds[middle:].index('RMC') if 'RMC' in kinds[middle:] else len(kinds)
    for fields in said[first : middle + after]:
        if fields[0][3:] == kind and (kind not in ('TTM', 'TLL') or fields[1] == number):
            return fields
    return None


def lose(here, odometry):
    """Sail on with what is left of own ship's data when what is lost counts as lost."""
    here.odometry = odometry
    pause(here)
    here.sail(2)


def pause(here):
    """No radar for as long as a sensor may be silent; scans come faster than they are stamped."""
    until = time.monotonic() + 1.3 * TIMEOUT
    here.wait(lambda: time.monotonic() > until)


def headless(stamp, position, velocity):
    message = convert.own_ship_to_odometry(stamp, position, velocity)
    message.pose.pose.orientation.z = message.pose.pose.orientation.w = math.nan
    message.header.frame_id = message.child_frame_id = 'map'
    message.twist.twist.linear.x, message.twist.twist.linear.y = map(float, velocity)
    return message


def placeless(stamp, position, velocity):
    return convert.own_ship_to_odometry(stamp, (math.nan, math.nan), velocity)


def test_ranges_are_from_the_reference_point_on_every_output(watch):
    """The radar stands 180 m aft of it and the GPS antenna 120 m ahead: both show."""
    here = watch(
        antenna_ahead_m=-180.0, antenna_starboard_m=20.0, gps_ahead_m=120.0, gps=(120.0, 0.0)
    )
    gps = np.array([0.0, 120.0])  # she heads north
    antenna = np.array([20.0, -180.0])
    here.odometry = lambda stamp, position, velocity: convert.own_ship_to_odometry(
        stamp, position + gps, velocity
    )
    scans = []
    for scan in here.scans:
        own, _ = own_ship_at(scan.own_ship, scan.plots.time)
        offset = convert.plots_positions(scan) - own - antenna
        range_, bearing = to_range_bearing(offset)
        scans.append(scan._replace(plots=scan.plots._replace(range=range_, bearing=bearing)))
    here.scans = scans
    here.sail(20)
    for ship, name in ((1, None), (2, None)):
        own, _ = own_ship_at(here.last.own_ship, here.last.end)
        true_range, true_bearing = to_range_bearing(here.place(ship) - own)
        near = [
            (name, row)
            for name, row in here.rows().items()
            if abs(float(row['range_nm']) * NAUTICAL_MILE - true_range) < 60
        ]
        assert len(near) == 1
        name, row = near[0]
        assert (
            float(row['bearing_deg']) % 360
            == pytest.approx(np.degrees(true_bearing) % 360, abs=0.8)
            or abs(float(row['bearing_deg']) - np.degrees(true_bearing)) > 359.2
        )
        fields = sentence(here, 'TTM', name[2:])
        assert float(fields[2]) * NAUTICAL_MILE == pytest.approx(true_range, abs=60)
    rmc, tll = sentence(here, 'RMC'), sentence(here, 'TLL', name[2:])
    south = [60 * float(text[:2]) + float(text[2:]) for text in (rmc[3], tll[2])]
    assert 60 * 33.9 - south[0] == pytest.approx(own[1] / NAUTICAL_MILE, abs=0.02)  # not 120 m off
    assert south[0] - south[1] == pytest.approx((here.place(2) - own)[1] / NAUTICAL_MILE, abs=0.05)


def test_offsets_without_a_heading_are_not_applied_and_that_is_told(watch):
    here = watch(antenna_ahead_m=90.0)
    here.odometry = headless
    here.sail(6)
    entry, values = state(here)
    assert 'offsets of the antennas are not applied' in entry.message
    assert values['heading from'] == 'never heard' and values['heading_deg'] == ''


def test_a_log_makes_it_sea_stabilised_and_every_output_says_so(watch):
    here = watch(stabilisation='log')
    here.sail(10)
    assert {row['stabilised'] for row in here.rows().values()} == {'ground'}
    for _ in range(12):
        say(here, 9.0 * KNOT, port=1.5 * KNOT)
        here.sail(1)
    here.wait(lambda: np.isfinite(here.tracker._sensors._log).all())
    say(here, 9.0 * KNOT, port=1.5 * KNOT)
    here.sail(2)
    assert {row['stabilised'] for row in here.rows().values()} == {'sea'}
    anchored = here.rows()[here.name_of(2)]
    assert float(anchored['speed_kn']) == pytest.approx(np.hypot(3.0, 1.5), abs=0.8)
    entry, values = state(here)
    assert (values['stabilised'], values['stabilised by']) == ('sea', 'log')
    assert float(values['water_speed_kn']) == pytest.approx(np.hypot(9.0, 1.5), abs=0.02)
    assert float(values['drift_kn']) == pytest.approx(np.hypot(3.0, 1.5), abs=0.2)
    osd, vhw = sentence(here, 'OSD'), sentence(here, 'VHW')
    assert osd[4] == osd[6] == 'W'
    assert float(osd[5]) == pytest.approx(np.hypot(9.0, 1.5), abs=0.1)
    assert vhw[1] == '000.0' and float(vhw[5]) == pytest.approx(np.hypot(9.0, 1.5), abs=0.02)
    assert sentence(here, 'RMC')[7] == '12.00'  # RMC is over ground


def test_a_silent_log_is_an_alert_and_the_speed_set_by_hand_stands_for_it(watch):
    here = watch(stabilisation='log', water_speed_kn=7.5)
    here.sail(4)
    say(here, 5.0)
    pause(here)
    here.sail(1)
    entry, values = state(here)
    assert values['stabilised by'] == 'speed by hand' and 'the log is silent' in entry.message
    assert sentence(here, 'OSD')[6] == 'M'
    here.awaits('log missing', 'active unacknowledged')


@pytest.mark.parametrize(
    'wrong, reason',
    [
        ({'ahead': math.nan}, own_sensors.LOG_NOT_FINITE),
        ({'ahead': 3.0, 'port': math.inf}, own_sensors.LOG_NOT_FINITE),
        ({'ahead': -71.0}, own_sensors.LOG_TOO_FAST),
        ({'ahead': 4.0, 'frame': '/map'}, own_sensors.WRONG_FRAME),
    ],
)
def test_a_wrong_log_message_is_refused_by_name(watch, wrong, reason):
    here = watch()
    say(here, **wrong)
    here.wait(lambda: here.tracker.bad_own_ship.counts[reason] == 1)
    assert np.isnan(here.tracker._sensors._log).all()


def test_a_lost_heading_leaves_relative_bearings_zones_and_alarms(watch):
    here = watch(zones='[{name: bow, kind: guard, range_nm: [.3, 3], bearing_deg: [345, 15]}]')
    here.sail(14)
    before = here.rows()[here.name_of(2)]
    name = here.name_of(2)
    assert sentence(here, 'TTM', name[2:])[4] == 'T' and before['bearing_deg']
    lose(here, headless)
    row = here.rows()[name]
    for key in ('bearing_deg', 'course_deg', 'speed_kn', 'relative_course_deg', 'course_sd_deg'):
        assert row[key] == ''
    own, _ = own_ship_at(here.last.own_ship, here.last.end)
    range_, bearing = to_range_bearing(here.place(2) - own)
    assert float(row['relative_bearing_deg']) == pytest.approx(np.degrees(bearing), abs=1.0)
    assert float(row['range_nm']) == pytest.approx(range_ / NAUTICAL_MILE, abs=0.03)
    assert row['cpa_nm'] and row['tcpa_min'] and row['stabilised'] == 'none'
    ttm = sentence(here, 'TTM', name[2:])
    assert ttm[4] == 'R' and float(ttm[3]) == pytest.approx(np.degrees(bearing), abs=1.0)
    assert ttm[5] == ttm[6] == '' and float(ttm[2]) > 1
    assert sentence(here, 'TLL', name[2:]) is None and sentence(here, 'HDT') is None
    assert sentence(here, 'RSD')[13] == 'H' and sentence(here, 'OSD')[2] == 'V'
    entry, values = state(here)
    assert entry.level == DiagnosticStatus.WARN
    assert 'relative bearings only; the last was 000.0 deg' in entry.message
    assert (values['heading from'], values['heading_deg']) == ('last known', '')
    standing = here.standing()
    assert any('new target in bow' in alarm for alarm in standing)
    assert any(alarm.endswith(': danger') for alarm in standing)
    here.odometry = convert.own_ship_to_odometry
    here.sail(3)
    assert here.rows()[name]['bearing_deg'] and sentence(here, 'TTM', name[2:])[4] == 'T'


def test_the_alert_of_a_lost_heading_says_what_it_comes_to(watch):
    here = watch()
    here.sail(3)
    lose(here, headless)
    here.wait(lambda: here.sail(1) or 'heading missing' in here.standing())
    assert here.alarm('heading missing').message.endswith(': relative bearings only')


def test_lost_positions_are_reckoned_by_the_log_and_the_last_good_source_is_named(watch):
    """The log reads what she makes over ground: she sails on, and her targets stand still."""
    here = watch()
    here.sail(14)
    name = here.name_of(2)
    here.odometry = placeless
    pause(here)
    for _ in range(12):
        say(here, SPEED * KNOT)
        here.wait(lambda: np.isfinite(here.tracker._sensors._log).all())
        here.sail(1)
    entry, values = state(here)
    assert values['position from'] == 'reckoned' and 'from the last known position' in entry.message
    assert values['velocity from'] == values['stabilised by'] == 'log'
    row = here.rows()[name]
    assert row['stabilised'] == 'sea' and float(row['speed_kn']) < 1.5
    own, _ = own_ship_at(here.last.own_ship, here.last.end)
    assert here.tracker._operator.picture.own.position == pytest.approx(own, abs=60)
    assert sentence(here, 'OSD')[6] == 'W'
    here.awaits('position missing', 'active unacknowledged')


def test_lost_positions_without_any_speed_leave_what_is_relative(watch):
    here = watch()
    here.sail(14)
    name = here.name_of(1)
    lose(here, placeless)
    row = here.rows()[name]
    assert row['speed_kn'] == row['course_deg'] == '' and row['stabilised'] == 'none'
    assert row['bearing_deg'] and row['level'] == DiagnosticStatus.ERROR
    assert float(row['relative_speed_kn']) == pytest.approx(SPEED + 8, abs=2.0)
    _, values = state(here)
    assert values['velocity from'] == 'last known' and values['position from'] == 'reckoned'


def test_a_stationary_target_is_marked_in_ttm_and_in_targets(watch):
    here = watch()
    here.sail(14)
    name = here.name_of(2)
    assert here.set(reference_target=int(name[2:]))[0].successful
    here.sail(1)
    assert [n for n, row in here.rows().items() if row['reference'] == 'R'] == [name]
    assert sentence(here, 'TTM', name[2:])[13] == 'R' and sentence(here, 'TLL', name[2:])[9] == 'R'
    other = here.name_of(1)
    assert sentence(here, 'TTM', other[2:])[13] == ''
    assert sentence(here, 'OSD')[6] == 'R'
    _, values = state(here)
    assert values['stabilised by'] == f'target {name}'


def test_a_radar_that_counts_from_the_bow_is_turned_by_the_heading(watch):
    here = watch(bearings='bow', bearing_offset_deg=-4.0)
    turn = np.radians(37.0)

    def heads(stamp, position, velocity):
        return convert.own_ship_to_odometry(stamp, position, velocity, turn)

    here.odometry = heads
    here.scans = [
        scan._replace(
            plots=scan.plots._replace(
                bearing=(scan.plots.bearing - turn + np.radians(4.0)) % (2 * np.pi)
            )
        )
        for scan in here.scans
    ]
    here.sail(14)
    row = here.rows()[here.name_of(2)]
    assert float(row['relative_bearing_deg']) == pytest.approx(
        (float(row['bearing_deg']) - 37.0) % 360, abs=0.11
    )
    assert float(row['speed_kn']) < 1.5
