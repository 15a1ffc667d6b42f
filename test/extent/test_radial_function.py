"""The radial function against a Gaussian process done in full and finite differences."""

import numpy as np
import pytest

from marine_tracker.extent.radial_function import contour, kernel, lame, radius

PAPER = contour(36, 2.0, 2.0, np.pi / 18)
SHIP = contour(24, 0.2, 0.1, np.pi / 14, folds=2, mean=1.0, power=4.0)


def direct(prior, a, b):
    """k(a, b) as printed in the paper, with folds."""
    half = prior.folds * (a[:, None] - b) / 2
    return (
        prior.deviation**2 * np.exp(-2 * np.sin(half) ** 2 / prior.scale**2)
        + prior.mean_deviation**2
    )


@pytest.mark.parametrize('prior', [PAPER, SHIP], ids=['paper', 'ship'])
def test_the_radius_is_the_posterior_of_the_process_given_f(prior):
    """Conditioned on f in one joint Gaussian of f and the radii asked for."""
    rng, prior = np.random.default_rng(1), prior._replace(power=2.0)  # the base is a circle
    f = prior.mean + rng.multivariate_normal(np.zeros(len(prior.angle)), prior.covariance)
    asked = rng.uniform(-10, 10, 20)
    found = radius(prior, np.ones((1, 2)), f[None], asked[None])
    gram = direct(prior, prior.angle, prior.angle) + 1e-6 * prior.deviation**2 * np.eye(len(f))
    cross = direct(prior, asked, prior.angle)
    expected = prior.mean + cross @ np.linalg.solve(gram, f - prior.mean)
    left = direct(prior, asked, asked) - cross @ np.linalg.solve(gram, cross.T)
    np.testing.assert_allclose(found.mean[0], expected, atol=1e-8)
    np.testing.assert_allclose(found.variance[0], np.maximum(np.diag(left), 0), atol=1e-8)


@pytest.mark.parametrize('prior', [PAPER, SHIP], ids=['paper', 'ship'])
def test_slopes_and_weights_are_finite_differences(prior):
    rng = np.random.default_rng(2)
    f = 1 + 0.2 * rng.standard_normal((3, len(prior.angle)))
    axes = np.array([[1.0, 1.0], [100.0, 16.0], [30.0, 40.0]])
    angle, step = rng.uniform(0, 2 * np.pi, (3, 8)), 1e-6
    at = radius(prior, axes, f, angle)
    ahead, behind = (radius(prior, axes, f, angle + e).mean for e in (step, -step))
    np.testing.assert_allclose(at.slope, (ahead - behind) / (2 * step), rtol=1e-5, atol=1e-4)
    for i in (0, 5, len(prior.angle) - 1):
        more = f + np.eye(len(prior.angle))[i]
        grown = radius(prior, axes, more, angle).mean - at.mean
        np.testing.assert_allclose(at.weight[..., i], grown, atol=1e-8)


def test_outlines_repeat_after_a_turn_and_those_of_two_folds_after_half_a_turn():
    rng = np.random.default_rng(3)
    angle = rng.uniform(-3, 3, (1, 50))
    for prior, period in ((PAPER, 2 * np.pi), (SHIP, np.pi)):
        f = rng.uniform(0.5, 1.5, (1, len(prior.angle)))
        one, other = (
            radius(prior, np.array([[50.0, 10.0]]), f, angle + turn) for turn in (0, period)
        )
        for a, b in zip(one, other):
            np.testing.assert_allclose(a, b, atol=1e-9)
    half = [kernel(PAPER, turn)[0] for turn in (0.0, np.pi)]
    assert abs(half[0] - half[1]).max() > 1


@pytest.mark.parametrize('power', [2.0, 4.0, 7.5])
def test_the_base_is_met_where_its_equation_says(power):
    axes, angle = np.array([[100.0, 16.0]]), np.linspace(0, 2 * np.pi, 41)[None]
    size, _ = lame(axes[:, None], power, angle)
    np.testing.assert_allclose(
        np.abs(size * np.cos(angle) / 100) ** power + np.abs(size * np.sin(angle) / 16) ** power, 1
    )


def test_bad_priors_are_refused():
    with pytest.raises(ValueError, match='2 points; it must have at least 3'):
        contour(2, 1.0, 1.0, 0.1)
    with pytest.raises(ValueError, match='folds is 3'):
        contour(8, 1.0, 1.0, 0.1, folds=3)
