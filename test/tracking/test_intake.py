import numpy as np
import pytest

from marine_tracker.tracking import intake
from marine_tracker.types import PolarPlots, append

PERIOD = 60 / 22


def plots(range_=(1000.0,), bearing=(1.0,), amplitude=None, time=None):
    count = len(range_)
    return PolarPlots(
        np.zeros(count) if time is None else np.asarray(time, float),
        np.asarray(range_, float),
        np.asarray(bearing, float),
        np.zeros(count) if amplitude is None else np.asarray(amplitude, float),
    )


@pytest.mark.parametrize(
    'bad, reason',
    [
        (plots([np.nan], [1.0]), intake.NOT_FINITE),
        (plots([np.inf], [1.0]), intake.NOT_FINITE),
        (plots([-np.inf], [1.0]), intake.NOT_FINITE),
        (plots([10.0], [np.nan]), intake.NOT_FINITE),
        (plots([10.0], [1.0], [np.nan]), intake.NOT_FINITE),
        (plots([10.0], [1.0], time=[np.inf]), intake.NOT_FINITE),
        (plots([-5.0], [1.0]), intake.BAD_RANGE),
        (plots([0.0], [1.0]), intake.BAD_RANGE),
        (plots([1e30], [1.0]), intake.TOO_FAR),
        (plots([10.0], [6.4]), intake.BAD_BEARING),
        (plots([10.0], [-3.2]), intake.BAD_BEARING),
        (plots([10.0], [1.0], time=[-1.0]), intake.BAD_OFFSET),
        (plots([10.0], [1.0], time=[60.0]), intake.BAD_OFFSET),
    ],
)
def test_a_bad_plot_is_left_out_and_counted_by_its_reason_alone(bad, reason):
    good = plots()
    kept, counts = intake.screen_plots(append(bad, good), PERIOD, 100)
    assert counts == {reason: 1}
    assert kept.range.tolist() == [1000.0]


def test_bearings_of_one_turn_back_and_forth_are_wrapped():
    kept, counts = intake.screen_plots(
        plots([1.0] * 4, [-np.pi, -0.5, 0.0, np.float32(2 * np.pi)]), PERIOD, 100
    )
    assert counts == {}
    assert kept.bearing == pytest.approx([np.pi, 2 * np.pi - 0.5, 0.0, 0.0], abs=1e-6)


def test_an_empty_scan_is_fine():
    kept, counts = intake.screen_plots(plots([], []), PERIOD, 100)
    assert counts == {} and len(kept.range) == 0


def test_the_strongest_plots_are_kept_in_their_order():
    kept, counts = intake.screen_plots(
        plots(np.arange(1.0, 100001), np.ones(100000), np.arange(100000) % 977), PERIOD, 500
    )
    assert counts == {intake.TOO_MANY: 99500}
    assert len(kept.range) == 500
    assert kept.amplitude.min() >= 971
    assert (np.diff(kept.range) > 0).all()


def run_scans(starts):
    order, results = intake.TimeOrder(), []
    for start in starts:
        order, taken, reason = intake.admit_scan(order, start, PERIOD)
        results.append((taken, reason, start + order.shift))
    return results


def test_scans_in_order_are_taken_also_after_a_pause():
    results = run_scans([0.0, 2.7, 5.4, 20.0, 22.7])
    assert all(taken and not reason for taken, reason, _ in results)


@pytest.mark.parametrize(
    'wrong, reason',
    [
        (5.4, intake.REPEATED),
        (2.7, intake.WENT_BACK),
        (-1e6, intake.WENT_BACK),
        (1e6, intake.JUMPED_AHEAD),
    ],
)
def test_one_wrong_stamp_costs_one_scan(wrong, reason):
    results = run_scans([0.0, 2.7, 5.4, wrong, 8.1, 10.8])
    assert [taken for taken, _, _ in results] == [True, True, True, False, True, True]
    assert results[3][1] == reason


@pytest.mark.parametrize('jump', [3600.0, -3600.0, -1.7e9])
def test_a_clock_that_was_set_is_followed_and_the_trackers_time_goes_on(jump):
    before = [k * PERIOD for k in range(5)]
    after = [jump + k * PERIOD for k in range(5, 10)]
    results = run_scans(before + after)
    assert [taken for taken, _, _ in results] == [True] * 5 + [False, False] + [True] * 3
    assert results[7][1] == intake.REBASED
    times = [time for taken, _, time in results if taken]
    # 4, then 7, 8, 9: the two rejected ones count as revolutions.
    assert np.diff(times) == pytest.approx([PERIOD] * 4 + [3 * PERIOD] + [PERIOD] * 2, abs=1e-5)


def test_stamps_that_stand_still_are_never_taken():
    results = run_scans([0.0] * 20)
    assert [taken for taken, _, _ in results] == [True] + [False] * 19
    assert {reason for _, reason, _ in results[1:]} == {intake.REPEATED}


def test_stamps_at_random_do_not_move_the_order():
    rng = np.random.default_rng(1)
    wild = rng.uniform(-1e9, 1e9, 200)
    results = run_scans([0.0, *wild, 2.7])
    assert results[-1] == (True, '', 2.7)


def test_a_bad_radial_speed_is_forgotten_and_counted_but_its_plot_stays():
    given = plots([1000.0, 2000.0, 3000.0, 4000.0, -1.0], [1.0] * 5)._replace(
        radial_speed=np.array([5.0, np.nan, -1e30, -np.inf, np.nan])
    )
    kept, counts = intake.screen_plots(given, PERIOD, 100)
    assert kept.range.tolist() == [1000.0, 2000.0, 3000.0, 4000.0]
    np.testing.assert_array_equal(kept.radial_speed, [5.0, np.nan, np.nan, np.nan])
    assert counts == {intake.BAD_RANGE: 1, intake.SPEED_NOT_FINITE: 2, intake.SPEED_TOO_HIGH: 1}
    assert set(counts) <= set(intake.PLOT_REASONS)


def beside(*scans):
    """What becomes of scans that start at the times, beside a radar heard at 1000 s."""
    order, out = intake.TimeOrder(), []
    for start in scans:
        order, taken, reason = intake.admit_scan(order, start, 2.5, [intake.TimeOrder(1000.0)])
        out.append((taken, reason))
    return order, out


def test_a_scan_older_than_another_radars_last_is_not_going_back():
    _, out = beside(997.0, 999.5)
    assert out == [(True, ''), (True, '')]


def test_a_radar_that_was_silent_for_long_returns_in_the_others_time():
    """Without another radar it would be taken to follow its last scan by one revolution."""
    order, _ = beside(995.0, 997.5)
    later = intake.TimeOrder(1600.0)
    order, taken, reason = intake.admit_scan(order, 1601.0, 2.5, [later])
    assert (taken, reason, order.shift) == (True, '', 0.0)


def test_a_radar_whose_clock_is_another_is_never_taken():
    _, out = beside(5000.0, 5002.5, 5005.0, 5007.5)
    assert out == [(False, intake.CLOCKS_DIFFER)] * 4


def test_a_clock_that_was_set_for_one_radar_is_set_for_the_other():
    order, _ = beside(995.0, 997.5)
    moved = intake.TimeOrder(4000.0, shift=-2999.0)  # 1001 s of the tracker's time
    order, taken, reason = intake.admit_scan(order, 4001.5, 2.5, [moved])
    assert (taken, reason, order.shift) == (True, intake.REBASED, -2999.0)
    order, taken, reason = intake.admit_scan(order, 4004.0, 2.5, [moved])
    assert (taken, reason) == (True, '')


def test_a_repeated_scan_is_not_taken_for_all_that_others_say():
    _, out = beside(999.0, 999.0)
    assert out == [(True, ''), (False, intake.REPEATED)]
