"""Parts of a revolution: which tracks the beam has passed, and which plots can be decided.

A radar may send its plots in sectors, several messages a revolution. A track is judged once the
beam has swept all of its gate's window; then its plot is there, or it is a miss. A plot waits while
it may also belong to a track that the beam has not passed yet. What would be judged together in a
whole revolution is judged together here, so the results are the same. Only in crowds, where windows
form long chains, does a track not wait for the whole chain.
"""

import math
from typing import NamedTuple, TypeVar

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..geometry import wrap_angle
from ..types import (
    Array,
    BoolArray,
    IntArray,
    OwnShip,
    Plots,
    PolarPlots,
    Scan,
    Tracks,
    append,
    row_of,
    take,
)
from .gate import Pairs
from .sweep import TURN, Sweep

PATIENCE = 3 / 64  # of a revolution after the beam's passage that a track waits for its neighbours
GAP = 0.5  # of a sector: where more is missing between two of them, a message was lost
HAIR = 1e-6  # rad
Found = tuple[Array, ...]  # what the map of clutter learns from

SomePlots = TypeVar('SomePlots', Plots, PolarPlots)


class Waiting(NamedTuple):
    """What one radar's sectors have left undecided.

    plots   that may belong to tracks that are not swept yet
    own_ship, antenna  samples of the last revolution (see types.Scan)
    id      [K]  tracks, ascending, and
    looked  [K]  s, when the beam passed them the last time that they were judged
    swept   rad, since the revolution began
    end     s, of the last sector
    found   of this revolution, one item a sector
    """

    plots: PolarPlots
    own_ship: OwnShip
    antenna: OwnShip | None
    id: IntArray
    looked: Array
    swept: float
    end: float
    found: tuple[Found, ...]


class Windows(NamedTuple):
    """The windows of N tracks, then of L lone plots, as the beam passes them next.

    pairs   of the gate, with the M plots of the pool
    middle, edge  [N + L] s, when it passes the middle and the far edge
    """

    pairs: Pairs
    middle: Array
    edge: Array


class Decided(NamedTuple):
    """What can be decided now: masks of the tracks [N], lone plots [L] and plots [M]; and of the
    plots [M] that are decided with one track, but may be another's, which is not swept yet."""

    tracks: BoolArray
    lone: BoolArray
    plots: BoolArray
    contested: BoolArray


def begin(scan: Scan) -> Waiting:
    """Nothing waits before the first sector."""
    nothing, ids = np.zeros(0), np.zeros(0, np.int64)
    plots = PolarPlots(nothing, nothing, nothing, nothing)
    own, antenna = scan.own_ship, scan.antenna
    return Waiting(plots, own, antenna, ids, nothing, 0.0, scan.start, ())


def pooled(waiting: Waiting, scan: Scan, period: float) -> Scan:
    """The sector with the plots that wait, and with own ship's samples of the last revolution."""
    since, antenna = scan.end - 1.5 * period, scan.antenna
    if waiting.antenna is not None and antenna is not None:
        antenna = joined(waiting.antenna, antenna, since)
    return scan._replace(
        plots=together(waiting.plots, scan.plots),
        own_ship=joined(waiting.own_ship, scan.own_ship, since),
        antenna=antenna,
    )


def last_looks(waiting: Waiting, ids: IntArray, last_time: Array) -> Array:
    """s [N], when the beam passed the tracks the last time that they were judged; of a new track
    the time of its last plot."""
    return np.where(
        np.isin(ids, waiting.id),
        np.append(waiting.looked, np.nan)[row_of(waiting.id, ids)],
        last_time,
    )


def passage(sweep: Sweep, bearing: Array, looked: Array) -> Array:
    """s [N], when the beam passes the bearings [N] for the first time since `looked` [N] s."""
    ago = sweep.period / TURN * np.mod(sweep.bearing0 - bearing, TURN)
    last: Array = sweep.start + sweep.period - ago
    return np.where(last - looked > 0.5 * sweep.period, last, last + sweep.period)


def windows(
    pairs: Pairs,
    plotted: Array,
    sweep: Sweep,
    passed: Array,
    before: Array,
    bearing: Array,
    half_width: Array,
) -> Windows:
    """The windows of bearings and half widths [N + L] rad; the beam passes the bearings `before`
    [N + L] rad at the times `passed` [N + L] s.

    pairs  of the gate, with plots at the times `plotted` [M] s: those of this passage are kept
    """
    rate = sweep.period / TURN
    middle = passed + rate * wrap_angle(bearing - before)
    near = np.abs(plotted[pairs.plot] - middle[pairs.track]) < 0.5 * sweep.period
    return Windows(take(pairs, near), middle, middle + rate * half_width)


def decide(
    waiting: Waiting, seen: Windows, scan: Scan, pool: PolarPlots, sweep: Sweep, lone: int
) -> Decided:
    """What can be decided now that the beam has come to the end of the sector.

    pool  the M plots; lone: L

    A window that the beam passed while no sector came, because a message is missing, is looked at
    in the next revolution.
    """
    items, plots = len(seen.edge), len(pool.time)
    gone = unseen(waiting, seen, scan)
    pairs = take(seen.pairs, ~gone[seen.pairs.track])
    overdue = scan.end - PATIENCE * sweep.period
    due = ((seen.edge <= scan.end) | (seen.middle <= overdue)) & ~gone
    graph = coo_array(
        (np.ones(len(pairs.track)), (pairs.track, items + pairs.plot)), (items + plots,) * 2
    )
    groups, group = connected_components(graph, directed=False)
    held = np.zeros(groups, bool)
    held[group[:items][~due & ~gone]] = True
    now = due & (~held[group[:items]] | (seen.middle <= overdue))
    wanted = np.zeros(plots, bool)
    wanted[pairs.plot[~now[pairs.track]]] = True
    decided = ~held[group[items:]] | (~wanted & (pool.time <= overdue))
    decided[pairs.plot[now[pairs.track]]] = True
    return Decided(now[: items - lone], now[items - lone :], decided, decided & wanted)


def unseen(waiting: Waiting, seen: Windows, scan: Scan) -> BoolArray:
    """Mask [N + L] of the windows whose middle the beam passed while no sector came."""
    if scan.start - waiting.end < GAP * (scan.end - scan.start):
        return np.zeros(len(seen.middle), bool)
    found: BoolArray = (seen.middle > waiting.end) & (seen.middle < scan.start)
    return found


def remember(
    waiting: Waiting,
    pool: Scan,
    plots: PolarPlots,
    ids: IntArray,
    looked: Array,
    tracks: Tracks,
    found: Found,
) -> Waiting:
    """The memory after a sector.

    pool    of the sector; plots: those that wait
    looked  [N] s, of the tracks `ids` [N] before the sector; tracks: those after it
    found   in this sector
    """
    row = row_of(ids, tracks.id)
    return Waiting(
        plots,
        pool.own_ship,
        pool.antenna,
        tracks.id,
        np.where(row >= 0, np.append(looked, np.nan)[row], tracks.last_time),
        waiting.swept + turned_since(waiting.end, pool),
        pool.end,
        (*waiting.found, found),
    )


def complete(waiting: Waiting) -> bool:
    """Whether the beam has turned once since the revolution began."""
    return waiting.swept >= TURN - HAIR


def found(waiting: Waiting) -> Found:
    """What the map of clutter learns from the revolution."""
    return tuple(np.concatenate(column) for column in zip(*waiting.found))


def next_revolution(waiting: Waiting) -> Waiting:
    """The memory when the next revolution begins."""
    return waiting._replace(swept=rest_of(waiting.swept), found=())


def turned_since(end: float, scan: Scan) -> float:
    """How far the beam turned from `end` s, or the sector's start if that is nan, to its end, rad;
    messages between may be missing."""
    angle = TURN if scan.sector is None else scan.sector.angle
    rate = angle / (scan.end - scan.start)
    return angle if math.isnan(end) else rate * (scan.end - end)


def rest_of(turned: float) -> float:
    """rad, what the beam has turned since the last whole revolution."""
    return turned - TURN * math.floor((turned + HAIR) / TURN)


def together(first: SomePlots, second: SomePlots) -> SomePlots:
    """The plots of both; a radial speed that only one of them has is nan for the other."""
    if not len(first.time) or not len(second.time):
        return second if len(second.time) else first
    if (first.radial_speed is None) != (second.radial_speed is None):
        first, second = (
            plots._replace(radial_speed=np.full(len(plots.time), np.nan))
            if plots.radial_speed is None
            else plots
            for plots in (first, second)
        )
    return append(first, second)


def joined(before: OwnShip, now: OwnShip, since: float = -np.inf) -> OwnShip:
    """The samples of both in time order, none twice; of those before `since` s only the last."""
    if (before.heading is None) != (now.heading is None):
        before, now = before._replace(heading=None), now._replace(heading=None)
    before = take(before, before.time < now.time[0])
    start = max(int(before.time.searchsorted(since)) - 1, 0)
    return append(take(before, slice(start, None)), now)
