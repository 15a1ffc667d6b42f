import dataclasses

import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import unresolved
from marine_tracker.tracking.gate import Pairs
from marine_tracker.tracking.lifecycle import COASTING, CONFIRMED, TENTATIVE
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import Extrapolation, Plots, take

RADAR = TrackerParameters(range_resolution_m=25.0, beam_width_deg=2.0)


def tracks_with(status):
    tracks = Tracker(TrackerParameters(estimator='cs_kalman')).start().tracks
    return tracks._replace(status=np.array(status, np.int8))


def ahead_at(*places):
    count = len(places)
    covariance = np.tile(np.diag([80.0, 50.0, 4.0, 4.0]), (count, 1, 1))
    return Extrapolation(np.zeros(count), np.array(places, float), np.zeros((count, 2)), covariance)


def shared(places, status=(CONFIRMED, CONFIRMED), plot_of=(0, -1)):
    """Who shares, of two tracks due north that both have plot 0 in their gates."""
    pairs = Pairs(np.array([0, 1]), np.array([0, 0]), np.array([1.0, 2.0]), np.zeros(2))
    return unresolved.shared(
        pairs, np.array(plot_of), tracks_with(status), ahead_at(*places), np.zeros((2, 2)), RADAR
    )


@pytest.mark.parametrize(
    ('place', 'one_cell'),
    [
        ((0.0, 1020.0), True),
        ((0.0, 1030.0), False),  # deeper than the cell
        ((30.0, 1000.0), True),
        ((40.0, 1000.0), False),  # wider: 2 degrees at 1,000 m are 35 m
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


def test_a_shared_plot_moves_both_and_says_nothing_of_how_they_lie():
    """The middle goes to the plot; their distance is as expected."""
    ahead = ahead_at((0.0, 1000.0), (8.0, 1012.0))
    at = np.array([[20.0, 1030.0]])
    noise = np.tile(30.0 * np.eye(2), (1, 1, 1))
    zero = np.zeros(1)
    plot = Plots(zero, np.hypot(*at.T), zero, zero, np.zeros((1, 2)), at, noise)
    one = np.array([1]), np.array([0]), np.array([0])
    rows = np.array([0])
    found = unresolved.split(unresolved.Shared(*one), rows, take(plot, rows), ahead, plot)
    assert found.position.mean(0) == pytest.approx(at[0])
    assert found.position[1] - found.position[0] == pytest.approx([8.0, 12.0])
    assert (np.linalg.eigvalsh(found.covariance - noise) > 0).all()
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
