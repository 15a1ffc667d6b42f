"""The radar picture and the table of targets in the terminal, of a tracker that runs over ROS 2.

Keys: + and - change the range, o the orientation, n selects the next target, a acknowledges all
alarms, q ends. It looks only, but for that acknowledgement. Needs the extra `top` (textual).
"""

import math
import os
import time
from argparse import ArgumentParser, Namespace
from typing import Any, ClassVar

import numpy as np
from rich.text import Text
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.widgets import DataTable, Footer, Static

from ..geometry import KNOT, NAUTICAL_MILE
from ..tracking.lifecycle import COASTING, LOST
from . import top_picture
from .top_picture import RANGES_NM, View

HELP = 'radar picture and table of targets in the terminal, over ROS 2'
REFRESH_S = 0.25
FLASH_S = 0.5
ORIENTATIONS = ('north-up', 'head-up')
STATUS = {top_picture.ACQUIRING: 'acquiring', COASTING: 'coasting'}
HEADS = ('target', 'NM', 'bearing', 'course', 'kn', 'CPA', 'TCPA', 'status')
MOST_ALARMS = 6
DANGER = 'bold red'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the options of the command."""
    parser.add_argument(
        '--range', type=float, default=6.0, metavar='NM', help='range (default: %(default)g)'
    )
    parser.add_argument('--head-up', action='store_true', help='own ship points up')
    parser.add_argument(
        '--domain', type=int, metavar='ID', help='ROS domain (default: ROS_DOMAIN_ID)'
    )


def run(args: Namespace) -> int:
    """Runs until q. ValueError for a range that there is not."""
    if args.range not in RANGES_NM:
        known = ', '.join(f'{one:g}' for one in RANGES_NM)
        raise ValueError(f'--range is {args.range:g}; it must be one of {known}')
    if args.domain is not None:
        os.environ['ROS_DOMAIN_ID'] = str(args.domain)
    TopApp(args.range, args.head_up).run()
    return 0


class TopApp(App[None]):
    """Picture on the left, targets and alarms on the right."""

    CSS = """
    #picture { width: 2fr; height: 1fr; }
    #side { width: 62; height: 1fr; }
    #targets { height: 1fr; }
    #alarms { height: auto; max-height: 8; color: $error; }
    #state { height: 1; }
    #state.stale { background: $error; color: $text; text-style: bold; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding('plus,equals_sign', 'zoom(-1)', 'nearer', key_display='+'),
        Binding('minus', 'zoom(1)', 'farther', key_display='-'),
        Binding('o', 'turn', 'orientation'),
        Binding('n', 'next', 'next target'),
        Binding('a', 'acknowledge', 'acknowledge all'),
        Binding('q', 'quit', 'end'),
    ]

    def __init__(self, range_nm: float = 6.0, head_up: bool = False) -> None:
        super().__init__()
        from ..nodes.top_listener import TopListener

        self._listener = TopListener()
        self.range_nm, self.orientation = range_nm, ORIENTATIONS[head_up]
        self.chosen: int | None = None  # id of the selected target's track
        self._said, self._said_until = '', 0.0

    def compose(self) -> ComposeResult:
        """The parts of the screen."""
        yield Static(id='state', markup=False)
        with Horizontal():
            yield Static(id='picture')
            with Vertical(id='side'):
                yield DataTable(id='targets', cursor_type='row', zebra_stripes=True)
                yield Static(id='alarms', markup=False)
        yield Footer()

    def on_mount(self) -> None:
        """Begin to listen."""
        table = self.query_one(DataTable)
        table.add_columns(*HEADS)
        table.can_focus = False
        self.set_interval(REFRESH_S, self._show)

    def on_unmount(self) -> None:
        """Leave the network."""
        self._listener.close()

    # -- keys --------------------------------------------------------------------------------------

    def action_zoom(self, step: int) -> None:
        """To the next range."""
        place = RANGES_NM.index(self.range_nm) + step
        self.range_nm = RANGES_NM[min(max(place, 0), len(RANGES_NM) - 1)]
        self._show()

    def action_turn(self) -> None:
        """To the next orientation."""
        self.orientation = ORIENTATIONS[self.orientation == ORIENTATIONS[0]]
        self._show()

    def action_next(self) -> None:
        """Select the next target, in the order of the table."""
        ids = [int(target['id']) for target in self._in_order()]
        if ids:
            place = ids.index(self.chosen) + 1 if self.chosen in ids else 0
            self.chosen = ids[place % len(ids)]
        self._show()

    def action_acknowledge(self) -> None:
        """All alarms."""
        self._said, self._said_until = self._listener.acknowledge_all(), time.monotonic() + 4
        self._show()

    # -- the screen --------------------------------------------------------------------------------

    def _in_order(self) -> np.ndarray:
        """Targets that are not lost, dangerous ones first, then by range."""
        targets = self._listener.seen.targets
        targets = targets[targets['status'] != LOST]
        return targets[np.lexsort([targets['range'], -targets['alarm'].astype(int)])]

    def _show(self) -> None:
        self._listener.spin()
        seen, stale = self._listener.seen, self._listener.stale()
        state = self.query_one('#state', Static)
        state.set_class(bool(stale), 'stale')
        said = self._said if time.monotonic() < self._said_until else ''
        heading = seen.own[4] if seen.own else math.nan
        head_up = self.orientation == 'head-up' and math.isfinite(heading)
        about = f'{self.range_nm:g} NM  {"head-up" if head_up else "north-up"}  {_own(seen.own)}'
        state.update(f' NO LIVE DATA: {stale} ' if stale else f' {about}  {said}')
        picture = self.query_one('#picture', Static)
        size = picture.content_size
        if size.width > 2 and size.height > 1:
            view = View(size.width, size.height, self.range_nm, heading if head_up else 0.0)
            shown = int(time.monotonic() / FLASH_S) % 2 == 0
            picture.update(top_picture.draw(view, seen.targets, seen.own, self.chosen, shown))
        self._fill(self.query_one(DataTable))
        alarms = [*seen.alarms[:MOST_ALARMS]]
        if len(seen.alarms) > MOST_ALARMS:
            alarms.append(f'and {len(seen.alarms) - MOST_ALARMS} more')
        self.query_one('#alarms', Static).update('\n'.join(alarms))

    def _fill(self, table: DataTable[Any]) -> None:
        rows = [
            (
                int(target['id']),
                [Text(one, DANGER if target['alarm'] else '') for one in cells(target)],
            )
            for target in self._in_order()
        ]
        if [key.value for key in table.rows] != [str(id) for id, _ in rows]:
            table.clear()
            for id, values in rows:
                table.add_row(*values, key=str(id))
        else:
            for row, (_, values) in enumerate(rows):
                for column, value in enumerate(values):
                    table.update_cell_at((row, column), value)  # type: ignore[arg-type]
        place = next((row for row, (id, _) in enumerate(rows) if id == self.chosen), None)
        table.show_cursor = place is not None
        if place is not None:
            table.move_cursor(row=place)


def cells(target: np.void) -> tuple[str, ...]:
    """The row of one target of `targets_cloud`; a dash where nothing is known."""
    danger = {0: '', 1: 'danger', 2: 'DANGER'}[int(target['alarm'])]
    return (
        f'TT{target["number"]:02}' if target['number'] else f'Q{target["id"]}',
        _number(target['range'] / NAUTICAL_MILE, '.2f'),
        _number(math.degrees(target['bearing']) % 360, '05.1f'),
        _number(math.degrees(target['course']) % 360, '05.1f'),
        _number(target['speed'] / KNOT, '.1f'),
        _number(target['cpa'] / NAUTICAL_MILE, '.2f'),
        _number(target['tcpa'] / 60, '.1f'),
        danger or STATUS.get(int(target['status']), 'tracking'),
    )


def _own(own: tuple[float, float, float, float, float] | None) -> str:
    if own is None:
        return ''
    speed = math.hypot(own[2], own[3])
    course = math.degrees(math.atan2(own[2], own[3])) % 360 if speed > 0 else math.nan
    heading = _number(math.degrees(own[4]) % 360, '05.1f')
    return f'HDG {heading}  COG {_number(course, "05.1f")}  SOG {_number(speed / KNOT, ".1f")} kn'


def _number(value: float, form: str) -> str:
    return format(float(value), form) if math.isfinite(value) else '–'
