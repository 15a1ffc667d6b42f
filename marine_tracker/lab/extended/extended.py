"""Extended targets: outlines by Gaussian processes with noisy input, compared with a random matrix.

The scenario of paper 004: outlines of three shapes, about 3 to 6 m in size, seen for 100 s as
points with a deviation of 1 m. The mean number of points is 0.8 a frame (very few), or 0.8 a metre
of outline. Then a ship of 200 m whose near side is seen, handed over from a random matrix to a
Gaussian process. 100 runs take about two minutes on two processors.
"""

import numpy as np

from ...evaluation import parallel
from ...evaluation.parallel import Job, Workers
from ...evaluation.result import Progress, Result, silent
from ...extent.input_noise import VARIANTS
from . import figures, handover
from .claims import claims
from .figures import CASES, OTHER_VARIANTS, OTHERWISE, SPARSE
from .handover import ASPECTS
from .pictures import pictures
from .trials import RANDOM_MATRIX, gaussian_process_trial, random_matrix_trial

HELP = 'outlines of extended targets by Gaussian processes and by a random matrix'
RUNS = 100


def run(runs: int, seed: int, progress: Progress = silent, workers: Workers = None) -> Result:
    """Runs all variants in all cases; returns figures, the claims of the paper, and pictures."""
    paper, ship = plan(runs, seed)
    found = dict(
        zip([*paper, *ship], parallel.run([*paper.values(), *ship.values()], workers, progress))
    )
    trials = {of: found[of] for of in paper}
    return Result(
        [
            *figures.figures(trials),
            figures.jacobian(),
            *handover.figures({aspect: found[aspect] for aspect in ship}),
            *figures.costs(),
        ],
        claims(trials),
        pictures(trials),
    )


def plan(runs: int, seed: int) -> tuple[dict[tuple[str, str], Job], dict[int, Job]]:
    """Jobs of the paper's cases by case and filter, and of the ship by aspect.

    Every filter of a case sees the same points.
    """
    seeds = iter(np.random.SeedSequence(seed).generate_state(len(CASES) + len(ASPECTS)).tolist())
    paper: dict[tuple[str, str], Job] = {}
    for case, what in CASES.items():
        its = next(seeds)
        for variant in VARIANTS:
            paper[case, variant] = Job(gaussian_process_trial, (what, variant, runs, its))
        paper[case, RANDOM_MATRIX] = Job(random_matrix_trial, (what, runs, its))
        if case == SPARSE:
            for name, changes in OTHERWISE.items():
                for variant in OTHER_VARIANTS:
                    paper[f'{case}, {name}', variant] = Job(
                        gaussian_process_trial, (what, variant, runs, its, *changes)
                    )
    return paper, {aspect: Job(handover.trial, (aspect, runs, next(seeds))) for aspect in ASPECTS}
