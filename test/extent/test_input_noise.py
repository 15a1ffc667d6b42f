"""Moments of the radius at an uncertain angle, against brute-force sampling and quadrature."""

import numpy as np
import pytest
from numpy.polynomial.hermite_e import hermegauss

from marine_tracker.extent import input_noise
from marine_tracker.extent.input_noise import MOST, NODES, VARIANTS, input_variance, noisy_radius
from marine_tracker.extent.radial_function import contour, radius

PRIOR = contour(36, 2.0, 2.0, np.pi / 18)
CIRCLE = np.ones((1, 2))
F = (4 + 1.2 * np.cos(2 * PRIOR.angle) + 0.8 * np.sin(3 * PRIOR.angle))[None]


def noisy(variant, angle, deviation, rng=None):
    return noisy_radius(PRIOR, CIRCLE, F, np.array([angle]), np.array([deviation**2]), variant, rng)


def integrated(angle, deviation):
    """Means of radius, slope and weights, and V, over N(angle, deviation^2): 80 Hermite nodes."""
    nodes, weights = hermegauss(80)
    weights = weights / weights.sum()
    at = radius(PRIOR, CIRCLE, F, (angle + deviation * nodes)[None])
    mean = at.mean[0] @ weights
    return (
        mean,
        at.slope[0] @ weights,
        weights @ at.weight[0],
        at.variance[0] @ weights + (at.mean[0] - mean) ** 2 @ weights,
    )


@pytest.mark.parametrize('variant', NODES)
def test_nodes_are_even_and_have_the_moments_of_a_unit_normal(variant):
    nodes, weights = NODES[variant]
    assert weights.sum() == pytest.approx(1)
    assert weights @ nodes == pytest.approx(0, abs=1e-15)
    if len(nodes) > 1:
        assert weights @ nodes**2 == pytest.approx(1)


@pytest.mark.parametrize('deviation', [0.02, 0.2, 0.6])
def test_fifteen_nodes_integrate_as_many_hermite_nodes_do(deviation):
    for angle in (0.3, 2.0, 4.4):
        for found, expected in zip(noisy('gp_q15', angle, deviation), integrated(angle, deviation)):
            np.testing.assert_allclose(found[0], expected, rtol=0.03, atol=0.03)


def test_draws_come_to_the_integral_in_the_mean():
    """400 times 100 draws; bound: 4 deviations of the mean."""
    rng = np.random.default_rng(1)
    found = np.array([noisy('gp_mc', 2.0, 0.3, rng).mean[0] for _ in range(400)])
    assert abs(found.mean() - integrated(2.0, 0.3)[0]) < 4 * found.std() / 20


def test_sigma_points_hold_for_small_deviations():
    for found, expected in zip(noisy('gp_ss', 2.0, 0.02), integrated(2.0, 0.02)):
        np.testing.assert_allclose(found[0], expected, rtol=0.01, atol=0.01)


def test_first_order_adds_the_variance_of_the_mean_radius():
    nodes, weights = hermegauss(40)
    radii = radius(PRIOR, CIRCLE, F, (2.0 + 0.02 * nodes)[None]).mean[0]
    mean = np.average(radii, weights=weights)
    expected = np.average((radii - mean) ** 2, weights=weights)
    added = noisy('gp_ts', 2.0, 0.02).variance[0] - noisy('gp', 2.0, 0.02).variance[0]
    assert added == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize('variant', VARIANTS)
def test_without_input_noise_all_are_the_plain_process(variant):
    plain = radius(PRIOR, CIRCLE, F, np.array([[1.1]]))
    for found, expected in zip(noisy(variant, 1.1, 0.0, np.random.default_rng(2)), plain):
        np.testing.assert_allclose(found, expected[:, 0], atol=1e-10)


def test_the_input_variance_is_that_of_drawn_cells_centres_and_headings():
    """Linear up to 0.02 rad; 200,000 draws know a variance to 0.3 %, bound 2 %."""
    rng = np.random.default_rng(3)
    bearing, distance = 0.7, 500.0
    noise = np.array([[20.0, 6.0], [6.0, 50.0]])
    joint = np.diag([30.0, 60.0, 1e-4])
    joint[0, 2] = joint[2, 0] = 0.02
    joint[1, 2] = joint[2, 1] = -0.03
    offset = distance * np.array([np.sin(bearing), np.cos(bearing)])
    cells = offset + rng.multivariate_normal(np.zeros(2), noise, 200000)
    drawn = rng.multivariate_normal(np.zeros(3), joint, 200000)
    east, north = (cells - drawn[:, :2]).T
    angle = np.arctan2(east, north) - drawn[:, 2]
    across = np.array([[np.cos(bearing), -np.sin(bearing)]])
    found = input_variance(across, np.array([distance]), noise[None], joint[None])
    assert found[0] == pytest.approx(angle.var(), rel=0.02)
    only = np.arctan2(*cells.T)
    found = input_variance(across, np.array([distance]), noise[None])
    assert found[0] == pytest.approx(only.var(), rel=0.02)


def test_the_input_variance_is_bounded():
    found = input_variance(np.array([[1.0, 0.0]]), np.array([0.1]), np.eye(2)[None])
    assert found[0] == MOST == pytest.approx((np.pi / 3) ** 2)


def test_only_the_drawing_variant_needs_a_generator():
    assert set(input_noise.NODES) == set(VARIANTS) - {'gp_mc'}
