"""The table of targets that the demo shows: live on a terminal, else as plain lines."""

import contextlib
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

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


@contextlib.contextmanager
def display() -> Iterator[Callable[..., None]]:
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
