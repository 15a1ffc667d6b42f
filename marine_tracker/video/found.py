"""What comes out of the extraction."""

from typing import NamedTuple

import numpy as np

from ..types import Array, IntArray, PolarPlots, append, take

LAND, LONE = 'echoes too long for a ship', 'samples of interference'
LOBE = 'side lobes of strong echoes'
NO_BEARING = 'spokes without a bearing'


class Details(NamedTuple):
    """Of the M plots.

    extent   [M, 2]  m along and across the line of sight, without pulse and beam
    cells    [M]     cells over the threshold
    doppler  [M]     share of the cells that recede less that of those that approach; 0: not told
    """

    extent: Array
    cells: IntArray
    doppler: Array


class Found(NamedTuple):
    """What a sector came to.

    plots    M plots in time order, with covariance; amplitude is dB over the local noise
    details  of the M plots
    counts   what was left out, by reason
    until    s and rad: the beam's place up to which all plots have come out; nan: none yet
    """

    plots: PolarPlots
    details: Details
    counts: dict[str, int]
    until: tuple[float, float]


def nothing() -> Found:
    """No plots."""
    none = np.empty(0)
    return Found(
        PolarPlots(none, none, none, none, covariance=np.empty((0, 2, 2))),
        Details(np.empty((0, 2)), np.empty(0, np.int64), none),
        {},
        (np.nan, np.nan),
    )


def together(parts: list[Found]) -> Found:
    """The parts as one, in time order."""
    plots, details, counts, until = nothing()
    for part in parts:
        plots, details = append(plots, part.plots), append(details, part.details)
        for reason, count in part.counts.items():
            counts[reason] = counts.get(reason, 0) + count
        if np.isfinite(part.until[0]):
            until = part.until
    order = np.argsort(plots.time, kind='stable')
    return Found(take(plots, order), take(details, order), counts, until)
