"""Pictures of the experiment `video`: what was measured, with the curves of theory."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...types import Array


def false_alarms(canvas: Any, found: Sequence[Any]) -> None:
    """Measured over asked for, by octave of range, one panel a rate."""
    rates = sorted({one.rate for one in found}, reverse=True)
    axes = canvas.subplots(1, len(rates), sharey=True)
    for axis, rate in zip(np.atleast_1d(axes), rates):
        axis.set(xlim=(7, 1200), xscale='log', ylim=(0, 3), xlabel='range, samples')
        for one in found:
            if one.rate == rate and np.isfinite(one.ratio).any():
                octave = 2.0 ** (np.arange(len(one.ratio)) + 3)
                axis.plot(octave, one.ratio, 'o-', markersize=4, label=one.kind)
        axis.axhspan(0.5, 2.0, color='0.9')
        axis.axhline(1.0, color='0.4', linewidth=1)
        axis.set_title(f'asked for {rate:.0e}', fontsize=10)
    np.atleast_1d(axes)[0].set_ylabel('false alarms, measured over asked for')
    np.atleast_1d(axes)[0].legend(fontsize=7)


def detection(
    canvas: Any,
    rates: Sequence[float],
    snr: Array,
    curves: Sequence[Array],
    fine: Array,
    theory: Sequence[Array],
) -> None:
    """Share of detected Swerling 1 targets over SNR."""
    axis = canvas.subplots()
    for rate, curve, line, colour in zip(rates, curves, theory, ('C0', 'C1', 'C2')):
        axis.plot(fine, line, color=colour, label=f'theory, {rate:.0e}')
        axis.plot(fine + 1.0, line, ':', color=colour, linewidth=1)
        axis.plot(snr, curve, 'o', color=colour, label=f'measured, {rate:.0e}')
    axis.set(xlabel='mean SNR, dB', ylabel='detected', ylim=(0, 1))
    axis.set_title('Swerling 1, cell averaging; dotted: 1 dB worse', fontsize=10)
    axis.legend(fontsize=8)


def accuracy(
    canvas: Any,
    snr: Sequence[float],
    range_: Sequence[float],
    bearing: Sequence[float],
    bounds: Sequence[tuple[float, float]],
) -> None:
    """Errors of points over SNR with the bound."""
    limits = np.array(bounds)
    for axis, error, bound, name in zip(
        canvas.subplots(1, 2),
        (range_, np.degrees(bearing)),
        (limits[:, 0], np.degrees(limits[:, 1])),
        ('range, m', 'bearing, deg'),
    ):
        axis.plot(snr, bound, label='Cramer-Rao bound')
        axis.plot(snr, 1.3 * bound, ':', color='C0', label='1.3 times it')
        axis.plot(snr, error, 'o', color='C1', label='plots')
        axis.set(yscale='log', xlabel='SNR, dB', ylabel=f'error of {name}')
        axis.legend(fontsize=8)
