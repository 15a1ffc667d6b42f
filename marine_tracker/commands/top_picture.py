"""The radar picture in characters: each a grid of 2 x 4 dots (Braille) with a colour of its own.

It knows neither ROS nor the terminal: numbers in, styled lines out.
"""

import math
from typing import NamedTuple

import numpy as np
from rich.text import Text

from ..geometry import NAUTICAL_MILE
from ..tracking.lifecycle import COASTING, LOST

ACQUIRING = 0  # of the field status: not confirmed yet
UNACKNOWLEDGED = 2  # of the field alarm
DOTS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])  # of a character
BRAILLE = 0x2800
RANGES_NM = (0.25, 0.5, 0.75, 1.5, 3.0, 6.0, 12.0, 24.0, 48.0, 96.0)
RINGS = 4
VECTOR_S = 360.0
# Styles of a character, those later here over those before.
STYLES = ('', 'grey37', 'cyan', 'green', 'white', 'bold red')
NOTHING, RING, OWN, TARGET, CHOSEN, DANGER = range(len(STYLES))


class View(NamedTuple):
    """How the sea lies in the characters.

    columns, rows  characters
    range_nm       from own ship to the edge of the circle
    up             rad, the true bearing that is up
    """

    columns: int
    rows: int
    range_nm: float
    up: float = 0.0

    @property
    def radius(self) -> float:
        """Of the circle, dots."""
        return max(min(2 * self.columns, 4 * self.rows) / 2 - 1, 1.0)

    def place(self, east: np.ndarray, north: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Dots to the right and down, of offsets from own ship in m."""
        scale = self.radius / (self.range_nm * NAUTICAL_MILE)
        right = east * math.cos(self.up) - north * math.sin(self.up)
        ahead = east * math.sin(self.up) + north * math.cos(self.up)
        return self.columns + right * scale, 2 * self.rows - ahead * scale


class _Sheet:
    """Dots and characters to be put down on."""

    def __init__(self, view: View) -> None:
        self.view = view
        self.dots = np.zeros((view.rows, view.columns), int)
        self.style = np.zeros((view.rows, view.columns), int)
        self.letters = np.full((view.rows, view.columns), '', object)

    def put(self, right: np.ndarray, down: np.ndarray, style: int) -> None:
        """Dots, those inside the circle."""
        view = self.view
        inside = np.hypot(right - view.columns, down - 2 * view.rows) <= view.radius + 0.5
        x, y = np.floor(right[inside]).astype(int), np.floor(down[inside]).astype(int)
        kept = (x >= 0) & (y >= 0) & (x < 2 * view.columns) & (y < 4 * view.rows)
        x, y = x[kept], y[kept]
        np.bitwise_or.at(self.dots, (y // 4, x // 2), DOTS[y % 4, x % 2])
        np.maximum.at(self.style, (y // 4, x // 2), style)

    def write(self, right: float, down: float, text: str, style: int) -> None:
        """Letters from this place on; those outside are left out."""
        row, column = int(down // 4), int(right // 2)
        for k, letter in enumerate(text, column):
            if 0 <= row < self.view.rows and 0 <= k < self.view.columns:
                self.letters[row, k] = letter
                self.style[row, k] = max(style, self.style[row, k])

    def lines(self) -> Text:
        """All of it, in colour."""
        found = Text(no_wrap=True)
        for row in range(self.view.rows):
            for column in range(self.view.columns):
                dots = self.dots[row, column]
                letter = self.letters[row, column] or (chr(BRAILLE + dots) if dots else ' ')
                found.append(letter, STYLES[self.style[row, column]])
            found.append('\n')
        found.right_crop(1)
        return found


def draw(
    view: View,
    targets: np.ndarray,
    own: tuple[float, float, float, float, float] | None,
    chosen: int | None = None,
    shown: bool = True,
) -> Text:
    """The picture: targets [T] of `targets_cloud`; own ship's x, y, vx, vy, heading in m, m/s, rad.

    chosen  id of the target that is selected
    shown   False while what flashes is dark
    """
    sheet = _Sheet(view)
    around = np.linspace(0, 2 * np.pi, 8 * int(view.radius) + 8)
    for ring in range(1, RINGS + 1):
        away = view.range_nm * NAUTICAL_MILE * ring / RINGS
        # The rings inside are broken, the edge is not.
        bearing = around if ring == RINGS else around[::4]
        sheet.put(*view.place(away * np.sin(bearing), away * np.cos(bearing)), RING)
    rim = 0.97 * view.range_nm * NAUTICAL_MILE
    for text, degrees in (('N', 0.0), ('E', 90.0), ('S', 180.0), ('W', 270.0)):
        angle = math.radians(degrees)
        right, down = view.place(np.array(rim * math.sin(angle)), np.array(rim * math.cos(angle)))
        sheet.write(float(right), float(down), text, RING)
    if own is None:
        return sheet.lines()
    x, y, _, _, heading = own
    line = np.linspace(0, view.range_nm * NAUTICAL_MILE, 2 * int(view.radius))
    if math.isfinite(heading):
        sheet.put(*view.place(line * math.sin(heading), line * math.cos(heading)), OWN)
    for target in targets[np.argsort(targets['alarm'], kind='stable')]:  # dangerous ones on top
        if not math.isfinite(target['x']) or target['status'] == LOST:
            continue
        if target['alarm'] == UNACKNOWLEDGED and not shown:
            continue
        _draw_target(sheet, target, x, y, target['id'] == chosen)
    right, down = view.place(np.zeros(()), np.zeros(()))
    sheet.write(float(right), float(down), '◎', OWN)
    return sheet.lines()


def _draw_target(sheet: _Sheet, target: np.void, x: float, y: float, chosen: bool) -> None:
    view = sheet.view
    style = DANGER if target['alarm'] else CHOSEN if chosen else TARGET
    east, north = float(target['x']) - x, float(target['y']) - y
    if math.hypot(east, north) > view.range_nm * NAUTICAL_MILE:
        return
    if target['status'] != ACQUIRING:
        times = np.linspace(0, VECTOR_S, 60)
        sheet.put(
            *view.place(east + float(target['vx']) * times, north + float(target['vy']) * times),
            style,
        )
    mark = {ACQUIRING: '◌', COASTING: '◠'}.get(int(target['status']), '○')
    if target['alarm']:
        mark = '●'
    right, down = view.place(np.array(east), np.array(north))
    number = f'{target["number"]:02}' if target['number'] else ''
    sheet.write(float(right), float(down), mark + number, style)
