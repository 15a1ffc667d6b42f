import json
import math
import re
import textwrap

import numpy as np
import pytest
from pyproj import Geod

from marine_tracker.geodesy import LocalFrame
from marine_tracker.geometry import KNOT, NAUTICAL_MILE
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.simulation import scenario

SHIP = {'start': {'range_nm': 5, 'bearing_deg': 40}, 'course_deg': 200, 'speed_kn': 12}


def ship(**changes):
    return {**SHIP, **changes}


def leg(**kind):
    return {'targets': [ship(legs=[kind])]}


@pytest.mark.parametrize('name', scenario.shipped())
def test_shipped_scenarios_load_and_suit_a_tracker(name):
    loaded = scenario.load(name)
    assert loaded.name == name
    assert loaded.description
    assert from_mapping(TrackerParameters, loaded.tracker_parameters()).max_range_m > 0


def test_the_promised_scenarios_are_shipped():
    assert {'paper_track', 'busy_strait', 'encounters', 'clean'} <= set(scenario.shipped())
    assert len(scenario.load('busy_strait').fleet.names) == 40
    assert len(scenario.load('encounters').fleet.names) == 3


def test_paper_track_turns_through_50_degrees_at_scan_500():
    loaded = scenario.load('paper_track')
    turn = 500 * 60 / 22
    before, after = (loaded.truth_at(turn + t) for t in (-0.1, 60.0))
    assert np.degrees(np.arctan2(*before.velocity[0])) == pytest.approx(70)
    assert np.degrees(np.arctan2(*after.velocity[0])) == pytest.approx(120)
    assert np.hypot(*loaded.truth_at(0).position[0]) == pytest.approx(4600)
    assert np.hypot(*loaded.truth_at(250).velocity[0]) == pytest.approx(9.26 + 1.03)


def test_metric_and_nautical_keys_mean_the_same(make_scenario):
    nautical = make_scenario(targets=[SHIP])
    metric = make_scenario(
        targets=[
            {
                'start': {'range_m': 5 * 1852, 'bearing_deg': 40},
                'course_deg': 200,
                'speed_mps': 12 * 1852 / 3600,
            }
        ]
    )
    for a, b in zip(nautical.truth_at(300.0), metric.truth_at(300.0), strict=True):
        assert a == pytest.approx(b)


def test_range_and_bearing_count_from_own_ships_start(make_scenario):
    loaded = make_scenario(
        own_ship={'start': {'north_m': 1000, 'east_nm': 1}, 'course_deg': 90, 'speed_kn': 10},
        targets=[SHIP],
    )
    offset = loaded.truth_at(0).position[0] - loaded.own_ship_at(0).position[0]
    assert offset == pytest.approx(
        5 * NAUTICAL_MILE * np.array([math.sin(math.radians(40)), math.cos(math.radians(40))])
    )
    assert loaded.own_ship_at([0, 60]).position[1] == pytest.approx(
        [NAUTICAL_MILE + 600 * KNOT, 1000]
    )


def test_geodetic_starts_are_placed_by_the_origin(make_scenario):
    loaded = make_scenario(
        own_ship={'start': {'lat_deg': 60, 'lon_deg': 10}},
        targets=[ship(start={'lat_deg': 60.1, 'lon_deg': 10.1})],
    )
    assert loaded.fleet.origin == LocalFrame(60, 10)
    assert loaded.truth_at(0).position[0] == pytest.approx([5560, 11144], abs=20)


@pytest.mark.parametrize(
    ('own', 'target'),
    [
        ((-17.0, 179.99), (-17.0, -179.98)),
        ((-17.3, -179.6), (-16.9, 179.7)),
        ((52.0, 180.0), (51.6, -179.7)),
        ((78.5, 15.0), (78.9, 13.0)),
        ((-84.9, 179.0), (-84.7, -178.0)),
    ],
)
def test_a_target_is_at_range_and_bearing_of_the_geodesic_across_the_date_line_too(
    make_scenario, own, target
):
    loaded = make_scenario(
        own_ship={'start': dict(zip(('lat_deg', 'lon_deg'), own))},
        targets=[ship(start=dict(zip(('lat_deg', 'lon_deg'), target)))],
    )
    bearing, _, distance = Geod(ellps='WGS84').inv(*own[::-1], *target[::-1])
    expected = distance * np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
    assert loaded.own_ship_at(0).position[0] == pytest.approx([0, 0], abs=1e-6)
    assert loaded.truth_at(0).position[0] == pytest.approx(expected, abs=0.1)


@pytest.mark.parametrize(
    ('place', 'said'),
    [
        ({'lat_deg': 10, 'lon_deg': 181.5}, 'lon_deg is 181.5; it must be between -180 and 180'),
        ({'lat_deg': 10, 'lon_deg': -200}, 'lon_deg is -200; it must be between -180 and 180'),
        ({'lat_deg': -90.5, 'lon_deg': 10}, 'lat_deg is -90.5; it must be between -90 and 90'),
    ],
)
def test_no_place_on_earth_is_refused(make_scenario, place, said):
    for change in ({'origin': place}, {'own_ship': {'start': place}}):
        with pytest.raises(ValueError, match=said):
            make_scenario(**change)


def test_tracker_parameters_are_those_of_the_radar(make_scenario):
    loaded = make_scenario(
        radar={
            'rotation_rpm': 24,
            'range_sigma_m': 9,
            'bearing_sigma_deg': 0.7,
            'max_range_nm': 6,
            'blind_range_m': 70,
        },
        tracker={'max_target_speed_kn': 30, 'vessel_class': 'small_craft'},
    )
    assert loaded.tracker_parameters() == pytest.approx(
        {
            'range_sigma_m': 9,
            'bearing_sigma_deg': 0.7,
            'min_range_m': 70,
            'max_range_m': 6 * 1852,
            'glint_sigma_m': 0,
            'scan_period_s': 2.5,
            'max_target_speed_mps': 30 * KNOT,
            'range_resolution_m': 30,
            'beam_width_deg': 1,
            'vessel_class': 'small_craft',
        }
    )


def test_detectable_is_between_blind_and_maximum_range(make_scenario):
    loaded = make_scenario(
        radar={'blind_range_m': 100, 'max_range_nm': 4},
        own_ship={'start': {'north_m': 0, 'east_m': 5000}},
        targets=[
            ship(speed_kn=0, start={'range_m': r, 'bearing_deg': 200})
            for r in (99, 101, 7407, 7409)
        ],
    )
    assert scenario.detectable(loaded, loaded.truth_at(0)).tolist() == [False, True, True, False]


@pytest.mark.parametrize(
    'values, text',
    [
        ({'duraton_s': 9}, 'duraton_s is not known; did you mean duration_s?'),
        ({'duration': 9}, 'duration is not known: the key must end in its unit; write duration_s'),
        ({'duration_s': 0}, 'duration_s is 0; it must be between 1 and'),
        ({'duration_s': '10 min'}, "duration_s is '10 min'; it must be a number"),
        ({'duration_s': 1e999}, 'duration_s is inf; it must be finite'),
        ({'duration_s': True}, 'duration_s is True; it must be a number'),
        ({'duration_s': 2}, 'duration_s is 2; it must not be less than a revolution, 2.73 s'),
        ({'targets': []}, 'the scenario has no targets'),
        ({'targets': {'a': 1}}, "targets is {'a': 1}; it must be a list"),
        ({'targets': ['ship']}, "targets[0] is 'ship'; it must be a mapping"),
        ({'targets': [{'course_deg': 1, 'speed_kn': 1}]}, 'targets[0] has no start'),
        (
            {'targets': [SHIP, {k: v for k, v in SHIP.items() if k != 'speed_kn'}]},
            'targets[1] has no speed_mps or speed_kn',
        ),
        (
            {'targets': [{k: v for k, v in SHIP.items() if k != 'course_deg'}]},
            'targets[0] has no course_deg',
        ),
        (
            {'targets': [ship(speed=12)]},
            'targets[0].speed is not known: the key must end in its unit; '
            'write speed_kn or speed_mps',
        ),
        (
            {'targets': [ship(speed_kmh=12)]},
            'targets[0].speed_kmh is not known: no such unit here; write speed_kn or speed_mps',
        ),
        ({'targets': [ship(speed_mps=12)]}, 'targets[0] has both speed_mps and speed_kn; give one'),
        (
            {'targets': [ship(speed_kn=500)]},
            'targets[0].speed_kn is 500; it must be between 0 and 100',
        ),
        (
            {'targets': [ship(speed_kn=-5)]},
            'targets[0].speed_kn is -5; it must be between 0 and 100',
        ),
        (
            {'targets': [ship(course_deg='north')]},
            "targets[0].course_deg is 'north'; it must be a num",
        ),
        ({'targets': [ship(start={'range_nm': 5})]}, 'targets[0].start has no bearing_deg'),
        ({'targets': [ship(start={'bearing_deg': 5})]}, 'targets[0].start has none of range_m or'),
        (
            {'targets': [ship(start={'range_nm': 5, 'bearing_deg': 1, 'east_m': 3})]},
            'targets[0].start.east_m is not known',
        ),
        (
            {'targets': [ship(start={'range_nm': 5, 'bearing_deg': 1, 'north_m': 3})]},
            'targets[0].start has range and north; it must have one of',
        ),
        ({'targets': [ship(start={'lat_deg': 5, 'lon_deg': 1})]}, 'scenario has no origin'),
        ({'targets': [ship(pd=0.5, pd_factor=0.5)]}, 'targets[0] has both pd and pd_factor'),
        ({'targets': [ship(pd=1.2)]}, 'targets[0].pd is 1.2; it must be between 0 and 1'),
        ({'targets': [ship(name=7)]}, 'targets[0].name is 7; it must be a text'),
        (
            {'targets': [ship(legs=[{'strait': {}}])]},
            'targets[0].legs[0].strait is not known; did you mean straight?',
        ),
        (
            leg(straight={}, turn={}),
            'targets[0].legs[0] has straight and turn; it must have one of',
        ),
        (leg(turn={'radius_m': 100}), 'targets[0].legs[0].turn has no angle_deg'),
        (leg(turn={'angle_deg': 90}), 'targets[0].legs[0].turn has none of radius_m or radius_nm'),
        (
            leg(turn={'angle_deg': 90, 'radius_m': 9, 'rate_deg_per_s': 1}),
            'targets[0].legs[0].turn has radius and rate_deg_per_s; it must have one of',
        ),
        (
            leg(turn={'angle_deg': 90, 'rate_deg_per_s': 400}),
            'turn.rate_deg_per_s is 400; it must be',
        ),
        (leg(turn={'angle_deg': 90, 'rate_deg': 4}), 'turn.rate_deg is not known'),
        (leg(speed={'to_kn': 10}), 'targets[0].legs[0].speed has none of duration_s; accel'),
        (
            leg(speed={'to_kn': 10, 'acceleration_mps2': 60}),
            'acceleration_mps2 is 60; it must be betw',
        ),
        (
            {'targets': [ship(legs=[{'straight': {}}, {'straight': {}}])]},
            'targets[0].legs[0].straight has no duration_s; only the last leg',
        ),
        (
            {'targets': [ship(speed_kn=0, legs=[{'turn': {'angle_deg': 9, 'radius_m': 90}}])]},
            'targets[0].legs[0].turn begins at a mean speed of 0 m/s',
        ),
        (
            {'targets': [ship(speed_wave={'amplitude_kn': 20, 'period_s': 60})]},
            'targets[0].speed_wave has an amplitude of',
        ),
        (
            {'radar': {'max_range_m': 500, 'blind_range_m': 600}},
            'radar.blind_range is 600 m; it must',
        ),
        (
            {'radar': {'pd_near': 0.5, 'pd_far': 0.6}},
            'radar.pd_far is 0.6; it must not exceed pd_near',
        ),
        (
            {'radar': {'sensor_errors': 'iso'}},
            "radar.sensor_errors is 'iso'; it must be one of none, ",
        ),
        ({'radar': {'sensor_errors': 'imo', 'range_sigma_m': 9}}, 'radar has range_sigma beside'),
        ({'radar': {'rpm': 22}}, 'radar.rpm is not known'),
        ({'clutter': {'uniform': -1}}, 'clutter.uniform is -1; it must be between 0'),
        (
            {'tracker': {'vessel_class': 'boat'}},
            "tracker.vessel_class is 'boat'; it must be one of",
        ),
        (
            {'own_ship': {'start': {'range_m': 1, 'bearing_deg': 2}}},
            'own_ship.start gives range and bearing, which count from own ship',
        ),
        (
            {'own_ship': {'vessel': 3}},
            'own_ship.vessel names an AIS vessel, but the scenario has no',
        ),
        ({'own_ship': [1]}, 'own_ship is [1]; it must be a mapping'),
        ({'ais': {'file': 'nowhere.csv'}}, 'nowhere.csv does not exist'),
    ],
)
def test_wrong_scenarios_are_refused_by_name_value_and_limit(tmp_path, values, text):
    file = tmp_path / 'wrong.yaml'
    file.write_text(
        json.dumps({'duration_s': 600, 'targets': [SHIP], **values}).replace('Infinity', '.inf')
    )
    with pytest.raises(ValueError) as refused:
        scenario.load(file)
    assert text in str(refused.value)
    assert str(refused.value).startswith(str(file))


@pytest.mark.parametrize(
    'text, message',
    [
        ('', 'the scenario has no duration_s'),
        ('- a\n', 'it must hold a mapping'),
        ('a: [', 'is not YAML'),
    ],
)
def test_files_that_hold_no_scenario_are_refused(tmp_path, text, message):
    file = tmp_path / 'wrong.yaml'
    file.write_text(text)
    with pytest.raises(ValueError, match=message):
        scenario.load(file)


def test_the_example_in_the_documentation_is_right(tmp_path):
    example = textwrap.dedent(
        re.search(r'(?s)\n\n(    description:.*?)\n\nShips', scenario.__doc__).group(1)
    )
    file = tmp_path / 'example.yaml'
    file.write_text(example)
    loaded = scenario.load(file)
    assert loaded.fleet.names == ('ferry',)
    assert loaded.clutter.sea == 40


def test_the_example_of_hulls_and_land_is_right(tmp_path):
    example = textwrap.dedent(
        re.search(r'(?s)\n\n(    targets:\n      - {name: tanker.*)\n', scenario.__doc__).group(1)
    )
    file = tmp_path / 'example.yaml'
    file.write_text('duration_s: 60\n' + example)
    loaded = scenario.load(file)
    assert loaded.fleet.hulls.beam.tolist() == [32]
    assert [(shore.name, len(shore.corners)) for shore in loaded.shores] == [
        ('mole', 2),
        ('islet', 4),
    ]
    assert len(loaded.fixed.place) == 30 + 2


def test_unknown_names_are_answered_with_the_nearest():
    with pytest.raises(ValueError, match='no scenario bussy_strait; did you mean busy_strait?'):
        scenario.load('bussy_strait')
    with pytest.raises(ValueError, match='cannot be read: No such file'):
        scenario.load('nowhere/at_all.yaml')


def test_a_radar_with_doppler_tells_the_tracker_its_deviation(make_scenario):
    told = make_scenario(radar={'radial_speed_sigma_kn': 0.5}).tracker_parameters()
    assert told['radial_speed_sigma_mps'] == pytest.approx(0.2572, abs=1e-4)
    assert 'radial_speed_sigma_mps' not in make_scenario().tracker_parameters()


def test_a_doppler_band_without_doppler_is_a_mistake(make_scenario):
    with pytest.raises(ValueError, match='max_radial_speed, but no radial_speed_sigma'):
        make_scenario(radar={'max_radial_speed_mps': 20})


def test_own_ship_at_rest_heads_where_her_course_is_stated_and_else_nowhere():
    for own, heading in (({'course_deg': 305, 'speed_kn': 0}, 305.0), ({}, math.nan)):
        at_rest = scenario.build({'duration_s': 60, 'own_ship': own, 'targets': [SHIP]}, 'x')
        told = np.degrees(at_rest.own_ship_at([0.0, 30.0]).heading)
        np.testing.assert_allclose(told, heading)


def test_own_ship_that_stops_goes_on_heading_where_she_went():
    legs = [
        {'turn': {'angle_deg': 60, 'rate_deg_per_s': 2}},
        {'speed': {'to_kn': 0, 'duration_s': 20}},
    ]
    own = {'course_deg': 320, 'speed_kn': 9, 'legs': legs}
    made = scenario.build({'duration_s': 90, 'own_ship': own, 'targets': [SHIP]}, 'x')
    assert np.degrees(made.own_ship_at([15.0, 80.0]).heading) == pytest.approx([350.0, 20.0])


def test_angles_are_decimal_with_or_without_leading_noughts(tmp_path):
    file = tmp_path / 'noughts.yaml'
    file.write_text(
        'duration_s: 060\nown_ship: {course_deg: 000, speed_kn: 0}\ntargets:\n'
        '  - {start: {range_nm: 02, bearing_deg: 030}, course_deg: 017, speed_kn: 012}\n'
    )
    truth = scenario.load(file).truth_at(0.0)
    assert truth.position[0] == pytest.approx([1852.0, 2 * 1852 * math.cos(math.pi / 6)])
    course = math.degrees(math.atan2(*truth.velocity[0]))
    assert course == pytest.approx(17.0)


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('duration_s: 90\nduration_s: 80\n', "'duration_s' is there twice"),
        ('duration_s: ' + '[' * 900, 'levels are allowed'),
        ('duration_s: ' + '6' * 300, 'too large'),
        ('duration_s: &a [&b [x, x], *b, *b]\ntargets: *a\n', 'duration_s is '),
    ],
)
def test_traps_of_yaml_are_refused_in_one_short_line(tmp_path, text, said):
    file = tmp_path / 'trap.yaml'
    file.write_text(text)
    with pytest.raises(ValueError) as refused:
        scenario.load(file)
    message = str(refused.value)
    assert message.startswith(str(file)) and said in message
    assert '\n' not in message and len(message) < 600
