"""The wavelet network compared with the filters it fuses: the error one scan ahead.

Ships: 22 rpm, 25 m and 0.4 deg, targets at 1.5 to 18 km. Small craft: 30 rpm, 6 m and 0.7 deg,
0.15 to 4 km. 150 scans, of which the first 20 are left out. Kinds of motion: those that the network
was trained on, on new tracks; and others: ships under autopilot, the sharp turn of paper 000, real
ships by AIS and a real speed boat (from --data), and strangers: ships of an independent simulation.
Errors are RMS per axis, positions in the plots' deviations sigma. Ratios are to the IMM tuned on
the network's own training tracks (for strangers: tuned on those), with 95 % intervals over the
tracks. 300 runs take about five minutes on two processors.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...estimators.gwnn import gwnn
from ...evaluation import parallel
from ...evaluation.parallel import Job, Workers
from ...evaluation.result import Progress, Result, silent
from ...networks import gwnn_weights
from . import failures, figures, pictures
from .claims import claims
from .figures import Findings
from .trials import FLEETS, RECORDED, cells, kinds

HELP = 'GWNN against CS-Kalman, CV and IMMs, on tracks it was trained on and others'
RUNS = 300
OPTIONS = {
    'data': {
        'type': Path,
        'metavar': 'FOLDER',
        'help': 'also judge on real tracks: a folder that '
        'holds ' + ' or '.join(map(str, RECORDED.values())) + ', or both',
    }
}


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    data: Path | None = None,
    workers: Workers = None,
) -> Result:
    """All cells and failures: figures with limits, claims, and the picture."""
    found = measure(runs, seed, progress, data, workers)
    return Result(figures.figures(found), claims(found), pictures.pictures(found))


def measure(
    runs: int, seed: int, progress: Progress, data: Path | None, workers: Workers
) -> Findings:
    """All measurements."""
    if data is not None and not any((data / file).exists() for file in RECORDED.values()):
        raise ValueError(
            f'--data is {data}; it holds neither of ' + ', '.join(map(str, RECORDED.values()))
        )
    weights = {name: gwnn.weights(vessel_class=name) for name in FLEETS}
    # Apart from every seed of a training, whose numbers come in pairs.
    seeds = iter(np.random.SeedSequence([seed, 7, 7]).generate_state(100).tolist())
    planned = {
        of: job for name in FLEETS for of, job in plan(name, runs, data, weights[name], seeds)
    }
    results = dict(zip(planned, parallel.run(list(planned.values()), workers, progress)))

    def those(what):
        return {of[1:]: result for of, result in results.items() if of[0] == what}

    # Timed last, when no other job runs.
    (cost,) = parallel.run([Job(failures.cost, (next(seeds), weights['ship']))], 1, silent)
    return Findings(
        those('fair'), those('hard'), those('sigma'), those('broken'), those('rubbish'), cost
    )


def plan(
    name: str, runs: int, data: Path | None, weights: gwnn_weights.Weights, seeds: Iterator[int]
) -> Iterator[tuple[tuple[str, str, str], Job]]:
    """The measurements of a vessel class, each with its key: field of `Findings`, vessel class,
    kind of motion.
    """
    fleet = FLEETS[name]
    for kind in kinds(name):
        its = next(seeds)  # drawn even if unused: without data the other seeds stay the same
        if kind not in RECORDED or (data is not None and (data / RECORDED[kind]).exists()):
            yield (
                ('fair', name, kind),
                Job(cells, (name, kind, runs, fleet.radar, its, data, weights)),
            )
    for what, kind, radar in figures.conditions(name):
        yield (what, name, kind), Job(cells, (name, kind, runs, radar, next(seeds), data, weights))
    for kind in figures.BROKEN[name]:
        yield (
            ('broken', name, kind),
            Job(failures.scans_to_fallback, (name, kind, runs, next(seeds), weights)),
        )
    yield ('rubbish', name, fleet.usual), Job(failures.rubbish, (name, runs, next(seeds), weights))
