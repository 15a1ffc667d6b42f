"""Land: shores as scatterers at rest. In each direction the radar sees only the nearest shore."""

import math
from typing import NamedTuple

import numpy as np

from ..files import shown
from ..geometry import NAUTICAL_MILE, to_range_bearing
from ..types import Array, BoolArray
from .fields import Section

SHORE_KEYS = 'name corners_m|corners_nm closed snr_db'
SNR_DB = 30.0
MAX_COORDINATE = 200_000.0  # m
SECTORS = 1800  # number of sectors of the horizon; the nearest shore is found in each


class Shore(NamedTuple):
    """A line of land.

    corners  [C, 2]  m, east and north
    snr_db   mean power over noise of one of its scatterers, dB
    """

    name: str
    corners: Array
    snr_db: float


def read(top: Section) -> tuple[Shore, ...]:
    """The shores under `land` of a scenario file; ValueError names place, value and limit."""
    return tuple(
        _shore(Section(item, f'land[{number}]', SHORE_KEYS), number)
        for number, item in enumerate(top.items('land'))
    )


def _shore(section, number):
    closed = section.values.get('closed', False)
    if not isinstance(closed, bool):
        raise ValueError(f'{section.place("closed")} is {shown(closed)}; it must be true or false')
    corners = corners_of(section, 'corners', 3 if closed else 2)
    if closed:
        corners.append(corners[0])
    for place, (first, second) in enumerate(zip(corners, corners[1:])):
        if first == second:
            where = section.place(_spelled(section, 'corners')[0])
            raise ValueError(f'{where}[{place}] is the same as the corner after it')
    return Shore(
        section.text('name', f'land {number + 1}'),
        np.array(corners),
        section.number('snr_db', 0.0, 60.0, SNR_DB),
    )


def corners_of(section: Section, stem: str, least: int) -> list[tuple[float, float]]:
    """(east, north) m of the pairs [north, east] under `stem_m` or `stem_nm`, at least so many;
    ValueError names place, value and limit."""
    section.one_of(stem)
    key, unit = _spelled(section, stem)
    corners = [
        _corner(corner, section.place(f'{key}[{place}]'), unit)
        for place, corner in enumerate(section.items(key))
    ]
    if len(corners) < least:
        raise ValueError(
            f'{section.place(key)} has {len(corners)} {stem}; it must have at least {least}'
        )
    return corners


def _spelled(section, stem):
    """The key that is given, and the size of its unit in m."""
    return next(
        (f'{stem}_{u}', size)
        for u, size in (('m', 1.0), ('nm', NAUTICAL_MILE))
        if f'{stem}_{u}' in section
    )


def _corner(corner, where, unit):
    """(east, north) m of a pair [north, east]."""
    if not (
        isinstance(corner, list)
        and len(corner) == 2
        and all(
            type(value) in (int, float)
            and math.isfinite(value)
            and abs(value) * unit <= MAX_COORDINATE
            for value in corner
        )
    ):
        raise ValueError(
            f'{where} is {shown(corner)}; it must be [north, east], numbers within '
            f'{MAX_COORDINATE / unit:g}'
        )
    north, east = corner
    return east * unit, north * unit


def lit(offset: Array, edge: Array, depth: float) -> BoolArray:
    """Which of the scatterers at offsets [S, 2] m from the radar are not hidden by nearer land.

    edge   [E, 2]  m, offsets of points along all shores, close to each other
    depth  m behind an edge; what is farther is hidden
    """
    nearest = np.full(SECTORS, np.inf)
    distance, sector = _polar(edge)
    np.minimum.at(nearest, sector, distance)
    distance, sector = _polar(offset)
    return distance <= nearest[sector] + depth


def _polar(offset):
    distance, bearing = to_range_bearing(offset)
    return distance, (bearing * (SECTORS / (2 * np.pi))).astype(np.int64) % SECTORS
