"""New tracks from the plots that no track took."""

import numpy as np

from ..types import Array, BoolArray, IntArray, Plots, Tracks
from .gate import Pairs, gate_size
from .lifecycle import TENTATIVE

PAIRING_GATE = gate_size(0.99)  # for the noise of a new target's first two plots


def unexplained(plots: Plots, pairs: Pairs, plot_of: IntArray, tracks: Tracks) -> BoolArray:
    """Mask [M] of the plots that belong to no track and are not in the gate of a held track, which
    may have caused them.

    pairs    of the gate; plot_of [N]: the plot that each track took, -1 for none
    """
    free = np.ones(len(plots.time), bool)
    free[plot_of[plot_of >= 0]] = False
    free[pairs.plot[tracks.status[pairs.track] != TENTATIVE]] = False
    return free


def pair_up(
    before: Plots,
    now: Plots,
    first: IntArray,
    second: IntArray,
    free: BoolArray,
    max_speed: float,
    room: int,
) -> tuple[IntArray, IntArray]:
    """The pairs (first [P] in before, second [P] in now) that may be new targets.

    free  [M] mask of the plots in now that no track explains
    room  largest number of pairs wanted

    A pair fits if the distance between its plots, minus the part that noise explains, needs at most
    max_speed, m/s. Every plot is used at most once, the slowest pair first: a plot has one target,
    and one false plot must not begin several tracks.
    """
    candidates = free[second]
    first, second = first[candidates], second[candidates]
    if not len(first):
        return first, second
    step = now.time[second] - before.time[first]
    way = now.position[second] - before.position[first]
    length = np.hypot(*way.T)
    way[length == 0] = 1.0, 0.0  # at rest: any direction will do
    unit = way / np.hypot(*way.T)[:, None]
    spread = before.covariance[first] + now.covariance[second]
    sigma = np.sqrt((unit[:, None] @ spread @ unit[..., None])[:, 0, 0])  # along the way
    excess = np.maximum(length - max_speed * step, 0.0) / sigma
    fits = ((excess**2 <= PAIRING_GATE) & (step > 0)).nonzero()[0]
    return _greedy(first[fits], second[fits], (length / sigma)[fits], room)


def _greedy(first: IntArray, second: IntArray, cost: Array, room: int) -> tuple[IntArray, IntArray]:
    """One-to-one pairs, at most `room`, cheapest first."""
    order = np.argsort(cost, kind='stable')
    taken_first: set[int] = set()
    taken_second: set[int] = set()
    keep: list[tuple[int, int]] = []
    for a, b in zip(first[order].tolist(), second[order].tolist()):
        if len(keep) == room:
            break
        if a not in taken_first and b not in taken_second:
            taken_first.add(a)
            taken_second.add(b)
            keep.append((a, b))
    chosen = np.array(keep, np.int64).reshape(-1, 2)
    return chosen[:, 0], chosen[:, 1]
