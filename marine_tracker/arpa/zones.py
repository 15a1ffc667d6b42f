"""Zones on the radar picture: guard zones, which acquire and alarm, and exclusion zones.

A zone is a sector annulus relative to own ship's heading, a polygon that goes with own ship, or a
polygon fixed to the ground. One YAML text, a list, describes them all:

    - {name: ahead, kind: guard, range_nm: [2, 3], bearing_deg: [315, 045]}
    - {name: ring, kind: guard, range_nm: [5.5, 6]}
    - {name: wake, kind: exclusion, corners_m: [[-80, -900], [80, -900], [30, 0], [-30, 0]]}
    - {name: quay, kind: exclusion, fixed_to: ground, corners_m: [[0, 0], [900, 0], [900, 400]]}

Sector bearings are relative to the heading, from the first clockwise to the second; without them
the zone is a full ring. Corners are [starboard, ahead] of own ship, or, of a zone fixed to the
ground, [east, north] in the frame `map`.
"""

import hashlib
from typing import Any, NamedTuple

import numpy as np

from .. import yaml_file
from ..files import shown
from ..geometry import to_range_bearing, unit_vector, wrap_bearing
from ..types import Array, BoolArray, IntArray
from . import zone_fields

MAX_ZONES = 100
HAIR = 1e-9  # rad


class Sectors(NamedTuple):
    """Sector annuli relative to own ship's heading.

    zone       [S]  index of the zone
    near, far  [S]  m
    start      [S]  rad clockwise from the heading, of the first side
    width      [S]  rad, clockwise from there; inf for a full ring
    """

    zone: IntArray
    near: Array
    far: Array
    start: Array
    width: Array


class Polygon(NamedTuple):
    """One polygon.

    zone        index of the zone
    ground      whether it is fixed to the ground ([east, north]) or to own ship ([starboard,
                ahead])
    start, end  [V, 2]  m, its sides, each from its lower end (in the second coordinate) up: so
                        two polygons compute the same of a side they share
    """

    zone: int
    ground: bool
    start: Array
    end: Array


class Zones(NamedTuple):
    """Z zones.

    name      their names, all different
    guard     [Z]  guard zone, else exclusion zone
    key       [Z]  a number for the zone: the same name, kind and outline give the same key
    sectors, polygons   their outlines
    """

    name: tuple[str, ...]
    guard: BoolArray
    key: IntArray
    sectors: Sectors
    polygons: tuple[Polygon, ...]


def parse(text: str) -> Zones:
    """The zones of a YAML text (see the module); '' gives none.

    ValueError names the zone, the key, the value and what it may be.
    """
    items = yaml_file.parse(text, 'parameter zones', as_text=True) or []
    if not isinstance(items, list):
        raise ValueError(
            f'zones are {shown(items)}; they must be a list of '
            'mappings, each with name, kind and range_nm or corners_m'
        )
    if len(items) > MAX_ZONES:
        raise ValueError(f'there are {len(items)} zones; there may be {MAX_ZONES}')
    names: list[str] = []
    guard, key = np.zeros(len(items), bool), np.zeros(len(items), np.int64)
    sectors, polygons = [], []
    for index, item in enumerate(items):
        name = zone_fields.name_of(item, index, names)
        names.append(name)
        guard[index] = zone_fields.choice_of(name, item, 'kind', ('guard', 'exclusion')) == 'guard'
        outline = zone_fields.outline_of(name, item)
        if outline.startswith('range'):
            shape: tuple[Any, ...] = zone_fields.sector_of(name, item, outline)
            sectors.append((index, *shape))
        else:
            ground = (
                zone_fields.choice_of(name, item, 'fixed_to', ('ship', 'ground'), 'ship')
                == 'ground'
            )
            corners = zone_fields.corners_of(name, item, outline)
            shape = (ground, corners.tolist())
            polygons.append(_polygon(index, ground, corners))
        key[index] = _key(name, guard[index], shape)
    zone, near, far, start, width = np.array(sectors, float).reshape(-1, 5).T
    return Zones(
        tuple(names),
        guard,
        key,
        Sectors(zone.astype(np.int64), near, far, start, width),
        tuple(polygons),
    )


def inside(zones: Zones, position: Array, own_position: Array, heading: float) -> BoolArray:
    """Mask [N, Z]: which positions [N, 2] m are in which zones.

    own_position [2] m; heading rad, true. If the heading is nan, no position is in a zone that
    depends on it; full rings and zones fixed to the ground still work. The sides of a sector belong
    to it. If two polygons share a side, a position belongs to only one of them.
    """
    sectors = zones.sectors
    mask = np.zeros((len(position), len(zones.name)), bool)
    offset = position - own_position
    distance, bearing = to_range_bearing(offset)
    if len(sectors.zone):
        ring = np.isinf(sectors.width)
        turned = wrap_bearing(bearing[:, None] - heading - sectors.start)
        # HAIR: rounding may put a bearing on the first side just below a whole turn.
        within = ring | (turned <= sectors.width + HAIR) | (turned >= 2 * np.pi - HAIR)
        mask[:, sectors.zone] = (
            within & (distance[:, None] >= sectors.near) & (distance[:, None] <= sectors.far)
        )
    on_ship = distance[:, None] * unit_vector(bearing - heading)
    for polygon in zones.polygons:
        mask[:, polygon.zone] = _within(polygon, position if polygon.ground else on_ship)
    return mask


def _polygon(zone: int, ground: bool, corners: Array) -> Polygon:
    following = np.roll(corners, -1, 0)
    down = (corners[:, 1] > following[:, 1])[:, None]
    return Polygon(
        zone, ground, np.where(down, following, corners), np.where(down, corners, following)
    )


def _within(polygon: Polygon, position: Array) -> BoolArray:
    """Mask [N] of the positions [N, 2] inside the polygon.

    Even-odd rule: a ray towards +x meets an odd number of sides. A corner counts with the side
    above it only.
    """
    (x0, y0), (x1, y1) = polygon.start.T, polygon.end.T
    x, y = position.T
    mask = np.zeros(len(position), bool)
    rows = ((y >= y0.min()) & (y < y1.max()) & (x < max(x0.max(), x1.max()))).nonzero()[0]
    row, side = ((y0 <= y[rows, None]) & (y[rows, None] < y1)).nonzero()
    x, y = x[rows[row]], y[rows[row]]
    met = x < x0[side] + (x1[side] - x0[side]) / (y1[side] - y0[side]) * (y - y0[side])
    mask[rows] = np.bincount(row[met], minlength=len(rows)) % 2
    return mask


def _key(*what: Any) -> int:
    """56 bits of a hash."""
    return int.from_bytes(hashlib.blake2b(repr(what).encode(), digest_size=7).digest(), 'big')
