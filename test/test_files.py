"""Files read with bounds, and written whole or not at all; values cut in messages."""

import os
import resource
import signal
import stat
import subprocess
import sys
import time

import pytest

from marine_tracker import files
from marine_tracker.files import shortened, shown, written


def test_a_file_takes_its_place_only_when_it_is_whole(tmp_path):
    path = tmp_path / 'out.csv'
    with written(path) as file:
        file.write('half')
        assert not path.exists()
    assert path.read_text() == 'half' and os.listdir(tmp_path) == ['out.csv']


@pytest.mark.parametrize('error', [ValueError, KeyboardInterrupt, SystemExit])
def test_an_error_leaves_what_was_there_before(tmp_path, error):
    path = tmp_path / 'out.csv'
    path.write_text('old')
    with pytest.raises(error), written(path) as file:
        file.write('new')
        raise error
    assert path.read_text() == 'old' and os.listdir(tmp_path) == ['out.csv']


def test_mode_and_links_stay(tmp_path):
    path, link = tmp_path / 'out', tmp_path / 'link'
    path.write_text('old')
    path.chmod(0o640)
    link.symlink_to(path)
    files.write_text(link, 'é')
    assert link.is_symlink() and path.read_bytes() == 'é'.encode()
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_what_is_no_regular_file_is_written_to(tmp_path):
    files.write_text('/dev/null', 'gone')
    assert stat.S_ISCHR(os.stat('/dev/null').st_mode)


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(FileNotFoundError) as error, written(tmp_path / 'none' / 'out.csv'):
        pass
    assert error.value.filename == str(tmp_path / 'none' / 'out.csv')


def run(*arguments, **how):
    return subprocess.Popen(
        [sys.executable, '-m', 'marine_tracker', *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **how,
    )


def sigint_ends():
    """A shell's job in the background, and so what a test starts there, ignores SIGINT."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.parametrize(('asked', 'code'), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_replay_that_is_stopped_is_quiet_and_leaves_no_half_of_a_file(tmp_path, asked, code):
    out = tmp_path / 'tracks.csv'
    process = run('replay', 'busy_strait', '--out', str(out), preexec_fn=sigint_ends)
    until = time.monotonic() + 60
    while not (parts := list(tmp_path.iterdir())) or not parts[0].stat().st_size:
        assert time.monotonic() < until and process.poll() is None, process.communicate()
        time.sleep(0.05)
    assert not out.exists()
    process.send_signal(asked)
    assert process.communicate(timeout=60) == ('', '')
    assert process.returncode == code and not list(tmp_path.iterdir())


def full_disk():
    """No file of this process may have more than 20 kB."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))


@pytest.mark.parametrize('command', [('replay', '--out'), ('scenario', 'write')])
def test_a_full_disk_leaves_what_was_there_and_is_told_in_one_line(tmp_path, command):
    out = tmp_path / 'out'
    if command[0] == 'replay':
        out.write_text('old')
        process = run('replay', 'encounters', '--out', str(out), preexec_fn=full_disk)
    else:
        process = run('scenario', 'write', 'encounters', str(out), preexec_fn=full_disk)
    _, said = process.communicate(timeout=100)
    assert process.returncode == 2
    assert len(said.splitlines()) == 1 and 'Traceback' not in said
    if command[0] == 'replay':
        assert out.read_text() == 'old' and os.listdir(tmp_path) == ['out']
    else:
        assert os.listdir(out) == []


@pytest.mark.parametrize(
    'value',
    ['x' * 10**6, 10**3000, list(range(10**5)), {k: k for k in range(10**5)}, [[[[[[1]]]]]] * 99],
)
def test_values_are_cut_in_messages(value):
    assert len(shown(value)) <= 80


def test_short_values_are_shown_as_they_are():
    for value in ('a', 1, 2.5, None, True, [1, 2], {'a': 1}):
        assert shown(value) == repr(value)


def test_names_are_told_in_one_line():
    assert shortened('a\nb\t c') == 'a b c'
    assert len(shortened('y' * 5000)) == 200
