"""Land by a file of polygons: plots on land begin no track.

The file is GeoJSON (RFC 7946): polygons and multi-polygons, alone or in features and collections.
With an origin their coordinates are longitude and latitude, deg; without one they are east and
north, m, of the local positions. A point is on land if it is in a polygon and in none of its holes.
"""

import json
import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from ..files import read_text, shortened, shown
from ..geodesy import LocalFrame
from ..types import Array, BoolArray, IntArray

MAX_BYTES = 50_000_000
MAX_CORNERS = 1_000_000
BINS = 4096  # strips of north, for which the edges are sorted
NESTED = {'FeatureCollection': 'features', 'GeometryCollection': 'geometries'}


class LandMask(NamedTuple):
    """E edges of polygons, sorted into strips of north.

    first, last  [E, 2]  m, east and north
    polygon      [E]     to which it belongs, its holes too
    south        m, where the strips begin; height m of each
    begin        [BINS + 1]  of each strip in `edge`: the edges that reach into it
    edge         [K]
    """

    first: Array
    last: Array
    polygon: IntArray
    south: float
    height: float
    begin: IntArray
    edge: IntArray


def read(path: str, origin: str) -> LandMask | None:
    """The mask of a file; None if the path is empty.

    origin  latitude and longitude, deg, in a text; '' if the file is in metres
    ValueError, in one line, for a file or an origin that is wrong.
    """
    frame = frame_of(origin)
    if not path:
        return None
    name = shortened(path)
    try:
        document = json.loads(read_text(path, MAX_BYTES))
    except OSError as error:
        raise ValueError(f'land_mask {name} cannot be read: {error.strerror}') from error
    except RecursionError:
        raise ValueError(f'land_mask {name} is nested too deeply') from None
    except json.JSONDecodeError as error:
        raise ValueError(f'land_mask {name}, line {error.lineno}: {error.msg}') from error
    try:
        return of_polygons(list(_polygons(document, frame)))
    except RecursionError:
        raise ValueError(f'land_mask {name} is nested too deeply') from None
    except ValueError as error:
        raise ValueError(f'land_mask {name}: {error}') from error


def frame_of(origin: str) -> LocalFrame | None:
    """The local frame of an origin "63.43 10.39"; None for ''. ValueError if it is none."""
    if not origin.strip():
        return None
    parts = origin.replace(',', ' ').split()
    try:
        latitude, longitude = map(float, parts)
    except ValueError:
        latitude = longitude = math.nan
    if not (abs(latitude) <= 90 and abs(longitude) <= 180):
        raise ValueError(
            f'parameter land_mask_origin is {shown(origin)}; it must be a latitude within 90 and a '
            'longitude within 180 degrees, as in "63.43 10.39"'
        )
    return LocalFrame(latitude, longitude)


def of_polygons(polygons: list[list[Array]]) -> LandMask:
    """The mask of polygons, each a list of rings [C, 2] m; the first is its outline. ValueError if
    there is none, or if there are too many corners."""
    rings = [(number, ring) for number, rings in enumerate(polygons) for ring in rings]
    count = sum(len(ring) for _, ring in rings)
    if not rings:
        raise ValueError('there is no polygon in it')
    if count > MAX_CORNERS:
        raise ValueError(f'the polygons have {count} corners; they may have {MAX_CORNERS}')
    first = np.concatenate([ring for _, ring in rings])
    last = np.concatenate([np.roll(ring, -1, 0) for _, ring in rings])
    polygon = np.concatenate([np.full(len(ring), number) for number, ring in rings])
    low, high = (edge(first[:, 1], last[:, 1]) for edge in (np.minimum, np.maximum))
    south, height = float(low.min()), max(float(np.ptp(first[:, 1])) / BINS, 1e-3)
    begin = np.clip(((low - south) / height).astype(np.int64), 0, BINS - 1)
    strips = np.clip(((high - south) / height).astype(np.int64), 0, BINS - 1) - begin + 1
    edge = np.arange(len(first)).repeat(strips)
    strip = np.arange(len(edge)) - (strips.cumsum() - strips - begin).repeat(strips)
    order = strip.argsort(kind='stable')
    return LandMask(
        first,
        last,
        polygon,
        south,
        height,
        strip[order].searchsorted(np.arange(BINS + 1)),
        edge[order],
    )


def on_land(mask: LandMask | None, position: Array) -> BoolArray:
    """Which positions [M, 2] m are on land: a line to the east crosses the edges of a polygon an
    odd number of times. Without a mask none is."""
    if mask is None:
        return np.zeros(len(position), bool)
    east, north = position.T
    strip = np.floor((north - mask.south) / mask.height)
    inside = (strip >= 0) & (strip <= BINS)
    strip = np.where(inside, np.minimum(strip, BINS - 1), 0).astype(np.int64)
    begin = mask.begin[strip]
    count = np.where(inside, mask.begin[strip + 1] - begin, 0)
    point = np.arange(len(east)).repeat(count)
    edge = mask.edge[np.arange(len(point)) - (count.cumsum() - count - begin).repeat(count)]
    (e1, n1), (e2, n2) = mask.first[edge].T, mask.last[edge].T
    spans = (n1 <= north[point]) != (n2 <= north[point])
    point, edge, e1, n1, e2, n2 = (a[spans] for a in (point, edge, e1, n1, e2, n2))
    crossing = e1 + (north[point] - n1) / (n2 - n1) * (e2 - e1)
    east_of = crossing > east[point]
    key = point[east_of] * (int(mask.polygon[-1]) + 1) + mask.polygon[edge[east_of]]
    found, crossed = np.unique(key, return_counts=True)
    land = np.zeros(len(east), bool)
    land[found[crossed % 2 == 1] // (int(mask.polygon[-1]) + 1)] = True
    return land


def _polygons(part: Any, frame: LocalFrame | None) -> Iterator[list[Array]]:
    """The polygons of a GeoJSON object."""
    kind = part.get('type') if isinstance(part, dict) else None
    if kind in NESTED:
        items = part.get(NESTED[kind])
        if not isinstance(items, list):
            raise ValueError(f'{kind} has no list of {NESTED[kind]}')
        for item in items:
            yield from _polygons(item, frame)
    elif kind == 'Feature':
        if part.get('geometry') is not None:
            yield from _polygons(part['geometry'], frame)
    elif kind == 'Polygon':
        yield _rings(part.get('coordinates'), frame)
    elif kind == 'MultiPolygon':
        coordinates = part.get('coordinates')
        if not isinstance(coordinates, list):
            raise ValueError(f'a MultiPolygon has the coordinates {shown(coordinates)}')
        for one in coordinates:
            yield _rings(one, frame)
    elif kind not in ('Point', 'MultiPoint', 'LineString', 'MultiLineString'):
        raise ValueError(f'{shown(part)} is no GeoJSON object')


def _rings(rings: Any, frame: LocalFrame | None) -> list[Array]:
    if not isinstance(rings, list) or not rings:
        raise ValueError(f'a polygon has the coordinates {shown(rings)}; it must have rings')
    return [_ring(ring, frame) for ring in rings]


def _ring(ring: Any, frame: LocalFrame | None) -> Array:
    """Corners [C, 2] m of a ring."""
    try:
        corners = np.array([corner[:2] for corner in ring], float).reshape(-1, 2)
    except (TypeError, ValueError, OverflowError, IndexError):
        corners = np.zeros((0, 2))
    if len(corners) < 4 or not np.isfinite(corners).all():
        raise ValueError(
            f'a ring is {shown(ring)}; it must be a list of 4 or more pairs of numbers'
        )
    if frame is None:
        return corners
    longitude, latitude = corners.T
    if (np.abs(latitude) > 90).any() or (np.abs(longitude) > 180).any():
        raise ValueError(
            f'a ring has {shown(ring)}; longitudes must be within 180 and latitudes within 90 deg '
            '(leave land_mask_origin empty if they are metres)'
        )
    return frame.to_local(latitude, longitude)
