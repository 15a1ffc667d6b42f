"""Runs simulator (or recorded radar), tracker and PPI over ROS 2, as processes; shows a table.

The address of the PPI is printed. On a desktop the page opens by itself.

Ends with Ctrl-C, after --duration, or when the recording or scenario has ended.
"""

import contextlib
import dataclasses
import os
import signal
import sys
import threading
import time
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from ..estimators import ESTIMATORS
from ..evaluation import video_source
from ..parameters import (
    EXTENTS,
    RadarSimulatorParameters,
    RecordingPlayerParameters,
    TrackerParameters,
    from_mapping,
)
from ..processes import closing, end_in_time
from ..recording import csv_folder, spokes_file
from . import demo_page, tracker_options
from .node_processes import Child, children_of

HELP = 'watch simulated or recorded radar being tracked, over ROS 2'

COLUMNS = (
    ('target', 'name'),
    ('status', 'status'),
    ('range NM', 'range_nm'),
    ('bearing', 'bearing_deg'),
    ('course', 'course_deg'),
    ('speed kn', 'speed_kn'),
    ('CPA NM', 'cpa_nm'),
    ('TCPA min', 'tcpa_min'),
    ('hits in 10', 'hits_in_10'),
    ('estimator', 'estimator'),
)
SIZES = (('length m', 'length_m'), ('heading', 'heading_deg'))  # with extents, before the last
TO_THE_LEFT = ('name', 'status', 'estimator')
STYLES = {'COASTING': 'yellow', 'LOST': 'bright_black'}
DANGEROUS = 'bold red'
MOST_ALARMS = 8  # listed below the table on a terminal; others are only counted
PLAIN_EVERY_S = 2.0  # s between two tables if there is no terminal
PPI, EXTRACTOR = 'ppi_display', 'plot_extractor'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the options of the command."""
    source = parser.add_mutually_exclusive_group()
    source.add_argument(
        '--scenario',
        default='encounters',
        metavar='NAME',
        help='a shipped scenario or a scenario file (default: %(default)s)',
    )
    source.add_argument(
        '--recording',
        metavar='FOLDER',
        help='a recorded folder instead, or a file of spokes (.npz)',
    )
    tracker_options.add_video_arguments(parser, heading=False)
    parser.add_argument(
        '--rate',
        type=float,
        default=1.0,
        metavar='F',
        help='simulated seconds in a second (default: 1)',
    )
    parser.add_argument('--estimator', choices=sorted(ESTIMATORS), help='filter of the tracker')
    parser.add_argument(
        '--extent',
        choices=(*EXTENTS, 'off'),
        metavar='{' + ','.join(EXTENTS) + '}',
        help='how the tracker joins cells that touch into one target',
    )
    parser.add_argument('--seed', type=int, default=1, help='seed of the simulator (default: 1)')
    parser.add_argument('--duration', type=float, metavar='S', help='end after so many seconds')
    parser.add_argument('--no-display', action='store_true', help='no page with the radar picture')
    parser.add_argument(
        '--domain', type=int, metavar='ID', help='ROS domain (default: one that is free)'
    )


def run(args: Namespace) -> int:
    """Returns 0 after a requested stop, 1 if a process died or ROS is missing."""
    stop = threading.Event()

    def on_signal(*_):
        closing()
        stop.set()

    before = {
        number: signal.signal(number, on_signal)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    }
    try:
        return _demo(args, stop)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _demo(args, stop: threading.Event) -> int:
    source, source_parameters, tracker_parameters = _parameters(args)
    extraction = _extraction(args)
    try:
        from ..nodes import domain
        from ..nodes.targets_listener import TargetsListener
    except ModuleNotFoundError as error:
        print(
            f'marine_tracker demo needs ROS 2 ({error}): '
            "pip install 'marine_tracker[ros]', or source a ROS 2 Jazzy",
            file=sys.stderr,
        )
        return 1
    end_in_time()
    with contextlib.ExitStack() as context:
        number = args.domain
        if number is None:
            number = context.enter_context(domain.free_domain())
        domain.set_local(os.environ, number)
        last = context.enter_context(contextlib.ExitStack())
        nodes = {'tracker': tracker_parameters, source: source_parameters}
        if extraction is not None:
            nodes[EXTRACTOR] = extraction
        if demo_page.wanted(args.no_display):
            nodes[PPI] = {
                'address': f'127.0.0.1:{demo_page.free_port()}',
                'use_sim_time': args.rate != 1,
            }
        children = context.enter_context(children_of(nodes))
        listener = TargetsListener()
        last.callback(listener.close)  # after the children have ended: it may hang
        title = Path(args.recording).name if args.recording else args.scenario
        return _watch(listener, children, stop, title, args.duration, number)


def _parameters(args) -> tuple[str, dict[str, Any], dict[str, Any]]:
    """The source node's name and parameters, and the tracker's. ValueError if one is wrong."""
    source: str
    if args.recording:
        source = 'recording_player'
        given = {'folder': os.path.abspath(args.recording), 'rate': args.rate}
        from_mapping(RecordingPlayerParameters, given)
        for_tracker = _recorded_parameters(args)
    else:
        from ..simulation import scenario

        source = 'radar_simulator'
        name = args.scenario
        given = {
            'scenario': os.path.abspath(name) if os.path.isfile(name) else name,
            'rate': args.rate,
            'seed': args.seed,
        }
        from_mapping(RadarSimulatorParameters, given)
        for_tracker = dict(scenario.load(name).tracker_parameters())
    if args.estimator:
        for_tracker['estimator'] = args.estimator
    if args.extent:
        for_tracker['extent'] = args.extent
    checked = from_mapping(TrackerParameters, for_tracker)
    for_tracker = {name: getattr(checked, name) for name in for_tracker}  # ints become floats
    if args.rate != 1:
        for_tracker['use_sim_time'] = True
    return source, given, for_tracker


def _recorded_parameters(args) -> dict[str, Any]:
    """The tracker's parameters for a recording."""
    if spokes_file.is_spokes_file(args.recording):
        video = spokes_file.read(args.recording)
        return video_source.tracker_parameters(tracker_options.video(args).parameters, video.sweep)
    return dict(csv_folder.read(args.recording).tracker_parameters)


def _extraction(args) -> dict[str, Any] | None:
    """The parameters of the plot extractor; None where plots come without it."""
    if not (args.recording and spokes_file.is_spokes_file(args.recording)):
        return None
    values = dataclasses.asdict(tracker_options.video(args).parameters)
    return {**values, **({'use_sim_time': True} if args.rate != 1 else {})}


def _watch(listener, children, stop, title: str, duration: float | None, domain: int) -> int:
    """Shows the targets until the end. Returns the exit code."""
    began, ended = time.monotonic(), None
    page = next((child for child in children if child.name == PPI), None)
    with _display() as show:
        while not stop.is_set() and ended is None:
            if duration is not None and time.monotonic() - began >= duration:
                break
            listener.spin(0.1)
            if page and (address := demo_page.address_of(page)):
                page = None
                demo_page.show(address)
            show(listener.picture, f'{title}, ROS domain {domain}')
            ended = next((child for child in children if child.process.poll() is not None), None)
        if ended is None:
            return 0
        if ended.process.returncode == 0 and ended.name != 'tracker':
            _drain(listener, show, f'{title}, ended')
            return 0
    _tell_why(ended)
    return 1


def _drain(listener, show, title: str) -> None:
    """Takes in what is still on its way after the source has ended."""
    until = time.monotonic() + 0.5
    while time.monotonic() < until:
        listener.spin(0.1)
    show(listener.picture, title)


def _tell_why(child: Child) -> None:
    child.log.seek(0)
    said = child.log.read().decode(errors='replace').strip().splitlines()[-10:]
    print(
        f'marine_tracker demo: {child.name} ended with code {child.process.returncode}'
        + (', saying' if said else ''),
        *said,
        sep='\n  ',
        file=sys.stderr,
    )


@contextlib.contextmanager
def _display():
    """A function that shows a picture: live on a terminal, else as plain tables."""
    if not sys.stdout.isatty():
        yield _plain()
        return
    from rich.console import Console
    from rich.live import Live

    console = Console()
    with Live(console=console, auto_refresh=False) as live:
        last: list[Any] = []

        def show(picture, title):
            if last[:1] != [(picture, title)]:
                live.update(_rich_table(picture, title, console.height), refresh=True)
                last[:] = [(picture, title)]

        yield show


def _plain():
    """Shows a picture as lines: once a scan, and not faster than people can read."""
    last = {'scans': 0, 'at': -PLAIN_EVERY_S}

    def show(picture, title):
        now = time.monotonic()
        if picture.scans == last['scans'] or now - last['at'] < PLAIN_EVERY_S:
            return
        last.update(scans=picture.scans, at=now)
        columns = _columns(picture)
        lines = [
            f'{_clock(picture)}  {title}  {_facts(picture)}',
            '  '.join(f'{head:>10}' for head, _ in columns),
        ]
        lines += [
            '  '.join([*(f'{target.get(key, ""):>10}' for _, key in columns), target['danger']])
            for target in picture.targets
        ]
        print('\n'.join([*lines, *picture.alarms]), flush=True)

    return show


def _columns(picture):
    """Heads and keys of the columns for these targets."""
    told = picture.targets and SIZES[0][1] in picture.targets[0]
    return (*COLUMNS[:-1], *SIZES, COLUMNS[-1]) if told else COLUMNS


def _rich_table(picture, title: str, height: int):
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    below = picture.alarms[:MOST_ALARMS]
    if len(picture.alarms) > MOST_ALARMS:
        below += (f'and {len(picture.alarms) - MOST_ALARMS} more alarms',)
    caption = Text('\n').join(
        [
            *(Text(line, DANGEROUS) for line in below),
            Text(_facts(picture)),
            *map(Text, picture.warnings),
            Text('Ctrl-C ends'),
        ]
    )
    table = Table(
        title=Text(f'{title}   {_clock(picture)}', 'table.title'),
        title_justify='left',
        caption=caption,
        caption_justify='left',
        box=SIMPLE_HEAD,
        padding=0,
    )
    columns = _columns(picture)
    for head, key in columns:
        table.add_column(
            head,
            justify='left' if key in TO_THE_LEFT else 'right',
            min_width=8 if key == 'status' else None,
        )  # TRACKING in full
    room = max(height - 8 - len(below) - len(picture.warnings), 1)
    # If there is not enough room for all, the dangerous ones are shown.
    shown = (
        picture.targets
        if len(picture.targets) <= room
        else sorted(picture.targets, key=lambda target: not target['danger'])[:room]
    )
    for target in shown:
        table.add_row(
            *(Text(target.get(key, '')) for _, key in columns),
            style=DANGEROUS if target['danger'] else STYLES.get(target['status']),
        )
    if len(picture.targets) > room:
        table.add_row(f'and {len(picture.targets) - room} more')
    return table


def _clock(picture) -> str:
    return time.strftime('%H:%M:%S', time.gmtime(picture.time)) if picture.scans else '--:--:--'


def _facts(picture) -> str:
    if not picture.scans:
        return 'waiting for the first revolution'
    count = len(picture.targets)
    return (
        f'{count} target{"" if count == 1 else "s"}, {picture.plots} plots a scan, '
        f'own ship {picture.own_ship}'
    )
