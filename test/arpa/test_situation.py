import numpy as np
import pytest

from marine_tracker.arpa.situation import DANGEROUS, NEARLY, SAFE, Limits
from marine_tracker.geometry import KNOT, NAUTICAL_MILE

LIMITS = Limits(cpa=0.5 * NAUTICAL_MILE, tcpa=720.0)


def passing(cpa, tcpa, speed=10 * KNOT):
    """Position and velocity of a target that passes at cpa m in tcpa s, going south."""
    return [[cpa, tcpa * speed]], [[0.0, -speed]]


def danger(situate, cpa_nm, tcpa_min, **about):
    position, velocity = passing(cpa_nm * NAUTICAL_MILE, tcpa_min * 60.0)
    return situate(position, velocity, limits=LIMITS, **about).danger.item()


@pytest.mark.parametrize(
    ('cpa', 'tcpa', 'expected'),
    [
        (0.0, 6, DANGEROUS),
        (0.49, 6, DANGEROUS),
        (0.49, 11.9, DANGEROUS),
        (0.3, 0.1, DANGEROUS),
        (0.52, 6, NEARLY),
        (0.3, 12.5, NEARLY),
        (0.52, 12.5, NEARLY),
        (0.6, 6, SAFE),
        (0.3, 13.3, SAFE),
        (0.3, -0.5, SAFE),
        (3.0, 6, SAFE),
    ],
)
def test_danger_is_cpa_and_tcpa_below_the_limits(situate, cpa, tcpa, expected):
    assert danger(situate, cpa, tcpa) == expected


def test_an_uncertain_miss_is_nearly_dangerous(situate):
    sharp, blunt = (danger(situate, 0.6, 6, sigma=sigma) for sigma in ((5, 0.02), (150, 1.0)))
    assert (sharp, blunt) == (SAFE, NEARLY)


def test_ships_at_rest_are_no_danger_to_each_other(situate):
    position, velocity = [[300.0, 100.0]], [[-0.8, -0.3]]  # noise, as of an anchored ship
    assert situate(position, velocity, limits=LIMITS).danger.item() == DANGEROUS
    assert situate(position, velocity, harmless=True, limits=LIMITS).danger.item() == SAFE


def test_without_relative_motion_there_is_no_danger(situate):
    scene = situate(
        [[300.0, 100.0]], [[3.0, 4.0]], own_velocity=[3.0, 4.0], limits=LIMITS, sigma=(5, 0.01)
    )
    assert scene.danger.item() == SAFE and scene.nearest.item() == pytest.approx(np.hypot(300, 100))


def test_the_nearest_distance_within_the_limit_of_time(situate):
    speed = 10 * KNOT
    for cpa, tcpa, expected in (
        (100.0, 300.0, 100.0),
        (100.0, -300.0, np.hypot(100, 300 * speed)),
        (100.0, 1000.0, np.hypot(100, 280 * speed)),
    ):
        scene = situate(*passing(cpa, tcpa), limits=LIMITS)
        assert scene.nearest.item() == pytest.approx(expected)


def test_a_track_in_a_guard_and_in_an_exclusion_zone_is_excluded(situate):
    zones = (
        '[{name: g, kind: guard, range_m: [0, 900]},'
        ' {name: e, kind: exclusion, range_m: [500, 600]}]'
    )
    scene = situate([[0, 100], [0, 550], [0, 1000]], zones=zones)
    assert scene.guarded.tolist() == [True, False, False]
    assert scene.excluded.tolist() == [False, True, False]
    assert scene.inside.tolist() == [[True, False], [True, True], [False, False]]
