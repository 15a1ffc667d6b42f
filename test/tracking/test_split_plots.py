"""Two plots of one ship: fused before the track takes them, and no second track beside it."""

import dataclasses

import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import split_plots
from marine_tracker.tracking.gate import Pairs
from marine_tracker.tracking.lifecycle import COASTING, CONFIRMED
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import Plots, PolarPlots

RADAR = TrackerParameters(range_resolution_m=30.0, beam_width_deg=1.0, glint_sigma_m=0.0)

EMPTY = np.full(2, 1e-8)  # sea


def plots_at(*places):
    at, zero = np.array(places, float), np.zeros(len(places))
    bearing = np.arctan2(*at.T)
    covariance = np.tile(80.0 * np.eye(2), (len(places), 1, 1))
    return Plots(zero, np.hypot(*at.T), bearing, zero, np.zeros_like(at), at, covariance)


def pairs_of(*gates):
    """Pairs of tracks with the plots in their gates."""
    track = np.arange(len(gates)).repeat([len(gate) for gate in gates])
    plot = np.concatenate(gates)
    return Pairs(track, plot, np.ones(len(plot)), np.zeros(len(plot)))


def test_plots_of_one_cell_that_one_track_claims_are_fused():
    plots = plots_at((0.0, 3000.0), (20.0, 3010.0))
    found = split_plots.fused(pairs_of([0, 1]), np.array([0]), plots, EMPTY, RADAR)
    assert found.position[0] == pytest.approx([10.0, 3005.0])
    assert found.range[0] == pytest.approx(np.hypot(10.0, 3005.0))
    assert (found.position[1] == plots.position[1]).all()


def test_among_many_false_plots_one_that_lies_near_is_not_fused():
    plots = plots_at((0.0, 3000.0), (20.0, 3010.0))
    found = split_plots.fused(pairs_of([0, 1]), np.array([0]), plots, 1e3 * EMPTY, RADAR)
    assert (found.position == plots.position).all()


@pytest.mark.parametrize(
    ('gates', 'plot_of', 'other'),
    [
        ([[0, 1], [1]], [0, 1], (20.0, 3010.0)),  # two tracks: each its own
        ([[0, 1], [0, 1]], [0, -1], (20.0, 3010.0)),  # two tracks, and one plot taken
        ([[0, 1]], [0], (20.0, 3040.0)),  # deeper than a cell
        ([[0, 1]], [0], (60.0, 3000.0)),  # wider: a degree at 3,000 m is 52 m
        ([[0]], [0], (5.0, 3000.0)),  # outside the gate
    ],
)
def test_plots_that_may_be_of_two_targets_stay_two(gates, plot_of, other):
    plots = plots_at((0.0, 3000.0), other)
    found = split_plots.fused(pairs_of(*gates), np.array(plot_of), plots, EMPTY, RADAR)
    assert (found.position == plots.position).all()


def test_no_track_begins_beside_a_plot_that_was_taken_or_begins_another():
    plots = plots_at((0, 3000), (10, 3005), (400, 3000), (410, 2990), (900, 3000))
    found = split_plots.alone(np.array([1, 2, 3, 4]), np.array([-1, 0]), plots, RADAR)
    assert found.tolist() == [False, True, False, True]
    assert split_plots.alone(np.zeros(0, int), np.array([0]), plots, RADAR).tolist() == []


def test_a_cell_across_north_is_one():
    plots = plots_at((-10, 3000), (10, 3005))
    assert split_plots.alone(np.array([0, 1]), np.array([-1]), plots, RADAR).tolist() == [
        True,
        False,
    ]


def long_ship(seed, hull):
    """Scans of one ship whose bow and stern each give a plot, a hull's length apart."""
    course = 60.0
    chosen = scenario.build(
        {
            'duration_s': 150,
            'radar': {'range_sigma_m': 6, 'bearing_sigma_deg': 0.15, 'pd_near': 0.95},
            'own_ship': {'course_deg': 0, 'speed_kn': 0},
            'targets': [
                {
                    'start': {'north_m': 1500.0, 'east_m': 900.0},
                    'course_deg': course,
                    'speed_kn': 12,
                }
            ],
        },
        'long ship',
    )
    rng, at = np.random.default_rng(seed), np.radians(course)
    for scan, truth in radar.simulate(chosen, seed):
        if not len(scan.plots.time):
            yield chosen, scan, truth
            continue
        place = truth.position[0] + 0.5 * hull * np.outer([1, -1], [np.sin(at), np.cos(at)])
        place = place[rng.random(2) < 0.9]
        noise = rng.standard_normal((len(place), 2)) * [6.0, np.radians(0.15)]
        plots = PolarPlots(
            scan.plots.time[0] + np.zeros(len(place)),
            np.hypot(*place.T) + noise[:, 0],
            np.arctan2(*place.T) + noise[:, 1],
            scan.plots.amplitude[0] + np.zeros(len(place)),
        )
        yield chosen, scan._replace(plots=plots), truth


def test_a_long_ship_that_gives_two_plots_is_one_target_at_its_middle():
    """36 m, which a glint of 10 m stands for."""
    tracks, error = [], []
    for seed in (4, 9):
        tracker = None
        for chosen, scan, truth in long_ship(seed, 36.0):
            if tracker is None:
                values = {**chosen.tracker_parameters(), 'estimator': 'imm', 'glint_sigma_m': 10.0}
                tracker = Tracker(dataclasses.replace(TrackerParameters(), **values))
                memory = tracker.start()
            memory, report = tracker.step(memory, scan)
            live = np.isin(report.tracks.status, (CONFIRMED, COASTING))
            if scan.end > 40:
                tracks.append(np.count_nonzero(live))
                at = tracker.extrapolate(report.tracks, truth.time[0]).position[live]
                error.append(at[0] - truth.position[0])
    assert set(tracks) == {1}
    assert np.sqrt(np.mean(np.sum(np.square(error), 1))) < 8.0
