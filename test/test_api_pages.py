"""The pages that `make api` writes (`make check` builds all of them, warnings are errors)."""

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

BUILD = Path(__file__).resolve().parents[1] / 'doc' / 'api' / 'build.py'


@pytest.fixture(scope='module')
def build():
    pytest.importorskip('pdoc', reason='pdoc (extra dev) is not installed: no API pages')
    spec = importlib.util.spec_from_file_location('build', BUILD)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


COLUMNS = """length   [N]     m, bow to stern
corners  [N, 4]  m, in the order < bow, beam, ...>"""


def test_columns_keep_their_lines_and_prose_does_not(build):
    page = build.plain_text(f'What ships\nmeasure.\n\n{COLUMNS}\n\nNone of `N` is\nlost.\n')
    prose, columns, end = re.findall(r'<(p|pre)>(.*?)</\1>', page, re.S)
    assert prose == ('p', 'What ships\nmeasure.')
    assert columns == ('pre', COLUMNS.replace('<', '&lt;').replace('>', '&gt;'))
    assert end == ('p', 'None of <code>N</code> is\nlost.')


def test_lists_and_indented_lines_stand_as_they_are(build):
    for text in ('- one\n- two', 'as here:\n    x = 1'):
        assert build.plain_text(text) == f'<pre>{text}</pre>'


def test_a_docstring_that_names_what_is_not_there_fails_the_build(tmp_path):
    """As a process: the page of a module whose annotation cannot be resolved."""
    pytest.importorskip('pdoc', reason='pdoc (extra dev) is not installed: no API pages')
    package = tmp_path / 'marine_tracker'
    (tmp_path / 'doc' / 'api').mkdir(parents=True)
    for file in BUILD.parent.iterdir():
        if file.is_file():
            (tmp_path / 'doc' / 'api' / file.name).write_bytes(file.read_bytes())
    package.mkdir()
    (package / '__init__.py').write_text(
        "import importlib\n__all__ = ['hail']\n\n\ndef __getattr__(name):\n"
        "    if name != 'hail':\n        raise AttributeError(name)\n"
        "    return importlib.import_module('marine_tracker.signals').hail\n"
    )
    built = []
    for annotation in ('int', "'Vessel'"):
        (package / 'signals.py').write_text(f'def hail(ship: {annotation}) -> None: ...\n')
        built.append(
            subprocess.run(
                [sys.executable, tmp_path / 'doc' / 'api' / BUILD.name, tmp_path / 'pages'],
                cwd=tmp_path,
                capture_output=True,
                text=True,
                timeout=100,
            )
        )
    good, bad = built
    assert good.returncode == 0, good.stderr
    pages = tmp_path / 'pages'
    assert (pages / 'index.html').is_file() and (pages / 'marine_tracker/signals.html').is_file()
    top = (pages / 'marine_tracker.html').read_text()
    assert 'marine_tracker/signals.html' in top and 'id="hail"' in top
    assert bad.returncode != 0 and 'Vessel' in bad.stderr
