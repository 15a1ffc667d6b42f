import numpy as np
import pytest
from scipy.stats import chi2

from marine_tracker.geometry import locate, own_ship_at, to_range_bearing, unit_vector, wrap_bearing
from marine_tracker.tracking.expected import Expected
from marine_tracker.tracking.gate import Pairs, gate, gate_size, split, window_pairs
from marine_tracker.tracking.noise import Noise
from marine_tracker.tracking.sweep import Sweep
from marine_tracker.types import OwnShip, PolarPlots

PERIOD = 60 / 22


@pytest.mark.parametrize('probability', [0.5, 0.9, 0.999, 0.999999])
def test_the_gate_holds_as_many_plots_as_promised(probability):
    assert gate_size(probability) == pytest.approx(chi2.ppf(probability, 2), rel=1e-6)


def scene(
    rng,
    tracks,
    plots,
    *,
    reach=6000.0,
    sigma=60.0,
    bearing_sigma=0.0087,
    speed=15.0,
    own_speed=0.0,
    period=PERIOD,
    bearing0=None,
    close=0.7,
):
    """Random tracks, and plots of which a share `close` lies near one of them."""
    bearing0 = rng.uniform(0, 2 * np.pi) if bearing0 is None else bearing0
    sweep = Sweep(0.0, period, bearing0)
    own = OwnShip(
        np.array([0.0]), rng.normal(0, 100, (1, 2)), own_speed * unit_vector(rng.uniform(0, 7, 1))
    )
    position = own.position + rng.uniform(-1, 1, (tracks, 2)) * reach
    velocity = speed * rng.normal(size=(tracks, 2))
    root = rng.normal(size=(tracks, 2, 2)) * sigma * rng.uniform(0.02, 1, (tracks, 1, 1))
    covariance = root @ root.swapaxes(1, 2) + np.eye(2)
    time = np.zeros(tracks)
    for _ in range(20):
        where = position + time[:, None] * velocity - own_ship_at(own, time)[0]
        time = sweep.time_at(to_range_bearing(where)[1])
    position = position + time[:, None] * velocity
    if tracks:
        near = position[rng.integers(0, tracks, plots)] + sigma * (
            rng.uniform(0.1, 2.5, (plots, 1)) * rng.normal(size=(plots, 2))
        )
    else:
        near = np.zeros((plots, 2))
    far = own.position + rng.uniform(-1, 1, (plots, 2)) * reach
    put = np.where(rng.random((plots, 1)) < close, near, far)
    plot_time = np.zeros(plots)
    for _ in range(20):
        distance, bearing = to_range_bearing(put - own_ship_at(own, plot_time)[0])
        plot_time = sweep.time_at(bearing)
    polar = PolarPlots(plot_time, distance, wrap_bearing(bearing), np.zeros(plots))
    located = locate(polar, own, 15.0, bearing_sigma)
    expected = Expected(time, position, velocity, covariance, own_ship_at(own, time)[0])
    return expected, located, sweep


def noise(range_sigma=15.0, bearing_sigma=0.0087, widest=0.0):
    return Noise(range_sigma, bearing_sigma, 0.0, widest)


def brute_force(expected, plots, size):
    """Every track with every plot at the plot's own time, one matrix after the other."""
    time, position, velocity, covariance, _ = expected
    found = {}
    for i in range(len(time)):
        for j in range(len(plots.time)):
            at = position[i] + (plots.time[j] - time[i]) * velocity[i]
            spread = covariance[i] + plots.covariance[j]
            apart = plots.position[j] - at
            distance = apart @ np.linalg.solve(spread, apart)
            if distance < size:
                found[i, j] = distance, np.linalg.slogdet(spread)[1]
    return found


SCENES = {
    'open sea': {},
    'fast targets': {'speed': 40.0},
    'own ship under way': {'own_speed': 15.0},
    'one time for all plots': {'period': 0.0},
    'around the antenna': {'reach': 150.0, 'sigma': 30.0},
    'on the antenna': {'reach': 2.0, 'sigma': 20.0},
    'beam starts at north': {'bearing0': 0.0},
    'coarse bearings': {'bearing_sigma': np.radians(3.0)},
    'long range': {'reach': 30000.0, 'sigma': 200.0},
    'little known': {'sigma': 2000.0},
    'hopeless': {'sigma': 20000.0},
    'coarse bearings around the antenna': {
        'reach': 300.0,
        'sigma': 100.0,
        'bearing_sigma': np.radians(5.0),
    },
    'sharp': {'sigma': 1.0},
    'slow antenna': {'period': 30.0, 'speed': 5.0},
}


@pytest.mark.parametrize('about', SCENES.values(), ids=SCENES)
@pytest.mark.parametrize('seed', range(4))
def test_the_gate_is_that_of_all_pairs(about, seed):
    rng = np.random.default_rng(100 + seed)
    size = gate_size((0.5, 0.9, 0.99, 0.999)[seed])
    targets, plots, sweep = scene(rng, 25, 60, **about)
    expected = brute_force(targets, plots, size)
    sigmas = noise(bearing_sigma=about.get('bearing_sigma', 0.0087))
    (track, plot, nis, log_det), _ = gate(targets, plots, sweep, sigmas, size)
    assert (np.diff(track) >= 0).all()
    found = list(zip(track.tolist(), plot.tolist()))
    assert len(set(found)) == len(found), 'a pair came twice'
    assert set(found) == set(expected)
    assert len(found) > 5, 'the scene says nothing'
    values = np.array([expected[pair] for pair in found])
    np.testing.assert_allclose(nis, values[:, 0], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(log_det, values[:, 1], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize('north', [0.0, 1e-12, -1e-12, 2 * np.pi - 1e-9])
def test_the_gate_does_not_tear_at_north(north):
    bearing = north + np.linspace(-0.02, 0.02, 9)
    position = 3000.0 * unit_vector(bearing)
    own = OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))
    plots = locate(
        PolarPlots(np.zeros(9), np.full(9, 3000.0), wrap_bearing(bearing), np.zeros(9)),
        own,
        15.0,
        0.0087,
    )
    covariance = np.tile(2500.0 * np.eye(2), (9, 1, 1))
    targets = Expected(np.zeros(9), position, np.zeros((9, 2)), covariance, np.zeros((9, 2)))
    size = gate_size(0.99)
    (track, plot, _, _), _ = gate(targets, plots, Sweep(0.0, 0.0, 0.0), noise(), size)
    assert set(zip(track.tolist(), plot.tolist())) == set(brute_force(targets, plots, size))
    assert len(track) > 30


@pytest.mark.parametrize(('tracks', 'plots'), [(0, 0), (0, 5), (5, 0)])
def test_nothing_meets_nothing(tracks, plots):
    found, left_out = gate(
        *scene(np.random.default_rng(1), tracks, plots), noise(), gate_size(0.99)
    )
    assert left_out == 0
    assert [len(column) for column in found] == [0, 0, 0, 0]
    assert found[0].dtype.kind == found[1].dtype.kind == 'i'


def test_the_gate_holds_the_targets_plot_as_often_as_promised():
    """20,000 tracks with Gaussian errors: 99 % within 4 sqrt(.01 * .99 / 20,000) = 0.3 %."""
    rng = np.random.default_rng(7)
    count, hits = 500, 0
    own = OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))
    root = np.array([[40.0, 10.0], [0.0, 25.0]])
    for _ in range(40):
        bearing = rng.uniform(0, 2 * np.pi, count)
        truth = rng.uniform(1000, 9000, count)[:, None] * unit_vector(bearing)
        distance, bearing = to_range_bearing(truth)
        polar = PolarPlots(
            np.zeros(count),
            distance + rng.normal(0, 15, count),
            wrap_bearing(bearing + rng.normal(0, 0.0087, count)),
            np.zeros(count),
        )
        targets = Expected(
            np.zeros(count),
            truth + rng.normal(size=(count, 2)) @ root.T,
            np.zeros((count, 2)),
            np.tile(root @ root.T, (count, 1, 1)),
            np.zeros((count, 2)),
        )
        plots = locate(polar, own, 15.0, 0.0087)
        (track, plot, _, _), _ = gate(
            targets, plots, Sweep(0.0, 0.0, 0.0), noise(), gate_size(0.99)
        )
        hits += np.count_nonzero(track == plot)
    assert abs(hits / 20_000 - 0.99) < 0.003


@pytest.mark.parametrize('seed', range(20))
def test_windows_find_exactly_the_plots_inside_them(seed):
    rng = np.random.default_rng(seed)
    tracks, plots = rng.integers(1, 30, 2)
    low = rng.uniform(-500, 5000, tracks)
    high = low + 10 ** rng.uniform(0, 4, tracks)
    bearing = rng.uniform(0, 2 * np.pi, tracks)
    half = np.minimum(10 ** rng.uniform(-3, 1, tracks), np.pi)
    plot_range, plot_bearing = rng.uniform(0, 6000, plots), rng.uniform(0, 2 * np.pi, plots)
    plot_bearing[0] = 0.0
    track, plot, left_out = window_pairs(
        0.5 * (low + high), low, high, bearing, half, plot_range, plot_bearing
    )
    assert left_out == 0
    expected = {
        (i, j)
        for i in range(tracks)
        for j in range(plots)
        if low[i] <= plot_range[j] <= high[i]
        and (half[i] >= np.pi or np.cos(plot_bearing[j] - bearing[i]) >= np.cos(half[i]))
    }
    found = list(zip(track.tolist(), plot.tolist()))
    assert len(found) == len(set(found))
    assert set(found) == expected
    assert (np.diff(track) >= 0).all()


@pytest.mark.parametrize('seed', range(4))
def test_plots_that_tell_their_own_covariance_are_gated_by_it(seed):
    """Clusters at close range are far less certain than the radar's figures say."""
    rng = np.random.default_rng(seed)
    targets, plots, sweep = scene(rng, 40, 60, reach=2500.0, sigma=20.0)
    root = rng.normal(0, 30, (len(plots.time), 2, 2))
    told = plots._replace(covariance=root @ root.swapaxes(1, 2) + 4 * np.eye(2))
    widest = float(np.sqrt(np.trace(told.covariance, axis1=1, axis2=2).max()))
    size = gate_size(0.99)
    (track, plot, _, _), _ = gate(targets, told, sweep, noise(5.0, 0.005, widest), size)
    expected = set(brute_force(targets, told, size))
    assert set(zip(track.tolist(), plot.tolist())) == expected
    (narrow, _, _, _), _ = gate(targets, told, sweep, noise(5.0, 0.005), size)
    assert len(narrow) < len(expected)


def test_pairs_of_tracks_and_of_lone_plots_come_apart_where_the_tracks_end():
    pairs = Pairs(
        np.array([0, 2, 2, 3, 5]), np.array([4, 0, 1, 1, 3]), np.arange(5.0), -np.arange(5.0)
    )
    for count, held in ((0, 0), (2, 1), (3, 3), (9, 5)):
        first, beyond = split(pairs, count)
        assert first.track.tolist() == pairs.track[:held].tolist()
        assert beyond.track.tolist() == (pairs.track[held:] - count).tolist()
        for one, two, both in zip(first[1:], beyond[1:], pairs[1:]):
            assert one.tolist() + two.tolist() == both.tolist()
