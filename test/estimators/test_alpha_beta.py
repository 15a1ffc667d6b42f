"""alpha_beta beside the contract: its shares, its Doppler, its covariance."""

import numpy as np
import pytest

from marine_tracker.estimators import ESTIMATORS, alpha_beta, alpha_beta_gains
from marine_tracker.estimators.alpha_beta_gains import GAINS, Misfit
from marine_tracker.geometry import to_range_bearing, unit_vector
from marine_tracker.parameters import TrackerParameters
from marine_tracker.types import take

PERIOD, SPEED_SIGMA = 2.5, 0.5
MODES = tuple(GAINS)
PAPER = ('hf', 'method1', 'method2')  # these keep radial speed and bearing rate


def make(mode, max_speed=30.0):
    return alpha_beta.alpha_beta(mode, max_speed, SPEED_SIGMA, alpha_beta.NOISE['ship'])


def track(estimator, plots):
    every = np.arange(len(plots[0].time))
    state = estimator.init(plots[0])
    for of_scan in plots[1:]:
        state = estimator.update(state, of_scan, every)
    return state


def with_doppler(plots, velocity, rng=None):
    bearing = to_range_bearing(plots.position - plots.origin)[1]
    speed = (velocity * unit_vector(bearing)).sum(-1)
    if rng is not None:
        speed = speed + rng.normal(0, SPEED_SIGMA, len(speed))
    return plots._replace(radial_speed=np.broadcast_to(speed, plots.time.shape).copy())


def misfit(speed=0.0, bearing=0.0, plots=5.0, mean_square=(0.0, 0.0)):
    one = np.ones(1)
    return Misfit(
        0 * one,
        speed * one,
        bearing * one,
        15 * one,
        0.5 * one,
        0.01 * one,
        plots * one,
        np.array([mean_square]),
    )


def test_parameters_choose_the_mode():
    assert {field for field in MODES} == set(
        TrackerParameters.__dataclass_fields__['alpha_beta_mode'].metadata['choices']
    )
    for mode in MODES:
        assert ESTIMATORS['alpha_beta'](TrackerParameters(alpha_beta_mode=mode))


def test_benedict_and_bordners_relation_holds_both_ways():
    alpha = np.linspace(0, 1, 11)
    np.testing.assert_allclose(
        alpha_beta_gains.position_gain(alpha_beta_gains.rate_gain(alpha)), alpha, atol=1e-12
    )


@pytest.mark.parametrize('mode', ['hf', 'hf_soft'])
def test_shares_grow_from_nothing_to_all_as_a_plot_differs(mode):
    sizes = [0.0, 0.2, 1.0, 5.0, 1e6]
    shares = np.array([np.concatenate(GAINS[mode](misfit(0.5 * s, 0.01 * s))) for s in sizes])
    assert (np.diff(shares, axis=0) > 0).all()
    np.testing.assert_allclose(shares[0], 0.0)
    np.testing.assert_allclose(shares[-1], 1.0, atol=1e-4)


def test_shares_at_known_misfits():
    """By hand: one sigma of speed, and the gate's six of bearing."""
    _, beta_v, alpha_a, _ = GAINS['hf'](misfit(0.5, 0.06))
    assert beta_v == pytest.approx(0.63212, abs=1e-5) and alpha_a == pytest.approx(0.63212, 1e-4)
    _, beta_v, alpha_a, _ = GAINS['hf_soft'](misfit(2.0, 0.06))
    assert beta_v == pytest.approx(0.5) and alpha_a == pytest.approx(0.5)
    alpha_r, beta_v, _, _ = GAINS['method1'](misfit(mean_square=(225.0, 1e-4)))
    assert alpha_r == pytest.approx(0.5) and beta_v == pytest.approx(1 / 6)
    alpha_r, beta_v, _, _ = GAINS['method2'](misfit(plots=3.0))
    assert alpha_r == pytest.approx(5 / 6) and beta_v == pytest.approx(0.5)


def test_method2_is_a_straight_line_through_all_plots(plots_at):
    """Along one line of sight its range is the end of the least-squares line: polyfit's."""
    rng = np.random.default_rng(3)
    distance = 4000 + 6.0 * PERIOD * np.arange(25) + rng.normal(0, 15, 25)
    state = track(
        make('method2'), [plots_at([[0.0, r]], k * PERIOD) for k, r in enumerate(distance)]
    )
    slope, start = np.polyfit(PERIOD * np.arange(25), distance, 1)
    assert state.mean[0, 1] == pytest.approx(start + slope * 24 * PERIOD, abs=1e-6)
    assert state.mean[0, 3] == pytest.approx(slope, abs=1e-8)


@pytest.mark.parametrize('mode', MODES)
def test_two_plots_make_the_first_rates(plots_at, mode):
    plots = [plots_at([[30.0, 4000.0]], 0.0), plots_at([[60.0, 4020.0]], PERIOD)]
    state = track(make(mode), plots)
    np.testing.assert_allclose(state.mean[0], [60.0, 4020.0, 12.0, 8.0], atol=0.2)


@pytest.mark.parametrize('mode', MODES)
def test_doppler_tells_the_speed_along_the_line_of_sight_at_once(plots_at, mode):
    velocity = np.array([4.0, -7.0])
    plots = with_doppler(plots_at([[3000.0, 4000.0]], 0.0), velocity)
    state = make(mode).init(plots)
    along = np.array([0.6, 0.8])
    assert state.mean[0, 2:] @ along == pytest.approx(velocity @ along, abs=0.01)
    assert np.sqrt(along @ state.covariance[0, 2:, 2:] @ along) == pytest.approx(
        SPEED_SIGMA, rel=1e-2
    )
    assert np.sqrt(state.covariance[0, 2, 2]) > 5  # across it nothing is known


@pytest.mark.parametrize('mode', MODES)
def test_a_plot_without_radial_speed_among_others_is_taken_as_of_a_radar_without(plots_at, mode):
    rng = np.random.default_rng(5)
    place, velocity = np.array([[2000.0, 3000.0], [-1000.0, 2500.0]]), np.array([5.0, 2.0])
    plain = [plots_at(place + velocity * k * PERIOD, k * PERIOD, rng=rng) for k in range(8)]
    told = [with_doppler(p, velocity) for p in plain]
    for p in told:
        p.radial_speed[1] = np.nan
    mixed, none = track(make(mode), told), track(make(mode), plain)
    np.testing.assert_allclose(mixed.mean[1], none.mean[1], rtol=1e-9)
    np.testing.assert_allclose(mixed.covariance[1], none.covariance[1], rtol=1e-6, atol=1e-9)
    assert np.abs(mixed.mean[0] - none.mean[0]).max() > 0.01


def long_track(plots_at, mode, doppler, runs=200, scans=60, own=lambda t: np.zeros(2)):
    """Errors [runs, 4] and the state after 60 plots of a target that passes 4 km off."""
    rng = np.random.default_rng(11)
    start, velocity = np.array([-3000.0, 4000.0]), np.array([7.0, 2.0])
    plots = []
    for k in range(scans):
        time = k * PERIOD
        p = plots_at(np.tile(start + velocity * time, (runs, 1)), time, own(time), rng=rng)
        # The radial speed is that along the true line of sight.
        true = unit_vector(to_range_bearing(start + velocity * time - own(time))[1]) @ velocity
        plots.append(
            p._replace(radial_speed=true + rng.normal(0, SPEED_SIGMA, runs)) if doppler else p
        )
    state = track(make(mode), plots)
    truth = np.concatenate([start + velocity * time, velocity])
    return state.mean - truth, state


@pytest.mark.parametrize('mode', ['hf_soft', 'hf'])
def test_doppler_makes_the_speed_better(plots_at, mode):
    """200 runs; RMS velocity error falls by a third at least."""
    with_, without = (
        np.sqrt(np.mean(long_track(plots_at, mode, told)[0][:, 2:] ** 2)) for told in (True, False)
    )
    assert with_ < 0.67 * without


@pytest.mark.parametrize('mode', ['hf_soft', 'hf', 'method1'])
@pytest.mark.parametrize('doppler', [True, False])
def test_the_covariance_is_that_of_the_errors(plots_at, mode, doppler):
    """Though the shares are not Kalman's. NEES of 200 runs: its mean would be 2 for a Gaussian;
    shares that depend on the plots make heavy tails, so half to twice is allowed."""
    error, state = long_track(plots_at, mode, doppler)
    for part in (slice(0, 2), slice(2, 4)):
        off = error[:, part]
        nees = (off * np.linalg.solve(state.covariance[:, part, part], off[..., None])[..., 0]).sum(
            1
        )
        assert 0.4 < nees.mean() < 4.0


@pytest.mark.parametrize('mode', MODES)
def test_own_ship_may_move(plots_at, mode):
    """The same errors from a ship at rest and one that steams by at 10 m/s, within their chance:
    RMS of 200 runs differ by less than a third."""
    rest, _ = long_track(plots_at, mode, True, scans=30)
    moving, _ = long_track(
        plots_at, mode, True, scans=30, own=lambda t: np.array([10.0 * t, -3.0 * t]) - [500.0, 0.0]
    )
    one, two = (np.sqrt(np.mean(e[:, :2] ** 2)) for e in (rest, moving))
    assert two < 1.33 * one


@pytest.mark.parametrize('mode', MODES)
def test_nothing_moves_across_faster_than_the_fastest_target(plots_at, mode):
    """Two plots a minute apart at 110 km, 2 deg of noise: 64 m/s, they say."""
    place = 110e3 * unit_vector(np.radians([[0.0], [2.0]]))
    plots = [plots_at(place[k], 60.0 * k, range_sigma=800.0, bearing_sigma=0.017) for k in range(2)]
    state = track(make(mode, max_speed=12.0), plots)
    assert np.hypot(*state.mean[0, 2:]) == pytest.approx(12.0, abs=0.5)


def test_only_the_soft_mode_keeps_the_ground_velocity_between_plots(plots_at):
    position, velocity = np.array([[0.0, 1500.0]]), np.array([10.0, 0.0])
    for mode in MODES:
        estimator = make(mode)
        plots = [
            plots_at(position + velocity * t, t, range_sigma=2.0, bearing_sigma=0.001)
            for t in (0.0, PERIOD)
        ]
        state = track(estimator, plots)
        later = estimator.extrapolate(state, np.array([60.0]))
        miss = np.hypot(*(later.position[0] - position[0] - 60 * velocity))
        assert (miss > 50) == (mode in PAPER), mode


def test_a_vague_plot_does_not_count(plots_at):
    position = np.array([[0.0, 1500.0]])
    state = track(make('method2'), [plots_at(position, k * PERIOD) for k in range(4)])
    vague = plots_at(position + 900.0, 4 * PERIOD)._replace(covariance=1e12 * np.eye(2)[None])
    after = make('method2').update(state, vague, np.array([0]))
    assert after.plots[0] == 4 and after.since[0] == 3 * PERIOD and after.time[0] == 4 * PERIOD
    assert take(after, slice(0, 1)).misfit.tolist() == state.misfit.tolist()


def test_plots_of_a_second_radar_do_not_spoil_the_velocity(plots_at):
    """Half a second after those of the first, of a target on a straight course; RMS of 400 tracks.

    A rate from so short a step has five times the deviation of one from a whole period.
    """
    place, velocity = np.array([2000.0, 3000.0]), np.array([5.0, 2.0])

    def error(radars, seconds):
        rng = np.random.default_rng(8)
        plots = [
            plots_at(np.tile(place + velocity * t, (400, 1)), t, rng=rng)
            for k in range(30)
            for t in k * PERIOD + np.array(seconds)
        ]
        state = track(
            ESTIMATORS['alpha_beta'](TrackerParameters(scan_period_s=PERIOD, radars=radars)), plots
        )
        return np.sqrt(np.mean((state.mean[:, 2:] - velocity) ** 2))

    of_one = error('', [0.0])
    assert error('[{topic: a}, {topic: b}]', [0.0, 0.5]) < of_one
    assert error('', [0.0, 0.5]) > 2 * of_one
