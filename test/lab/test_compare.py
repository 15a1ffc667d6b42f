"""The comparison of all estimators: few tracks, the same for all."""

import numpy as np
import pytest

from marine_tracker.estimators import ESTIMATORS
from marine_tracker.evaluation import replay
from marine_tracker.evaluation.result import draw
from marine_tracker.lab import marine_table
from marine_tracker.lab.compare import compare, pictures
from marine_tracker.lab.compare.compare import Errors
from marine_tracker.simulation import scenario

FOUND = {
    name: {'one': Errors(10.0 + k, 1.0, 0.99), 'two': Errors(np.nan, np.nan)}
    for k, name in enumerate(ESTIMATORS)
}


def test_scenes_without_data_are_the_simulated_ones():
    assert list(compare.scenes_of(20, 1, None)) == [
        *marine_table.TRACKS,
        'sharp turns',
        'boat',
        'busy strait',
    ]


def test_a_folder_without_recordings_is_named(tmp_path):
    with pytest.raises(ValueError, match='has no folder with plots.csv or ais.csv'):
        compare.scenes_of(20, 1, str(tmp_path))


def test_recordings_and_ais_are_scenes(recordings):
    scenes = compare.scenes_of(20, 1, str(recordings))
    assert scenes['autosea_joyride'][0] is compare.on_recording
    assert scenes['AIS, ais_north_sea'][0] is compare.in_traffic
    found = compare.on_recording('imm', str(recordings / 'autoferry_03'))
    assert found.held > 0.9 and 1 < found.position < 15


@pytest.mark.parametrize('name', ESTIMATORS)
def test_every_estimator_follows_ships_that_turn_hard(name):
    ships = compare.in_sharp_turns(name, 'sharp turns', 20, 3)
    assert 2 < ships.position < 80 and 0.1 < ships.velocity < 15
    assert ships == compare.in_sharp_turns(name, 'sharp turns', 20, 3)


def test_a_scenario_is_scored_as_a_recording():
    chosen = scenario.load('clean')
    found = replay.figures(replay.simulated(chosen, 3), 'imm')
    assert found['held'] > 0.95 and found['false_tracks'] == 0


def test_the_table_is_written_between_its_marks_only(tmp_path):
    page = tmp_path / 'page.md'
    page.write_text(f'above\n{compare.BEGIN}\nold\n{compare.END}\nbelow\n')
    compare.write_table(str(page), FOUND)
    lines = page.read_text().splitlines()
    assert lines[:2] == ['above', compare.BEGIN] and lines[-2:] == [compare.END, 'below']
    assert len(lines) == 8
    assert lines[4].startswith('| one | **10.0** / **1.00** (99 %) | 11.0 / **1.00** (99 %) |')
    assert lines[5].startswith('| two | - / - | - / - |')
    page.write_text('no marks')
    with pytest.raises(ValueError, match='has not the lines'):
        compare.write_table(str(page), FOUND)


def test_the_picture_is_drawn(tmp_path):
    pytest.importorskip('matplotlib')
    (file,) = draw(tmp_path, [pictures.picture(FOUND)])
    assert file.name == 'compare.png' and file.stat().st_size > 10_000


@pytest.mark.slow
def test_a_run_tells_every_estimator_in_every_scene_and_of_the_encounters(monkeypatch, tmp_path):
    monkeypatch.setattr(compare.imazu_encounters, 'IMAZU', ((180,),))
    monkeypatch.setattr(
        compare, 'ESTIMATORS', {name: ESTIMATORS[name] for name in ('cs_kalman', 'imm')}
    )
    page = tmp_path / 'page.md'
    page.write_text(f'{compare.BEGIN}\n{compare.END}')
    found = compare.run(4, 1, page=str(page), workers=1)
    names = {figure.name for figure in found.figures}
    assert {
        'imm, busy strait: held',
        'cs_kalman, boat: velocity',
        'imm, Imazu: warned with 6 minutes left',
    } <= names
    assert 'busy strait' in page.read_text() and len(found.pictures) == 1
