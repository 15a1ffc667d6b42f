"""What the tracker's parameters tell the page: its radars, how they are mounted, its zones."""

import dataclasses
from typing import Any

from ..arpa import zone_text
from ..parameters import TrackerParameters
from ..tracking.radars import Radar, radars_of
from .diagnostics import one_line
from .display_commands import MOUNTING
from .display_zones import NAME as ZONES


def radars_told(values: dict[str, Any], plots_topic: str) -> list[Radar]:
    """The tracker's radars, by its parameters; only how they are mounted is theirs.

    plots_topic  of a tracker with one radar
    """
    given = {name: values[name] for name in MOUNTING if values.get(name) is not None}
    radars = radars_of(dataclasses.replace(TrackerParameters(), **given))
    return [radar if radar.name else radar._replace(topic=plots_topic) for radar in radars]


def zones_told(values: dict[str, Any]) -> dict[str, Any]:
    """The zones in m and rad; where they cannot be read, why."""
    try:
        return {'zones': zone_text.plain(values.get(ZONES) or ''), 'error': ''}
    except ValueError as error:
        return {'zones': [], 'error': one_line(error)}
