"""Measures of outlines against shapes whose size is known."""

import numpy as np
import pytest

from marine_tracker.estimators.contract import Velocity
from marine_tracker.extent import outline_measures, random_matrix
from marine_tracker.extent.gaussian_process import FIRST_RADIUS, Model, start
from marine_tracker.extent.radial_function import contour as contour_prior
from marine_tracker.extent.radial_function import radius

PAPER = contour_prior(36, 2.0, 2.0, np.pi / 18)
SHIP = contour_prior(24, 0.2, 0.1, np.pi / 14, folds=2, mean=1.0)
TURN = 2 * np.pi


def target(prior, f, semi_axes=(1.0, 1.0), heading=0.5, covariance=0.0):
    """One row at [100, 200] m."""
    motion = np.array([[100.0, 200.0, 3.0, 4.0, heading, 0.0]])
    return start(
        Model(prior, 'gp', 0.0, 0.0),
        np.zeros(1),
        motion,
        covariance * np.eye(6),
        np.broadcast_to(f, (1, len(prior.angle))),
        np.array([semi_axes]),
    )


def matrix(extent):
    return random_matrix.start(
        np.zeros(1),
        np.zeros((1, 2)),
        np.eye(2)[None],
        Velocity(np.zeros((1, 2)), np.eye(2)[None]),
        np.array([extent]),
    )


def test_an_elliptic_ship_has_its_length_beam_area_and_axis():
    state = target(SHIP, 1.0, (100.0, 16.0), heading=4.0)
    found = outline_measures.measures(state, SHIP)
    assert found.length[0] == pytest.approx(200, rel=1e-3)
    assert found.beam[0] == pytest.approx(32, rel=1e-3)
    assert found.axis[0] == pytest.approx(4.0 - np.pi)
    outline = outline_measures.of_gaussian_process(state, SHIP)
    assert outline_measures.area(outline.points)[0] == pytest.approx(np.pi * 1600, rel=5e-3)
    bow = state.mean[0, :2] + 100 * np.array([np.sin(4.0), np.cos(4.0)])
    np.testing.assert_allclose(outline.points[0, 0], bow, rtol=1e-3)


def test_an_outline_longer_ahead_than_abaft_is_measured_end_to_end():
    f = 5 + 2 * np.cos(PAPER.angle)
    found = outline_measures.measures(target(PAPER, f), PAPER)
    assert found.length[0] == pytest.approx(10, rel=5e-3)


@pytest.mark.parametrize('prior, axes', [(PAPER, (1.0, 1.0)), (SHIP, (100.0, 16.0))])
def test_deviations_are_those_of_drawn_outlines(prior, axes):
    """2,000 draws of f, little uncertain, so that the ends stay where they are; bound 10 %."""
    rng = np.random.default_rng(1)
    mean = 1 + 0.1 * np.cos(2 * prior.angle) if prior is PAPER else np.ones(24)
    covariance = 1e-6 * prior.covariance
    state = target(prior, mean, axes)
    state.covariance[0, FIRST_RADIUS:, FIRST_RADIUS:] = covariance
    found = outline_measures.measures(state, prior)
    outline = outline_measures.of_gaussian_process(state, prior)
    draws = rng.multivariate_normal(mean, covariance, 2000)
    ends = np.array([[0.0, np.pi], [np.pi / 2, 3 * np.pi / 2]])
    for side, told in zip(ends, (found.length_sd, found.beam_sd)):
        at = [radius(prior, np.array([axes]), f[None], side[None]) for f in draws]
        width = np.array([one.mean.sum() for one in at])
        left = at[0].variance.sum()
        assert told[0] == pytest.approx(np.sqrt(width.var() + left), rel=0.1)
    side = outline_measures.AROUND[None, 23:24]
    at = [radius(prior, np.array([axes]), f[None], side) for f in draws]
    variance = np.var([one.mean for one in at]) + at[0].variance[0, 0]
    assert outline.radius_sd[0, 23] == pytest.approx(np.sqrt(variance), rel=0.1)


def test_a_random_matrix_is_an_ellipse():
    outline = outline_measures.of_random_matrix(matrix(np.diag([100.0**2, 16.0**2])))
    np.testing.assert_allclose(outline.points[0, [0, 90]], [[0, 16], [100, 0]], atol=1e-9)
    assert outline_measures.area(outline.points)[0] == pytest.approx(np.pi * 1600, rel=0.02)
    twice = outline_measures.of_random_matrix(matrix(np.diag([100.0**2, 16.0**2])), size=2.0)
    np.testing.assert_allclose(twice.points, 2 * outline.points)


def test_errors_of_drawn_outlines_are_calibrated():
    """f drawn from its own covariance: MD^2 is chi-square of 36, mean 36 +- 4 sqrt(72 / 400)."""
    rng = np.random.default_rng(2)
    truth = 4 + np.cos(2 * PAPER.angle)
    covariance = 0.01 * PAPER.covariance
    f = rng.multivariate_normal(truth, covariance, 400)
    state = start(
        Model(PAPER, 'gp', 0.0, 0.0),
        np.zeros(400),
        np.zeros((400, 6)),
        np.eye(6),
        f,
        np.ones((400, 2)),
    )
    state.covariance[:, FIRST_RADIUS:, FIRST_RADIUS:] = covariance
    found = outline_measures.error(state, PAPER, truth)
    assert abs(np.square(found.mahalanobis).mean() - 36) < 4 * np.sqrt(72 / 400)
    assert found.coverage.mean() == pytest.approx(0.9973, abs=0.004)
    assert np.square(found.rmse).mean() == pytest.approx(0.08, rel=0.2)


def test_the_shape_error_is_zero_on_the_truth_and_grows_with_place():
    def egg(angle):
        return 4 + np.cos(angle)

    state = target(PAPER, egg(PAPER.angle))
    points = outline_measures.of_gaussian_process(state, PAPER).points
    centre, heading = state.mean[:, :2], state.mean[:, 4]
    assert outline_measures.shape_error(points, centre, heading, egg)[0] < 0.01
    assert outline_measures.shape_error(points, centre, heading + np.pi, egg)[0] == pytest.approx(
        2 / np.sqrt(2), rel=0.02
    )
    assert outline_measures.shape_error(points + 1.0, centre, heading, egg)[0] > 0.7
