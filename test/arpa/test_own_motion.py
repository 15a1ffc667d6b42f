"""Own ship's smoothed motion, and sea against ground stabilisation."""

import numpy as np
import pytest

from marine_tracker.arpa.cpa import approach
from marine_tracker.arpa.motion import Motion
from marine_tracker.arpa.own_motion import own_motion, sea_stabilised, vectors
from marine_tracker.geometry import unit_vector
from marine_tracker.types import OwnShip


def samples(course, speed, times, rng=None, sigma=0.0):
    velocity = speed * unit_vector(np.broadcast_to(course, times.shape))
    if rng is not None:
        velocity = velocity + rng.normal(0, sigma, velocity.shape)
    step = np.diff(times, prepend=times[0])[:, None]
    return OwnShip(times, np.cumsum(step * velocity, 0), velocity)


def targets():
    covariance = np.tile(np.diag([100.0, 100.0, 0.04, 0.04]), (2, 1, 1))
    zero = np.zeros(2)
    return Motion(
        np.array([[3000.0, 4000.0], [-2000.0, 500.0]]),
        np.array([[-6.0, -2.0], [4.0, 3.0]]),
        covariance,
        zero.astype(int),
        zero,
        zero == 0,
        zero == 1,
    )


def test_noise_is_smoothed_and_its_measure_is_right():
    """2,000 fits to samples of .1 m/s noise: errors as deviations say, within 10 %."""
    rng, times = np.random.default_rng(1), np.arange(0, 20.01, 0.5)
    found = [own_motion(samples(1.0, 8.0, times, rng, 0.1), 20.0, 1.0) for _ in range(2000)]
    errors = np.array([own.velocity - 8.0 * unit_vector(1.0) for own in found])
    sigma = np.sqrt(np.mean([own.covariance[2:, 2:].trace() / 2 for own in found]))
    assert errors.std() < 0.07
    assert errors.std() == pytest.approx(sigma, rel=0.1)


def test_a_turn_does_not_lag():
    """45 deg in a minute: the course is that of now, within half a degree."""
    times = np.arange(0, 30.01, 0.5)
    own = own_motion(samples(np.radians(0.75) * times, 8.0, times), 30.0, 0.0)
    course = np.degrees(np.arctan2(*own.velocity))
    assert course == pytest.approx(22.5, abs=0.5)


def test_few_samples_and_late_ones():
    one = OwnShip(np.array([5.0]), np.array([[10.0, 20.0]]), np.array([[3.0, 4.0]]))
    own = own_motion(one, 7.0, 0.5)
    np.testing.assert_allclose(own.position, [16, 28])
    np.testing.assert_allclose(own.velocity, [3, 4])
    assert own.heading == 0.5 and (np.diag(own.covariance)[2:] > 0).all()
    none = OwnShip(np.zeros(0), np.zeros((0, 2)), np.zeros((0, 2)))
    with pytest.raises(ValueError, match='no sample'):
        own_motion(none, 0.0, 0.0)


def test_the_sea_moves_own_ship_and_target_alike():
    """Courses change, nothing relative does; an anchored ship makes way through a current."""
    times = np.arange(0, 20.01, 0.5)
    own, motion = own_motion(samples(0.3, 6.0, times), 20.0, 0.2), targets()
    drift = own.velocity - 5.0 * unit_vector(0.2)
    at_sea, own_at_sea = sea_stabilised(motion, own, drift)
    np.testing.assert_allclose(own_at_sea.velocity, 5.0 * unit_vector(0.2))
    ground, sea = approach(motion, own, 926, 720), approach(at_sea, own_at_sea, 926, 720)
    for name in (
        'range',
        'bearing',
        'relative_course',
        'relative_speed',
        'cpa',
        'tcpa',
        'bow_range',
        'bow_time',
        'danger_probability',
        'cpa_sigma',
    ):
        np.testing.assert_allclose(getattr(sea, name), getattr(ground, name), rtol=1e-6)
    assert not np.allclose(sea.course, ground.course)
    still, _ = sea_stabilised(motion._replace(velocity=np.zeros((2, 2))), own, drift)
    np.testing.assert_allclose(still.velocity, [-drift, -drift])


def test_relative_vectors_end_where_own_ship_will_see_the_target():
    times = np.arange(0, 20.01, 0.5)
    own, motion = own_motion(samples(0.0, 6.0, times), 20.0, 0.0), targets()
    true, relative = (vectors(motion, own, 360.0, kind) for kind in (False, True))
    np.testing.assert_allclose(true, motion.position + 360 * motion.velocity)
    np.testing.assert_allclose(relative - own.position, true - (own.position + 360 * own.velocity))
