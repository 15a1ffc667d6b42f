from typing import NamedTuple

import numpy as np
import pytest

from marine_tracker.types import append, put, take, where


class Inner(NamedTuple):
    a: np.ndarray
    b: np.ndarray


class Outer(NamedTuple):
    time: np.ndarray
    pair: tuple
    inner: Inner


def rows(*numbers):
    """A nested structure whose row i says in every array that it is number numbers[i]."""
    n = np.array(numbers, float)
    matrix = n[:, None, None] + np.zeros((2, 2))
    return Outer(n, (n.astype(np.int64), n[:, None] + np.zeros(2)), Inner(matrix, n > 2))


def same(found, expected):
    """Equal in values, types and nesting."""
    assert type(found) is type(expected)
    if isinstance(found, tuple):
        assert len(found) == len(expected)
        for one, other in zip(found, expected):
            same(one, other)
    else:
        assert found.dtype == expected.dtype
        np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize(
    ('chosen', 'expected'),
    [
        (np.array([2, 0]), (7, 1)),
        (np.array([False, True, True]), (5, 7)),
        (slice(1, None), (5, 7)),
        (np.array([1, 1]), (5, 5)),
        (np.zeros(0, np.int64), ()),
        (np.zeros(3, bool), ()),
    ],
)
def test_take_chooses_rows_of_every_array_at_every_depth(chosen, expected):
    same(take(rows(1, 5, 7), chosen), rows(*expected))


def test_a_field_that_is_not_told_stays_so():
    told = rows(1, 5, 7)
    untold = told._replace(pair=None)
    same_but_pair = (
        (take(untold, np.array([2, 0])), rows(7, 1)),
        (take(untold, slice(1, None)), rows(5, 7)),
        (append(untold, untold), rows(1, 5, 7, 1, 5, 7)),
        (where(np.array([True, False, True]), untold, untold), told),
        (put(untold, np.array([0]), take(untold, np.array([1]))), rows(5, 5, 7)),
    )
    for found, expected in same_but_pair:
        assert found.pair is None
        same(found._replace(pair=expected.pair), expected)


def test_what_is_told_by_one_alone_cannot_be_joined():
    with pytest.raises((TypeError, ValueError)):
        append(rows(1)._replace(pair=None), rows(2))


def test_append_puts_the_second_rows_behind_the_first():
    same(append(rows(1, 5), rows(7)), rows(1, 5, 7))


def test_append_of_no_rows_changes_nothing():
    same(append(rows(1, 5), rows()), rows(1, 5))
    same(append(rows(), rows(1, 5)), rows(1, 5))


def test_where_chooses_row_by_row():
    mask = np.array([True, False, True])
    same(where(mask, rows(1, 2, 3), rows(4, 5, 6)), rows(1, 5, 3))


@pytest.mark.parametrize('named', [np.array([2, 0]), np.array([True, False, True])])
def test_put_replaces_only_the_named_rows(named):
    expected = rows(9, 5, 8) if named.dtype != bool else rows(8, 5, 9)
    same(put(rows(1, 5, 7), named, rows(8, 9)), expected)


def test_put_leaves_its_arguments_alone():
    before, new = rows(1, 5, 7), rows(8)
    after = put(before, np.array([1]), new)
    same(before, rows(1, 5, 7))
    after.inner.a[:] = -1.0
    same(before, rows(1, 5, 7))
    same(new, rows(8))


def test_take_of_indices_owns_its_memory():
    before = rows(1, 5, 7)
    take(before, np.array([0, 1, 2])).inner.a[:] = -1.0
    same(before, rows(1, 5, 7))
