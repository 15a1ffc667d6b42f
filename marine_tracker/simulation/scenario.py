"""Scenario files: ships, land and radar. They are checked and turned into computable form.

A scenario is a YAML file. Keys end in their unit: a length is `_m` or `_nm`, a speed is `_mps` or
`_kn`. Only `duration_s` and one target are required:

    description: A ferry crosses our bow
    duration_s: 900
    radar: {max_range_nm: 6, range_sigma_m: 15, bearing_sigma_deg: 0.4, pd_near: 0.98, pd_far: 0.8,
            radial_speed_sigma_kn: 0.5,       # only of a radar with Doppler
            sectors: 16}                      # messages a revolution; without it one
    clutter: {uniform: 20, sea: 40, sea_scale_nm: 1}      # mean numbers a scan
    tracker: {max_target_speed_kn: 45}                    # tracker parameters
    own_ship: {course_deg: 0, speed_kn: 12}
    targets:
      - name: ferry
        start: {range_nm: 4, bearing_deg: 45}     # or north_m and east_m, or lat_deg and lon_deg
        course_deg: 270
        speed_kn: 16
        pd_factor: 0.9                            # of the radar's probability of detection; or pd
        speed_wave: {amplitude_kn: 1, period_s: 300}
        legs:
          - straight: {duration_s: 240}
          - turn: {angle_deg: -40, radius_m: 500}     # to port; or rate_deg_per_s
          - speed: {to_kn: 8, duration_s: 60}         # or acceleration_mps2

Ships can also be driven by AIS reports. The file is relative to the scenario's folder; its form is
described in ais_file.py. Own ship is then one of the vessels, or lies at a place:

    ais: {file: traffic.csv, start_s: 600, vessels: [3, 17]}      # all vessels, if none are named
    own_ship: {vessel: 1}                                         # or {start: {lat_deg:, lon_deg:}}

Latitudes are -90 to 90 and longitudes -180 to 180 degrees, south and west negative. Ships may cross
180. Positions count from `origin: {lat_deg:, lon_deg:}`, else from own ship's start, else from the
first vessel's (geodesy.LocalFrame). North is true there.

A ship with a hull, and the shore of land, are seen as cells instead of one plot (hull.py, land.py).
The size of a cell is the radar's range resolution and beam width:

    targets:
      - {name: tanker, start: {range_nm: 1, bearing_deg: 30}, course_deg: 250, speed_kn: 11,
         length_m: 200, hull: {beam_m: 32}}       # heading_deg, else the course; snr_db, else 25
    land:
      - {name: mole, corners_m: [[900, -400], [1200, 800]]}       # north, east; or corners_nm
      - {name: islet, corners_m: [[0, 600], [50, 700], [-80, 650]], closed: true, snr_db: 35}
    reflectors:                   # fixed, one plot each: quays, buoys, moored craft (reflectors.py)
      - {name: quay, corners_m: [[-300, 220], [400, 260]], spacing_m: 25, pd: [0.3, 0.95]}
      - {name: dinghies, places_m: [[120, -80], [150, -84]], pd: 0.8, spell_s: 60, wander_m: 3}
"""

import difflib
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import config, yaml_file
from ..geometry import heading_from
from ..parameters import VESSEL_CLASSES, TrackerParameters
from ..types import Numbers, OwnShip, Truth
from . import land, motion, reflectors, sensor_errors, ships
from .fields import Section
from .scenario_radar import (
    CLUTTER_KEYS,
    RADAR_KEYS,
    Clutter,
    ScenarioRadar,
    read_clutter,
    read_radar,
)
from .standard_scenarios import STANDARD

TOP_KEYS = (
    'description duration_s origin radar clutter tracker ais own_ship targets land reflectors'
)
TRACKER_KEYS = 'max_target_speed_kn|max_target_speed_mps vessel_class'


@dataclass(frozen=True)
class Scenario:
    """A scenario: gives the position of everything at any time.

    name, description
    duration  s
    radar, clutter
    fleet     own ship and the T targets
    shores    of the land
    fixed     things on the ground that often give a plot
    stated    tracker parameters that the scenario states
    """

    name: str
    description: str
    duration: float
    radar: ScenarioRadar
    clutter: Clutter
    fleet: ships.Fleet
    shores: tuple[land.Shore, ...]
    fixed: reflectors.Reflectors
    stated: dict[str, Any]

    @property
    def scans(self) -> int:
        """Number of whole revolutions in the scenario."""
        return int(self.duration / self.radar.scan_period + 1e-9)

    @property
    def in_cells(self) -> bool:
        """Whether there are hulls or land, which the radar sees as cells."""
        return bool(np.isfinite(self.fleet.hulls.beam).any() or self.shores)

    def own_ship_at(self, times: float | Numbers) -> OwnShip:
        """Own ship's true motion at the times [K]."""
        times = np.atleast_1d(np.asarray(times, dtype=float))
        paths, own = self.fleet.paths, np.zeros(len(times), np.int64)
        position, velocity = motion.locate_ships(paths, own, times)
        stated = motion.courses(paths, own, times) + (0.0 if self.fleet.steers else np.nan)
        return OwnShip(times, position, velocity, heading_from(velocity, stated))

    def truth_at(self, time: float) -> Truth:
        """Every target that exists at the time."""
        target = np.arange(1, self.fleet.paths.ships)
        target = target[motion.exist(self.fleet.paths, target, float(time))]
        times = np.full(len(target), float(time))
        return Truth(times, target, *motion.locate_ships(self.fleet.paths, target, times))

    def tracker_parameters(self) -> dict[str, Any]:
        """The tracker parameters for this radar and its waters: fields of TrackerParameters.

        Sigmas and cell are the radar's, but not below the smallest allowed value. Ships echo at
        their middle; with the sensor errors of the IMO they echo as real ones do.
        """
        range_sigma, bearing_sigma = self.radar.range_sigma, self.radar.bearing_sigma
        glint, doppler = 0.0, {}
        if self.radar.radial_speed_sigma is not None:
            doppler['radial_speed_sigma_mps'] = max(self.radar.radial_speed_sigma, 0.01)
        if self.radar.sensor_errors == 'imo':
            range_sigma, bearing_sigma = sensor_errors.IMO_SIGMAS
            glint = TrackerParameters.glint_sigma_m
        return {
            'range_sigma_m': max(range_sigma, 0.1),
            'bearing_sigma_deg': max(math.degrees(bearing_sigma), 0.01),
            'glint_sigma_m': glint,
            'range_resolution_m': max(self.radar.range_resolution, 1.0),
            'beam_width_deg': max(math.degrees(self.radar.beam_width), 0.1),
            'min_range_m': self.radar.blind_range,
            'max_range_m': self.radar.max_range,
            'scan_period_s': self.radar.scan_period,
            **doppler,
            **self.stated,
        }


def detectable(scenario: Scenario, truth: Truth) -> NDArray[np.bool_]:
    """[T] whether each true position lies between the radar's blind and maximum range."""
    own_ship = scenario.own_ship_at(truth.time)
    distance = np.hypot(*(truth.position - own_ship.position).T)
    return (distance >= scenario.radar.blind_range) & (distance <= scenario.radar.max_range)


def shipped() -> list[str]:
    """The names of the scenarios in the package: files, and the standard ones."""
    return sorted([file.stem for file in config.path('scenarios').glob('*.yaml')] + [*STANDARD])


def load(name_or_path: str | Path) -> Scenario:
    """The shipped scenario of that name, or that of a file (a path with a folder or ending).

    Raises ValueError for any error in it, naming file, place, value and limit.
    """
    path = Path(name_or_path)
    if path.suffix not in ('.yaml', '.yml') and len(path.parts) == 1:
        names = shipped()
        if path.name not in names:
            near = difflib.get_close_matches(path.name, names, 1)
            raise ValueError(
                f'no scenario {path.name}'
                + (f'; did you mean {near[0]}?' if near else '')
                + f' Shipped: {", ".join(names)}; or name a .yaml file'
            )
        if path.name in STANDARD:
            return build(STANDARD[path.name](), path.name)
        path = config.path('scenarios', f'{path.name}.yaml')
    try:
        return build(yaml_file.read_mapping(path), path.stem, path.parent)
    except OSError as error:
        raise ValueError(f'scenario {path} cannot be read: {error.strerror}') from error
    except ValueError as error:
        text = str(error)
        raise ValueError(text if text.startswith(str(path)) else f'{path}: {text}') from error


def build(values: dict[str, Any], name: str, folder: Path = Path()) -> Scenario:
    """The scenario of a mapping with the form of a file. Its AIS file is looked for in `folder`.

    Raises ValueError for any error in it, naming place, value and limit.
    """
    top = Section(values, '', TOP_KEYS)
    duration = top.number('duration_s', 1.0, ships.MAX_DURATION)
    radar = read_radar(top.section('radar', RADAR_KEYS))
    if duration < radar.scan_period:
        raise ValueError(
            f'duration_s is {duration:g}; it must not be less than a revolution, '
            f'{radar.scan_period:.3g} s'
        )
    made = Scenario(
        name,
        top.text('description', ''),
        duration,
        radar,
        read_clutter(top.section('clutter', CLUTTER_KEYS), radar),
        ships.read(top, folder, duration),
        land.read(top),
        reflectors.read(top),
        _stated(top.section('tracker', TRACKER_KEYS)),
    )
    if made.in_cells:
        _check_cells(radar)
    return made


def _check_cells(radar):
    """ValueError unless the radar has cells and no other errors."""
    if radar.sensor_errors != 'none':
        raise ValueError(
            f'radar.sensor_errors is {radar.sensor_errors!r} in a scenario with hulls '
            'or land; these are seen as cells, which have no other error: it must be '
            "'none'"
        )
    if radar.radial_speed_sigma is not None:
        raise ValueError(
            'radar has radial_speed_sigma in a scenario with hulls or land: cells '
            'tell no radial speed; leave it out'
        )
    for key, value, least in (
        ('range_resolution', radar.range_resolution, 1.0),
        ('beam_width', math.degrees(radar.beam_width), 0.1),
    ):
        if value < least:
            raise ValueError(
                f'radar.{key} is {value:g} in a scenario with hulls or land; it must '
                f'be at least {least:g}'
            )


def _stated(section):
    stated = {}
    if section.has('max_target_speed'):
        stated['max_target_speed_mps'] = section.speed('max_target_speed', 0.5, 100.0)
    if 'vessel_class' in section:
        stated['vessel_class'] = section.choice('vessel_class', VESSEL_CLASSES, '')
    return stated
