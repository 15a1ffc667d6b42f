"""The search for the best settings of a filter, and the judgement of what it finds."""

import numpy as np
import pytest

from marine_tracker.estimators import cs_kalman, imm
from marine_tracker.estimators.gwnn import bank_settings
from marine_tracker.training import filter_families, filter_tuning, training_tracks
from marine_tracker.types import take

# Restless: a CV mode of much noise, seldom left.
BAD = np.array([1.0, 1.0, 1.0, 0.9, 0.0, 0.0, 0.0])


@pytest.fixture(scope='module')
def few():
    return filter_tuning.course(110, np.random.default_rng(1))


def bowl(modes):
    """Least where noise and turn rate are those of the bank's IMM."""
    wanted = bank_settings.TUNED_ON_ALL
    return float(
        np.square(np.log(np.array(modes.noise) / wanted.noise)).sum()
        + np.log(modes.turn_rate[2] / wanted.turn_rate[2]) ** 2
    )


def test_tracks_are_of_every_kind_alike_and_none_close(few):
    assert np.bincount(few.kind).tolist() == [10] * len(training_tracks.WATERS['ship'].names)
    place = few.trial.ships.position
    nearest = training_tracks.WATERS['ship'].radars[0].nearest
    assert np.hypot(place[..., 0], place[..., 1]).min() > nearest
    assert few.trial.radar.range_sigma.min() >= 8
    assert 'weave, straight' not in few.cells and 'steady, manoeuvre' not in few.cells
    assert (few.counts.sum(0) <= 1).all() and few.counts[..., :20].sum() == 0


def test_fresh_tracks_are_not_those_of_the_search_nor_of_another_seed():
    _, seen = filter_tuning.tune('training', 110, 1, 3)
    again, fresh, other = (
        filter_tuning.course(110, filter_tuning._tracks_rng(3, 0)),
        filter_tuning.fresh(110, 3),
        filter_tuning.fresh(110, 4),
    )
    starts = [one.trial.ships.position[:, 0] for one in (seen, fresh, other)]
    np.testing.assert_array_equal(again.trial.ships.position[:, 0], starts[0])
    assert len(np.unique(np.concatenate(starts)[:, 0])) == 330


def test_the_loss_is_the_mean_log_rms_of_the_cells_that_count(few):
    error = few.counts.sum(2) * 2.0  # one sigma an axis in every scan
    assert filter_tuning.loss(error, few, 'training') == pytest.approx(0)
    assert filter_tuning.loss(error, few, 'manoeuvre') == pytest.approx(0)
    worse = error.copy()
    worse[few.cells.index('steady, straight')] *= np.exp(2)  # RMS times e
    assert filter_tuning.loss(worse, few, 'training') == pytest.approx(1 / len(few.cells))
    assert filter_tuning.loss(worse, few, 'manoeuvre') == pytest.approx(0)


def test_errors_are_in_deviations_of_the_plots_as_they_truly_are():
    """Twice the noise than stated, and told so, is as good: the filter's gate aside."""

    def rms(truly):
        on = filter_tuning.course(140, np.random.default_rng(2))
        row = np.flatnonzero(on.trial.radar.truly == 1)
        trial = on.trial._replace(
            ships=take(on.trial.ships, row),
            seen=on.trial.seen[row],
            radar=take(on.trial.radar, row)._replace(truly=np.full(len(row), truly)),
            plots=[take(plots, row) for plots in on.trial.plots],
        )
        part = on._replace(trial=trial, counts=on.counts[:, row], kind=on.kind[row])
        return filter_tuning.errors(bank_settings.TUNED_ON_ALL, part).sum()

    assert rms(2.0) == pytest.approx(rms(1.0) / 4)


def test_the_best_of_the_family_is_found_where_it_is_known():
    """600 evaluations on a bowl of seven dimensions, three of them flat, from a bad start."""
    found = filter_tuning.search(bowl, 600, 1, BAD)
    assert bowl(filter_families.IMM.at(BAD)) > 30
    assert found.loss == bowl(found.settings) == found.best[-1] < 0.05
    assert len(found.best) == 600 and (np.diff(found.best) <= 0).all()


def test_a_search_improves_a_bad_start_and_can_be_repeated(few):
    def judge(modes):
        return filter_tuning.loss(filter_tuning.errors(modes, few), few, 'training')

    found = filter_tuning.search(judge, 8, 4, BAD)
    assert found.best[0] == pytest.approx(judge(filter_families.IMM.at(BAD)))
    assert found.loss == judge(found.settings) < found.best[0] - 0.05
    assert filter_tuning.search(bowl, 80, 4, BAD) == filter_tuning.search(bowl, 80, 4, BAD)
    assert filter_tuning.search(bowl, 80, 4).settings != filter_tuning.search(bowl, 80, 5).settings


def test_one_evaluation_is_the_start_and_a_loss_that_is_no_number_is_told():
    assert filter_tuning.search(bowl, 1, 1, BAD).loss == pytest.approx(
        bowl(filter_families.IMM.at(BAD))
    )
    with pytest.raises(FloatingPointError, match=r'the error of Modes\(.*is nan'):
        filter_tuning.search(lambda modes: np.nan, 5, 1)


def test_all_settings_tried_keep_to_the_bounds():
    low, high = filter_families.IMM.at(np.zeros(7)), filter_families.IMM.at(np.ones(7))
    assert low.noise[0] == pytest.approx(filter_families.PERIOD * 1e-4**2)
    assert high.turn_rate == pytest.approx((0, 0, 0.45, -0.45))
    assert high.stay == pytest.approx((0.7, 0.55, 0.55, 0.55))
    tried = []

    def outward(modes):  # best at a corner of the bounds
        tried.append(modes)
        return -sum(np.log(modes.noise)) + sum(modes.stay)

    best = filter_tuning.search(outward, 400, 1).settings
    for modes in tried:
        for field in ('noise', 'stay'):
            ends = np.sort([getattr(low, field), getattr(high, field)], 0)
            value = np.array(getattr(modes, field))
            assert (ends[0] * (1 - 1e-9) <= value).all() and (value <= ends[1] * (1 + 1e-9)).all()
        assert 0.003 * (1 - 1e-9) <= modes.turn_rate[2] <= 0.45 * (1 + 1e-9)
    assert best.noise == pytest.approx(high.noise, rel=0.2)
    for corner in (low, high):  # every corner is a chain that exists
        imm.bank_of(corner)


def test_a_ratio_has_its_interval(few):
    rng = np.random.default_rng(6)
    error = few.counts.sum(2) * rng.uniform(1, 3, len(few.kind))
    ratio = filter_tuning.compare(error * 0.81, error, few, 'training', rng)
    assert ratio == pytest.approx((0.9, 0.9, 0.9))
    noisy = error * np.exp(rng.normal(0, 0.2, error.shape[1]))
    ratio = filter_tuning.compare(noisy, error, few, 'training', rng)
    assert ratio.low < ratio.value < ratio.high < ratio.low + 0.2
    cells = filter_tuning.cell_ratios(noisy, error, few)
    assert ratio.value == pytest.approx(np.exp(np.mean(np.log(list(cells.values())))))


@pytest.mark.parametrize('name', list(filter_families.FAMILIES))
def test_settings_as_text_are_the_settings(name):
    family = filter_families.FAMILIES[name]
    settings = family.at(np.full(len(family.searched), 0.4))
    pasted = eval(
        filter_families.as_text(settings), {'Modes': imm.Modes, 'Manoeuvre': cs_kalman.Manoeuvre}
    )
    for one, other in zip(pasted, settings):
        np.testing.assert_allclose(one, other, rtol=1e-4)


@pytest.mark.parametrize('name', ['cv_cv', 'cv', 'cs'])
def test_simpler_filters_are_tuned_the_same_way(name):
    """The search ends no worse than at the middle of the bounds, where it begins."""
    found, _ = filter_tuning.tune('training', 110, 6, 1, family=filter_families.FAMILIES[name])
    assert found.loss == found.best[-1] <= found.best[0]
    assert len(found.best) == 6
