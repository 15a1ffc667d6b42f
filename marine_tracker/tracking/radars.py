"""The radars whose plots one tracker fuses, each with accuracy, range and period of its own.

One YAML text, a list, describes them:

    - {topic: radar_x/radar/plots, range_sigma_m: 10.0, bearing_sigma_deg: 0.4}
    - {topic: radar_s/radar/plots, name: S band, bearing_sigma_deg: 1.0, scan_period_s: 2.4}

What a radar leaves out is that of the tracker's parameter of the same name.
"""

import dataclasses
import heapq
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import yaml

from ..parameters import TrackerParameters
from ..types import Scan

TOPIC = 'radar/plots'
# Parameters that a radar may have for itself.
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
HELD_REVOLUTIONS = 1.5  # of another radar: so long its plot shows that the target is there


class Radar(NamedTuple):
    """One radar.

    name        '' where there is only one
    topic       of its plots
    parameters  the tracker's, with this radar's own in their place
    """

    name: str
    topic: str
    parameters: TrackerParameters


def radars_of(parameters: TrackerParameters) -> tuple[Radar, ...]:
    """The radars of the parameter `radars`; one on `radar/plots` where it is empty.

    ValueError names the radar, the key, the value and what it may be.
    """
    try:
        items = yaml.safe_load(parameters.radars)
    except yaml.YAMLError as error:
        raise ValueError(f'radars are not YAML: {error}') from error
    if items is None:
        return (Radar('', TOPIC, parameters),)
    if not isinstance(items, list) or not items:
        raise ValueError(f'radars are {items!r}; they must be a list of mappings, each with topic')
    radars = tuple(_radar(item, place, parameters) for place, item in enumerate(items, 1))
    for what, values in (('name', [r.name for r in radars]), ('topic', [r.topic for r in radars])):
        if len(set(values)) < len(values):
            raise ValueError(f'radars have the {what}s {", ".join(values)}; each must differ')
    return radars


def fused(of_each: Sequence[Mapping[str, Any]], names: Sequence[str]) -> dict[str, Any]:
    """Tracker parameters of several radars, whose own parameters and names are given.

    What is not a radar's own is the first one's that has it.
    """
    together: dict[str, Any] = {}
    for one in reversed(of_each):
        together.update((key, value) for key, value in one.items() if key not in OWN)
    items = [
        {'topic': f'{name}/{TOPIC}', **{key: one[key] for key in OWN if key in one}}
        for name, one in zip(names, of_each, strict=True)
    ]
    return {**together, 'radars': yaml.safe_dump(items, sort_keys=False)}


def merged(*radars: Iterable[Scan]) -> Iterator[Scan]:
    """The scans of several radars as a tracker takes them: each when it ends."""

    def of(radar, scans):
        return (scan._replace(radar=radar) for scan in scans)

    return heapq.merge(*(of(*pair) for pair in enumerate(radars)), key=lambda scan: scan.end)


def held_updates(radars: tuple[Radar, ...]) -> int:
    """Updates of a track that may be later than a plot that has only now come in.

    A plot is at most one revolution old when its scan is complete.
    """
    periods = [radar.parameters.scan_period_s for radar in radars]
    return max(
        sum(int(period // other) + 1 for k, other in enumerate(periods) if k != place)
        for place, period in enumerate(periods)
    )


def _radar(item, place: int, parameters: TrackerParameters) -> Radar:
    if not isinstance(item, dict) or not isinstance(item.get('topic'), str):
        raise ValueError(f'radar {place} is {item!r}; it must be a mapping with a topic')
    topic, own = item['topic'], {k: v for k, v in item.items() if k not in ('topic', 'name')}
    name = str(item.get('name', topic.removesuffix(TOPIC).strip('/') or topic))
    for key in own:
        if key not in OWN:
            raise ValueError(f'radar {name} has {key}; it may have topic, name, {", ".join(OWN)}')
    try:
        return Radar(name, topic, dataclasses.replace(parameters, **own))
    except ValueError as error:
        raise ValueError(f'radar {name}: {error}') from error
