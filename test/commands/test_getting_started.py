"""What doc/getting_started.md tells a stranger to type is answered as it says."""

import re
from pathlib import Path

from marine_tracker import cli

PAGE = Path(__file__).resolve().parents[2] / 'doc' / 'getting_started.md'


def test_the_mistake_in_the_scene_of_ones_own_is_answered_as_the_page_says(command, tmp_path):
    text = PAGE.read_text()
    (scene,) = re.findall(r'```yaml\n(.*?)```', text, re.S)
    (said,) = re.findall(r'scenario check mine.yaml\n(.*?)\n```', text, re.S)
    file = tmp_path / 'mine.yaml'
    file.write_text(scene)
    done = command('scenario', 'check', file)
    assert done.returncode == 1
    assert (done.stdout + done.stderr).replace(f'{tmp_path}/', '').strip() == said
    file.write_text(scene.replace('speed: 15', 'speed_kn: 15'))
    done = command('scenario', 'check', file)
    assert done.returncode == 0 and 'ok' in done.stdout
    # Then it is written as a recording, tracked and judged.
    for words in (
        ('scenario', 'write', file, tmp_path / 'tapes' / 'mine'),
        ('replay', tmp_path / 'tapes' / 'mine', '--out', tmp_path / 'tracks.csv'),
        ('score', tmp_path / 'tapes' / 'mine', tmp_path / 'tracks.csv'),
    ):
        done = command(*words)
        assert done.returncode == 0, done.stderr


def test_every_command_and_option_on_the_page_is_there(capsys):
    lines = re.findall(r'marine_tracker (\w+)([^\n`]*)', PAGE.read_text())
    used = [(name, re.findall(r'--[\w-]+', rest)) for name, rest in lines if name in cli.COMMANDS]
    demo = re.findall(r"make demo ARGS='([^']*)'", PAGE.read_text())
    used += [('demo', re.findall(r'--[\w-]+', rest)) for rest in demo]
    assert len(used) >= 6
    for name, options in used:
        try:
            cli.main([name, '--help'])
        except SystemExit as ended:
            assert ended.code == 0
        shown = capsys.readouterr().out
        assert all(option in shown for option in options), (name, options)


def test_the_page_leads_only_to_pages_that_are_there():
    for link in re.findall(r'\]\(([^)#]+)', PAGE.read_text()):
        assert (PAGE.parent / link).exists(), link
