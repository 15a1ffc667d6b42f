import itertools

import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters
from marine_tracker.tracking import history, lifecycle
from marine_tracker.tracking.lifecycle import (
    COASTING,
    CONFIRMED,
    LOST,
    MISSED,
    OUT_OF_RANGE,
    TENTATIVE,
)
from marine_tracker.types import Tracks, take

PERIOD = 60 / 22


def one_plot(believed=0.5, status=TENTATIVE):
    """A track with its first plot, at time 0."""
    one = np.ones(1, np.int64)
    zero = np.zeros(1)
    return Tracks(
        one,
        0 * one,
        np.full(1, status, np.int8),
        one,
        np.array([believed]),
        one,
        zero,
        zero,
        zero,
        zero,
    )


def live(
    pattern,
    gain=50.0,
    loss=0.2,
    drift=0.0,
    beyond=False,
    believed=0.5,
    status=TENTATIVE,
    **parameters,
):
    """(status, reason, tracks) after each scan of the pattern: 1 hit, 0 missed, . not visible.

    Ends with the track's loss. gain, loss: likelihood ratios of a plot and of a miss.
    """
    p = TrackerParameters(**parameters)
    tracks, out = one_plot(believed, status), []
    for k, what in enumerate(pattern, 1):
        hit = np.array([what == '1'])
        now = k * PERIOD
        if hit[0]:
            tracks = tracks._replace(last_time=np.array([now]))
        ratio = np.where(hit, gain, loss)
        tracks = lifecycle.record(tracks, hit, np.array([what != '.']), ratio)
        found, reason = lifecycle.judge(tracks, p, hit, np.array([beyond]), np.array([drift]), now)
        tracks = tracks._replace(status=found)
        out.append((int(found[0]), int(reason[0]), tracks))
        if found[0] == LOST:
            break
    return out


def statuses(pattern, **about):
    return [status for status, _, _ in live(pattern, **about)]


@pytest.mark.parametrize(('needed', 'window'), [(2, 2), (2, 3), (3, 5), (4, 5), (6, 8)])
def test_m_of_n_plots_confirm_and_what_cannot_get_there_is_dropped(needed, window):
    """Every possible course of the first N scans."""
    for pattern in itertools.product('01', repeat=window - 1):
        expected = []
        plots = 1
        for scan, what in enumerate(pattern, 2):
            plots += what == '1'
            if plots >= needed:
                expected.append(CONFIRMED if what == '1' else COASTING)
                break
            if plots + window - scan < needed:
                expected.append(LOST)
                break
            expected.append(TENTATIVE)
        found = statuses(
            ''.join(pattern), gain=1e6, loss=0.5, confirm_hits=needed, confirm_scans=window
        )
        assert found[: len(expected)] == expected, pattern
        assert expected[-1] in (CONFIRMED, LOST)


def test_plots_that_clutter_explains_as_well_do_not_confirm():
    assert statuses('1111', gain=1.5, confirm_existence=0.97) == [TENTATIVE] * 4
    assert statuses('1111', gain=1.5, confirm_existence=0.5)[1] == CONFIRMED


def test_certainty_may_come_later_than_the_plots():
    assert statuses('1111', gain=4.0, confirm_existence=0.995) == [
        TENTATIVE,
        TENTATIVE,
        TENTATIVE,
        CONFIRMED,
    ]


def test_a_doubtful_track_is_dropped_once_its_window_is_poor():
    found = live('1110000', gain=1.5, confirm_existence=0.97)
    assert found[-1][:2] == (LOST, MISSED)
    assert len(found) == 6  # 1110 00: two in the last five


def test_a_confirmed_track_coasts_and_comes_back():
    assert statuses('110010') == [TENTATIVE, CONFIRMED, COASTING, COASTING, CONFIRMED, COASTING]


@pytest.mark.parametrize(('loss', 'doubt'), [(0.25, 0.3), (0.3, 0.1), (0.1, 0.02)])
def test_a_young_track_lives_until_its_target_is_hardly_there(loss, doubt):
    """Its existence is that of a chain of two states: one is seldom left, the other never."""
    pattern = '1111' + '0' * 30
    found = live(pattern, gain=9.0, loss=loss, lose_existence=doubt)
    there, gone = 0.5, 0.5
    for what, (status, _, tracks) in zip(pattern, found):
        there, gone = there * 0.999, gone + there * 0.001
        there *= 9.0 if what == '1' else loss
        assert tracks.existence[0] == pytest.approx(there / (there + gone))
        assert (status == LOST) == (tracks.existence[0] < doubt)
    assert found[-1][:2] == (LOST, MISSED) and len(found) < 15


def test_nothing_is_ever_quite_certain():
    """After any number of plots misses end a track, so many as tell that the target has gone."""
    few, many = (live('1' * n + '0' * 30, gain=1e4, loss=0.3) for n in (8, 200))
    assert len(few) - 8 == len(many) - 200 < 12


def test_a_sure_target_that_shows_in_five_of_ten_scans_is_kept():
    """However little one believes in it; one of few plots is not."""
    half = '0101100110' * 8
    about = {'gain': 1.1, 'loss': 0.1}
    assert LOST not in statuses('1' * 19 + half, believed=0.999, status=CONFIRMED, **about)
    assert LOST in statuses('1' * 3 + half, believed=0.999, status=CONFIRMED, **about)
    fewer = '0101000110' * 8
    assert LOST in statuses('1' * 19 + fewer, believed=0.999, status=CONFIRMED, **about)


@pytest.mark.parametrize('hold', [1, 3, 5])
def test_a_confirmed_track_needs_its_plots_in_ten_scans(hold):
    """With an existence beyond all doubt: lost with the first ten scans that hold too few plots."""
    rng = np.random.default_rng(hold)
    for _ in range(30):
        pattern = '1' * 10 + ''.join(rng.choice(list('01'), 40, p=[0.65, 0.35]))
        found = live(pattern, loss=1.0, hold_hits=hold)
        lengths = [
            k
            for k in range(1, len(pattern) + 1)
            if k >= 10 and ('1' + pattern)[k - 9 : k + 1].count('1') < hold
        ]
        expected = lengths[0] if lengths else len(pattern)
        assert len(found) == expected
        assert (found[-1][0] == LOST) == bool(lengths)


def test_five_plots_in_ten_hold_where_five_are_asked():
    about = {'loss': 1.0, 'hold_hits': 5}
    assert LOST not in statuses('1' * 9 + '0101010101' * 5, **about)
    assert LOST not in statuses('1' * 9 + '0000011111' * 5, **about)
    assert LOST in statuses('1' * 9 + '0000001111' * 5, **about)


def test_a_young_confirmed_track_is_not_held_to_ten_scans():
    assert statuses('11000', hold_hits=5)[-1] == COASTING


def test_a_coasting_track_that_may_be_anywhere_is_lost():
    about = {'drift': 5.0, 'max_drift': 4.0, 'believed': 0.99, 'status': CONFIRMED}
    assert live('0', **about)[-1][:2] == (LOST, MISSED)
    assert statuses('1', **about) == [CONFIRMED]
    assert statuses('0', **{**about, 'max_drift': 6.0}) == [COASTING]


def test_a_track_beyond_the_radars_range_has_left_by_range():
    about = {'beyond': True, 'believed': 0.99, 'status': CONFIRMED}
    assert live('.', **about)[-1][:2] == (LOST, OUT_OF_RANGE)
    assert statuses('1', **about) == [CONFIRMED]  # a plot is stronger than the estimate
    assert live('.', beyond=True)[-1][:2] == (LOST, OUT_OF_RANGE)


def test_where_the_radar_cannot_see_nothing_is_missed():
    before, after = live('11'), live('11' + '.' * 12)
    assert after[-1][0] == COASTING
    for name in ('history', 'existence', 'age'):
        assert getattr(after[-1][2], name) == getattr(before[-1][2], name)
    assert statuses('11' + '.' * 12 + '1')[-1] == CONFIRMED


def test_a_plot_where_none_was_expected_counts():
    """Such as a plot a little inside the blind range."""
    seen, nowhere = np.array([True]), np.array([False])
    tracks = lifecycle.record(one_plot(0.2), seen, nowhere, np.array([8.0]))
    assert tracks.history[0] == 0b11 and tracks.age[0] == 2
    assert tracks.existence[0] == pytest.approx(2 / 3, rel=1e-3)  # odds of 1/4, times 8


def test_no_track_stays_in_the_dark_for_ever():
    found = live('11' + '.' * 200)
    assert found[-1][0] == LOST
    assert 20 < len(found) < 60


def test_hits_and_misses_are_counted():
    rng = np.random.default_rng(0)
    bits = rng.integers(0, 2, (200, 20))
    many = bits @ (1 << np.arange(20))
    for scans in (1, 5, 10, 20):
        assert (history.hits(many, scans) == bits[:, :scans].sum(1)).all()
    since = [next((k for k in range(20) if row[k]), 20) for row in bits]
    assert history.misses_in_a_row(many).tolist() == since
    assert history.misses_in_a_row(np.zeros(1, np.int64)) == [20]


def test_only_so_many_scans_are_remembered():
    tracks = live('1' * 70)[-1][2]
    assert tracks.history[0] == (1 << 20) - 1


def test_tracks_are_judged_each_for_itself():
    """One batch of all cases gives what each alone gives."""
    rng = np.random.default_rng(8)
    count, p = 300, TrackerParameters(hold_hits=3)
    status = rng.integers(0, 3, count).astype(np.int8)
    many = Tracks(
        np.arange(count),
        np.zeros(count, np.int64),
        status,
        rng.integers(0, 1 << 20, count),
        rng.uniform(0, 1, count),
        rng.integers(1, 40, count),
        np.zeros(count),
        rng.uniform(-120, 0, count),
        np.zeros(count),
        np.zeros(count),
    )
    facts = (many.history & 1 == 1, rng.random(count) < 0.1, rng.uniform(0, 6, count))
    found = lifecycle.judge(many, p, *facts, 0.0)
    for row in range(count):
        one = take(many, np.array([row]))
        alone = lifecycle.judge(one, p, *(fact[row : row + 1] for fact in facts), 0.0)
        assert (alone[0][0], alone[1][0]) == (found[0][row], found[1][row])
    assert set(found[0]) == {TENTATIVE, CONFIRMED, COASTING, LOST}
    assert ((found[1] > 0) == (found[0] == LOST)).all()
