"""What is committed of OpenBridge is what its sources in web/ give."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STATIC = ROOT / 'marine_tracker' / 'display' / 'static'
BUILT = ('openbridge.js', 'openbridge.css')


def test_a_build_of_the_bundle_gives_the_committed_one(tmp_path):
    if not (ROOT / 'web' / 'node_modules').is_dir() or not shutil.which('node'):
        pytest.skip('web/node_modules is missing (cd web && npm ci): the bundle is not rebuilt')
    for name in ('colours.css', 'style.css'):
        shutil.copy(STATIC / name, tmp_path)
    done = subprocess.run(
        ['node', 'build.mjs', tmp_path],
        cwd=ROOT / 'web',
        capture_output=True,
        text=True,
        timeout=100,
    )
    assert done.returncode == 0, done.stderr
    for name in BUILT:
        assert (tmp_path / name).read_bytes() == (STATIC / name).read_bytes(), (
            f'npm run build: {name}'
        )


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
