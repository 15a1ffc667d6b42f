import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from marine_tracker.arpa import zones
from marine_tracker.arpa.zones import inside, parse
from marine_tracker.geometry import NAUTICAL_MILE, unit_vector

ORIGIN = np.zeros(2)


def at(range_, bearing_deg):
    """Position [1, 2] m from the origin."""
    return range_ * unit_vector(np.radians([bearing_deg]))


def sees(text, range_, bearing_deg, heading_deg=0.0, own=ORIGIN):
    return bool(
        inside(parse(text), own + at(range_, bearing_deg), own, math.radians(heading_deg))[0, 0]
    )


BOW = '[{name: bow, kind: guard, range_m: [1000, 2000], bearing_deg: [315, 045]}]'


@pytest.mark.parametrize(
    ('range_', 'bearing', 'expected'),
    [
        (1500, 0, True),
        (1500, 44.9, True),
        (1500, 315.1, True),
        (1500, 359.999, True),
        (1500, 45.1, False),
        (1500, 314.9, False),
        (1500, 180, False),
        (999, 0, False),
        (1001, 0, True),
        (1999, 0, True),
        (2001, 0, False),
    ],
)
def test_sector_over_the_bow(range_, bearing, expected):
    assert sees(BOW, range_, bearing) == expected


def test_bearings_are_decimal_though_yaml_reads_a_leading_nought_as_octal():
    assert sees(BOW, 1500, 44.0) and math.degrees(parse(BOW).sectors.width[0]) == pytest.approx(90)


def test_a_sector_turns_with_own_ship():
    assert not sees(BOW, 1500, 90)
    assert sees(BOW, 1500, 90, heading_deg=90)
    assert sees(BOW, 1500, 20, heading_deg=350)
    assert not sees(BOW, 1500, 300, heading_deg=350)


def test_both_sides_of_a_sector_belong_to_it():
    for side in (315.0, 45.0):
        assert sees(BOW, 1500, side)


@settings(max_examples=50, deadline=None)
@given(st.floats(0, 359.9), st.floats(1, 359), st.floats(0, 359.9))
def test_so_they_do_whatever_the_rounding(start, width, heading):
    end = (start + width) % 360
    text = f'[{{name: s, kind: guard, range_m: [10, 20], bearing_deg: [{start!r}, {end!r}]}}]'
    for side in (start, end):
        assert sees(text, 15, side + heading, heading)


def test_a_sector_wider_than_half_a_turn():
    text = '[{name: all but astern, kind: guard, range_m: [0, 100], bearing_deg: [200, 160]}]'
    assert [sees(text, 50, b) for b in (0, 100, 159, 180, 201, 300)] == [
        True,
        True,
        True,
        False,
        True,
        True,
    ]


def test_full_ring_and_its_hole():
    text = '[{name: ring, kind: guard, range_nm: [1, 2]}]'
    for bearing in range(0, 360, 15):
        assert sees(text, 1.5 * NAUTICAL_MILE, bearing, heading_deg=33)
        assert not sees(text, 0.9 * NAUTICAL_MILE, bearing)


@settings(max_examples=60, deadline=None)
@given(st.floats(-360, 360), st.floats(1, 359), st.floats(0, 359.9), st.floats(0, 359.9))
def test_sector_agrees_with_angles_counted_by_hand(start, width, heading, bearing):
    end = (start + width) % 360
    text = f'[{{name: s, kind: guard, range_m: [10, 20], bearing_deg: [{start!r}, {end!r}]}}]'
    turned = (bearing - heading - start) % 360
    if min(turned, abs(turned - width), 360 - turned) > 1e-6:  # not on a side
        assert sees(text, 15, bearing, heading) == (turned < width)


def polygon(corners, frame='ground', name='p', kind='exclusion'):
    pairs = [[float(a), float(b)] for a, b in corners]
    return f'{{name: {name}, kind: {kind}, fixed_to: {frame}, corners_m: {pairs}}}'


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(3, 12))
def test_polygon_agrees_with_the_angle_it_subtends(seed, count):
    """A position is inside where the corners turn once round it (the winding number)."""
    rng = np.random.default_rng(seed)
    bearing = np.sort(rng.uniform(0, 2 * np.pi, count))
    if np.diff(bearing, append=bearing[0] + 2 * np.pi).max() > 3.0 or np.diff(bearing).min() < 1e-3:
        return
    middle = np.array([300.0, -200.0])
    corners = middle + rng.uniform(20, 100, count)[:, None] * unit_vector(bearing)
    position = middle + rng.uniform(-110, 110, (200, 2))
    to = corners[None] - position[:, None]
    angle = np.arctan2(to[..., 0], to[..., 1])
    turn = np.angle(np.exp(1j * (np.roll(angle, -1, 1) - angle))).sum(1) / (2 * np.pi)
    found = inside(parse(f'[{polygon(corners)}]'), position, ORIGIN, 0.0)[:, 0]
    np.testing.assert_array_equal(found, np.abs(turn) > 0.5)


def test_a_position_on_the_side_that_two_polygons_share_is_in_one_of_them():
    corners = [(0, 0), (70, 10), (90, 100), (-20, 80)]
    one = polygon([corners[0], corners[1], corners[2]], name='one')
    two = polygon([corners[0], corners[2], corners[3]], name='two')
    along = np.linspace(0.01, 0.99, 99)[:, None] * np.array([90.0, 100.0])
    assert (inside(parse(f'[{one}, {two}]'), along, ORIGIN, 0.0).sum(1) == 1).all()


def test_polygon_on_the_ship_has_corners_starboard_and_ahead():
    text = f'[{polygon([(10, 100), (60, 100), (60, 200), (10, 200)], "ship")}]'
    assert sees(text, 150, 15)  # ahead, a little to starboard
    assert not sees(text, 150, 345)
    assert sees(text, 150, 255, heading_deg=240)
    assert sees(text, 150, 255, heading_deg=240, own=np.array([5e4, -3e4]))


def test_polygon_on_the_ground_stays_where_it_is():
    text = f'[{polygon([(0, 0), (100, 0), (100, 100), (0, 100)])}]'
    zone = parse(text)
    for own, heading in ((ORIGIN, 0.0), (np.array([900.0, 20.0]), 2.0)):
        found = inside(zone, np.array([[50.0, 50.0], [150.0, 50.0]]), own, heading)[:, 0]
        assert found.tolist() == [True, False]


def test_without_a_heading_only_what_needs_none_goes_on():
    text = f"""
      - {{name: bow, kind: guard, range_m: [0, 500], bearing_deg: [300, 60]}}
      - {{name: ring, kind: guard, range_m: [0, 500]}}
      - {polygon([(-10, -10), (10, -10), (0, 10)], 'ship', 'hull')}
      - {polygon([(-10, -10), (10, -10), (0, 10)], 'ground', 'quay')}
    """
    found = inside(parse(text), np.zeros((1, 2)) + 1e-3, ORIGIN, math.nan)[0]
    assert found.tolist() == [False, True, False, True]


def test_overlapping_zones_each_have_their_column():
    text = f"""
      - {{name: far, kind: guard, range_m: [500, 1500]}}
      - {polygon([(-900, 400), (900, 400), (0, 1400)], 'ground', 'land')}
      - {{name: near, kind: guard, range_m: [100, 800]}}
    """
    zone = parse(text)
    found = inside(zone, np.array([[0.0, 700.0], [0.0, -700.0], [0.0, 1000.0]]), ORIGIN, 0.0)
    assert found.tolist() == [[True, True, True], [True, False, True], [True, True, False]]
    assert zone.name == ('far', 'land', 'near') and zone.guard.tolist() == [True, False, True]


def test_nothing_set_and_nothing_there():
    for text in ('', '[]', '# later\n'):
        none = parse(text)
        assert none.name == () and inside(none, np.zeros((5, 2)), ORIGIN, 0.0).shape == (5, 0)
    assert inside(parse(BOW), np.zeros((0, 2)), ORIGIN, 0.0).shape == (0, 1)


def test_a_position_that_is_not_known_is_in_no_polygon_and_no_sector():
    text = f'[{polygon([(0, 0), (9, 0), (0, 9)])}, {{name: r, kind: guard, range_m: [0, 9e4]}}]'
    assert not inside(parse(text), np.full((1, 2), np.nan), ORIGIN, 0.0).any()


def test_the_example_in_the_documentation():
    text = zones.__doc__.split('describes them all:\n')[1].split('Sector bearings')[0]
    zone = parse(text)
    assert zone.name == ('ahead', 'ring', 'wake', 'quay')
    assert zone.guard.tolist() == [True, True, False, False]


def test_the_key_tells_whether_a_zone_is_still_the_same():
    before = parse(BOW).key
    assert (parse('- ' + BOW[1:-1]).key == before).all()
    for change in (('bow', 'prow'), ('2000', '2001'), ('045', '046'), ('guard', 'exclusion')):
        assert (parse(BOW.replace(*change)).key != before).all()


@pytest.mark.parametrize(
    ('text', 'told'),
    [
        ('[', 'zones, line 1 is not YAML'),
        ('ring', "zones are 'ring'; they must be a list"),
        ('{name: ring}', 'they must be a list'),
        ('[ring]', "zone 1 is 'ring'; it must be a mapping"),
        ('[{kind: guard, range_m: [0, 1]}]', 'zone 1 has no name'),
        (
            '[{name: ' + 'z' * 70_000 + ', kind: guard, range_m: [0, 1]}]',
            'zone 1 has a name of 70000 characters; it must have at most 80',
        ),
        (
            '[{name: a, kind: guard, range_m: [0, 1]}, {name: a, kind: guard, range_m: [0, 1]}]',
            'two zones have the name a',
        ),
        ('[{name: a, kind: guard, range_m: [0, 1], beering: 3}]', "zone a: 'beering' is not known"),
        ('[{name: a, range_m: [0, 1]}]', "zone a: kind is ''; it must be one of guard, exclusion"),
        ('[{name: a, kind: no, range_m: [0, 1]}]', "zone a: kind is 'no'"),
        ('[{name: a, kind: guard}]', 'zone a has no outline; it must have one of range_nm'),
        ('[{name: a, kind: guard, range_m: [0, 1], range_nm: [0, 1]}]', 'has range_m and range_nm'),
        ('[{name: a, kind: guard, range_m: [0, 1], corners_m: []}]', 'has range_m and corners_m'),
        ('[{name: a, kind: guard, range_m: [2, 1]}]', 'the first must be below the second'),
        ('[{name: a, kind: guard, range_m: [1, 1]}]', 'the first must be below the second'),
        ('[{name: a, kind: guard, range_m: [-1, 1]}]', 'two numbers between 0 and 370400'),
        ('[{name: a, kind: guard, range_nm: [1, 201]}]', 'two numbers between 0 and 200'),
        ('[{name: a, kind: guard, range_m: [1, .nan]}]', 'range_m is '),
        ('[{name: a, kind: guard, range_m: [1, nan]}]', 'range_m is '),
        ('[{name: a, kind: guard, range_m: 5}]', "range_m is '5'; it must be two numbers"),
        ('[{name: a, kind: guard, range_m: [0, 1, 2]}]', 'it must be two numbers'),
        (
            '[{name: a, kind: guard, range_m: [0, 1], bearing_deg: [0, 361]}]',
            'between -360 and 360',
        ),
        (
            '[{name: a, kind: guard, range_m: [0, 1], bearing_deg: [10, 370]}]',
            'between -360 and 360',
        ),
        ('[{name: a, kind: guard, range_m: [0, 1], bearing_deg: [0, 360]}]', 'for a full ring'),
        (
            '[{name: a, kind: guard, range_m: [0, 1], fixed_to: ground}]',
            'fixed_to does not go with',
        ),
        ('[{name: a, kind: guard, corners_m: [[0, 0], [1, 0]]}]', 'a list of 3 to 1000 corners'),
        ('[{name: a, kind: guard, corners_m: [[0, 0], [1, 0], [1]]}]', 'corners_m[2] is'),
        ('[{name: a, kind: guard, corners_m: [[0, 0], [1, 0], [1, x]]}]', 'corners_m[2] is'),
        (
            '[{name: a, kind: guard, corners_m: [[0, 0], [1, 0], [1, 1]], fixed_to: sea}]',
            'one of ship, ground',
        ),
        (
            '[{name: a, kind: guard, corners_m: [[0, 0], [1, 0], [1, 1]], bearing_deg: [1, 2]}]',
            'bearing_deg does not go with corners_m',
        ),
        (
            '[{name: a, kind: guard, corners_m: [[0, 0], [9, 9], [9, 0], [0, 5]]}]',
            'cross each other',
        ),
        ('[{name: a, kind: guard, corners_m: [[0, 0], [9, 9], [18, 18]]}]', 'enclose nothing'),
        ('[{name: a, kind: guard, corners_m: [[0, 0], [9, 9], [0, 9], [0, 0]]}]', 'have no length'),
        (
            str([{'name': str(k), 'kind': 'guard', 'range_m': [0, 1]} for k in range(101)]),
            'there are 101 zones; there may be 100',
        ),
    ],
)
def test_errors_name_the_zone_the_key_and_the_limits(text, told):
    with pytest.raises(ValueError) as error:
        parse(text)
    assert told in str(error.value)
