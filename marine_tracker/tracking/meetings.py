"""Tracks that meet: how probable it is that two of them have exchanged their targets.

Two confirmed tracks meet from the scan in which they contest a plot for the first time until KEPT
seconds after the last. Their swap risk is the probability that, of the two, a track now follows the
target that the other one followed before they met.

A scan can exchange them where two things hold. Its plots do not tell which is whose: that is the
doubt b, the lesser of the probabilities of both tracks to own one plot, over all joint associations
(0 to 0.5; marginals.py). And each of the two can go on as the other one: with d the distance of
their expected velocities, in deviations of that difference, its density is exp(-d^2 / 2) of the
greatest. So the scan's risk is b exp(-d^2): ships that cross at a wide angle are in one place, and
yet their motion tells them apart; ships in company have one motion, and yet their plots do. Scans
in a row ask the same question again, so the risk of the meeting is the greatest of its scans'.

`experiments crossings` compares what was told with what happened.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, Extrapolation, IntArray, Tracks, row_of, take

LEAST = 1e-3  # probability of a pair below which there is no doubt
KEPT = 120.0  # s after the last contested plot; then it is no news any more


class Contested(NamedTuple):
    """Pairs [P] of confirmed tracks and plots that several of them may own.

    track, plot  [P]  rows
    chance       [P]  that the plot is of the track, over all joint associations
    """

    track: IntArray
    plot: IntArray
    chance: Array


NOTHING = Contested(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0))


class Meetings(NamedTuple):
    """Pairs [E] of tracks that have met.

    one, two  [E]  ids, one < two
    swapped   [E]  probability that they have exchanged their targets since they met
    last      [E]  s, when they last contested a plot
    """

    one: IntArray
    two: IntArray
    swapped: Array
    last: Array


def begin() -> Meetings:
    """Nobody has met."""
    none = np.zeros(0, np.int64)
    return Meetings(none, none, np.zeros(0), np.zeros(0))


def step(
    before: Meetings,
    contested: Contested,
    plot_of: IntArray,
    tracks: Tracks,
    ahead: Extrapolation,
    now: float,
) -> Meetings:
    """The meetings after a scan that ended at `now` s.

    plot_of [N]: the plot that each track took, -1 for none; tracks; ahead: the first of them,
    expected
    """
    one, two, doubt = _doubts(contested, plot_of)
    if not len(one):
        return take(before, now - before.last <= KEPT) if len(before.one) else before
    apart = ahead.velocity[one] - ahead.velocity[two]
    spread = (ahead.covariance[one] + ahead.covariance[two])[:, 2:, 2:]
    distance = (apart * np.linalg.solve(spread, apart[..., None])[..., 0]).sum(1)
    risk = doubt * np.exp(-distance)
    kept = take(before, now - before.last <= KEPT)
    ids = np.sort(np.stack([tracks.id[one], tracks.id[two]]), 0)
    known = row_of(_key(kept.one, kept.two), _key(*ids))
    old, new = known >= 0, known < 0
    kept.swapped[known[old]] = np.maximum(kept.swapped[known[old]], risk[old])
    kept.last[known[old]] = now
    return Meetings(
        np.append(kept.one, ids[0, new]),
        np.append(kept.two, ids[1, new]),
        np.append(kept.swapped, risk[new]),
        np.append(kept.last, np.full(int(new.sum()), now)),
    )


def told(known: Meetings, ids: IntArray) -> tuple[Array, IntArray]:
    """The probability [N] that each of the tracks, ids [N], has exchanged its target with another
    one since they met, and the row [N] of the likeliest other one; -1 where there is none."""
    swapped, other = np.zeros(len(ids)), np.full(len(ids), -1)
    if not len(known.one):
        return swapped, other
    pair = row_of(ids, known.one), row_of(ids, known.two)
    mine, partner = np.concatenate(pair), np.concatenate(pair[::-1])
    chance = np.tile(known.swapped, 2)
    here = (mine >= 0).nonzero()[0]
    here = here[chance[here].argsort()]
    mine, partner, chance = mine[here], partner[here], chance[here]
    stayed = np.ones(len(ids))
    np.multiply.at(stayed, mine, 1 - chance)
    other[mine] = partner  # the last one counts, which is the likeliest
    return 1 - stayed, other


def _doubts(contested: Contested, plot_of: IntArray) -> tuple[IntArray, IntArray, Array]:
    """Pairs of tracks (one [E], two [E] rows, one < two) where one is in the gate of the plot that
    the other one took, and how much doubt [E] there is whose it is."""
    track, plot, chance = contested
    rival = (chance > LEAST).nonzero()[0]
    if len(rival) < 2:
        return rival[:0], rival[:0], chance[:0]
    taker = np.full(plot.max() + 1, -1)
    own = (plot_of[track] == plot).nonzero()[0]
    taker[plot[own]] = own  # row among the pairs
    owner = taker[plot[rival]]
    some = (owner >= 0) & (owner != rival)
    rival, owner = rival[some], owner[some]
    ends = np.sort(np.stack([track[rival], track[owner]]), 0)
    pair, at = np.unique(ends, axis=1, return_inverse=True)
    doubt = np.zeros(pair.shape[1])
    np.maximum.at(doubt, at.ravel(), np.minimum(chance[rival], chance[owner]))
    return pair[0], pair[1], doubt


def _key(one: IntArray, two: IntArray) -> IntArray:
    return (one << 32) | two
