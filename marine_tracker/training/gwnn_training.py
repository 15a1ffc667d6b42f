"""Trains the weights of `gwnn`: samples, two networks one after the other, and a final check.

A training may be stopped at any time. It continues from its checkpoint.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..estimators.gwnn import bank as filters
from ..estimators.gwnn import inputs
from ..networks import gwnn_weights
from ..networks import wavelet_network as net
from . import gwnn_checkpoint, gwnn_samples, gwnn_spread
from . import gwnn_fusion as fusion
from .training_tracks import WATERS, Waters

CHUNKS, STEPS = 48, 25000  # of the shipped training
UNSEEN = 1 << 16  # number of a chunk that is never trained on
FEW = 100  # a cell with fewer samples is not judged
SAVE_EVERY = 500  # steps

Progress = Callable[[str, int, int], None]


class Plan(NamedTuple):
    """A training and its data.

    vessel_class  the class of the filters
    waters        the tracks and radars
    seed          of all random draws
    chunks        number of chunks of `gwnn_samples.CHUNK` tracks
    steps         of the network that weights the filters; the other takes no more
    layout        of that network
    legs          whether it may use the straight legs; without them, only for comparison
    """

    vessel_class: str
    waters: Waters
    seed: int
    chunks: int = CHUNKS
    steps: int = STEPS
    layout: net.Layout = fusion.LAYOUT
    legs: bool = True

    @property
    def bank(self) -> filters.Filters:
        """The filters."""
        return filters.BANKS[self.vessel_class]


def plan(vessel_class: str, seed: int, **other: Any) -> Plan:
    """The plan of the shipped weights of a vessel class, with changes."""
    return Plan(vessel_class, WATERS[vessel_class], seed)._replace(**other)


def settings(plan: Plan) -> dict[str, Any]:
    """All settings that distinguish two trainings, for a checkpoint."""
    return {
        'vessel_class': plan.vessel_class,
        'filters': plan.bank.mark,
        'seed': plan.seed,
        'chunks': plan.chunks,
        'steps': plan.steps,
        'layout': list(plan.layout),
        'inputs': inputs.COUNT,
        'kinds': plan.waters.names,
        'legs': plan.legs,
        'motion': [*plan.waters.kinds.values(), *plan.waters.steered.values()],
        'radars': plan.waters.radars,
    }


def judge(weights: gwnn_weights.Weights, plan: Plan) -> dict[str, float]:
    """Ratio of the RMS position error to the base IMM's, by kind and phase, on new tracks."""
    samples = gwnn_samples.make(plan.bank, plan.waters, plan.seed, UNSEEN)
    out, _ = fusion.fuse(net.forward(weights.fusion, samples.seen), samples)
    size, against = (
        np.square(error[:, :2]).sum(1) for error in (out - samples.truth, samples.truth)
    )
    cell = gwnn_samples.cell_of(samples.cell)
    ratios = {}
    for i, kind in enumerate(plan.waters.names):
        for phase, name in enumerate(('straight', 'manoeuvre')):
            chosen = (cell.after == 0) & (cell.kind == i) & (cell.phase == phase)
            if chosen.sum() > FEW:
                ratios[f'{kind}, {name}'] = round(
                    float(np.sqrt(size[chosen].mean() / against[chosen].mean())), 3
                )
    return ratios


def run(
    plan: Plan, checkpoint: Path, progress: Progress = lambda stage, done, whole: None
) -> gwnn_weights.Weights:
    """Runs the whole training. Continues from the checkpoint file if there is one.

    Raises ValueError if the checkpoint belongs to another training, or is damaged.
    """
    training = gwnn_checkpoint.resume(checkpoint, settings(plan), plan.layout)
    parts = []
    for chunk in range(plan.chunks):
        progress('tracks', chunk, plan.chunks)
        parts.append(gwnn_samples.make(plan.bank, plan.waters, plan.seed, chunk))
    samples = gwnn_samples.join(parts)
    del parts
    if not plan.legs:
        samples.seen[:, inputs.OF_LEGS] = 0.0
    training = training or fusion.begin(
        samples, len(plan.waters.names), plan.seed, plan.layout, plan.legs
    )
    for step in range(training.moments.steps, plan.steps, SAVE_EVERY):
        progress('fusion', step, plan.steps)
        training = fusion.train(
            training, samples, plan.seed, plan.steps, min(step + SAVE_EVERY, plan.steps)
        )
        gwnn_checkpoint.save(checkpoint, settings(plan), training)
    progress('spread', 0, 1)
    spread = gwnn_spread.train(
        training.network,
        samples,
        plan.seed,
        min(plan.steps, gwnn_spread.STEPS),
        vessel_class=plan.vessel_class,
    )
    if not plan.legs:  # during the training these inputs were 0
        for network in (training.network, spread):
            network.inner[:-1][inputs.OF_LEGS] = 0.0
    weights = gwnn_weights.Weights(
        training.network,
        spread,
        {
            'made_by': 'marine_tracker train gwnn',
            'vessel_class': plan.vessel_class,
            'filters': plan.bank.mark,
            'seed': plan.seed,
            'steps': plan.steps,
            'tracks': plan.chunks * gwnn_samples.CHUNK,
            'samples': len(samples.cell),
            'kinds': plan.waters.names,
            'legs': plan.legs,
            'inputs': inputs.COUNT,
            'hidden': len(training.network.inner.T),
        },
    )
    progress('spread', 1, 1)
    return weights._replace(manifest={**weights.manifest, 'ratios': judge(weights, plan)})
