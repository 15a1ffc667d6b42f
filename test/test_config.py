"""The shipped configuration is found wherever the package stands."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from marine_tracker import config

ROOT = Path(config.__file__).resolve().parents[1]


def found_by(package, parts=('tracker.yaml',)):
    """What config.path answers in a new process that imports the package from a given place."""
    code = f'from marine_tracker import config; print(config.path(*{parts!r}))'
    # -P keeps the current folder, which may hold the source tree, out of the way.
    return subprocess.run(
        [sys.executable, '-P', '-c', code],
        env={'PYTHONPATH': str(package.parent)},
        capture_output=True,
        text=True,
        timeout=60,
    )


@pytest.fixture
def package_in(tmp_path):
    """Copies what config.py needs of the package into a folder below tmp_path."""

    def copy(folder):
        package = tmp_path / folder / 'marine_tracker'
        package.mkdir(parents=True)
        for name in ('__init__.py', 'config.py'):
            shutil.copy(ROOT / 'marine_tracker' / name, package)
        return package

    return copy


def test_source_tree_uses_its_own_config():
    assert config.path() == ROOT / 'config'
    assert config.path('scenarios', 'x.yaml') == ROOT / 'config' / 'scenarios' / 'x.yaml'


@pytest.mark.parametrize(
    'libraries',
    [
        'lib/python3.12/site-packages',  # pip in a venv, colcon
        'local/lib/python3.12/dist-packages',  # Debian's Python
        'somewhere',  # pip --target
    ],
)
def test_installed_package_uses_the_share_of_its_prefix(package_in, tmp_path, libraries):
    package = package_in(libraries)
    share = tmp_path / 'share' / 'marine_tracker' / 'config'
    share.mkdir(parents=True)
    answer = found_by(package)
    assert answer.stdout.strip() == str(share / 'tracker.yaml'), answer.stderr


def test_package_without_configuration_says_so(package_in):
    answer = found_by(package_in('lib/python3.12/site-packages'))
    assert answer.returncode != 0
    assert 'no configuration found for the marine_tracker package' in answer.stderr
