"""The table of MSC.192(79): what it says is met names tests that exist."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent
PAGE = ROOT.parent / 'doc' / 'msc192.md'
ROW = re.compile(r'^\| (?!clause|symbol|---)(.+) \|$', re.M)
NAMED = re.compile(r'`([\w/]+\.(?:py|test\.mjs))::([^`]+)`')
STANDS = {'met', 'part', 'missing', 'n.a.'}


def rows():
    """Cells of each row: (what, stands, why)."""
    for row in ROW.findall(PAGE.read_text()):
        cells = row.split(' | ')
        yield cells[0], cells[-2], cells[-1]


def test_every_row_says_where_it_stands_and_why():
    found = list(rows())
    assert len(found) > 90
    for what, stands, why in found:
        assert stands in STANDS, what
        assert why.strip(), what
        assert stands != 'met' or NAMED.search(why), f'{what}: by which test?'


@pytest.mark.parametrize(
    ('file', 'name'), sorted({pair for pair in NAMED.findall(PAGE.read_text())}), ids=lambda x: x
)
def test_every_test_that_is_named_exists(file, name):
    text = (ROOT / file).read_text()
    if file.endswith('.mjs'):
        assert f"test('{name}'" in text
    else:
        assert re.search(rf'^def {name}\(', text, re.M)


@pytest.mark.parametrize('section', [f'5.{k}' for k in range(13, 36)])
def test_every_section_of_the_standard_has_a_row(section):
    # A row may name several clauses: 5.25.1.1, .2; 5.24.4, 5.25.2.2.
    assert any(re.search(rf'\b{re.escape(section)}\b', what) for what, _, _ in rows())
