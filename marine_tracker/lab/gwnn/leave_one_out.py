"""Networks of `gwnn` trained in other ways: without a kind of motion, without legs, of plain units.

Each learns from a third of the tracks, in a sixth of the steps of the shipped one, and is judged on
fresh tracks. A network trained on everything, for as long, stands beside them: what differs is what
was left out. A kind left out in turn tells how `gwnn` does on motion that it has never seen.
"""

from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from ...estimators.gwnn import gwnn, inputs
from ...evaluation import parallel
from ...evaluation.parallel import Job, Workers
from ...evaluation.report import Figure, at_most
from ...evaluation.result import Progress, Result, silent
from ...networks.gwnn_weights import Weights
from ...networks.wavelet_network import TANH
from ...training import gwnn_fusion, gwnn_samples, gwnn_training
from ...types import take
from .figures import WHAT, geometric_mean, interval
from .trials import FLEETS, OWN, Cell, cells

HELP = '`gwnn` trained without each kind of motion in turn, without legs, of plain units: long'
RUNS = 150
CHUNKS, STEPS = 16, 4000  # of each training
WHOLE, NO_LEGS, PLAIN = 'trained on everything', 'no legs', 'tanh units'
LIMIT = {'position': 0.95, 'velocity': 0.94}  # of the geometric means over the kinds left out
CLASS = 'ship'

Found = dict[tuple[str, str], list[Cell]]


def run(runs: int, seed: int, progress: Progress = silent, workers: Workers = None) -> Result:
    """The ratios to the tuned IMM by kind of motion, for each way of training."""
    names = gwnn_training.plan(CLASS, seed).waters.names
    jobs = {
        way: Job(measure, (seed, way, [way] if way in names else names, runs))
        for way in (WHOLE, NO_LEGS, PLAIN, *names)
    }
    results = parallel.run(list(jobs.values()), workers, progress)
    found = {
        (way, kind): cells for way, by_kind in zip(jobs, results) for kind, cells in by_kind.items()
    }
    return Result(list(figures(found, names)))


def measure(seed: int, way: str, kinds: list[str], runs: int) -> dict[str, list[Cell]]:
    """The cells of these kinds of motion, with a network trained in a way."""
    weights, every = train(seed, way), gwnn_training.plan(CLASS, seed).waters.names
    return {
        kind: cells(
            CLASS,
            kind,
            runs,
            FLEETS[CLASS].radar,
            seed + 1000 * (1 + every.index(kind)),
            None,
            weights,
        )
        for kind in kinds
    }


def train(seed: int, way: str) -> Weights:
    """A short training: WHOLE, NO_LEGS, PLAIN, or without the kind of that name."""
    samples, names = _samples(seed), gwnn_training.plan(CLASS, seed).waters.names
    layout = gwnn_fusion.LAYOUT
    if way == PLAIN:
        layout = layout._replace(units=TANH)
    elif way == NO_LEGS:
        samples = samples._replace(seen=np.where(inputs.OF_LEGS, np.float32(0), samples.seen))
    elif way != WHOLE:
        kind = gwnn_samples.cell_of(samples.cell).kind
        samples = take(samples, np.flatnonzero(kind != names.index(way)))
    training = gwnn_fusion.begin(samples, len(names), seed, layout, way != NO_LEGS)
    network = gwnn_fusion.train(training, samples, seed, STEPS, STEPS).network
    if way == NO_LEGS:
        network.inner[:-1][inputs.OF_LEGS] = 0.0
    return gwnn.weights(vessel_class=CLASS)._replace(fusion=network)


@lru_cache(1)
def _samples(seed: int) -> gwnn_samples.Samples:
    """What all of them learn from."""
    plan = gwnn_training.plan(CLASS, seed)
    return gwnn_samples.join(
        [gwnn_samples.make(plan.bank, plan.waters, seed, chunk) for chunk in range(CHUNKS)]
    )


def figures(found: Found, names: list[str]) -> Iterator[Figure]:
    """Figures of all cells left out, and geometric means; cells by way of training and kind."""
    for what in WHAT:
        for kind in names:
            for one, other in zip(found[kind, kind], found[WHOLE, kind]):
                ratio, whole = (getattr(cell, what)[OWN] for cell in (one, other))
                told = f'{interval(ratio)}; {WHOLE} {whole.value:.3f}'
                name = f'{kind} left out, {one.phase}: {what} ratio'
                yield Figure(name, ratio.value, '', None, None, told)
        for way in ('left out', WHOLE, NO_LEGS, PLAIN):
            mean = geometric_mean(
                [
                    getattr(cell, what)[OWN]
                    for kind in names
                    for cell in found[kind if way == 'left out' else way, kind]
                ]
            )
            name, told = f'{what} ratio, geometric mean: {way}', interval(mean)
            if way == 'left out':
                yield at_most(name, mean.value, LIMIT[what], '', told)
            else:
                yield Figure(name, mean.value, '', None, None, told)
