import json

import numpy as np
import pytest

from marine_tracker.cli import main
from marine_tracker.evaluation.result import BORNE_OUT, IN_PART, NOT_BORNE_OUT
from marine_tracker.lab.gwnn_paper import gwnn_paper
from marine_tracker.lab.gwnn_paper import study as paper

RUNS, SEED = 8, 3


@pytest.fixture(scope='module')
def result():
    return gwnn_paper.run(RUNS, SEED)


@pytest.fixture(scope='module')
def figures(result):
    return {figure.name: figure for figure in result.figures}


def test_the_papers_target_sails_as_described():
    z = paper.track(600, turn_at=500)
    np.testing.assert_allclose(z[0], [4600, np.radians(30), 9.26, np.radians(70)])
    time = np.arange(600) * paper.PERIOD
    np.testing.assert_allclose(z[:, 2], 9.26 + 1.03 * np.sin(2 * np.pi * time / 1000))
    np.testing.assert_allclose(z[:501, 3], np.radians(70))
    np.testing.assert_allclose(z[520:, 3], np.radians(120))
    # The rate of the turn is the speed over the radius.
    rate = np.diff(z[501:506, 3]) / paper.PERIOD
    np.testing.assert_allclose(rate, z[501:505, 2] / 200, rtol=0.01)


def test_noise_is_as_stated_on_range_and_across():
    truth = paper.track(400)
    seen = paper.noisy(truth, 50, np.random.default_rng(1))
    off = seen - truth
    for error in (off[..., 0], off[..., 1] * truth[:, 0]):
        count = error.size
        assert abs(error.mean() - 0.5) < 4 * 0.3 / np.sqrt(count)
        assert abs(error.std() - 0.3) < 4 * 0.3 / np.sqrt(2 * count)
    # Speed from positions ten scans apart: the truth's mean, two errors of 0.3 m.
    assert off[:, 10:, 2].std() < 0.1


def test_convergence_counts_the_plots_before_ten_good_scans():
    error = np.full((3, 40), 1.0)
    error[0, :7] = 50.0
    error[1, 25] = 50.0
    error[2] = 50.0
    np.testing.assert_array_equal(paper.plots_to_converge(error), [8, 1, 40])


def test_two_points_extrapolate_a_straight_run_exactly_but_for_the_wave():
    truth = paper.track(100)
    error = paper.radial_error(paper.two_point(truth), truth)[2:]
    assert error.max() < 0.1


def test_all_limits_are_met_with_few_seeds(figures):
    missed = [name for name, figure in figures.items() if figure.ok is False]
    assert not missed
    demanded = [figure for figure in figures.values() if figure.ok is not None]
    assert len(demanded) == 9


def test_the_networks_converge_in_the_papers_order(figures):
    plots = [
        figures[f'Fig 2, 3, plots to 1.852 m: {name}'].value
        for name in ('GWNN, variable step', 'BP, variable step', 'BP, equal step')
    ]
    assert plots[0] * 5 < plots[1] < plots[2]


def test_honest_findings_are_in_the_table(figures):
    assert figures["eq 20-22, 1/q at which max|psi'| = 1/2q"].value < 0.9
    assert (
        figures['eq 20-21 fails at 1/q = 0.9: one net input'].value
        > figures['eq 20-21 fails at 1/q = 0.6: one net input'].value
    )
    line = figures['Fig 5, peak in the turn: line through two plots'].value
    assert line == pytest.approx(3.73, abs=0.05)
    assert all(
        line < figure.value
        for name, figure in figures.items()
        if name.startswith('Fig 5') and 'line' not in name
    )
    assert (
        figures['noise of a radar, 15 m: GWNN'].value
        > figures['noise of a radar, 15 m: the plots'].value
    )


def test_every_claim_has_its_verdict(result):
    assert {claim.source for claim in result.claims} == {
        'Fig 1',
        'Fig 2, 3',
        'Fig 4',
        'Fig 5',
        'abstract',
        'eq 20-22',
        'below eq 14',
        'eq 23',
    }
    verdicts = {claim.source: claim.verdict for claim in result.claims}
    assert verdicts['Fig 2, 3'] == BORNE_OUT
    assert verdicts['abstract'] == NOT_BORNE_OUT
    assert verdicts['eq 20-22'] == IN_PART


def test_the_command_prints_claims_and_draws_pictures(figures, tmp_path, capsys):
    pytest.importorskip('matplotlib')
    out = tmp_path / 'pictures'
    code = main(
        [
            'experiments',
            'gwnn_paper',
            '--runs',
            '2',
            '--seed',
            str(SEED),
            '--pictures',
            str(out),
            '--json',
            '-',
        ]
    )
    printed = capsys.readouterr()
    told = json.loads(printed.out)
    assert code == (0 if all(figure['ok'] is not False for figure in told['figures']) else 1)
    assert len(told['claims']) == 8
    assert len(told['figures']) == len(figures)
    assert 'Fig 5: "in the sharp turn the GWNN errs less than the BP network":' in printed.err
    files = sorted(out.iterdir())
    assert [file.stem for file in files] == [
        'eq20_22_robustness',
        'fig1_steady',
        'fig2_3_convergence',
        'fig4_noise',
        'fig5_sharp_turn',
    ]
    for file in files:
        assert file.read_bytes().startswith(b'\x89PNG') and file.stat().st_size > 10000


def test_other_seeds_give_other_figures_and_the_same_seed_the_same():
    one, same, other = (
        paper.steady(3, np.random.default_rng(seed), scans=120)[1] for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(one, same)
    assert (one != other).all()
