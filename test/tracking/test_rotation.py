"""How an antenna turns, told by its plots."""

import numpy as np
import pytest

from marine_tracker.geometry import wrap_angle, wrap_bearing
from marine_tracker.tracking import rotation

NOISE = np.radians(0.6)


def listen(period, spacing, stated, targets, messages, phase=0.8, seed=2, jitter=0.0):
    """What is known after so many messages; `targets` bearings, rad, give plots in each turn."""
    rng = np.random.default_rng(seed)
    turn = 2 * np.pi
    known = rotation.begin()
    bearings = np.asarray(targets)
    first = np.mod(bearings - phase, turn) / turn * period
    for k in range(messages):
        start, end = k * spacing, (k + 1) * spacing
        turns = np.ceil((start - first) / period)
        time = first + turns * period
        now = time < end
        seen = bearings[now] + rng.normal(0, NOISE, now.sum())
        known = rotation.hear(
            known, start, time[now] + rng.normal(0, jitter, now.sum()), seen, stated, spacing
        )
    return known


@pytest.mark.parametrize('count', [4, 16, 27.3])
@pytest.mark.parametrize('stated', [2.1, 2.73, 3.4])
def test_sectors_of_any_size_tell_period_and_direction(count, stated):
    period = 2.5
    targets = np.random.default_rng(5).uniform(0, 2 * np.pi, 12)
    known = listen(period, period / count, stated, targets, int(3 * count))
    assert known.period == pytest.approx(period, rel=2e-3)
    start = 41 * period / count
    part = known.sector(start, start + period / count)
    assert part.angle == pytest.approx(2 * np.pi / count, rel=2e-3)
    assert wrap_angle(part.bearing - 0.8 - 2 * np.pi * start / period) == pytest.approx(0, abs=0.03)


def test_a_lone_target_leaves_the_period_to_the_one_stated():
    known = listen(2.6, 2.6 / 8, 2.4, [1.1], 48)
    assert known.period == pytest.approx(2.6, rel=5e-3)


def test_whole_revolutions_of_a_fast_radar_are_no_sectors():
    targets = np.random.default_rng(6).uniform(0, 2 * np.pi, 9)
    known = listen(1.25, 1.25, 2.73, targets, 20)
    assert known.period == pytest.approx(1.25, rel=2e-3)
    assert known.sector(10.0, 11.25) is None


def test_nothing_is_known_of_plots_that_follow_no_rotation():
    rng = np.random.default_rng(9)
    known = rotation.begin()
    for k in range(60):
        time = k * 0.2 + rng.uniform(0, 0.2, 4)
        bearing = wrap_bearing(rng.uniform(0, 2 * np.pi, 4))
        known = rotation.hear(known, k * 0.2, time, bearing, 2.5, 0.2)
        assert not known.known
