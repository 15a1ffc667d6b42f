"""A process of the command or of a node does its linear algebra in one thread."""

import os
import subprocess
import sys

import pytest

from marine_tracker.processes import THREADS

SHOW = f'import os; print(*[os.environ[name] for name in {THREADS!r}])'


@pytest.mark.parametrize(
    'start',
    [
        'import marine_tracker.nodes',
        "from marine_tracker.cli import main\ntry: main(['--version'])\nexcept SystemExit: pass",
    ],
)
def test_one_thread_unless_the_user_says_otherwise(start):
    bare = {name: value for name, value in os.environ.items() if name not in THREADS}
    for given, expected in (({}, '1 1 1'), ({THREADS[0]: '4'}, '4 1 1')):
        said = subprocess.run(
            [sys.executable, '-c', f'{start}\n{SHOW}'],
            env=bare | given,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        assert said.splitlines()[-1] == expected


def test_numpy_is_not_loaded_before_it_is_asked_for():
    said = subprocess.run(
        [
            sys.executable,
            '-c',
            "import sys, marine_tracker.cli, marine_tracker.nodes; print('numpy' in sys.modules)",
        ],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert said.strip() == 'False'
