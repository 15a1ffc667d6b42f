"""Tracks a recording or a scenario in process, faster than real time, into a track file."""

import contextlib
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterable, Iterator

from ..estimators import WANT_DOPPLER
from ..evaluation.replay import fuse, write_tracks
from ..files import written
from ..processes import keep_freed_memory
from ..service import Service
from ..tracking import offsets
from ..types import Scan
from . import tracker_options

HELP = 'track a recording or a scenario into a CSV file, without ROS'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `replay`."""
    parser.add_argument(
        'source',
        metavar='SOURCE',
        nargs='+',
        help='folder of a recording, file of spokes (.npz), name of a shipped scenario, or '
        'scenario file; '
        'several of one scene, each by a radar of its own, are fused',
    )
    parser.add_argument(
        '--out',
        metavar='TRACKS.csv',
        required=True,
        help='track file to write: one row a track and scan; - for standard output',
    )
    parser.add_argument(
        '--alarms', metavar='ALARMS.csv', help='file to write: one row for each change of an alarm'
    )
    parser.add_argument('--seed', type=int, default=1, help='seed of a scenario (default: 1)')
    tracker_options.add_arguments(parser)
    tracker_options.add_video_arguments(parser)


def run(args: Namespace) -> int:
    """Writes the track file and prints one line about what was tracked."""
    if args.seed < 0:
        raise ValueError(f'--seed is {args.seed}; it must not be negative')
    keep_freed_memory()
    source = fuse(args.source, args.seed, tracker_options.video(args))
    for remark in source.remarks:
        print(remark, file=sys.stderr)
    parameters = tracker_options.parameters(args, source.tracker_parameters)
    scans = _with_progress(source.scans, source.total)
    with contextlib.ExitStack() as stack:
        file = sys.stdout
        if args.out != '-':
            file = stack.enter_context(written(args.out, newline=''))
        alarm_file = None
        if args.alarms:
            alarm_file = stack.enter_context(written(args.alarms, newline=''))
        summary = write_tracks(Service(parameters), scans, file, alarm_file)
    for remark in source.told():
        print(remark, file=sys.stderr)
    left_out = f', {summary.left_out} pairs left out' if summary.left_out else ''
    at_rest = f', {summary.stationary} stationary objects' if summary.stationary else ''
    print(
        f'{summary.scans} scans, {summary.confirmed} tracks confirmed, '
        f'{summary.moving} of them moving{at_rest}, {summary.cpu_ms:.2f} ms CPU a scan{left_out}',
        file=sys.stderr if args.out == '-' else sys.stdout,
    )
    for place, found in enumerate(summary.offsets, 1):
        if set(found.values()) != {offsets.NOT_KNOWN}:
            radar = f'radar {place}' if len(summary.offsets) > 1 else 'radar'
            told = ', '.join(f'{name} {value}' for name, value in found.items())
            print(f'{radar}: {told}', file=sys.stderr if args.out == '-' else sys.stdout)
    if parameters.estimator in WANT_DOPPLER and not summary.doppler:
        print(
            f'warning: the plots tell no radial speeds, which {parameters.estimator} wants',
            file=sys.stderr,
        )
    return 0


def _with_progress(
    scans: Iterable[tuple[int, Scan]], total: int | None
) -> Iterator[tuple[int, Scan]]:
    """The same scans, with a progress bar if the output is a terminal."""
    if not sys.stderr.isatty():
        yield from scans
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(scans, 'tracking', total=total, console=Console(stderr=True), transient=True)
