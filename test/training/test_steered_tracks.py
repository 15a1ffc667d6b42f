"""Vessels that are steered by rudder, stick, or wind and anchor."""

import numpy as np
import pytest

from marine_tracker.training import steered_tracks
from marine_tracker.training.steered_tracks import SHIPS, SMALL_CRAFT, Steered

PERIOD = 60 / 22
KINDS = [*SHIPS.values(), *SMALL_CRAFT.values()]


def sail(kind, seed=3, count=40, scans=80):
    steps = np.full((count, scans), PERIOD)
    return steered_tracks.sail(kind, np.full(count, 5000.0), steps, np.random.default_rng(seed))


@pytest.mark.parametrize('kind', KINDS)
def test_velocity_is_the_way_made_and_speed_within_reason(kind):
    ships, hull = sail(kind)
    made = np.diff(ships.position, axis=1) / PERIOD
    between = 0.5 * (ships.velocity[:, 1:] + ships.velocity[:, :-1])
    off = np.hypot(*np.moveaxis(made - between, -1, 0))
    assert np.median(off) < 0.2 and np.percentile(off, 99) < 1.0  # a boat turns in between
    assert np.hypot(*np.moveaxis(ships.velocity, -1, 0)).max() < kind.speed[1] + 3.0
    assert (hull >= 0).all() and (hull.max() > 0) == (kind.hull > 0)
    again, _ = sail(kind)
    np.testing.assert_array_equal(again.position, ships.position)


def test_a_ship_at_hard_rudder_turns_as_nomoto_says():
    """The rudder hard over: after some time the rate of turn is K times the rudder."""
    count = 1
    own, state = steered_tracks._begin_rudder(
        np.full(count, 100.0),
        np.full(count, 8.0),
        8.0,
        np.full(count, 1e9),
        np.random.default_rng(1),
    )
    own |= {'by_hand': np.ones(count, bool), 'loss': np.zeros(count), 'sea': np.zeros(count)}
    helm = 0.2
    state = (*state[:6], np.full(count, helm), state[7])
    own['calm'] = np.full(count, np.inf)
    for _ in range(2000):
        state, _ = steered_tracks._move_rudder(
            own, state, np.full(count, 0.5), np.random.default_rng(2)
        )
    assert state[1] == pytest.approx(own['gain'] * 8.0 / 100.0 * helm, rel=1e-3)


def test_what_is_moored_stays():
    ships, _ = sail(Steered('moored', (20.0, 100.0), (0.0, 0.0), (60.0, 300.0)), scans=200)
    moved = np.hypot(*np.moveaxis(ships.position - ships.position[:, :1], -1, 0))
    assert moved.max() < 400.0  # a chain's length, two hulls, and what the wind did


def test_no_vessel_is_faster_than_asked():
    steps = np.full((30, 60), PERIOD)
    ships, _ = steered_tracks.sail(
        SHIPS['stick'], np.full(30, 3000.0), steps, np.random.default_rng(4), fastest=6.0
    )
    assert np.hypot(*np.moveaxis(ships.velocity, -1, 0)).max() <= 6.0 + 1e-9
