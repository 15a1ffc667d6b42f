"""When the rotating beam meets the ships, and where they are then.

The beam starts each revolution at true north and turns evenly. It meets a target when its angle
equals the bearing of the moving target from the moving own ship.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import to_range_bearing, wrap_angle
from ..types import Array, Truth, take
from . import motion
from .scenario import Scenario

NEAR_SEAM = 0.25  # of a revolution; this near to north a passage may be doubled or missed
SEAM = 1e-9  # s; a passage less than this before north belongs to the next revolution
REVOLUTIONS = 64  # solved at once: array operations cost the same for
ROWS = 8192  # few rows as for many; but at most this many rows


class Passages(NamedTuple):
    """The beam's passages of targets in one revolution, one row each.

    target    [P]     its number, from 1; a target may be passed 0, 1 or 2 times
    turn      [P]     0, or 1 for the target's second passage
    time      [P]     s
    offset    [P, 2]  m, from own ship at that time
    velocity  [P, 2]  m/s, of the target over ground
    """

    target: NDArray[np.int64]
    turn: NDArray[np.int64]
    time: Array
    offset: Array
    velocity: Array


class Revolution(NamedTuple):
    """One revolution of the antenna: start and end s, the beam's passages, and the truth.

    The truth has a row for every target that exists, at the time when the beam passed it. For two
    passages it is the first one; for none it is the nearest end of the revolution.
    """

    start: float
    end: float
    passages: Passages
    truth: Truth


def revolutions(scenario: Scenario) -> Iterator[Revolution]:
    """The scenario's revolutions, one after the other."""
    targets = scenario.fleet.paths.ships - 1
    block = max(1, min(REVOLUTIONS, ROWS // targets))
    for first in range(0, scenario.scans, block):
        yield from _solve(scenario, np.arange(first, min(first + block, scenario.scans)))


def _solve(scenario, numbers):
    """The revolutions of these numbers [B]; rows are in order of revolution, target and time."""
    period = scenario.radar.scan_period
    target = np.arange(1, scenario.fleet.paths.ships)
    number = np.repeat(numbers, len(target))
    target = np.tile(target, len(numbers))
    start, end = number * period, (number + 1) * period
    offset, _, _ = _from_own_ship(scenario, target, 0.5 * (start + end))
    time = start + to_range_bearing(offset)[1] * (period / (2 * np.pi))
    # A target that moves across north may be met at both ends of the revolution, or at neither.
    late, early = time > end - NEAR_SEAM * period, time < start + NEAR_SEAM * period
    number, target = (np.concatenate([a, a[late], a[early]]) for a in (number, target))
    time = np.concatenate([time, time[late] - period, time[early] + period])
    time = _meet(scenario, target, time, number * period)
    order = np.lexsort((time, target, number))
    number, target, time = number[order], target[order], time[order]
    start, end = number * period, (number + 1) * period
    # Both revolutions must agree, despite rounding, on the owner of a passage exactly at north.
    inside = (time >= start - SEAM) & (time < end - SEAM)

    # Truth: the first passage inside, else the nearest end of the revolution.
    rank = np.where(inside, time - start, period + np.abs(time - 0.5 * (start + end)))
    best = np.lexsort((rank, target, number))
    best = best[_is_first(number[best], target[best])]
    time = np.clip(time, start, end)
    offset, position, velocity = _from_own_ship(scenario, target, time)
    there = motion.exist(scenario.fleet.paths, target, time)
    best = best[there[best]]
    met = np.flatnonzero(inside & there)
    second = ~_is_first(number[met], target[met])
    passages = Passages(target[met], second.astype(np.int64), time[met], offset[met], velocity[met])
    truth = Truth(time[best], target[best], position[best], velocity[best])
    edges = [
        np.searchsorted(number[rows], np.append(numbers, numbers[-1] + 1)) for rows in (met, best)
    ]
    for k, revolution in enumerate(numbers.tolist()):
        of_passages, of_truth = (slice(edge[k], edge[k + 1]) for edge in edges)
        yield Revolution(
            revolution * period,
            (revolution + 1) * period,
            take(passages, of_passages),
            take(truth, of_truth),
        )


def _is_first(number, target):
    """The first rows of each revolution and target; rows are sorted by both."""
    return (np.diff(number, prepend=-1) != 0) | (np.diff(target, prepend=0) != 0)


def _meet(scenario, target, time, start):
    """When the beam meets the targets [N]: the passages nearest to the times [N], by Newton.

    start [N] s is when the beam passed north.
    """
    turn = 2 * np.pi / scenario.radar.scan_period
    for _ in range(3):
        offset, _, velocity = _from_own_ship(scenario, target, time, relative=True)
        distance, bearing = to_range_bearing(offset)
        rate = (offset[:, 1] * velocity[:, 0] - offset[:, 0] * velocity[:, 1]) / np.maximum(
            distance, 1e-3
        ) ** 2
        # A bearing changes faster than half the beam's rate only within metres of own ship.
        rate = np.clip(rate, -0.5 * turn, 0.5 * turn)
        time = time + wrap_angle(bearing - turn * (time - start)) / (turn - rate)
    return time


def _from_own_ship(scenario, target, time, relative=False):
    """Offset from own ship, position, and velocity (or that relative to own ship) [N, 2]."""
    count = len(target)
    position, velocity = motion.locate_ships(
        scenario.fleet.paths, np.concatenate([target, np.zeros_like(target)]), np.tile(time, 2)
    )
    offset = position[:count] - position[count:]
    return (
        offset,
        position[:count],
        velocity[:count] - velocity[count:] if relative else velocity[:count],
    )
