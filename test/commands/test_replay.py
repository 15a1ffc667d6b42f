import csv
import json
import sys

import numpy as np
import pytest

from marine_tracker import cli, config
from marine_tracker.evaluation import metrics
from marine_tracker.evaluation.replay import open_source
from marine_tracker.recording import csv_folder, track_file
from marine_tracker.simulation import radar, scenario, standard_scenarios
from marine_tracker.types import PolarPlots


@pytest.fixture(scope='module')
def scene(tmp_path_factory):
    """The file of a scenario: `clean`, its first five minutes."""
    shipped = config.path('scenarios', 'clean.yaml').read_text()
    file = tmp_path_factory.mktemp('scene') / 'short.yaml'
    file.write_text(shipped.replace('duration_s: 900', 'duration_s: 300'))
    return file


def replay(out, *arguments):
    assert cli.main(['replay', *map(str, arguments), '--out', str(out)]) == 0
    return out


@pytest.fixture(scope='module')
def tracks(tmp_path_factory, scene):
    return replay(tmp_path_factory.mktemp('replay') / 'tracks.csv', scene)


def test_a_replay_has_the_documented_columns_and_names(tracks):
    with open(tracks, newline='') as file:
        reader = csv.DictReader(file)
        rows = list(reader)
    assert tuple(reader.fieldnames) == track_file.COLUMNS
    assert {row['status'] for row in rows} <= {'tentative', 'confirmed', 'coasting', 'lost'}
    assert {row['estimator'] for row in rows} == {'gwnn'}
    assert {bool(row['pred_north_m']) for row in rows} == {True, False}
    assert [row['pred_north_m'] for row in rows if row['track'] == rows[0]['track']][0] == ''


def test_twice_the_same_is_byte_equal_and_another_seed_is_not(scene, tracks, tmp_path):
    assert replay(tmp_path / 'again.csv', scene).read_bytes() == tracks.read_bytes()
    other = replay(tmp_path / 'other.csv', scene, '--seed', 2)
    assert other.read_bytes() != tracks.read_bytes()


def test_two_processes_give_byte_equal_files(command, scene, tmp_path):
    for name in ('a', 'b'):
        done = command(
            'replay',
            scene,
            '--estimator',
            'imm',
            '--out',
            tmp_path / name,
            PYTHONHASHSEED={'a': '1', 'b': '2'}[name],
        )
        assert done.returncode == 0, done.stderr
        assert done.stdout.startswith('110 scans, ') and done.stdout.count('\n') == 1
        assert done.stderr == ''  # no progress bar without a terminal
    assert (tmp_path / 'a').read_bytes() == (tmp_path / 'b').read_bytes()


def test_standard_output_gets_tracks_alone(command, scene, tracks):
    done = command('replay', scene, '--out', '-')
    assert done.stdout.encode() == tracks.read_bytes()
    assert 'tracks confirmed' in done.stderr


def test_pairs_left_out_in_a_crowd_are_told(capsys, scene, tmp_path):
    """1,500 plots within 150 m in every scan."""
    rng, count = np.random.default_rng(2), 1500

    def crowd():
        for scan, truth in radar.simulate(scenario.load(scene), 1):
            if scan.start > 12.0:
                return
            plots = PolarPlots(
                np.full(count, scan.start),
                rng.uniform(9000, 9150, count),
                rng.uniform(2.0, 2.015, count),
                np.zeros(count),
            )
            yield scan._replace(plots=plots), truth

    csv_folder.write(tmp_path / 'crowd', 'crowd', crowd(), {'range_sigma_m': 15.0})
    replay(tmp_path / 'tracks.csv', tmp_path / 'crowd')
    left_out = int(capsys.readouterr().out.split(' pairs left out')[0].split()[-1])
    assert left_out > 4 * 1_000_000
    replay(tmp_path / 'tracks.csv', scene)
    assert 'left out' not in capsys.readouterr().out


def test_a_written_scenario_replays_and_scores_like_the_scenario_itself(scene, tracks, tmp_path):
    chosen = scenario.load(scene)
    csv_folder.write(
        tmp_path / 'folder', chosen.name, radar.simulate(chosen, 1), chosen.tracker_parameters()
    )
    again = track_file.read(replay(tmp_path / 'tracks.csv', tmp_path / 'folder'))
    first = track_file.read(tracks)
    assert again.track.tolist() == first.track.tolist()
    assert again.status.tolist() == first.status.tolist()
    np.testing.assert_allclose(again.position, first.position, atol=0.01)
    figures = metrics.score(csv_folder.read(tmp_path / 'folder'), again).figures
    assert figures['truth_targets'] == len(
        {int(target) for _, truth in radar.simulate(chosen, 1) for target in truth.target}
    )
    assert figures['held'] > 0.95 and figures['never_confirmed'] == 0


def test_rows_carry_the_numbers_of_the_sources_scans(recordings, tmp_path):
    folder = recordings / 'autoferry_13'
    rows = track_file.read(replay(tmp_path / 'tracks.csv', folder))
    assert set(rows.scan.tolist()) <= set(csv_folder.read(folder).numbers.tolist())


def parameters_of(monkeypatch, folder, *arguments):
    """The tracker parameters that a replay of the folder runs with."""
    seen = []
    module = sys.modules['marine_tracker.commands.replay']
    real = module.Service
    monkeypatch.setattr(module, 'Service', lambda given: seen.append(given) or real(given))
    assert cli.main(['replay', str(folder), '--out', str(folder / 'out.csv'), *arguments]) == 0
    return seen[0]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / 'plots.csv').write_text('scan,time_s,range_m,bearing_deg\n')
    (tmp_path / 'own_ship.csv').write_text('scan,time_s,north_m,east_m\n0,0,0,0\n1,2.5,0,0\n')
    (tmp_path / 'radar.yaml').write_text(
        'range_sigma_m: 3.0\nbearing_sigma_deg: 0.9\nmax_target_speed_mps: 6.0\n'
    )
    return tmp_path


def test_parameters_overrule_each_other_in_the_documented_order(monkeypatch, folder):
    file = folder / 'mine.yaml'
    file.write_text('bearing_sigma_deg: 1.5\nmax_target_speed_mps: 7\nestimator: imm\n')
    used = parameters_of(
        monkeypatch,
        folder,
        '--parameters',
        str(file),
        '--set',
        'max_target_speed_mps=8',
        '--set',
        'vessel_class=small_craft',
        '--estimator',
        'cs_kalman',
    )
    assert (used.range_sigma_m, used.bearing_sigma_deg) == (3.0, 1.5)
    assert (used.max_target_speed_mps, used.vessel_class) == (8.0, 'small_craft')
    assert used.estimator == 'cs_kalman'


def test_a_nodes_parameter_file_is_taken_too(monkeypatch, folder):
    file = folder / 'node.yaml'
    file.write_text(
        '/**:\n  ros__parameters:\n    range_sigma_m: 9.0\n'
        'tracker:\n  ros__parameters:\n    bearing_sigma_deg: 2.0\n'
        'other:\n  ros__parameters:\n    bearing_sigma_deg: 3.0\n'
    )
    used = parameters_of(monkeypatch, folder, '--parameters', str(file))
    assert (used.range_sigma_m, used.bearing_sigma_deg) == (9.0, 2.0)


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (['--set', 'range_sigma=3'], 'unknown parameter range_sigma; did you mean range_sigma_m?'),
        (['--set', 'range_sigma_m=-3'], 'parameter range_sigma_m is -3'),
        (['--set', 'range_sigma_m=far'], "parameter range_sigma_m is 'far'"),
        (['--set', 'range_sigma_m'], '--set range_sigma_m: it must be NAME=VALUE'),
        (['--set', 'range_sigma_m=['], '--set range_sigma_m, line 1 is not YAML'),
        (['--seed', '-1'], '--seed is -1; it must not be negative'),
        (['--parameters', 'none.yaml'], 'none.yaml: no such file or directory'),
    ],
)
def test_wrong_parameters_are_named(folder, capsys, arguments, message):
    assert cli.main(['replay', str(folder), '--out', str(folder / 'out.csv'), *arguments]) == 2
    assert capsys.readouterr().err.startswith(f'marine_tracker: {message}')
    assert not (folder / 'out.csv').exists()


def test_a_parameter_file_of_other_nodes_is_refused(folder, capsys):
    (folder / 'node.yaml').write_text('player:\n  ros__parameters:\n    rate: 2.0\n')
    assert (
        cli.main(
            [
                'replay',
                str(folder),
                '--out',
                str(folder / 'out.csv'),
                '--parameters',
                str(folder / 'node.yaml'),
            ]
        )
        == 2
    )
    assert 'has no parameters of the tracker; it has those of player' in capsys.readouterr().err


def test_a_recording_knows_how_many_scans_it_has(folder):
    source = open_source(str(folder))
    assert source.total == 2 and [number for number, _ in source.scans] == [0, 1]


def test_an_estimator_that_wants_doppler_warns_where_there_is_none(folder, capsys):
    replay(folder / 'out.csv', folder, '--estimator', 'alpha_beta')
    assert 'the plots tell no radial speeds, which alpha_beta wants' in capsys.readouterr().err
    (folder / 'plots.csv').write_text(
        'scan,time_s,range_m,bearing_deg,radial_speed_mps\n0,0,100,0,5\n'
    )
    replay(folder / 'out.csv', folder, '--estimator', 'alpha_beta')
    assert capsys.readouterr().err == ''


def test_the_hf_radars_ships_are_held_with_the_shipped_parameters(tmp_path):
    """Within 6 km, which is three deviations across at 110 km, at the end of the hour."""
    file = config.path('tracker_hf_radar.yaml')
    rows = track_file.read(replay(tmp_path / 'out.csv', 'hf_radar', '--parameters', file))
    loaded = scenario.load('hf_radar')
    last = rows.time > 59 * 60
    place = rows.position[last & (rows.status != 'tentative')]
    truth = loaded.truth_at(59.5 * 60)
    apart = np.linalg.norm(place[:, None] - truth.position, axis=-1)
    assert (apart.min(0) < 6000).all()


def test_two_sources_of_one_scene_are_fused(tmp_path, capsys):
    out = tmp_path / 'tracks.csv'
    short = [tmp_path / f'{which}.yaml' for which in 'xs']
    for file in short:
        scene = standard_scenarios.two_radars(file.stem)
        file.write_text(json.dumps({**scene, 'duration_s': 150}))  # which is YAML
    assert cli.main(['replay', *map(str, short), '--out', str(out)]) == 0
    assert capsys.readouterr().out.startswith('110 scans, ')  # 60 and 50
