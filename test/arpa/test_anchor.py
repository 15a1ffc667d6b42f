"""Own ship at anchor, and who may be a danger to her there."""

import numpy as np
import pytest

from marine_tracker.arpa.anchor import ANCHORED, DETECTED, UNDER_WAY, at_anchor, harmless
from marine_tracker.arpa.cpa import OwnMotion
from marine_tracker.arpa.motion import Motion
from marine_tracker.types import OwnShip


def lying(velocity, last_s=150.0):
    """Samples of own ship of velocity(times) [K, 2] m/s, and her motion."""
    times = np.arange(0.0, last_s, 1.0)
    made = np.broadcast_to(velocity(times), (len(times), 2)).astype(float)
    samples = OwnShip(times, np.cumsum(made, 0), made)
    return samples, OwnMotion(samples.position[-1], made[-1], 0.0, np.zeros((4, 4))), times[-1]


def swinging(time):
    """To and fro by .6 m/s in 100 s, as a ship does at the end of her chain."""
    return np.stack([0.6 * np.cos(2 * np.pi * time / 100), np.zeros(len(time))], 1)


STILL = lying(lambda time: [0.02, -0.05])
SWINGS = lying(swinging)
CREEPS = lying(lambda time: [0.0, 0.6])
SAILS = lying(lambda time: [3.0, 4.0])


@pytest.mark.parametrize(
    ('own', 'detected', 'stated'),
    [(STILL, True, True), (SWINGS, True, True), (CREEPS, False, True), (SAILS, False, False)],
)
def test_at_anchor_is_who_makes_no_way_or_says_so_and_is_slow(own, detected, stated):
    assert at_anchor(*own, DETECTED) is detected
    assert at_anchor(*own, ANCHORED) is stated
    assert at_anchor(*own, UNDER_WAY) is False


def test_a_ship_that_has_just_stopped_swinging_into_view_is_not_taken_as_anchored():
    samples, own, now = lying(swinging, last_s=40.0)
    assert not at_anchor(samples, own._replace(velocity=np.array([0.6, 0.0])), now)


def moving(position, velocity, sigma=0.1, stationary=False):
    count = len(position)
    zero = np.zeros(count)
    return Motion(
        np.array(position, float),
        np.array(velocity, float),
        np.tile(np.diag([100.0, 100.0, sigma**2, sigma**2]), (count, 1, 1)),
        zero.astype(int),
        zero,
        zero == 0,
        np.full(count, stationary),
    )


def test_only_who_surely_comes_nearer_may_be_a_danger():
    own = OwnMotion(np.array([100.0, 200.0]), np.zeros(2), 0.0, np.zeros((4, 4)))
    position = [[100.0, 2200.0]] * 4
    velocity = [[0.5, -5.0], [0.0, 5.0], [3.0, 0.0], [0.0, -0.25]]
    assert harmless(moving(position, velocity), own).tolist() == [False, True, True, True]
    assert harmless(moving(position, velocity, sigma=2.0), own).all() == np.True_
    assert harmless(moving(position, velocity, stationary=True), own).all()
