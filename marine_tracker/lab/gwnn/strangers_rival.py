"""Searches for the strongest IMM on ships of the independent simulation: `strangers.TUNED`.

The same search as `marine_tracker tune imm`, on other tracks than the comparison has. The network
has no such help: it never sees these ships.
"""

from functools import partial

import numpy as np

from ...evaluation.report import Claim, Figure
from ...evaluation.result import BORNE_OUT, Progress, Result, silent
from ...training import filter_families, filter_tuning, track_trials
from . import strangers
from .trials import FLEETS, trial

HELP = 'search for the strongest IMM on ships that `gwnn` has never seen; N: settings to try'
RUNS = 200
TRACKS = 40  # of each class


def run(runs: int, seed: int, progress: Progress = silent) -> Result:
    """The settings found for all phases, and for manoeuvres only."""
    rng = np.random.default_rng([seed, 13, 13])
    trials = [
        trial('ship', name, TRACKS, FLEETS['ship'].radar, rng, None) for name in strangers.CRAFT
    ]
    figures, claims = [], []
    for i, target in enumerate(filter_tuning.STRAIGHT_WEIGHT):
        found = filter_tuning.search(partial(loss, trials, target), runs, seed)
        progress(i + 1, len(filter_tuning.STRAIGHT_WEIGHT))
        figures.append(Figure(f'{target}: RMS position error', float(np.exp(found.loss)), 'sigma'))
        text = filter_families.as_text(found.settings)
        claims.append(Claim('independent simulation', f'strongest for {target}', text, BORNE_OUT))
    return Result(figures, claims)


def loss(
    trials: list[track_trials.TrackTrial], target: str, settings: filter_families.Settings
) -> float:
    """Mean log RMS over classes and phases that count for the target."""
    levels = []
    for on in trials:
        error = track_trials.run(filter_tuning.filter_of(settings), on, gated=True).position
        for within, weight in ((~on.phase, filter_tuning.STRAIGHT_WEIGHT[target]), (on.phase, 1.0)):
            chosen = on.counts & within
            if weight and chosen.any():
                levels.append(np.log(track_trials.rms(error, chosen)))
    return float(np.mean(levels))
