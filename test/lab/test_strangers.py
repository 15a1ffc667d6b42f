"""Ships of the independent simulation."""

import ast
from pathlib import Path

import numpy as np
import pytest

from marine_tracker.estimators.gwnn import bank_settings
from marine_tracker.lab.gwnn import strangers, strangers_rival, trials

PERIOD = 60 / 22


def sail(name, seed=2, count=40, scans=90):
    return strangers.sail(name, np.full((count, scans), PERIOD), np.random.default_rng(seed))


@pytest.mark.parametrize('name', strangers.CRAFT)
def test_they_move_as_ships_do(name):
    ships = sail(name)
    made = np.diff(ships.position, axis=1) / PERIOD
    between = 0.5 * (ships.velocity[:, 1:] + ships.velocity[:, :-1])
    assert np.abs(made - between).max() < 0.4
    acceleration = np.hypot(*np.moveaxis(np.gradient(ships.velocity, axis=1), -1, 0)) / PERIOD
    assert np.percentile(acceleration, 99) < 1.0
    speed = np.hypot(*np.moveaxis(ships.velocity, -1, 0))
    assert speed.max() < 16 and np.median(speed) > 1
    if name == 'still':
        assert np.ptp(ships.velocity, axis=1).max() < 1e-9 and not ships.manoeuvre.any()
    else:
        assert 0.02 < ships.manoeuvre.mean() < 0.6
        # What counts as a manoeuvre is one.
        assert acceleration[ships.manoeuvre].mean() > 3 * acceleration[~ships.manoeuvre].mean()


def test_along_waypoints_a_ship_keeps_to_its_line():
    """Apart from turns, a cargo ship's course is steady within a few degrees for minutes."""
    ships = sail('cargo', scans=150)
    course = np.unwrap(np.arctan2(*np.moveaxis(ships.velocity, -1, 0)), axis=1)
    change = np.degrees(np.abs(course[:, 20:] - course[:, :-20]))
    quiet = ~np.stack([ships.manoeuvre[:, i : i - 20 or None] for i in range(21)]).any(0)[:, :130]
    assert np.median(change[quiet]) < 6.0


def test_they_share_nothing_with_the_training_but_the_form_of_a_track():
    tree = ast.parse(Path(strangers.__file__).read_text())
    taken = {
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and 'training' in (node.module or '')
        for alias in node.names
    }
    assert taken == {'Ships'}


def test_the_rival_tuned_on_them_is_the_stronger_one_there():
    rng = np.random.default_rng(5)
    on = [
        trials.trial('ship', name, 15, trials.FLEETS['ship'].radar, rng, None)
        for name in ('ferry',)
    ]
    tuned = strangers_rival.loss(on, 'training', strangers.TUNED['training'])
    other = bank_settings.STRONGEST['ship']['training']
    assert tuned < strangers_rival.loss(on, 'training', other)
