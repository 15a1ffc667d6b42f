"""How far noise and clutter reach above their level: the threshold for a false-alarm rate.

The strengths of cells without echoes are counted by how far they lie above the local level, in
zones of range. The upper tail of the counts is a Weibull tail in power: ln(-ln P) is a straight
line over the strength. The line through the tail between P = 0.01 and 0.0005 is prolonged to the
rate that is asked for. It is exact for receiver noise and Weibull clutter, and within a factor of 2
at 1e-6 for K-distributed clutter of any shape. It needs no scale of the strengths.

Source: Ward, Tough, Watts, Sea Clutter, 2nd ed., 9.2 (tails of Weibull and K clutter).
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, BoolArray, FloatArray, IntArray
from .level import scale

BINS = 256  # of strength above the level
UPPER, LOWER = 0.01, 0.0005  # probabilities between which the tail is fitted
ENOUGH = 40.0  # cells above, for a probability to be read
FAR = 3.6  # nepers above the level: farther up are echoes and other radars; noise never is, and
# the spikes of the sea hardly ever
MEMORY = 1.0e7  # cells; older counts fade beyond that many
PRIOR = 300.0  # cells: weight of the exponential tail that is assumed to begin with
MOST_TEXTURE = 3.0
LEAST_SLOPE = 0.4  # of the assumed one: no radar shows more than 150 dB
POOLED = 1000.0  # cells: weight of the tail of all zones in that of each


class Tail(NamedTuple):
    """What is known of noise and clutter in Z zones: octaves of range in samples.

    above    [Z, BINS]  cells by how far they lie above the level
    cells    [Z]        cells counted
    texture  [Z]        by how much the level of clutter differs from place to place, over what
                        noise alone would give; a running median, at least 1
    """

    above: Array
    cells: Array
    texture: Array


class Thresholds(NamedTuple):
    """By sample [B], all in steps of strength above the level.

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


def start(zones: int) -> Tail:
    """Nothing counted yet."""
    return Tail(np.zeros((zones, BINS)), np.zeros(zones), np.ones(zones))


def count(tail: Tail, above: FloatArray, free: BoolArray, zone: IntArray, full: int) -> Tail:
    """The tail with more cells.

    above  [R, B]  steps of their strengths above the level
    free   [R, B]  those that hold no echo; the others are not counted
    zone   [B]
    """
    zones = len(tail.cells)
    cells = np.bincount(zone, free.sum(0), zones)
    inside = np.flatnonzero(free & (above >= 0) & (above < FAR * scale(full)))
    bins = (above.ravel().take(inside) * (BINS / (full + 1))).astype(np.int64)
    at = (zone * BINS).take(inside % len(zone))
    counts = np.bincount(at + np.minimum(bins, BINS - 1), minlength=zones * BINS)
    keep = MEMORY / np.maximum(tail.cells + cells, MEMORY)
    return tail._replace(
        above=(tail.above + counts.reshape(zones, BINS)) * keep[:, None],
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
    zones, width = len(tail.cells), (full + 1) / BINS
    edge = np.arange(BINS, dtype=np.float64) * width
    prior = np.exp(-np.exp(edge / scale(full)))
    pooled = _survival(tail.above.sum(0), tail.cells.sum(), prior, PRIOR)
    over, origin, slope = np.empty((3, zones))
    for zone in range(zones):
        survival = _survival(tail.above[zone], tail.cells[zone], pooled, POOLED)
        cells = tail.cells[zone] + POOLED
        over[zone], origin[zone], slope[zone] = _line(edge, survival, cells, rate, full)
    octave = np.log2(np.arange(samples) + 1.0) - 3.5
    at = [np.interp(octave, np.arange(zones), values) for values in (over, origin, slope)]
    return Thresholds(*at)


def _survival(above: Array, cells: float, prior: FloatArray, weight: float) -> FloatArray:
    """P(at least so far above the level) by bin, with a prior that counts as `weight` cells."""
    beyond = np.cumsum(above[::-1])[::-1]
    return (beyond + weight * prior) / (cells + weight)


def _line(edge: Array, survival: FloatArray, cells: float, rate: float, full: int) -> Array:
    """Threshold, origin and slope from one zone's tail."""
    high = min(UPPER, 0.5 * survival[0])
    low = max(LOWER, ENOUGH / cells)
    if low > 0.3 * high:
        low = 0.3 * high
    logs = np.log(np.maximum(survival, 1e-300))
    # Probabilities fall along the edges; between two edges their logarithm is straight.
    at = np.interp(-np.log([high, low]), -logs, edge)
    reach = np.log(-np.log([high, low]))
    slope = (at[1] - at[0]) / (reach[1] - reach[0])
    slope = max(slope, LEAST_SLOPE * scale(full))
    wanted = np.log(-np.log(rate))
    if rate >= low:
        over = float(np.interp(-np.log(rate), -logs, edge))
    else:
        over = at[1] + slope * (wanted - reach[1])
    return np.array([over, at[1] - slope * reach[1], slope])
