import json

import numpy as np
import pytest

from marine_tracker.cli import main
from marine_tracker.evaluation.result import BORNE_OUT, IN_PART, NOT_BORNE_OUT
from marine_tracker.lab.wavelet import study

RUNS, SEED = 10, 3


@pytest.fixture(scope='module')
def told(tmp_path_factory):
    """What the command writes, and where it draws."""
    pytest.importorskip('matplotlib')
    out = tmp_path_factory.mktemp('wavelet')
    code = main(
        [
            'experiments',
            'wavelet',
            '--runs',
            str(RUNS),
            '--seed',
            str(SEED),
            '--json',
            str(out / 'figures.json'),
            '--pictures',
            str(out / 'pictures'),
        ]
    )
    assert code == 0
    return json.loads((out / 'figures.json').read_text()), out / 'pictures'


@pytest.fixture(scope='module')
def figures(told):
    return {figure['name']: figure for figure in told[0]['figures']}


@pytest.mark.parametrize('scene', study.SCENES)
def test_the_scenes_move_as_the_kinematics_say(scene):
    path = study.truth(scene)
    before = np.concatenate([study.START[None], path[:-1]])
    for axis in (0, 3):
        x, v, a = path[:, axis : axis + 3].T
        np.testing.assert_allclose(v - before[:, axis + 1], a, atol=1e-9)
        np.testing.assert_allclose(x - before[:, axis], 0.5 * (v + before[:, axis + 1]), atol=1e-6)
    assert np.hypot(*path[-1, ::3]) < 600e3  # not the 3,800 km of constant acceleration


def test_turns_bend_the_way_and_brakes_slow_it():
    path = study.truth('manv')
    speed, course = np.hypot(path[:, 1], path[:, 4]), np.unwrap(np.arctan2(path[:, 4], path[:, 1]))
    assert course[239] > course[199] + 0.5 and course[399] < course[349] - 0.5
    assert speed[559] < speed[549] - 100
    np.testing.assert_allclose(np.diff(course[60:199]), 0, atol=1e-9)


def test_all_limits_are_met_with_few_runs(figures):
    assert not [name for name, figure in figures.items() if figure['ok'] is False]
    assert sum(figure['ok'] is not None for figure in figures.values()) == 16


def test_honest_findings_are_in_the_table(figures):
    """A smoother as late is no worse, the IMM is better at sea, and missed plots are hard."""
    value = {name: figure['value'] for name, figure in figures.items()}
    for scene in study.SCENES:
        assert (
            value[f'{scene}, CS-Kalman + RTS: block mean']
            < value[f'{scene}, late, coarse: block mean']
            < value[f'{scene}, CS-Kalman']
        )
    assert value['sea, imm: velocity'] < value['sea, a_max 1, wavelet_cs: velocity']
    half = 'sea, circles, 50 % of the plots'
    assert value[f'{half}, wavelet_cs: position'] > 2 * value[f'{half}, CS-Kalman: position']


def test_every_claim_has_its_verdict(told):
    assert {claim['source']: claim['verdict'] for claim in told[0]['claims']} == {
        'section 5': IN_PART,
        'eq 14': NOT_BORNE_OUT,
        'eq 13': NOT_BORNE_OUT,
        'eq 13 to 15': NOT_BORNE_OUT,
        'this project': BORNE_OUT,
    }


def test_pictures_are_drawn(told):
    files = sorted(told[1].iterdir())
    assert [file.stem for file in files] == ['wavelet_a_max', 'wavelet_fig1']
    for file in files:
        assert file.read_bytes().startswith(b'\x89PNG') and file.stat().st_size > 10000
