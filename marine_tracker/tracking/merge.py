"""Two tracks on one target."""

import numpy as np

from ..types import Extrapolation, Tracks
from .lifecycle import LOST, TENTATIVE, misses_in_a_row

SAME = 3.36         # chi-square with 4 degrees of freedom, median
STARVED = 2         # misses in a row after which a confirmed track may be a duplicate


def duplicates(track, plot, plot_of, ahead: Extrapolation, tracks: Tracks, status):
    """Mask [N] of tracks that follow a target which another track follows too.

    track, plot  [P] pairs inside the gate; plot_of [N] the association
    ahead        the tracks before the update

    A track is one too many when a plot in its gate went to another track, it got none itself
    (a confirmed one: STARVED times in a row) and both agree in position and velocity. Two ships
    in company both get plots, ships that cross differ in velocity.
    """
    double = np.zeros(len(status), bool)
    starved = (plot_of < 0) & (status != LOST) & (
        (status == TENTATIVE) | (misses_in_a_row(tracks) >= STARVED))
    if not starved.any():
        return double
    owner = np.full(plot.max(initial=-1) + 1, -1)
    has = ((plot_of >= 0) & (plot_of < len(owner))).nonzero()[0]
    owner[plot_of[has]] = has
    look = (starved[track] & (owner[plot] >= 0)).nonzero()[0]
    one, other = track[look], owner[plot[look]]
    keep = (status[one] == TENTATIVE) | (status[other] != TENTATIVE)
    one, other = one[keep], other[keep]
    if not len(one):
        return double
    apart = np.concatenate([ahead.position, ahead.velocity], 1)
    apart = apart[one] - apart[other]
    spread = ahead.covariance[one] + ahead.covariance[other]
    distance = np.einsum('pi,pi->p', apart, np.linalg.solve(spread, apart[..., None])[..., 0])
    double[one[distance < SAME]] = True
    return double
