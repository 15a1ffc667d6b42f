"""Simulated ships and the plots a radar has of them."""

import numpy as np
import pytest

from marine_tracker.training import ship_tracks

PERIOD = 60 / 22


@pytest.mark.parametrize('kind', ship_tracks.KINDS)
def test_each_kind_moves_as_it_says(kind):
    count, scans = 200, 120
    ships = ship_tracks.sail(
        [kind] * count,
        np.full(count, 9000.0),
        np.full((count, scans), PERIOD),
        np.random.default_rng(1),
    )
    about = ship_tracks.KINDS[kind]
    step = np.diff(ships.position, axis=1)
    between = 0.5 * (ships.velocity[:, 1:] + ships.velocity[:, :-1])
    # Velocity is the slope of the position, but for what one scan of a turn bends.
    off = np.hypot(*np.moveaxis(step / PERIOD - between, -1, 0))
    assert np.quantile(off, 0.9) < (2.0 if kind == 'agile' else 0.5)
    acceleration = np.diff(ships.velocity, axis=1) / PERIOD
    size = np.hypot(*np.moveaxis(acceleration, -1, 0))
    assert size.max() < about.lateral + 0.2
    calm = ~ships.manoeuvre[:, 1:] & ~ships.manoeuvre[:, :-1]
    assert size[calm].max(initial=0.0) < 0.07  # slow drift of speed and course at most
    if about.weave:
        assert ships.manoeuvre.all()
    else:
        begun = (ships.manoeuvre[:, 1:] & ~ships.manoeuvre[:, :-1]).sum()
        free = (~ships.manoeuvre).sum()
        assert begun <= about.begin * free * 1.3 + 1e-9
        assert begun >= about.begin * free * 0.7
    if kind == 'steady':
        np.testing.assert_allclose(np.diff(ships.velocity, axis=1), 0.0, atol=1e-9)


def test_plots_have_the_noise_outliers_and_gaps_asked_for():
    count, scans, every = 300, 40, np.ones(300)
    ships = ship_tracks.sail(
        ['steady'] * count,
        np.full(count, 8000.0),
        np.full((count, scans), PERIOD),
        np.random.default_rng(2),
    )
    radar = ship_tracks.RunRadar(
        20 * every, 0.005 * every, 0.8 * every, 0.0 * every, 2 * every, PERIOD * every
    )
    plots, seen = ship_tracks.observe(ships, radar, np.random.default_rng(3))
    off = np.stack([p.range for p in plots], 1) - np.hypot(*np.moveaxis(ships.position, -1, 0))
    assert off.std() == pytest.approx(40.0, rel=0.03)  # twice the stated 20 m
    assert seen[:, :2].all()
    assert seen[:, 2:].mean() == pytest.approx(0.8, abs=0.02)
    wild = radar._replace(outliers=0.05 * every)
    plots, _ = ship_tracks.observe(ships, wild, np.random.default_rng(3))
    off = np.stack([p.range for p in plots], 1) - np.hypot(*np.moveaxis(ships.position, -1, 0))
    # A twentieth has 5 more deviations on top: 4 of its own are passed by 44 % of them.
    assert (np.abs(off) > 4 * 40).mean() == pytest.approx(0.05 * 0.433, rel=0.2)


def test_plots_wander_and_jump_over_a_hull():
    """Slowly: those of one scan tell most of those of the next; and the whole is of its size."""
    count, scans, every = 2000, 60, np.ones(2000)
    still = ship_tracks.Ships(
        np.tile(PERIOD * np.arange(scans), (count, 1)),
        np.tile([0.0, 1000.0], (count, scans, 1)),
        np.zeros((count, scans, 2)),
        np.zeros((count, scans), bool),
    )
    radar = ship_tracks.RunRadar(
        1e-6 * every, 1e-9 * every, every, 0 * every, every, PERIOD * every
    )
    plots, _ = ship_tracks.observe(still, radar, np.random.default_rng(4), 4.0 * every)
    along = np.stack([p.range for p in plots], 1) - 1000.0
    across = 1000.0 * np.stack([p.bearing for p in plots], 1)
    far = ship_tracks.FAR**2 * (1 - ship_tracks.BACK)
    for off in (along, (across + 3000) % (2000 * np.pi) - 3000):
        late = off[:, 30:]
        expected = 4.0 * np.sqrt(ship_tracks.WANDER**2 + far)
        assert late.std() == pytest.approx(expected, rel=0.08)
        both = np.corrcoef(late[:, :-1].ravel(), late[:, 1:].ravel())[0, 1]
        assert 0.85 < both < 0.95


def test_a_manoeuvre_is_felt_for_some_scans():
    manoeuvre = np.zeros((1, 20), bool)
    manoeuvre[0, 3] = True
    assert ship_tracks.phase(manoeuvre)[0].tolist() == [False] * 3 + [True] * 9 + [False] * 8
