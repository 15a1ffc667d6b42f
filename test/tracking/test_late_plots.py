"""Plots that come late, against the same plots in the order of their times."""

import numpy as np
import pytest

from marine_tracker.estimators import ESTIMATORS
from marine_tracker.estimators.gwnn import gwnn
from marine_tracker.geometry import polar_to_position
from marine_tracker.parameters import TrackerParameters
from marine_tracker.tracking import late_plots
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import Plots, take

RADARS = '[{topic: a, scan_period_s: 2.0}, {topic: b, scan_period_s: 2.5}]'


def plots_of(targets, time, rng, radial_speed=None):
    """A plot of each target at its time [N] s; targets cross at 7 m/s."""
    count = len(time)
    bearing = np.linspace(0.3, 6.0, targets)[:count] + rng.normal(0, 0.008, count)
    distance = 3000.0 + 7.0 * time + rng.normal(0, 15, count)
    position, covariance = polar_to_position(distance, bearing, 15.0, 0.008)
    return Plots(
        time,
        distance,
        bearing,
        np.zeros(count),
        np.zeros((count, 2)),
        position,
        covariance,
        radial_speed,
    )


def tracks_of(estimator, plots, updates=3):
    tracker = Tracker(TrackerParameters(radars=RADARS), estimator)
    tracks = tracker._begin(plots, 1, 0)
    return tracks._replace(past=late_plots.nothing_yet(tracks.state, plots, updates))


@pytest.fixture(params=[name for name in ESTIMATORS])
def estimator(request):
    return ESTIMATORS[request.param](TrackerParameters(estimator=request.param))


def same(one, other):
    """Equal to rounding; the outputs of the network of `gwnn`, of 32 bits, to that of 32 bits."""
    if isinstance(one, gwnn.GwnnState):
        np.testing.assert_allclose(one.output, other.output, atol=3e-6)
        one, other = one._replace(output=None), other._replace(output=None)
    if isinstance(one, tuple):
        for a, b in zip(one, other, strict=True):
            same(a, b)
    elif one is not None:
        np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-6)


def test_late_plots_end_where_the_plots_sorted_by_time_do(estimator):
    """Each of 40 targets gets its plots in an order of its own, up to three places late."""
    rng = np.random.default_rng(4)
    targets, count = 40, 14
    times = np.sort(rng.uniform(1, 40, (count, targets)), 0)
    every = [plots_of(targets, time, rng) for time in times]
    comes = np.argsort(np.arange(count)[:, None] + rng.uniform(0, 3.9, (count, targets)), 0)
    assert (np.maximum.accumulate(comes, 0) - comes).max() == 3
    tracks = tracks_of(estimator, plots_of(targets, np.zeros(targets), rng))
    expected = tracks.state
    rows = np.arange(targets)
    for plots in every:
        expected = estimator.update(expected, plots, rows)
    stack = Plots(*(None if c[0] is None else np.stack(c) for c in zip(*every)))
    for turn in comes:
        plots = Plots(*(None if c is None else c[turn, rows] for c in stack))
        some = rng.random(targets) < 0.5  # a scan's plots come in any company
        for part in (np.flatnonzero(some), np.flatnonzero(~some)):
            tracks = late_plots.update(estimator, tracks, take(plots, part), part, 1)
    same(tracks.state, expected)


def test_the_past_is_seen_as_it_was(estimator):
    rng = np.random.default_rng(5)
    tracks = tracks_of(estimator, plots_of(3, np.zeros(3), rng))
    states = [tracks.state]
    for time in (2.0, 4.0, 6.0):
        tracks = late_plots.update(
            estimator, tracks, plots_of(3, np.full(3, time), rng), np.arange(3), 0
        )
        states.append(tracks.state)
    seen = late_plots.as_of(tracks, np.array([7.0, 4.5, 1.0]))
    for row, wanted in enumerate((3, 2, 0)):
        same(take(seen, slice(row, row + 1)), take(states[wanted], slice(row, row + 1)))


def test_a_plot_older_than_all_that_is_remembered_still_counts(estimator):
    rng = np.random.default_rng(6)
    tracks = tracks_of(estimator, plots_of(3, np.zeros(3), rng), updates=1)
    for time in (2.0, 4.0, 6.0, 1.0):
        tracks = late_plots.update(
            estimator, tracks, plots_of(3, np.full(3, time), rng), np.arange(3), 0
        )
    found = estimator.extrapolate(tracks.state, np.full(3, 8.0))
    assert np.isfinite(found.position).all() and np.isfinite(found.covariance).all()
    assert (np.hypot(*found.position.T) < 3500).all()


def test_plots_with_and_without_a_radial_speed_mix():
    estimator = ESTIMATORS['imm'](TrackerParameters())
    rng = np.random.default_rng(7)
    tracks = tracks_of(estimator, plots_of(3, np.zeros(3), rng))
    for time, speed in ((2.0, None), (4.0, np.full(3, 7.0)), (3.0, None), (3.5, np.full(3, 7.0))):
        tracks = late_plots.update(
            estimator, tracks, plots_of(3, np.full(3, time), rng, speed), np.arange(3), 0
        )
    assert (tracks.state.time == 4.0).all()
