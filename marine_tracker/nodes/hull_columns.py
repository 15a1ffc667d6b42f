"""The columns of `targets` about size and heading, with extent on."""

from collections.abc import Callable

import numpy as np

from ..arpa.view import HullView
from ..extent.hulls import METHODS, SOURCES
from ..geometry import NAUTICAL_MILE
from ..types import Array, BoolArray, IntArray

COLUMNS = (
    'length_m',
    'length_sd_m',
    'beam_max_m',
    'heading_deg',
    'heading_sd_deg',
    'heading_from',
    'hull_clearance_nm',
    'extent_method',
)
POINT = 'point'  # too small for a size


def columns(
    hulls: HullView, degrees: Callable[[float], str], figure: Callable[[float, int], str]
) -> list[list[str]]:
    """The texts of each column, in the order of COLUMNS, a list of one for each target.

    degrees, figure: how angles and numbers are written.
    """
    shapes = hulls.shapes
    shown = shapes.extended

    def numbers(values, digits):
        return [figure(value, digits) for value in np.where(shown, values, np.nan).tolist()]

    heading = np.where(shown, np.degrees(shapes.heading), np.nan).tolist()
    return [
        numbers(shapes.length, 0),
        numbers(shapes.length_sd, 0),
        numbers(shapes.beam, 0),
        [degrees(value) for value in heading],
        numbers(np.degrees(shapes.heading_sd), 1),
        [
            SOURCES[source] if known else ''
            for source, known in zip(shapes.source.tolist(), shown.tolist())
        ],
        numbers(hulls.clearance / NAUTICAL_MILE, 3),
        [
            METHODS[method] if known else POINT
            for method, known in zip(shapes.method.tolist(), shown.tolist())
        ],
    ]


def outlines(hulls: HullView, alive: BoolArray) -> tuple[Array, IntArray]:
    """Closed outlines [H, K + 1, 2] m about their targets' middles, of the extended ones among
    `alive` [N], and the rows [H] of those."""
    rows = (hulls.shapes.extended & alive).nonzero()[0]
    corners = hulls.shapes.outline[rows]
    return np.concatenate([corners, corners[:, :1]], 1), rows
