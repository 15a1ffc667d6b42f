"""The wavelet network: the figures of its own paper, and how the estimator compares with others.

The first part is `gwnn_paper`: Figs 1 to 5 and eq 20-23 of paper 000, with at most 40 seeds. The
second part is `monte_carlo`: the estimator `gwnn` compared with CS-Kalman, CV, IMMs and plain tanh
units, on ships and small craft. 300 runs of both take about three minutes on two processors.
"""

from pathlib import Path

from ...evaluation.parallel import Workers
from ...evaluation.result import Progress, Result, silent
from ..gwnn_paper import gwnn_paper
from . import monte_carlo

HELP = "both below: the paper's figures, then the comparison"
RUNS = monte_carlo.RUNS
OPTIONS = monte_carlo.OPTIONS


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    data: Path | None = None,
    workers: Workers = None,
) -> Result:
    """Figures, claims and pictures of both parts."""
    parts = (
        gwnn_paper.run(min(runs, gwnn_paper.RUNS), seed, progress),
        monte_carlo.run(runs, seed, progress, data, workers),
    )
    return Result(
        [figure for part in parts for figure in part.figures],
        [claim for part in parts for claim in part.claims],
        [picture for part in parts for picture in part.pictures],
    )
