import dataclasses

import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import existence, unresolved
from marine_tracker.tracking.gate import Pairs
from marine_tracker.tracking.lifecycle import COASTING, CONFIRMED, TENTATIVE
from marine_tracker.tracking.surroundings import Evidence
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import Extrapolation, Plots, take

RADAR = TrackerParameters(range_resolution_m=25.0, beam_width_deg=2.0)


def tracks_with(status):
    tracks = Tracker(TrackerParameters(estimator='cs_kalman')).start().tracks
    return tracks._replace(status=np.array(status, np.int8))


def ahead_at(*places, sigma=2.0):
    count = len(places)
    covariance = np.tile(np.diag(np.repeat([sigma**2, 4.0], 2)), (count, 1, 1))
    return Extrapolation(np.zeros(count), np.array(places, float), np.zeros((count, 2)), covariance)


def plots_at(*places, noise=30.0):
    at, zero = np.array(places, float), np.zeros(len(places))
    covariance = np.tile(noise * np.eye(2), (len(places), 1, 1))
    return Plots(zero, np.hypot(*at.T), zero, zero, np.zeros_like(at), at, covariance)


def shared(
    places, status=(CONFIRMED, CONFIRMED), plot_of=(0, -1), plots=None, clutter=1e-8, sigma=2.0
):
    """Who shares, of two tracks that have all plots in their gates, by default their middle."""
    ahead = ahead_at(*places, sigma=sigma)
    plots = plots or plots_at(ahead.position.mean(0))
    count = len(plots.time)
    track, plot = np.arange(2).repeat(count), np.tile(np.arange(count), 2)
    off = plots.position[plot] - ahead.position[track]
    spread = ahead.covariance[track][:, :2, :2] + plots.covariance[plot]
    nis = (off * np.linalg.solve(spread, off[..., None])[..., 0]).sum(1)
    pairs = Pairs(track, plot, nis, np.log(np.linalg.det(spread)))
    density = np.full(count, clutter)
    likelihood = existence.likelihood(pairs, density)
    evidence = Evidence(density, likelihood, np.full(2, 0.9), 0.0, 1.0)
    rest = tracks_with(status), ahead, np.zeros((2, 2)), plots, RADAR
    return unresolved.shared(pairs, evidence, np.array(plot_of), *rest)


@pytest.mark.parametrize(
    ('place', 'one_cell'),
    [
        ((0.0, 1020.0), True),
        ((0.0, 1040.0), False),  # deeper than the cell
        ((30.0, 1000.0), True),
        ((50.0, 1000.0), False),  # wider: 2 degrees at 1,000 m are 35 m
    ],
)
def test_targets_in_one_cell_share_its_plot(place, one_cell):
    found = shared([(0.0, 1000.0), place])
    assert found.track.tolist() == [1] * one_cell
    assert found.owner.tolist() == [0] * one_cell and found.plot.tolist() == [0] * one_cell


def test_only_confirmed_tracks_share_and_only_one_that_has_no_plot():
    places = [(0.0, 1000.0), (3.0, 1004.0)]
    assert len(shared(places, (CONFIRMED, TENTATIVE)).track) == 0
    assert len(shared(places, (TENTATIVE, CONFIRMED)).track) == 0
    assert len(shared(places, plot_of=(-1, -1)).track) == 0
    assert len(shared(places, (COASTING, COASTING)).track) == 1


def test_two_good_plots_are_of_two_targets_however_near_they_were_expected():
    places = [(0.0, 1000.0), (10.0, 1012.0)]
    assert len(shared(places, plot_of=(0, 1), plots=plots_at(*places), sigma=9.0).track) == 0


def test_a_track_that_took_a_false_plot_beside_that_of_both_shares_it():
    """Among many false plots the one aside is none of the target's; in an empty sea it is."""
    places, plots = [(0.0, 1000.0), (4.0, 1010.0)], plots_at((2.0, 1005.0), (14.0, 1024.0))
    found = shared(places, plot_of=(0, 1), plots=plots, clutter=2e-4)
    assert (found.track.tolist(), found.owner.tolist(), found.plot.tolist()) == ([1], [0], [0])
    assert len(shared(places, plot_of=(0, 1), plots=plots, clutter=1e-9, sigma=9.0).track) == 0


def test_where_two_are_is_known_so_badly_that_they_are_hardly_in_one_cell():
    """Then one of them has not shown."""
    places = [(0.0, 1000.0), (0.0, 1050.0)]
    assert len(shared(places, plots=plots_at((0.0, 1000.0)), sigma=10.0).track) == 0
    assert len(shared(places, plots=plots_at((0.0, 1025.0)), sigma=25.0).track) == 1


def test_a_shared_plot_moves_both_and_says_nothing_of_how_they_lie():
    """The middle goes to the plot; their distance is as expected."""
    ahead = ahead_at((0.0, 1000.0), (8.0, 1012.0), sigma=9.0)
    at = np.array([[20.0, 1030.0]])
    plot = plots_at(*at)
    one = np.array([1]), np.array([0]), np.array([0])
    rows = np.array([0])
    found = unresolved.split(unresolved.Shared(*one), rows, take(plot, rows), ahead, plot)
    assert found.position.mean(0) == pytest.approx(at[0])
    assert found.position[1] - found.position[0] == pytest.approx([8.0, 12.0])
    assert (np.linalg.eigvalsh(found.covariance - plot.covariance) > 0).all()
    assert found.range == pytest.approx(np.hypot(*found.position.T))


def test_two_ships_that_cross_in_one_cell_stay_two():
    """At 25 degrees and with one plot for both, scan after scan: both numbers live."""
    angle, span = np.radians(25.0), 180.0
    kept = 0
    for seed in range(8):
        ships = [
            {
                'name': f'ship {k}',
                'start': {
                    'north_m': 3500.0 - float(0.5 * span * 7.0 * np.cos(turn)),
                    'east_m': 900.0 - float(0.5 * span * 7.0 * np.sin(turn)),
                },
                'course_deg': float(np.degrees(turn)),
                'speed_kn': 7.0 / 0.5144444,
                'pd': 0.95,
            }
            for k, turn in enumerate((0.4, 0.4 + angle))
        ]
        chosen = scenario.build(
            {
                'duration_s': span,
                'radar': {'range_resolution_m': 30, 'beam_width_deg': 1.0},
                'own_ship': {'course_deg': 0, 'speed_kn': 0},
                'targets': ships,
            },
            'crossing',
        )
        values = dataclasses.replace(
            TrackerParameters(estimator='imm'), **chosen.tracker_parameters()
        )
        tracker = Tracker(values)
        memory = tracker.start()
        for scan, _ in radar.simulate(chosen, seed):
            memory, _ = tracker.step(memory, scan)
        kept += sorted(memory.tracks.number[memory.tracks.number > 0]) == [1, 2]
    assert kept >= 7


def test_a_radar_that_measures_finely_has_a_small_cell_whatever_the_defaults_say():
    fine = TrackerParameters(range_sigma_m=3.0, bearing_sigma_deg=0.1)
    assert unresolved.cell(fine) == pytest.approx((12.0, np.radians(0.4)))
    coarse = TrackerParameters(range_sigma_m=20.0, range_resolution_m=35.0, beam_width_deg=1.5)
    assert unresolved.cell(coarse) == pytest.approx((35.0, np.radians(1.5)))
