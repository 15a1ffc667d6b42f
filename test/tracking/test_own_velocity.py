"""Own ship's velocity as told against that of her positions."""

import numpy as np
import pytest

from marine_tracker.tracking import own_ship, own_velocity


def sailed(seconds, period, velocity_of, told_of, noise=0.0, seed=1, jump=None):
    """The log after `seconds` s of samples; noise m of the positions; jump: (s, [2] m)."""
    rng = np.random.default_rng(seed)
    log, offs = own_ship.empty_log(), []
    time = np.arange(0.0, seconds, period)
    fine = np.linspace(0, seconds, 20001)
    path = np.concatenate(
        [np.zeros((1, 2)), np.cumsum(np.array([velocity_of(t) for t in fine[:-1]]) * fine[1], 0)]
    )
    for t in time:
        at = np.array([np.interp(t, fine, column) for column in path.T])
        at += rng.normal(0, noise, 2) if noise else 0
        if jump and t >= jump[0]:
            at += jump[1]
        log, reason = own_ship.admit_own_ship(log, t, at, np.array(told_of(t), float), t)
        assert reason == ''
        offs.append(log.off)
    return log, np.array(offs)


def turning(t):
    course = np.radians(20 + 1.5 * t)
    return 7.0 * np.sin(course), 7.0 * np.cos(course)


def test_a_twist_that_is_right_is_believed_through_turns_and_noise():
    for seed in range(20):
        for period, noise in ((0.1, 0.5), (1.0, 2.5)):
            log, offs = sailed(60, period, turning, turning, noise, seed)
            assert not offs.any()
            velocity, known = own_velocity.chosen(log.taken, log.off, 'auto')
            assert known and velocity[-1] == pytest.approx(turning(log.taken.time[-1]))


@pytest.mark.parametrize('period', [0.1, 1.0, 2.5])
@pytest.mark.parametrize('told', [lambda t: (0.0, 0.0), lambda t: (-5.5, 2.0)])
def test_a_twist_that_is_wrong_is_found_within_13_s(period, told):
    log, offs = sailed(13, period, lambda t: (1.0, 5.5), told, 0.3)
    assert offs[-1] == pytest.approx(np.hypot(*np.subtract((1.0, 5.5), told(0))), abs=0.6)
    velocity, _ = own_velocity.chosen(log.taken, log.off, 'auto')
    assert velocity[-1] == pytest.approx((1.0, 5.5), abs=0.5)
    assert own_velocity.chosen(log.taken, log.off, 'twist')[0][-1] == pytest.approx(told(0))


def test_positions_that_jump_once_do_not_put_the_twist_in_doubt():
    _, offs = sailed(40, 0.5, lambda t: (3.0, -4.0), lambda t: (3.0, -4.0), 0.2, jump=(20, 35.0))
    assert not offs.any()


def test_a_twist_once_found_wrong_is_believed_again_when_it_agrees_under_way():
    def velocity(t):
        return (4.0, 0.0) if t < 20 or t >= 60 else (0.0, 0.0)

    def told(t):
        return (0.0, 0.0) if t < 40 else velocity(t)

    _, offs = sailed(90, 0.5, velocity, told)
    assert offs[30] and offs[100] and not offs[-1]  # at rest anything agrees


def test_without_a_twist_the_positions_tell_also_in_a_turn():
    log, _ = sailed(40, 0.5, turning, lambda t: (np.nan, np.nan), 0.2)
    velocity, known = own_velocity.chosen(log.taken, log.off, 'auto')
    assert not known  # the first samples
    assert velocity[-1] == pytest.approx(turning(39.5), abs=0.4)
    sailing, fallback = own_ship.own_ship_for(log, 37.0, 39.7, 10.0)
    assert fallback == '' and np.hypot(*sailing.velocity.T) == pytest.approx(7.0, abs=0.4)


@pytest.mark.parametrize('ahead', [5.0, 17.0, 29.0, 4000.0])
def test_one_stamp_ahead_moves_own_ship_nowhere(ahead):
    log = own_ship.empty_log()
    for k in range(60):
        wrong = ahead if k == 40 else 0.0
        at = np.array([0.0, 0.6 * k])
        log, reason = own_ship.admit_own_ship(
            log, 0.1 * k + wrong, at, np.array([0.0, 6.0]), 0.1 * k
        )
        assert reason == (own_ship.OWN_JUMPED_AHEAD if wrong else '')
    assert log.taken.time[-1] == pytest.approx(5.9) and len(log.taken.time) == 59


def test_own_ship_that_was_silent_as_long_as_the_clock_says_is_taken_at_once():
    log = own_ship.empty_log()
    for t in (0.0, 0.5, 1.0, 1.5, 2.0, 77.0, 77.5):
        log, reason = own_ship.admit_own_ship(log, t, np.array([t, 0.0]), np.array([1.0, 0.0]), t)
        assert reason == ''
