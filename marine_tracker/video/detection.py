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
    return held, known, limits, _leave_out_lone(held, first, limits)


def over_threshold(
    held: Stack, end: int, known: tail.Tail, full: int, rate: float, blind: int
) -> tuple[Stack, tail.Tail, tail.Thresholds]:
    """The first half of `decide`: the cells over the threshold."""
    ring = level.GUARD_BLOCKS + level.RING_BLOCKS
    begin, rows, samples = len(held.noise), held.grid.rows, held.strength.shape[1]
    around = max(begin - ring, 0)
    columns = tail.zone_of(held.grid.centre)
    if len(known.texture) <= columns[-1]:
        known = tail.start(int(columns[-1]) + 1)
    noise, scatter, occupied, spread = level.levels(
        held.grid,
        held.mean[around:],
        held.square[around:],
        level.scale(full),
        known.texture[columns].astype(np.float32),
    )
    known = tail.varied(known, spread, columns, end - begin)
    decided = slice(begin - around, end - around)
    noise, occupied, kind = noise[decided], occupied[decided], tail.class_of(scatter[decided])
    level_ = level.at_samples(held.grid, noise)
    strength = held.strength[begin * rows : end * rows]

    # One spoke of each block is enough to tell the noise by.
    blocks = np.arange(end - begin)
    drawn = strength[blocks * rows + (begin + blocks) % rows]
    free = ~_near(occupied)
    free[:, held.grid.edge[:-1] < blind] = False
    known = tail.count(known, drawn - level_, free, kind, held.grid, full)

    limits = tail.thresholds(known, rate, full, samples)
    over = limits.over[kind, held.grid.centre.astype(np.int64)].astype(np.float32)
    threshold = np.ceil(level_ + level.at_samples(held.grid, over))
    threshold[:, :blind] = full + 1
    beyond = threshold > full
    limit = np.clip(threshold, 1, full).astype(strength.dtype)
    hits = strength.reshape(-1, rows, samples) >= limit[:, None]
    hits &= ~beyond[:, None]
    hits = hits.reshape(-1, samples)
    held.hits[begin * rows : end * rows] = hits[: len(held.hits) - begin * rows]
    held = held._replace(
        noise=np.concatenate([held.noise, noise]), kind=np.concatenate([held.kind, kind])
    )
    return held, known, limits


def _near(occupied: BoolArray) -> BoolArray:
    """Blocks that hold an echo, and those beside them."""
    near = occupied.copy()
    near[1:] |= occupied[:-1]
    near[:-1] |= occupied[1:]
    across = near.copy()
    near[:, 1:] |= across[:, :-1]
    near[:, :-1] |= across[:, 1:]
    return near


def _leave_out_lone(held: Stack, first: int, limits: tail.Thresholds) -> int:
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
    slope = limits.slope[kind_at(held, row, sample), sample]
    lone = (value - beside > LONE * slope) & (row > 0) & (row < last)
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


def kind_at(held: Stack, row: IntArray, sample: IntArray) -> IntArray:
    """[n] class of the noise about cells."""
    block = np.minimum(row // held.grid.rows, len(held.kind) - 1)
    return held.kind[block, held.grid.column[sample]]


def power_at(
    held: Stack, row: IntArray, sample: IntArray, limits: tail.Thresholds
) -> tuple[Array, StrengthArray, Array]:
    """ln of power over noise, strength, and steps in a factor e of power, of cells."""
    value, kind = held.strength[row, sample], kind_at(held, row, sample)
    slope = limits.slope[kind, sample]
    noise = noise_at(held, row, sample) + limits.origin[kind, sample]
    return (value + 0.5 - noise) / slope, value, slope
