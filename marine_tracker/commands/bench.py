"""Measures the cost of a scan, compared with `cs_kalman` and with Stone Soup on the same plots.

This tracker does whole steps, from extrapolation to the initiation of new tracks. Stone Soup does
association and update only (EKF, its tracks given): by DetectionKDTreeGNN2D with five neighbours,
and by its JPDA with EHM2 over the same tree, each where it finishes. CPU time, one process, the
same run: the ratio holds on any machine, the times do not. Stone Soup is measured if it is
installed (extra `bench`). The estimator's own part of the step is shown too. `--estimator all`
measures every estimator. The memory is that of the whole process, with the traffic and Stone Soup.

`--display` measures the picture instead: frames a second in a headless browser, processor time of
the display node, load time of the page, bytes to a viewer; 200 targets, 1,000 plots in a scan.

`--sectors` measures how soon after the beam a track comes over DDS, from a radar that sends 16
sectors a revolution, in real time.
"""

from argparse import ArgumentParser, Namespace

from ..estimators import ESTIMATORS
from ..evaluation import benchmark, report, video_benchmark
from ..processes import keep_freed_memory, peak_memory_mb
from . import bench_display, bench_sectors

HELP = 'measure the cost of a scan, compared with Stone Soup'
PLAIN, ALL = 'cs_kalman', 'all'
# Required ratios with cs_kalman, by number of targets.
DEMANDED = {200: 300.0, 1000: 400.0}
MOST_TARGETS = 1000  # the two limits below hold up to this number
MOST_ESTIMATOR_MS = 40.0  # for extrapolation and update by any estimator
MOST_RATIO = 10.0  # ratio of a scan's cost to that with cs_kalman
MOST_VIDEO_MS = 100.0  # CPU time of a revolution of radar video
MOST_LATENCY = 0.125  # of a revolution, from the beam to the plot
MANY_TARGETS = 50000  # the two limits below hold for this number
MOST_SCAN_MS, MOST_MB = 1000.0, 1000.0  # CPU time of a scan; memory of the process


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `bench`."""
    parser.add_argument(
        '--tracks',
        type=int,
        default=200,
        metavar='N',
        help='targets, each with a track (default 200)',
    )
    parser.add_argument(
        '--clutter', type=int, default=50, metavar='N', help='false plots a scan (default 50)'
    )
    parser.add_argument(
        '--estimator',
        choices=[*sorted(ESTIMATORS), ALL],
        default=PLAIN,
        help=f'filter of this tracker, or all of them (default {PLAIN})',
    )
    parser.add_argument(
        '--scans', type=int, default=10, metavar='N', help='scans measured (default 10)'
    )
    parser.add_argument(
        '--video',
        action='store_true',
        help='instead: plots out of radar video, 2,048 spokes of 1,024 samples a revolution',
    )
    parser.add_argument('--alone', action='store_true', help='leave Stone Soup out')
    parser.add_argument(
        '--sectors', action='store_true', help='instead: from the beam to the track, over DDS'
    )
    parser.add_argument(
        '--display', action='store_true', help='instead: the picture; takes two minutes'
    )
    parser.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
    report.add_arguments(parser)


def run(args: Namespace) -> int:
    """Prints the table. Returns 1 if a ratio misses its limit."""
    if args.display:
        title = f'picture of {bench_display.SHIPS} ships, seed {args.seed}'
        return report.publish(
            title, bench_display.figures(args.seed), args.json, {'seed': args.seed}
        )
    for name, least in (('tracks', 1), ('clutter', 0), ('scans', 1)):
        if getattr(args, name) < least:
            raise ValueError(f'--{name} is {getattr(args, name)}; it must be at least {least}')
    if args.sectors:
        title = f'{bench_sectors.SECTORS} sectors a revolution, {args.scans} revolutions'
        figures = bench_sectors.figures(args.scans, args.seed)
        return report.publish(title, figures, args.json, {'scans': args.scans, 'seed': args.seed})
    keep_freed_memory()
    if args.video:
        return _video(args)
    names = list(ESTIMATORS) if args.estimator == ALL else [args.estimator]
    results = benchmark.benchmark(
        args.tracks,
        args.clutter,
        list(dict.fromkeys([PLAIN, *names])),
        args.scans,
        args.seed,
        args.alone,
    )
    peers = {
        name: results.pop(name)
        for name in (benchmark.STONE_SOUP, benchmark.JPDA)
        if name in results
    }
    figures = [figure for name in results for figure in _figures(name, results, args.tracks)]
    many = args.tracks == MANY_TARGETS
    figures.append(_bounded('greatest memory', peak_memory_mb(), MOST_MB, many, 'MB'))
    for peer, theirs in peers.items():
        figures += [
            report.Figure(f'{peer}: CPU time of a scan', 1e3 * theirs.cpu_s, 'ms'),
            *_found(peer, theirs),
        ]
        figures += [
            _over_peer(name, peer, theirs.cpu_s / ours.cpu_s, args)
            for name, ours in results.items()
        ]
    title = (
        f'{args.tracks} targets, {args.clutter} false plots a scan, {args.estimator}, '
        f'{args.scans} scans, seed {args.seed}'
    )
    return report.publish(
        title,
        figures,
        args.json,
        {
            'tracks': args.tracks,
            'clutter': args.clutter,
            'estimator': args.estimator,
            'scans': args.scans,
            'seed': args.seed,
        },
    )


def _video(args: Namespace) -> int:
    """The cost of a revolution of radar video."""
    found = video_benchmark.benchmark(args.scans, args.seed)
    figures = [
        report.at_most('video: CPU time of a revolution', 1e3 * found.cpu_s, MOST_VIDEO_MS, 'ms'),
        report.at_most(
            'video: from beam to plot, 99 %', found.latency, MOST_LATENCY, 'revolutions'
        ),
        report.Figure('video: plots a revolution', found.plots, ''),
        report.Figure('greatest memory', peak_memory_mb(), 'MB'),
    ]
    title = f'radar video, {args.scans} revolutions, seed {args.seed}'
    return report.publish(title, figures, args.json, {'scans': args.scans, 'seed': args.seed})


def _figures(name: str, results: dict[str, benchmark.Result], targets: int):
    """Figures of this tracker with one estimator."""
    result, plain = results[name], results[PLAIN]
    bound = targets == MOST_TARGETS
    figures = [
        _bounded(
            f'{name}: CPU time of a scan',
            1e3 * result.cpu_s,
            MOST_SCAN_MS,
            targets == MANY_TARGETS,
            'ms',
        ),
        _bounded(
            f'{name}: of that, extrapolation and update',
            1e3 * result.estimator_s,
            MOST_ESTIMATOR_MS,
            bound,
            'ms',
        ),
    ]
    if name != PLAIN:
        figures.append(
            _bounded(
                f'{name}: ratio of a scan', result.cpu_s / plain.cpu_s, MOST_RATIO, bound, '', PLAIN
            )
        )
    return [*figures, *_found(name, result)]


def _bounded(name, value, limit, bound, unit, against=None):
    return (
        report.at_most(name, value, limit, unit, against)
        if bound
        else report.Figure(name, value, unit, None, None, against)
    )


def _found(name: str, result: benchmark.Result):
    return [
        report.Figure(f'{name}: targets kept', 100 * result.kept, '%'),
        report.Figure(f'{name}: position RMSE', result.rmse, 'm'),
    ]


def _over_peer(name: str, peer: str, ratio: float, args: Namespace) -> report.Figure:
    demanded = DEMANDED.get(args.tracks) if name == PLAIN and args.clutter == 50 else None
    title = f'{name}: times less than {peer}'
    if demanded is None or peer != benchmark.STONE_SOUP:
        return report.Figure(title, ratio, '', None, None, peer)
    return report.at_least(title, ratio, demanded, '', peer)
