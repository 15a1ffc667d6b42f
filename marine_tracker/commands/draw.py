"""Draw a recording as a picture: its plots, its truth where it has one, and tracks.

FOLDER is a recording. Each TRACKS.csv, as `marine_tracker replay` writes them, gets a panel of its
own, so before and after stand side by side. Without any, the plots alone are drawn.

grey dots: plots, darker ones later        black: truth, a dot at its start
blue: tracks, confirmed or coasting         red: where they are on no target of the truth
green squares: stationary tracks           triangle: own ship
"""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

import numpy as np

from ..evaluation import metrics, screened
from ..files import written
from ..geometry import locate
from ..recording import track_file
from ..recording.csv_folder import Recording
from ..recording.track_file import TrackRows
from ..types import Array, BoolArray

HELP = 'draw a recording: plots, truth and tracks'
AIMED = ('confirmed', 'coasting')


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `draw`."""
    parser.add_argument('folder', metavar='FOLDER', help='recording')
    parser.add_argument('tracks', metavar='TRACKS.csv', nargs='*', help='track files, a panel each')
    parser.add_argument('--out', metavar='FILE.png', required=True, help='image to write')
    parser.add_argument(
        '--radius',
        type=float,
        metavar='M',
        help="half the picture's width, about own ship's middle place, m (default: what is there)",
    )


def run(args: Namespace) -> int:
    """Writes the image and says where it is."""
    try:
        from matplotlib.figure import Figure
    except ModuleNotFoundError as error:
        raise ValueError('drawing needs matplotlib: pip install "marine_tracker[plot]"') from error
    if args.radius is not None and not args.radius > 0:
        raise ValueError(f'--radius is {args.radius:g} m; it must be more than 0')
    recording, _ = screened.read(args.folder)
    panels: list[tuple[str, TrackRows | None]] = [('plots', None)]
    if args.tracks:
        panels = [(Path(name).name, track_file.read(name)) for name in args.tracks]
    figure = Figure(figsize=(9 * len(panels), 9), layout='constrained')
    kind = Path(args.out).suffix.removeprefix('.').lower()
    if kind not in figure.canvas.get_supported_filetypes():
        raise ValueError(f'--out is {args.out}; its name must end in that of an image, like .png')
    every = figure.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0]
    for axes, (name, rows) in zip(every, panels, strict=True):
        _surroundings(axes, recording)
        told = '' if rows is None else _tracks(axes, recording, rows)
        axes.set(aspect='equal', xlabel='east, m', ylabel='north, m', title=f'{name}{told}')
        axes.grid(color='0.92')
        if args.radius is not None:
            east, north = np.median(recording.own_ship.position, 0)
            axes.set_xlim(east - args.radius, east + args.radius)
            axes.set_ylim(north - args.radius, north + args.radius)
    figure.suptitle(f'{recording.name}: {len(recording.scans)} scans')
    with written(args.out, 'wb') as image:
        figure.savefig(image, format=kind, dpi=80)
    print(f'drawn: {args.out}')
    return 0


def _surroundings(axes: Any, recording: Recording) -> None:
    """The plots, the truth and own ship."""
    plots = [locate(scan.plots, scan.measured_from, 1.0, 0.001) for scan in recording.scans]
    position = np.concatenate([one.position for one in plots])
    time = np.concatenate([one.time for one in plots])
    axes.scatter(*position.T, c=-time, cmap='gray', s=4, alpha=0.6, linewidths=0)
    truth = [(one.target, one.position) for one in recording.truths]
    target = np.concatenate([one for one, _ in truth]) if truth else np.zeros(0)
    place = np.concatenate([one for _, one in truth]) if truth else np.zeros((0, 2))
    for name in np.unique(target):
        way = place[target == name]
        axes.plot(*way.T, color='black', linewidth=1)
        axes.plot(*way[0], 'o', color='black', markersize=4)
    axes.plot(*recording.own_ship.position.T, color='tab:orange', linewidth=1)
    axes.plot(*recording.own_ship.position[-1], '^', color='tab:orange', markersize=8)


def _tracks(axes: Any, recording: Recording, rows: TrackRows) -> str:
    """The tracks; and in words how many there are."""
    aimed, still = np.isin(rows.status, AIMED), rows.status == 'stationary'
    cutoff = float(recording.notes.get('cutoff_m', metrics.CUTOFF))
    false = aimed & ~near_truth(recording, rows, cutoff)
    for track in np.unique(rows.track[aimed]):
        mine = (rows.track == track) & aimed
        way = rows.position[mine]
        axes.plot(*way.T, color='tab:blue', linewidth=1.4)
        axes.annotate(track, way[-1], xytext=(3, 3), textcoords='offset points', fontsize=7)
    axes.plot(*rows.position[false].T, '.', color='crimson', markersize=2.5)
    for track in np.unique(rows.track[still]):
        place = rows.position[still & (rows.track == track)].mean(0)
        axes.plot(*place, 's', mfc='none', color='tab:green', markersize=7)
    told = f'\n{len(np.unique(rows.track[aimed]))} tracks'
    stationary = len(np.unique(rows.track[still]))
    return told + (f', {stationary} at stationary objects' if stationary else '')


def near_truth(recording: Recording, rows: TrackRows, cutoff: float) -> BoolArray:
    """Mask [R] of the rows within `cutoff` m of a target at their time; all, without a truth."""
    scans = [truth for truth in recording.truths if len(truth.time)]
    found = np.ones(len(rows.time), bool)
    if not scans:
        return found
    middle: Array = np.array([truth.time.mean() for truth in scans])
    scan = np.abs(middle - rows.time[:, None]).argmin(1)
    for k, truth in enumerate(scans):
        mine = (scan == k).nonzero()[0]
        away = np.linalg.norm(rows.position[mine, None] - truth.position, axis=2)
        found[mine] = away.min(1) <= cutoff
    return found
