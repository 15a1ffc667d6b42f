"""Recordings pass the screen of live data."""

import numpy as np
import pytest

from marine_tracker.cli import main
from marine_tracker.evaluation import screened
from marine_tracker.recording import csv_folder
from marine_tracker.simulation import radar, scenario


@pytest.fixture
def folder(tmp_path):
    """30 scans of a scenario as a recording."""
    chosen = scenario.load('clean')
    pairs = [pair for pair, _ in zip(radar.simulate(chosen, 5), range(30))]
    csv_folder.write(tmp_path / 'rec', 'clean', pairs, chosen.tracker_parameters())
    return tmp_path / 'rec'


def change(file, row, **cells):
    """Other cells in a row of a table."""
    lines = file.read_text().splitlines()
    names, values = lines[0].split(','), lines[row].split(',')
    for name, value in cells.items():
        values[names.index(name)] = value
    lines[row] = ','.join(values)
    file.write_text('\n'.join(lines) + '\n')


def test_a_good_recording_comes_back_as_it_is(folder):
    recording = csv_folder.read(folder)
    same, counts = screened.screened(recording)
    assert same is recording and not counts


def test_recorded_radars_pass_untouched(recordings):
    for path in sorted(recordings.iterdir()):
        if (path / 'own_ship.csv').exists():
            recording = csv_folder.read(path)
            same, counts = screened.screened(recording)
            assert same is recording, (path.name, counts)


@pytest.mark.parametrize(
    ('cells', 'reason'),
    [
        ({'range_m': '1e307'}, 'plots beyond 500 km'),
        ({'range_m': '0'}, 'plots with range not positive'),
        ({'time_s': '5e8'}, 'plots with time out of the scan'),
    ],
)
def test_bad_plots_are_rejected_and_counted(folder, cells, reason):
    before = csv_folder.read(folder)
    change(folder / 'plots.csv', 4, **cells)
    recording, remarks = screened.read(folder)
    assert remarks == (f'recording rec; rejected: 1 {reason}',)
    left = [len(scan.plots.range) for scan in recording.scans]
    was = [len(scan.plots.range) for scan in before.scans]
    assert sum(was) - sum(left) == 1
    assert len(recording.scans) == len(before.scans) == len(recording.numbers)


@pytest.mark.parametrize('north', ['4e299', '-6e8', '30000'])
def test_own_ship_stays_where_her_good_samples_put_her(folder, north):
    before = csv_folder.read(folder)
    change(folder / 'own_ship.csv', 12, north_m=north)
    recording, (remark,) = screened.read(folder)
    assert 'samples of own ship of 30' in remark
    apart = np.hypot(*(recording.own_ship.position - before.own_ship.position).T)
    assert apart.max() < 1.0
    for scan, was in zip(recording.scans, before.scans):
        np.testing.assert_allclose(scan.own_ship.position, was.own_ship.position, atol=1.0)


def test_replay_and_score_go_on_and_tell(folder, tmp_path, capsys):
    change(folder / 'plots.csv', 2, range_m='9e305')
    change(folder / 'own_ship.csv', 9, east_m='7e290')
    tracks = str(tmp_path / 'tracks.csv')
    for command in (['replay', str(folder), '--out', tracks], ['score', str(folder), tracks]):
        assert main(command) == 0
        said = capsys.readouterr().err
        assert '1 plots beyond 500 km' in said and 'samples of own ship of 30' in said
    with open(tracks) as file:
        assert 'nan' not in file.read()


def test_times_beyond_all_clocks_are_refused_by_line(folder):
    change(folder / 'own_ship.csv', 30, time_s='3e250')
    with pytest.raises(ValueError, match=r'own_ship.csv, line 31: time_s is 3e250'):
        screened.read(folder)
