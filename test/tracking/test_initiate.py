import itertools

import numpy as np
import pytest

from marine_tracker.tracking.existence import ratio_of_two
from marine_tracker.tracking.expected import reach
from marine_tracker.tracking.initiate import pair_up
from marine_tracker.types import Plots

PERIOD = 60 / 22
SPEED = 20.0
SIGMA = 10.0


def plots(position, time=0.0, sigma=SIGMA):
    position = np.reshape(np.asarray(position, float), (-1, 2))
    count = len(position)
    distance = np.hypot(*position.T)
    return Plots(
        np.full(count, time),
        distance,
        np.arctan2(*position.T),
        np.zeros(count),
        np.zeros((count, 2)),
        position,
        np.tile(sigma**2 * np.eye(2), (count, 1, 1)),
    )


def pairs(before, now, free=None, room=100, max_speed=SPEED, chosen=None):
    """What `pair_up` makes of all pairs, or those chosen."""
    all_pairs = itertools.product(range(len(before.time)), range(len(now.time)))
    candidates = np.array(list(all_pairs) if chosen is None else chosen, np.int64).reshape(-1, 2)
    free = np.ones(len(now.time), bool) if free is None else np.asarray(free)
    first, second = pair_up(before, now, candidates[:, 0], candidates[:, 1], free, max_speed, room)
    return list(zip(first.tolist(), second.tolist()))


@pytest.mark.parametrize(
    ('speed', 'fits'),
    [(0.001, True), (10.0, True), (20.0, True), (30.0, True), (45.0, False), (80.0, False)],
)
def test_two_plots_begin_a_track_unless_the_target_were_too_fast(speed, fits):
    """20 m/s allowed, and noise of 14 m between the plots makes up for 12 m/s more at most 99 %."""
    course = 1.1
    way = speed * PERIOD * np.array([np.sin(course), np.cos(course)])
    found = pairs(plots([[1000, 500]]), plots([[1000, 500] + way], PERIOD))
    assert found == ([(0, 0)] if fits else [])


def test_noise_excuses_less_where_there_is_less_of_it():
    before, now = plots([[0, 900]], sigma=1.0), plots([[25 * PERIOD, 900]], PERIOD, sigma=1.0)
    assert pairs(before, now) == []
    assert pairs(before, now, max_speed=26.0) == [(0, 0)]


def test_slow_pairs_of_a_long_gap_fit():
    assert pairs(plots([[0, 900]]), plots([[150, 900]], 10.0)) == [(0, 0)]
    assert pairs(plots([[0, 900]]), plots([[150, 900]], 2.0)) == []


@pytest.mark.parametrize('later', [0.0, -1.0])
def test_time_must_have_passed_between_the_plots(later):
    assert pairs(plots([[0, 900]], 5.0), plots([[1, 900]], 5.0 + later)) == []


@pytest.mark.filterwarnings('error')
def test_plots_at_one_place_are_a_target_at_rest():
    assert pairs(plots([[300, 900]]), plots([[300, 900]], PERIOD)) == [(0, 0)]


def test_every_plot_begins_one_track_at_most():
    rng = np.random.default_rng(3)
    before, now = plots(rng.uniform(0, 120, (30, 2))), plots(rng.uniform(0, 120, (25, 2)), PERIOD)
    found = pairs(before, now)
    first, second = zip(*found)
    assert len(set(first)) == len(first) and len(set(second)) == len(second)
    assert len(found) > 15


def test_the_slowest_pair_comes_first():
    before, now = plots([[0, 900], [40, 900]]), plots([[38, 900], [80, 900]], PERIOD)
    assert sorted(pairs(before, now)) == [(1, 0)] or sorted(pairs(before, now)) == [(0, 1), (1, 0)]
    assert (1, 0) in pairs(before, now)


def test_plots_that_a_track_explains_begin_none():
    before, now = plots([[0, 900], [0, 2000]]), plots([[1, 900], [1, 2000]], PERIOD)
    assert pairs(before, now, free=[False, True]) == [(1, 1)]


def test_only_the_pairs_offered_are_used():
    before, now = plots([[0, 900], [0, 2000]]), plots([[1, 900], [1, 2000]], PERIOD)
    assert pairs(before, now, chosen=[(1, 1)]) == [(1, 1)]
    assert pairs(before, now, chosen=[]) == []


@pytest.mark.parametrize('room', [0, 1, 3])
def test_no_more_tracks_begin_than_there_is_room_for(room):
    place = np.array([[0, 900], [0, 2000], [0, 3000], [0, 4000], [0, 5000]], float)
    found = pairs(plots(place), plots(place + 3.0, PERIOD), room=room)
    assert len(found) == room
    assert all(a == b for a, b in found)


def test_no_plots_no_pairs():
    none = plots(np.zeros((0, 2)))
    assert pairs(none, plots([[1, 2]], PERIOD)) == []
    assert pairs(plots([[1, 2]]), none) == []


def test_targets_within_their_speed_are_within_reach():
    """Fastest targets, any course, noise: nearly all second plots within the gate of 99.9 %."""
    rng = np.random.default_rng(5)
    count = 4000
    start = plots(rng.normal(0, SIGMA, (count, 2)))
    course = rng.uniform(0, 2 * np.pi, count)
    way = SPEED * PERIOD * np.stack([np.sin(course), np.cos(course)], 1)
    apart = way + rng.normal(0, SIGMA, (count, 2)) - start.position
    spread = reach(start, PERIOD, SPEED) + SIGMA**2 * np.eye(2)
    distance = np.einsum('ni,ni->n', apart, np.linalg.solve(spread, apart[..., None])[..., 0])
    assert np.mean(distance < 13.8) > 0.999


def worth(before, now, density, speed=SPEED):
    """Log-odds of a pair where a target begins for every two hundred false plots of 1e-8 / m^2."""
    begins = np.array([5e-11])
    return np.log(ratio_of_two(before, now, np.array([density]), begins, speed, 0.8))[0]


def test_a_pair_in_dense_clutter_is_worth_less():
    """Twice: its first plot is likelier clutter, and so is its second."""
    before, now = plots([[0, 900]]), plots([[20, 900]], PERIOD)
    sparse, dense = (worth(before, now, density) for density in (1e-8, 1e-5))
    assert sparse - dense == pytest.approx(2 * np.log(1000))
    assert sparse > 0


def test_a_second_plot_that_could_lie_anywhere_is_worth_less():
    before = plots([[0, 900]])
    near = worth(before, plots([[20, 900]], PERIOD), 1e-7)
    late = worth(before, plots([[20, 900]], 10 * PERIOD), 1e-7)
    fast = worth(before, plots([[20, 900]], PERIOD), 1e-7, 5 * SPEED)
    assert late < near and fast < near
