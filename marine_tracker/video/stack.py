"""The spokes that are being worked on: the newest ones, of one scale and without a gap."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import wrap_angle
from ..types import Array, BoolArray, FloatArray, IntArray, Spokes, StrengthArray, take
from . import level
from .lobes import Lobe, lobe

FIRST = 48  # spokes that tell how far apart spokes are
MISSING = 3.5  # spokes left out before a gap ends the stack, beside
JITTER = np.radians(1.5)  # that a heading may jump from spoke to spoke
FULL = (15, 255, 4095, 65535)  # greatest strengths of radars


class Stack(NamedTuple):
    """R spokes, B samples; the first blocks of them are decided.

    time, bearing  [R]        s; rad, without jumps at north
    strength       [R, B]
    hits           [R, B]     cells over their threshold, not yet part of a plot
    mean, square   [M, C]     of the whole blocks among the spokes (level.block_means)
    noise, kind    [D, C]     location and class of the noise in the decided ones
    range_step     m; spacing rad, nan until there are FIRST spokes
    """

    time: Array
    bearing: Array
    strength: StrengthArray
    hits: BoolArray
    mean: FloatArray
    square: Array
    noise: FloatArray
    kind: IntArray
    range_step: float
    spacing: float
    grid: level.Grid
    lobe: Lobe


NO_GRID = level.of_edges(1, np.array([0, 1]))
NO_LOBE = Lobe(np.ones(2))


def runs(spokes: Spokes) -> Iterator[Spokes]:
    """The spokes in runs of one scale, without those that have no bearing."""
    spokes = _rows(spokes, np.isfinite(spokes.bearing))
    if not len(spokes.time):
        return
    turn = wrap_angle(np.diff(spokes.bearing))
    usual = max(float(np.median(turn)), 1e-5) if len(turn) else np.inf
    apart = (np.diff(spokes.range_step) != 0) | ~_goes_on(turn, usual)
    edge = [0, *(np.flatnonzero(apart) + 1).tolist(), len(spokes.time)]
    for first, last in zip(edge, edge[1:]):
        yield _rows(spokes, slice(first, last))


def _rows(spokes: Spokes, rows: slice | BoolArray) -> Spokes:
    own_ship = spokes.own_ship
    first = (spokes.time, spokes.bearing, spokes.range_step, spokes.strength)
    return Spokes(*take(first, rows), own_ship)


def _goes_on(turn: Array, usual: float) -> BoolArray:
    """Whether a spoke so many rad farther on is the next one: a heading that is told in steps moves
    it to and fro."""
    good: BoolArray = (turn > -JITTER - usual / 2) & (turn < MISSING * usual + JITTER)
    return good


def follows(stack: Stack, run: Spokes) -> bool:
    """Whether the run goes on where the stack ends."""
    same = (
        stack.range_step == run.range_step[0]
        and stack.strength.shape[1] == run.strength.shape[1]
        and stack.strength.dtype == run.strength.dtype
    )
    spacing = stack.spacing
    if np.isnan(spacing):
        turns = np.diff(stack.bearing)
        spacing = float(np.median(turns)) if len(turns) else np.inf
    gap = wrap_angle(float(run.bearing[0] - stack.bearing[-1]))
    return bool(
        same
        and _goes_on(np.array(gap), max(spacing, 1e-5))
        and run.time[0] >= stack.time[-1] - 1e-6
    )


def begun(run: Spokes) -> Stack:
    """A stack of this run alone."""
    none = np.zeros((0, 0), np.float32)
    return Stack(
        run.time,
        np.unwrap(run.bearing),
        run.strength,
        np.zeros(run.strength.shape, bool),
        none,
        none.astype(np.float64),
        none,
        none.astype(np.int64),
        float(run.range_step[0]),
        np.nan,
        NO_GRID,
        NO_LOBE,
    )


def longer(stack: Stack, run: Spokes) -> Stack:
    """The stack with the run behind it."""
    last = stack.bearing[-1]
    bearing = last + wrap_angle(run.bearing[:1] - last) + np.unwrap(run.bearing) - run.bearing[0]
    return stack._replace(
        time=np.concatenate([stack.time, run.time]),
        bearing=np.concatenate([stack.bearing, bearing]),
        strength=np.concatenate([stack.strength, run.strength]),
        hits=np.concatenate([stack.hits, np.zeros(run.strength.shape, bool)]),
    )


def measured(stack: Stack, beam: float, pulse: float, final: bool) -> Stack:
    """The stack with the means of its whole blocks; and first with its blocks, when there are
    spokes enough to tell how far apart they are.

    final  no spoke follows: the last block is filled up with its last spoke
    """
    if np.isnan(stack.spacing):
        if len(stack.time) < FIRST and not final:
            return stack
        turns = np.diff(stack.bearing)
        spacing = max(float(np.median(turns)), 1e-4) if len(turns) else 2 * np.pi / 2048
        samples = stack.strength.shape[1]
        of = lobe(spacing, stack.range_step, beam, pulse)
        blocks = level.grid(samples, stack.range_step, spacing, beam, pulse)
        none = np.zeros((0, len(blocks.centre)), np.float32)
        stack = stack._replace(spacing=spacing, grid=blocks, lobe=of, mean=none, noise=none)
        stack = stack._replace(square=none.astype(np.float64), kind=none.astype(np.int64))
    rows, count = stack.grid.rows, len(stack.time)
    odd = -count % rows
    if final and odd:
        last = slice(count - 1, count)
        stack = stack._replace(
            strength=np.concatenate([stack.strength, stack.strength[last].repeat(odd, 0)]),
            hits=np.concatenate([stack.hits, stack.hits[last].repeat(odd, 0)]),
        )
        count += odd
    known, whole = len(stack.mean), count // rows
    if whole > known:
        mean, square = level.block_means(stack.grid, stack.strength[known * rows : whole * rows])
        stack = stack._replace(
            mean=np.concatenate([stack.mean, mean]), square=np.concatenate([stack.square, square])
        )
    return stack


def trimmed(stack: Stack, first: int) -> Stack:
    """The stack without what lies before row `first`, in whole blocks, and with what the level of
    the next block needs."""
    rows = stack.grid.rows
    ring = level.GUARD_BLOCKS + level.RING_BLOCKS
    blocks = min(max(first, 0) // rows, max(len(stack.noise) - ring, 0))
    if blocks <= 0:
        return stack
    cut = blocks * rows
    return stack._replace(
        time=stack.time[cut:],
        bearing=stack.bearing[cut:],
        strength=stack.strength[cut:],
        hits=stack.hits[cut:],
        mean=stack.mean[blocks:],
        square=stack.square[blocks:],
        noise=stack.noise[blocks:],
        kind=stack.kind[blocks:],
    )


def full_scale(strength: StrengthArray, least: int) -> int:
    """The greatest strength that the radar can tell, by what it has told so far."""
    top = max(int(strength.max(initial=0)), least)
    return next(full for full in FULL if full >= top)


Labels = NDArray[np.int32]
