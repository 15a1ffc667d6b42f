"""Run an experiment again and print its figures beside what is claimed for them."""

import sys
from pathlib import Path

from ..evaluation import report
from ..evaluation.experiments import EXPERIMENTS

HELP = 'reproduce published figures'


def add_arguments(parser) -> None:
    """The command line of `experiments`."""
    names = parser.add_subparsers(title='experiments', metavar='NAME', required=True)
    for name, experiment in EXPERIMENTS.items():
        sub = names.add_parser(name, help=experiment.HELP, description=experiment.__doc__)
        sub.add_argument('--runs', type=int, default=experiment.RUNS, metavar='N',
                         help=f'Monte Carlo runs (default {experiment.RUNS})')
        sub.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
        if hasattr(experiment, 'pictures'):
            sub.add_argument('--out', metavar='FOLDER',
                             help='also draw pictures into this folder (needs matplotlib)')
        if hasattr(experiment, 'DATA'):
            sub.add_argument('--data', metavar='FOLDER', help=experiment.DATA)
        report.add_arguments(sub)
        sub.set_defaults(experiment=name)


def run(args) -> int:
    """Print the table; 1 where a figure misses its limit."""
    if args.runs < 1:
        raise ValueError(f'--runs is {args.runs}; it must be at least 1')
    experiment = EXPERIMENTS[args.experiment]
    data = {'data': Path(args.data)} if getattr(args, 'data', None) else {}
    figures = experiment.run(args.runs, args.seed, **data)
    claims = experiment.claims(args.runs, args.seed) if hasattr(experiment, 'claims') else ()
    if getattr(args, 'out', None):
        for file in experiment.pictures(args.out, args.runs, args.seed):
            print(f'drawn: {file}', file=sys.stderr)
    title = f'{args.experiment}: {args.runs} runs, seed {args.seed}'
    return report.publish(title, figures, args.json, {
        'experiment': args.experiment, 'runs': args.runs, 'seed': args.seed}, claims)
