"""`marine_tracker screenshots`: pictures of scenes that run."""

import shutil

import pytest

pytest.importorskip('rclpy')
pytest.importorskip('aiohttp', reason='no aiohttp: there is no page')
from marine_tracker.display import browser

if not browser.program():
    pytest.skip('no Chromium: no pictures are taken', allow_module_level=True)


@pytest.mark.slow
def test_a_picture_of_a_scene_is_taken(command, tmp_path):
    done = command('screenshots', tmp_path / 'pictures', '--only', 'hulls', timeout=110)
    assert done.returncode == 0, done.stderr
    (file,) = (tmp_path / 'pictures').iterdir()
    assert file.name == 'ppi_hulls.png' and file.read_bytes().startswith(b'\x89PNG')
    assert file.stat().st_size > 20_000
    shutil.rmtree(tmp_path / 'pictures')


def test_a_picture_that_there_is_not_is_refused_by_name(command, tmp_path):
    done = command('screenshots', tmp_path, '--only', 'sunset')
    assert done.returncode == 2 and '--only is sunset' in done.stderr
