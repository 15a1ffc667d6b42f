"""The "current" statistical model against quadrature, its filter against the joint Gaussian."""

from functools import cache

import numpy as np
import pytest
from scipy.linalg import block_diag, expm

from marine_tracker.estimators.cs_kalman import (
    PRESETS,
    SERIES_BELOW,
    SHOWN,
    Manoeuvre,
    acceleration_variance,
    cs_kalman,
    predict,
)

RATES = [1 / 60, 1 / 20, 0.3, 2.0]  # 1/s, alpha
TURNS = np.r_[
    np.logspace(-4, np.log10(5), 19), SERIES_BELOW * (1 + np.array([-1e-3, -1e-12, 0, 1e-12, 1e-3]))
]  # alpha T
NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)


def singer(alpha):
    """dx/dt = A x of [x, v, a], where the acceleration decays at the rate alpha."""
    return np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -alpha]])


@cache
def kicks(alpha, step):
    """[n, 3] states after unit kicks of acceleration at the nodes of the quadrature."""
    half = 0.5 * step
    return expm(singer(alpha) * (half * (NODES + 1))[:, None, None])[..., 2]


def integrate(alpha, step, integrand):
    """Of integrand(kick [n, 3]) over [0, step], Gauss-Legendre; 24 nodes are exact to rounding."""
    return np.tensordot(0.5 * step * WEIGHTS, integrand(kicks(alpha, step)), 1)


def transition(alpha, step):
    return expm(singer(alpha) * step)


def drive(alpha, step):
    """Effect of a constant mean acceleration of 1: dx/dt = A x + [0, 0, alpha]."""
    return alpha * integrate(alpha, step, lambda kick: kick)


def noise(alpha, step):
    """Covariance that white noise of unit density leaves after the step."""
    return integrate(alpha, step, lambda kick: kick[:, :, None] * kick[:, None, :])


def variance(acceleration, limit):
    """Modified Rayleigh density, spec part A; the floor is a twentieth of its value at rest."""
    away = limit - acceleration if acceleration >= 0 else -limit - acceleration
    return (4 - np.pi) / np.pi * max(away**2, 0.05 * limit**2)


def moved(mean, covariance, step, alpha, limit=1.0):
    """`predict` of one state."""
    mean, covariance = predict(
        np.array([mean], float),
        np.array([covariance], float),
        np.array([step], float),
        Manoeuvre(limit, alpha),
    )
    return mean[0], covariance[0]


def close(found, expected, relative=1e-9):
    """Entry by entry, relative to each entry: no small one hides behind a large one."""
    np.testing.assert_allclose(found, expected, rtol=relative, atol=1e-30)


def test_the_oracle_agrees_with_exact_integrals_where_these_are_simple():
    """alpha = 0 in all but name: a kick is a constant acceleration."""
    step = 3.0
    close(integrate(1e-14, step, lambda k: k), [step**3 / 6, step**2 / 2, step], 1e-12)
    close(noise(1e-14, step)[0], [step**5 / 20, step**4 / 8, step**3 / 6], 1e-12)


@pytest.mark.parametrize('alpha', RATES)
def test_the_transition_is_that_of_the_model(alpha):
    """F is read off the covariance cross terms: with P = e_j e_j', F P F' = f_j f_j'."""
    for turn in TURNS:
        step = turn / alpha
        expected = transition(alpha, step)
        _, none = moved(np.zeros(6), np.zeros((6, 6)), step, alpha)
        for j in range(3):
            big = 1e40  # beside it the process noise is nothing
            unit = np.zeros((6, 6))
            unit[j, j] = unit[3 + j, 3 + j] = big
            _, covariance = moved(np.zeros(6), unit, step, alpha)
            column = expected[:, j]
            for axis in (slice(0, 3), slice(3, 6)):
                close(covariance[axis, axis] / big, np.outer(column, column))
            assert not covariance[:3, 3:].any() and not none[:3, 3:].any()


@pytest.mark.parametrize('alpha', RATES)
def test_the_drive_of_the_mean_acceleration_is_that_of_the_model(alpha):
    """At twice the limit the drive is that of the limit, so F and U come apart."""
    for turn in TURNS:
        step = turn / alpha
        once, _ = moved([0, 0, 1, 0, 0, -1], np.eye(6), step, alpha)
        twice, _ = moved([0, 0, 2, 0, 0, -2], np.eye(6), step, alpha)
        expected = drive(alpha, step)
        close((2 * once - twice)[:3], expected)
        close((2 * once - twice)[3:], -expected)
        close((twice - once)[:3], transition(alpha, step)[:, 2])


@pytest.mark.parametrize('alpha', RATES)
@pytest.mark.parametrize(
    ('east', 'north', 'limit'), [(0.0, 0.3, 1.0), (-0.2, 0.25, 0.3), (5.0, -5.0, 2.0)]
)
def test_the_process_noise_is_that_of_the_model(alpha, east, north, limit):
    for turn in TURNS:
        step = turn / alpha
        _, covariance = moved([0, 0, east, 0, 0, north], np.zeros((6, 6)), step, alpha, limit)
        expected = noise(alpha, step)
        for axis, acceleration in ((slice(0, 3), east), (slice(3, 6), north)):
            size = 2 * alpha * variance(np.clip(acceleration, -limit, limit), limit)
            close(covariance[axis, axis], size * expected)


@pytest.mark.parametrize('alpha', RATES)
def test_steps_backwards_undo_the_transition_and_add_noise(alpha):
    for turn in TURNS[TURNS < 1]:
        step = turn / alpha
        _, covariance = moved(np.zeros(6), np.diag([0, 0, 1e40] * 2), -step, alpha)
        column = transition(alpha, -step)[:, 2]
        close(covariance[:3, :3] / 1e40, np.outer(column, column))
        _, covariance = moved(np.zeros(6), np.zeros((6, 6)), -step, alpha)
        close(covariance[:3, :3], 2 * alpha * variance(0, 1) * noise(alpha, step))


def test_far_and_near_steps_of_one_batch_do_not_mix():
    alpha, steps = 0.05, np.array([60.0, 0.0, 1e-3, 2.7, 60.0, -3.0])
    mean = np.array([[1.0, 2, 0.1, 4, 5, -0.1]] * 6)
    covariance = np.tile(np.eye(6), (6, 1, 1))
    batch = predict(mean, covariance, steps, Manoeuvre(0.3, alpha))
    for row, step in enumerate(steps):
        one = moved(mean[row], covariance[row], step, alpha, 0.3)
        np.testing.assert_allclose(batch[0][row], one[0], rtol=1e-12)
        np.testing.assert_allclose(batch[1][row], one[1], rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize('limit', [0.3, 1.0, 2.0])
def test_the_variance_follows_the_rayleigh_density_and_keeps_its_floor(limit):
    for a in np.r_[np.linspace(-3, 3, 61) * limit, 0.0, limit, -limit]:
        found = acceleration_variance(a, limit)
        assert found == pytest.approx(variance(np.clip(a, -limit, limit), limit))
        assert found >= 0.05 * (4 - np.pi) / np.pi * limit**2 * (1 - 1e-12)


def test_part_of_a_prediction_is_the_part_of_the_whole():
    rng = np.random.default_rng(2)
    root = rng.normal(size=(4, 6, 6))
    mean, covariance, step = rng.normal(size=(4, 6)), root @ root.swapaxes(1, 2), np.arange(4.0)
    rows = np.array([0, 3, 1, 4])
    whole = predict(mean, covariance, step, PRESETS['ship'])
    part = predict(mean, covariance, step, PRESETS['ship'], SHOWN)
    np.testing.assert_allclose(part[0], whole[0][:, rows], rtol=1e-12)
    np.testing.assert_allclose(part[1], whole[1][:, rows][:, :, rows], rtol=1e-12)


@pytest.mark.parametrize('manoeuvre', [Manoeuvre(0.3, 1 / 60), Manoeuvre(2.0, 1 / 5)])
def test_the_filter_is_the_exact_posterior_of_its_model(condition, gaussian_plots, manoeuvre):
    """Four tracks, each with its own times, gaps and plot noise, against the joint Gaussian.

    The model's mean acceleration and noise depend on the estimate before each plot; the oracle
    takes those from the filter and all else (F, U, Q, the conditioning) from elsewhere.
    """
    rng = np.random.default_rng(4)
    alpha, limit = manoeuvre.frequency, manoeuvre.max_acceleration
    filter_ = cs_kalman(manoeuvre, 25.0)
    tracks, scans = 4, 17
    observe = np.zeros((2, 6))
    observe[0, 0] = observe[1, 3] = 1.0
    truth = rng.uniform(-3000, 3000, (tracks, 2))
    velocity = rng.uniform(-10, 10, (tracks, 2))
    time = rng.uniform(0, 2.7, tracks)

    def plots_now():
        root = rng.normal(size=(len(rows), 2, 2)) * 20
        covariance = root @ root.swapaxes(1, 2) + 9 * np.eye(2)
        noise_now = np.linalg.cholesky(covariance) @ rng.normal(size=(len(rows), 2, 1))
        return gaussian_plots(truth[rows] + noise_now[..., 0], covariance, time[rows])

    rows = np.arange(tracks)
    plots = plots_now()
    state = filter_.init(plots)
    speed = 12.5**2
    priors = [
        (
            np.array([*plots.position[i][:1], 0, 0, *plots.position[i][1:], 0, 0]),
            plots.covariance[i],
        )
        for i in range(tracks)
    ]
    steps, seen = [[] for _ in rows], [[] for _ in rows]
    for k in range(1, scans):
        step = rng.uniform(0.1, 12.0, tracks)
        velocity += 0.6 * limit * step[:, None] * np.where(k % 6 < 3, 1, -1)
        truth, time = truth + velocity * step[:, None], time + step
        rows = rng.permutation(tracks)[: 1 + k % tracks]
        plots = plots_now()
        for i, row in enumerate(rows):
            gap = time[row] - state.time[row]
            f, u, q = transition(alpha, gap), drive(alpha, gap), noise(alpha, gap)
            parts = []
            for a in state.mean[row, [2, 5]]:
                mean = np.clip(a, -limit, limit)
                parts.append((f, u * mean, 2 * alpha * variance(mean, limit) * q))
            f, u, q = zip(*parts)
            steps[row].append((block_diag(*f), np.concatenate(u), block_diag(*q)))
            seen[row].append((plots.position[i], plots.covariance[i]))
        state = filter_.update(state, plots, rows)
    for row in range(tracks):
        mean, plot = priors[row]
        start = np.diag([0, speed, variance(0, limit)] * 2)
        start[np.ix_([0, 3], [0, 3])] = plot
        expected = condition(mean, start, steps[row], observe, seen[row])
        sigma = np.sqrt(np.diag(expected[1]))
        np.testing.assert_allclose((state.mean[row] - expected[0]) / sigma, 0, atol=1e-8)
        np.testing.assert_allclose(
            state.covariance[row] / np.outer(sigma, sigma),
            expected[1] / np.outer(sigma, sigma),
            atol=1e-8,
        )
        ahead = filter_.extrapolate(state, state.time)
        np.testing.assert_allclose(ahead.position[row], expected[0][[0, 3]], rtol=1e-8)
        np.testing.assert_allclose(ahead.velocity[row], expected[0][[1, 4]], rtol=1e-8, atol=1e-8)


def test_a_target_that_accelerates_twice_as_hard_as_assumed_is_not_lost(plots_at):
    """Without the floor of the variance the filter errs by over 400 m here."""
    rng = np.random.default_rng(6)
    filter_ = cs_kalman(Manoeuvre(0.2, 1 / 60), 25.0)
    runs, speed, rate, period = 50, 15.0, 0.4 / 15.0, 60 / 22
    state, worst = None, 0.0
    for k in range(150):
        course = rate * k * period  # circles, 0.4 m/s^2
        truth = 2000 + speed / rate * np.array([np.sin(course), 1 - np.cos(course)])
        plots = plots_at(np.tile(truth, (runs, 1)), k * period, rng=rng)
        state = (
            filter_.init(plots) if state is None else filter_.update(state, plots, np.arange(runs))
        )
        error = filter_.extrapolate(state, plots.time).position - truth
        if k > 20:
            worst = max(worst, float(np.sqrt(np.mean(error**2))))
    assert worst < 150.0
