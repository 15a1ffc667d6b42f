"""The comparison of `gwnn` with its rivals as figures with limits."""

from typing import NamedTuple

import numpy as np

from ...evaluation.report import Figure, at_most
from ...training.track_trials import Ratio
from .failures import BREAK_SIZE, COST_TRACKS
from .trials import ALONE, BRIEFLY, FLEETS, IMM, OWN, Cell, Conditions

GEOMETRIC_MEAN = 0.96
# Limits of the position ratio for ships, by cell. Every other cell: 1.00, upper end of the interval
# 1.01.
DEMANDED = {
    'steady, straight': 0.94,
    'weave, manoeuvre': 0.93,
    'sharp, manoeuvre': 0.93,
    'agile, manoeuvre': 0.89,
    'AIS, straight': 0.97,
    'boat, manoeuvre': 0.97,
}
UPPER_END = 1.01
VELOCITY_LIMIT = 1.02
SHIPPED, SHIPPED_LIMIT = 'IMM as shipped', 1.02  # limit for small craft: not worse than `imm`
HARD_LIMIT = 1.03
SIGMA_LIMITS = {'straight': 0.85, 'manoeuvre': 1.10}
NIS = (1.6, 2.8)  # 2 in theory
IDLE = {'straight': 0.006, 'manoeuvre': 0.013}  # limit of the share of scans in needless fallback
IDLE_AGILE = {'straight': 0.029, 'manoeuvre': 0.035}
AGILE = ('agile', 'boat')
BROKEN = {'ship': ('mix', 'sharp', 'autopilot', 'agile'), 'small_craft': ('cruise',)}
CAUGHT, CAUGHT_AGILE = 8, 34  # limits: scans from the break to the fallback, in nine of ten runs
RUBBISH_LIMIT = 1.10  # limit, relative to CS-Kalman's error
COST_LIMIT = 40.0  # ms, limit
HARD, SIGMA = 'Pd .8, 3 % outliers, uneven scans', 'sigma stated half'
HARD_RPM = {'ship': 23.9, 'small_craft': 33.0}


class Findings(NamedTuple):
    """All measurements, by vessel class and kind of motion.

    fair     cells under fair conditions
    hard     under hard ones; sigma: with deviations stated half of what they are
    broken   scans from a break to the fallback, and the position ratio to CS-Kalman afterwards
    rubbish  position ratio to CS-Kalman with random weights and with ones that are not numbers
    cost     ms, of 1,000 tracks
    """

    fair: dict[tuple[str, str], list[Cell]]
    hard: dict[tuple[str, str], list[Cell]]
    sigma: dict[tuple[str, str], list[Cell]]
    broken: dict
    rubbish: dict
    cost: float


def conditions(vessel_class: str) -> list[tuple[str, str, Conditions]]:
    """Conditions other than the fair ones: name, kind of motion, radar."""
    fleet = FLEETS[vessel_class]
    hard = fleet.radar._replace(
        detection=0.8, outliers=0.03, jitter=0.05, rpm=HARD_RPM[vessel_class]
    )
    others = ['autopilot'] if vessel_class == 'ship' else []
    return [('hard', kind, hard) for kind in [fleet.usual, *others]] + [
        ('sigma', fleet.usual, fleet.radar._replace(truly=2.0))
    ]


def fair_cells(found: Findings, vessel_class: str) -> list[Cell]:
    """All cells of a vessel class under fair conditions."""
    return [
        cell for (name, _), cells in found.fair.items() if name == vessel_class for cell in cells
    ]


def name_of(cell: Cell) -> str:
    """The name of a cell in a figure."""
    fleet = '' if cell.vessel_class == 'ship' else f'{cell.vessel_class.replace("_", " ")}, '
    return f'{fleet}{cell.kind}, {cell.phase}'


def geometric_mean(ratios: list[Ratio]) -> Ratio:
    """Geometric mean over independent cells. The interval comes from theirs, taken as normal."""
    level, low, high = np.log(np.array(ratios)).T
    half = np.sqrt(np.square(0.5 * (high - low)).sum()) / len(ratios)
    return Ratio(*(float(np.exp(level.mean() + side * half)) for side in (0, -1, 1)))


def figures(found: Findings) -> list[Figure]:
    """All figures."""
    table = []
    for name in FLEETS:
        cells = fair_cells(found, name)
        for cell in cells:
            table += _figures_of_a_cell(cell)
        table += _means(name, cells)
        for (of, _), others in found.hard.items():
            table += [_under(cell, HARD, HARD_LIMIT) for cell in others if of == name]
        for (of, _), others in found.sigma.items():
            table += [
                _under(cell, SIGMA, SIGMA_LIMITS[cell.phase]) for cell in others if of == name
            ]
    return table + _figures_of_failures(found)


def _figures_of_a_cell(cell: Cell) -> list[Figure]:
    name, ratio, ships = name_of(cell), cell.position[OWN], cell.vessel_class == 'ship'
    table = [
        Figure(
            f'{name}: position', cell.rms[OWN], 'sigma', None, None, f'{IMM} {cell.rms[IMM]:.3f}'
        )
    ]
    if ships:
        limit = DEMANDED.get(name, 1.0)
        table.append(
            Figure(
                f'{name}: position ratio',
                ratio.value,
                '',
                f'<= {limit:g}, upper end {UPPER_END}',
                ratio.value <= limit and ratio.high <= UPPER_END,
                interval(ratio),
            )
        )
        brief = cell.over[BRIEFLY]
        table.append(
            Figure(
                f'{name}: position ratio to the {BRIEFLY}',
                brief.value,
                '',
                None,
                None,
                interval(brief, BRIEFLY),
            )
        )
    else:
        table.append(
            Figure(f'{name}: position ratio', ratio.value, '', None, None, interval(ratio))
        )
        over = cell.over[SHIPPED]
        table.append(
            at_most(
                f'{name}: position ratio to `imm`',
                over.value,
                SHIPPED_LIMIT,
                '',
                interval(over, SHIPPED),
            )
        )
    velocity, alone = cell.velocity[OWN], cell.velocity[ALONE].value
    against = f'{interval(velocity)}; {ALONE} {alone:.3f}'
    table.append(
        at_most(f'{name}: velocity ratio', velocity.value, VELOCITY_LIMIT, '', against)
        if ships
        else Figure(f'{name}: velocity ratio', velocity.value, '', None, None, against)
    )
    low, high = NIS
    idle = (IDLE_AGILE if cell.kind in AGILE or not ships else IDLE)[cell.phase]
    table += [
        Figure(
            f'{name}: mean NIS',
            cell.nis,
            '',
            f'{low} .. {high}' if ships else None,
            low <= cell.nis <= high if ships else None,
            '2 in theory',
        ),
        at_most(f'{name}: scans in fallback', 100 * cell.idle, 100 * idle, '%'),
    ]
    table += [
        Figure(
            f'{name}: position ratio, {rival}',
            other.value,
            '',
            None,
            None,
            f'{interval(other)}; velocity {cell.velocity[rival].value:.3f}',
        )
        for rival, other in cell.position.items()
        if rival not in (OWN, ALONE)
    ]
    return table


def _means(vessel_class: str, cells: list[Cell]) -> list[Figure]:
    """Geometric means over the cells, of the network and of its rivals."""
    prefix = '' if vessel_class == 'ship' else f'{vessel_class.replace("_", " ")}, '
    table = []
    for what in ('position', 'velocity'):
        for rival in getattr(cells[0], what):
            mean = geometric_mean([getattr(cell, what)[rival] for cell in cells])
            name = f'{prefix}{what} ratio, geometric mean over the cells'
            if rival == OWN and vessel_class == 'ship':
                table.append(at_most(name, mean.value, GEOMETRIC_MEAN, '', interval(mean)))
            else:
                table.append(
                    Figure(
                        name if rival == OWN else f'{name}, {rival}',
                        mean.value,
                        '',
                        None,
                        None,
                        interval(mean),
                    )
                )
    return table


def _under(cell: Cell, what: str, limit: float) -> Figure:
    ratio, name = cell.position[OWN], f'{name_of(cell)}, {what}: position ratio'
    if cell.vessel_class == 'ship':
        return at_most(name, ratio.value, limit, '', interval(ratio))
    over = cell.over[SHIPPED]
    return at_most(
        f'{name} to `imm`',
        over.value,
        limit,
        '',
        f'{interval(over, SHIPPED)}; {IMM} {ratio.value:.3f}',
    )


def _figures_of_failures(found: Findings) -> list[Figure]:
    table = []
    for (name, kind), (first, after) in found.broken.items():
        limit = CAUGHT_AGILE if kind in AGILE or name != 'ship' else CAUGHT
        table += [
            at_most(
                f'{kind}: scans to fallback after a break of {BREAK_SIZE:g} sigma, p90',
                float(np.percentile(first, 90)),
                limit,
            ),
            Figure(f'{kind}: position ratio after the break', after.value, '', None, None, 'CS'),
        ]
    for (_, kind), ratios in found.rubbish.items():
        for what, ratio in zip(('random weights', 'weights not numbers'), ratios):
            table.append(
                at_most(
                    f'{kind}, {what}: position ratio',
                    ratio and ratio.value,
                    RUBBISH_LIMIT,
                    '',
                    'CS',
                )
            )
    return [
        *table,
        at_most(f'extrapolation and update, {COST_TRACKS} tracks', found.cost, COST_LIMIT, 'ms'),
    ]


def interval(ratio: Ratio, to: str = IMM) -> str:
    """A ratio with its interval, as text."""
    return f'{to} [{ratio.low:.3f} {ratio.high:.3f}]'
