"""The echo of a point: how many spokes and samples beam and pulse spread it over.

Its power falls off as a Gaussian in bearing, by a quarter at half a beam width (the beam is passed
twice), and in range, by half at half a pulse length. Source: Skolnik, Radar Handbook, 3rd ed., 2.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array

SHIP = 300.0  # m
SHORTEST = 7.5  # m: a pulse of 50 ns
BEAM_FALL = 8 * np.log(2)  # ln(power) is -BEAM_FALL * (bearing / beam width)^2
PULSE_FALL = 4 * np.log(2)  # ln(power) is -PULSE_FALL * (range / pulse length)^2


class Lobe(NamedTuple):
    """shape  [2]  spokes in a beam width and samples in a pulse length, each at least 1
    ship   samples of the longest usual ship, SHIP
    """

    shape: Array
    ship: float = 0.0

    @property
    def gap(self) -> int:
        """Spokes without a hit that do not end an echo."""
        return max(int(0.25 * self.shape[0]), 1)

    @property
    def single(self) -> Array:
        """[2] spokes and samples; an echo that is no wider has one maximum only."""
        return np.maximum(1.2 * self.shape, 2.0)

    @property
    def smooth(self) -> tuple[int, int]:
        """Window in which the maxima are smoothed."""
        spokes, samples = 0.4 * self.shape
        return max(round(spokes), 1), max(round(samples), 1)

    @property
    def apart(self) -> tuple[int, int]:
        """Window in which there is one maximum."""
        spokes, samples = 0.9 * self.shape
        return 2 * int(spokes / 2) + 1, max(2 * int(samples / 2) + 1, 3)


def lobe(spacing: float, range_step: float, beam: float, pulse: float) -> Lobe:
    """For spokes `spacing` rad apart with samples of `range_step` m; pulse 0: not known, two
    samples, or the shortest pulse that marine radars have."""
    depth = pulse or max(2 * range_step, SHORTEST)
    return Lobe(np.maximum([beam / spacing, depth / range_step], 1.0), SHIP / range_step)
