import json

import numpy as np
import pytest
from pyproj import Geod

from marine_tracker.cli import main
from marine_tracker.recording import csv_folder
from marine_tracker.simulation import scenario

WRONG = 'duration_s: 60\ntargets:\n  - {start: {range_nm: 5, bearing_deg: 1}, speed_kn: 700}\n'


def test_list_names_every_shipped_scenario_with_its_targets(capsys):
    assert main(['scenario', 'list']) == 0
    lines = capsys.readouterr().out.splitlines()[1:]
    assert [line.split()[0] for line in lines] == scenario.shipped()
    assert lines[scenario.shipped().index('busy_strait')].split()[1:4] == ['40', '30', 'min']


def test_check_says_ok_or_what_is_wrong(tmp_path, capsys):
    file = tmp_path / 'wrong.yaml'
    file.write_text(WRONG)
    assert main(['scenario', 'check', 'encounters']) == 0
    assert main(['scenario', 'check', str(file), 'clean']) == 1
    told = capsys.readouterr()
    assert 'encounters: ok, 3 targets, 550 scans' in told.out
    assert 'clean: ok' in told.out
    assert f'{file}: targets[0].speed_kn is 700; it must be between 0 and 100' in told.err


def test_show_tells_where_targets_start_and_how_near_they_come(capsys):
    assert main(['scenario', 'show', 'encounters']) == 0
    told = capsys.readouterr().out
    assert 'own ship: course 000.0, 14.0 kn' in told
    row = next(line for line in told.splitlines() if line.startswith(' 1'))
    # 9 NM at 358 deg, closing at 27 kn: 9 sin 2 deg = .31 NM after 20.0 min
    assert row.split()[2:] == ['9.00', '358.0', '180.0', '13.0', '0.31', '20.0']


def test_show_draws_a_picture(tmp_path, capsys):
    pytest.importorskip('matplotlib')
    file = tmp_path / 'chart.png'
    assert main(['scenario', 'show', 'clean', '--plot', str(file)]) == 0
    assert file.read_bytes().startswith(b'\x89PNG')


def test_write_makes_a_recording_that_repeats_to_the_byte(tmp_path, capsys):
    for folder, seed in (('a', 3), ('b', 3), ('c', 4)):
        folder = str(tmp_path / folder)
        assert main(['scenario', 'write', 'clean', folder, '--seed', str(seed)]) == 0
    a, b, c = ((tmp_path / folder / 'plots.csv').read_bytes() for folder in 'abc')
    assert a == b != c
    recording = csv_folder.read(tmp_path / 'a')
    assert len(recording.scans) == scenario.load('clean').scans
    assert recording.notes['uncooperative'] is False
    # two bearing sigmas, .3 deg, at 8 NM
    assert recording.notes['seen_within_m'] == 155
    assert recording.tracker_parameters == pytest.approx(
        scenario.load('clean').tracker_parameters()
    )


@pytest.mark.parametrize('start', [(-16.8, 179.99), (79.5, -179.98)])
def test_ships_by_ais_over_the_date_line_are_written_tracked_and_scored(tmp_path, start):
    """From AIS file to score: own ship goes over the line, the other comes towards her."""
    earth, lines = Geod(ellps='WGS84'), ['time_s,vessel,lat_deg,lon_deg']
    towards = 90.0 if start[1] > 0 else 270.0
    for time in np.arange(0.0, 310, 10):
        for vessel, along in (('own', 9 * time), ('other', 3000 - 6 * time)):
            lon, lat, _ = earth.fwd(*start[::-1], towards, along)
            lines.append(f'{time:g},{vessel},{lat:.9f},{lon:.9f}')
    (tmp_path / 'ais.csv').write_text('\n'.join(lines) + '\n')
    (tmp_path / 'line.yaml').write_text(
        'duration_s: 180\nais: {file: ais.csv}\nown_ship: {vessel: own}\n'
    )
    scene, made, tracks = (str(tmp_path / name) for name in ('line.yaml', 'made', 'tracks.csv'))
    assert main(['scenario', 'write', scene, made]) == 0
    assert json.loads((tmp_path / 'made' / 'notes.json').read_text())['origin'] == list(start)
    assert main(['replay', made, '--out', tracks]) == 0
    figures = str(tmp_path / 'figures.json')
    given = ['--ais', str(tmp_path / 'ais.csv'), '--json', figures]
    assert main(['score', made, tracks, *given]) == 0
    found = {
        one['name']: one['value']
        for one in json.loads((tmp_path / 'figures.json').read_text())['figures']
    }
    assert found['vessels'] == 1 and found['held'] > 0.9 and found['strangers'] == 0
    assert abs(found['range_error_mean_m']) < 10 and abs(found['bearing_error_mean_deg']) < 0.3


def test_unknown_scenario_ends_with_one_line(capsys):
    assert main(['scenario', 'show', 'nowhere']) != 0
    assert 'no scenario nowhere' in capsys.readouterr().err
