import itertools

import numpy as np
import pytest

from marine_tracker.tracking import marginals
from marine_tracker.tracking.marginals import marginals as probabilities


def by_enumeration(weight):
    """Probability of each pair of a matrix of weights, over all joint associations one by one."""
    rows, columns = weight.shape
    total, found = 0.0, np.zeros_like(weight)
    for choice in itertools.product(range(-1, columns), repeat=rows):
        taken = [k for k in choice if k >= 0]
        if len(set(taken)) < len(taken):
            continue
        worth = np.prod([weight[t, k] for t, k in enumerate(choice) if k >= 0])
        total += worth
        for t, k in enumerate(choice):
            if k >= 0:
                found[t, k] += worth
    return found / total


def scene(rng, tracks, plots, share=0.6):
    """A matrix of weights, of which some are 0: no pair."""
    weight = 10 ** rng.uniform(-2, 3, (tracks, plots))
    return np.where(rng.random((tracks, plots)) < share, weight, 0.0)


def of_matrix(weight):
    row, column = weight.nonzero()
    found = np.zeros_like(weight)
    found[row, column] = probabilities(row, column, weight[row, column], *weight.shape)
    return found


@pytest.mark.parametrize('seed', range(40))
def test_small_groups_are_summed_over_all_joint_associations(seed):
    rng = np.random.default_rng(seed)
    weight = scene(rng, *rng.integers(1, 6, 2))
    assert of_matrix(weight) == pytest.approx(by_enumeration(weight), abs=1e-12)


def test_many_groups_at_once_are_each_as_if_alone():
    """Of different sizes, one too large for the exact sum, in shuffled order."""
    rng = np.random.default_rng(41)
    sizes = [(1, 1), (2, 1), (1, 4), (3, 3), (9, 7), (2, 2), (4, 2)]
    blocks = [scene(rng, *size, 0.9) for size in sizes]
    tracks, plots = np.sum(sizes, axis=0)
    whole = np.zeros((tracks, plots))
    corner = np.zeros(2, int)
    for block in blocks:
        whole[corner[0] :, corner[1] :][: block.shape[0], : block.shape[1]] = block
        corner += block.shape
    order, across = rng.permutation(tracks), rng.permutation(plots)
    found = np.empty_like(whole)
    found[np.ix_(order, across)] = of_matrix(whole[np.ix_(order, across)]) * 0
    found = of_matrix(whole[np.ix_(order, across)])[np.ix_(order.argsort(), across.argsort())]
    corner = np.zeros(2, int)
    for block in blocks:
        part = found[corner[0] :, corner[1] :][: block.shape[0], : block.shape[1]]
        assert part == pytest.approx(of_matrix(block), abs=1e-6)
        corner += block.shape


def test_a_chain_too_long_for_the_sum_is_exact_by_messages():
    """Nine tracks and nine plots, each plot between two tracks: a tree."""
    rng = np.random.default_rng(42)
    chain = np.diag(10 ** rng.uniform(-1, 2, 9)) + np.diag(10 ** rng.uniform(-1, 2, 8), 1)
    assert len(chain) > marginals.MOST_TRACKS
    # The last plot of the chain belongs to the last track only; so the sum over what is free.
    ahead = by_enumeration_of_chain(chain)
    assert of_matrix(chain) == pytest.approx(ahead, abs=1e-5)


def by_enumeration_of_chain(chain):
    """The same where track k wants plots k and k + 1."""
    count = len(chain)
    total, found = 0.0, np.zeros_like(chain)
    for choice in itertools.product((None, 0, 1), repeat=count):
        taken = [k + step for k, step in enumerate(choice) if step is not None]
        if len(set(taken)) < len(taken) or count in taken:
            continue
        worth = np.prod([chain[k, k + step] for k, step in enumerate(choice) if step is not None])
        total += worth
        for k, step in enumerate(choice):
            if step is not None:
                found[k, k + step] += worth
    return found / total


@pytest.mark.parametrize('seed', range(5))
def test_large_tangled_groups_are_nearly_right(seed, monkeypatch):
    """The messages against the sum, on groups that both can do."""
    rng = np.random.default_rng(50 + seed)
    weight = scene(rng, 4, 4, 0.8)
    exact = of_matrix(weight)
    monkeypatch.setattr(marginals, 'MOST_PLOTS', 0)
    off = np.abs(of_matrix(weight) - exact)
    assert off.max() < 0.2 and off.mean() < 0.05


def test_nothing_gives_nothing():
    none = np.zeros(0, np.int64)
    assert len(probabilities(none, none, np.zeros(0), 3, 4)) == 0
