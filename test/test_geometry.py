import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from marine_tracker.geometry import (
    bearing_from_yaw,
    locate,
    own_ship_at,
    polar_to_position,
    to_range_bearing,
    unit_vector,
    wrap_angle,
    wrap_bearing,
)
from marine_tracker.types import OwnShip, PolarPlots

ANGLES = st.floats(-1e4, 1e4) | st.sampled_from(
    [
        s * np.nextafter(k * np.pi, towards)
        for s in (-1, 1)
        for k in (0, 1, 2, 3)
        for towards in (-np.inf, np.inf)
    ]
    + [k * np.pi for k in range(-4, 5)]
    + [-1e-17, -5e-324]
)


@given(ANGLES)
def test_a_wrapped_bearing_is_the_same_direction_within_one_turn(angle):
    wrapped = float(wrap_bearing(angle))
    assert 0 <= wrapped < 2 * np.pi
    assert math.cos(wrapped - angle) == pytest.approx(1.0, abs=1e-12)


@given(ANGLES)
def test_a_wrapped_angle_is_the_same_direction_within_half_a_turn_either_way(angle):
    wrapped = float(wrap_angle(angle))
    assert -np.pi <= wrapped < np.pi
    assert math.cos(wrapped - angle) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(
    ('bearing_deg', 'east', 'north', 'yaw_deg'),
    [
        (0, 0, 1, 90),
        (90, 1, 0, 0),
        (180, 0, -1, -90),
        (270, -1, 0, -180),
        (45, 0.5**0.5, 0.5**0.5, 45),
        (225, -(0.5**0.5), -(0.5**0.5), -135),
    ],
)
def test_bearings_run_clockwise_from_north_and_yaw_counter_clockwise_from_east(
    bearing_deg, east, north, yaw_deg
):
    bearing = np.radians(bearing_deg)
    assert unit_vector(bearing) == pytest.approx([east, north], abs=1e-12)
    distance, back = to_range_bearing(1000.0 * np.array([east, north]))
    assert distance == pytest.approx(1000.0)
    assert math.cos(back - bearing) == pytest.approx(1.0)
    assert 0 <= back < 2 * np.pi
    of_yaw = float(bearing_from_yaw(np.radians(yaw_deg)))
    assert math.cos(of_yaw - bearing) == pytest.approx(1.0) and 0 <= of_yaw < 2 * np.pi


def test_the_bearing_of_own_position_is_finite():
    distance, bearing = to_range_bearing(np.zeros((1, 2)))
    assert distance == [0.0] and np.isfinite(bearing).all()


def noise_grid(range_sigma, bearing_sigma):
    """Range and bearing noise and their probabilities, by Gauss-Hermite quadrature."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(40)
    weights = weights / weights.sum()
    dr, db = np.meshgrid(range_sigma * nodes, bearing_sigma * nodes)
    return dr.ravel(), db.ravel(), np.outer(weights, weights).ravel()


@pytest.mark.parametrize('bearing_sigma_deg', [0.1, 0.5, 2.0, 10.0])
@pytest.mark.parametrize('distance', [300.0, 6000.0, 44000.0])
def test_the_mean_of_a_targets_converted_plots_is_where_it_is(distance, bearing_sigma_deg):
    range_sigma, bearing_sigma, bearing = 15.0, np.radians(bearing_sigma_deg), 2.1
    dr, db, weight = noise_grid(range_sigma, bearing_sigma)
    position, _ = polar_to_position(distance + dr, bearing + db, range_sigma, bearing_sigma)
    assert weight @ position == pytest.approx(distance * unit_vector(bearing), abs=1e-9 * distance)


@pytest.mark.parametrize('bearing_sigma_deg', [0.1, 0.5, 2.0, 10.0])
@pytest.mark.parametrize('distance', [300.0, 6000.0, 44000.0])
def test_the_covariance_is_that_of_the_truth_given_the_measurement(distance, bearing_sigma_deg):
    """Where nothing else is known: the truth spread about the measurement, by quadrature."""
    range_sigma, bearing_sigma, bearing = 15.0, np.radians(bearing_sigma_deg), 2.1
    position, covariance = polar_to_position(
        np.array([distance]), np.array([bearing]), range_sigma, bearing_sigma
    )
    dr, db, weight = noise_grid(range_sigma, bearing_sigma)
    apart = (distance - dr)[:, None] * unit_vector(bearing - db) - position
    expected = (apart * weight[:, None]).T @ apart
    assert covariance[0] == pytest.approx(expected, rel=1e-6, abs=1e-6 * np.trace(expected))


@pytest.mark.parametrize('bearing_sigma_deg', [0.5, 1.0, 2.0])
def test_long_range_plots_carry_no_bias_and_their_nees_is_two(bearing_sigma_deg):
    """44 km, 100,000 plots; the plain conversion lies 1.7, 6.7 and 27 m short.

    The mean error may be 4 standard deviations of the mean; the NEES, of mean 2 and variance
    about 4, has a mean within 4 * 2 / sqrt(100,000) = 0.025.
    """
    rng = np.random.default_rng(5)
    count, distance, bearing = 100_000, 44_000.0, np.radians(250.0)
    range_sigma, bearing_sigma = 15.0, np.radians(bearing_sigma_deg)
    r = distance + rng.normal(0, range_sigma, count)
    b = bearing + rng.normal(0, bearing_sigma, count)
    radial = unit_vector(bearing)
    truth = distance * radial
    position, covariance = polar_to_position(r, b, range_sigma, bearing_sigma)
    apart = position - truth
    along = apart @ radial
    bound = 4 * along.std() / np.sqrt(count)
    assert abs(along.mean()) < bound
    plain = (r[:, None] * unit_vector(b) - truth) @ radial
    assert plain.mean() < -5 * bound, 'the test could not see the bias'
    nees = np.einsum('ni,ni->n', apart, np.linalg.solve(covariance, apart[..., None])[..., 0])
    assert abs(nees.mean() - 2) < 0.025


def test_sigmas_may_differ_from_plot_to_plot():
    r, b = np.array([1000.0, 5000.0]), np.array([0.3, 4.0])
    sigma_r, sigma_b = np.array([5.0, 50.0]), np.array([0.01, 0.1])
    position, covariance = polar_to_position(r, b, sigma_r, sigma_b)
    for i in range(2):
        one = polar_to_position(r[i : i + 1], b[i : i + 1], float(sigma_r[i]), float(sigma_b[i]))
        np.testing.assert_allclose(position[i], one[0][0], rtol=1e-14)
        np.testing.assert_allclose(covariance[i], one[1][0], rtol=1e-9)


def test_covariances_are_positive_definite_down_to_the_antenna():
    r = np.array([0.0, 1e-3, 1.0, 2e5])
    _, covariance = polar_to_position(r, np.full(4, 1.0), 15.0, np.radians(0.5))
    assert (np.linalg.eigvalsh(covariance) >= 0).all()
    assert (np.linalg.eigvalsh(covariance)[1:] > 0).all()


SHIP = OwnShip(
    np.array([10.0, 12.0, 16.0]),
    np.array([[0.0, 0.0], [4.0, 2.0], [4.0, 10.0]]),
    np.array([[2.0, 1.0], [1.0, 1.0], [-1.0, 3.0]]),
)


@pytest.mark.parametrize(
    ('time', 'position', 'velocity'),
    [
        (10.0, (0, 0), (2, 1)),
        (11.0, (2, 1), (1.5, 1)),
        (15.0, (4, 8), (-0.5, 2.5)),
        (16.0, (4, 10), (-1, 3)),
        (18.0, (2, 16), (-1, 3)),  # holds the last velocity
        (7.0, (-6, -3), (2, 1)),  # and the first one, backwards
    ],
)
def test_own_ship_moves_straight_between_samples_and_on_beyond_them(time, position, velocity):
    for at in (time, np.array([time]), np.array([[time, time]])):
        found = own_ship_at(SHIP, at)
        assert found[0].shape == found[1].shape == np.shape(at) + (2,)
        assert found[0].reshape(-1, 2)[-1] == pytest.approx(position)
        assert found[1].reshape(-1, 2)[-1] == pytest.approx(velocity)


def test_one_sample_of_own_ship_is_enough():
    ship = OwnShip(np.array([5.0]), np.array([[1.0, 2.0]]), np.array([[3.0, -1.0]]))
    position, velocity = own_ship_at(ship, np.array([5.0, 7.0, 4.0]))
    assert position == pytest.approx(np.array([[1, 2], [7, 0], [-2, 3]]))
    assert velocity == pytest.approx(np.array([[3, -1]] * 3))
    assert own_ship_at(ship, 6.0)[0] == pytest.approx([4.0, 1.0])
    assert own_ship_at(ship, np.zeros(0))[0].shape == (0, 2)


def test_every_plot_is_placed_by_own_ship_at_its_own_time():
    time = np.array([10.0, 11.0, 18.0])
    polar = PolarPlots(
        time,
        np.array([100.0, 200.0, 300.0]),
        np.radians([0.0, 90.0, 180.0]),
        np.array([1.0, 2.0, 3.0]),
    )
    sigma_b = np.radians(0.1)
    plots = locate(polar, SHIP, 5.0, sigma_b)
    assert plots.origin == pytest.approx(np.array([[0, 0], [2, 1], [2, 16]]))
    # The unbiased conversion puts them farther out by less than 2 parts in a million here.
    assert plots.position == pytest.approx(np.array([[0, 100], [202, 1], [2, -284]]), abs=1e-3)
    for name in ('time', 'range', 'bearing', 'amplitude'):
        np.testing.assert_array_equal(getattr(plots, name), getattr(polar, name))
    # North of the ship the range error lies north, the bearing error east.
    assert plots.covariance[0] == pytest.approx(
        np.diag([(100 * sigma_b) ** 2 + (5 * sigma_b) ** 2, 25.0]), rel=1e-3
    )
    assert plots.covariance[1] == pytest.approx(
        np.diag([25.0, (200 * sigma_b) ** 2 + (5 * sigma_b) ** 2]), rel=1e-3
    )


def test_no_plots_are_placed_nowhere():
    none = np.zeros(0)
    plots = locate(PolarPlots(none, none, none, none), SHIP, 5.0, 0.01)
    assert plots.position.shape == (0, 2) and plots.covariance.shape == (0, 2, 2)
