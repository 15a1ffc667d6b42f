"""Claims about `gwnn`, and whether the comparison confirms them."""

from ...evaluation.report import Claim
from ...evaluation.result import IN_PART, NOT_BORNE_OUT, verdict
from .figures import (
    IDLE,
    MEAN,
    MEAN_STRANGERS,
    RUBBISH_LIMIT,
    SHIPPED,
    WHAT,
    Findings,
    fair_cells,
    geometric_mean,
    name_of,
)
from .trials import ALONE, IMM, MANOEUVRE, OWN, Cell, is_stranger


def claims(found: Findings) -> list[Claim]:
    """Each claim with what was found and the verdict. A cell is won or lost if its interval says
    so.
    """
    every, boats = (fair_cells(found, name) for name in ('ship', 'small_craft'))
    ships = [cell for cell in every if not is_stranger('ship', cell.kind)]
    strangers = [cell for cell in every if is_stranger('ship', cell.kind)]
    return [
        _mean('ships', ships, MEAN),
        *(
            [_mean('ships of the independent simulation', strangers, MEAN_STRANGERS)]
            if strangers
            else []
        ),
        _everywhere(ships, IMM, 'the IMM tuned on the same tracks'),
        _everywhere(ships, MANOEUVRE, 'the IMM tuned for manoeuvre'),
        _everywhere(every, 'CS of the fallback', 'CS-Kalman, which it falls back to'),
        _fallback(every),
        _rubbish(found),
        _everywhere(boats, SHIPPED, '`imm` as shipped for small craft'),
        _everywhere(boats, IMM, 'the IMM tuned on the same tracks of small craft'),
    ]


def _mean(whose: str, cells: list[Cell], most: dict[str, float]) -> Claim:
    means = [geometric_mean([getattr(cell, what)[OWN] for cell in cells]) for what in WHAT]
    told = [
        f'{what} {1 - mean.value:+.1%} [{1 - mean.high:+.1%} {1 - mean.low:+.1%}]'
        for what, mean in zip(WHAT, means)
    ]
    return Claim(
        f'{whose}, mean of all cells',
        'errors below those of the strongest IMM by '
        + ' and '.join(f'{1 - most[what]:.0%} ({what})' for what in WHAT),
        'gain, geometric mean over the cells: ' + ', '.join(told),
        verdict(
            all(mean.value <= most[what] for what, mean in zip(WHAT, means)),
            IN_PART if all(mean.high < 1 for mean in means) else NOT_BORNE_OUT,
        ),
    )


def _everywhere(cells: list[Cell], rival: str, called: str) -> Claim:
    """The verdict over every kind of motion and phase."""
    over = {name_of(cell): cell.over[rival] for cell in cells}
    won = [name for name, ratio in over.items() if ratio.high < 1]
    lost = {name: ratio for name, ratio in over.items() if ratio.low > 1}
    mean = geometric_mean(list(over.values()))
    told = (
        f'ratio {mean.value:.3f} [{mean.low:.3f} {mean.high:.3f}], geometric mean; '
        f'{len(won)} of {len(over)} cells won, {len(lost)} lost'
    )
    if lost:
        told += ': ' + ', '.join(f'{name} {ratio.value:.3f}' for name, ratio in lost.items())
    whose = 'small craft' if cells[0].vessel_class == 'small_craft' else 'ships'
    return Claim(
        f'{whose}, every kind of motion',
        f'better than {called}',
        told,
        verdict(len(won) == len(over), IN_PART if mean.high < 1 else NOT_BORNE_OUT),
    )


def _fallback(cells: list[Cell]) -> Claim:
    most = max(cells, key=lambda cell: cell.idle)
    mean = geometric_mean([cell.over[ALONE] for cell in cells])
    return Claim(
        'monitor',
        'on good weights it hardly ever falls back',
        f'at most {most.idle:.1%} of the scans ({name_of(most)}); the errors are '
        f'{mean.value:.3f} of those of a network that never falls back',
        verdict(most.idle <= IDLE, IN_PART),
    )


def _rubbish(found: Findings) -> Claim:
    ratios = [ratio for pair in found.rubbish.values() for ratio in pair]
    told = ', '.join('not numbers' if ratio is None else f'{ratio.value:.3f}' for ratio in ratios)
    return Claim(
        'monitor',
        'bad weights cost little more than CS-Kalman',
        f'position ratios with random weights, and with weights that are not numbers: {told}',
        verdict(all(ratio is not None and ratio.value <= RUBBISH_LIMIT for ratio in ratios)),
    )
