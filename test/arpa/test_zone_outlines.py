import numpy as np
import pytest

from marine_tracker.arpa import zones
from marine_tracker.arpa.zone_outlines import outlines
from marine_tracker.geometry import NAUTICAL_MILE, unit_vector

OWN = np.array([500.0, -300.0])
TEXT = """
  - {name: ring, kind: guard, range_m: [1000, 2000]}
  - {name: ahead, kind: guard, range_nm: [2, 3], bearing_deg: [315, 045]}
  - {name: wake, kind: exclusion, corners_m: [[-80, -900], [80, -900], [30, 0], [-30, 0]]}
  - {name: quay, kind: exclusion, fixed_to: ground, corners_m: [[0, 0], [900, 0], [900, 400]]}
"""


def only(name):
    """That one of the zones."""
    line = next(line for line in TEXT.splitlines() if f'name: {name}' in line)
    return zones.parse(line)


def length(segments):
    return np.hypot(*np.diff(segments, axis=1)[:, 0].T).sum()


def test_without_zones_there_is_nothing_to_draw():
    assert outlines(zones.parse(''), True, OWN, 0.0).shape == (0, 2, 2)


def test_each_kind_is_drawn_by_itself():
    everything = zones.parse(TEXT)
    guard, exclusion = (outlines(everything, kind, OWN, 0.3) for kind in (True, False))
    assert len(guard) == sum(
        len(outlines(only(name), True, OWN, 0.3)) for name in ('ring', 'ahead')
    )
    assert len(exclusion) == 4 + 3


def test_a_ring_lies_around_own_ship_whatever_the_heading():
    for heading in (0.0, 2.0, np.nan):
        drawn = outlines(only('ring'), True, OWN, heading)
        away = np.hypot(*(drawn.reshape(-1, 2) - OWN).T)
        assert set(np.round(away, 6)) == {1000.0, 2000.0}
        assert length(drawn) == pytest.approx(2 * np.pi * 3000, rel=0.002)


@pytest.mark.parametrize('heading', [0.0, 1.0, 4.0])
def test_what_is_drawn_of_a_sector_is_its_border(heading):
    zone = only('ahead')
    drawn = outlines(zone, True, OWN, heading)
    quarter, side = np.pi / 2, NAUTICAL_MILE
    assert length(drawn) == pytest.approx(quarter * 5 * side + 2 * side, rel=0.001)
    # A little to one side of each segment's middle is inside, to the other outside.
    middle, along = drawn.mean(1), np.diff(drawn, axis=1)[:, 0]
    across = along[:, ::-1] * [1, -1] / np.hypot(*along.T)[:, None]
    one, other = (
        zones.inside(zone, middle + step * across, OWN, heading)[:, 0] for step in (15.0, -15.0)
    )
    assert (one != other).all()


def test_a_polygon_of_own_ship_turns_with_her_and_one_on_the_ground_does_not():
    heading = np.radians(90.0)
    wake = outlines(only('wake'), False, OWN, heading).reshape(-1, 2)
    ahead, starboard = unit_vector(heading), unit_vector(heading + np.pi / 2)
    corners = [
        OWN + x * starboard + y * ahead for x, y in ((-80, -900), (80, -900), (30, 0), (-30, 0))
    ]
    assert sorted(set(map(tuple, np.round(wake, 6)))) == sorted(map(tuple, np.round(corners, 6)))
    quay = [outlines(only('quay'), False, OWN, heading) for heading in (0.0, 2.0, np.nan)]
    assert all(np.array_equal(drawn, quay[0]) for drawn in quay)
    assert set(map(tuple, quay[0].reshape(-1, 2))) == {(0, 0), (900, 0), (900, 400)}


def test_without_a_heading_what_turns_with_own_ship_is_not_drawn():
    for name in ('ahead', 'wake'):
        assert not len(outlines(only(name), name == 'ahead', OWN, np.nan))
