import itertools

import numpy as np
import pytest

from marine_tracker.evaluation.gospa import assign, assign_sticky, gospa_parts


def test_a_case_by_hand():
    distance = np.array([[10.0, 500.0], [40.0, 30.0], [500.0, 500.0]])
    row, column = assign(distance, 100.0)
    assert list(zip(row, column)) == [(0, 0), (1, 1)]
    assert gospa_parts(distance, 100.0) == (1000.0, 5000.0, 0.0)


@pytest.mark.parametrize('shape', [(0, 0), (0, 3), (2, 0)])
def test_nothing_to_pair(shape):
    row, column = assign(np.zeros(shape), 100.0)
    assert len(row) == len(column) == 0
    assert gospa_parts(np.zeros(shape), 100.0) == (0.0, shape[0] * 5000.0, shape[1] * 5000.0)


def test_gospa_is_the_least_over_all_pairings():
    rng = np.random.default_rng(5)
    for targets, tracks in itertools.product(range(4), range(4)):
        distance = rng.uniform(0, 200, (targets, tracks))
        least = min(
            sum(distance[a, b] ** 2 for a, b in zip(chosen, order))
            + (targets + tracks - 2 * len(chosen)) * 5000.0
            for count in range(min(targets, tracks) + 1)
            for chosen in itertools.combinations(range(targets), count)
            for order in itertools.permutations(range(tracks), count)
        )
        assert sum(gospa_parts(distance, 100.0)) == pytest.approx(least)


def test_a_kept_pair_stays_though_another_is_nearer():
    distance = np.array([[50.0, 5.0], [60.0, 90.0]])
    row, column = assign_sticky(distance, 100.0, [[0], []])
    assert sorted(zip(row, column)) == [(0, 0), (1, 1)]


def test_a_pair_beyond_the_cutoff_is_not_kept():
    distance = np.array([[150.0, 5.0]])
    row, column = assign_sticky(distance, 100.0, [[0]])
    assert list(zip(row, column)) == [(0, 1)]
