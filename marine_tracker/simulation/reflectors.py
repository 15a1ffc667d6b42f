"""Fixed things on the ground that often give a plot: quays, bridges, beacons, moored craft.

Each is a point. Its probability of detection is drawn from a span, and drawn anew about every
`spell_s`: tide, wind and the angle of view change what a thing ashore echoes. They are no targets,
so the truth does not hold them.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..files import shown
from ..geometry import to_range_bearing
from ..types import Array, OwnShip
from .echoes import STRONGEST, THRESHOLD
from .fields import Section
from .land import corners_of
from .scenario_radar import ScenarioRadar

KEYS = 'name corners_m|corners_nm places_m|places_nm spacing_m|spacing_nm pd spell_s wander_m'
PD = (0.3, 0.95)
SPELL = 120.0  # s
MOST = 20_000  # points of one scenario


class Reflectors(NamedTuple):
    """Fixed points, F rows.

    place   [F, 2]  m, east and north
    least, most  [F]  the span of the probability of detection
    spell   [F]     s, mean time until the probability is drawn anew
    wander  [F]     m, deviation of each plot, on each axis: a big thing echoes here and there
    """

    place: Array
    least: Array
    most: Array
    spell: Array
    wander: Array


class Seen(NamedTuple):
    """Those of one revolution that are seen, F rows.

    time      [F]  s, when the beam met them
    distance  [F]  m, from own ship at that time
    power     [F]  over noise
    """

    time: Array
    distance: Array
    power: Array


def read(top: Section) -> Reflectors:
    """Those under `reflectors` of a scenario file; ValueError names place, value and limit."""
    parts = [
        _group(Section(item, f'reflectors[{number}]', KEYS))
        for number, item in enumerate(top.items('reflectors'))
    ]
    none = Reflectors(np.empty((0, 2)), *np.empty((4, 0)))
    made = Reflectors(*(np.concatenate(columns) for columns in zip(none, *parts)))
    if len(made.spell) > MOST:
        raise ValueError(f'reflectors make {len(made.spell)} points; there may be {MOST}')
    return made


def _group(section: Section) -> Reflectors:
    section.text('name', 'reflectors')
    if section.one_of('corners', 'places') == 'places':
        if section.has('spacing'):
            raise ValueError(f'{section.where} has a spacing beside places; it goes with corners')
        place = np.array(corners_of(section, 'places', 1))
    else:
        corners = np.array(corners_of(section, 'corners', 2))
        place = _along(corners, section.length('spacing', 1.0, 10_000.0))
    least, most = _span(section)
    size = np.ones(len(place))
    return Reflectors(
        place,
        least * size,
        most * size,
        section.number('spell_s', 1.0, 1e6, SPELL) * size,
        section.number('wander_m', 0.0, 1000.0, 0.0) * size,
    )


def _along(corners: Array, spacing: float) -> Array:
    """Points [F, 2] m along the line of corners, both ends included."""
    run = np.append(0.0, np.hypot(*np.diff(corners, axis=0).T).cumsum())
    at = np.linspace(0.0, run[-1], math.ceil(run[-1] / spacing) + 1)
    return np.stack([np.interp(at, run, axis) for axis in corners.T], -1)


def _span(section: Section) -> tuple[float, float]:
    """The smallest and largest probability of detection: one number, or two in a list."""
    value = section.values.get('pd', list(PD))
    both = value if isinstance(value, list) else [value, value]
    right = len(both) == 2 and all(type(x) in (int, float) and 0 <= x <= 1 for x in both)
    if not right or both[0] > both[1]:
        raise ValueError(
            f'{section.place("pd")} is {shown(value)}; it must be a number between 0 and 1, or the '
            'smallest and the largest one in a list'
        )
    return float(both[0]), float(both[1])


class Chance(NamedTuple):
    """The probability of detection [F] now; and the generator of all chance about reflectors."""

    detection: Array
    random: np.random.Generator


def begin(of: Reflectors, random: np.random.Generator) -> Chance:
    """The chance of the first revolution."""
    return Chance(_drawn(of, random), random)


def _drawn(of: Reflectors, random: np.random.Generator) -> Array:
    return of.least + (of.most - of.least) * random.random(len(of.least))


def echoes(
    of: Reflectors,
    radar: ScenarioRadar,
    own_ship_at: Callable[[Array], OwnShip],
    start: float,
    chance: Chance,
) -> tuple[Seen, Chance]:
    """What is seen in the revolution from `start` s on, and the chance of the next one."""
    random = chance.random
    count, period = len(of.place), radar.scan_period
    place = of.place + of.wander[:, None] * random.standard_normal((count, 2))
    time = np.full(count, start + 0.5 * period)
    for _ in range(2):  # own ship moves while the beam turns
        distance, bearing = to_range_bearing(place - own_ship_at(time).position)
        time = start + bearing * (period / (2 * np.pi))
    with np.errstate(divide='ignore'):
        mean = THRESHOLD / -np.log(np.minimum(chance.detection, STRONGEST))
    power = mean * random.exponential(size=count)
    seen = (
        ((power > THRESHOLD) | (chance.detection >= 1))
        & (distance >= radar.blind_range)
        & (distance <= radar.max_range)
    )
    power = np.maximum(power, THRESHOLD)
    anew = random.random(count) < period / of.spell
    detection = np.where(anew, _drawn(of, random), chance.detection)
    return Seen(time[seen], distance[seen], power[seen]), Chance(detection, random)
