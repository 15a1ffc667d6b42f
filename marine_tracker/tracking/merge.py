"""Finds two tracks on one target."""

import numpy as np

from ..types import HISTORY, BoolArray, Extrapolation, IntArray, Tracks
from .gate import Pairs
from .history import hits, misses_in_a_row
from .lifecycle import LOST, TENTATIVE, sure

SAME = 9.49  # chi-square with 4 degrees of freedom, 95 %
RECENT = 10  # scans in which two tracks must share the plots of one target
STARVED = 4  # misses in a row, each next to the other's plot, that prove the same


def duplicates(pairs: Pairs, plot_of: IntArray, ahead: Extrapolation, tracks: Tracks) -> BoolArray:
    """Mask [N] of tracks that follow a target which another track follows too.

    pairs    those inside the gate; plot_of [N] the association
    ahead    the tracks before the update
    tracks   after it, as this scan has judged them

    A track is superfluous if it had no plot because another track took one in its gate, both agree
    in position and velocity, and together they recently had no more plots than one target gives (or
    this one had none for long). Two sure tracks may be two ships in one cell of the radar: of them
    more scans must tell so. Two ships in company both get plots. Ships that cross differ in
    velocity.
    """
    track, plot, status = pairs.track, pairs.plot, tracks.status
    double = np.zeros(len(status), bool)
    starved = (plot_of < 0) & (status != LOST)
    if not starved.any():
        return double
    owner = np.full(plot.max(initial=-1) + 1, -1)
    has = ((plot_of >= 0) & (plot_of < len(owner))).nonzero()[0]
    owner[plot_of[has]] = has
    look = (starved[track] & (owner[plot] >= 0)).nonzero()[0]
    if not len(look):
        return double
    one, other = track[look], owner[plot[look]]
    mine, others = tracks.history[one], tracks.history[other]
    old = sure(tracks)[one] & sure(tracks)[other]
    few = [hits(mine, n) + hits(others, n) <= n + 1 for n in (RECENT, HISTORY)]
    sharing = np.where(old, few[1], few[0] | (misses_in_a_row(mine) >= STARVED))
    keep = (status[one] == TENTATIVE) | ((status[other] != TENTATIVE) & sharing)
    one, other = one[keep], other[keep]
    if not len(one):
        return double
    apart = np.concatenate([ahead.position, ahead.velocity], 1)
    apart = apart[one] - apart[other]
    spread = ahead.covariance[one] + ahead.covariance[other]
    distance = (apart * np.linalg.solve(spread, apart[..., None])[..., 0]).sum(1)
    double[one[distance < SAME]] = True
    return double
