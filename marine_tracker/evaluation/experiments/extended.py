"""Extended targets: outlines by Gaussian processes with noisy input, beside a random matrix.

The scenario of paper 004: outlines of three shapes, about 3 to 6 m, seen for 100 s as points with a
deviation of 1 m; 0.8 a frame, which is next to nothing, and 0.8 a metre of outline. 100 runs take
some two minutes on two processors.
"""

import os

import numpy as np

from ...extent.input_noise import VARIANTS
from . import extended_figures, jobs
from .extended_claims import claims
from .extended_figures import CASES, OTHER_VARIANTS, OTHERWISE, SPARSE, Findings
from .extended_pictures import pictures
from .extended_trials import RANDOM_MATRIX, gaussian_process_trial, random_matrix_trial
from .jobs import Job
from .result import Progress, Result, silent

HELP = 'outlines of extended targets by Gaussian processes and by a random matrix'
RUNS = 100
OPTIONS = {
    'processes': {'type': int, 'metavar': 'N', 'default': os.cpu_count(),
                  'help': 'how many at once (default %(default)s); no figure depends on it'},
}


def run(runs: int, seed: int, progress: Progress = silent, processes: int | None = None) -> Result:
    """All variants in all cases, the claims of the paper, and the pictures."""
    if processes is not None and processes < 1:
        raise ValueError(f'--processes is {processes}; it must be at least 1')
    found = measure(runs, seed, progress, processes or os.cpu_count() or 1)
    return Result([*extended_figures.figures(found), extended_figures.jacobian(),
                   *extended_figures.costs()], claims(found), pictures(found))


def measure(runs: int, seed: int, progress: Progress, processes: int) -> Findings:
    """Every filter of a case sees the same points."""
    seeds = dict(zip(CASES, np.random.SeedSequence(seed).generate_state(len(CASES)).tolist()))
    planned = {}
    for case, what in CASES.items():
        for variant in VARIANTS:
            planned[case, variant] = Job(gaussian_process_trial,
                                         (what, variant, runs, seeds[case]))
        planned[case, RANDOM_MATRIX] = Job(random_matrix_trial, (what, runs, seeds[case]))
    for name, changes in OTHERWISE.items():
        for variant in OTHER_VARIANTS:
            planned[f'{SPARSE}, {name}', variant] = Job(
                gaussian_process_trial,
                (CASES[SPARSE], variant, runs, seeds[SPARSE], *changes))
    return dict(zip(planned, jobs.run(list(planned.values()), processes, progress)))
