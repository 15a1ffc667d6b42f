"""The bound where it is known: linear measurements, and filters that can do no better."""

import numpy as np
import pytest

from marine_tracker.extent import gaussian_process as gp
from marine_tracker.extent.radial_function import contour
from marine_tracker.lab.extended.pcrlb import bound_step

PRIOR = contour(36, 2.0, 2.0, np.pi / 18)


def scene(rng, count, cells):
    """Rows of circles at known places, with cells on their outlines."""
    motion = np.tile([20.0, 30.0, 0.0, 0.0, 0.3, 0.0], (count, 1))
    angle = rng.uniform(0, 2 * np.pi, (count, cells))
    line = np.stack([np.sin(angle), np.cos(angle)], -1)
    seen = motion[:, None, :2] + 4 * line + rng.standard_normal((count, cells, 2))
    return motion, seen


def model(variant='gp'):
    return gp.Model(PRIOR, variant, noise=1e-4, turn_noise=1e-8)


def start(motion, covariance, f):
    return gp.start(
        model(), np.zeros(len(motion)), motion, covariance, f, np.ones((len(motion), 2))
    )


def test_the_bound_of_a_linear_filter_is_its_covariance():
    """Place and heading all but known, one row: the bound after 12 cells is the Kalman filter's."""
    motion, cells = scene(np.random.default_rng(1), 1, 12)
    state = start(motion, 1e-9 * np.eye(6), np.full((1, 36), 4.0))
    noise = np.eye(2)[None]
    bound = bound_step(state.covariance[0], 0.0, state, cells, np.array([12]), noise, model())
    found, _ = gp.update(
        gp.predict(state, np.zeros(1), model()),
        np.array([0]),
        cells,
        np.array([12]),
        noise,
        model(),
    )
    np.testing.assert_allclose(bound[6:, 6:], found.covariance[0, 6:, 6:], atol=1e-5)


def test_without_cells_the_bound_is_the_prediction():
    motion, cells = scene(np.random.default_rng(2), 3, 1)
    state = start(motion, np.diag([1, 1, 0.1, 0.1, 0.1, 0.001]), np.full((3, 36), 4.0))
    later = state._replace(time=np.full(3, 2.0))
    bound = bound_step(
        state.covariance[0],
        0.0,
        later,
        cells,
        np.zeros(3, int),
        np.tile(np.eye(2), (3, 1, 1)),
        model(),
    )
    moved = gp.predict(state, later.time, model())
    np.testing.assert_allclose(bound, moved.covariance[0], rtol=1e-5, atol=1e-6)


def test_information_is_the_mean_over_the_rows():
    """Rows alike count once: as many cells in each of five rows as in one."""
    motion, cells = scene(np.random.default_rng(3), 1, 6)
    five = np.repeat(motion, 5, 0)
    bounds = []
    for rows in (motion, five):
        state = start(rows, np.diag([1, 1, 0.1, 0.1, 0.1, 0.001]), np.full((len(rows), 36), 4.0))
        bounds.append(
            bound_step(
                state.covariance[0],
                0.0,
                state,
                np.repeat(cells, len(rows), 0),
                np.full(len(rows), 6),
                np.tile(np.eye(2), (len(rows), 1, 1)),
                model(),
            )
        )
    np.testing.assert_allclose(bounds[0], bounds[1], rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize('variant', ['gp_ts', 'gp_ss', 'gp_q15'])
def test_input_noise_widens_the_bound(variant):
    motion, cells = scene(np.random.default_rng(4), 50, 10)
    f = np.tile(4 + np.cos(3 * PRIOR.angle), (50, 1))
    state = start(motion, np.diag([1, 1, 0.1, 0.1, 0.1, 0.001]), f)
    arguments = (
        state.covariance[0],
        0.0,
        state,
        cells,
        np.full(50, 10),
        np.tile(np.eye(2), (50, 1, 1)),
    )
    plain, wide = (
        np.trace(bound_step(*arguments, model(name))[6:, 6:]) for name in ('gp', variant)
    )
    assert wide > 1.05 * plain
