"""Plots from radar video beside theory, and the whole chain beside a threshold and blobs.

    false alarms   cells over the threshold in receiver noise, Weibull and K clutter that falls with
                   range, by octave of range, beside the rate asked for
    detection      Swerling 1 targets in noise beside the curve of cell averaging
    accuracy       steady points beside the Cramer-Rao bound; their covariance by its NIS
    resolution     pairs of ships near to each other
    whole chain    20 ships, sea state 4, a coast, a shower, two other radars; one run

A run is a revolution of the false alarms; the other parts take shares of it.
"""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...evaluation import parallel, report
from ...evaluation.report import Figure
from ...evaluation.result import Picture, Progress, Result, silent
from ...types import Array
from . import false_alarms, matched, pictures, points, recorded, whole

HELP = 'plots from radar video: false alarms, detection, accuracy, resolution, whole chain'
RUNS = 40
OPTIONS = {
    'minutes': {
        'type': float,
        'default': 30.0,
        'metavar': 'M',
        'help': 'length of the scene of the whole chain (default 30); 0: without it',
    },
    'data': {
        'metavar': 'FOLDER',
        'help': 'folder with files of spokes (.npz), which are drawn with plots and tracks',
    },
}
EXPECTED = 12.0  # false alarms; an octave with fewer is not judged
SNR = np.arange(0.0, 31.0, 2.0)
DETECTION_RATES = (1e-4, 1e-6)
ACCURACY_DB = (13.0, 16.0, 20.0, 25.0, 30.0)
APART = ((1.3, 0.0), (0.0, 1.5))
PAIR_DB = 25.0
SAMPLE_RATIO = 2.0


class Rates(NamedTuple):
    """rate asked for; ratio [Z] measured over asked for, nan where there are too few cells; cells
    [Z]."""

    kind: str
    rate: float
    ratio: Array
    cells: Array


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    minutes: float = 30.0,
    data: str | None = None,
    workers: parallel.Workers = None,
) -> Result:
    """All parts."""
    if not 0 <= minutes <= 600:
        raise ValueError(f'--minutes is {minutes:g}; it must be between 0 and 600')
    some = max(2, runs // 8)
    work = [
        parallel.Job(rates, (kind, rate, runs, seed))
        for kind in false_alarms.KINDS
        for rate in false_alarms.RATES
    ]
    kinds = len(work)
    work += [parallel.Job(detected, (rate, max(2, runs), seed)) for rate in DETECTION_RATES]
    work += [parallel.Job(points.measure, (snr, some, seed)) for snr in ACCURACY_DB]
    work += [parallel.Job(points.resolved, (*apart, PAIR_DB, some, seed)) for apart in APART]
    if minutes:
        work.append(parallel.Job(whole.both, (minutes, seed)))
    found = parallel.run(work, workers, progress)
    take = _Taker(found)
    alarms: list[Rates] = take(kinds)
    curves: list[Array] = take(len(DETECTION_RATES))
    errors: list[points.Errors] = take(len(ACCURACY_DB))
    pairs: list[float] = take(len(APART))
    figures = _alarms(alarms) + _detection(curves) + _accuracy(errors) + _resolution(pairs)
    if minutes:
        ours, theirs = take(1)[0]
        figures += _whole(ours, theirs)
    drawn = _pictures(alarms, curves, errors)
    for path in sorted(Path(data).glob('*.npz')) if data else ():
        one = recorded.follow(path)
        figures += [
            Figure(f'{one.name}: plots a revolution', one.mean_plots, ''),
            Figure(f'{one.name}: moving targets alive', one.mean_moving, ''),
            *_matched(path.with_suffix('.nmea'), one),
        ]
        drawn.append(Picture(f'video_{one.name}', (8.0, 8.0), partial(recorded.paint, of=one)))
    return Result(figures, pictures=drawn)


class _Taker:
    """Takes so many of a list, one after the other."""

    def __init__(self, of: list[Any]) -> None:
        self._of = iter(of)

    def __call__(self, count: int) -> list[Any]:
        return [next(self._of) for _ in range(count)]


def rates(kind: str, rate: float, runs: int, seed: int) -> Rates:
    """False alarms of one kind of clutter at one rate."""
    counts = false_alarms.count(kind, rate, runs, seed)
    enough = counts.cells * rate >= EXPECTED
    with np.errstate(invalid='ignore'):
        ratio = np.where(enough, counts.over / (counts.cells * rate), np.nan)
    return Rates(kind, rate, ratio, counts.cells)


def detected(rate: float, runs: int, seed: int) -> Array:
    """Share of detected targets at each SNR."""
    return false_alarms.detected(SNR, rate, runs, seed)


def _alarms(found: list[Rates]) -> list[Figure]:
    """The octave that is farthest from the rate asked for: the larger of ratio and its inverse,
    with its sign of direction in the name."""
    figures = []
    for one in found:
        judged = one.ratio[np.isfinite(one.ratio)]
        worst = None
        if len(judged):
            worst = float(np.maximum(judged, 1 / np.maximum(judged, 1e-9)).max())
        octaves = f'{len(judged)} octaves'
        name = f'false alarms, {one.kind}, {one.rate:.0e}: worst factor of {octaves}'
        figures.append(
            report.at_most(name, worst, SAMPLE_RATIO, '', 'the rate asked for')
            if len(judged)
            else Figure(name, None, '', None, None, 'the rate asked for')
        )
    return figures


def _detection(curves: list[Array]) -> list[Figure]:
    cells = false_alarms.reference_cells()
    return [
        report.at_most(
            f'detection, Swerling 1, {rate:.0e}: loss against the CFAR curve',
            false_alarms.loss(SNR, curve, rate, cells),
            1.0,
            'dB',
            f'cell averaging over {cells:.0f} cells',
        )
        for rate, curve in zip(DETECTION_RATES, curves)
    ]


def _accuracy(errors: list[points.Errors]) -> list[Figure]:
    figures = []
    for snr, one in zip(ACCURACY_DB, errors):
        range_, bearing = points.bound(snr)
        for name, error, bound in (('range', one.range, range_), ('bearing', one.bearing, bearing)):
            figures.append(
                report.at_most(
                    f'accuracy, {snr:.0f} dB: {name} error over the bound',
                    float(np.sqrt(np.mean(error**2))) / bound,
                    1.3,
                    '',
                    'Cramer-Rao',
                )
            )
        figures.append(Figure(f'accuracy, {snr:.0f} dB: NIS over 2', one.nis.mean() / 2, ''))
    nis = np.concatenate([one.nis for one in errors]).mean() / 2
    honest = Figure(
        'accuracy, all: NIS over 2', nis, '', '0.9 to 1.1', bool(0.9 <= nis <= 1.1), 'chi-square'
    )
    return [*figures, honest]


def _resolution(pairs: list[float]) -> list[Figure]:
    return [
        report.at_least(
            f'resolution: pairs {beams:g} beams and {pulses:g} pulses apart', share, 0.5
        )
        for (beams, pulses), share in zip(APART, pairs)
    ]


def _whole(ours: whole.Held, theirs: whole.Held) -> list[Figure]:
    against = 'threshold and blobs'
    figures = [
        report.at_least('whole chain: least time a ship is held', 100 * ours.worst, 97, '%'),
        Figure('whole chain: mean time a ship is held', 100 * ours.mean, '%'),
        report.at_most('whole chain: false moving targets alive', ours.false, 0.5),
        report.at_most('whole chain: targets on land', ours.on_land, 2.0),
        Figure('whole chain: plots a revolution', ours.plots, ''),
    ]
    for name, value, unit in (
        ('least time a ship is held', 100 * theirs.worst, '%'),
        ('mean time a ship is held', 100 * theirs.mean, '%'),
        ('false moving targets alive', theirs.false, ''),
        ('targets on land', theirs.on_land, ''),
        ('plots a revolution', theirs.plots, ''),
    ):
        figures.append(Figure(f'{against}: {name}', value, unit, None, None, against))
    return figures


def _matched(path: Path, one: recorded.Recorded) -> list[Figure]:
    """The vessels that told AIS, where a file beside the recording tells them."""
    if not path.exists():
        return []
    vessels = matched.read(path)
    found = matched.match(vessels, one.every)
    moving = found.near & found.moving
    against = f'{found.moving.sum()} that tell AIS'
    return [
        Figure(f'{one.name}: moving vessels with a plot', moving.sum(), '', against=against),
        Figure(f'{one.name}: the same at wrong bearings', found.by_chance, '', against=against),
        Figure(f'{one.name}: range of plots off by', found.range, 'm'),
        Figure(f'{one.name}: bearing of plots off by', math.degrees(found.bearing), 'deg'),
    ]


def _pictures(
    alarms: list[Rates], curves: list[Array], errors: list[points.Errors]
) -> list[Picture]:
    cells = false_alarms.reference_cells()
    fine = np.linspace(SNR[0], SNR[-1], 200)
    theory = [false_alarms.theory(fine, rate, cells) for rate in DETECTION_RATES]
    bounds = [points.bound(snr) for snr in ACCURACY_DB]
    paints: list[tuple[str, Callable[[Any], None]]] = [
        ('video_false_alarms', lambda canvas: pictures.false_alarms(canvas, alarms)),
        (
            'video_detection',
            lambda canvas: pictures.detection(canvas, DETECTION_RATES, SNR, curves, fine, theory),
        ),
        (
            'video_accuracy',
            lambda canvas: pictures.accuracy(
                canvas,
                ACCURACY_DB,
                [math.sqrt(np.mean(e.range**2)) for e in errors],
                [math.sqrt(np.mean(e.bearing**2)) for e in errors],
                bounds,
            ),
        ),
    ]
    return [Picture(name, (8.0, 4.5), paint) for name, paint in paints]
