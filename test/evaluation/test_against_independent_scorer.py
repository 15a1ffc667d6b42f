"""The product's scorer against the independent one that stands beside the recordings."""

import json
import subprocess
import sys

import numpy as np
import pytest

from marine_tracker.evaluation import metrics
from marine_tracker.evaluation.replay import open_source, write_tracks
from marine_tracker.recording import csv_folder, track_file
from marine_tracker.service import service_for


@pytest.fixture(scope='module')
def scorer(recordings):
    tool = recordings.parent / 'tools' / 'score_recording.py'
    if not tool.is_file():
        pytest.skip(f'no independent scorer: {tool} does not exist')
    return tool


def tracks_of(folder, path):
    source = open_source(str(folder))
    with open(path, 'w') as file:
        write_tracks(service_for(source.tracker_parameters), source.scans, file)


def roughen(path):
    """Harder to score: rows by time alone, tracks that swap names and stray, duplicates, gaps."""
    header, *lines = path.read_text().splitlines()
    keep = [i for i, name in enumerate(header.split(',')) if name != 'scan']
    rng = np.random.default_rng(11)
    rough = []
    for line in lines:
        cells = line.split(',')
        cells[1] = str(int(cells[1]) % 5)
        cells[3] = f'{float(cells[3]) + 20 * rng.standard_t(2):.4f}'
        if rng.random() < 0.9:
            rough.append(','.join(cells[i] for i in keep))
    path.write_text('\n'.join([','.join(header.split(',')[i] for i in keep), *rough]) + '\n')


@pytest.mark.parametrize(
    ('rough', 'options'),
    [(False, {}), (True, {'cutoff': 60.0, 'bias_deg': -1.8, 'lag': 0.5})],
    ids=['tracks and notes', 'rough tracks and options'],
)
@pytest.mark.parametrize('name', ['autosea_joyride', 'autoferry_03', 'autoferry_13'])
def test_every_figure_agrees(recordings, scorer, tmp_path, name, rough, options):
    tracks, figures = tmp_path / 'tracks.csv', tmp_path / 'figures.json'
    tracks_of(recordings / name, tracks)
    if rough:
        roughen(tracks)
    flags = {'cutoff': '--c', 'bias_deg': '--bias-deg', 'lag': '--lag-s'}
    subprocess.run(
        [
            sys.executable,
            scorer,
            recordings / name,
            tracks,
            '--json',
            figures,
            *(f'{flags[key]}={value}' for key, value in options.items()),
        ],
        check=True,
        capture_output=True,
    )
    theirs = json.loads(figures.read_text())
    ours = metrics.score(csv_folder.read(recordings / name), track_file.read(tracks), **options)
    assert set(theirs) == {*ours.figures, 'recording', 'per_target', 'false_counts_uncooperative'}
    assert theirs['recording'] == name
    assert theirs['false_counts_uncooperative'] == ours.counts_strangers
    for figure, value in ours.figures.items():
        assert value == pytest.approx(theirs[figure], rel=1e-9, abs=1e-12), figure
    assert {str(target) for target in ours.targets} == set(theirs['per_target'])
    for target, values in ours.targets.items():
        assert values == pytest.approx(theirs['per_target'][str(target)], rel=1e-9), target
