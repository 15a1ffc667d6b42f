"""The outline filter against finite differences and an exact joint Gaussian."""

import numpy as np
import pytest

from marine_tracker.extent import gaussian_process as gp
from marine_tracker.extent.input_noise import VARIANTS
from marine_tracker.extent.radial_function import contour
from marine_tracker.types import take

PAPER = contour(36, 2.0, 2.0, np.pi / 18)
SHIP = contour(24, 0.2, 0.1, np.pi / 14, folds=2, mean=1.0)


def model(variant='gp_q15', prior=PAPER, **other):
    return gp.Model(prior, variant, noise=1e-4, turn_noise=1e-8, **other)


def outlined(rng, count, prior=PAPER, size=4.0):
    """Rows with lively outlines and full covariances."""
    motion = np.column_stack(
        [
            rng.uniform(-50, 50, (count, 2)),
            rng.normal(0, 2, (count, 2)),
            rng.uniform(-3, 3, count),
            rng.normal(0, 0.01, count),
        ]
    )
    f = size * (1 + 0.2 * rng.standard_normal((count, len(prior.angle))))
    state = gp.start(
        model(prior=prior),
        np.zeros(count),
        motion,
        np.diag([1, 1, 0.1, 0.1, 0.01, 1e-4]),
        f,
        np.ones((count, 2)),
    )
    mix = np.eye(state.mean.shape[1]) + 0.05 * rng.standard_normal(state.covariance.shape)
    return state._replace(covariance=mix @ state.covariance @ mix.swapaxes(1, 2))


def around(state, rng, cells):
    """Cells [N, cells, 2] some 2 to 6 m from the centres."""
    angle = rng.uniform(0, 2 * np.pi, (len(state.time), cells))
    distance = rng.uniform(2, 6, angle.shape)[..., None]
    return state.mean[:, None, :2] + distance * np.stack([np.sin(angle), np.cos(angle)], -1)


def noises(count):
    return np.tile([[1.0, 0.3], [0.3, 0.6]], (count, 1, 1))


@pytest.mark.parametrize('inside', [(1.0, 0.0), (0.85, 0.25)])
@pytest.mark.parametrize('variant', ['gp', 'gp_ts'])
def test_the_jacobian_is_that_of_the_innovation(variant, inside):
    """Central differences; the figure demanded is 1e-2."""
    rng = np.random.default_rng(1)
    state = outlined(rng, 40)
    cell, chosen, step = around(state, rng, 1)[:, 0], model(variant, inside=inside), 1e-6
    found = gp.measure(state, cell, noises(40), chosen).jacobian
    for i in range(found.shape[1]):
        shift = step * np.eye(found.shape[1])[i]
        ahead, behind = (
            gp.measure(state._replace(mean=state.mean + s), cell, noises(40), chosen).innovation
            for s in (shift, -shift)
        )
        np.testing.assert_allclose(found[:, i], (behind - ahead) / (2 * step), atol=1e-4)


@pytest.mark.parametrize('variant', VARIANTS)
def test_without_input_noise_every_variant_is_the_plain_filter(variant):
    """No noise of the cells, and a place and heading that are known."""
    rng = np.random.default_rng(2)
    state = outlined(rng, 5)
    state.covariance[:, gp.PLACE] = state.covariance[:, :, gp.PLACE] = 0.0
    cells, every = around(state, rng, 6), np.arange(5)
    none = 1e-12 * noises(5)
    plain, _ = gp.update(state, every, cells, np.full(5, 6), none, model('gp'))
    found, _ = gp.update(
        state, every, cells, np.full(5, 6), none, model(variant), np.random.default_rng(0)
    )
    np.testing.assert_allclose(found.mean, plain.mean, atol=1e-4)
    np.testing.assert_allclose(found.covariance, plain.covariance, atol=1e-4)


def test_with_place_and_heading_known_the_outline_is_the_exact_posterior(condition):
    """Then a cell is linear in f: 30 cells one by one against all at once."""
    rng = np.random.default_rng(3)
    motion = np.array([[100.0, -50.0, 0.0, 0.0, 0.8, 0.0]])
    state = gp.start(
        model('gp'), np.zeros(1), motion, np.zeros((6, 6)), np.ones((1, 36)), np.ones((1, 2))
    )
    angle = rng.uniform(0, 2 * np.pi, 30)
    off = rng.uniform(3, 5, 30)
    line = np.stack([np.sin(angle + 0.8), np.cos(angle + 0.8)], -1)
    cells = motion[:, None, :2] + off[:, None] * line
    noise = np.array([[1.0, 0.3], [0.3, 0.6]])
    found, nis = gp.update(state, np.array([0]), cells, np.array([30]), noise[None], model('gp'))
    kernel = (
        4 * np.exp(-2 * np.sin((angle[:, None] - PAPER.angle) / 2) ** 2 / (np.pi / 18) ** 2) + 4
    )
    h = np.linalg.solve(PAPER.covariance, kernel.T).T
    variance = 8 - (h * kernel).sum(1) + np.einsum('ci,ij,cj->c', line, noise, line)
    stays = (np.eye(36), 0, np.zeros((36, 36)))
    mean, covariance = condition(
        np.ones(36), PAPER.covariance, [stays], h, [(off, np.diag(variance))]
    )
    np.testing.assert_allclose(found.mean[0, 6:], mean, atol=1e-6)
    np.testing.assert_allclose(found.covariance[0, 6:, 6:], covariance, atol=1e-6)
    assert not found.covariance[0, :6].any()
    assert nis[0] > 0


def test_prediction_moves_centre_and_heading_only():
    rng = np.random.default_rng(4)
    state, step, chosen = outlined(rng, 3), np.array([0.0, 2.7, 60.0]), model()
    moved = gp.predict(state, step, chosen)
    for row, T in enumerate(step):
        F = np.eye(42)
        F[0, 2] = F[1, 3] = F[4, 5] = T
        Q = np.zeros((42, 42))
        for a, b, q in ((0, 2, 1e-4), (1, 3, 1e-4), (4, 5, 1e-8)):
            Q[np.ix_([a, b], [a, b])] = q * np.array([[T**3 / 3, T**2 / 2], [T**2 / 2, T]])
        np.testing.assert_allclose(moved.mean[row], F @ state.mean[row])
        np.testing.assert_allclose(
            moved.covariance[row], F @ state.covariance[row] @ F.T + Q, atol=1e-9
        )


def test_rows_do_not_mix_and_padding_does_not_count():
    rng = np.random.default_rng(5)
    state = outlined(rng, 4)
    cells, count = around(state, rng, 8), np.array([8, 0, 3, 5])
    rows = np.array([3, 1, 0])
    together, nis = gp.update(state, rows, cells[rows], count[rows], noises(3), model())
    cells[2] = np.nan
    for at, row in enumerate(rows):
        one = np.array([0])
        alone, its = gp.update(
            take(state, np.array([row])),
            one,
            cells[[row], : count[row]],
            count[[row]],
            noises(1),
            model(),
        )
        np.testing.assert_allclose(together.mean[row], alone.mean[0], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(nis[at], its[0])
    assert np.isnan(nis[1])
    for row in (1, 2):
        np.testing.assert_array_equal(together.mean[row], state.mean[row])
    np.testing.assert_array_equal(outlined(np.random.default_rng(5), 4).mean, state.mean)


@pytest.mark.parametrize('prior', [PAPER, SHIP])
def test_the_covariance_stays_one(prior):
    """100 cells: symmetric, and no eigenvalue below rounding."""
    rng = np.random.default_rng(6)
    state = outlined(rng, 3, prior, 1.0)._replace(semi_axes=np.array([[4.0, 3.0]] * 3))
    for _ in range(10):
        state, _ = gp.update(
            state,
            np.arange(3),
            around(state, rng, 10),
            np.full(3, 10),
            noises(3),
            model(prior=prior),
        )
    np.testing.assert_allclose(state.covariance, state.covariance.swapaxes(1, 2), atol=1e-10)
    assert np.linalg.eigvalsh(state.covariance).min() > -1e-10


def test_far_cells_are_left_out_by_the_gate():
    rng = np.random.default_rng(7)
    state = outlined(rng, 1)
    far = state.mean[:, None, :2] + 500.0
    found, nis = gp.update(state, np.array([0]), far, np.array([1]), noises(1), model(gate=16.0))
    np.testing.assert_array_equal(found.mean, state.mean)
    assert nis[0] > 16


def test_an_unknown_variant_is_refused():
    with pytest.raises(ValueError, match="variant is 'gp_x'; it must be one of gp, gp_ts"):
        gp.start(
            model('gp_x'),
            np.zeros(1),
            np.zeros((1, 6)),
            np.eye(6),
            np.ones((1, 36)),
            np.ones((1, 2)),
        )
