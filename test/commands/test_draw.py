"""`draw`: a recording as a picture."""

import numpy as np
import pytest

from marine_tracker import cli
from marine_tracker.commands import draw
from marine_tracker.evaluation import screened
from marine_tracker.recording import track_file

SCENE = """
duration_s: 60
own_ship: {course_deg: 20, speed_kn: 8}
radar: {max_range_nm: 3, range_sigma_m: 12, bearing_sigma_deg: 0.4}
clutter: {uniform: 8}
targets:
- {start: {range_nm: 1.6, bearing_deg: 65}, course_deg: 290, speed_kn: 11}
"""


@pytest.fixture(scope='module')
def recorded(tmp_path_factory):
    """A folder and its track file."""
    work = tmp_path_factory.mktemp('draw')
    (work / 'scene.yaml').write_text(SCENE)
    assert cli.main(['scenario', 'write', str(work / 'scene.yaml'), str(work / 'scene')]) == 0
    words = ['replay', str(work / 'scene'), '--out', str(work / 'tracks.csv')]
    assert cli.main([*words, '--estimator', 'imm']) == 0
    return work


def test_panels_of_track_files_are_drawn_beside_each_other(recorded, capsys):
    tracks = str(recorded / 'tracks.csv')
    sizes = []
    for files in ([], [tracks], [tracks, tracks]):
        picture = recorded / f'{len(files)}.png'
        assert cli.main(['draw', str(recorded / 'scene'), *files, '--out', str(picture)]) == 0
        head = picture.read_bytes()[:24]
        assert head.startswith(b'\x89PNG')
        sizes.append(int.from_bytes(head[16:20], 'big'))
    assert sizes[1] == sizes[0] and sizes[2] == 2 * sizes[0]
    assert 'drawn: ' in capsys.readouterr().out


def test_rows_far_from_every_target_are_false(recorded):
    recording, _ = screened.read(recorded / 'scene')
    rows = track_file.read(recorded / 'tracks.csv')
    known = np.isin(rows.status, draw.AIMED)
    assert draw.near_truth(recording, rows, 150.0)[known].all()
    apart = rows._replace(position=rows.position + [400.0, 0.0])
    assert not draw.near_truth(recording, apart, 150.0)[known].any()


@pytest.mark.parametrize(
    'words, said',
    [(['--out', 'x.txt'], '--out is x.txt'), (['--out', 'x.png', '--radius', '-3'], 'is -3 m')],
)
def test_wrong_words_are_named(recorded, capsys, words, said):
    assert cli.main(['draw', str(recorded / 'scene'), *words]) == 2
    assert said in capsys.readouterr().err
