"""Ships as many scatterers: along the hull's outline, and on deck.

Scatterers of the outline are seen only from the side they face, so the near side of a ship is lit.
The weaker ones on deck are always seen. All fluctuate from scan to scan, independently of each
other (Swerling 1), because a ship moves through many wavelengths between scans. Their mean power is
the same at all ranges, because of the receiver's sensitivity time control.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import unit_vector
from ..types import Array, BoolArray
from .ships import Fleet

SPACING = 4.0  # m, of scatterers along the outline
DECK_SPACING = 6.0  # m, along the middle line
DECK_POWER = 0.3  # of the power of a scatterer on the outline
DECK_WIDTH = 0.5  # of the beam; width of the strip where they lie
MIDDLE_LINE = np.array([[0.45, 0.0], [-0.45, 0.0]])  # in lengths, forward and to starboard
# Outline in half lengths forward and half beams to starboard, clockwise from the bow.
OUTLINE = np.array([[1.0, 0.0], [0.6, 1.0], [-1.0, 1.0], [-1.0, -1.0], [0.6, -1.0], [1.0, 0.0]])


class Scatterers(NamedTuple):
    """S scatterers of all hulls, fixed to their ships.

    target  [S]     number of the ship, from 1
    place   [S, 2]  m, forward and to starboard of the ship's middle
    normal  [S, 2]  likewise, the way an outline faces; 0 on deck
    power   [S]     mean, over that of noise
    """

    target: NDArray[np.int64]
    place: Array
    normal: Array
    power: Array


def outline(length: float, beam: float) -> Array:
    """Corners [6, 2] m of a hull, forward and to starboard. The last one repeats the first."""
    return OUTLINE * [0.5 * length, 0.5 * beam]


def scatterers(fleet: Fleet, random: np.random.Generator) -> Scatterers:
    """The scatterers of all ships that have a hull."""
    none, pairs = np.zeros(0), np.zeros((0, 2))
    parts = [Scatterers(np.zeros(0, np.int64), pairs, pairs, none)]
    for ship in np.flatnonzero(np.isfinite(fleet.hulls.beam)):
        length, beam = fleet.length[ship], fleet.hulls.beam[ship]
        place, normal = along(outline(length, beam), SPACING, random)
        on_deck, _ = along(length * MIDDLE_LINE, DECK_SPACING, random)
        deck = len(on_deck)
        on_deck[:, 1] = beam * DECK_WIDTH * (random.random(deck) - 0.5)
        power = 10 ** (0.1 * fleet.hulls.snr_db[ship]) * np.repeat(
            [1.0, DECK_POWER], [len(place), deck]
        )
        parts.append(
            Scatterers(
                np.full(len(power), ship + 1),
                np.concatenate([place, on_deck]),
                np.concatenate([normal, np.zeros((deck, 2))]),
                power,
            )
        )
    return Scatterers(*map(np.concatenate, zip(*parts, strict=True)))


def along(corners: Array, spacing: float, random: np.random.Generator) -> tuple[Array, Array]:
    """Points [P, 2] m, one on each stretch of about `spacing` m of a line, and its normals [P, 2].

    corners [C, 2] m; the normals, of unit length, point outward where a line runs as OUTLINE does.
    """
    points, normals = [], []
    for first, second in zip(corners[:-1], corners[1:]):
        way = second - first
        length = np.hypot(*way)
        count = max(round(length / spacing), 1)
        share = (np.arange(count) + random.random(count)) / count
        points.append(first + share[:, None] * way)
        normals.append(np.tile([way[1] / length, -way[0] / length], (count, 1)))
    return np.concatenate(points), np.concatenate(normals)


def place(of: Scatterers, middle: Array, heading: Array, own: Array) -> tuple[Array, BoolArray]:
    """Offsets [S, 2] m, east and north, from the ships' middles, and which [S] are lit.

    middle [S, 2] m and heading [S] rad of each scatterer's ship; own [S, 2] m: the radar.
    """
    forward = unit_vector(heading)
    starboard = np.stack([forward[:, 1], -forward[:, 0]], -1)
    offset, faces = (a[:, :1] * forward + a[:, 1:] * starboard for a in (of.place, of.normal))
    to_radar = own - middle - offset
    return offset, (faces * to_radar).sum(1) >= 0
