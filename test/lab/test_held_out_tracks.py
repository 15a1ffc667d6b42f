"""True tracks that no weights were trained on."""

import numpy as np
import pytest

from marine_tracker.lab.gwnn import held_out_tracks, trials

PERIOD = 60 / 22


def test_ships_under_autopilot_and_the_papers_turn():
    steps = np.full((100, 150), PERIOD)
    ships = held_out_tracks.nomoto(steps, np.random.default_rng(4))
    assert 0.1 < ships.manoeuvre.mean() < 0.6
    turn = held_out_tracks.paper_turn(steps, np.random.default_rng(4))
    course = np.unwrap(np.arctan2(turn.velocity[0, :, 0], turn.velocity[0, :, 1]))
    assert np.degrees(course[0]) == pytest.approx(70)
    assert np.degrees(course[-1] - course[0]) == pytest.approx(50, abs=1.0)
    assert np.flatnonzero(turn.manoeuvre[0])[0] == 100
    np.testing.assert_allclose(turn.position[0, 0], 4600 * np.array([0.5, np.sqrt(0.75)]))


def test_real_ships_and_boats_move_as_recorded(recordings):
    steps = np.full((30, 100), PERIOD)
    rng = np.random.default_rng(5)
    ships = held_out_tracks.real_ships(recordings / trials.AIS, steps, rng)
    speed = np.hypot(*np.moveaxis(ships.velocity, -1, 0))
    assert 1 < np.median(speed) < 12
    assert 10 <= ships.manoeuvre[:, 20:].any(1).sum() <= 25
    boats = held_out_tracks.recorded_boats(recordings / trials.BOAT, steps, rng)
    speed = np.hypot(*np.moveaxis(boats.velocity, -1, 0))
    assert 1 < np.median(speed) < 12 and boats.manoeuvre.mean() > 0.5
