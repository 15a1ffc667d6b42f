"""Outlines as the filters see them, with error bars: Figs 4 and 5 of paper 004, redrawn."""

from functools import partial
from typing import Any

import numpy as np

from ...evaluation.result import Picture
from ...extent.input_noise import VARIANTS
from ...geometry import unit_vector
from .figures import CASES, DENSE, SPARSE, Findings
from .trials import PRIOR, RANDOM_MATRIX, SHAPES, START

ESTIMATE, TRUTH, MISSED = '#0072b2', '0.25', '#d55e00'
SHOWN = ('gp', 'gp_ts', 'gp_mc', 'gp_q15', RANDOM_MATRIX)
NAMES = {
    'gp': 'GP',
    'gp_ts': 'GP-TS',
    'gp_ss': 'GP-SS',
    'gp_mc': 'GP-MC',
    'gp_q15': 'GP-Q15',
    RANDOM_MATRIX: 'random matrix',
}
REACH = 9.0  # m from the centre, half the width of the picture


def pictures(found: Findings) -> list[Picture]:
    """Outlines, and error bars of few and of many points."""
    return [
        Picture('extended_outlines', (12.5, 10.6), partial(outlines, found=found)),
        *(
            Picture(
                f'extended_error_bars_{name}',
                (12.5, 3.4),
                partial(error_bars, found=found, case=case),
            )
            for name, case in (('sparse', SPARSE), ('dense', DENSE))
        ),
    ]


def outlines(figure: Any, found: Findings) -> None:
    """The first run of each case and filter after 100 s, with bands of 3 deviations."""
    figure.suptitle(
        'Outlines after 100 s, the first run of each: truth dashed, estimates with '
        'bands of 3 deviations'
    )
    axes = figure.subplots(len(CASES), len(SHOWN), sharex=True, sharey=True)
    angle = np.linspace(0, 2 * np.pi, 361)
    for row, (case, what) in zip(axes, CASES.items()):
        truth = SHAPES[what.shape](angle)[:, None] * unit_vector(angle + START[4])
        for ax, name in zip(row, SHOWN):
            drawn = found[case, name].drawn
            if drawn.outer.size:
                band = np.concatenate([_closed(drawn.outer), _closed(drawn.inner)[::-1]])
                ax.fill(*band.T, color=ESTIMATE, alpha=0.2, linewidth=0)
            ax.plot(*_closed(drawn.outline).T, color=ESTIMATE, linewidth=1.6)
            ax.plot(*truth.T, '--', color=TRUTH, linewidth=1.2)
            ax.set(aspect='equal', xlim=(-REACH, REACH), ylim=(-REACH, REACH))
            ax.grid(color='0.93')
        row[0].set_ylabel(f'{case}\nnorth, m')
    for ax, name in zip(axes[0], SHOWN):
        ax.set_title(NAMES[name])
    for ax in axes[-1]:
        ax.set_xlabel('east, m')


def error_bars(figure: Any, found: Findings, case: str) -> None:
    """Errors of the radii of the first run, with 3 deviations; larger errors are highlighted."""
    figure.suptitle(f'Errors of the radius with 3 deviations, the first run after 100 s: {case}')
    angle = np.degrees(PRIOR.angle)
    for ax, name in zip(figure.subplots(1, len(VARIANTS), sharey=True), VARIANTS):
        drawn = found[case, name].drawn
        beyond = np.abs(drawn.error) > 3 * drawn.deviation
        for those, colour in ((~beyond, ESTIMATE), (beyond, MISSED)):
            ax.errorbar(
                angle[those],
                drawn.error[those],
                3 * drawn.deviation[those],
                fmt='o',
                markersize=3,
                color=colour,
                elinewidth=1,
            )
        ax.axhline(0, color=TRUTH, linewidth=1)
        ax.set(xlabel='angle off the bow, deg', xlim=(-10, 360), xticks=(0, 90, 180, 270))
        ax.set_title(f'{NAMES[name]}: {beyond.sum()} of {len(angle)} beyond', fontsize=10)
        ax.grid(color='0.93')
    figure.axes[0].set_ylabel('radius off the truth, m')


def _closed(points):
    return np.concatenate([points, points[:1]])
