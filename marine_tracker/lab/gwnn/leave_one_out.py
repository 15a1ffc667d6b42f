"""How `gwnn` does on a kind of motion that it was not trained on: each kind left out in turn.

For each kind a network is trained on all others, shorter than the shipped one, and judged on fresh
tracks of that kind only. A network trained on all kinds, for as long, stands beside it.
"""

import tempfile
from collections.abc import Iterator
from pathlib import Path

from ...evaluation import parallel
from ...evaluation.parallel import Job, Workers
from ...evaluation.report import Figure, at_most
from ...evaluation.result import Progress, Result, silent
from ...training import gwnn_training
from .figures import geometric_mean, interval
from .trials import FLEETS, IMM, OWN, Cell, cells

HELP = '`gwnn` on kinds of motion that it was not trained on, each left out in turn: half an hour'
RUNS = 150
CHUNKS, STEPS = 20, 5000  # of each training
WHOLE = 'all kinds'
POSITION, VELOCITY = 0.95, 0.94  # limits of the geometric means
CLASS = 'ship'


def run(runs: int, seed: int, progress: Progress = silent, workers: Workers = None) -> Result:
    """The ratios to the tuned IMM, of the kinds left out and of the same kinds when trained on."""
    names = gwnn_training.plan(CLASS, seed).waters.names
    weights = dict(
        zip(
            [WHOLE, *names],
            parallel.run(
                [Job(train, (seed, without)) for without in [None, *names]], workers, progress
            ),
        )
    )
    seeds = [seed + 1000 * i for i in range(1, 1 + len(names))]
    jobs = [
        Job(cells, (CLASS, kind, runs, FLEETS[CLASS].radar, its, None, {OWN: weights[of]}))
        for kind, its in zip(names, seeds)
        for of in (kind, WHOLE)
    ]
    found = parallel.run(jobs, workers, silent)
    return Result(list(figures(found[::2], found[1::2])))


def train(seed: int, without: str | None):
    """Weights of a short training without a kind of motion."""
    plan = gwnn_training.plan(CLASS, seed, chunks=CHUNKS, steps=STEPS)
    if without is not None:
        plan = plan._replace(waters=plan.waters.without(without))
    with tempfile.TemporaryDirectory() as folder:
        return gwnn_training.run(plan, Path(folder, 'weights.part'))


def figures(left_out: list[list[Cell]], trained_on: list[list[Cell]]) -> Iterator[Figure]:
    """Figures of all cells, and their geometric means with limits."""
    pairs = [pair for ones, others in zip(left_out, trained_on) for pair in zip(ones, others)]
    for what, limit in (('position', POSITION), ('velocity', VELOCITY)):
        for one, other in pairs:
            ratio, whole = (getattr(cell, what)[OWN] for cell in (one, other))
            yield Figure(
                f'{one.kind} left out, {one.phase}: {what} ratio',
                ratio.value,
                '',
                None,
                None,
                f'{interval(ratio)}; {WHOLE} {whole.value:.3f}',
            )
        strange, known = (
            geometric_mean([getattr(pair[i], what)[OWN] for pair in pairs]) for i in (0, 1)
        )
        name = f'{what} ratio, geometric mean'
        yield at_most(f'{name}, kinds left out', strange.value, limit, '', interval(strange))
        yield Figure(f'{name}, {WHOLE}', known.value, '', None, None, interval(known, IMM))
