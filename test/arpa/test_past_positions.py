import numpy as np
import pytest

from marine_tracker.arpa.cpa import OwnMotion
from marine_tracker.arpa.motion import Motion
from marine_tracker.arpa.past_positions import begin, relative, step

PERIOD = 60 / 22
OWN_VELOCITY = np.array([3.0, 4.0])


def own_at(time):
    return np.array([100.0, 50.0]) + np.multiply.outer(time, OWN_VELOCITY)


def truth(id, time):
    """Position [..., 2] of target `id`, on a straight course of its own."""
    start, velocity = np.array([1000.0 * id, -500.0]), np.array([id - 3.0, 2.0])
    return start + np.multiply.outer(time, velocity), velocity


def follow(past, ids, now, first_time=0.0):
    position, velocity = (
        (np.array(column).reshape(-1, 2) for column in zip(*(truth(id, now) for id in ids)))
        if ids
        else (np.zeros((0, 2)), np.zeros((0, 2)))
    )
    none = np.zeros(len(ids), np.int64)
    return step(
        past,
        np.array(ids, np.int64),
        np.broadcast_to(first_time, len(ids)),
        Motion(
            position, velocity, np.zeros((len(ids), 4, 4)), none, 0.0 * none, none > 0, none > 0
        ),
        OwnMotion(own_at(now), OWN_VELOCITY, 0.0, np.zeros((4, 4))),
        now,
    )


def test_past_positions_are_equal_in_time_and_where_the_targets_were():
    past = begin(4, 30.0)
    for k in range(60):
        past = follow(past, [2, 5], k * PERIOD)
    now = 59 * PERIOD
    assert past.time.tolist() == [150.0, 120.0, 90.0, 60.0] and now - past.time[0] < 30.0
    for row, id in enumerate((2, 5)):
        np.testing.assert_allclose(past.position[row], truth(id, past.time)[0], atol=1e-9)
    np.testing.assert_allclose(past.own, own_at(past.time), atol=1e-9)


def test_relative_past_positions_are_offsets_from_where_own_ship_was():
    past = begin(4, 30.0)
    for k in range(60):
        past = follow(past, [2], k * PERIOD)
    np.testing.assert_allclose(
        relative(past)[0], truth(2, past.time)[0] - own_at(past.time), atol=1e-9
    )


def test_a_new_track_has_none_before_its_first_plot():
    past = begin(4, 30.0)
    for k in range(45):
        past = follow(past, [2], k * PERIOD)
    for k in range(45, 60):  # from 122.7 s on
        past = follow(past, [2, 7], k * PERIOD, first_time=np.array([0.0, 45 * PERIOD]))
    assert past.id.tolist() == [2, 7]
    assert np.isfinite(past.position[0]).all()
    assert np.isfinite(past.position[1]).all(1).tolist() == [True, False, False, False]


def test_rows_follow_the_tracks():
    past = begin(4, 30.0)
    for k in range(60):
        past = follow(past, [2, 5, 9], k * PERIOD)
    now = past
    past = follow(past, [9, 2], 60 * PERIOD)
    assert past.id.tolist() == [9, 2]
    np.testing.assert_array_equal(past.position, now.position[[2, 0]])
    assert follow(past, [], 61 * PERIOD).position.shape == (0, 4, 2)


def test_an_interval_shorter_than_a_scan():
    past = begin(10, 1.0)
    for k in range(12):
        past = follow(past, [2], k * PERIOD)
    np.testing.assert_array_equal(-np.diff(past.time), 1.0)
    np.testing.assert_allclose(past.position[0], truth(2, past.time)[0], atol=1e-9)


@pytest.mark.parametrize('jump', [-1000.0, 1000.0])
def test_the_past_begins_anew_when_time_jumps(jump):
    past = begin(4, 30.0)
    for k in range(60):
        past = follow(past, [2], k * PERIOD)
    past = follow(past, [2], 60 * PERIOD + jump, first_time=-2000.0)
    assert np.isfinite(past.time).tolist() == [True, False, False, False]
    np.testing.assert_allclose(past.position[0, 0], truth(2, past.time[0])[0], atol=1e-9)
    assert np.isnan(past.position[0, 1:]).all() and np.isnan(past.own[1:]).all()


def test_a_gap_within_what_is_kept_is_filled_along_the_course():
    past = begin(4, 30.0)
    for now in (0.0, 35.0, 110.0):
        past = follow(past, [2], now)
    assert past.time.tolist() == [90.0, 60.0, 30.0, 0.0]
    np.testing.assert_allclose(past.position[0], truth(2, past.time)[0], atol=1e-9)


@pytest.mark.parametrize(
    ('count', 'interval', 'message'),
    [
        (0, 30.0, 'number of past positions is 0'),
        (4, 0.0, 'interval of past positions is 0 s'),
        (4, np.nan, 'interval of past positions is nan s'),
        (4, np.inf, 'interval of past positions is inf s'),
    ],
)
def test_what_cannot_be_kept_is_an_error(count, interval, message):
    with pytest.raises(ValueError, match=message):
        begin(count, interval)
