"""The filters' answers to a step of the acceleration: Figs 3 to 5 of paper 001, and at sea."""

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from ...evaluation.result import Picture
from .trials import BP, CS, IMM, ROUGH, SETTINGS, Answer

# Colours of Okabe and Ito, as in `lab.gwnn.pictures`. The BP network's line is wide, because the
# other one covers it.
STYLES = {
    CS: ('#000000', '--', 1.5, 'CS filter alone'),
    IMM: ('#009e73', '-', 1.5, IMM),
    BP: ('#e69f00', '-', 4.0, 'BP network'),
    ROUGH: ('#0072b2', '-', 1.5, 'rough network'),
}
PAPER = {'0 -> 5': 'weak (Fig 3)', '0 -> 40': 'strong (Fig 4)', '5 -> 25': 'step (Fig 5)'}
BEFORE = 10  # scans shown before the step


def pictures(found: Mapping[tuple[str, str, str], Answer]) -> list[Picture]:
    """One for the paper's scenario, one at sea."""
    return [
        Picture(
            f'rough_nn_{name}',
            (3.6 * len(setting.steps), 5.6),
            partial(paint, found=found, name=name),
        )
        for name, setting in SETTINGS.items()
    ]


def paint(figure: Any, found: Mapping[tuple[str, str, str], Answer], name: str) -> None:
    """Top: the mean acceleration. Bottom: the mean O (for the IMM the weight of its F1)."""
    setting = SETTINGS[name]
    above, below = figure.subplots(2, len(setting.steps), sharex=True, height_ratios=(3, 1.3))
    time = (np.arange(setting.scans) - setting.change) * setting.period
    for step, top, bottom in zip(setting.steps, above, below):
        before, after = setting.steps[step]
        top.step(
            time,
            np.where(time < 0, before, after),
            where='post',
            color='0.6',
            linewidth=1,
            label='truth',
        )
        for rival, (colour, line, width, text) in STYLES.items():
            cell = found[name, step, rival]
            top.plot(time, cell.mean, line, color=colour, linewidth=width, label=text)
            if rival != CS:
                bottom.plot(time, cell.share, line, color=colour, linewidth=width)
        size = after - before
        top.set(
            title=f'{step} m/s² {PAPER.get(step, "")}'.rstrip(),
            xlim=(-BEFORE * setting.period, time[-1]),
            ylim=(before - 0.2 * size, after + 0.45 * size),
        )
        bottom.set(xlabel='time after the step, s', ylim=(0, 1))
        for axes in (top, bottom):
            axes.grid(color='0.92')
            axes.set_axisbelow(True)
    above[0].set_ylabel('mean acceleration, m/s²')
    below[0].set_ylabel('share O')
    handles, labels = above[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc='outside upper left', ncols=5, frameon=False, fontsize=9)
