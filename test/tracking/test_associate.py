import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from marine_tracker.tracking.associate import associate


def best_gain(track, plot, gain, tracks, plots):
    """Total gain of the best assignment of all, by one dense matrix (0 = leave alone)."""
    worth = np.zeros((tracks, plots))
    worth[track, plot] = gain
    return worth[linear_sum_assignment(worth, maximize=True)].sum()


def check(track, plot, gain, tracks, plots):
    track, plot = np.asarray(track, np.int64), np.asarray(plot, np.int64)
    gain = np.asarray(gain, float)
    before = [a.copy() for a in (track, plot, gain)]
    plot_of = associate(track, plot, gain, tracks, plots)
    for array, copy in zip((track, plot, gain), before):
        np.testing.assert_array_equal(array, copy)
    assert plot_of.shape == (tracks,)
    taken = plot_of[plot_of >= 0]
    assert len(np.unique(taken)) == len(taken), 'a plot was used twice'
    pairs = {(t, p): g for t, p, g in zip(track.tolist(), plot.tolist(), gain)}
    total = 0.0
    for t, p in enumerate(plot_of.tolist()):
        if p >= 0:
            assert (t, p) in pairs, 'a pair was invented'
            total += pairs[t, p]
    expected = best_gain(track, plot, gain, tracks, plots)
    assert total == pytest.approx(expected, rel=1e-12, abs=1e-12)
    return plot_of


def random_graph(rng, tracks, plots, pairs):
    code = np.sort(rng.choice(tracks * plots, pairs, replace=False))
    return code // plots, code % plots


@pytest.mark.parametrize('seed', range(120))
def test_the_assignment_is_the_global_optimum(seed):
    rng = np.random.default_rng(seed)
    tracks, plots = rng.integers(1, 40, 2)
    density = rng.choice([0.2, 0.7, 1.5, 3.0])
    pairs = int(min(tracks * plots, density * max(tracks, plots)))
    track, plot = random_graph(rng, tracks, plots, pairs)
    check(track, plot, rng.uniform(1e-6, 20, pairs), tracks, plots)


@pytest.mark.parametrize('seed', range(20))
def test_a_crowd_is_solved_exactly(seed):
    """Every track with nearly every plot."""
    rng = np.random.default_rng(seed)
    tracks, plots = rng.integers(5, 30, 2)
    track, plot = random_graph(rng, tracks, plots, int(0.8 * tracks * plots))
    check(track, plot, rng.uniform(0, 14, len(track)) + 1e-9, tracks, plots)


@pytest.mark.parametrize('seed', range(20))
@pytest.mark.parametrize('length', [2, 3, 7, 60])
def test_chains_are_solved_exactly(seed, length):
    """Track i wants plots i and i + 1: one decision reaches from end to end. Shuffled names."""
    rng = np.random.default_rng(seed)
    link = np.arange(length)
    track, plot = np.r_[link, link], np.r_[link, link + 1]
    track, plot = rng.permutation(length)[track], rng.permutation(length + 1)[plot]
    order = np.lexsort((plot, track))
    gain = rng.uniform(0.1, 1, 2 * length)
    check(track[order], plot[order], gain, length, length + 1)
    check(
        plot[np.lexsort((track, plot))], track[np.lexsort((track, plot))], gain, length + 1, length
    )


def test_the_nearest_plot_yields_where_the_sum_is_better():
    """Track 0 prefers plot 0 but track 1 has nothing else."""
    plot_of = check([0, 0, 1], [0, 1, 0], [10.0, 9.0, 8.0], 2, 2)
    assert plot_of.tolist() == [1, 0]


def test_a_track_rather_takes_none_than_spoils_the_sum():
    plot_of = check([0, 1], [0, 0], [3.0, 4.0], 2, 1)
    assert plot_of.tolist() == [-1, 0]


@pytest.mark.parametrize(('tracks', 'plots'), [(0, 0), (0, 4), (4, 0), (3, 5)])
def test_where_no_pair_is_admissible_every_track_goes_without(tracks, plots):
    assert check([], [], [], tracks, plots).tolist() == [-1] * tracks


def test_one_track_with_many_plots_and_one_plot_with_many_tracks():
    check([0] * 5, [0, 1, 2, 3, 4], [1.0, 5.0, 2.0, 4.0, 3.0], 1, 5)
    check([0, 1, 2, 3, 4], [0] * 5, [1.0, 5.0, 2.0, 4.0, 3.0], 5, 1)


@pytest.mark.parametrize('seed', range(10))
def test_equal_gains_give_a_best_sum_too(seed):
    rng = np.random.default_rng(seed)
    track, plot = random_graph(rng, 20, 20, 60)
    check(track, plot, rng.choice([1.0, 2.0], 60), 20, 20)


def test_thousands_of_small_groups_agree_with_one_dense_solution():
    rng = np.random.default_rng(3)
    tracks = 600
    track = np.repeat(np.arange(tracks), 2)
    plot = np.minimum(track + rng.integers(0, 3, len(track)), tracks - 1)
    _, first = np.unique(track * tracks + plot, return_index=True)
    check(track[first], plot[first], rng.uniform(0.1, 10, len(first)), tracks, tracks)
