"""Cells over the level around them by what the false-alarm rate asks for."""

import numpy as np

from ..types import Array, BoolArray, IntArray, StrengthArray
from . import level, tail
from .stack import Stack

LONE = 2.8  # nepers, 12 dB: a sample so far above both its neighbours in bearing is no echo ...
LEAST_SPOKES = 3.0  # ... where the beam spreads an echo over that many spokes


def decide(
    held: Stack, end: int, known: tail.Tail, full: int, rate: float, blind: int
) -> tuple[Stack, tail.Tail, tail.Thresholds, int]:
    """Decides on the blocks up to `end`: the stack with their hits, the tail with their noise, the
    thresholds, and how many samples were taken for another radar's.

    blind  samples; nearer ones are no echoes
    """
    first = len(held.noise) * held.grid.rows
    held, known, limits = over_threshold(held, end, known, full, rate, blind)
    if held.lobe.shape[0] < LEAST_SPOKES:
        return held, known, limits, 0
    return held, known, limits, _leave_out_lone(held, first, limits.slope)


def over_threshold(
    held: Stack, end: int, known: tail.Tail, full: int, rate: float, blind: int
) -> tuple[Stack, tail.Tail, tail.Thresholds]:
    """The first half of `decide`: the cells over the threshold."""
    ring = level.GUARD_BLOCKS + level.RING_BLOCKS
    begin, rows, samples = len(held.noise), held.grid.rows, held.strength.shape[1]
    around = max(begin - ring, 0)
    zone = tail.zone_of(np.arange(samples))
    if len(known.cells) <= zone[-1]:
        known = tail.start(int(zone[-1]) + 1)
    columns = tail.zone_of(held.grid.centre)
    noise, occupied, spread = level.levels(
        held.grid, held.mean[around:], level.scale(full), known.texture[columns].astype(np.float32)
    )
    known = tail.varied(known, spread, columns, end - begin)
    decided = slice(begin - around, end - around)
    noise, occupied = noise[decided], occupied[decided]
    level_ = level.at_samples(held.grid, noise)
    strength = held.strength[begin * rows : end * rows]

    # One spoke of each block is enough to tell the noise by.
    blocks = np.arange(end - begin)
    drawn = strength[blocks * rows + (begin + blocks) % rows]
    busy = np.repeat(_near(occupied), np.diff(held.grid.edge), axis=1)
    busy[:, :blind] = True
    known = tail.count(known, drawn - level_, ~busy, zone, full)

    limits = tail.thresholds(known, rate, full, samples)
    threshold = np.ceil(level_ + limits.over.astype(np.float32))
    threshold[:, :blind] = full + 1
    beyond = threshold > full
    limit = np.clip(threshold, 1, full).astype(strength.dtype)
    hits = strength.reshape(-1, rows, samples) >= limit[:, None]
    hits &= ~beyond[:, None]
    hits = hits.reshape(-1, samples)
    held.hits[begin * rows : end * rows] = hits[: len(held.hits) - begin * rows]
    return held._replace(noise=np.concatenate([held.noise, noise])), known, limits


def _near(occupied: BoolArray) -> BoolArray:
    """Blocks that hold an echo, and those beside them."""
    near = occupied.copy()
    near[1:] |= occupied[:-1]
    near[:-1] |= occupied[1:]
    across = near.copy()
    near[:, 1:] |= across[:, :-1]
    near[:, :-1] |= across[:, 1:]
    return near


def _leave_out_lone(held: Stack, first: int, slope: Array) -> int:
    """Takes hits from row `first` on back that are alone in their spoke; how many.

    Another radar's pulse is there in one spoke only. An echo is as wide as the beam. Its strength
    is brought down to that of the neighbours, so that it moves no plot.
    """
    row, sample = np.nonzero(held.hits[first:])
    row += first
    strength = held.strength
    value = strength[row, sample].astype(np.int64)
    last = len(strength) - 1
    beside = np.maximum(
        strength[np.maximum(row - 1, 0), sample], strength[np.minimum(row + 1, last), sample]
    )
    lone = (value - beside > LONE * slope[sample]) & (row > 0) & (row < last)
    row, sample = row[lone], sample[lone]
    held.hits[row, sample] = False
    strength[row, sample] = beside[lone]
    return len(row)


def noise_at(held: Stack, row: IntArray, sample: IntArray) -> Array:
    """[n] location of the noise about cells."""
    of = held.grid
    block = np.minimum(row // of.rows, len(held.noise) - 1)
    low, high = held.noise[block, of.left[sample]], held.noise[block, of.right[sample]]
    return low + of.share[sample] * (high - low)


def power_at(
    held: Stack, row: IntArray, sample: IntArray, limits: tail.Thresholds
) -> tuple[Array, StrengthArray]:
    """ln of power over noise, and strength, of cells."""
    value = held.strength[row, sample]
    noise = noise_at(held, row, sample) + limits.origin[sample]
    return (value + 0.5 - noise) / limits.slope[sample], value
