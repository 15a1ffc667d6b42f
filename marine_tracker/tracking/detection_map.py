"""How often targets show: the probability of detection over range and bearing, learnt slowly.

Sectors of a ring that doubles in range, in true bearing. Sure targets teach it: they show, or not.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, BoolArray, IntArray

NEAREST = 100.0  # m, outer edge of the first ring
RINGS, SECTORS = 12, 16  # to 200 km
MEMORY = 400.0  # looks at sure targets in a cell
PRIOR_LOOKS = 30.0  # that the parameter's probability weighs as much as


class DetectionMap(NamedTuple):
    """looks [RINGS * SECTORS] at sure targets, and how many were hits, forgotten slowly."""

    looks: Array
    hits: Array


def empty() -> DetectionMap:
    """Nothing is known."""
    none = np.zeros(RINGS * SECTORS)
    return DetectionMap(none, none)


def _cell(range_: Array, bearing: Array) -> IntArray:
    octave = np.log2(np.maximum(range_, 0.5 * NEAREST) / (0.5 * NEAREST)).astype(np.int64)
    sector = (bearing * (SECTORS / (2 * np.pi))).astype(np.int64) % SECTORS
    return np.minimum(octave, RINGS - 1) * SECTORS + sector


def learn(before: DetectionMap, range_: Array, bearing: Array, hit: BoolArray) -> DetectionMap:
    """The map after a scan that looked for the sure targets at [K] (m, rad) and found those of the
    mask [K]."""
    cell = _cell(range_, bearing)
    looks = np.bincount(cell, minlength=RINGS * SECTORS)
    keep = np.exp(-looks / MEMORY)
    found = np.bincount(cell, hit, RINGS * SECTORS)
    return DetectionMap(before.looks * keep + looks, before.hits * keep + found)


def probability(known: DetectionMap, range_: Array, bearing: Array, prior: float) -> Array:
    """Probability of detection [N] at the places [N] (m, rad); `prior` where nothing is known."""
    cell = _cell(range_, bearing)
    found: Array = (known.hits[cell] + PRIOR_LOOKS * prior) / (known.looks[cell] + PRIOR_LOOKS)
    return found
