"""Which tracks go steadily."""

import numpy as np
import pytest

from marine_tracker.tracking import steady

SIGMA = 5.0  # m


def followed(positions, period=2.5):
    """The line through plots at positions [K, A, 2] m."""
    every = np.ones(len(positions[0]), bool)
    line = steady.begin(positions[0], np.zeros(len(every)))
    for k, at in enumerate(positions[1:], 1):
        line = steady.follow(line, every, at, np.full(len(every), k * period))
    return line


def test_the_slope_is_that_of_a_fit_with_older_plots_weighing_less():
    rng = np.random.default_rng(2)
    time = 2.5 * np.arange(15)
    plots = 30 + np.stack([1.7 * time, -0.6 * time], 1) + rng.normal(0, SIGMA, (15, 2))
    weight = (1 - 1 / steady.MEMORY) ** np.arange(15)[::-1]
    slope = np.polyfit(time, plots, 1, w=np.sqrt(weight))[0]
    line = followed(plots[:, None])
    assert line.slope[0] / line.spread[0] == pytest.approx(slope)
    assert steady.speed(line)[0] == pytest.approx(np.hypot(*slope))


def test_boats_are_under_way_and_things_at_rest_are_not():
    rng = np.random.default_rng(5)
    time = 2.5 * np.arange(12)[:, None, None]
    boats = time * [2.0, 1.0] + rng.normal(0, SIGMA, (12, 200, 2))
    still = rng.normal(0, SIGMA, (12, 200, 2))
    variance = np.full(200, SIGMA**2)
    # The scatter about the line has 20 degrees of freedom; it exceeds 1.5 in 7 of 100.
    assert steady.under_way(followed(boats), variance).mean() > 0.85
    assert not steady.under_way(followed(still), variance).any()


def test_hops_along_a_quay_are_no_line():
    rng = np.random.default_rng(7)
    stands = 30.0 * np.cumsum(rng.random((12, 200)) < 0.25, 0)  # from one plot to the next
    plots = np.stack([stands, 0 * stands], 2) + rng.normal(0, SIGMA, (12, 200, 2))
    assert steady.under_way(followed(plots), np.full(200, SIGMA**2)).mean() < 0.3


def test_tracks_without_a_plot_keep_their_line():
    line = followed(np.zeros((3, 2, 2)))
    after = steady.follow(line, np.array([True, False]), np.ones((2, 2)), np.full(2, 9.0))
    assert after.plots[1] == line.plots[1] and after.plots[0] > line.plots[0]
    assert after.position[1].tolist() == [0, 0] and after.position[0, 0] > 0
