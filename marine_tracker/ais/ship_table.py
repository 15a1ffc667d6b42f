"""The ships of AIS as a table, one row a ship."""

from typing import NamedTuple

import numpy as np

from .. import m1371
from ..geometry import unit_vector
from ..types import Array, BoolArray, CodeArray, IntArray
from .reports import Text

LOST_AFTER = 6.0  # intervals between reports
SILENT_INTERVAL = 60.0  # s; of a ship whose motion nobody knows


class Ships(NamedTuple):
    """S rows, a ship each; two rows where two senders use one number.

    id         [S]     never used again
    mmsi       [S]
    kind       [S]     of m1371.KINDS
    heard      [S]     s, the last report of any kind
    time       [S]     s, of the place
    position   [S, 2]  m, of the antenna; nan where none is known
    speed, course  [S] m/s, rad over ground; nan for none
    heading, turn  [S] rad, rad/s; nan for none
    status     [S]     of m1371.STATUSES; -1 for none
    accurate, timed, coarse  [S]  of the place: to 10 m; by the second; of a message 27
    name, call_sign, ship_type, size  as in Reports
    begun      [S]     s, of the first place that fits the others
    other      [S, 2]  m, a place that was refused; nan for none
    other_time [S]     s, of it
    jumps      [S]     number of places refused
    double     [S]     another row has the same number
    lost       [S]     silent for too long
    """

    id: IntArray
    mmsi: IntArray
    kind: CodeArray
    heard: Array
    time: Array
    position: Array
    speed: Array
    course: Array
    heading: Array
    turn: Array
    status: CodeArray
    accurate: BoolArray
    timed: BoolArray
    coarse: BoolArray
    name: Text
    call_sign: Text
    ship_type: IntArray
    size: Array
    begun: Array
    other: Array
    other_time: Array
    jumps: IntArray
    double: BoolArray
    lost: BoolArray

    @property
    def placed(self) -> BoolArray:
        """Mask [S] of those whose place is known."""
        found: BoolArray = np.isfinite(self.position[:, 0])
        return found

    @property
    def velocity(self) -> Array:
        """m/s [S, 2] over ground as told; 0 of a ship at rest without course; nan where none is."""
        course = np.where((self.speed == 0) & np.isnan(self.course), 0.0, self.course)
        found: Array = self.speed[:, None] * unit_vector(course)
        return found

    @property
    def timeout(self) -> Array:
        """s [S] of silence after which a ship is lost, by kind, status and speed."""
        silent = np.where(
            self.coarse,
            m1371.LONG_RANGE,
            m1371.interval(self.kind, self.status, self.speed, np.zeros(len(self.id))),
        )
        unknown = np.isnan(self.speed) & (self.kind == m1371.CLASS_A) & ~self.coarse
        found: Array = LOST_AFTER * np.where(unknown, np.maximum(silent, SILENT_INTERVAL), silent)
        return found

    @property
    def length(self) -> Array:
        """m [S]; nan where it is not known."""
        return _side(self.size[:, 0], self.size[:, 1])

    @property
    def beam(self) -> Array:
        """m [S]; nan where it is not known."""
        return _side(self.size[:, 2], self.size[:, 3])


def _side(first: Array, second: Array) -> Array:
    found: Array = np.where(np.isnan(first), second, first + second)
    return found


def none() -> Ships:
    """No ships."""
    ids, codes, times = np.zeros(0, np.int64), np.zeros(0, np.int8), np.zeros(0)
    pairs, flags, words = np.zeros((0, 2)), np.zeros(0, bool), np.zeros(0, 'U20')
    return Ships(
        *(ids, ids, codes, times, times, pairs, times, times, times, times, codes),
        *(flags, flags, flags, words, words.astype('U7'), ids, np.zeros((0, 4))),
        *(times, pairs, times, ids, flags, flags),
    )
