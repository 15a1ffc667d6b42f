"""The ablation, in a short form."""

from itertools import islice

import numpy as np
import pytest

from marine_tracker.lab.clutter import ablation, clutter
from marine_tracker.lab.clutter.pieces import FUNCTIONS, PARAMETERS, PARTS, without
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking.tracker import Tracker


@pytest.fixture(scope='module')
def scans():
    """The first minutes of boats in company, which give one plot at times, and false plots."""
    return list(islice((scan for scan, _ in radar.simulate(scenario.load('two_boats'), 3)), 45))


def tracked(scans):
    """Positions, existence and status after the scans."""
    values = scenario.load('two_boats').tracker_parameters()
    tracker = Tracker(from_mapping(TrackerParameters, {**values, 'estimator': 'cs_kalman'}))
    memory = tracker.start()
    for scan in scans:
        memory, _ = tracker.step(memory, scan)
    at = tracker.extrapolate(memory.tracks, scans[-1].end).position
    return np.hstack([at.ravel(), memory.tracks.existence, memory.tracks.status])


@pytest.fixture(scope='module')
def whole(scans):
    return tracked(scans)


def test_every_part_can_be_left_out():
    assert set(PARTS) == set(PARAMETERS) | set(FUNCTIONS)


@pytest.mark.parametrize('part', [part for part in FUNCTIONS if part != 'split plots'])
def test_a_part_that_is_left_out_changes_the_tracks_and_is_back_afterwards(scans, whole, part):
    with without(part):
        changed = tracked(scans)
    assert not np.array_equal(whole, changed)
    assert all(getattr(module, name) is not piece for module, name, piece in FUNCTIONS[part])


def test_a_part_is_back_after_an_error():
    module, name, piece = FUNCTIONS['existence'][0]
    with pytest.raises(OSError, match='broken'), without('existence'):
        assert getattr(module, name) is piece
        raise OSError('broken')
    assert getattr(module, name) is not piece


def test_figures_tell_scene_and_part():
    rows = [[[10.0, 0.5, 0.99, 4.0], [12.0, 0.7, 0.98, 5.0]]]
    found = ablation._figures(['pond'], [None, 'places'], rows)
    assert [(figure.name, figure.value) for figure in found[3:6]] == [
        ('pond, all parts: rmse', 4.0),
        ('pond, without places: gospa', 12.0),
        ('pond, without places: false', 0.7),
    ]


@pytest.mark.slow
def test_a_scene_with_all_parts_is_that_of_the_experiment_of_clutter():
    found = ablation.run(1, 5, estimator='imm', scenes=['agile_boat'], without=['joint'], workers=1)
    whole = clutter.follow('agile_boat', 'imm', 5)
    assert found.figures[0].value == whole.gospa and found.figures[3].value == whole.rmse
    assert len(found.figures) == 8


def test_what_is_not_there_is_refused_by_name(tmp_path):
    with pytest.raises(ValueError, match='no part radar; there are existence, P_D, fine map'):
        ablation.run(1, 1, without=['radar'])
    with pytest.raises(ValueError, match='no scene lake'):
        ablation.run(1, 1, scenes=['lake'])
    with pytest.raises(ValueError, match='has no folder with a truth.csv'):
        ablation.run(1, 1, data=str(tmp_path))
