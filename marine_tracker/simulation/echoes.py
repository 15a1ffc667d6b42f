"""Cells over the threshold: the echoes of many scatterers after pulse and beam.

The radar looks at a grid of cells, one range resolution deep and one beam wide. The echoes of all
scatterers add up in a cell as waves do. Each has a weight that depends on its distance from the
cell: Gaussian in range (the pulse) and in bearing (the beam, which is passed twice). The power is a
half at half a cell away in range, and a quarter in bearing. So a strong scatterer also fills the
neighbouring cells: this is the smear.
"""

import numpy as np
from numpy.typing import NDArray

from ..geometry import wrap_bearing
from ..types import Array, PolarPlots, take
from .scenario_radar import ScenarioRadar

THRESHOLD = 20.0  # power over noise at which a plot is declared: 13 dB
STRONGEST = 0.9999  # probability of detection that gives the amplitude of a certain plot
NEAR = np.arange(-2, 3)  # cells; two cells away, pulse and beam are down by 48 dB or more


def cells(
    radar: ScenarioRadar,
    start: float,
    distance: Array,
    bearing: Array,
    echo: NDArray[np.complex128],
    random: np.random.Generator,
) -> PolarPlots:
    """The cells over the threshold in the revolution that begins at `start` s.

    distance [S] m, bearing [S] rad of the scatterers when the beam passes them; echo [S] complex,
    amplitude relative to the receiver's noise. A plot lies in the middle of its cell.
    """
    sectors = round(2 * np.pi / radar.beam_width)
    width = 2 * np.pi / sectors
    ring, sector = distance / radar.range_resolution - 0.5, bearing / width - 0.5
    i, j = (np.rint(place).astype(np.int64)[:, None] + NEAR for place in (ring, sector))
    pulse = np.exp2(-2 * (ring[:, None] - i) ** 2)
    beam = np.exp2(-4 * ((sector[:, None] - j) * (width / radar.beam_width)) ** 2)
    field = (echo[:, None] * pulse)[:, :, None] * beam[:, None, :]
    cell, which = np.unique(
        (i[:, :, None] * sectors + (j % sectors)[:, None, :]).ravel(), return_inverse=True
    )
    total = np.sqrt(0.5) * random.standard_normal((2, len(cell)))
    total += [np.bincount(which, part.ravel(), len(cell)) for part in (field.real, field.imag)]
    power = np.square(total).sum(0)
    distance = (cell // sectors + 0.5) * radar.range_resolution
    seen = (power > THRESHOLD) & (distance >= radar.blind_range) & (distance <= radar.max_range)
    bearing = (cell % sectors + 0.5)[seen] * width
    plots = PolarPlots(
        start + bearing * (radar.scan_period / (2 * np.pi)),
        distance[seen] + radar.range_bias,
        wrap_bearing(bearing + radar.bearing_bias),
        10 * np.log10(power[seen]),
    )
    return take(plots, plots.range > 0)
