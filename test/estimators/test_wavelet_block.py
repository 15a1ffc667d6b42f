"""The block filter against the exact joint Gaussian, and its wavelets against their definition."""

import numpy as np
import pytest
from scipy.linalg import block_diag, expm

from marine_tracker.estimators import wavelet_block
from marine_tracker.estimators.cs_kalman import Manoeuvre, predict
from marine_tracker.estimators.wavelet_block import SIZE, analysis, coarse, correct, smooth
from marine_tracker.gaussian.linear import kalman_update, weighted_fusion

WAVELETS = ('haar', 'db2', 'db4', 'sym4', 'coif1')
ALPHA, LIMIT = 1 / 40, 3.0
MANOEUVRE = Manoeuvre(LIMIT, ALPHA)
OBSERVE = np.zeros((2, 6))
OBSERVE[0, 0] = OBSERVE[1, 3] = 1.0


def history(rng, tracks=3, plots=8):
    """Uneven times, plots of any covariance, and what is known at the start."""
    root = rng.normal(size=(tracks, 6, 6))
    mean = rng.normal(size=(tracks, 6)) * np.tile([1000, 8, 0.5], 2)
    covariance = root @ root.swapaxes(1, 2) + 0.1 * np.eye(6)
    time = np.cumsum(rng.uniform(0.3, 4.0, (tracks, plots + 1)), 1)
    shape = rng.normal(size=(tracks, plots, 2, 2))
    noise = 4 * shape @ shape.swapaxes(-1, -2) + np.eye(2)
    position = mean[:, None, ::3] + rng.normal(size=(tracks, plots, 2)) * 10
    return mean, covariance, time, position, noise


def chain(mean, step):
    """F, u, Q of a step, by the matrix exponential and Van Loan's integral; mean [6] at start."""
    singer = np.array([[0.0, 1, 0], [0, 0, 1], [0, 0, -ALPHA]])
    move = expm(singer * step)
    noises, drives = [], []
    for a in mean[2::3]:
        held = np.clip(a, -LIMIT, LIMIT)
        room = LIMIT - abs(held)
        variance = (4 - np.pi) / np.pi * max(room**2, 0.05 * LIMIT**2)
        density = np.diag([0, 0, 2 * ALPHA * variance])
        loan = expm(np.block([[-singer, density], [np.zeros((3, 3)), singer.T]]) * step)
        noises.append(loan[3:, 3:].T @ loan[:3, 3:])
        driven = expm(
            np.block([[singer, np.array([[0], [0], [ALPHA * held]])], [np.zeros((1, 4))]]) * step
        )
        drives.append(driven[:3, 3])
    return block_diag(move, move), np.concatenate(drives), block_diag(*noises)


@pytest.mark.parametrize('wavelet', WAVELETS)
@pytest.mark.parametrize('depth', [0, 1, 2])
def test_the_transform_is_orthonormal_and_its_details_see_no_level(wavelet, depth):
    rows = analysis(wavelet, depth)
    np.testing.assert_allclose(rows @ rows.T, np.eye(SIZE), atol=1e-10)
    np.testing.assert_allclose(rows[SIZE >> depth :] @ np.ones(SIZE), 0, atol=1e-10)


def test_haar_is_sums_and_differences():
    half = np.sqrt(0.5)
    np.testing.assert_allclose(
        np.abs(analysis('haar', 2)),
        [[0.5] * 4, [0.5] * 4, [half, half, 0, 0], [0, 0, half, half]],
        atol=1e-12,
    )


@pytest.mark.parametrize('wavelet', WAVELETS)
def test_the_coarsest_row_of_every_wavelet_is_the_mean(wavelet):
    np.testing.assert_allclose(coarse(wavelet, 2), [[0.5] * 4], atol=1e-10)


def test_what_cannot_be_is_refused():
    with pytest.raises(ValueError, match='block of 6 cannot be halved 2 times'):
        analysis('haar', 2, 6)
    with pytest.raises(ValueError, match='bior2.2 is not orthogonal'):
        analysis('bior2.2', 1)
    mean, covariance, time, position, noise = history(np.random.default_rng(0), plots=6)
    with pytest.raises(ValueError, match='history of 6 plots'):
        smooth(mean, covariance, time, position, noise, MANOEUVRE)


@pytest.mark.parametrize('wavelet', WAVELETS)
def test_all_subbands_are_the_exact_posterior_at_block_ends(condition, wavelet):
    """Two blocks of uneven steps; the oracle conditions the whole trajectory at once."""
    rng = np.random.default_rng(3)
    mean, covariance, time, position, noise = history(rng)
    rows = analysis(wavelet, 2)
    steps = np.diff(time, axis=1)
    state, spread, begins = mean, covariance, [mean, None]
    for at in (0, SIZE):
        part = slice(at, at + SIZE)
        block = wavelet_block.predict(state, spread, steps[:, part], MANOEUVRE)
        block = correct(block, position[:, part], noise[:, part], rows)
        state, spread = block.mean[:, -1], block.covariance[:, -6:, -6:]
        begins[1] = state if at == 0 else begins[1]
    for i in range(len(mean)):
        # Mean and variance of the acceleration are held through a block.
        chains = [chain(begins[k // SIZE][i], steps[i, k]) for k in range(2 * SIZE)]
        exact, sure = condition(
            mean[i], covariance[i], chains, OBSERVE, list(zip(position[i], noise[i], strict=True))
        )
        np.testing.assert_allclose(state[i], exact, rtol=1e-9, atol=1e-8)
        np.testing.assert_allclose(spread[i], sure, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize('wavelet', WAVELETS)
def test_all_subbands_smooth_inside_the_block_as_the_joint_gaussian_does(wavelet):
    """One block: prior of all four states from sampled sources, conditioned in one piece."""
    rng = np.random.default_rng(4)
    mean, covariance, time, position, noise = history(rng, tracks=1, plots=SIZE)
    step = np.diff(time[0])
    weight, centre = np.zeros((6 * SIZE, 6 * (SIZE + 1))), []
    source, last = [covariance[0]], mean[0]
    now = np.concatenate([np.eye(6), np.zeros((6, 6 * SIZE))], 1)
    for j in range(SIZE):
        move, drive, kick = chain(mean[0], step[j])
        now, last = move @ now, move @ last + drive
        now[:, 6 * (j + 1) : 6 * (j + 2)] = np.eye(6)
        weight[6 * j : 6 * (j + 1)] = now
        centre.append(last)
        source.append(kick)
    joint = weight @ block_diag(*source) @ weight.T
    seen = np.kron(np.eye(SIZE), OBSERVE)
    gain = joint @ seen.T @ np.linalg.inv(seen @ joint @ seen.T + block_diag(*noise[0]))
    expected = np.concatenate(centre)
    exact = expected + gain @ (position[0].ravel() - seen @ expected)
    block = wavelet_block.predict(mean, covariance, np.diff(time), MANOEUVRE)
    np.testing.assert_allclose(block.covariance[0], joint, rtol=1e-9, atol=1e-9)
    block = correct(block, position, noise, analysis(wavelet, 2))
    np.testing.assert_allclose(block.mean[0].ravel(), exact, rtol=1e-9, atol=1e-8)
    np.testing.assert_allclose(block.covariance[0], joint - gain @ seen @ joint, atol=1e-8)


def test_the_coarse_level_moves_the_block_as_a_whole():
    """Its details stay as predicted, and the Joseph covariance is that of a linear error."""
    rng = np.random.default_rng(5)
    mean, covariance, time, position, noise = history(rng, plots=SIZE)
    before = wavelet_block.predict(mean, covariance, np.diff(time), MANOEUVRE)
    after = correct(before, position, noise, coarse('haar', 2))
    shift = after.mean - before.mean
    np.testing.assert_allclose(shift, np.tile(shift[:, :1], (1, SIZE, 1)), atol=1e-9)
    # Monte Carlo of the same linear rule: the gain is read off unit innovations.
    flat = before.mean.reshape(3, -1)
    gain = np.stack(
        [
            correct(
                before, before.mean[..., ::3] + unit.reshape(1, SIZE, 2), noise, coarse('haar', 2)
            ).mean.reshape(3, -1)
            - flat
            for unit in np.eye(2 * SIZE)
        ],
        -1,
    )
    seen = np.kron(np.eye(SIZE), OBSERVE)
    for i in range(3):
        draws = 60000
        error = rng.multivariate_normal(np.zeros(24), before.covariance[i], draws)
        off = np.concatenate([rng.multivariate_normal(np.zeros(2), r, draws) for r in noise[i]], 1)
        left = error - (error @ seen.T + off) @ gain[i].T
        found = left.var(0) / np.diag(after.covariance[i])
        assert (np.abs(found - 1) < 5 * np.sqrt(2 / draws)).all()


def test_details_count_only_beyond_the_threshold():
    rng = np.random.default_rng(6)
    mean, covariance, time, position, noise = history(rng, plots=SIZE)
    plain = smooth(mean, covariance, time, position, noise, MANOEUVRE)
    deaf = smooth(mean, covariance, time, position, noise, MANOEUVRE, threshold=1e6)
    np.testing.assert_allclose(deaf.mean, plain.mean, atol=1e-9)
    open_ = smooth(mean, covariance, time, position, noise, MANOEUVRE, threshold=0.5)
    assert np.abs(open_.mean - plain.mean).max() > 0.01


def test_two_plots_in_turn_are_the_weighted_one():
    rng = np.random.default_rng(7)
    mean, covariance, time, position, noise = history(rng, tracks=5, plots=2)
    fused, sure = weighted_fusion(position[:, 0], noise[:, 0], position[:, 1], noise[:, 1])
    at = (0, 3)
    turn, spread = predict(mean, covariance, time[:, 0], MANOEUVRE)
    once = kalman_update(turn, spread, fused - turn[:, ::3], sure, at)
    for k in (0, 1):
        turn, spread, _, _ = kalman_update(
            turn, spread, position[:, k] - turn[:, ::3], noise[:, k], at
        )
    np.testing.assert_allclose(once[0], turn, rtol=1e-10, atol=1e-9)
    np.testing.assert_allclose(once[1], spread, rtol=1e-9, atol=1e-9)
