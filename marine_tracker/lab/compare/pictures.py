"""Every estimator's errors relative to those of the IMM, scene by scene."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from ...evaluation.result import Picture

BESIDE = 'imm'
# Colours of Okabe and Ito, and a marker each. Other estimators take the colours that are left.
MARKS = (
    ('s', '#e69f00'),
    ('o', '#0072b2'),
    ('^', '#009e73'),
    ('v', '#cc79a7'),
    ('D', '#56b4e9'),
    ('P', '#d55e00'),
    ('X', '#000000'),
    ('*', '#7f7f7f'),
)
MOST = 2.5  # ratio; larger values are drawn at the edge
FEWER = 0.02  # held for this much less of the time than with the IMM: drawn hollow


def picture(found: Mapping[str, Mapping[str, Any]]) -> Picture:
    """Errors by estimator and scene (compare.py)."""
    scenes = list(next(iter(found.values())))
    return Picture(
        'compare', (10, 1.7 + 0.36 * len(scenes)), partial(paint, found=found, scenes=scenes)
    )


def paint(figure: Any, found: Mapping[str, Mapping[str, Any]], scenes: Sequence[str]) -> None:
    """Two panels, position and velocity; one row a scene. Left of 1 is better than the IMM."""
    panels = figure.subplots(1, 2, sharey=True)
    others = [name for name in found if name != BESIDE]
    for axes, what in zip(panels, ('position', 'velocity'), strict=True):
        axes.set(xscale='log', xlim=(0.6, MOST), ylim=(len(scenes) - 0.5, -0.5))
        for row in range(1, len(scenes), 2):
            axes.axhspan(row - 0.5, row + 0.5, color='0.955', linewidth=0)
        axes.axvline(1.0, color='0.35', linewidth=1)
        for row, scene in enumerate(scenes):
            for place, name in enumerate(others):
                _mark(
                    axes,
                    row + 0.7 * (place + 0.5) / len(others) - 0.35,
                    place,
                    found[name][scene],
                    found[BESIDE][scene],
                    what,
                )
        ticks = (0.6, 0.7, 0.8, 1.0, 1.2, 1.5, 2.0, 2.5)
        axes.set_xticks(ticks, [f'{tick:g}' for tick in ticks])
        axes.minorticks_off()
        axes.grid(axis='x', color='0.9')
        axes.set_axisbelow(True)
        axes.set_xlabel(f'{what} error over that of {BESIDE}')
        axes.tick_params(axis='y', length=0)
    panels[0].set_yticks(range(len(scenes)), [scene.replace('_', ' ') for scene in scenes])
    for place, name in enumerate(others):
        mark, colour = MARKS[place % len(MARKS)]
        panels[0].plot([], [], mark, color=colour, linestyle='', label=name)
    panels[0].plot([], [], color='0.35', linewidth=1, label=BESIDE)
    figure.legend(
        loc='outside upper left',
        ncols=len(found),
        frameon=False,
        fontsize=9,
        title=f'Left of 1 is better; at the right edge: {MOST:g} or more; hollow: holds '
        'its targets for less of the time',
        alignment='left',
        columnspacing=1.0,
        handletextpad=0.2,
    )


def _mark(axes, y: float, place: int, errors, beside, what: str) -> None:
    value = getattr(errors, what) / getattr(beside, what)
    mark, colour = MARKS[place % len(MARKS)]
    if np.isnan(value):
        return
    hollow = errors.held < beside.held - FEWER
    axes.plot(
        min(value, MOST),
        y,
        mark,
        color=colour,
        markersize=5,
        clip_on=False,
        markerfacecolor='white' if hollow else colour,
    )
