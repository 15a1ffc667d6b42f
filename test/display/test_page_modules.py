"""The page's modules by themselves: the tests in page/, run by Node.js."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parent / 'page'


def node():
    program = shutil.which('node')
    if not program:
        pytest.skip('no node: the modules of the page are not tested')
    return program


@pytest.mark.parametrize('file', sorted(PAGE.glob('*.test.mjs')), ids=lambda file: file.stem)
def test_modules_of_the_page(file):
    done = subprocess.run([node(), '--test', file], capture_output=True, text=True, timeout=100)
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(r'^# pass [1-9]', done.stdout, re.M)
