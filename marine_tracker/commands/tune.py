"""Searches for the best settings of a filter and shows the gain over the shipped ones.

The search simulates tracks as in the training of `gwnn`, with a different seed. It minimises the
position error one scan ahead. The figures are also given for new tracks that the search did not
see. It takes some minutes of one processor.
"""

from argparse import ArgumentParser, Namespace

from ..estimators.gwnn import bank_settings
from ..evaluation import report
from ..parameters import VESSEL_CLASSES
from ..processes import keep_freed_memory
from ..training import filter_families, filter_tuning
from ..training.tuned import TUNED
from .progress_bar import progress_bar

HELP = 'search for the best settings of a filter'
TRACKS = 280
FRESH = 10  # times the number of tracks in the search
# What is tuned, and with how many evaluations by default.
FILTERS = {
    'imm': ('the four-mode IMM that `gwnn` is compared with', 600),
    'cv_cv': ('an IMM of two straight modes', 400),
    'cv': ('one straight mode', 50),
    'cs': ('CS-Kalman', 150),
}
CLEAR = 0.995  # ratio of errors; below it settings are clearly better than the shipped ones


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `tune`."""
    names = parser.add_subparsers(title='estimators', metavar='NAME', required=True)
    for name, (what, evaluations) in FILTERS.items():
        sub = names.add_parser(name, help=what, description=__doc__)
        sub.set_defaults(filter=name)
        _add_arguments(sub, _shipped(name, 'ship'), evaluations)


def _add_arguments(sub, targets, evaluations):
    sub.add_argument(
        '--for',
        dest='target',
        choices=list(targets),
        default='training',
        help='what to optimise: every kind of motion and '
        'phase alike, or manoeuvres only (default %(default)s)',
    )
    sub.add_argument(
        '--vessel-class',
        choices=VESSEL_CLASSES,
        default='ship',
        help='class of the motion (default %(default)s)',
    )
    sub.add_argument(
        '--evaluations',
        type=int,
        default=evaluations,
        metavar='N',
        help='number of settings to try (default %(default)s)',
    )
    sub.add_argument(
        '--tracks',
        type=int,
        default=TRACKS,
        metavar='N',
        help='number of tracks for each (default %(default)s); '
        f'{FRESH} times as many new ones for the final check',
    )
    sub.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
    report.add_arguments(sub)


def _shipped(name: str, vessel_class: str) -> dict[str, filter_families.Settings]:
    """The settings that the comparison uses, by what they are tuned for."""
    if name == 'imm':
        return dict(bank_settings.STRONGEST[vessel_class])
    return {'training': getattr(TUNED[vessel_class], name)}


def run(args: Namespace) -> int:
    """Prints the settings found, with the results of them and of the shipped ones."""
    for name, least in (('evaluations', 1), ('tracks', filter_tuning.LEAST_TRACKS), ('seed', 0)):
        if getattr(args, name) < least:
            raise ValueError(f'--{name} is {getattr(args, name)}; it must be at least {least}')
    keep_freed_memory()
    shipped = {
        f'shipped for {target}': settings
        for target, settings in _shipped(args.filter, args.vessel_class).items()
    }
    rival = f'shipped for {args.target}'
    with progress_bar('trying settings') as show:
        found, seen = filter_tuning.tune(
            args.target,
            args.tracks,
            args.evaluations,
            args.seed,
            show,
            args.vessel_class,
            filter_families.FAMILIES[args.filter],
        )
    fresh = filter_tuning.fresh(FRESH * args.tracks, args.seed, args.vessel_class)
    verdict = filter_tuning.judge(
        found.settings, shipped, rival, args.target, seen, fresh, args.seed
    )
    settings = filter_families.as_text(found.settings)
    better = verdict.ratio.high < 1 and verdict.ratio.value < CLEAR
    claim = report.Claim(
        rival,
        'tuned as well as can be',
        settings,
        'NO: on fresh tracks the settings found are clearly better; use them'
        if better
        else 'nothing clearly better was found',
    )
    return report.publish(
        f'{args.filter} of {args.vessel_class} for {args.target}: {args.evaluations} evaluations '
        f'on {len(seen.kind)} tracks, seed {args.seed}',
        verdict.figures,
        args.json,
        {
            'filter': args.filter,
            'vessel_class': args.vessel_class,
            'target': args.target,
            'evaluations': args.evaluations,
            'tracks': len(seen.kind),
            'seed': args.seed,
            'settings': found.settings._asdict(),
            'best': found.best,
        },
        [claim],
    )
