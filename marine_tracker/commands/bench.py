"""Measure what a scan costs, and how many times Stone Soup's cost on the same plots that is.

Whole steps of this tracker, from extrapolation to the initiation of new tracks, against Stone
Soup's association and update alone (EKF, DetectionKDTreeGNN2D with five neighbours, its tracks
given). CPU time, one process, the same run: the ratio holds on any machine, the times do not.
Stone Soup is measured where it is installed (extra `bench`).
"""

from ..estimators import ESTIMATORS
from ..evaluation import benchmark, report
from ..heap import keep_freed_memory

HELP = 'measure the cost of a scan, beside Stone Soup'
# Ratios to reach with cs_kalman, by number of targets.
DEMANDED = {200: 300.0, 1000: 400.0}


def add_arguments(parser) -> None:
    """The command line of `bench`."""
    parser.add_argument('--tracks', type=int, default=200, metavar='N',
                        help='targets, each with a track (default 200)')
    parser.add_argument('--clutter', type=int, default=50, metavar='N',
                        help='false plots a scan (default 50)')
    parser.add_argument('--estimator', choices=sorted(ESTIMATORS), default='cs_kalman',
                        help='filter of this tracker (default cs_kalman)')
    parser.add_argument('--scans', type=int, default=10, metavar='N',
                        help='scans measured (default 10)')
    parser.add_argument('--alone', action='store_true', help='leave Stone Soup out')
    parser.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
    report.add_arguments(parser)


def run(args) -> int:
    """Print the table; 1 where a ratio misses what is demanded."""
    for name, least in (('tracks', 1), ('clutter', 0), ('scans', 1)):
        if getattr(args, name) < least:
            raise ValueError(f'--{name} is {getattr(args, name)}; it must be at least {least}')
    keep_freed_memory()
    results = benchmark.benchmark(args.tracks, args.clutter, args.estimator, args.scans, args.seed,
                                  args.alone)
    figures = []
    for who, result in results.items():
        figures += [report.Figure(f'{who}: CPU time of a scan', 1e3 * result.cpu_s, 'ms'),
                    report.Figure(f'{who}: targets kept', 100 * result.kept, '%'),
                    report.Figure(f'{who}: position RMSE', result.rmse, 'm')]
    if len(results) > 1:
        ours, theirs = results.values()
        ratio = theirs.cpu_s / ours.cpu_s
        demanded = DEMANDED.get(args.tracks) if (
            args.estimator == 'cs_kalman' and args.clutter == 50) else None
        name, against = 'ratio of the CPU times', 'Stone Soup'
        figures.append(report.Figure(name, ratio, '', None, None, against) if demanded is None
                       else report.at_least(name, ratio, demanded, '', against))
    title = (f'{args.tracks} targets, {args.clutter} false plots a scan, {args.estimator}, '
             f'{args.scans} scans, seed {args.seed}')
    return report.publish(title, figures, args.json, {
        'tracks': args.tracks, 'clutter': args.clutter, 'estimator': args.estimator,
        'scans': args.scans, 'seed': args.seed})
