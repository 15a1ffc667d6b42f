"""The arrays that flow through the tracker: one leading axis, one row a plot or a track.

Every type is a NamedTuple of numpy arrays. `take`, `append` and `where` select, add and choose rows
of any of them (and of an estimator's state, which may nest them). So no code loops over tracks.

Axes: M plots, N tracks, K own-ship samples. Positions are [east, north] in metres in the
ground-stabilised frame `map`; times are seconds; bearings are radians clockwise from true north.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
FloatArray = NDArray[np.floating[Any]]  # of float32 as well, for the trained networks
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
StrengthArray = NDArray[np.unsignedinteger[Any]]  # of radar video, uint8 or uint16
CodeArray = NDArray[np.int8]  # one of a few named numbers, such as Tracks.status
Numbers = Sequence[float] | Array
HISTORY = 20  # scans of hits and misses that a track remembers, bits of Tracks.history


class OwnShip(NamedTuple):
    """Samples of own ship's motion, in time order; a scan needs at least one.

    time      [K]     s
    position  [K, 2]  m, east and north, of the reference point that ranges are measured from
    velocity  [K, 2]  m/s, east and north, over ground
    heading   [K]     rad, true, as it is told; nan where it is not, None: of no sample
    """

    time: Array
    position: Array
    velocity: Array
    heading: Array | None = None


class PolarPlots(NamedTuple):
    """What the radar measures, one row a plot.

    time       [M]  s, when the beam passed the plot
    range      [M]  m
    bearing    [M]  rad, clockwise from true north
    amplitude  [M]  dB, signal over noise; 0 where the radar does not tell

    None where the radar does not tell:
    radial_speed  [M]        m/s over ground along the line of sight, positive when opening; nan for
                             a plot that does not tell
    covariance    [M, 2, 2]  m^2, east and north, of each plot's place, where a plot is the middle
                             of a cluster of echoes; else the radar's range and bearing sigma count
    """

    time: Array
    range: Array
    bearing: Array
    amplitude: Array
    radial_speed: Array | None = None
    covariance: Array | None = None


class Sector(NamedTuple):
    """A part of a revolution: where the beam began, rad, and how far it turned clockwise, rad, more
    than 0 and at most a whole turn."""

    bearing: float
    angle: float


class Scan(NamedTuple):
    """The plots of one antenna revolution, or a part of one, and own ship's motion during it.

    start, end  s, the time of the revolution; equal where a recording stamps all plots alike
    plots       M plots, in any order
    own_ship    K samples that cover the revolution as well as is known
    radar       which of the tracker's radars it comes from, counted from 0
    antenna     the same K samples of the antenna; None: it is at own ship's reference point
    sector      the part of a revolution that was swept; None: a whole one. Parts follow one another
    unswept     [G, 2]  rad, gaps in it: where each begins, and its width clockwise; None: none
    """

    start: float
    end: float
    plots: PolarPlots
    own_ship: OwnShip
    radar: int = 0
    antenna: OwnShip | None = None
    sector: Sector | None = None
    unswept: Array | None = None

    @property
    def measured_from(self) -> OwnShip:
        """Where the plots were measured from."""
        return self.own_ship if self.antenna is None else self.antenna


class Sweep(NamedTuple):
    """Spokes as a radar sends them, S of them, not yet placed.

    time      [S]     s, when the beam passed
    angle     [S]     rad, clockwise from own ship's bow
    heading   [S]     rad, true, as the radar tells it; nan where it does not
    range     [S]     m, of the end of the last sample; samples are even from 0 on
    strength  [S, B]  uint8 or uint16, the radar's own scale: higher is stronger, 0 is nothing
    """

    time: Array
    angle: Array
    heading: Array
    range: Array
    strength: StrengthArray


class Spokes(NamedTuple):
    """Radar video of a sector: echo strengths along S directions, in the order of the beam.

    A sector is any number of spokes. Sample b of a spoke lies from b to b + 1 range steps.

    time        [S]     s, when the beam passed
    bearing     [S]     rad, clockwise from true north, by the heading of that moment; nan where
                        no heading was known
    range_step  [S]     m, depth of a sample
    strength    [S, B]  uint8 or uint16, the radar's own scale: higher is stronger, 0 is nothing
    own_ship    K samples that cover the sector as well as is known
    """

    time: Array
    bearing: Array
    range_step: Array
    strength: StrengthArray
    own_ship: OwnShip


class Truth(NamedTuple):
    """Where the targets really are, one row a target.

    time      [T]     s
    target    [T]     the scenario's or recording's number of the target
    position  [T, 2]  m, east and north
    velocity  [T, 2]  m/s, east and north; nan where unknown
    """

    time: Array
    target: IntArray
    position: Array
    velocity: Array


class Plots(NamedTuple):
    """Plots as an estimator takes them: the radar's measurement and its Cartesian equivalent.

    time        [M]        s, when the beam passed
    range       [M]        m
    bearing     [M]        rad in [0, 2 pi), clockwise from true north
    amplitude   [M]        dB
    origin      [M, 2]     m, the antenna's position at `time`
    position    [M, 2]     m, east and north, unbiased
    covariance  [M, 2, 2]  m^2, of `position`
    radial_speed  [M]      m/s over ground along the line of sight, positive when opening; nan for
                           a plot that does not tell, None where the radar does not
    """

    time: Array
    range: Array
    bearing: Array
    amplitude: Array
    origin: Array
    position: Array
    covariance: Array
    radial_speed: Array | None = None


class Extrapolation(NamedTuple):
    """Where the tracks are at given times.

    time        [N]        s
    position    [N, 2]     m, east and north
    velocity    [N, 2]     m/s, east and north
    covariance  [N, 4, 4]  of [position, velocity]
    """

    time: Array
    position: Array
    velocity: Array
    covariance: Array


class Tracks(NamedTuple):
    """The tracker's whole memory, one row a track; `state` belongs to the estimator.

    id          [N]  unique from initiation on, never used again
    number      [N]  the ARPA's target number, given at confirmation; 0 while tentative
    status      [N]  one of tracking.lifecycle.TENTATIVE, CONFIRMED, COASTING, LOST, STATIONARY
    history     [N]  bits: bit k tells whether the track had a plot k scans ago
    existence   [N]  probability that there is a target
    age         [N]  scans since its first plot in which the track could be seen
    first_time  [N]  s, first plot
    last_time   [N]  s, last plot
    bearing     [N]  rad from own ship when last swept: tells when the beam will pass again
    state       estimator state, N rows
    radar       [N]  which radar had the last plot; None with one radar
    past        the last updates (tracking.late_plots.Update), the last first; () with one radar
    """

    id: IntArray
    number: IntArray
    status: CodeArray
    history: IntArray
    existence: Array
    age: IntArray
    first_time: Array
    last_time: Array
    bearing: Array
    state: Any
    radar: CodeArray | None = None
    past: tuple[Any, ...] = ()


Rows = TypeVar('Rows', bound=tuple[Any, ...])  # a NamedTuple of arrays, or a tuple of such


def take(rows_of: Rows, rows: IntArray | BoolArray | slice) -> Rows:
    """The chosen rows (indices, mask or slice) of a NamedTuple of arrays, nested ones included.

    A field that is None stays None; so it does with the functions below.
    """
    if isinstance(rows, slice):
        return _map(lambda a: a[rows], rows_of)
    if rows.dtype == bool:
        rows = rows.nonzero()[0]
    parts = [
        take(a, rows) if isinstance(a, tuple) else None if a is None else a.take(rows, 0)
        for a in rows_of
    ]
    return _like(rows_of, parts)


def some(rows_of: Rows, mask: BoolArray) -> Rows:
    """The rows of the mask; where it holds for all, the same arrays again."""
    rows = mask.nonzero()[0]
    return rows_of if len(rows) == len(mask) else take(rows_of, rows)


def append(first: Rows, second: Rows) -> Rows:
    """The rows of `first`, then those of `second`."""
    return _map(lambda *pair: np.concatenate(pair), first, second)


def where(choose_first: BoolArray, first: Rows, second: Rows) -> Rows:
    """Row by row: `first` where the mask [N] holds, else `second`."""

    def one(a: NDArray[Any], b: NDArray[Any]) -> NDArray[Any]:
        return np.where(choose_first.reshape((-1,) + (1,) * (a.ndim - 1)), a, b)

    return _map(one, first, second)


def put(into: Rows, rows: IntArray, new: Rows) -> Rows:
    """A copy of `into` with the named rows replaced by the rows of `new`."""

    def one(a: NDArray[Any], b: NDArray[Any]) -> NDArray[Any]:
        a = a.copy()
        a[rows] = b
        return a

    return _map(one, into, new)


def among(values: IntArray, others: IntArray) -> BoolArray:
    """Mask [N] of the values that are among the others [K]; at once where there are none."""
    if not len(values) or not len(others):
        return np.zeros(len(values), bool)
    return np.isin(values, others)


def row_of(ids: IntArray, wanted: IntArray) -> IntArray:
    """Row [K] in ids [N], all different, of each wanted id [K]; -1 where it is not there."""
    if not len(ids):
        return np.full(len(wanted), -1)
    order = np.argsort(ids)
    place = np.minimum(np.searchsorted(ids, wanted, sorter=order), len(ids) - 1)
    row = order[place]
    return np.where(ids[row] == wanted, row, -1)


def _map(f: Callable[..., NDArray[Any]], *structures: Rows) -> Rows:
    parts = [
        _map(f, *column)
        if isinstance(column[0], tuple)
        else None
        if all(one is None for one in column)
        else f(*column)
        for column in zip(*structures)
    ]
    return _like(structures[0], parts)


def _like(example: Rows, parts: list[Any]) -> Rows:
    """The parts as the tuple that the example is."""
    same: Any = example._make(parts) if hasattr(example, '_make') else tuple(parts)
    return cast(Rows, same)
