"""The radars whose plots one tracker fuses, each with its own accuracy, range and period.

One YAML text, a list, describes them:

    - {topic: radar_x/radar/plots, range_sigma_m: 10.0, bearing_sigma_deg: 0.4}
    - {topic: radar_s/radar/plots, name: S band, bearing_sigma_deg: 1.0, scan_period_s: 2.4}

If a radar leaves out a parameter, the tracker's parameter of the same name applies.
"""

import dataclasses
import heapq
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from .. import yaml_file
from ..files import shortened, shown
from ..parameters import TrackerParameters
from ..types import Scan

TOPIC = 'radar/plots'
MAX_RADARS = 20
MAX_NAME = 200  # characters
# Parameters that each radar may set.
OWN = (
    'range_sigma_m',
    'bearing_sigma_deg',
    'radial_speed_sigma_mps',
    'scan_period_s',
    'antenna_ahead_m',
    'antenna_starboard_m',
    'bearing_offset_deg',
    'bearings',
    'min_range_m',
    'max_range_m',
    'detection_probability',
)
HELD_REVOLUTIONS = 1.5  # of another radar; this long its plot shows that the target is there


class Radar(NamedTuple):
    """One radar.

    name        '' if there is only one
    topic       of its plots
    parameters  the tracker's, with this radar's own values
    """

    name: str
    topic: str
    parameters: TrackerParameters


def radars_of(parameters: TrackerParameters) -> tuple[Radar, ...]:
    """The radars of the parameter `radars`; one on `radar/plots` if it is empty.

    ValueError names the radar, the key, the value and the allowed values.
    """
    items = yaml_file.parse(parameters.radars, 'parameter radars')
    if items is None:
        return (Radar('', TOPIC, parameters),)
    if not isinstance(items, list) or not items:
        raise ValueError(
            f'radars are {shown(items)}; they must be a list of mappings, each with topic'
        )
    if len(items) > MAX_RADARS:
        raise ValueError(f'there are {len(items)} radars; there may be {MAX_RADARS}')
    radars = tuple(_radar(item, place, parameters) for place, item in enumerate(items, 1))
    for what, values in (('name', [r.name for r in radars]), ('topic', [r.topic for r in radars])):
        if len(set(values)) < len(values):
            told = shortened(', '.join(values))
            raise ValueError(f'radars have the {what}s {told}; each must differ')
    return radars


def fused(of_each: Sequence[Mapping[str, Any]], names: Sequence[str]) -> dict[str, Any]:
    """Tracker parameters of several radars, from their own parameters and their names.

    Other parameters come from the first radar that has them.
    """
    together: dict[str, Any] = {}
    for one in reversed(of_each):
        together.update((key, value) for key, value in one.items() if key not in OWN)
    items = [
        {'topic': f'{name}/{TOPIC}', **{key: one[key] for key in OWN if key in one}}
        for name, one in zip(names, of_each, strict=True)
    ]
    return {**together, 'radars': json.dumps(items)}


def merged(*radars: Iterable[Scan]) -> Iterator[Scan]:
    """The scans of several radars in the order in which a tracker takes them: by their ends."""

    def of(radar: int, scans: Iterable[Scan]) -> Iterator[Scan]:
        return (scan._replace(radar=radar) for scan in scans)

    return heapq.merge(*(of(*pair) for pair in enumerate(radars)), key=lambda scan: scan.end)


def held_updates(radars: tuple[Radar, ...]) -> int:
    """Number of updates of a track that may be later than a plot that comes in now.

    A plot is at most one revolution old when its scan is complete.
    """
    periods = [radar.parameters.scan_period_s for radar in radars]
    return max(
        sum(int(period // other) + 1 for k, other in enumerate(periods) if k != place)
        for place, period in enumerate(periods)
    )


def _radar(item: Any, place: int, parameters: TrackerParameters) -> Radar:
    if not isinstance(item, dict) or not isinstance(item.get('topic'), str):
        raise ValueError(f'radar {place} is {shown(item)}; it must be a mapping with a topic')
    topic, own = item['topic'], {k: v for k, v in item.items() if k not in ('topic', 'name')}
    name = item.get('name', topic.removesuffix(TOPIC).strip('/') or topic)
    name = name if isinstance(name, str) else shown(name)
    for what, text in (('topic', topic), ('name', name)):
        if len(text) > MAX_NAME:
            raise ValueError(
                f'radar {place}: {what} is {shown(text)}; it may have {MAX_NAME} characters'
            )
    for key in own:
        if key not in OWN:
            raise ValueError(f'radar {name} has {key}; it may have topic, name, {", ".join(OWN)}')
    try:
        return Radar(name, topic, dataclasses.replace(parameters, **own))
    except ValueError as error:
        raise ValueError(f'radar {name}: {error}') from error
