"""Ships as hulls: their estimated length and centre, and land that is left out.

One ship that passes at 1 and 2 km, with cells of a short and of a long pulse; one close by, with
and without an outline; the scenarios `hulls` and `coast` with and without extents. Ten runs take
about three minutes.
"""

from functools import partial

import numpy as np

from ...evaluation import report
from ...evaluation.result import Picture, Progress, Result, silent
from .at_sea import COARSE, FINE, Case, HullsAtSea
from .at_sea import run as run_case
from .pictures import paint
from .traffic import track

HELP = 'length, heading and centre of ships seen as cells; land left out'
RUNS = 10
ASPECTS = (0.0, 45.0, 90.0)
LENGTHS, DISTANCES = (120, 200, 300), (1000.0, 2000.0)
LIMITS = {FINE: (12.0, '10 m, 0.75 deg'), COARSE: (28.0, '30 m, 1.2 deg')}
CLOSE = [Case(200, 1000.0, aspect, FINE) for aspect in (45.0, 90.0, 120.0)]


def run(runs: int, seed: int, progress: Progress = silent) -> Result:
    """All parts. The limits are those of the prototype."""
    done, whole = 0, 2 * len(LENGTHS) * len(DISTANCES) * len(ASPECTS) + 2 * len(CLOSE) + 5

    def one_more():
        nonlocal done
        progress(done, whole)
        done += 1

    figures = []
    for cell, (limit, name) in LIMITS.items():
        found: list[HullsAtSea] = []
        for length in LENGTHS:
            for distance in DISTANCES:
                own = []
                for aspect in ASPECTS:
                    one_more()
                    own += _runs(Case(length, distance, aspect, cell), 'random_matrix', runs, seed)
                found += own
                figures.append(
                    report.Figure(
                        f'{name}, {length} m at {distance:.0f} m: length',
                        _rms([of.length for of in own]),
                        'm',
                    )
                )
        figures.append(
            report.at_most(
                f'random matrix, {name}: length',
                _rms([of.length for of in found]),
                limit,
                'm',
                'prototype',
            )
        )
        course = float(np.degrees(_rms([of.course for of in found])))
        figures.append(
            report.at_most(f'random matrix, {name}: course', course, 2.0, 'deg', 'prototype')
            if cell == FINE
            else report.Figure(f'random matrix, {name}: course', course, 'deg')
        )

    bias = {}
    for extent in ('random_matrix', 'gp'):
        parts = []
        for case in CLOSE:
            one_more()
            parts.append(_bias(_runs(case, extent, runs, seed)))
        bias[extent] = float(np.mean(parts))
        figures.append(
            report.Figure(f'200 m at 1 km, {extent}: bias of the track', bias[extent], 'm')
        )
    figures.append(
        report.at_most(
            '200 m at 1 km: bias over that of plain centroids',
            bias['gp'] / bias['random_matrix'],
            0.5,
            '',
            'plain centroids',
        )
    )

    tracked = {}
    for name, extent in (
        ('hulls', 'none'),
        ('hulls', 'random_matrix'),
        ('hulls', 'gp'),
        ('coast', 'none'),
        ('coast', 'gp'),
    ):
        one_more()
        tracked[name, extent] = now = track(name, extent, seed)
        figures += [
            report.Figure(f'{name}, extent {extent}: tracks confirmed', now.confirmed),
            report.Figure(f'{name}, extent {extent}: least held ship', float(now.held.min())),
            report.Figure(f'{name}, extent {extent}: RMSE of the nearest track', now.nearest, 'm'),
        ]
    for extent in ('random_matrix', 'gp'):
        now, plain = tracked['hulls', extent], tracked['hulls', 'none']
        figures += [
            report.at_most(
                f'hulls, extent {extent}: position RMSE', now.rmse, plain.rmse, 'm', 'extent none'
            ),
            report.at_least(
                f'hulls, extent {extent}: held',
                float(now.held.mean()),
                float(plain.held.mean()),
                '',
                'extent none',
            ),
        ]
    coast = tracked['coast', 'gp']
    figures += [
        report.at_most(
            'coast: tracks confirmed over those with extent none',
            coast.confirmed / tracked['coast', 'none'].confirmed,
            0.1,
            '',
            'extent none',
        ),
        report.at_least(
            'coast: held',
            float(coast.held.mean()),
            float(tracked['coast', 'none'].held.mean()),
            '',
            'extent none',
        ),
    ]
    progress(whole, whole)
    pictures = [
        Picture(
            'hulls',
            (11, 5.5),
            partial(paint, hulls=tracked['hulls', 'gp'].snapshot, coast=coast.snapshot),
        )
    ]
    return Result(figures, (), pictures)


def _runs(case: Case, extent: str, runs: int, seed: int) -> list[HullsAtSea]:
    return [run_case(case, extent, seed + n) for n in range(runs)]


def _rms(values) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _bias(found: list[HullsAtSea]) -> float:
    """Length m of the mean offset over the runs."""
    return float(np.hypot(*np.mean([of.centre for of in found], 0)))
