import os
import subprocess
import sys
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope='session')
def recordings():
    """The folder of real recordings that may stand beside the checkout."""
    folder = CHECKOUT.parent / 'shared' / 'data'
    if not folder.is_dir():
        pytest.skip(f'no real recordings: {folder} does not exist')
    return folder


@pytest.fixture(scope='session')
def command():
    """Run `python -m marine_tracker ARGUMENTS...` as a process; gives the CompletedProcess."""
    def run(*arguments, timeout=60, **environment):
        return subprocess.run(
            [sys.executable, '-m', 'marine_tracker', *map(str, arguments)], text=True,
            capture_output=True, timeout=timeout,
            env={**os.environ, 'PYTHONPATH': str(CHECKOUT), **environment})
    return run
