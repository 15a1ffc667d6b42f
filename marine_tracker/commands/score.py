"""Score a track file against the truth of a recording.

FOLDER is a recording with truth.csv (or what `marine_tracker scenario write` made). TRACKS.csv has
at least the columns time_s, track, status, north_m, east_m, vel_north_mps, vel_east_mps; what
`marine_tracker replay` writes, or another tracker's output in this form.
"""

from ..evaluation import metrics, report
from ..recording import csv_folder, track_file

HELP = 'tell how good a track file is on a recording'


def add_arguments(parser) -> None:
    """The command line of `score`."""
    parser.add_argument('folder', metavar='FOLDER', help='recording with truth.csv')
    parser.add_argument('tracks', metavar='TRACKS.csv', help='track file to score')
    parser.add_argument('--cutoff', type=float, metavar='M',
                        help='a track farther from a target is not on it, m (default: '
                             f'notes.json, else {metrics.CUTOFF:g})')
    parser.add_argument('--bias-deg', type=float, metavar='DEG',
                        help='bearing bias of the tracks, deg (default: notes.json, else 0)')
    parser.add_argument('--lag-s', type=float, metavar='S',
                        help='how late plots are, s (default: notes.json, else 0)')
    report.add_arguments(parser)
    lines = [f'  {name:27s} {text}{f", {unit}" if unit else ""}'
             for name, (unit, text) in metrics.FIGURES.items()]
    lines += ['', 'and for each target N:']
    lines += [f'  target_N_{name:18s} {text}{f", {unit}" if unit else ""}'
              for name, (unit, text) in metrics.TARGET_FIGURES.items()]
    parser.epilog = 'figures:\n' + '\n'.join(lines)


def run(args) -> int:
    """Print the figures; always 0, for nothing is demanded."""
    recording = csv_folder.read(args.folder)
    score = metrics.score(recording, track_file.read(args.tracks), args.cutoff, args.bias_deg,
                          args.lag_s)
    figures = [report.Figure(name, value, metrics.FIGURES[name][0])
               for name, value in score.figures.items()]
    figures += [report.Figure(f'target_{target}_{name}', value, metrics.TARGET_FIGURES[name][0])
                for target, values in score.targets.items() for name, value in values.items()]
    title = f'{args.tracks} on {recording.name}'
    if score.counts_strangers:
        title += ' (false tracks include those on vessels and landmarks without truth)'
    return report.publish(title, figures, args.json, {
        'recording': recording.name, 'false_counts_uncooperative': score.counts_strangers})
