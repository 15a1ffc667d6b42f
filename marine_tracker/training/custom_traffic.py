"""A user's own traffic for the training of `gwnn`: kinds of vessels from a file, or a scenario.

A file of kinds is YAML. A pair is minimum and maximum. Every key except the first two is optional:

    pilot boat:
      speed_mps: [3, 15]
      manoeuvres_per_scan: 0.03         # probability that one begins
      turns_share: 0.75                 # of the manoeuvres; the others change speed
      turn_radius_m: [30, 400]
      turn_acceleration_mps2: 2.5       # maximum, across the course
      turn_angle_deg: 150               # maximum
      speed_change_mps2: [0.05, 0.6]
      weave_period_s: [15, 80]          # for a course that swings all the time
      drift_share: 0.5                  # of the vessels: speed and course wander slowly
"""

from pathlib import Path
from typing import Any

from .. import yaml_file
from ..files import shown
from ..simulation.fields import Section
from ..simulation.scenario import Scenario
from .ship_tracks import Kind
from .training_tracks import Radars, Waters

KEYS = (
    'speed_mps manoeuvres_per_scan turns_share turn_radius_m turn_acceleration_mps2 '
    'turn_angle_deg speed_change_mps2 weave_period_s drift_share'
)
SIGMA_SPREAD = 1.2  # sigmas are drawn from the scenario's value up to this multiple of it
RATE_SPREAD = 1.05  # likewise the antenna's rate, under hard conditions
HARD = 0.25  # share of the tracks seen under hard conditions
NEAREST, LEAST_BEGIN = 20.0, 50.0  # m


def read_kinds(path: Path) -> dict[str, Kind]:
    """The kinds of vessels of a file.

    Raises ValueError for any error in it, naming file, place, value and limit.
    """
    try:
        values = yaml_file.read_mapping(path)
        if not values:
            raise ValueError('there is no kind of vessel in it')
        return {str(name): _kind(Section(item, str(name), KEYS)) for name, item in values.items()}
    except OSError as error:
        raise ValueError(f'kinds {path} cannot be read: {error.strerror}') from error
    except ValueError as error:
        text = str(error)
        raise ValueError(text if text.startswith(str(path)) else f'{path}: {text}') from error


def _kind(section: Section) -> Kind:
    usual = Kind(0.0)
    weave = _pair(section, 'weave_period_s', 5.0, 3600.0) if 'weave_period_s' in section else None
    return Kind(
        begin=section.number('manoeuvres_per_scan', 0.0, 1.0),
        turns=section.number('turns_share', 0.0, 1.0, usual.turns),
        speed=_pair(section, 'speed_mps', 0.0, 100.0),
        radius=_pair(section, 'turn_radius_m', 1.0, 1e5, usual.radius),
        lateral=section.number('turn_acceleration_mps2', 0.001, 50.0, usual.lateral),
        angle=section.number('turn_angle_deg', 15.0, 3600.0, usual.angle),
        thrust=_pair(section, 'speed_change_mps2', 0.001, 50.0, usual.thrust),
        weave=weave,
        drift=section.number('drift_share', 0.0, 1.0, usual.drift),
    )


def _pair(section, key, low, high, default=None) -> tuple[float, float]:
    """Minimum and maximum, both within [low, high]."""
    if key not in section:
        if default is None:
            raise ValueError(f'{section.owner} has no {key}')
        return default
    value = section.values[key]
    place = section.place(key)
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError(f'{place} is {shown(value)}; it must be a pair [least, most]')
    ends = [
        Section({'value': end}, f'{place}[{i}]', 'value').number('value', low, high)
        for i, end in enumerate(value)
    ]
    if ends[0] > ends[1]:
        raise ValueError(f'{place} is {shown(value)}; the least must not be above the most')
    return ends[0], ends[1]


def from_scenario(waters: Waters, scenario: Scenario) -> Waters:
    """The waters with the scenario's radar instead of their own, and with its targets' tracks
    added.
    """
    told: dict[str, Any] = scenario.tracker_parameters()
    radar = scenario.radar
    nearest = max(radar.blind_range, NEAREST)
    begin = min(max(nearest, LEAST_BEGIN), radar.max_range)
    rate = radar.rotation

    def around(value, by):
        return value / by, value * by

    own = Radars(
        1.0,
        around(told['range_sigma_m'], SIGMA_SPREAD),
        around(told['bearing_sigma_deg'], SIGMA_SPREAD),
        (begin, radar.max_range),
        min(nearest, begin),
        (rate, rate),
        HARD,
        around(rate, RATE_SPREAD),
        detection=(radar.pd_far, radar.pd_near),
    )
    return waters._replace(radars=(own,), scenario=scenario)
