"""The radar picture, north up, from the spokes of the last revolution."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..types import Array, Spokes, StrengthArray

ROWS = 2048  # directions
OLD_S = 6.0  # s; a direction that was not swept for so long is empty


class Polar(NamedTuple):
    """The last spoke in each of ROWS directions.

    strength  [ROWS, B]
    time      [ROWS]  s, when it was swept; -inf: never
    step      [ROWS]  m, of its samples
    """

    strength: StrengthArray
    time: Array
    step: Array


def start(samples: int = 1) -> Polar:
    """Nothing swept yet."""
    return Polar(np.zeros((ROWS, samples), np.uint8), np.full(ROWS, -np.inf), np.ones(ROWS))


def painted(polar: Polar, spokes: Spokes) -> Polar:
    """The picture with these spokes; each also fills the directions up to the next one's, for as
    far as two spokes usually lie apart."""
    known = np.flatnonzero(np.isfinite(spokes.bearing))
    if not len(known):
        return polar
    strength = spokes.strength
    if strength.shape[1] != polar.strength.shape[1] or strength.dtype != polar.strength.dtype:
        fresh = start(strength.shape[1])
        polar = fresh._replace(strength=fresh.strength.astype(strength.dtype))
    per_row = ROWS / (2 * np.pi)
    row = np.floor(spokes.bearing[known] * per_row).astype(np.int64) % ROWS
    turn = np.mod(np.diff(spokes.bearing[known]), 2 * np.pi)
    apart = math.ceil(float(np.median(turn)) * per_row) if len(turn) else 1
    for shift in range(min(max(apart, 1), ROWS // 64)):
        at = (row + shift) % ROWS
        polar.strength[at] = strength[known]
        polar.time[at] = spokes.time[known]
        polar.step[at] = spokes.range_step[known]
    return polar


def north_up(polar: Polar, size: int, now: float) -> NDArray[np.uint8]:
    """[size, size] picture with own ship in the middle, north up, from 0 to 255.

    The edge is the range of the newest spoke. What was not swept is 0.
    """
    samples = polar.strength.shape[1]
    newest = int(np.argmax(polar.time))
    metres = samples * polar.step[newest] / (size / 2)
    axis = np.arange(size) - (size - 1) / 2
    east, north = np.meshgrid(axis, -axis)
    row = np.floor(np.arctan2(east, north) * (ROWS / (2 * np.pi))).astype(np.int64) % ROWS
    sample = np.floor(np.hypot(east, north) * metres / polar.step[row]).astype(np.int64)
    fresh = now - polar.time < OLD_S
    seen = fresh[row] & (sample < samples)
    full = next(f for f in (15, 255, 4095, 65535) if f >= int(polar.strength.max(initial=0)))
    value = polar.strength[row, np.minimum(sample, samples - 1)]
    return np.where(seen, value * (255.0 / full), 0.0).astype(np.uint8)
