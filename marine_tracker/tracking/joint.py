"""The plots that tracks take: each its own, or what joint association makes of contested ones.

Where tracks of confirmed targets contest plots, the association that is best may be wrong, and a
wrong one lets targets swap. There each track takes an equivalent of all plots it may own, by their
probabilities over all joint associations (JPDA). Only contested plots are shared out so: plots that
nobody else wants, clutter among them, are decided by the best association alone. A soft update by
them makes a track less sure, and in clutter a track that is less sure finds more clutter.

Two targets in one cell of the radar share its one plot (unresolved.py).
"""

from typing import NamedTuple

import numpy as np

from ..parameters import TrackerParameters
from ..types import Extrapolation, IntArray, Plots, Tracks, take
from . import unresolved
from .encounters import NOTHING, Contested
from .equivalent_plot import equivalents
from .expected import Expected
from .gate import Pairs
from .lifecycle import TENTATIVE
from .marginals import marginals
from .surroundings import Evidence


class Taken(NamedTuple):
    """What the tracks of this scan are updated with.

    plots    K + U plots
    rows     [K + U]  of the tracks that take them
    sharing  [U]      the last of them: tracks that share another's plot
    contested         what confirmed tracks contest; nothing where that is not looked at
    """

    plots: Plots
    rows: IntArray
    sharing: IntArray
    contested: Contested


def take_plots(
    pairs: Pairs,
    evidence: Evidence,
    plot_of: IntArray,
    tracks: Tracks,
    ahead: Extrapolation,
    expected: Expected,
    plots: Plots,
    radar: TrackerParameters,
) -> Taken:
    """The plots for the tracks that took one, and for those that share one.

    plot_of [N]: the plot that each track took, -1 for none; the last tracks may be new, and `ahead`
    lacks them
    """
    rows = (plot_of >= 0).nonzero()[0]
    chosen = take(plots, plot_of[rows])
    if radar.association == 'nearest' or not len(pairs.track):
        return Taken(chosen, rows, rows[:0], NOTHING)
    count = len(ahead.time)
    doubtful, contested = NOTHING, _contested(pairs, tracks, len(plots.time))
    if len(contested):
        here = tracks.existence[:count] * evidence.detected
        odds = here / (1 - here * radar.gate_probability)
        some = take(pairs, contested)
        chance = marginals(
            some.track,
            some.plot,
            odds[some.track] * evidence.likelihood[contested],
            count,
            len(plots.time),
        )
        chance /= np.maximum(np.bincount(some.track, chance, count)[some.track], 1e-300)
        doubtful = Contested(some.track, some.plot, chance)
        chosen = equivalents(some, chance, plot_of, rows, chosen, ahead, plots)
    both = unresolved.shared(pairs, plot_of, tracks, ahead, expected.origin, radar)
    if not len(both.track):
        return Taken(chosen, rows, both.track, doubtful)
    chosen = unresolved.split(both, rows, chosen, ahead, plots)
    return Taken(chosen, np.append(rows, both.track), both.track, doubtful)


def _contested(pairs: Pairs, tracks: Tracks, plots: int) -> IntArray:
    """The pairs of confirmed targets with plots that more than one of them may own."""
    held = tracks.status[pairs.track] != TENTATIVE
    wanted = np.bincount(pairs.plot, held, plots)
    found: IntArray = (held & (wanted[pairs.plot] > 1)).nonzero()[0]
    return found
