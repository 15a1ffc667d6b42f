"""The numbered examples run as they stand and print what they promise."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import marine_tracker

EXAMPLES = Path(marine_tracker.__file__).resolve().parents[1] / 'examples'


def output_of(example, *arguments):
    """What an example prints, run from another folder than its own."""
    run = subprocess.run(
        [sys.executable, EXAMPLES / example, *arguments],
        cwd='/',
        timeout=100,
        env={'PYTHONPATH': str(EXAMPLES.parent), 'PATH': ''},
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stderr
    return run.stdout


def metres(text):
    return [float(number) for number in re.findall(r'([\d.]+) m$', text, re.M)]


def test_every_example_is_run_here():
    tested = set(re.findall(r"output_of\('(\d\d_\w+\.py)'", Path(__file__).read_text()))
    assert {file.name for file in EXAMPLES.glob('*.py')} == tested


def test_simulated_targets_are_tracked():
    errors = metres(output_of('01_track_simulated_radar.py'))
    # Three ships; a plot at 2.5 NM is off by some 36 m RMS, a track by less.
    assert len([error for error in errors if error < 100]) == 3


@pytest.mark.parametrize('source', ['scenario', pytest.param('recording', marks=pytest.mark.slow)])
def test_recording_is_replayed_and_scored(source, request):
    arguments = []
    if source == 'recording':
        arguments = [request.getfixturevalue('recordings') / 'autosea_joyride']
    text = output_of('02_replay_recording.py', *arguments)
    held = re.findall(r'^(cs_kalman|imm) +held +([\d.]+)%', text, re.M)
    assert [name for name, _ in held] == ['cs_kalman', 'imm']
    assert all(float(percent) > 80 for _, percent in held)


def test_own_estimator_is_about_as_good_as_a_shipped_one():
    shipped, own = metres(output_of('03_write_an_estimator.py'))
    assert 0 < own < 2 * shipped


def test_two_radars_are_better_than_each_and_one_may_fail():
    x, s, both, fails = metres(text := output_of('05_two_radars.py'))
    assert max(both, fails) < min(x, s)
    assert re.findall(r'followed by (\d+) tracks', text) == ['6'] * 4


def test_the_picture_shows_the_ships_of_the_strait(tmp_path):
    pytest.importorskip('matplotlib')
    drawn = output_of('04_draw_tracks.py', tmp_path / 'strait.png')
    assert 36 <= int(drawn.split()[0]) <= 44
    assert (tmp_path / 'strait.png').stat().st_size > 50_000
