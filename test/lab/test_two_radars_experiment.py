"""The experiment of two radars: a short form, and the whole statement as a slow test."""

import numpy as np
import pytest

from marine_tracker.lab.two_radars import two_radars


@pytest.fixture(scope='module')
def scene():
    return dict(zip(two_radars.WAYS, two_radars.scene('imm', 5, until=420.0), strict=True))


def rms(course):
    return np.sqrt(np.nanmean(course.position[:, : two_radars.SEEN_BY_BOTH] ** 2))


def test_the_fused_track_is_better_than_either_and_outlives_one(scene):
    """Of the first 420 s of one run; the errors of six ships at 60 moments."""
    assert rms(scene['both']) < 0.95 * min(rms(scene['X band']), rms(scene['S band']))
    for way in ('both', 'both, S band silent'):
        assert not np.isnan(scene[way].position).any()
    assert np.isnan(scene['S band'].position[:, -1]).mean() > 0.9  # the boat


def test_the_ratio_has_an_interval_that_holds_it():
    rng = np.random.default_rng(2)
    square = rng.chisquare(8, 60)
    value, low, high = two_radars._ratio(1.1 * square, square, rng)
    assert (low, value, high) == pytest.approx((np.sqrt(1.1),) * 3)  # pairs are kept together
    value, low, high = two_radars._ratio(rng.chisquare(8, 60), square, rng)
    assert low < value < high and low > 0.7 and high < 1.4


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_all_figures_are_met():
    found = two_radars.run(20, 2)
    assert not [figure for figure in found.figures if figure.ok is False]
    assert found.claims[0].verdict == 'borne out'
