import numpy as np
import pytest

from marine_tracker.tracking.equivalent_plot import equivalents
from marine_tracker.tracking.gate import Pairs
from marine_tracker.types import Extrapolation, Plots, take


def covariances(rng, count, size, scale):
    root = rng.normal(size=(count, size, size)) * scale
    return root @ root.swapaxes(1, 2) + 0.3 * scale**2 * np.eye(size)


def plots_at(position, covariance, time):
    count = len(position)
    zero, origin = np.zeros(count), np.zeros((count, 2))
    range_ = np.hypot(*position.T)
    bearing = np.mod(np.arctan2(*position.T), 2 * np.pi)
    return Plots(time, range_, bearing, zero, origin, position, covariance)


def kalman(mean, covariance, plot, noise):
    """Position and its covariance after one plot."""
    gain = covariance @ np.linalg.inv(covariance + noise)
    return mean + gain @ (plot - mean), covariance - gain @ covariance


@pytest.mark.parametrize('seed', range(20))
def test_one_update_gives_mean_and_covariance_of_the_mixture(seed):
    """Two tracks that contest three plots, which came at different times."""
    rng = np.random.default_rng(seed)
    place = np.array([[900.0, -400.0], [930.0, -380.0]])
    ahead = Extrapolation(
        np.array([7.0, 7.1]), place, rng.normal(0, 6, (2, 2)), covariances(rng, 2, 4, 20.0)
    )
    plots = plots_at(
        place[[0, 1, 0]] + rng.normal(0, 8, (3, 2)),
        covariances(rng, 3, 2, 8.0),
        7.0 + rng.uniform(-0.2, 0.2, 3),
    )
    pairs = Pairs(np.array([0, 0, 0, 1, 1]), np.array([0, 1, 2, 1, 2]), np.zeros(5), np.zeros(5))
    chance = np.array([0.5, 0.2, 0.2, 0.6, 0.3])
    plot_of, rows = np.array([0, 1]), np.array([0, 1])
    found = equivalents(pairs, chance, plot_of, rows, take(plots, plot_of), ahead, plots)
    for track in (0, 1):
        before = ahead.covariance[track, :2, :2]
        parts = [(1 - chance[pairs.track == track].sum(), np.zeros(2), before)]
        for of, plot, weight in zip(pairs.track, pairs.plot, chance):
            if of == track:
                drift = (plots.time[plot] - ahead.time[track]) * ahead.velocity[track]
                at, spread = kalman(
                    place[track], before, plots.position[plot] - drift, plots.covariance[plot]
                )
                parts.append((weight, at - place[track], spread))
        mean = sum(weight * off for weight, off, _ in parts)
        spread = sum(w * (s + np.outer(off - mean, off - mean)) for w, off, s in parts)
        drift = (found.time[track] - ahead.time[track]) * ahead.velocity[track]
        at, after = kalman(
            place[track], before, found.position[track] - drift, found.covariance[track]
        )
        assert at == pytest.approx(place[track] + mean, abs=1e-6)
        if np.linalg.eigvalsh(before - spread).min() > 0.2 * np.trace(before):
            assert after == pytest.approx(spread, rel=1e-6)
        # A mixture wider than what was expected: the plot tells a little, never less than nothing.
        assert np.linalg.eigvalsh(found.covariance[track]).min() > 0
        assert np.linalg.eigvalsh(before - after).min() > 0
    assert found.range == pytest.approx(np.hypot(*found.position.T))
    assert np.sin(found.bearing) * found.range == pytest.approx(found.position[:, 0])
    assert ((found.bearing >= 0) & (found.bearing < 2 * np.pi)).all()


def test_a_track_whose_plot_is_not_in_doubt_keeps_it():
    rng = np.random.default_rng(21)
    place = rng.normal(0, 500, (3, 2))
    ahead = Extrapolation(
        np.zeros(3), place, np.zeros((3, 2)), np.tile(100.0 * np.eye(4), (3, 1, 1))
    )
    plots = plots_at(place + 3.0, np.tile(30.0 * np.eye(2), (3, 1, 1)), np.zeros(3))
    pairs = Pairs(np.array([0, 2]), np.array([0, 2]), np.zeros(2), np.zeros(2))
    plot_of = np.array([0, 1, -1])
    rows = np.array([0, 1])
    chosen = take(plots, plot_of[rows])
    found = equivalents(pairs, np.array([0.9999, 0.5]), plot_of, rows, chosen, ahead, plots)
    for a, b in zip(found[:-1], chosen[:-1]):
        assert np.array_equal(a, b)
