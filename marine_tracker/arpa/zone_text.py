"""The parameter `zones` as a page edits it: read into plain values, one zone put in or taken out.

The zones that are not touched stay as they were written, in their own units and keys. The result is
JSON, which is YAML, too.
"""

import json
import math
from typing import Any

from .. import yaml_file
from . import zone_fields, zones


def plain(text: str) -> list[dict[str, Any]]:
    """The zones of a text, in m and rad. ValueError where it is wrong (zones.parse).

    name, kind   as written
    fixed_to     ship or ground
    range        m, nearest and farthest; None for a polygon
    bearing      rad: the first side, clockwise from the bow, and the width; None for ring, polygon
    corners      [starboard, ahead] of own ship or [east, north] in `map`, m; None for a sector
    """
    zones.parse(text)
    return [_plain(item) for item in _items(text)]


def put(text: str, zone: dict[str, Any], was: str = '') -> str:
    """The text with one zone more, or with `zone` in place of the one named `was`.

    ValueError where there is no such zone any more, or where the result is wrong.
    """
    items = _items(text)
    if was:
        items[_place(items, was)] = zone
    else:
        items.append(zone)
    return _checked(items)


def without(text: str, name: str) -> str:
    """The text without the zone of this name. ValueError where there is none."""
    items = _items(text)
    del items[_place(items, name)]
    return _checked(items)


def _items(text: str) -> list[dict[str, Any]]:
    return yaml_file.parse(text, 'parameter zones', as_text=True) or []


def _place(items: list[dict[str, Any]], name: str) -> int:
    for place, item in enumerate(items):
        if str(item.get('name', '')).strip() == name:
            return place
    raise ValueError(f'there is no zone {name} any more')


def _checked(items: list[dict[str, Any]]) -> str:
    text = json.dumps(items, ensure_ascii=False) if items else ''
    zones.parse(text)
    return text


def _plain(item: dict[str, Any]) -> dict[str, Any]:
    name = item['name'].strip()
    outline = zone_fields.outline_of(name, item)
    found: dict[str, Any] = {
        'name': name,
        'kind': item['kind'],
        'fixed_to': item.get('fixed_to', 'ship'),
        'range': None,
        'bearing': None,
        'corners': None,
    }
    if outline.startswith('corners'):
        return found | {'corners': zone_fields.corners_of(name, item, outline).tolist()}
    near, far, start, width = map(float, zone_fields.sector_of(name, item, outline))
    sides = None if math.isinf(width) else [start, width]
    return found | {'range': [near, far], 'bearing': sides}
