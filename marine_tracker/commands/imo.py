"""Measures tracker and ARPA under the IMO's test conditions, as a type approval does.

Simulated plots with the sensor errors of resolution A.823(19) go through the whole service with
default settings. The parts:

  accuracy    the four scenarios of A.823 after 1 and 3 minutes, limits of A.823 and MSC.192(79)
  manoeuvres  accuracy after own ship's turns, and how long targets' turns stay wrong
  encounters  Imazu's 22 encounters: acquired, warned of, measured (1 run for each 100)
  loss        targets seen in 5 of 10 scans are kept; targets that vanish are called lost

An error figure is the one that 95 of 100 runs do not exceed. The report compares it with a straight
line fitted to the same plots. A limit that the line does not meet is shown, but not required. A
thousand runs of all parts take about twenty minutes on two processors, longer with more estimators.
"""

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence

import numpy as np

from ..conformance import accuracy, encounters, figures, loss, manoeuvres, page
from ..conformance.accuracy import A823, MINUTES, Outcome, a823_trial
from ..estimators import ESTIMATORS
from ..evaluation import report
from ..evaluation.parallel import Workers
from ..parameters import TrackerParameters
from . import worker_options
from .progress_bar import progress_bar

HELP = 'measure the accuracy under the test conditions of the IMO'
PARTS = ('accuracy', 'manoeuvres', 'encounters', 'loss')
ALL = ('gwnn', 'cs_kalman', 'imm')


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `imo`."""
    parser.add_argument(
        '--runs', type=int, default=1000, metavar='N', help='Monte Carlo runs (default 1000)'
    )
    parser.add_argument(
        '--estimator',
        choices=[*sorted(ESTIMATORS), 'all'],
        default=TrackerParameters().estimator,
        help=f'filter of the tracker, or all of {", ".join(ALL)} on the same plots '
        '(default %(default)s)',
    )
    parser.add_argument(
        '--part',
        choices=PARTS,
        action='append',
        help='run only this part; may be given more than once',
    )
    parser.add_argument(
        '--html',
        metavar='DIR',
        help='also write the report as a page with pictures (needs matplotlib)',
    )
    parser.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
    worker_options.add_arguments(parser)
    report.add_arguments(parser)


def run(args: Namespace) -> int:
    """Prints the figures. Returns 1 if one misses its limit."""
    for name, least in (('runs', 1), ('seed', 0)):
        if getattr(args, name) < least:
            raise ValueError(f'--{name} is {getattr(args, name)}; it must be at least {least}')
    estimators = ALL if args.estimator == 'all' else (args.estimator,)
    parts = [part for part in PARTS if part in (args.part or PARTS)]
    with worker_options.workers(args) as workers:
        results = measure(estimators, parts, args.runs, args.seed, workers)
    title = f'IMO test conditions, {", ".join(estimators)}: {args.runs} runs, seed {args.seed}'
    if args.html:
        written = page.write(args.html, results, title, args.seed)
        print(f'written: {written}', file=sys.stderr)
    return report.publish(
        title,
        figures.figures(results),
        args.json,
        {'estimators': estimators, 'parts': parts, 'runs': args.runs, 'seed': args.seed},
    )


def measure(
    estimators: Sequence[str], parts: Sequence[str], runs: int, seed: int, workers: Workers
) -> figures.Results:
    """Runs the requested parts."""
    found = figures.Results(estimators, {}, {})
    if 'accuracy' in parts:
        keys = [(minutes, number) for minutes in MINUTES for number in A823[minutes]]
        with progress_bar('accuracy') as progress:
            outcomes = accuracy.run(
                [a823_trial(number, 60.0 * minutes) for minutes, number in keys],
                estimators,
                runs,
                seed,
                progress,
                workers,
            )
        found = found._replace(steady=dict(zip(keys, outcomes)))
    if 'manoeuvres' in parts:
        numbers = list(A823[3])
        trials = [trial for number in numbers for trial in manoeuvres.own_turns(number)]
        with progress_bar('own ship turns') as progress:
            outcomes = accuracy.run(trials, estimators, -(-runs // 4), seed + 1, progress, workers)
        with progress_bar('targets turn') as progress:
            turns = manoeuvres.target_turns(estimators, runs, seed, progress, workers)
        found = found._replace(
            turns=turns,
            own_turns={
                number: Outcome(one.truth, np.concatenate([one.found, other.found]))
                for number, one, other in zip(numbers, outcomes[::2], outcomes[1::2])
            },
        )
    if 'encounters' in parts:
        with progress_bar('encounters') as progress:
            found = found._replace(
                encounters=encounters.run(estimators, -(-runs // 100), seed, progress, workers)
            )
    if 'loss' in parts:
        with progress_bar('loss') as progress:
            found = found._replace(kept=loss.run(estimators, runs, seed, progress, workers))
    return found
