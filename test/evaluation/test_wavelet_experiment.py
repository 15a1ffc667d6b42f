import json

import numpy as np
import pytest

from marine_tracker.cli import main
from marine_tracker.evaluation.experiments import wavelet, wavelet_study
from marine_tracker.evaluation.experiments.result import BORNE_OUT, IN_PART, NOT_BORNE_OUT

RUNS, SEED = 10, 3


@pytest.fixture(scope='module')
def result():
    return wavelet.run(RUNS, SEED)


@pytest.fixture(scope='module')
def figures(result):
    return {figure.name: figure for figure in result.figures}


@pytest.mark.parametrize('scene', wavelet_study.SCENES)
def test_the_scenes_move_as_the_kinematics_say(scene):
    path = wavelet_study.truth(scene)
    before = np.concatenate([wavelet_study.START[None], path[:-1]])
    for axis in (0, 3):
        x, v, a = path[:, axis:axis + 3].T
        np.testing.assert_allclose(v - before[:, axis + 1], a, atol=1e-9)
        np.testing.assert_allclose(x - before[:, axis], 0.5 * (v + before[:, axis + 1]), atol=1e-6)
    assert np.hypot(*path[:, ::3].T).max() < 200e3


def test_turns_bend_the_way_and_brakes_slow_it():
    path = wavelet_study.truth('manv')
    speed, course = np.hypot(path[:, 1], path[:, 4]), np.unwrap(np.arctan2(path[:, 4], path[:, 1]))
    assert course[239] > course[199] + 0.5 and course[399] < course[349] - 0.5
    assert speed[559] < speed[549] - 100
    np.testing.assert_allclose(np.diff(course[60:199]), 0, atol=1e-9)


def test_all_limits_are_met_with_few_runs(figures):
    missed = [name for name, figure in figures.items() if figure.ok is False]
    assert not missed
    assert sum(figure.ok is not None for figure in figures.values()) == 16


def test_honest_findings_are_in_the_table(figures):
    """Smoothing the Kalman filter as late is no worse, and the IMM is better at sea."""
    for scene in wavelet_study.SCENES:
        assert (figures[f'{scene}, CS-Kalman + RTS: block mean'].value
                < figures[f'{scene}, late, coarse: block mean'].value
                < figures[f'{scene}, CS-Kalman'].value)
    assert figures['sea, imm: velocity'].value < figures['sea, a_max 1, wavelet_cs: velocity'].value


def test_every_claim_has_its_verdict(result):
    verdicts = {claim.source: claim.verdict for claim in result.claims}
    assert verdicts == {'section 5': IN_PART, 'eq 14': NOT_BORNE_OUT, 'eq 13': NOT_BORNE_OUT,
                        'eq 13 to 15': NOT_BORNE_OUT, 'this project': BORNE_OUT}


def test_the_command_prints_claims_and_draws_pictures(tmp_path, capsys):
    pytest.importorskip('matplotlib')
    out = tmp_path / 'pictures'
    main(['experiments', 'wavelet', '--runs', '2', '--seed', '4', '--pictures', str(out),
          '--json', '-'])
    printed = capsys.readouterr()
    assert len(json.loads(printed.out)['claims']) == 5
    assert 'eq 14: "the block is put together from its low-pass part":' in printed.err
    assert [file.stem for file in sorted(out.iterdir())] == ['wavelet_a_max', 'wavelet_fig1']
    for file in out.iterdir():
        assert file.read_bytes().startswith(b'\x89PNG') and file.stat().st_size > 10000
