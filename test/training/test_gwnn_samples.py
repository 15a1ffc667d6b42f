"""What the wavelet network learns from."""

import numpy as np
import pytest

from marine_tracker.estimators.gwnn import bank
from marine_tracker.training import gwnn_samples, training_tracks
from marine_tracker.training.gwnn_fusion import cell_weights, rivals


def made(seed, chunk, vessel_class='ship'):
    return gwnn_samples.make(
        bank.BANKS[vessel_class], training_tracks.WATERS[vessel_class], seed, chunk
    )


@pytest.fixture(scope='module')
def samples():
    return made(900, 0)


def test_they_are_sound_and_repeatable(samples):
    assert len(samples.cell) > 10000
    for array in samples:
        assert np.isfinite(array).all()
    again = made(900, 0)
    np.testing.assert_array_equal(again.seen, samples.seen)
    assert made(900, 1).seen[0, 0] != samples.seen[0, 0]


def test_every_kind_and_phase_is_there(samples):
    names = training_tracks.WATERS['ship'].names
    count = np.bincount(samples.cell, minlength=gwnn_samples.cell_count(len(names)))
    count = count.reshape(len(names), 2, 2, 2)
    for i, kind in enumerate(names):
        assert (count[i, 0].sum() > 0) == (kind != 'weave')
        assert (count[i, 1].sum() > 0) == (kind not in ('steady', 'drift')) or kind == 'moored'


def test_after_a_plot_the_time_asked_for_is_the_plots(samples):
    after = gwnn_samples.cell_of(samples.cell).after == 1
    assert (samples.scans[after] == 0).all() and (samples.scans[~after] > 0).all()


def test_the_base_knows_its_own_error(samples):
    """Steady ships, sigma stated rightly: the truth is as far off as the variance tells."""
    cell = gwnn_samples.cell_of(samples.cell)
    chosen = (cell.kind == 0) & (samples.truly == 1) & (cell.sort == 0)
    ratio = np.square(samples.truth[chosen]) / np.exp(samples.spread[chosen])
    assert 0.3 < ratio.mean() < 1.5


def test_each_cell_counts_by_the_better_of_two_imms(samples):
    """The position error of that one, weighted, is 1 in every cell; the other's is no less."""
    weights = cell_weights(samples)
    size = rivals(samples)[:, 0] / samples.truly[:, None] ** 2  # of the positions
    counted = (weights[:, 0] * samples.truly**2)[:, None] * np.minimum(size, 40)
    for cell in np.unique(samples.cell):
        total = counted[samples.cell == cell].mean(0)
        assert total.min() == pytest.approx(1.0, rel=1e-3)
