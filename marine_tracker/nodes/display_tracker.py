"""What the tracker's parameters tell the page: its radars, how they are mounted, its zones."""

import dataclasses
from typing import Any

from ..arpa import zone_text
from ..parameters import TrackerParameters
from ..tracking.radars import radars_of
from .diagnostics import one_line
from .display_commands import MOUNTING
from .display_zones import NAME as ZONES


def radars_told(
    values: dict[str, Any], plots_topic: str
) -> tuple[list[str], list[TrackerParameters]]:
    """The topic of each radar's plots, and its parameters; values as the tracker has them.

    plots_topic  of a tracker with one radar
    """
    given = {name: values[name] for name in MOUNTING if values.get(name) is not None}
    radars = radars_of(dataclasses.replace(TrackerParameters(), **given))
    of_each = [radar.topic if radar.name else plots_topic for radar in radars]
    return of_each, [radar.parameters for radar in radars]


def zones_told(values: dict[str, Any]) -> dict[str, Any]:
    """The zones in m and rad; where they cannot be read, why."""
    try:
        return {'zones': zone_text.plain(values.get(ZONES) or ''), 'error': ''}
    except ValueError as error:
        return {'zones': [], 'error': one_line(error)}
