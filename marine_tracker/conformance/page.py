"""Writes the IMO report as an HTML page with its pictures."""

from collections.abc import Sequence
from html import escape
from pathlib import Path

import numpy as np

from ..evaluation.report import Figure, number
from ..evaluation.result import draw
from ..files import Place, write_text
from .figures import Results, figures, lines
from .pictures import pictures

STYLE = """body { font: 15px/1.5 sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; margin: 1em 0 } img { max-width: 100% }
td, th { padding: .15em .7em; border-bottom: 1px solid #ddd; text-align: left }
td.n { text-align: right } .met { color: #23662a } .missed { color: #b00020; font-weight: bold }
.past { color: #777 }"""
ABOUT = """Errors that 95 of 100 runs do not exceed, with all sensor errors of resolution
A.823(19), appendix 3, through the whole service. The fit is a straight line through the same plots:
it knows that the target keeps its course. A limit that the fit itself misses is shown in grey and
is not required."""


def write(folder: Place, results: Results, title: str, seed: int) -> Path:
    """Writes index.html and pictures into the folder, which is created; returns the page's path."""
    drawn = draw(folder, pictures(results, seed))
    parts = [
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{escape(title)}</title>',
        f'<style>{STYLE}</style><h1>{escape(title)}</h1><p>{escape(ABOUT)}</p>',
    ]
    for e, name in enumerate(results.estimators):
        if results.steady:
            parts += [f'<h2>{escape(name)}: accuracy</h2>', _accuracy(lines(results.steady, e + 1))]
    rest = [f for f in figures(results) if ' min: ' not in f.name or 'Imazu' in f.name]
    parts += ['<h2>All else</h2>', _table(rest)]
    parts += [f'<p><img src="{file.name}" alt="{file.stem}"></p>' for file in drawn]
    page = Path(folder) / 'index.html'
    write_text(page, '\n'.join(parts) + '\n')
    return page


def _accuracy(told) -> str:
    rows = []
    for line in told:
        cells = [f'{line.scenario}', f'{line.minutes} min', line.figure, line.unit]
        values = [number(line.value), number(line.fit), number(line.ratio)]
        rows.append(
            _row(
                cells,
                values,
                [
                    _verdict(line.value, line.fit, limit)
                    for limit in (line.a823, 0.5 * line.a823, line.msc192)
                ],
            )
        )
    return _rows(
        (
            'scenario',
            'after',
            'figure',
            '',
            '95 %',
            'fit',
            'ratio',
            'A.823',
            'half of it',
            'MSC.192',
        ),
        rows,
    )


def _verdict(value, fit, limit) -> tuple[str, str]:
    if np.isnan(limit):
        return '', ''
    kind = 'met' if value <= limit else 'past' if fit > limit else 'missed'
    return f'&le; {limit:g}', kind


def _table(told: Sequence[Figure]) -> str:
    verdict = {True: 'met', False: 'missed', None: 'past'}
    return _rows(
        ('figure', '', 'limit', 'beside'),
        [
            _row(
                [f.name],
                [f'{number(f.value)} {f.unit}'],
                [(escape(f.limit or ''), verdict[f.ok]), (escape(f.against or ''), '')],
            )
            for f in told
        ],
    )


def _row(texts, values, marked) -> str:
    return (
        '<tr>'
        + ''.join(f'<td>{escape(text)}</td>' for text in texts)
        + ''.join(f'<td class="n">{escape(text)}</td>' for text in values)
        + ''.join(f'<td class="{kind}">{text}</td>' for text, kind in marked)
        + '</tr>'
    )


def _rows(head, rows) -> str:
    return (
        '<table><tr>'
        + ''.join(f'<th>{escape(text)}</th>' for text in head)
        + '</tr>'
        + '\n'.join(rows)
        + '</table>'
    )
