"""Tracks on places where plots always are: which are targets, and which are a place.

A track that never moved, on an established place in a crowd of such places, is STATIONARY: it is
shown as that place, by one number, however often the track itself is lost and begun again. One that
stands alone, as an anchored ship or a buoy, stays a target, and if its track is lost for a while,
its place is still shown by its number. A track that has moved is a target and stays one: a ship
that stops, anchors, or goes alongside. A stationary one that moves becomes a target with the number
of its place, which is forgotten: a ship that leaves its berth.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, BoolArray, Extrapolation, IntArray, Tracks, append, some, take
from . import steady
from .lifecycle import COASTING, CONFIRMED, LOST, STATIONARY
from .places import AT_REST, GATE, UNNAMED, WANDER, Places, empty, nearest

AWAY = 12  # of a track that surely moves: a plot counts
OFF, ALONG = 3, 1  # if it lies off every place, or on a line with those before it
LEARNT = 40  # revolutions after which the map holds most places


class Anchors(NamedTuple):
    """Where the tracks began, A rows, ascending by id.

    id        [A]
    position  [A, 2]  m, of the first plot
    variance  [A]     m^2, of it, the larger axis
    away      [A]     sum over plots in a row far from it: OFF or ALONG
    moved     [A]     it has moved for sure
    number    [A]     of the target, 0 for none
    target    [A]     it is a target, and no place
    line      through its last plots, A rows
    """

    id: IntArray
    position: Array
    variance: Array
    away: IntArray
    moved: BoolArray
    number: IntArray
    target: BoolArray
    line: steady.Line


class Standing(NamedTuple):
    """What is known of the N tracks of a scan, each with its plot or where it was expected.

    position  [N, 2]  m
    variance  [N]     m^2, the larger axis
    hit       [N]     it had a plot
    time      [N]     s
    """

    position: Array
    variance: Array
    hit: BoolArray
    time: Array


class Ground(NamedTuple):
    """The memory between two scans.

    revolutions  that the places were learnt from
    """

    places: Places
    anchors: Anchors
    revolutions: int

    @property
    def moving(self) -> IntArray:
        """Ids of the tracks that have moved for sure."""
        return self.anchors.id[self.anchors.moved]


def begin() -> Ground:
    """Nothing is known."""
    ids, none, at = np.zeros(0, np.int64), np.zeros(0), np.zeros((0, 2))
    no, line = ids > 0, steady.begin(at, none)
    return Ground(empty(), Anchors(ids, at, none, ids, no, ids, no, line), 0)


def step(
    ground: Ground, tracks: Tracks, was: BoolArray, seen: Standing
) -> tuple[Ground, Tracks, BoolArray]:
    """The memory and the N tracks after a scan; and the tracks [N] whose plots may be learnt from,
    for they are not under way.

    was   [N] status before the scan was STATIONARY
    seen  of the N tracks

    Anchors of tracks that were not in this scan stay; those of lost ones go.
    """
    at = at_places(ground.places, seen)
    here, others = _apart(ground.anchors, tracks.id)
    anchors = follow(here, tracks, seen)
    along = steady.under_way(anchors.line, seen.variance + WANDER**2)
    anchors = moving(anchors, at, seen, along, ground.revolutions >= LEARNT)
    rest = was | ~along  # what surely moves does not become a place
    tracks, places = settle(tracks, was, rest, anchors, at, ground.places, others)
    target = (tracks.status == CONFIRMED) | (tracks.status == COASTING)
    anchors = anchors._replace(number=tracks.number, target=target)
    every = some(anchors, tracks.status != LOST)
    if others is not None:
        every = append(others, every)
        every = take(every, every.id.argsort(kind='stable'))
    ground = ground._replace(places=places, anchors=every)
    return ground, tracks, ~anchors.moved | (steady.speed(anchors.line) < AT_REST)


def _apart(anchors: Anchors, ids: IntArray) -> tuple[Anchors, Anchors | None]:
    """The anchors of tracks in this scan, by their ids [N], and those of others, if any are."""
    if np.array_equal(anchors.id, ids[: len(anchors.id)]):
        return anchors, None
    here = np.isin(anchors.id, ids)
    return take(anchors, here), take(anchors, ~here)


def follow(before: Anchors, tracks: Tracks, seen: Standing) -> Anchors:
    """The anchors of the N tracks, of which the first ones have anchors before; new ones begin
    where they are."""
    count = len(before.id)
    old = before._replace(
        line=steady.follow(before.line, seen.hit[:count], seen.position[:count], seen.time[:count])
    )
    if count < len(tracks.id):
        at, time, ids = seen.position[count:], seen.time[count:], tracks.id[count:]
        none = np.zeros(len(ids), np.int64)
        no, variance = none > 0, seen.variance[count:]
        new = Anchors(ids, at, variance, none, no, none, no, steady.begin(at, time))
        old = append(old, new)
    return old._replace(id=tracks.id, number=tracks.number)


def moving(
    anchors: Anchors, at: IntArray, seen: Standing, under_way: BoolArray, learnt: bool
) -> Anchors:
    """The anchors after a scan in which the tracks were at the places `at` [N], -1 for none.

    Before the map is learnt, a track that goes from plot to plot along a quay is off every place,
    too; then only a line through its plots tells that a track moves, `under_way` [N].
    """
    east, north = (seen.position - anchors.position).T
    apart = east**2 + north**2
    clear = apart > GATE * (seen.variance + anchors.variance + 2 * WANDER**2)
    step = under_way * ALONG
    if learnt:
        step[at < 0] = OFF
    step *= clear
    away = np.where(seen.hit, np.where(step > 0, anchors.away + step, 0), anchors.away)
    return anchors._replace(away=away, moved=anchors.moved | (away >= AWAY))


def settle(
    tracks: Tracks,
    was: BoolArray,
    rest: BoolArray,
    anchors: Anchors,
    at: IntArray,
    places: Places,
    others: Anchors | None,
) -> tuple[Tracks, Places]:
    """The tracks with STATIONARY ones marked and numbered, and the places without those left.

    was     [N] it was stationary before this scan
    rest    [N] it may be stationary
    at      [N] its established place, -1 for none
    others  anchors of tracks that were not in this scan
    """
    named = places.number
    if not np.count_nonzero(named) and not np.count_nonzero(was):
        return tracks, places
    live = (tracks.status == CONFIRMED) | (tracks.status == COASTING)
    still = live & rest & ~anchors.moved & ((at >= 0) | was)
    crowd = np.append(places.crowded, False)[at] | (was & (at < 0))
    number = tracks.number.copy()
    # A track on a place that has no name lends it its number; a place lends its own to a track.
    lend = (live & (at >= 0) & (number > 0)).nonzero()[0]
    lend = lend[named[at[lend]] == UNNAMED]
    if len(lend):
        lend = lend[~np.isin(number[lend], named)]
        named = named.copy()
        named[at[lend]] = number[lend]
    borrow = (still & (number == 0) & (at >= 0)).nonzero()[0]
    borrow = borrow[named[at[borrow]] > 0]
    if len(borrow):
        taken = number if others is None else np.append(number, others.number)
        borrow = borrow[~np.isin(named[at[borrow]], taken)]
        _, first = np.unique(named[at[borrow]], return_index=True)
        number[borrow[first]] = named[at[borrow[first]]]
    tracks = tracks._replace(
        status=np.where(still & crowd, STATIONARY, tracks.status).astype(np.int8), number=number
    )
    leaves = number[live & (anchors.away >= AWAY)]
    places = places._replace(number=named)
    if len(leaves):
        places = some(places, ~np.isin(named, leaves) | (named <= 0))
    return tracks, places


def name(places: Places, next_number: int) -> tuple[Places, int]:
    """Numbers for the established places that no track lent one; and the next free number.

    The plots of one thing may scatter over two places: one that is within reach of a place with a
    number is the same thing, and is dropped.
    """
    rows = (places.number == UNNAMED).nonzero()[0]
    if not len(rows):
        return places, next_number
    named = places.position[places.number > 0]
    same = nearest(named, places.position[rows], places.variance[rows]) >= 0
    number = places.number.copy()
    number[rows[~same]] = next_number + np.arange((~same).sum())
    kept = np.ones(len(number), bool)
    kept[rows[same]] = False
    return take(places._replace(number=number), kept), next_number + int((~same).sum())


class Shown(NamedTuple):
    """The places that are shown, S rows, in the order of their numbers.

    number    [S]
    position  [S, 2]  m, east and north
    variance  [S]     m^2, of that position, each axis
    share     [S]     of the last revolutions with a plot
    idle      [S]     revolutions since the last plot
    """

    number: IntArray
    position: Array
    variance: Array
    share: Array
    idle: IntArray


NOTHING_SHOWN = Shown(
    np.zeros(0, np.int64), np.zeros((0, 2)), np.zeros(0), np.zeros(0), np.zeros(0, np.int64)
)


def shown(ground: Ground) -> Shown:
    """The established places, without those for which a target stands."""
    places = ground.places
    chosen = places.number > 0
    if not np.count_nonzero(chosen):
        return NOTHING_SHOWN
    chosen &= ~np.isin(places.number, ground.anchors.number[ground.anchors.target])
    there = take(places, chosen.nonzero()[0][places.number[chosen].argsort()])
    return Shown(
        there.number,
        there.position,
        there.variance / np.maximum(there.plots, 1) + WANDER**2,
        there.share,
        there.idle,
    )


def at_places(places: Places, seen: Standing) -> IntArray:
    """Row [N] of the established place at which each track is, -1 for none."""
    rows = places.established.nonzero()[0]
    found = nearest(places.position[rows], seen.position, seen.variance)
    return np.where(found >= 0, np.append(rows, -1)[found], -1)


def standing(
    plot_of: IntArray,
    plots: Array,
    variances: Array,
    ahead: Extrapolation,
    expected: Array,
    time: Array,
) -> Standing:
    """What is known of the N tracks of a scan.

    plot_of           [N]     the plot that each track took, -1 for none; time [N] s
    plots, variances  [M, 2]  m, of the plots, and [M] m^2, their larger axes
    ahead             the tracks before the scan, with covariances `expected` [N0, 2, 2] m^2; those
                      that are missing are new, and had a plot
    """
    count, before, hit = len(plot_of), len(ahead.time), plot_of >= 0
    position, variance = np.empty((count, 2)), np.empty(count)
    position[:before], variance[:before] = ahead.position, larger(expected)
    rows = hit.nonzero()[0]
    took = plot_of[rows]
    position[rows], variance[rows] = plots[took], variances[took]
    return Standing(position, variance, hit, time)


def larger(covariance: Array) -> Array:
    """The larger eigenvalue [N] of matrices [N, 2, 2]."""
    a, b, d = covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]
    found: Array = 0.5 * (a + d) + np.hypot(0.5 * (a - d), b)
    return found
