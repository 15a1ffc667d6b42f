"""How far noise and clutter reach above their level: the threshold for a false-alarm rate.

The strengths of cells without echoes are counted by how far they lie above the local level, in
zones of range, and in each by classes of how far the cells around scatter: a shower reaches less
far above its level than the sea of the same range. The upper tail of the counts is a Weibull tail
in power: ln(-ln P) is a straight line over the strength. The line through the tail between P = 0.01
and 0.0005 is prolonged to the rate that is asked for. It is exact for receiver noise and Weibull
clutter, and within a factor of 2 at 1e-6 for K-distributed clutter of any shape. It needs no scale
of the strengths.

Source: Ward, Tough, Watts, Sea Clutter, 2nd ed., 9.2 (tails of Weibull and K clutter).
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, BoolArray, FloatArray, IntArray
from .level import Grid, scale

BINS = 256  # of strength above the level
EDGES = (1.12, 1.3, 1.55, 1.9)  # of classes: scatter of the cells around over that of noise
CLASSES = len(EDGES) + 1
UPPER, LOWER = 0.01, 0.0005  # probabilities between which the tail is fitted
ENOUGH = 40.0  # cells above, for a probability to be read
FAR = 3.6  # nepers above the level: farther up are echoes and other radars; noise never is, and
# the spikes of the sea hardly ever
MEMORY = 1.0e7  # cells; older counts fade beyond that many
PRIOR = 300.0  # cells: weight of the exponential tail that is assumed to begin with
MOST_TEXTURE = 3.0
LEAST_SLOPE = 0.4  # of the assumed one: no radar shows more than 150 dB
POOLED = 1000.0  # cells: weight of the tail of all zones in that of each
SHARED = 20000.0  # cells: weight of the tail of a zone in that of each of its classes


class Tail(NamedTuple):
    """What is known of noise and clutter in Z zones, octaves of range in samples, and CLASSES of
    scatter.

    above    [Z, CLASSES, BINS]  cells by how far they lie above the level
    cells    [Z, CLASSES]        cells counted
    texture  [Z]        by how much the level of clutter differs from place to place, over what
                        noise alone would give; a running median, at least 1
    """

    above: Array
    cells: Array
    texture: Array


class Thresholds(NamedTuple):
    """By class of scatter and sample [CLASSES, B], all in steps of strength above the level.

    over    what a cell must reach
    origin  the location, and
    slope   steps in a factor e of power, of the noise as the tail tells them
    """

    over: Array
    origin: Array
    slope: Array


def zone_of(sample: Array | IntArray) -> IntArray:
    """The zone of a sample: its octave, 0 to 3 of the nearest eight samples together."""
    return np.maximum(np.log2(np.maximum(sample, 1)).astype(np.int64) - 3, 0)


def class_of(scatter: FloatArray) -> IntArray:
    """The class of a scatter (level.levels)."""
    return np.digitize(scatter, EDGES)


def start(zones: int) -> Tail:
    """Nothing counted yet."""
    return Tail(np.zeros((zones, CLASSES, BINS)), np.zeros((zones, CLASSES)), np.ones(zones))


def count(
    tail: Tail, above: FloatArray, free: BoolArray, kind: IntArray, of: Grid, full: int
) -> Tail:
    """The tail with more cells.

    above  [R, B]  steps of their strengths above the level
    free   [R, C]  columns that hold no echo; the others are not counted
    kind   [R, C]  class of the scatter around
    """
    which = zone_of(of.centre) * CLASSES + kind
    wide = np.diff(of.edge)
    cells = np.bincount(which.ravel(), (free * wide).ravel(), tail.cells.size)
    limit = np.where(free, np.float32(FAR * scale(full)), np.float32(0)).repeat(wide, axis=1)
    inside = np.flatnonzero((above >= 0) & (above < limit))
    bins = (above.ravel().take(inside) * (BINS / (full + 1))).astype(np.int64)
    row, sample = np.divmod(inside, above.shape[1])
    at = which[row, of.column[sample]] * BINS + np.minimum(bins, BINS - 1)
    counts = np.bincount(at, minlength=tail.above.size)
    cells = cells.reshape(tail.cells.shape)
    keep = MEMORY / np.maximum(tail.cells + cells, MEMORY)
    return tail._replace(
        above=(tail.above + counts.reshape(tail.above.shape)) * keep[..., None],
        cells=(tail.cells + cells) * keep,
    )


def varied(tail: Tail, spread: FloatArray, zone: IntArray, blocks: int) -> Tail:
    """The tail after so many blocks of spokes in which the level differed by `spread` [C].

    The running median goes a step towards what is seen, so a shore in a few directions does not
    count. zone [C] of each.
    """
    zones = len(tail.cells)
    number = np.bincount(zone, minlength=zones)
    seen = np.bincount(zone, spread, zones) / np.maximum(number, 1)
    step = np.exp(np.sign(seen - tail.texture) * min(0.005 * blocks, 0.2))
    texture = np.clip(tail.texture * np.where(number > 0, step, 1.0), 1.0, MOST_TEXTURE)
    return tail._replace(texture=texture)


def thresholds(tail: Tail, rate: float, full: int, samples: int) -> Thresholds:
    """What to reach for the false-alarm rate `rate`; straight between the middles of zones."""
    zones = len(tail.texture)
    edge = np.arange(BINS, dtype=np.float64) * ((full + 1) / BINS)
    noise: Array = np.exp(-np.exp(edge / scale(full)))
    every = _survival(tail.above.sum((0, 1)), tail.cells.sum(), noise, PRIOR)
    cells = tail.cells.sum(1)
    zone = _survival(tail.above.sum(1), cells, every, POOLED)
    survival = _survival(tail.above, tail.cells, zone[:, None], SHARED)
    lines = _lines(edge, survival, cells[:, None] + POOLED, rate, full)
    octave = np.log2(np.arange(samples) + 1.0) - 3.5
    low = np.clip(octave.astype(np.int64), 0, zones - 1)
    high = np.minimum(low + 1, zones - 1)
    share = np.clip(octave - low, 0.0, 1.0)
    found = [(a[low] + share[:, None] * (a[high] - a[low])).T for a in lines]
    return Thresholds(*found)


def _survival(above: Array, cells: Array, prior: Array, weight: float) -> Array:
    """[..., BINS] P(at least so far above the level), with a prior that counts as `weight` cells,
    of counts [..., BINS] of so many cells [...]."""
    beyond = np.cumsum(above[..., ::-1], axis=-1)[..., ::-1]
    found: Array = (beyond + weight * prior) / (np.asarray(cells)[..., None] + weight)
    return found


def _lines(
    edge: Array, survival: Array, cells: Array, rate: float, full: int
) -> tuple[Array, Array, Array]:
    """Threshold, origin and slope [...] from tails [..., BINS]."""
    high = np.minimum(UPPER, 0.5 * survival[..., 0])
    low = np.minimum(np.maximum(LOWER, ENOUGH / cells), 0.3 * high)
    logs = np.log(np.maximum(survival, 1e-300))
    first, last = _where(edge, logs, high), _where(edge, logs, low)
    far, near = np.log(-np.log(low)), np.log(-np.log(high))
    slope = np.maximum((last - first) / (far - near), LEAST_SLOPE * scale(full))
    beyond = last + slope * (np.log(-np.log(rate)) - far)
    over = np.where(rate >= low, _where(edge, logs, np.full_like(low, rate)), beyond)
    return over, last - slope * far, slope


def _where(edge: Array, logs: Array, probability: Array) -> Array:
    """[...] where tails with logarithms [..., BINS] fall to a probability [...]; these are straight
    between two edges."""
    wanted = np.log(probability)[..., None]
    right = np.clip((logs >= wanted).sum(-1, keepdims=True), 1, BINS - 1)
    above, below = (np.take_along_axis(logs, at, -1) for at in (right - 1, right))
    share = np.clip((above - wanted) / np.maximum(above - below, 1e-12), 0.0, 1.0)
    found: Array = edge[right] - (1 - share) * edge[1]
    return found[..., 0]
