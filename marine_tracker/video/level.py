"""The level of noise and clutter around each cell of radar video.

Strengths are display values: mostly the logarithm of power, after the radar's own gain and clutter
controls, cut off at 0. The scale is not known, so nothing here depends on it. Spokes and samples
are put into blocks. The level of a block comes from the mean of the blocks around it, on the side
where it is greatest, and without those that hold an echo. Sea near own ship, rain and land so get
their own level.

Where noise has exponential power, its logarithm is s times a Gumbel variable plus a location u.
The mean of what is left of it above 0 gives u, even where most of it is cut off.

Sources: Skolnik, Radar Handbook, 3rd ed., 7.4 (cell averaging, greatest of, censoring); Goldstein,
"False-alarm regulation in log-normal and Weibull clutter", IEEE T-AES 9(1), 1973.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from ..types import Array, BoolArray, FloatArray, IntArray, StrengthArray

DYNAMIC_NEPERS = 13.8  # of power, 60 dB: what a radar's scale is taken to span, to begin with
GUARD_M = 40.0  # m: echoes that long do not raise their own level
SHIP_M = 100.0  # m: half of a long ship
RING_BLOCKS = 4  # depth of the ring of blocks beyond the guard
GUARD_BLOCKS = 2
OCCUPIED = 4.0  # deviations of a block's mean above the level, from which it holds an echo
LEAST_OFFSET = -1.7  # lowest u / s that is told from a mean: 0.5 % of cells above 0


class Grid(NamedTuple):
    """Blocks of spokes and samples; C columns of samples.

    rows      spokes in a block
    edge      [C + 1]  first sample of each column; the last one is the number of samples
    centre    [C]      samples, the middle of each column
    left, right, share  [B]  of each sample, the columns on both sides of its middle, and how far it
                             is on the way
    column    [B]      of each sample, the column that it lies in
    close     [C]      a ship may be wider than what is looked at beside a block
    """

    rows: int
    edge: IntArray
    centre: Array
    left: IntArray
    right: IntArray
    share: Array
    column: IntArray
    close: BoolArray

    @property
    def cells(self) -> FloatArray:
        """[C] number of cells in a block."""
        return (self.rows * np.diff(self.edge)).astype(np.float32)


def grid(samples: int, range_step: float, spacing: float, beam: float, pulse: float) -> Grid:
    """Blocks for spokes of `samples` samples of `range_step` m, `spacing` rad apart.

    beam rad and pulse m are the radar's. Near own ship columns are narrower, as the level there
    falls steeply with range.
    """
    rows = int(np.clip(round(0.5 * beam / spacing), 1, 16))
    widest = int(np.clip(max(GUARD_M / 2, pulse) / range_step, 8, max(samples // 16, 8)))
    edges = [0]
    while edges[-1] < samples:
        edges.append(edges[-1] + int(np.clip(edges[-1] // 8, 2, widest)))
    edges[-1] = samples
    beside = (GUARD_BLOCKS + RING_BLOCKS) * rows * spacing * range_step
    return of_edges(rows, np.array(edges), SHIP_M / beside)


def of_edges(rows: int, edge: IntArray, wide: float = 0.0) -> Grid:
    """Blocks of so many spokes, with columns at these edges; before the sample `wide` a ship is
    wider than what is looked at beside a block."""
    centre = (edge[:-1] + edge[1:]).astype(np.float64) / 2
    sample = np.arange(edge[-1])
    last = len(centre) - 1
    right = np.clip(np.searchsorted(centre, sample + 0.5), min(1, last), last)
    left = np.maximum(right - 1, 0)
    apart = np.maximum(centre[right] - centre[left], 1e-9)
    share = np.clip((sample + 0.5 - centre[left]) / apart, 0.0, 1.0)
    column = np.repeat(np.arange(last + 1), np.diff(edge))
    return Grid(rows, edge, centre, left, right, share, column, centre < wide)


def block_means(of: Grid, strength: StrengthArray) -> tuple[FloatArray, Array]:
    """Means [blocks, C] of the strength and of its square; a strength v stands for the values from
    v to v + 1."""
    spokes = strength.reshape(-1, of.rows, strength.shape[1])
    kind, wide = (np.uint16, np.uint32) if strength.dtype == np.uint8 else (np.uint32, np.uint64)
    total = spokes.sum(1, dtype=kind)
    square = np.multiply(spokes, spokes, dtype=kind).sum(1, dtype=wide)
    # A strength v above 0 lies half a step above v, and 0 is one step below the first.
    above = np.add(spokes > 0, 0, dtype=np.uint8).sum(1, dtype=np.uint8)
    value = total - np.float32(0.5) * above
    mean = np.add.reduceat(value, of.edge[:-1], axis=1) / of.cells
    as_told = np.add.reduceat(total, of.edge[:-1], axis=1, dtype=np.float64) / of.cells
    within = np.add.reduceat(square, of.edge[:-1], axis=1) / of.cells - as_told**2
    return mean, within + np.square(mean, dtype=np.float64)


def scale(full: int) -> float:
    """Steps of the strength in a factor e of power, as assumed until the tail is known."""
    return (full + 1) / DYNAMIC_NEPERS


def levels(
    of: Grid, mean: FloatArray, square: Array, step: float, texture: FloatArray
) -> tuple[FloatArray, FloatArray, BoolArray, FloatArray]:
    """Location [blocks, C] of the noise around each block, how far [blocks, C] its cells scatter,
    over what noise of exponential power would, which blocks hold an echo, and by how much [C] the
    means of blocks differ, over what noise alone would give.

    mean, square  [blocks, C]  from block_means; step: steps in a factor e of power
    texture       [C]          how much they usually differ, at least 1
    """
    reach = GUARD_BLOCKS + RING_BLOCKS
    cells = np.broadcast_to(of.cells, mean.shape)
    count = len(mean)
    every = np.arange(count + 1.0)[:, None] * np.append(0.0, np.cumsum(of.cells, dtype=np.float64))
    # A ship close by fills all that is beside it: what may be an echo is told by range alone.
    first = _around(_integral(mean * cells), every, ~of.close)
    residual = mean - first
    noise = np.float32(1.28 * step) / np.sqrt(of.cells)
    occupied = residual > OCCUPIED * texture * noise
    free = np.where(occupied, np.float32(0), cells)
    left, sums = _integral(free), _integral(mean * free)
    level = _around(sums, left, np.ones(len(of.cells), bool))
    # Where hardly anything is free, as on land, its own level counts.
    box, all_, total, squares = (
        _columns(_rows(a, reach), -reach, reach)
        for a in (left, every, sums, _integral(square * free))
    )
    few = box < 0.25 * all_
    box = np.maximum(box, 1.0)
    variance = squares / box - (total / box) ** 2
    scatter = np.sqrt(np.maximum(variance, 0.0), dtype=np.float32) / np.float32(1.28 * step)
    level = np.where(few, np.maximum(level, first), level)
    # From the lower half alone: echoes lie in the upper one.
    some = np.ascontiguousarray(residual[:: 2 if count > 8 else 1].T)
    count = some.shape[1]
    ranked = np.partition(some, (count // 4, count // 2), axis=1)
    spread = 1.48 * (ranked[:, count // 2] - ranked[:, count // 4]) / noise
    return location(level / step) * np.float32(step), scatter, occupied, spread


def _around(total: Array, cells: Array, with_sides: BoolArray) -> FloatArray:
    """Mean in the ring around each block, on the nearer or farther side: the greater one.

    total, cells  [blocks + 1, C + 1]  integrals (_integral) of the sums and numbers of cells
    with_sides    [C]  whether what is beside a block in bearing counts, too
    """
    guard, reach = GUARD_BLOCKS, GUARD_BLOCKS + RING_BLOCKS
    parts = []
    for a in (total, cells):
        wide = _rows(a, reach)
        beside = _columns(wide - _rows(a, guard), -guard, guard) * with_sides
        near, far = _columns(wide, -reach, -guard - 1), _columns(wide, guard + 1, reach)
        parts.append((beside + near, beside + far))
    sides = [sums / np.maximum(counts, 1) for sums, counts in zip(*parts)]
    return np.maximum(*sides).astype(np.float32)


def _integral(a: FloatArray) -> Array:
    """[R + 1, C + 1] sums of all rows and columns before each."""
    found = np.zeros((a.shape[0] + 1, a.shape[1] + 1))
    np.cumsum(a, axis=0, out=found[1:, 1:])
    np.cumsum(found[1:, 1:], axis=1, out=found[1:, 1:])
    return found


def _rows(integral: Array, half: int) -> Array:
    """[R, C + 1] what the rows within `half` of each row add to an integral."""
    count = len(integral) - 1
    at = np.arange(count)
    last, first = np.minimum(at + half + 1, count), np.maximum(at - half, 0)
    return integral.take(last, 0) - integral.take(first, 0)


def _columns(rows: Array, low: int, high: int) -> Array:
    """[R, C] sums over the columns from `low` to `high` beside each column."""
    first, last = _ends(rows.shape[1] - 1, low, high)
    return rows.take(last, 1) - rows.take(first, 1)


@cache
def _ends(count: int, low: int, high: int) -> tuple[IntArray, IntArray]:
    """Where the sums over columns begin and end, of `count` columns."""
    at = np.arange(count)
    return np.clip(at + low, 0, count), np.clip(at + high + 1, 0, count)


def _clipped_means() -> tuple[Array, Array]:
    """u and the mean of max(u + g, 0) for g = ln(E), E exponential of mean 1; the integral of
    exp(-exp(t)) from -u on."""
    t = np.arange(-60.0, 4.0, 1e-3)
    survival = np.exp(-np.exp(t))
    above = np.cumsum(survival[::-1])[::-1] * 1e-3
    offset = np.linspace(LEAST_OFFSET, 50.0, 4000)
    return offset, np.interp(-offset, t, above)


_OFFSET, _MEAN = _clipped_means()


def location(mean: FloatArray) -> FloatArray:
    """u of the noise whose values cut off at 0 have this mean, all in steps s."""
    beyond = np.maximum(mean - _MEAN[-1], 0)  # a scale far above its noise
    return (np.interp(mean, _MEAN, _OFFSET) + beyond).astype(np.float32)


def at_samples(of: Grid, values: FloatArray) -> FloatArray:
    """[blocks, samples]: values [blocks, C] of blocks, straight between their middles."""
    low = values.take(of.left, 1)
    return low + of.share.astype(np.float32) * (values.take(of.right, 1) - low)
