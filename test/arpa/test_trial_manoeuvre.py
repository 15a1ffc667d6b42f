import numpy as np
import pytest

from marine_tracker.arpa.cpa import OwnMotion, approach
from marine_tracker.arpa.motion import Motion
from marine_tracker.arpa.own_path import TrialManoeuvre, countdown, paths
from marine_tracker.arpa.trial_manoeuvre import safe_courses, trial_approach
from marine_tracker.geometry import KNOT, NAUTICAL_MILE, to_range_bearing, unit_vector

MILE, TEN_KNOTS = NAUTICAL_MILE, 10 * KNOT
LIMITS = (0.5 * MILE, 1200.0)
SURE = np.diag([1.0, 1.0, 1e-4, 1e-4])


def targets(position, velocity, covariance=SURE):
    position = np.atleast_2d(np.asarray(position, float))
    count = len(position)
    rest = dict.fromkeys(Motion._fields[3:], np.zeros(count, int))  # of no weight in a trial
    return Motion(
        position=position,
        velocity=np.broadcast_to(np.asarray(velocity, float), (count, 2)),
        covariance=np.broadcast_to(covariance, (count, 4, 4)),
        **rest,
    )


def own_ship(course_deg=0.0, speed=TEN_KNOTS, position=(0.0, 0.0)):
    course = np.radians(course_deg)
    return OwnMotion(np.array(position), speed * unit_vector(course), course, np.zeros((4, 4)))


def traffic(seed, count=60):
    """Targets within 8 NM, at up to 20 knots."""
    rng = np.random.default_rng(seed)
    position = rng.uniform(0.5, 8, (count, 1)) * MILE * unit_vector(rng.uniform(0, 7, count))
    velocity = rng.uniform(1, 20, (count, 1)) * KNOT * unit_vector(rng.uniform(0, 7, count))
    root = rng.normal(size=(count, 4, 4)) * np.array([20, 20, 0.2, 0.2])[:, None]
    return targets(position, velocity, root @ root.swapaxes(1, 2) + SURE)


def sailed(own, trial, step=0.1, until=3000.0):
    """Own ship's positions [T, 2] at every `step` s, sailed step by step."""
    speed, course = to_range_bearing(own.velocity)
    left = (trial.course - course + np.pi) % (2 * np.pi) - np.pi
    positions, position = [], np.array(own.position)
    for k in range(round(until / step)):
        positions.append(position)
        position = position + step * speed * unit_vector(course)
        if (k + 1) * step > trial.delay:
            turn = np.clip(left, -trial.turn_rate * step, trial.turn_rate * step)
            course, left = course + turn, left - turn
            speed += np.clip(
                trial.speed - speed, -trial.acceleration * step, trial.acceleration * step
            )
    return np.array(positions)


@pytest.mark.parametrize('delay', [0.0, 240.0])
def test_a_trial_that_changes_nothing_gives_the_plain_cpa(delay):
    motion, own = traffic(1), own_ship(37, position=(300.0, -200.0))
    trial = TrialManoeuvre(np.radians(37), TEN_KNOTS, delay)
    plain, tried = approach(motion, own, *LIMITS), trial_approach(motion, own, trial, *LIMITS)
    assert (plain.tcpa < 0).sum() > 10 and (plain.danger_probability > 0.1).sum() > 3
    np.testing.assert_allclose(tried.cpa, plain.cpa, atol=1e-6)
    np.testing.assert_allclose(tried.tcpa, plain.tcpa, atol=1e-6)
    np.testing.assert_allclose(tried.danger_probability, plain.danger_probability, atol=1e-6)


@pytest.mark.parametrize(
    'trial',
    [
        TrialManoeuvre(np.radians(60), 12 * KNOT, 300.0, np.inf, np.inf),
        TrialManoeuvre(np.radians(60), 12 * KNOT, 60.0, np.radians(1.0), 0.05),
        TrialManoeuvre(np.radians(200), 4 * KNOT, 0.0, np.radians(0.3), 0.01),
        TrialManoeuvre(np.radians(-100), 0.0, 120.0, np.radians(2.0), 0.02),
        TrialManoeuvre(np.radians(350), 10 * KNOT, 30.0, np.radians(0.5), np.inf),
    ],
)
def test_cpa_and_tcpa_are_those_of_the_path_sailed_step_by_step(trial):
    motion, own = traffic(2), own_ship(0)
    tried = trial_approach(motion, own, trial, *LIMITS)
    track, step = sailed(own, trial), 0.1
    time = step * np.arange(len(track))
    for k in range(len(motion.position)):
        distance = np.hypot(*(motion.position[k] + time[:, None] * motion.velocity[k] - track).T)
        at = distance.argmin()
        if at == 0:
            assert not tried.tcpa[k] >= 0  # nan where next to nothing moves
        elif at < len(time) - 1:
            # The sailor's own step errs by half a step's way per change.
            assert tried.cpa[k] == pytest.approx(distance[at], abs=2.0)
            assert distance[max(round(tried.tcpa[k] / step), 0)] == pytest.approx(
                distance[at], abs=2.0
            )


def test_turning_at_once_is_the_plain_cpa_of_the_new_course():
    motion = traffic(3)
    trial = TrialManoeuvre(np.radians(123), 7 * KNOT, 0.0, np.inf, np.inf)
    tried = trial_approach(motion, own_ship(0), trial, *LIMITS)
    plain = approach(motion, own_ship(123, 7 * KNOT), *LIMITS)
    np.testing.assert_allclose(tried.cpa, plain.cpa, atol=1e-6)
    np.testing.assert_allclose(tried.tcpa, plain.tcpa, atol=1e-6)
    np.testing.assert_allclose(tried.danger_probability, plain.danger_probability, atol=1e-6)


def test_the_mirrored_trial_passes_the_mirrored_targets_alike():
    motion, flip = traffic(4), np.array([-1.0, 1.0])
    mirror = np.kron(np.eye(2), np.diag(flip))
    mirrored = motion._replace(
        position=motion.position * flip,
        velocity=motion.velocity * flip,
        covariance=mirror @ motion.covariance @ mirror,
    )
    for turn in (30, 90, 160):
        starboard, port = (
            trial_approach(
                some, own_ship(0), TrialManoeuvre(np.radians(sign * turn), 8 * KNOT, 60.0), *LIMITS
            )
            for some, sign in ((motion, 1), (mirrored, -1))
        )
        for one, other in zip(starboard, port):
            np.testing.assert_allclose(one, other, atol=1e-6)


def test_a_target_turned_away_from_in_time_is_no_danger():
    # Head-on; own ship turns back before it comes near: nearest at the corner of the path.
    motion, own = targets((0, 4 * MILE), (0, -TEN_KNOTS)), own_ship(0)
    trial = TrialManoeuvre(np.pi, 20 * KNOT, 180.0, np.inf, np.inf)
    tried = trial_approach(motion, own, trial, *LIMITS)
    assert tried.cpa[0] == pytest.approx(3 * MILE, abs=1.0)
    assert tried.tcpa[0] == pytest.approx(180.0)
    assert tried.danger_probability[0] < 1e-6
    assert approach(motion, own, *LIMITS).danger_probability[0] > 0.99


@pytest.mark.parametrize('turn_rate', [np.inf, np.radians(0.5)])
def test_the_danger_probability_is_that_of_sampled_motions(turn_rate):
    rng, count = np.random.default_rng(5), 8_000
    covariance = np.diag([60.0, 60.0, 0.5, 0.5]) ** 2 + 0.0
    covariance[0, 2] = covariance[2, 0] = covariance[1, 3] = covariance[3, 1] = 15.0
    motion = targets(
        [[3000, 6000], [-2500, 5000], [0, 7000], [4000, 1500]],
        [[-4, -4], [5, -2], [0, -6], [-6, 2]],
        covariance,
    )
    trial = TrialManoeuvre(np.radians(20), TEN_KNOTS, 90.0, turn_rate)
    expected = trial_approach(motion, own_ship(0), trial, 900.0, 700.0).danger_probability
    assert ((expected > 0.05) & (expected < 0.95)).sum() >= 3
    for k in range(4):
        error = rng.multivariate_normal(np.zeros(4), covariance, count)
        sample = targets(motion.position[k] + error[:, :2], np.zeros(2))
        sample = sample._replace(velocity=motion.velocity[k] + error[:, 2:])
        tried = trial_approach(sample, own_ship(0), trial, 900.0, 700.0)
        share = np.mean((tried.cpa < 900) & (tried.tcpa >= 0) & (tried.tcpa < 700))
        # 4 sigma of 8,000 samples is at most .0224; the rest is what the straight track leaves.
        assert expected[k] == pytest.approx(share, abs=0.0224 + 0.01)


def test_courses_are_safe_where_turning_at_once_keeps_the_cpa():
    motion, own = traffic(6, 5), own_ship(0)
    chosen = safe_courses(
        motion, own, TrialManoeuvre(0.0, TEN_KNOTS, 0.0, np.inf, np.inf), 0.5 * MILE
    )
    for k in range(0, 360, 7):
        turned = approach(motion, own_ship(k), 0.5 * MILE, 1e6)
        some = 1 - np.prod(1 - turned.danger_probability)
        assert chosen.probability[k] == pytest.approx(some, abs=1e-6)
        assert chosen.safe[k] == (some < 0.05)
    assert 0 < chosen.safe.sum() < 360


def test_safe_sectors_are_the_runs_of_safe_courses_through_north_too():
    # A target abeam to starboard that lies still: courses towards it are not safe.
    chosen = safe_courses(
        targets((2 * MILE, 0), (0, 0)),
        own_ship(0),
        TrialManoeuvre(0.0, TEN_KNOTS, 0.0, np.inf, np.inf),
        0.5 * MILE,
    )
    # The courses within asin(.5 / 2) = 14.5 degrees of it pass too near.
    np.testing.assert_allclose(np.degrees(chosen.sectors), [[105, 75]], atol=1.01)
    assert chosen.safe[0] and chosen.safe[270] and not chosen.safe[90]
    assert chosen.nearest[90] == 0 and chosen.cpa[90] < 10
    assert chosen.cpa[270] == pytest.approx(2 * MILE)  # already as near as it will be


def test_two_dangers_leave_two_safe_sectors():
    motion = targets([[2 * MILE, 0], [-2 * MILE, 0]], (0, 0))
    chosen = safe_courses(
        motion, own_ship(0), TrialManoeuvre(0.0, TEN_KNOTS, 0.0, np.inf, np.inf), 0.5 * MILE
    )
    np.testing.assert_allclose(np.degrees(chosen.sectors), [[105, 255], [285, 75]], atol=1.01)


def test_less_sure_motion_leaves_fewer_safe_courses():
    trial = TrialManoeuvre(0.0, TEN_KNOTS, 60.0)
    counts = [
        safe_courses(
            targets((0, 4 * MILE), (0, -5), scale * SURE), own_ship(0), trial, 0.5 * MILE
        ).safe.sum()
        for scale in (1.0, 1e3, 1e4)
    ]
    assert counts[0] > counts[1] > counts[2] > 0


def test_without_targets_every_course_is_safe():
    chosen = safe_courses(
        targets(np.zeros((0, 2)), np.zeros(2)),
        own_ship(0),
        TrialManoeuvre(0.0, TEN_KNOTS),
        0.5 * MILE,
    )
    assert chosen.safe.all() and np.isinf(chosen.cpa).all() and (chosen.nearest == -1).all()
    np.testing.assert_allclose(np.degrees(chosen.sectors), [[0, 359]])


def test_surrounded_no_course_is_safe():
    motion = targets(0.3 * MILE * unit_vector(np.radians(np.arange(0, 360, 20))), (0, 0))
    chosen = safe_courses(motion, own_ship(0), TrialManoeuvre(0.0, TEN_KNOTS), 0.5 * MILE)
    assert not chosen.safe.any() and chosen.sectors.shape == (0, 2)


def test_a_target_of_unknown_motion_is_left_out():
    motion = traffic(7, 3)
    motion = motion._replace(position=motion.position + [[0], [np.nan], [0]])
    tried = trial_approach(motion, own_ship(0), TrialManoeuvre(1.0, TEN_KNOTS), *LIMITS)
    assert np.isnan(tried.cpa).tolist() == [False, True, False]
    assert tried.danger_probability[1] == 0
    chosen = safe_courses(motion, own_ship(0), TrialManoeuvre(1.0, TEN_KNOTS), 0.5 * MILE)
    assert set(chosen.nearest) <= {0, 2}


def test_many_targets_in_portions_give_the_same_as_few():
    motion, own, trial = traffic(8, 200), own_ship(0), TrialManoeuvre(0.0, TEN_KNOTS, 30.0)
    every = safe_courses(motion, own, trial, 0.1 * MILE)
    one = trial_approach(motion, own, trial._replace(course=np.radians(200)), 0.1 * MILE, np.inf)
    assert every.probability[200] == pytest.approx(1 - np.prod(1 - one.danger_probability))


def test_the_trial_leaves_its_inputs_alone():
    motion, own = traffic(9), own_ship(0)
    before = [np.array(column) for column in (*motion, *own)]
    safe_courses(motion, own, TrialManoeuvre(1.0, TEN_KNOTS, 60.0), 0.5 * MILE)
    for one, other in zip(before, (*motion, *own)):
        np.testing.assert_array_equal(one, other)


def test_the_countdown_ends_at_the_manoeuvre():
    trial = TrialManoeuvre(1.0, 5.0, 100.0)
    assert countdown(trial, 30.0) == trial._replace(delay=70.0)
    assert countdown(trial, 130.0).delay == 0
    with pytest.raises(ValueError, match='elapsed is -1 s'):
        countdown(trial, -1.0)


def test_counting_down_does_not_change_where_own_ship_will_be():
    own, trial = own_ship(10), TrialManoeuvre(np.radians(80), 6.0, 100.0)
    later = own_ship(10, position=tuple(60.0 * own.velocity))
    first, second = (
        paths(ship, some, np.array([trial.course]))
        for ship, some in ((own, trial), (later, countdown(trial, 60.0)))
    )
    np.testing.assert_allclose(first.time[0, 1:] - 60.0, second.time[0, 1:], atol=1e-9)
    np.testing.assert_allclose(first.position[0, 1:], second.position[0, 1:], atol=1e-6)


def test_own_ship_at_rest_begins_from_its_heading():
    own = own_ship(90, 0.0)
    path = paths(
        own, TrialManoeuvre(np.radians(90), 5.0, 0.0, acceleration=0.1), np.radians([90.0])
    )
    np.testing.assert_allclose(path.position[0, -1], [125.0, 0.0], atol=1e-6)  # v^2 / 2a


def test_a_steady_turn_is_a_circle():
    own, rate = own_ship(0), np.radians(1.0)
    path = paths(own, TrialManoeuvre(np.radians(90), TEN_KNOTS, 0.0, rate), np.radians([90.0]))
    radius = TEN_KNOTS / rate
    np.testing.assert_allclose(path.position[0, -1], [radius, radius], rtol=1e-6)
    np.testing.assert_allclose(np.hypot(*(path.position[0] - [radius, 0]).T), radius, rtol=1e-6)
    assert path.time[0, -1] == pytest.approx(90.0)


@pytest.mark.parametrize(
    ('values', 'named'),
    [
        ({'course': np.nan}, 'trial course is nan rad; it must be finite'),
        ({'speed': -1.0}, 'trial speed is -1 m/s; it must be between 0 and 51.4444 m/s'),
        ({'speed': 60.0}, 'trial speed is 60 m/s'),
        ({'delay': -1.0}, 'trial delay is -1 s; it must be between 0 and 3600 s'),
        ({'turn_rate': 0.0}, 'trial turn_rate is 0 rad/s; it must be above 0'),
        ({'acceleration': np.nan}, 'trial acceleration is nan m/s^2'),
    ],
)
def test_an_impossible_trial_is_refused(values, named):
    trial = TrialManoeuvre(1.0, 5.0)._replace(**values)
    with pytest.raises(ValueError, match=named.replace('^', r'\^')):
        trial_approach(traffic(1), own_ship(0), trial, *LIMITS)


def test_wrong_limits_and_an_unknown_own_ship_are_refused():
    motion, own, trial = traffic(1), own_ship(0), TrialManoeuvre(1.0, 5.0)
    with pytest.raises(ValueError, match='CPA limit is 0 m'):
        trial_approach(motion, own, trial, 0.0, 100.0)
    with pytest.raises(ValueError, match='TCPA limit is -5 s'):
        trial_approach(motion, own, trial, 100.0, -5.0)
    with pytest.raises(ValueError, match='risk is 1; it must be between 0 and 1'):
        safe_courses(motion, own, trial, 100.0, risk=1.0)
    with pytest.raises(ValueError, match='own ship is at'):
        trial_approach(motion, own._replace(position=np.array([np.nan, 0])), trial, 1.0, 1.0)
