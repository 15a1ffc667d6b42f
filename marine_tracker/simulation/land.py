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
    key = section.one_of('corners')
    key, unit = next(
        (f'{key}_{u}', size)
        for u, size in (('m', 1.0), ('nm', NAUTICAL_MILE))
        if f'{key}_{u}' in section
    )
    closed = section.values.get('closed', False)
    if not isinstance(closed, bool):
        raise ValueError(f'{section.place("closed")} is {shown(closed)}; it must be true or false')
    corners = [
        _corner(corner, section.place(f'{key}[{place}]'), unit)
        for place, corner in enumerate(section.items(key))
    ]
    least = 3 if closed else 2
    if len(corners) < least:
        raise ValueError(
            f'{section.place(key)} has {len(corners)} corners; it must have at least {least}'
        )
    if closed:
        corners.append(corners[0])
    for place, (first, second) in enumerate(zip(corners, corners[1:])):
        if first == second:
            raise ValueError(f'{section.place(key)}[{place}] is the same as the corner after it')
    return Shore(
        section.text('name', f'land {number + 1}'),
        np.array(corners),
        section.number('snr_db', 0.0, 60.0, SNR_DB),
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
