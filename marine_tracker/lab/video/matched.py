"""Plots of recorded video beside the vessels that told AIS in the same seconds.

A file NAME.nmea beside NAME.npz holds lines of `seconds sentence`: own ship's GLL and AIS. The
radar's errors of range and bearing are those with which most vessels have a plot.
"""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pynmea2

from ...ais.sentences import Sentences
from ...geodesy import LocalFrame
from ...geometry import KNOT, to_range_bearing, unit_vector, wrap_angle
from ...types import Array, BoolArray, PolarPlots

NEAR_M, NEAR = 125.0, math.radians(1.0)  # a plot so near to a vessel is hers
WITHIN, MOVING = 20_000.0, 2.0 * KNOT
RANGES = np.arange(-300.0, 301.0, 25.0)
BEARINGS = np.radians(np.arange(-4.0, 4.01, 0.25))
WRONG = np.radians(np.arange(10.0, 351.0, 10.0))  # bearings that are not the vessels'


class Vessels(NamedTuple):
    """[V] of each the last report: s; m from own ship, east and north; m/s over ground."""

    time: Array
    position: Array
    velocity: Array

    def at(self, time: float) -> Array:
        """[V, 2] m, where they are."""
        return self.position + self.velocity * (time - self.time)[:, None]


class Matched(NamedTuple):
    """range, bearing: m, rad, what plots are off by; near [V] vessels with a plot in any scan;
    moving [V]; by_chance: number of moving vessels that have one at wrong bearings, on average."""

    range: float
    bearing: float
    near: BoolArray
    moving: BoolArray
    by_chance: float


def read(path: Path) -> Vessels:
    """The vessels within WITHIN that a file of sentences tells; ValueError without own ship's
    position or a vessel."""
    sentences, own = Sentences(), []
    for line in path.read_text(errors='replace').splitlines():
        seconds, _, sentence = line.partition(' ')
        if 'GLL,' in sentence:
            told = pynmea2.parse(sentence)
            own.append((told.latitude, told.longitude))
        else:
            sentences.take(sentence, float(seconds))
    told = sentences.reports()
    last = {
        mmsi: k for k, mmsi in enumerate(told.mmsi.tolist()) if told.latitude[k] == told.latitude[k]
    }
    if not own or not last:
        raise ValueError(f'{path}: tells no position of own ship, or no vessel')
    rows = np.array(list(last.values()))
    frame = LocalFrame(*np.median(own, axis=0).tolist())
    position = frame.to_local(told.latitude[rows], told.longitude[rows])
    speed = np.nan_to_num(told.speed[rows])
    velocity = speed[:, None] * unit_vector(np.nan_to_num(told.course[rows]))
    near = np.hypot(*position.T) < WITHIN
    return Vessels(told.heard[rows][near], position[near], velocity[near])


def match(vessels: Vessels, scans: Sequence[PolarPlots]) -> Matched:
    """The vessels that have a plot in any of the scans, with own ship at rest at the origin."""
    moving = np.hypot(*vessels.velocity.T) > MOVING
    off = [_off(vessels, plots) for plots in scans]
    count = [[_near(off, range_, bearing).sum() for bearing in BEARINGS] for range_ in RANGES]
    best = np.unravel_index(int(np.argmax(count)), (len(RANGES), len(BEARINGS)))
    range_, bearing = float(RANGES[best[0]]), float(BEARINGS[best[1]])
    for _ in range(3):  # to the middle of those that are near
        pairs = np.concatenate([one[_gate(one, range_, bearing)] for one in off])
        range_, bearing = np.median(pairs, axis=0).tolist()
    chance = [(_near(off, range_, bearing + wrong) & moving).sum() for wrong in WRONG]
    return Matched(range_, bearing, _near(off, range_, bearing), moving, float(np.mean(chance)))


def _off(vessels: Vessels, plots: PolarPlots) -> Array:
    """[V, M, 2] m, rad: how far each plot is from each vessel in range and bearing."""
    middle = float(plots.time.mean()) if len(plots.time) else 0.0
    range_, bearing = to_range_bearing(vessels.at(middle))
    return np.stack(
        [plots.range - range_[:, None], wrap_angle(plots.bearing - bearing[:, None])], -1
    )


def _gate(off: Array, range_: float, bearing: float) -> BoolArray:
    """[V, M] which are near, where plots are off by a range and bearing."""
    found: BoolArray = (np.abs(off[..., 0] - range_) < NEAR_M) & (
        np.abs(wrap_angle(off[..., 1] - bearing)) < NEAR
    )
    return found


def _near(off: list[Array], range_: float, bearing: float) -> BoolArray:
    """[V] vessels with a plot near them in any scan."""
    return np.any([_gate(one, range_, bearing).any(1) for one in off], axis=0)
