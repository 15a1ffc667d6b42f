"""Duplicates end, neighbours live: whole scans, with the plots as they come."""

import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters
from marine_tracker.tracking.lifecycle import REASONS
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import append, take

ESTIMATORS = ['cs_kalman', 'imm']


def follow(tracker, scans, memory=None):
    """Memory after the scans, and every report."""
    memory = tracker.start() if memory is None else memory
    reports = []
    for scan in scans:
        memory, report = tracker.step(memory, scan)
        reports.append(report)
    return memory, reports


@pytest.fixture(params=ESTIMATORS)
def tracker(request):
    return Tracker(TrackerParameters(estimator=request.param))


@pytest.mark.parametrize('seed', range(6))
def test_two_tracks_on_one_target_become_one(tracker, revolution, seed):
    """The second one is put there by hand: the first once more, confirmed, with its own number.

    On a clean sea the two have one plot between them; within 30 scans (80 s) one is gone.
    """
    rng = np.random.default_rng(seed)
    position, velocity = [[2000.0, 1000.0], [-3000.0, 500.0]], [[5.0, 2.0], [0.0, -6.0]]
    scans = [revolution(k, position, velocity, rng=rng) for k in range(40)]
    memory, _ = follow(tracker, scans[:10])
    assert sorted(memory.tracks.number) == [1, 2]
    double = take(memory.tracks, np.array([0]))
    double = double._replace(id=np.array([memory.next_id]), number=np.array([3]))
    memory = memory._replace(
        tracks=append(memory.tracks, double), next_id=memory.next_id + 1, next_number=4
    )
    memory, reports = follow(tracker, scans[10:], memory)
    ends = [
        REASONS[reason]
        for report in reports
        for reason in report.reason[(report.reason > 0) & (report.tracks.number > 0)]
    ]
    assert len(memory.tracks.id) == 2
    assert ends in (['merged'], ['missed'])
    estimate = tracker.extrapolate(memory.tracks, scans[-1].end).position
    truth = np.array(position) + scans[-1].end * np.array(velocity)
    apart = np.hypot(*(estimate[:, None] - truth).transpose(2, 0, 1)).min(0)
    assert (apart < 100).all()


def numbers_through(tracker, scans, settled=8):
    """The sets of confirmed numbers after each scan past the first few."""
    memory, seen = tracker.start(), []
    for k, scan in enumerate(scans):
        memory, _ = tracker.step(memory, scan)
        if k >= settled:
            seen.append(tuple(sorted(memory.tracks.number[memory.tracks.number > 0].tolist())))
    return set(seen)


@pytest.mark.parametrize('gap', [120.0, 200.0, 400.0])
def test_two_ships_in_company_stay_two(tracker, revolution, gap):
    """Abreast at 2 km, one course: `gap` apart, 8 and more deviations of a plot's range."""
    rng = np.random.default_rng(11)
    position = [[0.0, 2000.0], [0.0, 2000.0 + gap]]
    scans = [revolution(k, position, [[6.0, 0.0]] * 2, rng=rng) for k in range(100)]
    assert numbers_through(tracker, scans) == {(1, 2)}


@pytest.mark.parametrize('angle_deg', [60, 90, 180])
def test_two_ships_that_cross_stay_two(tracker, revolution, angle_deg):
    """They pass through one place half way; each is then near its own truth."""
    rng = np.random.default_rng(12)
    scans = 100
    half = 50 * 60 / 22
    angle = np.radians(angle_deg)
    velocity = 8.0 * np.array([[1.0, 0.0], [np.cos(angle), np.sin(angle)]])
    position = np.array([500.0, 1800.0]) - half * velocity
    flow = [revolution(k, position, velocity, rng=rng) for k in range(scans)]
    assert numbers_through(tracker, flow) == {(1, 2)}
    memory, _ = follow(tracker, flow)
    found = tracker.extrapolate(memory.tracks, flow[-1].end)
    truth = position + flow[-1].end * velocity
    for place, speed in zip(truth, velocity):
        row = np.argmin(np.hypot(*(found.position - place).T))
        assert np.hypot(*(found.position[row] - place)) < 80
        assert np.hypot(*(found.velocity[row] - speed)) < 4


def test_a_ship_that_overtakes_another_closely_does_not_swallow_it(tracker, revolution):
    rng = np.random.default_rng(13)
    velocity = np.array([[4.0, 0.0], [10.0, 0.0]])
    position = np.array([[-400.0, 1500.0], [-1300.0, 1640.0]])
    scans = [revolution(k, position, velocity, rng=rng) for k in range(110)]
    assert numbers_through(tracker, scans) == {(1, 2)}
