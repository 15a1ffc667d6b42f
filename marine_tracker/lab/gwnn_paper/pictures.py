"""Pictures of the results of `study`: the paper's Figs 1 to 5 and eq 20-22, redrawn."""

from functools import partial
from typing import Any

import numpy as np

from ...evaluation.result import Picture
from .study import FAR, NEAR, TURN_AT, Study

BP_COLOUR, GWNN_COLOUR, OTHER = '#c2571a', '#1f5fa8', '0.35'
SHOWN = 160  # plots of Fig 2 and 3


def pictures(s: Study) -> list[Picture]:
    """All five."""
    return [
        Picture(name, size, partial(paint, s=s))
        for name, size, paint in (
            ('fig1_steady', (9, 3.6), steady),
            ('fig2_3_convergence', (9, 4.6), convergence),
            ('fig4_noise', (9, 6.4), noise),
            ('fig5_sharp_turn', (9, 4.6), sharp_turn),
            ('eq20_22_robustness', (7.5, 4.4), robustness),
        )
    ]


def steady(figure: Any, s: Study) -> None:
    """Fig 1."""
    figure.suptitle('Steady error of the GWNN, no noise (Fig 1)')
    left, right = figure.subplots(1, 2)
    left.plot(s.speeds, s.range_error, 'o-', color=GWNN_COLOUR)
    left.axhline(NEAR, color=OTHER, linestyle='--', linewidth=1)
    left.annotate(
        'E1 = 1.852 m: no more training below',
        (s.speeds[0], NEAR),
        xytext=(0, -11),
        textcoords='offset points',
        fontsize=8,
        color=OTHER,
    )
    left.set(ylim=(0, 2.0), ylabel='range error, m RMS')
    right.plot(s.speeds, s.bearing_error, 'o-', color=GWNN_COLOUR)
    right.set(ylim=(0, None), ylabel='bearing error, deg RMS')
    for axes in (left, right):
        axes.set(xlabel='speed of the target, m/s', xlim=(0, 21))
        axes.grid(color='0.92')


def convergence(figure: Any, s: Study) -> None:
    """Fig 2 and 3."""
    axes = figure.add_subplot(
        title='Learning to extrapolate, medians of the seeds (Fig 2 and 3)',
        xlabel='plots learnt from',
        ylabel='radial error, m',
        yscale='log',
        xlim=(0, SHOWN),
        ylim=(0.2, 60),
    )
    styles = {
        'BP, equal step': (BP_COLOUR, ':'),
        'BP, variable step': (BP_COLOUR, '-'),
        'GWNN, equal step': (GWNN_COLOUR, ':'),
        'GWNN, variable step': (GWNN_COLOUR, '-'),
    }
    for name, (colour, line) in styles.items():
        error = s.learning[name][:SHOWN]
        count = np.median(s.plots[name])
        axes.plot(
            np.arange(1, 1 + len(error)),
            error,
            line,
            color=colour,
            label=f'{name}: {count:.0f} plots',
        )
    band(axes, (SHOWN - 1, 'right'))
    axes.legend()


def noise(figure: Any, s: Study) -> None:
    """Fig 4."""
    figure.suptitle(
        'Error of the GWNN one scan ahead in noise N(0.5, 0.3) m, medians of the seeds (Fig 4)'
    )
    for number, (what, limit) in enumerate(
        (('range, m', 4), ('bearing, deg', 0.05), ('speed, m/s', 0.2), ('course, deg', 1.0)), 1
    ):
        axes = figure.add_subplot(
            4, 1, number, ylabel=what, xlim=(0, len(s.noise)), ylim=(0, limit)
        )
        axes.plot(s.noise[:, number - 1], color=GWNN_COLOUR, linewidth=0.8)
        axes.grid(color='0.92')
        if number < 4:
            axes.tick_params(labelbottom=False)
    axes.set_xlabel('scan')


def sharp_turn(figure: Any, s: Study) -> None:
    """Fig 5."""
    axes = figure.add_subplot(
        title='Turn of 50 deg on a radius of 200 m at scan 500, no noise (Fig 5)',
        xlabel='scan',
        ylabel='radial error, m',
        ylim=(0, 16),
    )
    styles = {
        'BP, eta .1': (BP_COLOUR, '-'),
        'GWNN, eta .1': (GWNN_COLOUR, '-'),
        'BP, eta .5': (BP_COLOUR, '--'),
        'GWNN, eta .5': (GWNN_COLOUR, '--'),
        'line through two plots': (OTHER, ':'),
    }
    for name, (colour, line) in styles.items():
        error = s.turning[name]
        axes.plot(
            TURN_AT - 10 + np.arange(len(error)),
            error,
            line,
            color=colour,
            label=f'{name}: peak {s.peak[name]:.1f} m',
        )
    band(axes, (TURN_AT - 10, 'left'))
    axes.legend(title='curves: median of the seeds; peaks: median of theirs', title_fontsize=8)


def robustness(figure: Any, s: Study) -> None:
    """Eq 20 to 22."""
    axes = figure.add_subplot(
        title='Steepest wavelet against the steepest sigmoid (eq 20-22)',
        xlabel='1 / q',
        ylabel="max|psi'| / max|S'|",
        xlim=(0, 1.5),
        ylim=(0, 1.8),
    )
    axes.plot(s.ratio, s.steep, color=GWNN_COLOUR)
    axes.axhline(1.0, color=OTHER, linewidth=1)
    axes.plot(s.crossing, 1.0, 'o', color=GWNN_COLOUR)
    axes.annotate(
        f'found: {s.crossing:.4f} = atanh(1/√2)',
        (s.crossing, 1.0),
        xytext=(-12, 14),
        textcoords='offset points',
        ha='right',
        color=GWNN_COLOUR,
    )
    axes.axvline(0.9, color=BP_COLOUR, linestyle='--', linewidth=1)
    axes.annotate(
        'paper: 0.9', (0.9, 0.1), xytext=(6, 0), textcoords='offset points', color=BP_COLOUR
    )
    axes.grid(color='0.92')


def band(axes: Any, place: tuple[int, str]) -> None:
    """The paper's two error thresholds, named at (x, alignment)."""
    x, side = place
    for value, name in ((NEAR, 'E1'), (FAR, 'E2')):
        axes.axhline(value, color=OTHER, linestyle='--', linewidth=1)
        axes.annotate(
            f'{name} {value} m',
            (x, value),
            xytext=(0, 3),
            ha=side,
            textcoords='offset points',
            fontsize=8,
            color=OTHER,
        )
    axes.grid(color='0.92')
