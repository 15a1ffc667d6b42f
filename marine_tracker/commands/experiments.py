"""Runs an experiment again and prints its figures with their limits and claims."""

import inspect
import sys
from argparse import ArgumentParser, Namespace
from contextlib import ExitStack

from ..evaluation import report
from ..evaluation.result import draw
from ..lab.registry import EXPERIMENTS
from . import worker_options
from .progress_bar import progress_bar

HELP = 'reproduce published figures'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `experiments`."""
    names = parser.add_subparsers(title='experiments', metavar='NAME', required=True)
    for name, experiment in EXPERIMENTS.items():
        sub = names.add_parser(name, help=experiment.HELP, description=experiment.__doc__)
        sub.add_argument(
            '--runs',
            type=int,
            default=experiment.RUNS,
            metavar='N',
            help=f'Monte Carlo runs (default {experiment.RUNS})',
        )
        sub.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
        for option, about in _options(experiment).items():
            sub.add_argument(f'--{option}', **about)
        if _has_parts(experiment):
            worker_options.add_arguments(sub)
        sub.add_argument(
            '--pictures',
            metavar='FOLDER',
            help='also draw its pictures, if it has any, into this folder (needs matplotlib)',
        )
        report.add_arguments(sub)
        sub.set_defaults(experiment=name)


def _options(experiment):
    return getattr(experiment, 'OPTIONS', {})


def _has_parts(experiment):
    return 'workers' in inspect.signature(experiment.run).parameters


def run(args: Namespace) -> int:
    """Prints the table. Returns 1 if a figure misses its limit."""
    if args.runs < 1:
        raise ValueError(f'--runs is {args.runs}; it must be at least 1')
    if args.seed < 0:
        raise ValueError(f'--seed is {args.seed}; it must not be negative')
    experiment = EXPERIMENTS[args.experiment]
    options = {name: getattr(args, name) for name in _options(experiment)}
    with ExitStack() as stack:
        if _has_parts(experiment):
            options['workers'] = stack.enter_context(worker_options.workers(args))
        progress = stack.enter_context(progress_bar(args.experiment))
        found = experiment.run(args.runs, args.seed, progress=progress, **options)
    if args.pictures:
        for file in draw(args.pictures, found.pictures):
            print(f'drawn: {file}', file=sys.stderr)
    title = f'{args.experiment}: {args.runs} runs, seed {args.seed}'
    return report.publish(
        title,
        found.figures,
        args.json,
        {'experiment': args.experiment, 'runs': args.runs, 'seed': args.seed},
        found.claims,
    )
