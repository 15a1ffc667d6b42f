"""The hypotheses about a target's last change, against an exact mixture and straight-line fits."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from marine_tracker.gaussian import leg_hypotheses as legs
from marine_tracker.gaussian.leg_hypotheses import AT_FIRST, LEGS, STRAIGHT, Habits
from marine_tracker.gaussian.linear_modes import unpack

OBSERVE = np.eye(2, 4)
HABITS = Habits(hold=200.0, manoeuvre=30.0, noise=0.3)
R = np.array([[400.0, -80.0], [-80.0, 250.0]])
SPEED = 12.0
KNOWN = 1e9  # degrees of freedom: R is R


def unchanged(count):
    return np.tile(np.eye(2), (count, 1, 1))


def feed(plots, times, habits=HABITS):
    """One track; its hypotheses and what is shown after the last plot."""
    state = legs.begin(plots[:1], R[None], times[:1], SPEED)
    shown = None
    for z, before, now in zip(plots[1:], times, times[1:]):
        state, shown = legs.update(
            state,
            np.array([now]),
            np.array([now - before]),
            z[None],
            R[None],
            unchanged(1),
            np.array([KNOWN]),
            habits,
        )
    return state, shown


def test_after_two_steps_it_is_the_exact_mixture():
    """All ways of changing mode, one by one, by Bayes; nothing has been merged but equals."""
    times, plots = np.array([0.0, 4.0]), np.array([[1000.0, 500.0], [1035.0, 470.0]])
    state, shown = feed(plots, times)
    turn, settle = 1 - np.exp(-4.0 / HABITS.hold), 1 - np.exp(-4.0 / HABITS.manoeuvre)
    chance = {
        'straight on': AT_FIRST * (1 - turn),
        'turned': AT_FIRST * turn,
        'turning on': (1 - AT_FIRST) * (1 - settle),
        'settled': (1 - AT_FIRST) * settle,
    }
    prior = np.diag([0, 0, SPEED**2, SPEED**2])
    prior[:2, :2] = R
    F = np.eye(4)
    F[0, 2] = F[1, 3] = 4.0
    evidence, means, covariances = [], [], []
    for way, p in chance.items():
        q = HABITS.noise if way.startswith('turn') else STRAIGHT
        P = F @ prior @ F.T + q * np.kron([[4.0**3 / 3, 8.0], [8.0, 4.0]], np.eye(2))
        x, S = F @ np.r_[plots[0], 0, 0], P[:2, :2] + R
        evidence.append(p * multivariate_normal(x[:2], S).pdf(plots[1]))
        K = P[:, :2] @ np.linalg.inv(S)
        means.append(x + K @ (plots[1] - x[:2]))
        covariances.append(P - K @ OBSERVE @ P)
    weight = np.array(evidence) / sum(evidence)
    assert state.weight[0, 0] == pytest.approx(weight[1] + weight[2], rel=1e-6)
    likely = weight > legs.LEAST_SHOWN
    likely[[1, 2]] = weight[1] + weight[2] > legs.LEAST_SHOWN  # one hypothesis: a manoeuvre
    weight = weight * likely / (weight * likely).sum()
    mean = weight @ np.array(means)
    spread = sum(
        w * (P + np.outer(m - mean, m - mean)) for w, m, P in zip(weight, means, covariances)
    )
    found = unpack(shown)
    np.testing.assert_allclose(found[0][0], mean, rtol=1e-9)
    np.testing.assert_allclose(found[1][0], spread, rtol=1e-7)


def test_a_target_that_never_manoeuvres_gets_the_straight_line_fit():
    """With changes next to impossible, what is shown is generalised least squares."""
    rng = np.random.default_rng(2)
    times = np.cumsum(rng.uniform(0.5, 6.0, 40))
    plots = np.outer(times, [3.0, -5.0]) + [4000, 2000] + rng.multivariate_normal([0, 0], R, 40)
    _, shown = feed(plots, times, Habits(1e12, 30.0, 0.3))
    design = np.concatenate([np.hstack([np.eye(2), (t - times[-1]) * np.eye(2)]) for t in times])
    weigh = np.kron(np.eye(40), np.linalg.inv(R))
    information = design.T @ weigh @ design + np.diag([0, 0, SPEED**-2, SPEED**-2])
    fit = np.linalg.solve(information, design.T @ weigh @ plots.ravel())
    mean, covariance = unpack(shown)
    sigma = np.sqrt(np.diag(np.linalg.inv(information)))
    np.testing.assert_allclose((mean[0] - fit) / sigma, 0, atol=0.05)
    np.testing.assert_allclose(np.sqrt(np.diag(covariance[0])) / sigma, 1, atol=0.02)


def turning(rng, tracks, scans, ends, period=2.7):
    """Plots [tracks, scans, 2] of ships that turn by 60 deg at 1 deg/s until the scan `ends`."""
    course = np.radians(np.clip((np.arange(scans) - ends) * period + 60, 0, 60))
    velocity = 8 * np.stack([np.sin(course), np.cos(course)], -1)
    way = np.cumsum(velocity * period, 0)
    return way + rng.multivariate_normal([0, 0], R, (tracks, scans))


def run(plots, period=2.7, habits=HABITS, certainty=15.0):
    """Many tracks at once; the shown rows [scans - 1, N, 14] and the states."""
    tracks, scans = plots.shape[:2]
    noise, time = np.tile(R, (tracks, 1, 1)), np.zeros(tracks)
    state = legs.begin(plots[:, 0], noise, time, SPEED)
    rows, states = [], []
    for k in range(1, scans):
        state, shown = legs.update(
            state,
            time + k * period,
            time + period,
            plots[:, k],
            noise,
            unchanged(tracks),
            np.full(tracks, certainty),
            habits,
        )
        rows.append(shown)
        states.append(state)
    return np.array(rows), states


def test_a_turn_is_seen_and_its_end_is_dated():
    rng = np.random.default_rng(4)
    plots = turning(rng, 200, 130, ends=70)
    _, states = run(plots)
    before, during, after = states[40], states[65], states[-1]

    def likeliest(state):
        """Probability of legs older than 40 s; when the likeliest leg began."""
        leg = state.weight[:, 1:].argmax(1)
        now = 2.7 * (1 + next(k for k, s in enumerate(states) if s is state))
        old = (state.weight[:, 1:] * (now - state.begun > 40)).sum(1)
        return old, state.begun[np.arange(200), leg]

    assert (likeliest(before)[0] > 0.5).mean() > 0.95
    assert np.median(likeliest(before)[1]) < 10
    assert (likeliest(during)[0] < 0.5).mean() > 0.95
    assert (likeliest(after)[0] > 0.5).mean() > 0.95
    assert np.median(likeliest(after)[1]) == pytest.approx(70 * 2.7, abs=15)


def test_weights_are_probabilities_and_covariances_regular_whatever_the_plots():
    rng = np.random.default_rng(8)
    plots = rng.normal(0, 1, (50, 60, 2)) * np.exp(rng.uniform(0, 9, (50, 1, 1)))
    _, states = run(plots)
    for state in states[::7]:
        np.testing.assert_allclose(state.weight.sum(1), 1.0, atol=1e-9)
        assert (state.weight > 0).all()
        _, covariance = unpack(state.rows)
        assert np.linalg.eigvalsh(covariance).min() > 0


def test_a_plot_at_the_same_time_changes_no_mode():
    """Two plots of one moment are worth one of half the covariance."""
    first, second = np.array([[0.0, 0.0]]), np.array([[10.0, -6.0]])
    state = legs.begin(first, R[None], np.zeros(1), SPEED)
    state, shown = legs.update(
        state, np.zeros(1), np.zeros(1), second, R[None], unchanged(1), np.array([KNOWN]), HABITS
    )
    mean, covariance = unpack(shown)
    np.testing.assert_allclose(mean[0, :2], [5.0, -3.0], atol=1e-9)
    np.testing.assert_allclose(covariance[0, :2, :2], R / 2, atol=1e-9)
    assert state.weight[0, 0] == pytest.approx(1 - AT_FIRST)


def test_tracks_do_not_touch_each_other():
    rng = np.random.default_rng(6)
    plots = turning(rng, 12, 50, ends=30)
    together, _ = run(plots)
    for i in (0, 7):
        alone, _ = run(plots[i : i + 1])
        np.testing.assert_allclose(alone[:, 0], together[:, i], rtol=1e-9, atol=1e-9)


def test_errors_that_were_misjudged_scale_the_fits_covariance():
    """All plots twice as bad as thought: so is the velocity, and the mean stays."""
    rng = np.random.default_rng(5)
    state, _ = feed(np.cumsum(rng.normal(0, 5, (20, 2)), 0), np.arange(20) * 3.0)
    columns = state.rows.transpose(2, 1, 0).copy()
    legs._stretch(columns, 2 * unchanged(1))
    mean, covariance = unpack(columns.transpose(2, 1, 0))
    was, spread = unpack(state.rows)
    np.testing.assert_allclose(mean, was)
    np.testing.assert_allclose(covariance, 4 * spread)
    assert state.rows.shape == (1, 1 + LEGS, 14)
    skew = np.array([[[1.5, 0.0], [0.4, 0.7]]])
    columns = state.rows.transpose(2, 1, 0).copy()
    legs._stretch(columns, skew)
    whole = np.kron(np.eye(2), skew[0])
    np.testing.assert_allclose(
        unpack(columns.transpose(2, 1, 0))[1][0], whole @ spread[0] @ whole.T, rtol=1e-9
    )
