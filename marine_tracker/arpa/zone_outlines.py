"""The outlines of zones as line segments, to draw."""

import numpy as np

from ..geometry import unit_vector
from ..types import Array
from .zones import Zones

ARC_STEP = np.radians(5)


def outlines(zones: Zones, guard: bool, own_position: Array, heading: float) -> Array:
    """Segments [S, 2, 2] m, east and north, of all guard zones, or of all exclusion zones.

    own_position [2] m; heading rad, true. If the heading is nan, zones that turn with own ship are
    left out, except full rings.
    """
    parts = [np.zeros((0, 2, 2))]
    sectors = zones.sectors
    for zone, near, far, start, width in zip(*sectors):
        ring = np.isinf(width)
        if zones.guard[zone] != guard or not (ring or np.isfinite(heading)):
            continue
        first, turn = (0.0, 2 * np.pi) if ring else (heading + start, width)
        angles = first + np.linspace(0, turn, int(np.ceil(turn / ARC_STEP)) + 1)
        arcs = [own_position + radius * unit_vector(angles) for radius in (near, far)]
        parts += [np.stack([arc[:-1], arc[1:]], 1) for arc in arcs]
        if not ring:
            parts.append(np.stack([arcs[0][[0, -1]], arcs[1][[0, -1]]], 1))
    ahead, starboard = unit_vector(heading), unit_vector(heading + np.pi / 2)
    for polygon in zones.polygons:
        if zones.guard[polygon.zone] != guard or not (polygon.ground or np.isfinite(heading)):
            continue
        sides = np.stack([polygon.start, polygon.end], 1)
        parts.append(
            sides
            if polygon.ground
            else own_position + sides[..., :1] * starboard + sides[..., 1:] * ahead
        )
    return np.concatenate(parts)
