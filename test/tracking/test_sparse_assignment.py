import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from marine_tracker.tracking import associate as association
from marine_tracker.tracking.associate import associate
from marine_tracker.tracking.sparse_assignment import best_pairs


def problem(seed):
    """A sparse problem of up to 70 tracks and plots; every third one is full of ties."""
    rng = np.random.default_rng(seed)
    tracks, plots = rng.integers(1, 70, 2)
    count = int(min(tracks * plots, rng.choice([0.3, 1.2, 3.0, 9.0]) * max(tracks, plots)))
    code = np.sort(rng.choice(tracks * plots, max(count, 1), replace=False))
    gain = rng.uniform(1e-9, 17.0, len(code))
    if seed % 3 == 0:
        gain = rng.integers(1, 4, len(code)).astype(float)
    return code // plots, code % plots, gain, tracks, plots


def dense_total(track, plot, gain, tracks, plots):
    worth = np.zeros((tracks, plots))
    worth[track, plot] = gain
    return worth[linear_sum_assignment(worth, maximize=True)].sum()


def total(track, plot, gain, plot_of):
    worth = dict(zip(zip(track.tolist(), plot.tolist()), gain.tolist()))
    taken = [(t, p) for t, p in enumerate(plot_of.tolist()) if p >= 0]
    assert len({p for _, p in taken}) == len(taken), 'a plot was used twice'
    return sum(worth[pair] for pair in taken)


@pytest.mark.parametrize('seed', range(200))
def test_a_graph_costs_what_the_matrix_costs(seed, monkeypatch):
    """Rectangular both ways, with ties, with rows and columns that have no candidate."""
    monkeypatch.setattr(association, 'FEW', 0)
    monkeypatch.setattr(association, 'LARGE', 0)
    found = associate(*problem(seed))
    assert total(*problem(seed)[:3], found) == pytest.approx(dense_total(*problem(seed)))


def crowd(rows, columns, seed):
    """Every row wants every column, for nearly the same gain."""
    rng = np.random.default_rng(seed)
    row, column = np.divmod(np.arange(rows * columns), columns)
    return row, column, 5 + rng.uniform(0, 1e-3, len(row)), rows, columns


@pytest.mark.parametrize(('rows', 'columns'), [(60, 55), (55, 60), (64, 64)])
def test_the_search_gives_up_where_many_contest_the_same(rows, columns):
    asked = crowd(rows, columns, 4)
    found = best_pairs(*asked)
    assert asked[2][found].sum() == pytest.approx(dense_total(*asked))
    assert best_pairs(*asked, patience=0.01) is None


def test_what_the_search_gave_up_is_solved_all_the_same(monkeypatch):
    monkeypatch.setattr(association, 'LARGE', 0)
    monkeypatch.setattr(association, 'PATIENCE', 0.01)
    asked = crowd(60, 55, 5)
    assert total(*asked[:3], associate(*asked)) == pytest.approx(dense_total(*asked))


def test_what_is_given_stays_as_it_was():
    asked = problem(5)
    before = [one.copy() for one in asked[:3]]
    _, row = np.unique(asked[0], return_inverse=True)
    _, column = np.unique(asked[1], return_inverse=True)
    best_pairs(row, column, asked[2], row.max() + 1, column.max() + 1)
    for one, copy in zip(asked, before):
        np.testing.assert_array_equal(one, copy)


def test_a_long_chain_is_one_component():
    """Track k wants plots k and k + 1: 3,000 links, found and solved as one."""
    rng = np.random.default_rng(8)
    link = np.arange(3000)
    order = np.lexsort((np.r_[link, link + 1], np.r_[link, link]))
    track, plot = np.r_[link, link][order], np.r_[link, link + 1][order]
    gain = rng.uniform(0.1, 1, len(track))
    found = associate(track, plot, gain, 3000, 3001)
    assert total(track, plot, gain, found) == pytest.approx(
        dense_total(track, plot, gain, 3000, 3001)
    )
