import json

import pytest

from marine_tracker import cli
from marine_tracker.evaluation import ais_score, metrics
from marine_tracker.geodesy import LocalFrame

COLUMNS = 'time_s,track,status,north_m,east_m,vel_north_mps,vel_east_mps\n'


@pytest.fixture
def folder(tmp_path):
    """One target that goes north at 4 m/s, seen in each of 8 scans, 10 m east of its track."""
    plots, own_ship, truth, tracks = ([] for _ in range(4))
    for k in range(8):
        plots += [f'{k},{2 * k},{500 + 8 * k},0', f'{k},{2 * k},100,180', f'{k},{2 * k},900,180']
        own_ship.append(f'{k},{2 * k},0,0')
        truth.append(f'{k},{2 * k},3,{500 + 8 * k},0,4,0')
        tracks.append(f'{2 * k},1,confirmed,{500 + 8 * k},10,4,0')
    for name, header, rows in (
        ('plots', 'scan,time_s,range_m,bearing_deg\n', plots),
        ('own_ship', 'scan,time_s,north_m,east_m\n', own_ship),
        ('truth', 'scan,time_s,target,north_m,east_m,vel_north_mps,vel_east_mps\n', truth),
        ('tracks', COLUMNS, tracks),
    ):
        (tmp_path / f'{name}.csv').write_text(header + '\n'.join(rows) + '\n')
    return tmp_path


def figures(text):
    return {figure['name']: figure['value'] for figure in json.loads(text)['figures']}


def test_json_on_standard_output_is_one_object_and_the_table_goes_beside(command, folder):
    done = command('score', folder, folder / 'tracks.csv', '--json', '-')
    assert done.returncode == 0
    found = figures(done.stdout)
    assert found['position_rmse_m'] == pytest.approx(10) and found['held'] == 1
    assert list(found) == [
        *metrics.FIGURES,
        *(f'target_3_{name}' for name in metrics.TARGET_FIGURES),
    ]
    assert json.loads(done.stdout)['recording'] == folder.name
    assert 'position_rmse_m' in done.stderr


def test_options_reach_the_scorer(command, folder):
    done = command(
        'score',
        folder,
        folder / 'tracks.csv',
        '--json',
        folder / 'figures.json',
        '--cutoff',
        '5',
        '--lag-s',
        '2',
        '--bias-deg',
        '-3',
    )
    assert done.returncode == 0 and 'position_rmse_m' in done.stdout
    found = figures((folder / 'figures.json').read_text())
    assert found['cutoff_m'] == 5 and found['held'] == 0
    assert found['position_rmse_m'] is None and found['never_confirmed'] == 1


def test_help_says_what_each_figure_is(capsys):
    with pytest.raises(SystemExit):
        cli.main(['score', '--help'])
    out = capsys.readouterr().out
    for name, (_, text) in metrics.FIGURES.items():
        assert f'{name} ' in out and text in out


def test_a_recording_without_truth_and_a_bad_track_file_are_one_line_errors(capsys, folder):
    tracks = folder / 'tracks.csv'
    tracks.write_text(COLUMNS + '0,1,confirmed,x,0,0,0\n')
    assert cli.main(['score', str(folder), str(tracks)]) == 2
    assert "tracks.csv, line 2: north_m is 'x'" in capsys.readouterr().err
    tracks.write_text(COLUMNS)
    (folder / 'truth.csv').unlink()
    assert cli.main(['score', str(folder), str(tracks)]) == 2
    err = capsys.readouterr().err
    assert 'has no truth to score against' in err and err.count('\n') == 1


@pytest.fixture
def ais(folder):
    """The target's own reports, every 4 s, of a frame whose zero lies at 55 N 7 E."""
    frame = LocalFrame(55, 7)
    lines = [f'{t},boat,{frame.to_geodetic([0, 500 + 4 * t])[0]:.9f},7' for t in range(-8, 28, 4)]
    (folder / 'ais.csv').write_text('time_s,vessel,lat_deg,lon_deg\n' + '\n'.join(lines) + '\n')
    return folder / 'ais.csv'


def test_track_files_score_against_ais(command, folder, ais):
    tracks = folder / 'tracks.csv'
    (folder / 'truth.csv').unlink()  # not needed
    done = command(
        'score', folder, tracks, tracks, '--ais', ais, '--origin-deg', '55', '7', '--json', '-'
    )
    assert done.returncode == 0, done.stderr
    found = figures(done.stdout)
    assert list(found) == list(ais_score.FIGURES)
    assert found['runs'] == 2 and found['tracks'] == 1
    assert found['bearing_error_mean_deg'] == pytest.approx(1.08, abs=0.1)  # 10 m of 528 m
    assert json.loads(done.stdout)['ais'] == str(ais)
    (folder / 'notes.json').write_text('{"origin": [55, 7], "ais_start_s": 100}')
    given = ['score', str(folder), str(tracks), '--ais', str(ais)]
    assert cli.main(given) == 2  # no vessel then
    assert cli.main([*given, '--ais-start-s', '0']) == 0


def test_what_ais_lacks_is_a_one_line_error(capsys, folder, ais):
    tracks = str(folder / 'tracks.csv')
    for arguments, message in (
        ([tracks, '--ais', str(ais)], 'does not tell where on Earth it is'),
        ([tracks, tracks], '2 track files are given; without --ais it must be one'),
        ([tracks, '--ais', 'none.csv', '--origin-deg', '55', '7'], 'none.csv does not exist'),
        (
            [tracks, '--ais', str(ais), '--origin-deg', '55', '7', '--cutoff', '-1'],
            'cutoff_m is -1.0; it must be a number, above 0',
        ),
        ([tracks, '--ais', str(ais), '--origin-deg', '95', '7'], 'origin is [95.0, 7.0]'),
    ):
        assert cli.main(['score', str(folder), *arguments]) == 2
        err = capsys.readouterr().err
        assert message in err and err.count('\n') == 1
