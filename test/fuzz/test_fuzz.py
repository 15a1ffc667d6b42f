"""The fuzzers with a fixed seed, short here; in full by `make fuzz`."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

FUZZ = Path(__file__).with_name('fuzz.py')
ROOT = Path(__file__).resolve().parents[2]
CASES = {'yaml': 300, 'csv': 200, 'weights': 200, 'clouds': 300, 'odometry': 300}
MESSAGES = ('clouds', 'odometry')


def run(folder, kind, *numbers):
    if kind in MESSAGES:
        pytest.importorskip('rclpy')
    done = subprocess.run(
        [sys.executable, str(FUZZ), kind, *map(str, numbers)],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, 'PYTHONPATH': str(ROOT)},
    )
    assert done.returncode == 0, done.stderr[-5000:]
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.parametrize('kind', CASES)
def test_whatever_comes_in_gives_values_or_one_clear_line(tmp_path, kind):
    figures = run(tmp_path, kind, CASES[kind], 7)
    assert figures['failed'] == 0 and figures['cases'] == CASES[kind]
    if kind != 'odometry':
        assert 0 < figures['refused'] < figures['cases']


@pytest.mark.fuzz
@pytest.mark.timeout(3600)
@pytest.mark.parametrize('kind', CASES)
def test_the_same_at_length(tmp_path, kind):
    figures = run(tmp_path, kind)
    print(figures)
    assert figures['failed'] == 0
