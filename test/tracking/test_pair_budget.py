import numpy as np
import pytest

from marine_tracker.geometry import to_range_bearing, unit_vector
from marine_tracker.tracking import pair_budget
from marine_tracker.tracking.gate import window_pairs
from marine_tracker.tracking.pair_budget import fullest, nearest


@pytest.fixture
def small(monkeypatch):
    """A budget of 40 pairs and 3 for each window."""
    monkeypatch.setattr(pair_budget, 'PAIRS', 40)
    monkeypatch.setattr(pair_budget, 'A_WINDOW', 3)


def test_within_the_budget_nothing_gives_way(small):
    full, _ = fullest(np.array([40, 0, 9]))
    assert full.tolist() == [False, False, False]


@pytest.mark.parametrize('seed', range(30))
def test_the_fullest_windows_give_way_and_the_budget_is_used(small, seed):
    rng = np.random.default_rng(seed)
    count = rng.integers(0, 10 ** rng.integers(1, 4, 25))
    budget = 40 + 3 * len(count)
    full, most = fullest(count)
    if count.sum() <= budget:
        assert not full.any()
        return
    kept = np.where(full, most, count)
    assert (full == (count > most)).all()
    assert kept.sum() <= budget < kept.sum() + full.sum()  # one more each would be too much


def cloud(rng, count, middle, radius):
    return np.asarray(middle) + rng.uniform(-radius, radius, (count, 2))


def windows(place, reach):
    distance, bearing = to_range_bearing(place)
    half_width = np.where(
        distance > reach, np.arcsin(np.minimum(reach / np.maximum(distance, 1e-9), 1.0)), np.pi
    )
    return distance, distance - reach, distance + reach, np.mod(bearing, 2 * np.pi), half_width


def polar(place):
    range_, bearing = to_range_bearing(place)
    return range_, np.mod(bearing, 2 * np.pi)


@pytest.mark.parametrize('middle', [(3000.0, 1500.0), (0.0, 4000.0), (60.0, -20.0)])
def test_in_a_crowd_the_nearest_plots_are_compared(small, middle):
    """The best fit of each target is among them; over north and beside own ship too."""
    rng = np.random.default_rng(3)
    targets, plots = cloud(rng, 30, middle, 60.0), cloud(rng, 300, middle, 60.0)
    track, plot, left_out = window_pairs(*windows(targets, 150.0), *polar(plots))
    assert len(track) + left_out >= 8000  # of 9,000, where beside own ship some are out of reach
    assert 0 < len(track) <= 40 + 3 * 30
    assert (np.diff(track) >= 0).all()
    apart = np.linalg.norm(targets[:, None] - plots, axis=-1)
    compared = np.zeros(apart.shape, bool)
    compared[track, plot] = True
    assert np.mean(compared[np.arange(30), apart.argmin(1)]) > 0.9
    assert len(set(zip(track.tolist(), plot.tolist()))) == len(track)


def test_a_crowd_costs_targets_elsewhere_nothing(small):
    rng = np.random.default_rng(4)
    crowd, elsewhere = cloud(rng, 200, (3000, 1500), 50), cloud(rng, 5, (-5000, 800), 900)
    targets = np.concatenate([elsewhere, cloud(rng, 20, (3000, 1500), 50)])
    plots = np.concatenate([elsewhere + 5.0, crowd])
    track, plot, left_out = window_pairs(*windows(targets, 150.0), *polar(plots))
    assert left_out > 3000
    found = set(zip(track.tolist(), plot.tolist()))
    assert {(k, k) for k in range(5)} <= found


def test_plots_at_one_place_are_shared_out():
    """Thousands of equals: not every target takes the same few."""
    place = np.tile([2500.0, 700.0], (400, 1))
    distance, bearing = polar(place)
    reach = np.full(400, 90.0), np.full(400, 0.03)
    window, plot = nearest(distance, bearing, *reach, distance, bearing, 5)
    assert np.bincount(window).tolist() == [5] * 400
    assert len(np.unique(plot)) > 350


def test_far_off_range_and_bearing_count_in_windows():
    """At 20 km a plot 100 m aside fits a window of 30 m by 300 m better than one 50 m beyond."""
    target = 20000.0 * unit_vector(np.array([1.0]))
    plots = np.concatenate([target + 100 * unit_vector(1.0 + np.pi / 2), target * 1.0025])
    _, plot = nearest(*polar(target), np.array([30.0]), np.array([300 / 20000.0]), *polar(plots), 1)
    assert plot.tolist() == [0]
