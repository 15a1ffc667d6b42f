"""Turns the results of all conformance runs into figures with their limits."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..evaluation.report import Figure, at_least, at_most
from .accuracy import FIGURES, MINUTES, UNITS, Outcome, a823_limits, msc192_limits
from .encounters import Encounter
from .loss import Kept
from .manoeuvres import MET_AGAIN, RIGHT, Turn

HALVES = 12  # number of A.823's 3-minute limits that must be met at half their value
RATIO = 1.25  # largest ratio to the straight-line fit
RIGHT_WITHIN = 60.0  # s after a target's turn
CPA_ERROR, TCPA_ERROR = 0.15, 0.3  # NM, min: limits for Imazu's encounters
WARNED = 6.0  # min of TCPA, limit
KEPT, ENDED = 99.0, 10  # %, scans: limits for target loss


class Results(NamedTuple):
    """The results of all runs with E estimators, by kind; empty for what was not run.

    steady     by minutes of steady tracking and scenario
    own_turns  by scenario, both sides together
    """

    estimators: Sequence[str]
    steady: dict[tuple[int, int], Outcome]
    own_turns: dict[int, Outcome]
    turns: Sequence[Turn] = ()
    encounters: Sequence[Encounter] = ()
    kept: Kept | None = None


class Line(NamedTuple):
    """One figure of one scenario: 95 % of the errors; the fit; the limits (nan: none)."""

    minutes: int
    scenario: int
    figure: str
    unit: str
    value: float
    fit: float
    a823: float
    msc192: float

    @property
    def ratio(self) -> float:
        """Ratio to the fit."""
        return self.value / self.fit


def lines(outcomes: dict[tuple[int, int], Outcome], column: int) -> list[Line]:
    """Lines of one estimator (column 1 and up) for figures that a standard limits, in order."""
    found = []
    for (minutes, number), outcome in outcomes.items():
        a823, msc192 = a823_limits(number, minutes), msc192_limits(outcome.truth, minutes)
        values = outcome.in_95
        found += [
            Line(minutes, number, name, unit, values[column, k], values[0, k], a823[k], msc192[k])
            for k, (name, unit) in enumerate(zip(FIGURES, UNITS))
            if not np.isnan(a823[k]) or (minutes == MINUTES[0] and not np.isnan(msc192[k]))
        ]
    return found


def figures(results: Results) -> list[Figure]:
    """All figures. A limit that the straight-line fit itself misses is shown, but not required."""
    found = []
    for e, name in enumerate(results.estimators):
        told = lines(results.steady, e + 1)
        found += [_steady(name, line) for line in told]
        if told:
            found += _overall(name, told, results.steady, e + 1)
        for number, outcome in results.own_turns.items():
            found += [
                _limited(
                    f'{name}: scenario {number}, {MET_AGAIN:g} s after own ship turned 45 deg: '
                    f'{line.figure}',
                    line,
                    line.a823,
                    f'fit {line.fit:.2f}',
                )
                for line in lines({(3, number): outcome}, e + 1)
            ]
        for turn in results.turns:
            found.append(
                at_most(
                    f'{name}: target turned {turn.angle:g} deg at {turn.rate:g} deg/s: '
                    f'course error below {RIGHT:g} deg',
                    turn.right_again[e],
                    RIGHT_WITHIN,
                    's',
                    f'after the turn; {turn.before[e]:.2f} deg before it',
                )
            )
        found += _encounters(name, results.encounters, e)
        if results.kept is not None:
            ended = results.kept.ended[e]
            found += [
                at_least(
                    f'{name}: targets in 5 of 10 scans kept for 10 minutes',
                    100 * results.kept.kept[e].mean(),
                    KEPT,
                    '%',
                ),
                at_most(
                    f'{name}: lost alarm, scans after the last plot',
                    np.nanmax(ended, initial=0),
                    ENDED,
                ),
            ]
    return found


def _steady(name, line):
    title = f'{name}: scenario {line.scenario}, {line.minutes} min: {line.figure}'
    if line.minutes == 1:
        return _limited(title, line, line.msc192, _beside(line, 'A.823', line.a823))
    return _limited(title, line, line.a823, _beside(line, 'MSC.192', line.msc192))


def _beside(line, standard, limit):
    text = f'fit {line.fit:.2f}'
    if not np.isnan(limit):
        text += f'; {standard} <= {limit:g} {"met" if line.value <= limit else "missed"}'
    return text


def _limited(title, line, limit, against):
    """A figure whose limit is required only if the fit can meet it."""
    if np.isnan(limit):
        return Figure(title, line.value, line.unit, None, None, against)
    if line.fit > limit:
        return Figure(
            title, line.value, line.unit, f'<= {limit:g}', None, f'{against}: not even the fit'
        )
    return at_most(title, line.value, limit, line.unit, against)


def _overall(name, told, outcomes, column):
    judged = [line for line in told if line.minutes == 3]
    without = max(np.isinf(outcome.errors[:, column, 0]).mean() for outcome in outcomes.values())
    halves = sum(line.value <= 0.5 * line.a823 for line in judged)
    return [
        at_least(
            f'{name}: A.823 figures at 3 min at or below half their limit',
            halves,
            HALVES,
            '',
            f'of {len(judged)}; fit {sum(x.fit <= 0.5 * x.a823 for x in judged)}',
        ),
        at_most(
            f'{name}: largest ratio to the fit at 3 min',
            max((line.ratio for line in judged), default=None),
            RATIO,
            '',
            'fit',
        ),
        Figure(
            f'{name}: runs without a target when it was judged, worst scenario', 100 * without, '%'
        ),
    ]


def _encounters(name, encounters, e):
    found = []
    for one in encounters:
        for what, errors, limit, unit in (
            ('CPA', one.cpa, CPA_ERROR, 'NM'),
            ('TCPA', one.tcpa, TCPA_ERROR, 'min'),
        ):
            error = np.quantile(errors[e], 0.95, axis=0, method='inverted_cdf').max()
            found.append(
                at_most(
                    f'{name}: Imazu {one.number}, 3 min after acquisition: {what} error',
                    error,
                    limit,
                    unit,
                    'CPA 0, 95 % of runs',
                )
            )
    if encounters:
        acquired = np.concatenate([np.isfinite(one.acquired[e]).ravel() for one in encounters])
        warned = min(one.warned[e].min() for one in encounters)
        found += [
            at_least(f'{name}: Imazu, targets acquired', 100 * acquired.mean(), 100, '%'),
            at_least(
                f'{name}: Imazu, TCPA left at the danger alarm, least', warned / 60, WARNED, 'min'
            ),
        ]
    return found
