import json
import math

import numpy as np
import pytest

from marine_tracker.evaluation import report
from marine_tracker.evaluation.report import Figure, at_least, at_most


def test_the_table_shows_names_values_units_limits_and_verdicts():
    text = report.table(
        [
            Figure('scans', 12),
            at_most('rmse', 3.25, 5.5, 'm', 'the sketch'),
            at_least('held', None, 0.9),
        ]
    )
    lines = [line.split() for line in text.splitlines()]
    assert lines[0] == ['figure', 'value', 'unit', 'limit', 'against']
    assert lines[1] == ['scans', '12']
    assert lines[2] == ['rmse', '3.250', 'm', '<=', '5.5', 'ok', 'the', 'sketch']
    assert lines[3] == ['held', '-', '>=', '0.9', 'MISSED']


def test_columns_that_say_nothing_are_left_out():
    assert report.table([Figure('scans', 12)]).splitlines()[0].split() == ['figure', 'value']


@pytest.mark.parametrize(
    ('figure', 'ok'),
    [
        (at_most('a', 5.5, 5.5), True),
        (at_most('a', 5.6, 5.5), False),
        (at_least('a', 5.5, 5.5), True),
        (at_least('a', 5.4, 5.5), False),
        (at_most('a', None, 5.5), False),
        (at_least('a', math.nan, 5.5), False),
    ],
)
def test_limits_are_inclusive_and_nothing_measured_fails(figure, ok):
    assert figure.ok is ok


def test_json_has_the_six_keys_and_plain_numbers(tmp_path, capsys):
    figures = [
        Figure('a', np.float32(1.5)),
        Figure('b', np.int64(3), 'm'),
        Figure('c', math.nan),
        at_most('d', np.float64(2), 3, against='x'),
    ]
    path = tmp_path / 'figures.json'
    assert report.publish('title', figures, str(path), {'seed': 4}) == 0
    assert capsys.readouterr().out.startswith('title\nfigure')
    found = json.loads(path.read_text())
    assert found['seed'] == 4
    assert found['figures'] == [
        {'name': 'a', 'value': 1.5, 'unit': '', 'limit': None, 'ok': None, 'against': None},
        {'name': 'b', 'value': 3, 'unit': 'm', 'limit': None, 'ok': None, 'against': None},
        {'name': 'c', 'value': None, 'unit': '', 'limit': None, 'ok': None, 'against': None},
        {'name': 'd', 'value': 2.0, 'unit': '', 'limit': '<= 3', 'ok': True, 'against': 'x'},
    ]


def test_json_on_standard_output_stands_alone(capsys):
    assert report.publish('title', [at_least('a', 1, 2)], '-') == 1
    out, err = capsys.readouterr()
    assert json.loads(out)['figures'][0]['ok'] is False
    assert err.startswith('title')


@pytest.mark.parametrize(
    ('value', 'text'),
    [
        (0.0, '0.000'),
        (1234.5678, '1234.568'),
        (1e-9, '1e-09'),
        (3.2e7, '3.2e+07'),
        (7, '7'),
        (None, '-'),
        (math.inf, '-'),
        ('imm', 'imm'),
        (True, 'True'),
    ],
)
def test_numbers_are_readable(value, text):
    assert report.number(value) == text


def test_claims_stand_below_the_table_and_in_the_json(capsys):
    claim = report.Claim('Fig 9', 'it flies', 'it does not, by far ' + 30 * 'and wide ', 'denied')
    report.publish('title', [report.Figure('height', 0.0, 'm')], '-', claims=[claim])
    printed = capsys.readouterr()
    assert '\nFig 9: "it flies": denied\n  it does not' in printed.err
    assert max(map(len, printed.err.splitlines())) <= 100
    assert json.loads(printed.out)['claims'] == [claim._asdict()]
    report.publish('title', [report.Figure('height', 0.0, 'm')], '-')
    assert 'claims' not in json.loads(capsys.readouterr().out)
