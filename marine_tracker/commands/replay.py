"""Track a recording or a scenario in process, faster than real time, into a track file."""

import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..estimators import WANT_DOPPLER
from ..extent.extents import Extents
from ..processes import keep_freed_memory
from ..recording import csv_folder, track_file
from ..simulation import radar, scenario
from ..tracking.lifecycle import CONFIRMED, STATUS_NAMES
from ..tracking.radars import fused, merged
from ..tracking.tracker import Tracker
from ..types import Scan
from . import tracker_options

HELP = 'track a recording or a scenario into a CSV file, without ROS'


class Source(NamedTuple):
    """Scans to track.

    scans               (number, scan) in time order
    total               how many; None where it is not known
    tracker_parameters  those that belong to the radar and its waters
    """

    scans: Iterable[tuple[int, Scan]]
    total: int | None
    tracker_parameters: dict[str, Any]


class Summary(NamedTuple):
    """scans done, tracks ever confirmed, the tracker's mean CPU time a scan in ms, and whether any
    plots told radial speeds."""

    scans: int
    confirmed: int
    cpu_ms: float
    doppler: bool


def add_arguments(parser) -> None:
    """The command line of `replay`."""
    parser.add_argument(
        'source',
        metavar='SOURCE',
        nargs='+',
        help='folder of a recording, name of a shipped scenario, or scenario file; '
        'several of one scene, each by a radar of its own, are fused',
    )
    parser.add_argument(
        '--out',
        metavar='TRACKS.csv',
        required=True,
        help='track file to write: one row a track and scan; - for standard output',
    )
    parser.add_argument('--seed', type=int, default=1, help='seed of a scenario (default: 1)')
    tracker_options.add_arguments(parser)


def run(args) -> int:
    """Write the track file and say in one line what was tracked."""
    if args.seed < 0:
        raise ValueError(f'--seed is {args.seed}; it must not be negative')
    keep_freed_memory()
    source = fuse(args.source, args.seed)
    tracker = Tracker(tracker_options.parameters(args, source.tracker_parameters))
    scans = _with_progress(source.scans, source.total)
    if args.out == '-':
        summary = write_tracks(tracker, scans, sys.stdout)
    else:
        with open(args.out, 'w', newline='') as file:
            summary = write_tracks(tracker, scans, file)
    print(
        f'{summary.scans} scans, {summary.confirmed} tracks confirmed, '
        f'{summary.cpu_ms:.2f} ms CPU a scan',
        file=sys.stderr if args.out == '-' else sys.stdout,
    )
    if tracker.parameters.estimator in WANT_DOPPLER and not summary.doppler:
        print(
            f'warning: the plots tell no radial speeds, which {tracker.parameters.estimator} wants',
            file=sys.stderr,
        )
    return 0


def open_source(name: str, seed: int = 1) -> Source:
    """A recording where `name` is a folder, else a scenario run with `seed`.

    ValueError where it is neither, or is not in order.
    """
    if Path(name).is_dir():
        recording = csv_folder.read(name)
        numbers = recording.numbers.tolist()
        return Source(zip(numbers, recording.scans), len(numbers), recording.tracker_parameters)
    chosen = scenario.load(name)
    simulated = enumerate(scan for scan, _ in radar.simulate(chosen, seed))
    return Source(simulated, None, chosen.tracker_parameters())


def fuse(names: Sequence[str], seed: int = 1) -> Source:
    """The sources of one scene as one, each of them a radar of its own; a single one as it is.

    Scans are numbered as they end. Of scenarios each has noise of its own, from `seed` on.
    """
    sources = [open_source(name, seed + k) for k, name in enumerate(names)]
    if len(sources) == 1:
        return sources[0]
    radars = [f'radar_{k}' for k in range(1, len(sources) + 1)]
    totals = [source.total for source in sources if source.total is not None]
    return Source(
        enumerate(merged(*((scan for _, scan in source.scans) for source in sources))),
        sum(totals) if len(totals) == len(sources) else None,
        fused([source.tracker_parameters for source in sources], radars),
    )


def write_tracks(tracker: Tracker, scans: Iterable[tuple[int, Scan]], file) -> Summary:
    """Run the tracker over numbered scans and write what it says after each of them."""
    names = np.array(STATUS_NAMES)
    confirmed: set[int] = set()
    extents = Extents(tracker.parameters)
    memory, known, count, cpu, doppler = tracker.start(), extents.start(), 0, 0.0, False
    track_file.write_header(file)
    for number, scan in scans:
        began = time.process_time()
        (memory, known), report, _, _ = extents.track(tracker, memory, known, scan)
        estimate = tracker.extrapolate(report.tracks, report.time)
        cpu += time.process_time() - began
        tracks = report.tracks
        track_file.write_scan(
            file,
            number,
            estimate,
            tracks.id,
            names[tracks.status],
            report.predicted,
            report.plot,
            scan.own_ship,
            tracker.parameters.estimator,
        )
        confirmed.update(tracks.id[tracks.status == CONFIRMED].tolist())
        count += 1
        doppler |= scan.plots.radial_speed is not None
    return Summary(count, len(confirmed), 1e3 * cpu / max(count, 1), doppler)


def _with_progress(
    scans: Iterable[tuple[int, Scan]], total: int | None
) -> Iterator[tuple[int, Scan]]:
    """The same scans, with a progress bar where a person watches."""
    if not sys.stderr.isatty():
        yield from scans
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(scans, 'tracking', total=total, console=Console(stderr=True), transient=True)
