"""Where own ship and her plots lie on the page: mounting, bearings from the bow, fixes."""

import math

import numpy as np
import pytest

pytest.importorskip('rclpy')
from sensor_msgs.msg import NavSatFix

from marine_tracker.geodesy import LocalFrame
from marine_tracker.nodes import convert
from marine_tracker.nodes.display_own import OwnShipHeard
from marine_tracker.nodes.display_tracker import radars_told, zones_told
from marine_tracker.parameters import TrackerParameters
from marine_tracker.types import PolarPlots

START = 1_700_000_000_000_000_000
PIER = np.array([1450.0, -620.0])


def odometry(seconds, position=(0.0, 0.0), velocity=(0.0, 0.0), heading=math.nan):
    stamp = START + round(seconds * 1e9)
    return convert.own_ship_to_odometry(stamp, np.array(position), np.array(velocity), heading)


def fix(seconds, latitude, longitude):
    return convert.fix_message(START + round(seconds * 1e9), latitude, longitude)


def plots(away, bearing, time=(0.0,)):
    return PolarPlots(np.array(time), np.array(away), np.array(bearing), np.full(len(away), 20.0))


def test_a_pier_stays_where_it_is_while_own_ship_yaws_and_plots_come_from_the_bow():
    heard = OwnShipHeard()
    heard.radars = [TrackerParameters(bearings='bow')]
    places = []
    for k in range(400):
        seconds = 0.1 * k
        yaw = math.radians(213 + 20 * math.sin(2 * math.pi * seconds / 17))
        assert heard.hear(odometry(seconds, heading=yaw % (2 * math.pi)))
        if k % 25 == 24:
            away, bearing = math.hypot(*PIER), math.atan2(*PIER) - yaw
            at = (0.0,)
            place = heard.place(
                plots([away], [bearing % (2 * math.pi)], at), START + round(seconds * 1e9), 0
            )
            places.append(place[0])
    assert np.hypot(*(np.array(places) - PIER).T).max() < 3.0


def test_the_antenna_and_the_gps_are_where_they_are_mounted():
    heard = OwnShipHeard()
    heard.radars = [
        TrackerParameters(gps_ahead_m=-40.0, antenna_ahead_m=15.0, antenna_starboard_m=6.0)
    ]
    # Heading east: the reference point is 40 m east of the GPS, the antenna 15 m on, 6 m south.
    for k in range(3):
        heard.hear(odometry(k, (500.0, 80.0), heading=math.radians(90)))
    assert heard.position == pytest.approx([540, 80])
    place = heard.place(plots([1000.0], [0.0]), START + 2_000_000_000, 0)
    assert place[0] == pytest.approx([555, 1074], abs=1e-6)
    told = heard.plain(1.0)
    assert (told['x'], told['y']) == (540, 80)


def test_a_lost_heading_is_never_north_but_the_last_bow():
    heard = OwnShipHeard()
    heard.hear(odometry(0, heading=math.radians(61)))
    assert heard.plain(0.0)['heading'] == pytest.approx(math.radians(61))
    heard.hear(odometry(1))
    told = heard.plain(1.0)
    assert told['heading'] is None and told['bow'] == pytest.approx(math.radians(61))


def test_without_any_heading_the_bow_is_known_only_to_a_radar_that_counts_from_it():
    heard = OwnShipHeard()
    heard.hear(odometry(0))
    assert heard.plain(0.0)['bow'] is None
    heard.radars = [TrackerParameters(), TrackerParameters(bearings='bow')]
    assert heard.plain(0.0)['bow'] == 0.0


def test_own_place_on_earth_is_reckoned_from_the_fix_by_her_way_since():
    heard = OwnShipHeard()
    for k in range(31):
        heard.hear(odometry(0.1 * k, (8.0 * 0.1 * k, 0.0), (8.0, 0.0), math.radians(90)))
        if k == 10:
            assert heard.hear_fix(fix(1.0, 59.2, 10.6), 5.0)
    told = heard.plain(7.0)
    latitude, longitude = LocalFrame(59.2, 10.6).to_geodetic([16.0, 0.0])
    assert told['latitude'] == pytest.approx(latitude, abs=2e-7)
    assert told['longitude'] == pytest.approx(longitude, abs=2e-7)
    assert heard.plain(15.1)['latitude'] is None  # 10.1 s old


def test_a_fix_that_is_none_is_refused():
    heard = OwnShipHeard()
    heard.hear(odometry(0))
    none = fix(0, 59.2, 10.6)
    none.status.status = -1
    assert not heard.hear_fix(none, 0.0)
    assert not heard.hear_fix(fix(0, math.nan, 10.6), 0.0)
    assert not heard.hear_fix(NavSatFix(latitude=95.0), 0.0)
    assert heard.plain(0.0)['latitude'] is None


def test_a_velocity_that_is_not_told_places_plots_all_the_same():
    heard = OwnShipHeard()
    message = odometry(0, (70.0, 40.0))
    message.twist.twist.linear.x = math.nan
    heard.hear(message)
    place = heard.place(plots([500.0], [math.pi / 2], (1.2,)), START, 0)
    assert place[0] == pytest.approx([570, 40])


def test_the_radars_of_the_tracker_are_told_by_its_parameters():
    text = '[{topic: x/radar/plots, antenna_ahead_m: 12.5}, {topic: s/radar/plots, bearings: bow}]'
    found = radars_told({'radars': text, 'bearings': 'north'}, 'plots')
    assert [radar.topic for radar in found] == ['x/radar/plots', 's/radar/plots']
    assert [radar.name for radar in found] == ['x', 's']
    assert [radar.parameters.bearings for radar in found] == ['north', 'bow']
    assert [radar.parameters.antenna_ahead_m for radar in found] == [12.5, 0.0]
    (only,) = radars_told({'radars': '', 'bearing_offset_deg': 1.5}, 'other')
    assert (only.topic, only.name) == ('other', '')


def test_zones_that_cannot_be_read_are_told_with_the_reason():
    told = zones_told({'zones': '[{name: a, kind: what, range_nm: [1, 2]}]'})
    assert told['zones'] == [] and 'zone a' in told['error']
    assert zones_told({'zones': ''}) == {'zones': [], 'error': ''}
