"""Search the best settings of an IMM, and say what they gain over the shipped ones.

The search draws the tracks that the weights of `gwnn` are trained on, with a seed apart, and
minimises the position error one scan ahead; the figures are also given on fresh tracks that the
search did not see. Some minutes of one processor.
"""


from ..estimators import bank
from ..evaluation import imm_tuning, report
from ..heap import keep_freed_memory
from ..parameters import VESSEL_CLASSES
from .progress_bar import progress_bar

HELP = 'search the best settings of an IMM'
EVALUATIONS, TRACKS = 600, 280
FRESH = 10                      # times the tracks of the search
CLEAR = 0.995                   # ratio of errors that settings better than the shipped ones have


def add_arguments(parser) -> None:
    """The command line of `tune`."""
    names = parser.add_subparsers(title='estimators', metavar='NAME', required=True)
    sub = names.add_parser('imm', help='the four-mode IMM that `gwnn` is compared with',
                           description=__doc__)
    sub.add_argument('--for', dest='target', choices=list(imm_tuning.STRAIGHT_WEIGHT),
                     default='training', help='what it is to be best at: every kind of motion and '
                     'phase alike, or manoeuvres only (default %(default)s)')
    sub.add_argument('--vessel-class', choices=VESSEL_CLASSES, default='ship',
                     help='whose motion (default %(default)s)')
    sub.add_argument('--evaluations', type=int, default=EVALUATIONS, metavar='N',
                     help='settings to try (default %(default)s)')
    sub.add_argument('--tracks', type=int, default=TRACKS, metavar='N',
                     help='tracks to try each on (default %(default)s); '
                     f'{FRESH} times as many fresh ones are judged on')
    sub.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
    report.add_arguments(sub)


def run(args) -> int:
    """Print the settings found and how they and the shipped ones do."""
    for name, least in (('evaluations', 1), ('tracks', imm_tuning.LEAST_TRACKS), ('seed', 0)):
        if getattr(args, name) < least:
            raise ValueError(f'--{name} is {getattr(args, name)}; it must be at least {least}')
    keep_freed_memory()
    shipped = {f'shipped for {target}': modes
               for target, modes in bank.STRONGEST[args.vessel_class].items()}
    rival = f'shipped for {args.target}'
    with progress_bar('trying settings') as show:
        found, seen = imm_tuning.tune(args.target, args.tracks, args.evaluations, args.seed,
                                      show, args.vessel_class)
    fresh = imm_tuning.fresh(FRESH * args.tracks, args.seed, args.vessel_class)
    verdict = imm_tuning.judge(found.modes, shipped, rival, args.target, seen, fresh, args.seed)
    settings = imm_tuning.as_text(found.modes)
    better = verdict.ratio.high < 1 and verdict.ratio.value < CLEAR
    claim = report.Claim(
        rival, 'tuned as well as can be', settings,
        'NO: on fresh tracks the settings found are clearly better; use them' if better
        else 'nothing clearly better was found')
    return report.publish(
        f'IMM of {args.vessel_class} for {args.target}: {args.evaluations} evaluations on '
        f'{len(seen.kind)} tracks, seed {args.seed}', verdict.figures, args.json,
        {'vessel_class': args.vessel_class, 'target': args.target,
         'evaluations': args.evaluations, 'tracks': len(seen.kind), 'seed': args.seed,
         'settings': found.modes._asdict(), 'best': found.best}, [claim])
