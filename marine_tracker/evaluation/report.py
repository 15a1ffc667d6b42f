"""Figures for people and machines: a table, and with --json one JSON object."""

import json
import math
import sys
import textwrap
from argparse import ArgumentParser
from collections.abc import Sequence
from typing import Any, NamedTuple

from ..files import write_text


class Figure(NamedTuple):
    """One measured figure.

    name     stable: scripts look for it         value    None if there was nothing to measure
    unit     '' for a plain number               limit    the requirement, e.g. '<= 5.5'
    ok       whether the requirement is met      against  the baseline or source of the requirement
    limit and ok are None if there is no requirement.
    """

    name: str
    value: Any
    unit: str = ''
    limit: str | None = None
    ok: bool | None = None
    against: str | None = None


class Claim(NamedTuple):
    """A published claim: its source, its text, what was found, and the verdict."""

    source: str
    claim: str
    found: str
    verdict: str


def at_most(
    name: str, value: float | None, limit: float, unit: str = '', against: str | None = None
) -> Figure:
    """A figure that must not exceed `limit`. A value that could not be measured fails."""
    return Figure(
        name, value, unit, f'<= {limit:g}', value is not None and bool(value <= limit), against
    )


def at_least(
    name: str, value: float | None, limit: float, unit: str = '', against: str | None = None
) -> Figure:
    """A figure that must reach `limit`. A value that could not be measured fails."""
    return Figure(
        name, value, unit, f'>= {limit:g}', value is not None and bool(value >= limit), against
    )


def add_arguments(parser: ArgumentParser) -> None:
    """Adds --json, for every command that measures."""
    parser.add_argument(
        '--json',
        metavar='FILE',
        help='also write the figures as JSON; - for standard output, the table '
        'then goes to standard error',
    )


def publish(
    title: str,
    figures: Sequence[Figure],
    json_to: str | None = None,
    facts: dict[str, Any] | None = None,
    claims: Sequence[Claim] = (),
) -> int:
    """Prints the table and the claims, writes the JSON if asked, and returns the exit code.

    json_to  a file, '-' for standard output, None for no JSON
    facts    what the JSON object has in addition to `figures`, e.g. {'seed': 1}
    claims   printed below the table; in the JSON as a list `claims`, if there are any
    Returns 0, or 1 if a figure misses its limit.
    """
    text = '\n'.join([title, table(figures), *map(in_words, claims)])
    print(text, file=sys.stderr if json_to == '-' else sys.stdout)
    if json_to is not None:
        said = {'claims': [claim._asdict() for claim in claims]} if claims else {}
        text = to_json(figures, {**(facts or {}), **said})
        if json_to == '-':
            print(text)
        else:
            write_text(json_to, text + '\n')
    return 1 if any(figure.ok is False for figure in figures) else 0


def to_json(figures: Sequence[Figure], facts: dict[str, Any] | None = None) -> str:
    """One object, {**facts, 'figures': [...]}; numbers that are not finite become null."""
    rows = [figure._asdict() for figure in figures]
    return json.dumps(_plain({**(facts or {}), 'figures': rows}), indent=1, allow_nan=False)


def in_words(claim: Claim) -> str:
    """A claim as a paragraph: first the claim with the verdict, then what was found."""
    head = f'\n{claim.source}: "{claim.claim}": {claim.verdict}'
    return f'{head}\n{textwrap.fill(claim.found, 96, initial_indent="  ", subsequent_indent="  ")}'


def table(figures: Sequence[Figure]) -> str:
    """The figures as aligned lines. Empty columns are left out."""
    verdict = {None: '', True: 'ok', False: 'MISSED'}
    rows = [('figure', 'value', 'unit', 'limit', '', 'against')]
    rows += [
        (f.name, number(f.value), f.unit, f.limit or '', verdict[f.ok], f.against or '')
        for f in figures
    ]
    columns = [column for column in zip(*rows) if any(column[1:])]
    widths = [max(map(len, column)) for column in columns]
    return '\n'.join(
        '  '.join(
            cell.rjust(width) if cell and column[0] == 'value' else cell.ljust(width)
            for cell, width, column in zip(cells, widths, columns)
        ).rstrip()
        for cells in zip(*columns)
    )


def number(value: Any) -> str:
    """A value as text: up to four digits after the point; - for None."""
    value = _plain(value)
    if value is None:
        return '-'
    if not isinstance(value, float):
        return str(value)
    return f'{value:.3f}' if value == 0 or 1e-2 <= abs(value) < 1e6 else f'{value:.3g}'


def _plain(value):
    """The value in JSON's own types, numpy's numbers and arrays included."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if hasattr(value, 'tolist'):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
