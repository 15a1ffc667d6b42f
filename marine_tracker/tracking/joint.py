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
from ..types import Array, Extrapolation, IntArray, Plots, Tracks, take
from . import unresolved
from .equivalent_plot import equivalents
from .expected import Expected
from .gate import Pairs
from .lifecycle import TENTATIVE
from .marginals import marginals
from .meetings import NOTHING, Contested
from .surroundings import Evidence

NOBODY = np.zeros(0, np.int64)


class Taken(NamedTuple):
    """What the tracks of this scan are updated with.

    plots    K + U plots
    rows     [K + U]  of the tracks that take them
    sharing  [U]      the last of them: tracks that share another's plot
    plot_of  [N]      the plot that each track took alone, or whose owner it is; -1 for none
    contested         what confirmed tracks contest; nothing where that is not looked at
    """

    plots: Plots
    rows: IntArray
    sharing: IntArray
    plot_of: IntArray
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
    joint = radar.association == 'joint'
    contested = _contested(pairs, tracks, len(plots.time)) if joint else NOBODY
    if not len(contested):
        rows = (plot_of >= 0).nonzero()[0]
        return Taken(take(plots, plot_of[rows]), rows, NOBODY, plot_of, NOTHING)
    at = expected.origin
    both = unresolved.shared(pairs, evidence, plot_of, tracks, ahead, at, plots, radar)
    plot_of = plot_of.copy()
    plot_of[both.track] = -1
    rows = (plot_of >= 0).nonzero()[0]
    some = take(pairs, contested)
    chance = _chances(some, evidence.likelihood[contested], evidence, tracks, plots, radar)
    given = chance / np.maximum(np.bincount(some.track, chance, len(plot_of))[some.track], 1e-300)
    chosen = equivalents(some, given, plot_of, rows, take(plots, plot_of[rows]), ahead, plots)
    if len(both.track):
        chosen = unresolved.split(both, rows, chosen, ahead, plots)
    rows, doubtful = np.append(rows, both.track), Contested(some.track, some.plot, chance)
    return Taken(chosen, rows, both.track, plot_of, doubtful)


def _chances(
    pairs: Pairs,
    likelihood: Array,
    evidence: Evidence,
    tracks: Tracks,
    plots: Plots,
    radar: TrackerParameters,
) -> Array:
    """Probability [P] that the plot of each pair is the track's."""
    count = len(evidence.detected)
    here = tracks.existence[:count] * evidence.detected
    odds = here / (1 - here * radar.gate_probability)
    weight = odds[pairs.track] * likelihood
    return marginals(pairs.track, pairs.plot, weight, count, len(plots.time))


def _contested(pairs: Pairs, tracks: Tracks, plots: int) -> IntArray:
    """The pairs of confirmed targets with plots that more than one of them may own."""
    held = tracks.status[pairs.track] != TENTATIVE
    wanted = np.bincount(pairs.plot, held, plots)
    found: IntArray = (held & (wanted[pairs.plot] > 1)).nonzero()[0]
    return found
