"""Silence, wrong stamps and clocks that were set, told apart by another clock."""

import numpy as np
import pytest

from marine_tracker.tracking import intake

PERIOD = 60 / 24


class Radar:
    """Scans through the screen; `at` s: our clock, which the stamps follow `rate` times as fast."""

    def __init__(self, rate=1.0, own_ship=True, jitter=0.0):
        self.order, self.rate, self.own_ship = intake.TimeOrder(), rate, own_ship
        self.jitter, self.rng = jitter, np.random.default_rng(2)

    def hear(self, stamp, wrong=0.0, at=None, own=None):
        """(taken, reason, the tracker's time less the stamp)."""
        at = stamp / self.rate if at is None else at
        at += self.rng.uniform(0, self.jitter)
        own = stamp + PERIOD if own is None else own
        self.order, taken, reason = intake.admit_scan(
            self.order,
            stamp + wrong,
            PERIOD,
            arrival=at + PERIOD / self.rate,
            own=own if self.own_ship else np.nan,
        )
        return taken, reason, self.order.shift

    def sail(self, scans, first=0.0):
        for k in range(scans):
            assert self.hear(first + k * PERIOD)[0]
        return first + scans * PERIOD


@pytest.mark.parametrize('silence', [28, 35, 75, 140, 900])
def test_a_pause_as_long_as_our_clock_says_is_silence(silence):
    here = Radar(own_ship=False, jitter=0.8)
    now = here.sail(15) + silence
    assert [here.hear(now + k * PERIOD) for k in range(4)] == [(True, '', 0.0)] * 4


@pytest.mark.parametrize('rate', [0.4, 6.0, 50.0])
@pytest.mark.parametrize('silence', [28, 35, 75, 140, 550])
def test_at_another_rate_own_ships_stamps_tell_of_silence(rate, silence):
    here = Radar(rate)
    now = here.sail(15) + silence
    assert [here.hear(now + k * PERIOD) for k in range(4)] == [(True, '', 0.0)] * 4


@pytest.mark.parametrize('rate', [1.0, 40.0])
@pytest.mark.parametrize('ahead', [5, 8, 13, 21, 30, 500])
def test_one_stamp_ahead_costs_its_scan_and_moves_nothing(rate, ahead):
    here = Radar(rate)
    now = here.sail(15)
    assert here.hear(now, wrong=ahead) == (False, intake.JUMPED_AHEAD, 0.0)
    assert [here.hear(now + k * PERIOD) for k in range(1, 4)] == [(True, '', 0.0)] * 3


def test_what_waited_in_a_queue_while_we_were_stopped_is_taken_at_once():
    here = Radar(own_ship=False)
    now, woken = here.sail(15), 15 * PERIOD + 47
    late = [now + k * PERIOD for k in range(8, 18)]  # the last ten
    assert [here.hear(stamp, at=woken) for stamp in late] == [(True, '', 0.0)] * 10


@pytest.mark.parametrize('jump', [55.0, 3600.0, -20.0, -40000.0])
def test_a_clock_that_was_set_is_told_from_silence_by_ours_and_the_tracks_stand_not_still(jump):
    """Also where own ship has the same clock; time goes on by ours meanwhile."""
    here = Radar()
    now = here.sail(15)
    outcome = [here.hear(now + k * PERIOD + jump, at=now + k * PERIOD) for k in range(4)]
    assert [taken for taken, *_ in outcome] == [False, False, True, True]
    assert outcome[2][1] == intake.REBASED and outcome[3][1] == ''
    assert here.order.shift == pytest.approx(-jump, abs=0.01)


def test_a_recording_that_begins_again_goes_on_by_one_revolution():
    here = Radar(rate=20.0)
    now = here.sail(15)
    outcome = [here.hear(k * PERIOD, at=(now + k * PERIOD) / 20) for k in range(4)]
    assert [reason for _, reason, _ in outcome] == [
        intake.WENT_BACK,
        intake.WENT_BACK,
        intake.REBASED,
        '',
    ]
    assert here.order.last + here.order.shift == pytest.approx(now + 3 * PERIOD)


def test_a_jump_that_no_clock_can_judge_waits_for_a_second_scan():
    here = Radar(rate=30.0, own_ship=False)
    now = here.sail(15) + 20
    assert here.hear(now, at=now / 30 - 0.5) == (False, intake.JUMPED_AHEAD, 0.0)
    assert here.hear(now + PERIOD)[:2] == (True, '')


def test_a_wrong_stamp_near_another_radars_time_is_held_up_all_the_same():
    other = intake.TimeOrder()
    here = Radar(own_ship=False)
    for k in range(15):
        here.hear(k * PERIOD)
        other, *_ = intake.admit_scan(
            other, k * PERIOD + 1, PERIOD, arrival=k * PERIOD + 1 + PERIOD
        )
    now = 15 * PERIOD
    _, taken, reason = intake.admit_scan(
        here.order, now + 12, PERIOD, [other], arrival=now + PERIOD
    )
    assert (taken, reason) == (False, intake.JUMPED_AHEAD)
