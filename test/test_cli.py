import pytest

from marine_tracker import cli
from marine_tracker.commands import replay


def test_help_names_every_command_and_the_first_steps(command):
    done = command('--help')
    assert done.returncode == 0 and done.stderr == ''
    listed = done.stdout.split('commands:')[1].split('first steps:')[0]
    for name in cli.COMMANDS:
        assert f'\n    {name} ' in listed, name
    assert 'marine_tracker doctor' in done.stdout


def test_version(command):
    done = command('--version')
    assert done.returncode == 0 and done.stdout.startswith('marine_tracker ')


@pytest.mark.parametrize('name', cli.COMMANDS)
def test_every_command_explains_itself(name, capsys):
    with pytest.raises(SystemExit) as stop:
        cli.main([name, '--help'])
    assert stop.value.code == 0
    out = capsys.readouterr().out
    assert out.startswith(f'usage: marine_tracker {name}')
    assert len(out.split('\n\n')[1]) > 20         # what it is for, in words


@pytest.mark.parametrize(('arguments', 'message'), [
    ([], 'marine_tracker: the following arguments are required: COMMAND'),
    (['fly'], "marine_tracker: argument COMMAND: invalid choice: 'fly'"),
    (['replay', 'x'], 'marine_tracker replay: the following arguments are required: --out'),
    (['replay', 'nowhere', '--out', 'x.csv'], 'marine_tracker: '),
    (['score', 'nowhere', 'x.csv'], 'marine_tracker: recording nowhere is not a folder'),
    (['doctor', '--listen', '-1'], 'marine_tracker: --listen is -1 s'),
])
def test_wrong_use_is_one_line_and_exit_code_2(command, arguments, message):
    done = command(*arguments)
    assert done.returncode == 2 and done.stdout == ''
    assert done.stderr.startswith(message)
    assert done.stderr.count('\n') == 1


def interrupted(args):
    raise KeyboardInterrupt


def test_ctrl_c_ends_quietly_with_130(monkeypatch, capsys):
    monkeypatch.setattr(replay, 'run', interrupted)
    assert cli.main(['replay', 'clean', '--out', 'x.csv']) == 130
    assert capsys.readouterr() == ('', '')


def test_a_file_that_cannot_be_opened_is_named(tmp_path, capsys):
    out = tmp_path / 'none' / 'tracks.csv'
    assert cli.main(['replay', 'clean', '--out', str(out)]) == 2
    assert capsys.readouterr().err == f'marine_tracker: {out}: no such file or directory\n'
