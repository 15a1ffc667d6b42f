"""How far a radar's pulse and beam smear a point echo: the position noise of a single cell.

A cell can stand anywhere in the area that pulse and beam light up at once, weighted by their
shapes. The factors are the deviations of cells about a point target at 25 dB, divided by range
resolution and beam width.
"""

import numpy as np

from ..geometry import unit_vector
from ..types import Array

ALONG, ACROSS = 0.55, 0.4  # of the range resolution, of the beam's width


def smear(range_: Array, bearing: Array, range_resolution: float, beam_width: float) -> Array:
    """Covariances [..., 2, 2] m^2, east and north, of cells about a point target.

    range_, bearing [...] m, rad; range_resolution m; beam_width rad.
    """
    line = unit_vector(np.asarray(bearing))
    square = line[..., :, None] * line[..., None, :]
    along = (ALONG * range_resolution) ** 2
    across = (ACROSS * beam_width * np.asarray(range_))[..., None, None] ** 2
    return along * square + across * (np.eye(2) - square)
