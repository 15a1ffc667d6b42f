"""Two parallel filters joined by a rough network, by a plain network, or without one (paper 001).

A target flies straight or accelerates gently, and then accelerates: 5, 40, and from 5 to 25 m/s^2,
as in the paper at 300 m/s. The paper does not describe the radar; 1 s, 100 m and a_max 60 m/s^2 are
assumed. The same is done at sea (22 rpm, 20 m, a_max 1 m/s^2). The two networks are compared with
the plain CS filter with the same a_max, and with an IMM of the same two filters. Delay: time until
the mean of the estimated accelerations has made 63 % of the step.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ...evaluation import report
from ...evaluation.result import (
    BORNE_OUT,
    IN_PART,
    NOT_BORNE_OUT,
    Progress,
    Result,
    silent,
    verdict,
)
from .pictures import pictures
from .trials import BP, CS, FILTERS, IMM, RADARS, ROUGH, SETTINGS, Answer, answers, quiet_share

HELP = 'two CS filters joined by a rough or a plain network: steps of the acceleration'
RUNS = 200
# Delay s and acceleration RMSE m/s^2 that the prototype of these filters found.
PROTOTYPE = {
    '0 -> 5': {CS: '6, 6.28', BP: '10, 2.60', ROUGH: '10, 2.66', IMM: '10, 2.66'},
    '0 -> 40': {CS: '6, 11.55', BP: '8, 13.47', ROUGH: '8, 13.27', IMM: '7, 12.24'},
    '5 -> 25': {CS: '6, 7.39', BP: '9, 7.07', ROUGH: '9, 6.97', IMM: '8, 6.94'},
}
RMSE_LIMITS = {'0 -> .1': 1.06, '0 -> .5': 1.01, '0 -> 1': 1.01}  # rough over BP, at sea
LITTLE = 0.05  # of an error; two trainings of one network may differ by 0.02
Found = dict[tuple[str, str, str], Answer]


class Ratio(NamedTuple):
    """Ratio of two RMSE on the same plots, with its 95 % interval."""

    value: float
    low: float
    high: float


def run(runs: int, seed: int, progress: Progress = silent) -> Result:
    """All steps by all filters, and how calm the networks are with other radars."""
    found = answers(runs, seed, progress)
    calm = {
        name: {kind: quiet_share(kind, radar, runs, seed) for kind in ('rough', 'bp')}
        for name, radar in RADARS.items()
    }
    return Result(figures(found) + calmness(calm), claims(found), pictures(found))


def figures(found: Found) -> list[report.Figure]:
    """Every cell, then the figures with limits."""
    out = []
    for (name, step, rival), cell in found.items():
        where = f'{name} {step}, {rival}'
        known = PROTOTYPE.get(step, {}).get(rival)
        out += [
            report.Figure(
                f'{where}: delay', cell.delay, 's', None, None, known and f'prototype {known}'
            ),
            report.Figure(f'{where}: acceleration RMSE', cell.acceleration, 'm/s^2'),
            report.Figure(f'{where}: overshoot', cell.overshoot),
        ]
    for rival in FILTERS:
        cell = found['sea', '0 -> .5', rival]
        out += [
            report.Figure(f'sea, quiet, {rival}: velocity RMSE', cell.quiet_velocity, 'm/s'),
            report.Figure(f'sea, quiet, {rival}: position RMSE', cell.quiet_position, 'm'),
        ]
    quiet = {rival: found['sea', '0 -> .5', rival].quiet_velocity for rival in FILTERS}
    for rival in (ROUGH, BP):
        out.append(
            report.at_most(
                f'sea, quiet, {rival} over CS: velocity RMSE',
                quiet[rival] / quiet[CS],
                0.65,
                '',
                CS,
            )
        )
    for step, limit in RMSE_LIMITS.items():
        out.append(
            report.at_most(
                f'sea {step}, rough over BP: acceleration RMSE',
                ratio(found, 'sea', step, ROUGH, BP).value,
                limit,
                '',
                BP,
            )
        )
    out.append(
        report.at_most(
            'sea 0 -> .5, rough: greatest overshoot', found['sea', '0 -> .5', ROUGH].overshoot, 1.3
        )
    )
    return out


def calmness(calm: Mapping[str, Mapping[str, float]]) -> list[report.Figure]:
    """Mean O by radar and kind of network."""
    return [
        report.Figure(f'share O on a straight course, {kind}: {name}', value)
        for name, kinds in calm.items()
        for kind, value in kinds.items()
    ]


def ratio(found: Found, setting: str, step: str, rival: str, against: str) -> Ratio:
    """Ratio of the acceleration RMSE of one filter to another's."""
    one, other = (found[setting, step, name].of_runs for name in (rival, against))
    square = one.mean() / other.mean()
    # Both saw the same plots, so errors they share cancel in the difference.
    spread = 1.96 * np.std(one - square * other) / (np.sqrt(len(one)) * other.mean())
    low, value, high = np.sqrt(np.maximum(square + np.array([-spread, 0, spread]), 0.0))
    return Ratio(float(value), float(low), float(high))


def claims(found: Found) -> list[report.Claim]:
    """What the paper says, what was found, and the verdict."""
    air = SETTINGS['air'].steps
    return [
        _better(
            found,
            'paper 001, Figs 3-5',
            'the rough network tracks every manoeuvre (weak, '
            'strong, changing) better than the BP network',
            ROUGH,
            BP,
        ),
        _delay(found, air),
        _growing(found, air),
        _stable(found),
        _parallel(found),
        _better(
            found, 'ours', 'an IMM of the same two filters beats the rough network', IMM, ROUGH
        ),
        _better(found, 'ours', 'an IMM of the same two filters beats the BP network', IMM, BP),
    ]


def _better(found: Found, source: str, text: str, rival: str, against: str) -> report.Claim:
    over = {
        f'{name} {step}': ratio(found, name, step, rival, against)
        for name, setting in SETTINGS.items()
        for step in setting.steps
    }
    won = sum(one.high < 1 for one in over.values())
    lost = sum(one.low > 1 for one in over.values())
    told = ', '.join(
        f'{name} {one.value:.3f} [{one.low:.3f} {one.high:.3f}]' for name, one in over.items()
    )
    return report.Claim(
        source,
        text,
        f'acceleration RMSE, {rival} over {against} [95 %]: {told}; '
        f'better in {won} of {len(over)}, worse in {lost}',
        verdict(won == len(over), IN_PART if won > lost else NOT_BORNE_OUT),
    )


def _delay(found: Found, steps) -> report.Claim:
    delays = {
        step: [found['air', step, rival].delay for rival in (ROUGH, BP, CS)] for step in steps
    }
    told = '; '.join(f'{step} {a:g}, {b:g}, {c:g} s' for step, (a, b, c) in delays.items())
    shorter = [a < b for a, b, _ in delays.values()]
    return report.Claim(
        'paper 001, section 6',
        'the rough network shortens the delay in manoeuvres',
        f'rough, BP, plain CS: {told}',
        verdict(all(shorter), IN_PART if any(shorter) else NOT_BORNE_OUT),
    )


def _growing(found: Found, steps) -> report.Claim:
    gain = {step: 1 - ratio(found, 'air', step, ROUGH, BP).value for step in steps}
    told = ', '.join(f'{step} {value:+.1%}' for step, value in gain.items())
    return report.Claim(
        'paper 001, section 6',
        'the greater the acceleration, the more it gains on BP',
        f'gain: {told}',
        verdict(gain['0 -> 40'] > gain['5 -> 25'] > gain['0 -> 5'] and gain['0 -> 40'] > LITTLE),
    )


def _stable(found: Found) -> report.Claim:
    calm = {rival: found['sea', '0 -> .5', rival] for rival in (ROUGH, BP)}
    told = '; '.join(
        f'{rival}: O {cell.share[20 : SETTINGS["sea"].change].mean():.3f}, velocity '
        f'{cell.quiet_velocity:.3f} m/s'
        for rival, cell in calm.items()
    )
    gain = 1 - calm[ROUGH].quiet_velocity / calm[BP].quiet_velocity
    return report.Claim(
        'paper 001, section 4',
        'two values to an input are steadier than one',
        f'sea, before the step: {told}; gain {gain:+.1%}',
        verdict(gain > LITTLE, IN_PART if gain > 0 else NOT_BORNE_OUT),
    )


def _parallel(found: Found) -> report.Claim:
    air, sea = found['air', '0 -> 40', ROUGH], found['sea', '0 -> 1', ROUGH]
    plain = found['air', '0 -> 40', CS], found['sea', '0 -> 1', CS]
    calmer = sea.quiet_velocity / plain[1].quiet_velocity
    return report.Claim(
        'paper 001, section 4',
        'the parallel filter is accurate without manoeuvre and quick in it',
        f'against the plain CS filter, velocity without manoeuvre {calmer:.2f} (sea); in hard '
        f'manoeuvres it answers later ({air.delay:g} against {plain[0].delay:g} s, sea '
        f'{sea.delay:.1f} against {plain[1].delay:.1f} s) and overshoots ({air.overshoot:.2f} '
        f'against {plain[0].overshoot:.2f})',
        BORNE_OUT
        if calmer < 1 and air.delay <= plain[0].delay
        else IN_PART
        if calmer < 1
        else NOT_BORNE_OUT,
    )
