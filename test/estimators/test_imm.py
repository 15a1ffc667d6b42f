"""The IMM against a plain one per track, exact posteriors and its models against quadrature."""

from functools import lru_cache

import numpy as np
import pytest
from scipy.linalg import expm, logm
from scipy.stats import multivariate_normal

from marine_tracker.estimators.imm import PRESETS, Modes, imm
from marine_tracker.gaussian.linear_modes import bank, move_means, transition_power

MAX_SPEED = 24.0
OBSERVE = np.eye(2, 4)
BANKS = {
    'two CV': Modes((0.001, 0.5), (0.0, 0.0), (0.98, 0.9), 2.7),
    'CV and two turns': Modes((0.01, 0.2, 0.1), (0.0, 0.04, -0.06), (0.95, 0.9, 0.8), 3.0),
    **PRESETS,
}


def turn_flow(rate):
    """d/dt of [e n ve vn] on a coordinated turn, clockwise: the course grows at the rate."""
    flow = np.zeros((4, 4))
    flow[0, 2] = flow[1, 3] = 1.0
    flow[2, 3], flow[3, 2] = rate, -rate
    return flow


def white_acceleration(density, step):
    """Covariance from white acceleration on a straight line, by Gauss-Legendre quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    out = np.zeros((4, 4))
    for s, w in zip(0.5 * step * (nodes + 1), 0.5 * step * weights):
        kick = np.vstack([s * np.eye(2), np.eye(2)])
        out += w * density * kick @ kick.T
    return out


def chain(modes, step):
    """Mode transitions over a step: the matrix logarithm gives the rates in continuous time."""
    count = len(modes.stay)
    matrix = np.array(
        [
            [modes.stay[i] if i == j else (1 - modes.stay[i]) / (count - 1) for j in range(count)]
            for i in range(count)
        ]
    )
    return expm(rates(matrix.tobytes(), count) * step / modes.period)


@lru_cache
def rates(matrix, count):
    return logm(np.frombuffer(matrix).reshape(count, count)).real


class PlainImm:
    """One track, the book's algorithm (Bar-Shalom, Li, Kirubarajan 2001, 11.6.6) in loops."""

    def __init__(self, modes, z, R, time):
        self.modes, self.time, self.J = modes, time, len(modes.noise)
        self.x = [np.r_[z, 0, 0] for _ in range(self.J)]
        P = np.diag([0, 0, MAX_SPEED**2 / 4, MAX_SPEED**2 / 4])
        P[:2, :2] = R
        self.P = [P.copy() for _ in range(self.J)]
        self.mu = chain(modes, 1e6)[0]

    def predict(self, time):
        step, J = time - self.time, self.J
        p = chain(self.modes, step)
        c = [sum(p[i, j] * self.mu[i] for i in range(J)) for j in range(J)]
        xs, Ps = [], []
        for j in range(J):
            share = [p[i, j] * self.mu[i] / c[j] for i in range(J)]
            x = sum(share[i] * self.x[i] for i in range(J))
            P = sum(
                share[i] * (self.P[i] + np.outer(self.x[i] - x, self.x[i] - x)) for i in range(J)
            )
            F = expm(turn_flow(self.modes.turn_rate[j]) * step)
            xs.append(F @ x)
            Ps.append(F @ P @ F.T + white_acceleration(self.modes.noise[j], step))
        return np.array(c), xs, Ps

    def update(self, z, R, time):
        c, xs, Ps = self.predict(time)
        likelihood = np.zeros(self.J)
        for j in range(self.J):
            S = OBSERVE @ Ps[j] @ OBSERVE.T + R
            likelihood[j] = multivariate_normal(OBSERVE @ xs[j], S).pdf(z)
            K = Ps[j] @ OBSERVE.T @ np.linalg.inv(S)
            rest = np.eye(4) - K @ OBSERVE
            self.x[j] = xs[j] + K @ (z - OBSERVE @ xs[j])
            self.P[j] = rest @ Ps[j] @ rest.T + K @ R @ K.T  # Joseph
        self.mu = c * likelihood / (c @ likelihood)
        self.time = time

    def combined(self, time):
        c, xs, Ps = self.predict(time)
        x = sum(w * m for w, m in zip(c, xs))
        return x, sum(w * (P + np.outer(m - x, m - x)) for w, m, P in zip(c, xs, Ps))


def moves(extrapolation, row):
    return np.r_[extrapolation.position[row], extrapolation.velocity[row]]


def agree(found_mean, found_covariance, mean, covariance, bound=1e-8):
    """In units of the expected deviations."""
    sigma = np.sqrt(np.diag(covariance))
    np.testing.assert_allclose((found_mean - mean) / sigma, 0, atol=bound)
    scale = np.outer(sigma, sigma)
    np.testing.assert_allclose(found_covariance / scale, covariance / scale, atol=bound)


@pytest.mark.parametrize('modes', BANKS.values(), ids=BANKS)
def test_the_bank_is_the_plain_imm_track_by_track(gaussian_plots, modes):
    """Three tracks with turns, own times and gaps; weights, means and covariances agree."""
    rng = np.random.default_rng(9)
    filter_ = imm(modes, MAX_SPEED)
    tracks = 3
    truth, time = rng.uniform(-3000, 3000, (tracks, 2)), rng.uniform(0, 3, tracks)
    velocity, rate = rng.uniform(-10, 10, (tracks, 2)), np.array([0.0, 0.03, -0.05])
    R = np.array([[200.0, 80.0], [80.0, 150.0]])

    def plots_now(rows):
        noisy = truth[rows] + rng.multivariate_normal([0, 0], R, len(rows))
        return gaussian_plots(noisy, np.tile(R, (len(rows), 1, 1)), time[rows])

    plots = plots_now(np.arange(tracks))
    state = filter_.init(plots)
    plain = [PlainImm(modes, plots.position[i], R, time[i]) for i in range(tracks)]
    for k in range(1, 16):
        step = rng.uniform(0.5, 5.0, tracks)
        for i in range(tracks):
            flow = expm(turn_flow(rate[i] if 5 < k < 12 else 0.0) * step[i])
            truth[i], velocity[i] = np.split(flow @ np.r_[truth[i], velocity[i]], 2)
        time = time + step
        rows = rng.permutation(tracks)[: 1 + k % tracks]
        plots = plots_now(rows)
        state = filter_.update(state, plots, rows)
        for i, row in enumerate(rows):
            plain[row].update(plots.position[i], R, time[row])
    later = time + np.array([0.0, 2.0, 30.0])
    ahead = filter_.extrapolate(state, later)
    for i, one in enumerate(plain):
        np.testing.assert_allclose(state.weight[i], one.mu, atol=1e-8)
        for j in range(one.J):
            agree(state.mean[i, j], state.covariance[i, j], one.x[j], one.P[j])
        agree(moves(ahead, i), ahead.covariance[i], *one.combined(later[i]))


@pytest.mark.parametrize(('noise', 'turn_rate'), [(0.05, 0.0), (0.3, 0.02), (0.01, -0.15)])
def test_one_mode_is_the_exact_posterior_of_its_model(condition, gaussian_plots, noise, turn_rate):
    rng = np.random.default_rng(14)
    filter_ = imm(Modes((noise,), (turn_rate,), (1.0,), 2.7), MAX_SPEED)
    count = 25
    R = np.array([[300.0, -90.0], [-90.0, 120.0]])
    time = np.cumsum(rng.uniform(0.2, 8.0, count))
    z = np.cumsum(rng.normal(0, 20, (count, 2)), 0) + [2000.0, -1000.0]
    state, steps = None, []
    for k in range(count):
        plots = gaussian_plots(z[k : k + 1], R[None], time[k : k + 1])
        state = filter_.init(plots) if k == 0 else filter_.update(state, plots, np.array([0]))
        if k:
            gap = time[k] - time[k - 1]
            steps.append(
                (expm(turn_flow(turn_rate) * gap), np.zeros(4), white_acceleration(noise, gap))
            )
    start = np.diag([0, 0, MAX_SPEED**2 / 4, MAX_SPEED**2 / 4])
    start[:2, :2] = R
    expected = condition(np.r_[z[0], 0, 0], start, steps, OBSERVE, [(p, R) for p in z[1:]])
    agree(state.mean[0, 0], state.covariance[0, 0], *expected)
    now = filter_.extrapolate(state, time[-1:])
    agree(moves(now, 0), now.covariance[0], *expected)


@pytest.mark.parametrize('modes', BANKS.values(), ids=BANKS)
def test_after_two_plots_the_bank_is_the_exact_mixture(gaussian_plots, modes):
    """With one prior for all modes nothing has been merged yet: Bayes over the joint Gaussians."""
    filter_ = imm(modes, MAX_SPEED)
    R, z = np.diag([225.0, 900.0]), np.array([[1000.0, 500.0], [1040.0, 470.0]])
    gap = 4.0
    first, second = (gaussian_plots(z[k : k + 1], R[None], np.array([k * gap])) for k in (0, 1))
    state = filter_.update(filter_.init(first), second, np.array([0]))
    now = filter_.extrapolate(state, second.time)
    prior = np.diag([225.0, 900.0, MAX_SPEED**2 / 4, MAX_SPEED**2 / 4])
    ahead = np.linalg.matrix_power(chain(modes, modes.period), 4096)[0] @ chain(modes, gap)
    evidence, means, covariances = [], [], []
    for q, w in zip(modes.noise, modes.turn_rate):
        F, Q = expm(turn_flow(w) * gap), white_acceleration(q, gap)
        joint = np.block(
            [
                [F @ prior @ F.T + Q, (F @ prior @ F.T + Q) @ OBSERVE.T],
                [OBSERVE @ (F @ prior @ F.T + Q), OBSERVE @ (F @ prior @ F.T + Q) @ OBSERVE.T + R],
            ]
        )
        x = F @ np.r_[z[0], 0, 0]
        evidence.append(multivariate_normal(x[:2], joint[4:, 4:]).pdf(z[1]))
        gain = joint[:4, 4:] @ np.linalg.inv(joint[4:, 4:])
        means.append(x + gain @ (z[1] - x[:2]))
        covariances.append(joint[:4, :4] - gain @ joint[4:, :4])
    weight = ahead * evidence / (ahead @ evidence)
    mean = weight @ np.array(means)
    spread = sum(
        w * (P + np.outer(m - mean, m - mean)) for w, m, P in zip(weight, means, covariances)
    )
    agree(moves(now, 0), now.covariance[0], mean, spread)


@pytest.mark.parametrize('modes', BANKS.values(), ids=BANKS)
def test_modes_change_in_time_and_not_by_plot(modes):
    over = transition_power(modes.stay, modes.period)
    at = np.array([0.0, 1e-6, 1.0, modes.period, 2 * modes.period, 60.0])
    found = over(at)
    np.testing.assert_allclose(found.sum(2), 1.0, atol=1e-12)
    assert (found >= 0).all() and (found <= 1).all()
    np.testing.assert_allclose(found[0], np.eye(len(modes.stay)), atol=1e-12)
    np.testing.assert_allclose(np.diagonal(found[3]), modes.stay, atol=1e-12)
    np.testing.assert_allclose(found[4], found[3] @ found[3], atol=1e-12)
    for step, matrix in zip(at, found):
        np.testing.assert_allclose(matrix, chain(modes, step), atol=1e-9)


def test_modes_left_alike_make_no_chain_singular():
    """Their eigenvalues coincide; a general solver may then give vectors that do not span."""
    rng = np.random.default_rng(1)
    for quiet, others in 1 - np.exp(rng.uniform(np.log(1e-4), np.log(0.45), (60, 2))):
        modes = Modes((1,) * 4, (0,) * 4, (quiet, others, others, others), 2.7)
        found = transition_power(modes.stay, modes.period)(np.array([2.7, 5.4]))
        np.testing.assert_allclose(found[0], chain(modes, 2.7), atol=1e-9)
        np.testing.assert_allclose(found[1], chain(modes, 5.4), atol=1e-9)


def test_modes_never_left_are_kept():
    for stay in ((1.0,), (1.0, 1.0), (1.0, 1.0, 0.9)):
        found = transition_power(stay, 2.7)(np.array([0.0, 2.7, 3600.0]))
        np.testing.assert_allclose(found.sum(2), 1.0, atol=1e-8)
        np.testing.assert_allclose(found[:, 0, 0], 1.0, atol=1e-8)


def test_a_chain_that_does_not_exist_in_continuous_time_is_refused():
    with pytest.raises(ValueError, match=r'0\.3.*too small'):
        transition_power((0.3, 0.3), 2.7)


def turn_matrices(rate, step):
    """[N, J, 4, 4]: what the modes make of each unit state."""
    turns = bank(np.zeros(len(rate)), rate, ())
    units = np.tile(np.eye(4)[:, :, None, None], (1, 1, len(rate), len(step)))
    return np.stack([move_means(turns, unit, step) for unit in units.swapaxes(0, 1)], -1).transpose(
        2, 1, 0, 3
    )


def test_turns_are_arcs_clockwise_for_a_positive_rate():
    rate = np.array([0.0, 0.02, -0.02, 0.5, 1e-9])
    step = np.array([0.0, 1e-6, 2.7, 60.0, -3.0])
    found = turn_matrices(rate, step)
    for i, t in enumerate(step):
        for j, w in enumerate(rate):
            np.testing.assert_allclose(found[i, j], expm(turn_flow(w) * t), atol=1e-7)
    # North-bound, a quarter turn to starboard: bound east, as far north as east.
    quarter = turn_matrices(np.array([0.1]), np.array([np.pi / 0.2]))[0, 0] @ [0, 0, 0, 10.0]
    assert quarter == pytest.approx([100.0, 100.0, 10.0, 0.0])


@pytest.mark.parametrize('modes', PRESETS.values(), ids=PRESETS)
def test_weights_stay_probabilities_however_wild_the_plots(gaussian_plots, modes):
    filter_ = imm(modes, MAX_SPEED)
    R = np.diag([1.0, 1.0])[None]
    state = filter_.init(gaussian_plots([[0.0, 0.0]], R, [0.0]))
    for k, off in enumerate([10.0, 1e6, -1e6, 0.0, 1e5], 1):
        state = filter_.update(state, gaussian_plots([[off, -off]], R, [2.7 * k]), np.array([0]))
        assert state.weight.sum() == pytest.approx(1.0)
        assert (state.weight > 0).all()
        assert np.isfinite(state.mean).all()
