"""What is committed of the page is what its sources give, and in the form that is agreed on."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STATIC = ROOT / 'marine_tracker' / 'display' / 'static'
BUILT = ('openbridge.js', 'openbridge.css')


def test_a_build_of_the_bundle_gives_the_committed_one(tmp_path, web):
    for file in STATIC.glob('*.css'):
        if file.name not in BUILT:
            shutil.copy(file, tmp_path)
    done = subprocess.run(
        ['node', 'build.mjs', tmp_path], cwd=web, capture_output=True, text=True, timeout=100
    )
    assert done.returncode == 0, done.stderr
    for name in BUILT:
        assert (tmp_path / name).read_bytes() == (STATIC / name).read_bytes(), (
            f'npm run build: {name}'
        )


@pytest.mark.parametrize('check', ['lint', 'check-format'])
def test_modules_keep_to_the_rules(web, check):
    done = subprocess.run(
        ['npm', 'run', '--silent', check], cwd=web, capture_output=True, text=True, timeout=100
    )
    assert done.returncode == 0, f'npm run {check}:\n{done.stdout}{done.stderr}'


def test_the_page_is_small_and_loads_nothing_from_elsewhere():
    files = [file for file in STATIC.iterdir() if file.is_file()]
    assert sum(file.stat().st_size for file in files) < 1_000_000
    for file in files:
        text = file.read_text()
        if file.name not in BUILT:
            assert len(text.splitlines()) <= 350, file.name
            assert 'https://' not in text and 'http://' not in text.replace(
                'http://www.w3.org/', ''
            )
