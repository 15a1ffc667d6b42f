"""Pairs of a ship of AIS and a radar track: their evidence, and their life.

candidate -> joined -> parted, where it was surely joined -> mismatch
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, BoolArray, CodeArray, IntArray, put, row_of, take

SURELY = 20.0  # s joined, after which coming apart is a mismatch
APART = 5.0  # deviations by which they must differ then
BESIDE, LEAVES, LEFT_FOR = 60.0, 4.0, 8.0  # s, deviations, s: of the place beside the echo
LEAST_OFF = 50.0  # m
PARTED_FOR, KEPT = 60.0, 600.0  # s; so long a parted pair may become a mismatch, and is one

CANDIDATE, JOINED, PARTED, MISMATCH = range(4)


class Pairs(NamedTuple):
    """P pairs that are remembered.

    ship, track  [P]  ids
    evidence     [P]  log-likelihood ratio
    state        [P]  CANDIDATE, JOINED, PARTED (it was surely joined) or MISMATCH
    since        [P]  s, of that state
    sure         [P]  s that it is, or was, joined without a break
    beside       [P, 2]  m, of the echo from where AIS says, as kept so far; nan: not joined yet
    left         [P]  s since she left it
    off          [P]  deviations from it now
    """

    ship: IntArray
    track: IntArray
    evidence: Array
    state: CodeArray
    since: Array
    sure: Array
    beside: Array
    left: Array
    off: Array


def nothing() -> Pairs:
    """No pairs."""
    ids, times = np.zeros(0, np.int64), np.zeros(0)
    return Pairs(
        ids, ids, times, np.zeros(0, np.int8), times, times, np.zeros((0, 2)), times, times
    )


def probability_of(pairs: Pairs) -> Array:
    """Of each pair [P], that it is one ship: by the evidence of all tracks that may be hers."""
    odds = np.exp(np.minimum(pairs.evidence, 30.0))
    _, which = np.unique(pairs.ship, return_inverse=True)
    found: Array = odds / (1.0 + np.bincount(which, odds)[which])
    return found


def remembered(before: Pairs, ship: IntArray, track: IntArray, now: float) -> Pairs:
    """The pairs of these ids [P], with what is remembered of them."""
    count = len(ship)
    nobody = np.zeros(count)
    new = Pairs(
        ship,
        track,
        nobody,
        nobody.astype(np.int8),
        np.full(count, now),
        nobody,
        np.full((count, 2), np.nan),
        nobody,
        nobody,
    )
    if not len(before.ship):
        return new
    most = 1 + max(int(track.max(initial=0)), int(before.track.max(initial=0)))
    row = row_of(before.ship * most + before.track, ship * most + track)
    known = (row >= 0).nonzero()[0]
    return put(new, known, take(before, row[known]))


def beside(
    pairs: Pairs, differ: Array, covariance: Array, refused: BoolArray, elapsed: float
) -> Pairs:
    """The pairs with the place of each echo beside that of AIS, of differences [P, 2] m; those that
    left it for too long have no evidence any more. refused [P]: she says another place by now."""
    joined = pairs.state == JOINED
    off = np.where(joined[:, None], differ - pairs.beside, 0.0)
    off[np.isnan(off)] = 0.0
    spread = covariance[:, :2, :2]
    nis = np.einsum('pi,pij,pj->p', off, np.linalg.inv(spread), off)
    leaves = joined & (((nis > LEAVES**2) & (np.hypot(*off.T) > LEAST_OFF)) | refused)
    left = np.where(leaves, pairs.left + elapsed, 0.0)
    gain = np.maximum(elapsed / BESIDE, elapsed / np.maximum(pairs.sure + elapsed, 1e-9))
    moved = np.where(
        np.isnan(pairs.beside), differ, pairs.beside + np.minimum(gain, 1.0)[:, None] * off
    )
    beside = np.where((joined & ~leaves)[:, None], moved, pairs.beside)
    gone = left >= LEFT_FOR
    evidence = np.where(gone, np.minimum(pairs.evidence, -1.0), pairs.evidence)
    return pairs._replace(beside=beside, left=left, evidence=evidence, off=np.sqrt(nis))


def judged(
    pairs: Pairs,
    chosen: BoolArray,
    ship: IntArray,
    track: IntArray,
    differs: BoolArray,
    now: float,
    elapsed: float,
) -> Pairs:
    """The pairs with their new states: chosen [P] are joined; differs [P] say two places."""
    taken = _of_chosen(ship, chosen) | _of_chosen(track, chosen)
    was = pairs.state
    parted = (was == JOINED) & (pairs.sure >= SURELY)
    parted |= (was == PARTED) & (now - pairs.since < PARTED_FOR)
    goes_on = (was == MISMATCH) & (now - pairs.since < KEPT)
    state = np.where(~taken & parted, PARTED, CANDIDATE)
    state = np.where(~taken & (goes_on | (parted & differs)), MISMATCH, state)
    state = np.where(chosen, JOINED, state).astype(np.int8)
    again = chosen & (was != JOINED)
    return pairs._replace(
        state=state,
        since=np.where(state != was, now, pairs.since),
        sure=np.where(
            chosen, np.where(again, 0.0, pairs.sure) + elapsed, pairs.sure * (state != CANDIDATE)
        ),
        beside=np.where((again | (state == CANDIDATE))[:, None], np.nan, pairs.beside),
    )


def _of_chosen(rows: IntArray, chosen: BoolArray) -> BoolArray:
    """Mask [P] of the pairs whose row [P] is that of a chosen pair, too."""
    held = np.zeros(rows.max(initial=-1) + 1, bool)
    held[rows[chosen]] = True
    found: BoolArray = held[rows]
    return found
