"""doc/equations.md names functions that exist."""

import importlib
import re
from pathlib import Path

import pytest

import marine_tracker

PAGE = Path(marine_tracker.__file__).resolve().parents[1] / 'doc' / 'equations.md'
ROWS = re.findall(r'^\|.*\|.*\| (.*) \|$', PAGE.read_text(), re.M)
NAMES = sorted({name for row in ROWS for name in re.findall(r'`(\w+(?:\.\w+)+)`', row)})


def test_there_are_functions_to_look_for():
    assert len(NAMES) > 30


@pytest.mark.parametrize('name', NAMES)
def test_the_function_of_an_equation_exists(name):
    module, function = name.rsplit('.', 1)
    assert hasattr(importlib.import_module(f'marine_tracker.{module}'), function)
