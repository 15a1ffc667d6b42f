"""Areas of danger: against trials that turn at once, and against ships that are sailed."""

import numpy as np
import pytest

from marine_tracker.arpa.cpa import OwnMotion, approach
from marine_tracker.arpa.danger_areas import COURSES, RISK, dangers
from marine_tracker.arpa.motion import Motion
from marine_tracker.arpa.own_motion import sea_stabilised
from marine_tracker.arpa.own_path import TrialManoeuvre
from marine_tracker.arpa.trial_manoeuvre import safe_courses
from marine_tracker.geometry import KNOT, NAUTICAL_MILE, unit_vector
from marine_tracker.lab.danger_areas.danger_areas import crossing

MILE, SPEED = NAUTICAL_MILE, 11 * KNOT
LIMITS = (0.6 * MILE, 1500.0)
SURE = np.diag([1.0, 1.0, 1e-6, 1e-6])


def targets(position, velocity, covariance=SURE):
    position = np.atleast_2d(np.asarray(position, float))
    count = len(position)
    rest = dict.fromkeys(Motion._fields[3:], np.zeros(count, int))  # of no weight here
    return Motion(
        position,
        np.broadcast_to(np.asarray(velocity, float), (count, 2)),
        np.broadcast_to(covariance, (count, 4, 4)),
        **rest,
    )


def own_ship(course_deg=0.0, speed=SPEED, position=(0.0, 0.0), sigma=0.0):
    course = np.radians(course_deg)
    covariance = np.diag([0, 0, sigma**2, sigma**2])
    return OwnMotion(np.array(position), speed * unit_vector(course), course, covariance)


def traffic(seed, count):
    """Targets within 7 NM, at up to 20 knots."""
    rng = np.random.default_rng(seed)
    position = rng.uniform(0.7, 7, (count, 1)) * MILE * unit_vector(rng.uniform(0, 7, count))
    velocity = rng.uniform(1, 20, (count, 1)) * KNOT * unit_vector(rng.uniform(0, 7, count))
    root = rng.normal(size=(count, 4, 4)) * np.array([25, 25, 0.15, 0.15])[:, None]
    return targets(position, velocity, root @ root.swapaxes(1, 2) + SURE)


def sailed(motion, own, course, rng, draws=2000, step=10.0):
    """[N] share of drawn states of each target that come within the limits, sailed step by step."""
    cpa_limit, tcpa_limit = LIMITS
    steered = np.hypot(*own.velocity) * np.array([np.sin(course), np.cos(course)])
    shares = []
    for row in range(len(motion.position)):
        mean = np.concatenate([motion.position[row], motion.velocity[row]])
        state = rng.multivariate_normal(mean, motion.covariance[row], draws)
        error = rng.multivariate_normal(np.zeros(4), own.covariance, draws)
        place = state[:, :2] - own.position - error[:, :2]
        least, nearest = np.hypot(*place.T), np.zeros(draws)
        for k in range(1, round(tcpa_limit / step) + 1):
            place = place + step * (state[:, 2:] - steered - error[:, 2:])
            distance = np.hypot(*place.T)
            least, nearest = np.minimum(least, distance), np.where(distance < least, k, nearest)
        shares.append(((least < cpa_limit) & (nearest > 0) & (nearest < k)).mean())
    return np.array(shares)


@pytest.mark.parametrize(('seed', 'count', 'sigma'), [(43, 5, 0.0), (32, 9, 0.05), (33, 20, 0.1)])
def test_a_course_crosses_an_area_where_ships_that_are_sailed_meet(seed, count, sigma):
    motion, own = traffic(seed, count), own_ship(211, position=(300.0, -900.0), sigma=sigma)
    rng = np.random.default_rng(seed)
    course = rng.uniform(0, 2 * np.pi, 10)
    found = dangers(motion, own, *LIMITS)
    crossed, _, _ = crossing(found.areas, course, count)
    shares = np.array([sailed(motion, own, one, rng) for one in course])
    # Beyond 5 sigma of 2,000 draws; what a step of 10 s misses of the nearest distance is less.
    sure = np.abs(shares - RISK) > 0.025
    assert (crossed & sure).sum() >= 3
    np.testing.assert_array_equal(crossed[sure], shares[sure] > RISK)
    assert sure.mean() > 0.95


def test_on_every_course_the_danger_is_that_of_a_trial_that_turns_at_once():
    motion, own = traffic(34, 3), own_ship(77)
    found = dangers(motion, own, *LIMITS)
    tried = safe_courses(motion, own, TrialManoeuvre(0.0, SPEED, 0.0, np.inf, np.inf), *LIMITS)
    np.testing.assert_allclose(found.probability[::2], tried.probability, atol=1e-9)
    assert (found.safe[::2] == tried.safe).all() and 0 < tried.safe.sum() < 360
    np.testing.assert_allclose(COURSES[::2], tried.course)


def test_a_course_in_no_area_is_safe_and_one_that_crosses_is_not():
    motion, own = traffic(35, 6), own_ship(10)
    found = dangers(motion, own, *LIMITS)
    crossed, _, _ = crossing(found.areas, found.course, 6)
    assert not found.safe[crossed.any(1)].any() and crossed.any()
    lone = dangers(traffic(35, 1), own, *LIMITS)
    crossed, _, _ = crossing(lone.areas, lone.course, 1)
    assert (crossed.any(1) == ~lone.safe).all()


def test_the_area_of_a_ship_at_rest_is_the_circle_around_it():
    place = np.array([2.5 * MILE, 1.0 * MILE])
    areas = dangers(targets(place, (0, 0)), own_ship(140), 0.4 * MILE, np.inf).areas
    (course,), (near,), (far,) = areas.course, areas.near, areas.far
    distance, bearing = np.hypot(*place), np.arctan2(*place)
    half = np.arcsin(0.4 * MILE / distance)
    assert np.degrees(course[[0, -1]]) == pytest.approx(
        np.degrees([bearing - half, bearing + half]), abs=0.1
    )
    for way in (near, far):
        reached = way[:, None] * unit_vector(course) - place
        inner = slice(3, -3)  # at the edges a hair decides
        assert np.hypot(*reached[inner].T) == pytest.approx(0.4 * MILE, abs=10)
    assert areas.probability[0, 5:-5].min() > 0.99


def test_a_faster_own_ship_meets_a_crossing_target_in_one_place_a_slower_one_in_two():
    def count(speed):
        crossing_ship = targets((3 * MILE, 3 * MILE), (-14 * KNOT, -7 * KNOT))
        return len(dangers(crossing_ship, own_ship(0, speed), 0.2 * MILE, 5400.0).areas.row)

    assert count(18 * KNOT) == 1
    assert count(9 * KNOT) == 2


def test_the_middle_of_the_area_is_where_both_ships_are_at_the_same_time():
    motion = targets((2.2 * MILE, 2.9 * MILE), (-9 * KNOT, -3 * KNOT))
    areas = dangers(motion, own_ship(50), 0.3 * MILE, 3600.0).areas
    (course,), (middle,) = areas.course, (areas.near + areas.far) / 2
    passing = middle / SPEED
    away = (
        motion.position[0]
        + passing[:, None] * motion.velocity[0]
        - middle[:, None] * unit_vector(course)
    )
    least = np.hypot(*away.T)
    assert least.min() < 40
    assert least.max() == pytest.approx(0.3 * MILE, abs=20)  # at its edges


def test_own_present_course_is_in_an_area_if_the_probability_of_danger_reaches_the_risk():
    motion = traffic(36, 60)
    own = own_ship(302, sigma=0.05)
    now = approach(motion, own, *LIMITS).danger_probability
    crossed, _, _ = crossing(
        dangers(motion, own, *LIMITS).areas, np.array([np.radians(302.0)]), len(now)
    )
    np.testing.assert_array_equal(crossed[0], now >= RISK)
    assert crossed.any() and not crossed.all()


def test_the_less_is_known_the_larger_the_area():
    widths = [
        np.ptp(dangers(motion, own_ship(5), *LIMITS).areas.course)
        for motion in (targets((0, 4 * MILE), (3, -4), k * SURE) for k in (1.0, 3e3, 3e4))
    ]
    assert widths[0] < widths[1] < widths[2]


def test_areas_stand_in_the_water_where_motion_is_through_the_water():
    motion, own = traffic(37, 8), own_ship(20)
    drift = np.array([1.1, -0.6])
    moving, through = sea_stabilised(motion, own, drift)
    found = dangers(moving, through, *LIMITS).areas
    speed = np.hypot(*through.velocity)
    assert abs(speed - SPEED) > 0.3
    by_hand = dangers(
        motion._replace(velocity=motion.velocity - drift),
        own._replace(velocity=own.velocity - drift),
        *LIMITS,
    ).areas
    np.testing.assert_allclose(found.far, by_hand.far)
    # On the way through the water in the middle of an area both ships meet, water and all.
    row, k = found.row[0], 12
    time = (found.near[0, k] + found.far[0, k]) / 2 / speed
    water = speed * unit_vector(found.course[0, k])
    ship = own.position + time * (water + drift)
    assert np.hypot(*(motion.position[row] + time * motion.velocity[row] - ship)) < LIMITS[0]


def test_the_area_through_north_is_one():
    areas = dangers(targets((0, 3 * MILE), (0, 0)), own_ship(90), *LIMITS).areas
    assert len(areas.row) == 1
    first, last = areas.course[0, [0, -1]]
    assert first > np.pi and last > 2 * np.pi and last - first < 1


def test_two_targets_with_two_areas_each_are_kept_apart():
    motion = targets([[3 * MILE, 3 * MILE], [-3 * MILE, 3 * MILE]], [[-7, -3.5], [7, -3.5]])
    areas = dangers(motion, own_ship(0, 9 * KNOT), 0.2 * MILE, 5400.0).areas
    assert sorted(areas.row.tolist()) == [0, 0, 1, 1]
    right, left = (areas.course[areas.row == row] for row in (0, 1))
    mirrored = np.sort(-left[:, ::-1] % (2 * np.pi), 0)
    assert np.sort(right % (2 * np.pi), 0) == pytest.approx(mirrored, abs=1e-3)


def test_surrounded_by_danger_the_area_goes_all_around():
    here = dangers(targets((40.0, 10.0), (0, 0), 1e4 * SURE), own_ship(0), *LIMITS)
    assert not here.safe.any()
    assert np.ptp(here.areas.course) == pytest.approx(2 * np.pi)
    assert (here.areas.near == 0).all()


@pytest.mark.parametrize(
    ('motion', 'own'),
    [
        (targets(np.zeros((0, 2)), (0, 0)), own_ship(0)),
        (targets((np.nan, np.nan), (np.nan, np.nan)), own_ship(0)),
        (targets((0, -2 * MILE), (0, -5)), own_ship(0)),  # goes away
    ],
)
def test_without_a_target_that_can_be_met_there_is_no_area(motion, own):
    found = dangers(motion, own, *LIMITS)
    assert found.safe.all() and not len(found.areas.row)
    assert found.areas.near.shape == (0, found.areas.course.shape[1])


def test_own_ship_at_rest_has_no_areas():
    found = dangers(targets((0, 3 * MILE), (0, -6)), own_ship(0, 0.0), *LIMITS)
    assert not len(found.areas.row) and not found.safe.any()


def test_what_is_not_possible_is_named():
    motion = traffic(38, 2)
    with pytest.raises(ValueError, match='CPA limit is -2 m'):
        dangers(motion, own_ship(), -2.0, 100.0)
    with pytest.raises(ValueError, match='risk is 1.5'):
        dangers(motion, own_ship(), *LIMITS, risk=1.5)
    with pytest.raises(ValueError, match='own ship makes'):
        dangers(motion, own_ship(0, np.nan), *LIMITS)
