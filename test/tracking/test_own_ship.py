import numpy as np
import pytest

from marine_tracker.geometry import KNOT
from marine_tracker.tracking import own_ship


def run_own_ship(samples):
    log, reasons = own_ship.empty_log(), []
    for time, east, north, *velocity in samples:
        log, reason = own_ship.admit_own_ship(
            log, time, np.array([east, north]), np.array(velocity or [0.0, 5.0])
        )
        reasons.append(reason)
    return log, reasons


@pytest.mark.parametrize(
    'bad, reason',
    [
        ((3.0, np.nan, 0.0), own_ship.OWN_NOT_FINITE),
        ((3.0, 1e12, 0.0), own_ship.OWN_NOT_FINITE),
        ((np.inf, 0.0, 0.0), own_ship.OWN_NOT_FINITE),
        ((3.0, 0.0, 15.0, np.inf, 0.0), own_ship.OWN_NOT_FINITE),
        ((2.0, 0.0, 10.0), own_ship.OWN_REPEATED),
        ((1.5, 0.0, 10.0), own_ship.OWN_WENT_BACK),
        ((3.0, 5000.0, 15.0), own_ship.OWN_TELEPORTED),
        ((3.0, 0.0, 15.0, 101 * KNOT, 0.0), own_ship.OWN_TELEPORTED),
    ],
)
def test_a_bad_own_ship_sample_is_left_out(bad, reason):
    log, reasons = run_own_ship([(1.0, 0.0, 5.0), (2.0, 0.0, 10.0), bad, (4.0, 0.0, 20.0)])
    assert reasons == ['', '', reason, '']
    assert log.taken.time.tolist() == [1.0, 2.0, 4.0]


def test_own_ship_elsewhere_for_good_is_believed_after_five_samples():
    there = [(3.0 + k, 90e3, 5.0 * k) for k in range(6)]
    log, reasons = run_own_ship([(1.0, 0.0, 5.0), (2.0, 0.0, 10.0), *there])
    assert reasons == ['', ''] + [own_ship.OWN_TELEPORTED] * 4 + [own_ship.OWN_REBASED, '']
    assert log.taken.position[-1].tolist() == [90e3, 25.0]
    assert log.taken.time[0] == 3.0


def test_own_ship_that_teleports_to_and_fro_is_never_believed():
    samples = [(1.0 + k, 80e3 * (k % 3), 0.0) for k in range(1, 30)]
    log, reasons = run_own_ship([(1.0, 0.0, 0.0), *samples])
    assert own_ship.OWN_REBASED not in reasons
    assert (log.taken.position[:, 0] == 0).all()


def test_the_log_does_not_grow_for_ever():
    log, _ = run_own_ship([(0.1 * k, 0.0, 0.5 * k) for k in range(own_ship.MAX_OWN_SAMPLES + 100)])
    assert len(log.taken.time) == own_ship.MAX_OWN_SAMPLES


def test_own_ship_during_a_scan_is_what_lies_around_it():
    log, _ = run_own_ship([(0.1 * k, 0.0, 0.5 * k) for k in range(100)])
    sailed, fallback = own_ship.own_ship_for(log, 2.05, 4.0, 10.0)
    assert fallback == ''
    assert sailed.time[0] <= 2.05 and sailed.time[-1] >= 4.0
    assert len(sailed.time) < 25


def test_a_silent_own_ship_is_taken_at_rest_where_it_was():
    log, _ = run_own_ship([(1.0, 0.0, 5.0), (2.0, 0.0, 10.0)])
    assert own_ship.own_ship_for(log, 11.0, 13.0, 10.0)[1] == ''
    sailed, fallback = own_ship.own_ship_for(log, 12.1, 14.0, 10.0)
    assert fallback == own_ship.OWN_SILENT
    assert sailed.position.tolist() == [[0.0, 10.0]] and not sailed.velocity.any()


def test_own_ship_never_heard_is_taken_at_rest_at_the_origin():
    sailed, fallback = own_ship.own_ship_for(own_ship.empty_log(), 5.0, 7.0, 10.0)
    assert fallback == own_ship.OWN_NEVER_HEARD
    assert not sailed.position.any() and not sailed.velocity.any()


def heard(seconds):
    """A log of own ship who goes north-east, heard once a second, in time with our clock."""
    log = own_ship.empty_log()
    for t in np.arange(0.0, seconds):
        log, reason = own_ship.admit_own_ship(
            log, t, np.array([3.0, 4.0]) * t, np.array([3.0, 4.0]), t + 500, np.radians(40.0)
        )
        assert not reason
    return log


def test_lost_positions_go_on_without_a_jump_then_through_the_water():
    log, water, timeout = heard(30), np.array([2.0, 4.5]), 6.0
    for end in (31.0, 33.5, 35.0):
        assert own_ship.reckoned(log, end, end + 500, timeout, water, 0.7) is log  # not late yet
    log = own_ship.reckoned(log, 36.0, 536.0, timeout, water, 0.7)
    assert log.reckoned and log.taken.position[-1] == pytest.approx([108.0, 144.0])
    log = own_ship.reckoned(log, 38.5, 538.5, timeout, water, 0.7)
    assert log.taken.position[-1] == pytest.approx([113.0, 155.25])
    sailed, fallback = own_ship.own_ship_for(log, 36.0, 38.5, timeout)
    assert fallback == '' and sailed.velocity[-1] == pytest.approx(water)
    assert sailed.heading == pytest.approx([0.7, 0.7])


def test_lost_positions_without_any_speed_go_on_as_she_went():
    unknown = np.full(2, np.nan)
    log = own_ship.reckoned(heard(20), 29.0, 529.0, 6.0, unknown, np.nan)
    log = own_ship.reckoned(log, 41.0, 541.0, 6.0, unknown, np.nan)
    assert log.taken.position[-1] == pytest.approx([123.0, 164.0])


def test_positions_that_come_back_are_taken_at_once_where_she_may_have_got():
    log = own_ship.reckoned(heard(20), 60.0, 560.0, 6.0, np.array([2.4, 4.2]), 0.7)
    log, reason = own_ship.admit_own_ship(
        log, 61.0, np.array([183.0, 244.0]), np.array([3.0, 4.0]), 561.0
    )
    assert reason == '' and not log.reckoned
    assert log.taken.position[-1].tolist() == [183.0, 244.0]


def test_silence_by_stamps_alone_is_not_reckoned_over():
    """Own ship on another clock: her stamps are old, and yet she was heard just now."""
    log = heard(20)
    assert own_ship.reckoned(log, 400.0, 520.0, 6.0, np.array([2.0, 2.0]), 0.7) is log
