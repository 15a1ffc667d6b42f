"""Pictures of the wavelet experiment: the paper's Fig 1 redrawn, and a_max at sea."""

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from ...evaluation.result import Picture
from ...types import Array
from .study import SCENES, SIZE

CS_COLOUR, OURS_COLOUR, LATE_COLOUR, OTHER = '#c2571a', '#1f5fa8', '#009e73', '0.35'
SMOOTH = 20  # s of averaging, so that the curves can be told apart


def pictures(
    errors: Mapping[tuple[str, str], Array],
    sea: Mapping[tuple[str, float], tuple[float, float]],
    sea_imm: tuple[float, float],
) -> list[Picture]:
    """Both."""
    return [
        Picture('wavelet_fig1', (9, 6.0), partial(over_time, errors=errors)),
        Picture('wavelet_a_max', (9, 3.8), partial(limits, sea=sea, sea_imm=sea_imm)),
    ]


def over_time(figure: Any, errors: Mapping[tuple[str, str], Array]) -> None:
    """Fig 1: error of x over time."""
    figure.suptitle(f'RMS error along x, mean of {SMOOTH} s (Fig 1, reconstructed scenes)')
    styles = {
        'CS-Kalman': (CS_COLOUR, '-'),
        'CS-Kalman + RTS': (CS_COLOUR, '--'),
        'late, coarse': (LATE_COLOUR, '-'),
        'wavelet_cs': (OURS_COLOUR, '-'),
        'IMM of two CV': (OTHER, ':'),
    }
    for axes, scene in zip(figure.subplots(len(SCENES), 1, sharex=True), SCENES, strict=True):
        for name, (colour, line) in styles.items():
            error = errors[scene, name][..., 0]
            late = ' (late)' if 'RTS' in name else ''
            if name == 'late, coarse':
                error = error.reshape(len(error), -1, SIZE).mean(2).repeat(SIZE, 1)
                late = ', block mean'
            square = np.mean(error**2, 0).reshape(-1, SMOOTH).mean(1)
            axes.plot(
                SMOOTH * (np.arange(len(square)) + 0.5),
                np.sqrt(square),
                line,
                color=colour,
                label=name + late,
            )
        axes.set(ylabel=f'{scene}: error, m', ylim=(0, None), xlim=(0, error.shape[1]))
        axes.grid(color='0.92')
    axes.set_xlabel('time, s')
    axes.legend(ncols=2, fontsize=8)


def limits(
    figure: Any, sea: Mapping[tuple[str, float], tuple[float, float]], sea_imm: tuple[float, float]
) -> None:
    """Sensitivity to a_max in turns of 1.5 deg/s, whose acceleration is 0.21 m/s^2."""
    figure.suptitle('Turns of 1.5 deg/s at 8 m/s (0.21 m/s²), 15 m and 0.5 deg, 22 rpm, no latency')
    for which, (axes, unit) in enumerate(
        zip(figure.subplots(1, 2), ('position, m', 'velocity, m/s'))
    ):
        for name, colour in (('CS-Kalman', CS_COLOUR), ('wavelet_cs', OURS_COLOUR)):
            points = sorted(
                (limit, value[which]) for (filter_, limit), value in sea.items() if filter_ == name
            )
            axes.plot(*zip(*points), 'o-', color=colour, label=name)
        axes.axhline(sea_imm[which], color=OTHER, linestyle=':', label='imm')
        axes.set(xscale='log', xlabel='a_max, m/s²', ylabel=f'RMS an axis: {unit}', ylim=(0, None))
        ticks = (0.05, 0.1, 0.3, 1, 3)
        axes.set_xticks(ticks, [f'{tick:g}' for tick in ticks])
        axes.minorticks_off()
        axes.grid(color='0.92')
        axes.legend()
