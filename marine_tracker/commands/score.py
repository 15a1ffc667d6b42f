"""Score a track file against the truth of a recording, or track files against AIS reports.

FOLDER is a recording with truth.csv (or what `marine_tracker scenario write` made). TRACKS.csv has
at least the columns time_s, track, status, north_m, east_m, vel_north_mps, vel_east_mps; what
`marine_tracker replay` writes, or another tracker's output in this form.

With --ais the ships' own reports are the truth. Several track files (runs on the same scans) may be
given. The recording then needs no truth.csv. Its notes.json may give the latitude and longitude of
the frame's zero ("origin": [55.0, 7.0]). `scenario write` writes them for a scenario with AIS.
"""

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

from ..evaluation import ais_score, metrics, report, screened
from ..recording import track_file
from ..simulation import ais_file

HELP = 'tell how good a track file is on a recording'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `score`."""
    parser.add_argument('folder', metavar='FOLDER', help='recording with truth.csv')
    parser.add_argument('tracks', metavar='TRACKS.csv', nargs='+', help='track file to score')
    parser.add_argument(
        '--cutoff',
        type=float,
        metavar='M',
        help='a track farther from a target is not on it, m (default: '
        f'notes.json, else {metrics.CUTOFF:g})',
    )
    parser.add_argument(
        '--bias-deg',
        type=float,
        metavar='DEG',
        help='bearing bias of the tracks, deg (default: notes.json, else 0)',
    )
    parser.add_argument(
        '--lag-s',
        type=float,
        metavar='S',
        help='how late plots are, s (default: notes.json, else 0)',
    )
    parser.add_argument(
        '--ais',
        metavar='FILE',
        type=Path,
        help='score against the AIS reports in this CSV file: columns '
        + ', '.join(ais_file.COLUMNS)
        + ', or as others publish them (simulation/ais_file.py)',
    )
    parser.add_argument(
        '--ais-start-s',
        type=float,
        metavar='S',
        help="the AIS file's time at the recording's time 0 (default: notes.json, else 0)",
    )
    parser.add_argument(
        '--ais-max-gap-s',
        type=float,
        metavar='S',
        default=ais_score.MAX_GAP,
        help='between reports farther apart a vessel is not known (default %(default)g)',
    )
    parser.add_argument(
        '--origin-deg',
        type=float,
        nargs=2,
        metavar=('LAT', 'LON'),
        help="of the frame's zero (default: notes.json)",
    )
    report.add_arguments(parser)
    lines = [
        f'  {name:27s} {text}{f", {unit}" if unit else ""}'
        for name, (unit, text) in metrics.FIGURES.items()
    ]
    lines += ['', 'and for each target N:']
    lines += [
        f'  target_N_{name:18s} {text}{f", {unit}" if unit else ""}'
        for name, (unit, text) in metrics.TARGET_FIGURES.items()
    ]
    lines += ['', 'with --ais instead:']
    lines += [
        f'  {name:27s} {text}{f", {unit}" if unit else ""}'
        for name, (unit, text) in ais_score.FIGURES.items()
    ]
    parser.epilog = 'figures:\n' + '\n'.join(lines)


def run(args: Namespace) -> int:
    """Prints the figures. Always returns 0, because there are no limits."""
    recording, remarks = screened.read(args.folder)
    for remark in remarks:
        print(remark, file=sys.stderr)
    if args.ais is not None:
        return _against_ais(args, recording)
    if len(args.tracks) > 1:
        raise ValueError(f'{len(args.tracks)} track files are given; without --ais it must be one')
    score = metrics.score(
        recording, track_file.read(args.tracks[0]), args.cutoff, args.bias_deg, args.lag_s
    )
    figures = [
        report.Figure(name, value, metrics.FIGURES[name][0])
        for name, value in score.figures.items()
    ]
    figures += [
        report.Figure(f'target_{target}_{name}', value, metrics.TARGET_FIGURES[name][0])
        for target, values in score.targets.items()
        for name, value in values.items()
    ]
    title = f'{args.tracks[0]} on {recording.name}'
    if score.counts_strangers:
        title += ' (false tracks include those on vessels and landmarks without truth)'
    return report.publish(
        title,
        figures,
        args.json,
        {'recording': recording.name, 'false_counts_uncooperative': score.counts_strangers},
    )


def _against_ais(args, recording) -> int:
    found = ais_score.score(
        recording,
        [track_file.read(file) for file in args.tracks],
        args.ais,
        args.origin_deg,
        args.ais_start_s,
        args.cutoff,
        args.ais_max_gap_s,
    )
    figures = [
        report.Figure(name, value, ais_score.FIGURES[name][0], against='AIS')
        for name, value in found.items()
    ]
    what = args.tracks[0] if len(args.tracks) == 1 else f'{len(args.tracks)} track files'
    return report.publish(
        f'{what} on {recording.name}',
        figures,
        args.json,
        {'recording': recording.name, 'ais': str(args.ais)},
    )
