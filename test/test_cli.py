import re
import subprocess
import sys
from pathlib import Path

import pytest

from marine_tracker import cli

PACKAGE = Path(cli.__file__).resolve().parent


def test_help_names_every_command_and_the_first_steps(command):
    done = command('--help')
    assert done.returncode == 0 and done.stderr == ''
    listed = done.stdout.split('commands:')[1].split('first steps:')[0]
    for name in cli.COMMANDS:
        assert re.search(rf'\n    {name}\s', listed), name
    assert 'marine_tracker doctor' in done.stdout


def test_version(command):
    done = command('--version')
    assert done.returncode == 0 and done.stdout.startswith('marine_tracker ')


@pytest.mark.parametrize('name', cli.COMMANDS)
def test_every_command_explains_itself(name, command):
    """A process each: what one imports may not need what another has imported."""
    done = command(name, '--help')
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(f'usage: marine_tracker {name}')
    assert len(done.stdout.split('\n\n')[1]) > 20  # what it is for, in words


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        ([], 'marine_tracker: the following arguments are required: COMMAND'),
        (['fly'], "marine_tracker: argument COMMAND: invalid choice: 'fly'"),
        (['replay', 'x'], 'marine_tracker replay: the following arguments are required: --out'),
        (['replay', 'nowhere', '--out', 'x.csv'], 'marine_tracker: '),
        (['score', 'nowhere', 'x.csv'], 'marine_tracker: recording nowhere is not a folder'),
        (['doctor', '--listen', '-1'], 'marine_tracker: --listen is -1 s'),
    ],
)
def test_wrong_use_is_one_line_and_exit_code_2(capsys, arguments, message):
    try:
        code = cli.main(arguments)
    except SystemExit as stop:  # argparse's way
        code = stop.code
    out, err = capsys.readouterr()
    assert code == 2 and out == ''
    assert err.startswith(message)
    assert err.count('\n') == 1


def test_a_process_with_wrong_input_ends_with_2_and_no_traceback(command):
    done = command('score', 'nowhere', 'x.csv')
    assert (done.returncode, done.stdout, done.stderr) == (
        2,
        '',
        'marine_tracker: recording nowhere is not a folder\n',
    )


@pytest.mark.parametrize('missing', ['numpy', 'ruamel'])
def test_without_a_package_it_says_so_and_doctor_still_runs(command, tmp_path, missing):
    (tmp_path / f'{missing}.py').write_text(
        f'raise ModuleNotFoundError("No module named {missing!r}", name={missing!r})'
    )
    path = f'{tmp_path}:{PACKAGE.parent}'
    done = command('replay', 'clean', '--out', '-', PYTHONPATH=path)
    assert (done.returncode, done.stdout, done.stderr) == (
        2,
        '',
        f'marine_tracker: the Python module {missing} is not installed; '
        'see marine_tracker doctor\n',
    )
    listed = command('--help', PYTHONPATH=path).stdout
    assert f'cannot run: the Python module {missing} is not installed' in ' '.join(listed.split())
    assert command('doctor', '--listen', '0', PYTHONPATH=path).returncode == 1


def test_a_reader_that_leaves_early_is_no_error(tmp_path):
    done = subprocess.run(
        f'"{sys.executable}" -m marine_tracker replay clean --out - 2> "{tmp_path}/err" | head -1',
        shell=True,
        cwd=PACKAGE.parent,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.stdout.startswith('time_s,track,') and done.stdout.count('\n') == 1
    assert (tmp_path / 'err').read_text() == ''


def test_a_file_that_cannot_be_opened_is_named(tmp_path, capsys):
    out = tmp_path / 'none' / 'tracks.csv'
    assert cli.main(['replay', 'clean', '--out', str(out)]) == 2
    assert capsys.readouterr().err == f'marine_tracker: {out}: no such file or directory\n'
