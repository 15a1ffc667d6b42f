import numpy as np
import pytest

from marine_tracker.tracking import meetings
from marine_tracker.tracking.meetings import KEPT, NOTHING, Contested
from marine_tracker.types import Extrapolation


def ahead_with(velocity, sigma=1.0):
    count = len(velocity)
    covariance = np.tile(np.diag([100.0, 100.0, sigma**2, sigma**2]), (count, 1, 1))
    return Extrapolation(
        np.zeros(count), np.zeros((count, 2)), np.array(velocity, float), covariance
    )


class Waters:
    """Tracks with the ids 11, 12, ... whose plots are contested scan by scan."""

    def __init__(self, ids):
        self.id, self.known = np.array(ids), meetings.begin()

    def scan(self, velocity, now, chances=None, plot_of=None, sigma=1.0):
        """chances [N, M]: of each track to own each plot; 0 where it is not in the gate."""
        contested = NOTHING
        if chances is not None:
            track, plot = np.nonzero(chances)
            contested = Contested(track, plot, np.array(chances)[track, plot])
        plot_of = np.full(len(self.id), -1) if plot_of is None else np.array(plot_of)
        self.known = meetings.step(
            self.known, contested, plot_of, self, ahead_with(velocity, sigma), now
        )
        return meetings.told(self.known, self.id)


def test_plots_in_doubt_and_one_motion_are_a_risk():
    sea = Waters([11, 12])
    swapped, other = sea.scan([(5, 5), (5, 5)], 0.0, [[0.7, 0.3], [0.3, 0.7]], [0, 1])
    assert swapped == pytest.approx([0.3, 0.3]) and other.tolist() == [1, 0]


def test_ships_that_cross_at_a_wide_angle_are_told_apart_by_their_motion():
    sea, even = Waters([11, 12]), [[0.5, 0.5], [0.5, 0.5]]
    swapped, _ = sea.scan([(0, 8), (8, 0)], 0.0, even, [0, 1])
    assert (swapped < 1e-6).all()
    swapped, _ = sea.scan([(0, 8), (1, 7)], 3.0, even, [0, 1])
    assert swapped == pytest.approx(0.5 * np.exp(-1.0), rel=1e-6)  # 2 m^2/s^2 of 2 m^2/s^2


def test_one_plot_of_two_leaves_in_doubt_whose_it_is():
    swapped, _ = Waters([4, 9]).scan([(3, 0), (3, 0)], 0.0, [[0.6], [0.4]], [0, -1])
    assert swapped == pytest.approx([0.4, 0.4])


def test_the_risk_of_a_meeting_is_the_greatest_of_its_scans_and_ends_with_it():
    sea, same = Waters([11, 12]), [(2, 2), (2, 2)]
    for now, doubt, told in ((0, 0.1, 0.1), (3, 0.4, 0.4), (6, 0.05, 0.4)):
        even = [[1 - doubt, doubt], [doubt, 1 - doubt]]
        assert sea.scan(same, now, even, [0, 1])[0] == pytest.approx([told, told])
    assert sea.scan(same, 6 + KEPT)[0] == pytest.approx([0.4, 0.4])
    swapped, other = sea.scan(same, 6.1 + KEPT)
    assert not swapped.any() and (other == -1).all() and not len(sea.known.one)


def test_each_track_is_told_its_likeliest_partner_and_the_lonely_none():
    sea = Waters([2, 5, 7, 30])
    chances = [[0.9, 0, 0, 0], [0.1, 0.6, 0.3, 0], [0, 0.2, 0.7, 0], [0, 0, 0, 1.0]]
    swapped, other = sea.scan([(4, 0)] * 4, 0.0, chances, [0, 1, 2, 3])
    assert other.tolist() == [1, 2, 1, -1]
    assert swapped == pytest.approx(np.array([0.1, 0.3 + 0.1 - 0.3 * 0.1, 0.3, 0.0]))


def test_tracks_are_known_by_their_ids_whatever_their_rows():
    sea, same = Waters([11, 12]), [(2, 2), (2, 2)]
    sea.scan(same, 0.0, [[0.8, 0.2], [0.2, 0.8]], [0, 1])
    sea.id = np.array([40, 12, 11])
    swapped, other = meetings.told(sea.known, sea.id)
    assert swapped == pytest.approx([0, 0.2, 0.2]) and other.tolist() == [-1, 2, 1]
    assert meetings.told(sea.known, np.array([12]))[1].tolist() == [-1]  # the other one is lost
