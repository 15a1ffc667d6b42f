"""The comparison of `gwnn` with its rivals as figures with limits."""

from typing import NamedTuple

import numpy as np

from ...evaluation.report import Figure, at_most
from ...training.track_trials import Ratio
from .failures import BREAK_SIZE, COST_TRACKS
from .trials import (
    ALONE,
    FLEETS,
    HELD_OUT,
    IMM,
    LINE,
    MANOEUVRE,
    OWN,
    Cell,
    Conditions,
    is_stranger,
)

# Limits for ships: geometric means of the ratios to the IMM, and what no cell may surely exceed.
WHAT = 'position', 'velocity'
MEAN = {'position': 0.93, 'velocity': 0.91}
MEAN_STRAIGHT = {'position': 0.92, 'velocity': 0.90}
MEAN_STRANGERS = {'position': 0.95, 'velocity': 0.93}
CELL_LIMIT, STRANGER_LIMIT = 1.0, 1.02
LINE_LIMIT, MANOEUVRE_LIMIT = 1.10, 1.03  # ratio to the straight line; to the IMM for manoeuvres
NEES = (0.9, 1.1)  # limits of the mean over all scans; 1 in theory
SHIPPED, SHIPPED_LIMIT = 'IMM as shipped', 1.02  # limit for small craft: not worse than `imm`
HARD_LIMIT = 1.03
SIGMA_LIMITS = {'straight': 0.85, 'manoeuvre': 1.10}
NIS = (1.6, 2.8)  # 2 in theory
IDLE = 0.003  # limit of the share of scans in needless fallback
AGILE = ('agile', 'boat', 'stick')
BROKEN = {'ship': ('mix', 'sharp', 'autopilot', 'agile'), 'small_craft': ('cruise',)}
CAUGHT, CAUGHT_AGILE = 8, 20  # limits: scans from the break to the fallback, in nine of ten runs
RUBBISH_LIMIT = 1.10  # limit, relative to CS-Kalman's error
COST_LIMIT = 15.0  # ms, limit
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
    others = ['autopilot', 'ferry'] if vessel_class == 'ship' else []
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
    if is_stranger(cell.vessel_class, cell.kind):
        fleet = 'stranger, '
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
    name, ships = name_of(cell), cell.vessel_class == 'ship'
    limit = STRANGER_LIMIT if is_stranger(cell.vessel_class, cell.kind) else CELL_LIMIT
    alone, told = cell.position[ALONE].value, f'{IMM} {cell.rms[IMM]:.3f}'
    table = [Figure(f'{name}: position', cell.rms[OWN], 'sigma', None, None, told)]
    for what in WHAT:
        ratio = getattr(cell, what)[OWN]
        table.append(
            Figure(
                f'{name}: {what} ratio',
                ratio.value,
                '',
                f'<= {limit:g}, or within chance' if ships else None,
                min(ratio.value, ratio.low) <= limit if ships else None,
                interval(ratio),
            )
        )
    for rival, most, phase in (
        (LINE, LINE_LIMIT, 'straight'),
        (MANOEUVRE, MANOEUVRE_LIMIT, 'manoeuvre'),
    ):
        if rival in cell.faster and cell.phase == phase and ships:
            for what, ratio in zip(WHAT, (cell.over[rival], cell.faster[rival])):
                told = interval(ratio, rival)
                table.append(
                    at_most(f'{name}: {what} ratio to the {rival}', ratio.value, most, '', told)
                )
    if not ships:
        over = cell.over[SHIPPED]
        told = interval(over, SHIPPED)
        table.append(
            at_most(f'{name}: position ratio to `imm`', over.value, SHIPPED_LIMIT, '', told)
        )
    low, high = NIS
    table += [
        Figure(
            f'{name}: mean NIS',
            cell.nis,
            '',
            f'{low} .. {high}' if ships else None,
            low <= cell.nis <= high if ships else None,
            '2 in theory',
        ),
        Figure(f'{name}: mean NEES', cell.nees, '', None, None, '1 in theory'),
        at_most(
            f'{name}: scans in fallback',
            100 * cell.idle,
            100 * IDLE,
            '%',
            f'{ALONE}: position ratio {alone:.3f}',
        ),
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
    """Geometric means over the cells, of the network and of its rivals; strangers apart."""
    if vessel_class != 'ship':
        prefix = f'{vessel_class.replace("_", " ")}, '
        return [one for what in WHAT for one in _mean(f'{prefix}{what}', what, cells)]
    own = [cell for cell in cells if not is_stranger(vessel_class, cell.kind)]
    strangers = [cell for cell in cells if is_stranger(vessel_class, cell.kind)]
    straight = [cell for cell in own if cell.phase == 'straight']
    new = [cell for cell in own if cell.kind in HELD_OUT]
    table = []
    for what in WHAT:
        table += _mean(what, what, own, MEAN[what])
        table += _mean(f'straight cells, {what}', what, straight, MEAN_STRAIGHT[what])
        table += _mean(f'never trained on, {what}', what, new)
        table += _mean(f'strangers, {what}', what, strangers, MEAN_STRANGERS[what])
    low, high = NEES
    for name, some in (('', own), ('strangers, ', strangers)):
        if some:
            value = float(np.average([cell.nees for cell in some], weights=[c.scans for c in some]))
            table.append(
                Figure(
                    f'{name}NEES, mean over all scans',
                    value,
                    '',
                    f'{low} .. {high}',
                    low <= value <= high,
                    '1 in theory',
                )
            )
    return table


def _mean(name: str, what: str, cells: list[Cell], limit: float | None = None) -> list[Figure]:
    """Geometric means of position or velocity over some cells; only the network's has a limit."""
    table = []
    for rival in getattr(cells[0], what) if cells else ():
        if rival == LINE:  # is not there in every cell
            continue
        mean = geometric_mean([getattr(cell, what)[rival] for cell in cells])
        called = f'{name} ratio, geometric mean over the cells'
        if rival == OWN and limit is not None:
            table.append(at_most(called, mean.value, limit, '', interval(mean)))
        else:
            called += '' if rival == OWN else f', {rival}'
            table.append(Figure(called, mean.value, '', None, None, interval(mean)))
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
