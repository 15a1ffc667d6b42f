"""The comparison as a picture: every estimator's error relative to the IMM's, cell by cell."""

from functools import partial
from typing import Any

from ...evaluation.result import Picture
from .figures import SHIPPED, Findings, fair_cells
from .trials import HELD_OUT, MANOEUVRE, OWN, Cell, is_stranger

# Colours of Okabe and Ito, safe for colour-blind readers; the markers differ too. OWN is drawn
# last.
STYLES = {
    'CS': ('x', '#000000', 'current statistical model (tuned)'),
    'CV/CV': ('D', '#cc79a7', 'IMM of two constant velocities (tuned)'),
    MANOEUVRE: ('s', '#e69f00', 'IMM tuned for manoeuvre'),
    SHIPPED: ('^', '#009e73', '`imm` as shipped'),
    OWN: ('o', '#0072b2', 'GWNN'),
}
LEAST, MOST = 0.8, 1.6  # ratio; larger values are written as a number at the edge
LINE = 0.16  # rows between two estimators


def pictures(found: Findings) -> list[Picture]:
    """One for each vessel class."""
    made = []
    for name, title in (('ship', 'Ships'), ('small_craft', 'Small craft')):
        cells = fair_cells(found, name)
        made.append(
            Picture(
                f'gwnn_{name}',
                (9, 1.5 + 0.4 * len(cells)),
                partial(compare, cells=cells, title=title),
            )
        )
    return made


def compare(figure: Any, cells: list[Cell], title: str) -> None:
    """Rows of cells: straight courses, manoeuvres, then kinds of motion outside the training."""
    groups: dict[str, list[Cell]] = {'straight': [], 'manoeuvre': [], 'never trained on': []}
    for cell in cells:
        new = cell.kind in HELD_OUT or is_stranger(cell.vessel_class, cell.kind)
        groups['never trained on' if new else cell.phase].append(cell)
    rows = [cell for group in groups.values() for cell in group]
    ships = cells[0].vessel_class == 'ship'  # for whom one rival less keeps the picture readable
    shown = [name for name in STYLES if name != SHIPPED or not ships]
    least = min([LEAST] + [0.97 * cell.position[name].value for cell in rows for name in shown])
    axes = figure.add_subplot(xscale='log', xlim=(least, MOST), ylim=(len(rows) - 0.5, -0.5))
    for row, cell in enumerate(rows):
        if row % 2:
            axes.axhspan(row - 0.5, row + 0.5, color='0.955', linewidth=0)
        for place, name in enumerate(shown):
            _mark(axes, row + LINE * (len(shown) / 2 - 0.5 - place), name, cell.position[name])
    axes.axvline(1.0, color='0.35', linewidth=1)
    edge = 0
    for group in list(groups.values())[:-1]:
        edge += len(group)
        axes.axhline(edge - 0.5, color='0.35', linewidth=1)
    if groups['never trained on']:
        axes.annotate(
            'never trained on',
            (MOST, edge - 0.5),
            xytext=(-4, -3),
            fontsize=8,
            textcoords='offset points',
            ha='right',
            va='top',
            color='0.35',
        )
    axes.set_yticks(range(len(rows)), [f'{cell.kind}, {cell.phase}' for cell in rows])
    axes.tick_params(axis='y', length=0)
    ticks = [tick / 10 for tick in range(1, 17) if tick / 10 >= least]
    axes.set_xticks(ticks, [f'{tick:g}' for tick in ticks])
    axes.minorticks_off()
    axes.set_xlabel(
        'position error one scan ahead, over that of the IMM tuned on all kinds of '
        'motion   (left of 1 is better)'
    )
    axes.grid(axis='x', color='0.9')
    axes.set_axisbelow(True)
    for name in reversed(shown):
        mark, colour, text = STYLES[name]
        axes.plot([], [], mark, color=colour, markersize=_size(name), linestyle='', label=text)
    axes.plot([], [], color='0.35', linewidth=1, label='1: IMM tuned on all kinds of motion')
    figure.legend(
        loc='outside upper left',
        ncols=3,
        frameon=False,
        fontsize=9,
        title=f'{title}: 95 % intervals over the tracks',
        alignment='left',
    )


def _size(name: str) -> int:
    return 7 if name == OWN else 5


def _mark(axes, y: float, name: str, ratio) -> None:
    mark, colour, _ = STYLES[name]
    if ratio.value > MOST:
        axes.plot(MOST, y, '>', color=colour, markersize=5, clip_on=False)
        axes.annotate(
            f'{ratio.value:.1f}',
            (MOST, y),
            xytext=(6, 0),
            textcoords='offset points',
            va='center',
            fontsize=8,
            color=colour,
            annotation_clip=False,
        )
        return
    axes.plot([ratio.low, ratio.high], [y, y], color=colour, linewidth=1.2)
    axes.plot(ratio.value, y, mark, color=colour, markersize=_size(name))
