"""The experiment of scenes with clutter, in a short form."""

import numpy as np
import pytest

from marine_tracker.lab.clutter import clutter
from marine_tracker.simulation import scenario


def test_every_scene_is_shipped_and_has_a_limit_only_by_its_own_name():
    assert set(clutter.SCENES) <= set(scenario.shipped())
    for limits in (clutter.FALSE_ALIVE, clutter.HELD, clutter.CONFIRMED_AFTER):
        assert set(limits) <= set(clutter.SCENES)


def test_boats_of_a_clean_scene_are_held_and_counted():
    found = clutter.follow('agile_boat', 'imm', 7)
    assert found.held.shape == found.confirmed.shape == (2,)
    assert found.held.min() > 0.8
    assert 3 <= found.confirmed.min()  # a track has two plots before it is confirmed by a third
    assert found.numbers >= 2
    assert found.gospa >= found.without_false
    assert found.false < 1


def test_figures_name_scene_and_limit():
    one = clutter.Run(80.0, 60.0, np.array([1.0, 0.95]), np.array([4.0, np.nan]), 0.2, 30)
    figures = {f.name: f for f in clutter._figures('false_plots', [one, one])}
    assert figures['false_plots: false tracks alive'].ok is False
    assert figures['false_plots: held, mean of the ships'].ok is True
    assert figures['false_plots: held, the worst ship'].value == 0.95
    assert figures['false_plots: ships never held'].value == 2
    assert figures['false_plots: confirmation, median'].value == 4
    assert all(f.limit is None for f in clutter._figures('canal', [one]))


def test_a_scene_that_does_not_exist_is_refused_by_name():
    with pytest.raises(ValueError, match='there is no scene pond; there are busy_harbour, canal'):
        clutter.run(1, 1, scenes=['pond'])
