"""Checked reading of one zone's mapping: every ValueError names the zone, the key and the limits.

Scalars come as text (see zones.parse).
"""

import math
from typing import Any

import numpy as np

from ..files import shown
from ..geometry import NAUTICAL_MILE
from ..types import Array

KEYS = ('name', 'kind', 'range_nm', 'range_m', 'bearing_deg', 'corners_nm', 'corners_m', 'fixed_to')
UNITS = {'nm': NAUTICAL_MILE, 'm': 1.0}
LONGEST_NAME = 80  # characters
MAX_CORNERS = 1000
FARTHEST = 200 * NAUTICAL_MILE  # m, limit of ranges and corners


def name_of(item: Any, index: int, taken: list[str]) -> str:
    """The zone's name, which no zone before it may have. Its keys must be known."""
    if not isinstance(item, dict):
        raise ValueError(
            f'zone {index + 1} is {shown(item)}; it must be a mapping with name, '
            'kind and range_nm or corners_m'
        )
    name = item.get('name', '')
    if not isinstance(name, str) or not name.strip():
        raise ValueError(f'zone {index + 1} has no name')
    name = name.strip()
    if len(name) > LONGEST_NAME:
        raise ValueError(
            f'zone {index + 1} has a name of {len(name)} characters; it must have at most '
            f'{LONGEST_NAME}, for alarms repeat it'
        )
    if name in taken:
        raise ValueError(f'two zones have the name {name}')
    for key in item:
        if key not in KEYS:
            raise ValueError(
                f'zone {name}: {shown(key)} is not known; it may be one of {", ".join(KEYS)}'
            )
    return name


def choice_of(
    name: str, item: dict[str, Any], key: str, choices: tuple[str, ...], default: str = ''
) -> str:
    """One of the allowed words."""
    value = item.get(key, default)
    if value not in choices:
        raise ValueError(
            f'zone {name}: {key} is {shown(value)}; it must be one of {", ".join(choices)}'
        )
    found: str = value
    return found


def outline_of(name: str, item: dict[str, Any]) -> str:
    """The key that holds the outline."""
    given = [key for key in item if key.startswith(('range', 'corners'))]
    if len(given) != 1:
        raise ValueError(
            f'zone {name} has {" and ".join(given) or "no outline"}; it must have one '
            'of range_nm, range_m, corners_nm, corners_m'
        )
    wrong = 'fixed_to' if given[0].startswith('range') else 'bearing_deg'
    if wrong in item:
        raise ValueError(f'zone {name}: {wrong} does not go with {given[0]}')
    return given[0]


def sector_of(name: str, item: dict[str, Any], key: str) -> tuple[float, float, float, float]:
    """near, far m; start, width rad."""
    unit = UNITS[key.removeprefix('range_')]
    near, far = unit * two_numbers(name, key, item[key], 0.0, FARTHEST / unit)
    if not near < far:
        raise ValueError(
            f'zone {name}: {key} is {shown(item[key])}; the first must be below the second'
        )
    if 'bearing_deg' not in item:
        return near, far, 0.0, math.inf
    start, end = two_numbers(name, 'bearing_deg', item['bearing_deg'], -360.0, 360.0)
    width = (end - start) % 360.0
    if not width:
        raise ValueError(
            f'zone {name}: bearing_deg is {shown(item["bearing_deg"])}, from a '
            'bearing to itself; leave it out for a full ring'
        )
    return near, far, math.radians(start), math.radians(width)


def corners_of(name: str, item: dict[str, Any], key: str) -> Array:
    """The polygon's corners [V, 2] m."""
    values = item[key]
    if not isinstance(values, list) or not 3 <= len(values) <= MAX_CORNERS:
        raise ValueError(
            f'zone {name}: {key} is {shown(values)}; it must be a list of 3 to '
            f'{MAX_CORNERS} corners'
        )
    unit = UNITS[key.removeprefix('corners_')]
    limit = FARTHEST / unit
    corners = unit * np.array(
        [
            two_numbers(name, f'{key}[{index}]', pair, -limit, limit)
            for index, pair in enumerate(values)
        ]
    )
    if _crosses_itself(corners):
        raise ValueError(
            f'zone {name}: the sides of {key} cross each other, have no length or enclose nothing'
        )
    return corners


def two_numbers(name: str, key: str, values: Any, low: float, high: float) -> Array:
    """Two numbers."""
    try:
        numbers = [float(value) for value in values] if isinstance(values, list) else []
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != 2 or not all(low <= number <= high for number in numbers):
        raise ValueError(
            f'zone {name}: {key} is {shown(values)}; it must be two numbers between '
            f'{low:g} and {high:g}'
        )
    return np.array(numbers)


def _crosses_itself(corners: Array) -> bool:
    """Whether two sides of the polygon cross, one has no length, or there is no area."""
    start, side = corners, np.roll(corners, -1, 0) - corners
    if not side.any(1).all():
        return True

    def beside(point: Array) -> Array:
        """Sign [V, V]: on which side of side i point j lies."""
        to = point[None] - start[:, None]
        return np.sign(side[:, None, 0] * to[..., 1] - side[:, None, 1] * to[..., 0])

    begin, end = beside(start), beside(np.roll(start, -1, 0))
    parts = begin * end < 0
    (x, y), (next_x, next_y) = corners.T, np.roll(corners, -1, 0).T
    return bool((parts & parts.T).any()) or not x @ next_y - y @ next_x
