"""What happens at sea and what the radar is: scenario files, checked and made computable.

A scenario is a YAML file whose keys carry their unit; lengths may be given as `_m` or `_nm`, speeds
as `_mps` or `_kn`. `load` returns it with everything in SI units, ready to ask for positions at
any time. Ships are stated by a start and legs, or driven by AIS reports (see ais.py).
"""

import difflib
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import config
from ..geometry import KNOT, NAUTICAL_MILE, local_from_geodetic, unit_vector
from ..parameters import VESSEL_CLASSES, read_yaml_mapping
from ..types import OwnShip, Truth
from . import ais, motion, sensor_errors
from .fields import Section

MAX_SPEED = 100 * KNOT                    # m/s: the fastest relative speed an ARPA has to know
MAX_ACCELERATION = 10.0                   # m/s^2
MAX_TURN_RATE = 45.0                      # deg/s
MAX_LENGTH = 200 * NAUTICAL_MILE          # m
MAX_DURATION = 7 * 86400.0                # s

TOP_KEYS = 'description duration_s origin radar clutter tracker ais own_ship targets'
AIS_KEYS = 'file vessels start_s max_gap_s pd pd_factor'
RADAR_KEYS = ('rotation_rpm max_range_m|max_range_nm blind_range_m|blind_range_nm '
              'range_sigma_m|range_sigma_nm bearing_sigma_deg range_bias_m|range_bias_nm '
              'bearing_bias_deg range_resolution_m|range_resolution_nm beam_width_deg '
              'pd_near pd_far sensor_errors')
SHIP_KEYS = 'start course_deg speed_kn|speed_mps speed_wave legs'
TARGET_KEYS = 'name ' + SHIP_KEYS + ' length_m|length_nm pd pd_factor'
START_KEYS = {'range': 'range_m|range_nm bearing_deg',
              'north': 'north_m|north_nm east_m|east_nm',
              'lat_deg': 'lat_deg lon_deg'}


class Radar(NamedTuple):
    """The simulated radar.

    rotation            rpm, antenna; the beam passes true north at the start of a revolution
    max_range           m, and
    blind_range         m: targets nearer than this or beyond that are not seen
    range_sigma         m, and
    bearing_sigma       rad: Gaussian noise of a plot (not used with sensor_errors 'imo')
    range_bias          m, and
    bearing_bias        rad: constant errors
    range_resolution    m, and
    beam_width          rad: targets closer than both in one revolution give one plot
    pd_near, pd_far     probability of detection at no range and at the maximum range
    sensor_errors       'none' or 'imo'
    """

    rotation: float
    max_range: float
    blind_range: float
    range_sigma: float
    bearing_sigma: float
    range_bias: float
    bearing_bias: float
    range_resolution: float
    beam_width: float
    pd_near: float
    pd_far: float
    sensor_errors: str

    @property
    def scan_period(self) -> float:
        """Time of one revolution, s."""
        return 60.0 / self.rotation


class Clutter(NamedTuple):
    """False plots: mean numbers a revolution, and how fast sea clutter falls off.

    uniform    evenly over the area between blind and maximum range
    sea        from the waves, evenly in bearing; the number per metre of range falls as
               exp(-range / sea_scale), so the number per area falls faster still
    sea_scale  m
    """

    uniform: float
    sea: float
    sea_scale: float


@dataclass(frozen=True)
class Scenario:
    """A scenario, ready to be asked where everything is at any time.

    name, description, duration s
    origin         (latitude, longitude) in degrees of the frame's [0, 0], or None
    radar, clutter
    paths          motion.Paths of own ship, ship 0, and the T targets by their numbers, from 1
    target_names   T texts
    pd_factor      [T]  1 where `pd` is stated
    pd             [T]  probability of detection at every range, nan where the radar's curve holds
    target_length  [T]  m
    stated         tracker parameters that the scenario states
    """

    name: str
    description: str
    duration: float
    origin: tuple[float, float] | None
    radar: Radar
    clutter: Clutter
    paths: motion.Paths
    target_names: tuple[str, ...]
    pd_factor: NDArray[np.float64]
    pd: NDArray[np.float64]
    target_length: NDArray[np.float64]
    stated: dict[str, Any]

    @property
    def scans(self) -> int:
        """Number of whole revolutions in the scenario."""
        return int(self.duration / self.radar.scan_period + 1e-9)

    def own_ship_at(self, times) -> OwnShip:
        """Own ship's true motion at the times [K]."""
        times = np.atleast_1d(np.asarray(times, dtype=float))
        position, velocity = motion.locate_ships(
            self.paths, np.zeros(len(times), np.int64), times)
        return OwnShip(times, position, velocity)

    def truth_at(self, time: float) -> Truth:
        """Every target that exists at the time."""
        target = np.arange(1, self.paths.ships)
        target = target[motion.exist(self.paths, target, float(time))]
        times = np.full(len(target), float(time))
        return Truth(times, target, *motion.locate_ships(self.paths, target, times))

    def tracker_parameters(self) -> dict[str, Any]:
        """What a tracker is told of this radar and its waters: fields of TrackerParameters.

        The sigmas are the radar's, but not below the smallest that a tracker takes.
        """
        range_sigma, bearing_sigma = self.radar.range_sigma, self.radar.bearing_sigma
        if self.radar.sensor_errors == 'imo':
            range_sigma, bearing_sigma = sensor_errors.IMO_SIGMAS
        return {'range_sigma_m': max(range_sigma, 0.1),
                'bearing_sigma_deg': max(math.degrees(bearing_sigma), 0.01),
                'min_range_m': self.radar.blind_range,
                'max_range_m': self.radar.max_range,
                'scan_period_s': self.radar.scan_period,
                **self.stated}


def detectable(scenario: Scenario, truth: Truth) -> NDArray[np.bool_]:
    """[T] whether each true position lies between the radar's blind and maximum range."""
    own_ship = scenario.own_ship_at(truth.time)
    distance = np.hypot(*(truth.position - own_ship.position).T)
    return (distance >= scenario.radar.blind_range) & (distance <= scenario.radar.max_range)


def shipped() -> list[str]:
    """The names of the scenarios that come with the package."""
    return sorted(file.stem for file in config.path('scenarios').glob('*.yaml'))


def load(name_or_path) -> Scenario:
    """The shipped scenario of that name, or that of a file (a path with a folder or ending).

    Raises ValueError, naming file, place, value and limit, for anything that is wrong in it.
    """
    path = Path(name_or_path)
    if path.suffix not in ('.yaml', '.yml') and len(path.parts) == 1:
        names = shipped()
        if path.name not in names:
            near = difflib.get_close_matches(path.name, names, 1)
            raise ValueError(f'no scenario {path.name}'
                             + (f'; did you mean {near[0]}?' if near else '')
                             + f' Shipped: {", ".join(names)}; or name a .yaml file')
        path = config.path('scenarios', f'{path.name}.yaml')
    try:
        values = read_yaml_mapping(path)
        return _scenario(path.stem, values, path.parent)
    except OSError as error:
        raise ValueError(f'scenario {path} cannot be read: {error.strerror}') from error
    except ValueError as error:
        text = str(error)
        raise ValueError(text if text.startswith(str(path)) else f'{path}: {text}') from error


def _scenario(name, values, folder):
    top = Section(values, '', TOP_KEYS)
    duration = top.number('duration_s', 1.0, MAX_DURATION)
    radar = _radar(top.section('radar', RADAR_KEYS))
    traffic, options = None, top.section('ais', AIS_KEYS)
    if 'ais' in top:
        traffic = ais.read(folder / options.text('file'),
                           options.number('start_s', 0.0, 1e9, 0.0), duration,
                           options.number('max_gap_s', 1.0, 3600.0, 120.0))
    own = top.section('own_ship', SHIP_KEYS + ' vessel')
    own_vessel = str(own.values['vessel']) if 'vessel' in own else None
    origin = _origin(top, own, traffic, own_vessel)
    own_way = (_way(own, origin, None) if own_vessel is None
               else _driven_own_ship(own, origin, traffic, own_vessel, duration))
    own_start, _ = motion.locate_ships(motion.table([own_way], duration), np.array(0), 0.0)

    ways, names, chances, lengths = [own_way], [], [], []
    for number, item in enumerate(top.items('targets')):
        place = f'targets[{number}]'
        section = Section(item, place, TARGET_KEYS)
        ways.append(_way(section, origin, own_start))
        names.append(section.text('name', f'target {number + 1}'))
        chances.append(_chance(section))
        lengths.append(section.length('length', 1.0, 500.0, 100.0))
    if traffic is not None:
        for vessel in _chosen_vessels(options, traffic, own_vessel):
            ways.append(ais.way(traffic[vessel], origin))
            names.append(f'AIS {vessel}')
            chances.append(_chance(options))
            length = traffic[vessel].length
            lengths.append(length if math.isfinite(length) else 100.0)
    if not names:
        raise ValueError('the scenario has no targets; give targets: or ais:')
    pd, pd_factor = np.array(chances).T
    return Scenario(
        name, top.text('description', ''), duration, origin, radar,
        _clutter(top.section('clutter', 'uniform sea sea_scale_m|sea_scale_nm'), radar),
        motion.table(ways, duration), tuple(names), pd_factor, pd, np.array(lengths),
        _stated(top))


def _radar(section):
    errors = section.choice('sensor_errors', ('none', 'imo'), 'none')
    if errors == 'imo':
        for key in ('range_sigma', 'bearing_sigma'):
            if any(k.startswith(key) for k in section.values):
                raise ValueError(f'radar has {key} beside sensor_errors: imo, which states all '
                                 'noise; leave one out')
    radar = Radar(
        section.number('rotation_rpm', 1.0, 300.0, 22.0),
        section.length('max_range', 100.0, MAX_LENGTH, 12 * NAUTICAL_MILE),
        section.length('blind_range', 0.0, 10000.0, 50.0),
        section.length('range_sigma', 0.0, 1000.0, 15.0),
        math.radians(section.number('bearing_sigma_deg', 0.0, 10.0, 0.5)),
        section.length('range_bias', -1000.0, 1000.0, 0.0),
        math.radians(section.number('bearing_bias_deg', -10.0, 10.0, 0.0)),
        section.length('range_resolution', 0.0, 1000.0, 30.0),
        math.radians(section.number('beam_width_deg', 0.0, 30.0, 1.0)),
        section.number('pd_near', 0.01, 1.0, 0.98),
        section.number('pd_far', 0.01, 1.0, 0.8),
        errors)
    if radar.blind_range >= radar.max_range:
        raise ValueError(f'radar.blind_range is {radar.blind_range:g} m; it must be below '
                         f'max_range, {radar.max_range:g} m')
    if radar.pd_far > radar.pd_near:
        raise ValueError(f'radar.pd_far is {radar.pd_far:g}; it must not exceed pd_near, '
                         f'{radar.pd_near:g}')
    return radar


def _clutter(section, radar):
    return Clutter(section.number('uniform', 0.0, 100000.0, 0.0),
                   section.number('sea', 0.0, 100000.0, 0.0),
                   section.length('sea_scale', 10.0, radar.max_range, min(
                       NAUTICAL_MILE, radar.max_range)))


def _stated(top):
    section = top.section('tracker', 'max_target_speed_kn|max_target_speed_mps vessel_class')
    stated = {}
    if section.has('max_target_speed'):
        stated['max_target_speed_mps'] = section.speed('max_target_speed', 0.5, 100.0)
    if 'vessel_class' in section:
        stated['vessel_class'] = section.choice('vessel_class', VESSEL_CLASSES, '')
    return stated


def _origin(top, own, traffic, own_vessel):
    """Where the frame's [0, 0] is: as stated, else where own ship or the first vessel starts."""
    if 'origin' in top:
        return _geodetic(top.section('origin', 'lat_deg lon_deg'))
    start = own.values.get('start')
    if isinstance(start, dict) and 'lat_deg' in start:
        return _geodetic(own.section('start', START_KEYS['lat_deg']))
    if traffic:
        reports = traffic.get(own_vessel) or next(iter(traffic.values()))
        return float(reports.latitude[0]), float(reports.longitude[0])
    return None


def _geodetic(section):
    return section.number('lat_deg', -85.0, 85.0), section.number('lon_deg', -180.0, 180.0)


def _driven_own_ship(own, origin, traffic, vessel, duration):
    if traffic is None:
        raise ValueError('own_ship.vessel names an AIS vessel, but the scenario has no ais.file')
    if len(own.values) > 1:
        raise ValueError('own_ship.vessel drives own ship; it must be the only key of own_ship')
    if vessel not in traffic:
        raise ValueError(f'own_ship.vessel is {vessel}; the AIS file has no such vessel in the '
                         'time of the scenario')
    way = ais.way(traffic[vessel], origin)
    ends = [piece.start for piece in way[1:]] + [duration]
    for piece, end in zip(way, ends, strict=True):
        if not piece.exists and piece.start < duration and end > 0:
            raise ValueError(f'own_ship.vessel {vessel} has no reports from {piece.start:g} s to '
                             f'{end:g} s; own ship must be known throughout')
    return way


def _chosen_vessels(options, traffic, own_vessel):
    asked = [str(vessel) for vessel in options.items('vessels')]
    for vessel in asked:
        if vessel not in traffic:
            raise ValueError(f'ais.vessels names {vessel}; the AIS file has no such vessel in the '
                             'time of the scenario')
    return [vessel for vessel in asked or traffic if vessel != own_vessel]


def _chance(section):
    """Stated probability of detection (nan: the radar's curve) and the curve's factor."""
    if 'pd' in section and 'pd_factor' in section:
        raise ValueError(f'{section.where} has both pd and pd_factor; give one')
    pd = section.number('pd', 0.0, 1.0) if 'pd' in section else math.nan
    return pd, section.number('pd_factor', 0.0, 1.0, 1.0)


def _way(section, origin, own_start):
    """The way of a target, or of own ship itself, which has no `own_start` and may lie at rest."""
    if own_start is not None and 'start' not in section:
        raise ValueError(f'{section.where} has no start')
    position = (_start(section, origin, own_start) if 'start' in section else np.zeros(2))
    speed = section.speed('speed', 0.0, MAX_SPEED, None if own_start is not None else 0.0)
    course = section.number('course_deg', -360.0, 360.0, 0.0 if speed == 0.0 else None)
    wave = None
    if 'speed_wave' in section:
        swing = section.section('speed_wave', 'amplitude_kn|amplitude_mps period_s')
        wave = motion.Wave(swing.speed('amplitude', 0.0, MAX_SPEED),
                           swing.number('period_s', 1.0, MAX_DURATION))
    legs = [_leg(item, f'{section.where}.legs[{number}]')
            for number, item in enumerate(section.items('legs'))]
    try:
        return motion.sail(position, math.radians(course), speed, legs, wave)
    except ValueError as error:
        raise ValueError(f'{section.where}.{error}') from error


def _start(ship, origin, own_start):
    kind = ship.section('start', ' '.join(START_KEYS.values())).one_of(*START_KEYS)
    section = ship.section('start', START_KEYS[kind])
    if kind == 'range':
        if own_start is None:
            raise ValueError(f'{section.where} gives range and bearing, which count from own ship; '
                             'give north and east, or lat_deg and lon_deg')
        distance = section.length('range', 0.0, MAX_LENGTH)
        return own_start + distance * unit_vector(
            math.radians(section.number('bearing_deg', -360.0, 360.0)))
    if kind == 'north':
        return np.array([section.length('east', -MAX_LENGTH, MAX_LENGTH),
                         section.length('north', -MAX_LENGTH, MAX_LENGTH)])
    if origin is None:
        raise ValueError(f'{section.where} gives lat_deg and lon_deg, but the scenario has no '
                         'origin')
    return local_from_geodetic(*_geodetic(section), *origin)


def _leg(item, where):
    leg = Section(item, where, 'straight turn speed')
    kind = leg.one_of('straight', 'turn', 'speed')
    if kind == 'straight':
        values = leg.section('straight', 'duration_s')
        return motion.Straight(values.number('duration_s', 0.0, MAX_DURATION)
                               if 'duration_s' in values else None)
    if kind == 'turn':
        values = leg.section('turn', 'angle_deg radius_m|radius_nm rate_deg_per_s')
        angle = math.radians(values.number('angle_deg', -3600.0, 3600.0))
        if values.one_of('radius', 'rate_deg_per_s') == 'radius':
            return motion.Turn(angle, radius=values.length('radius', 1.0, MAX_LENGTH))
        return motion.Turn(angle, rate=math.radians(
            values.number('rate_deg_per_s', 1e-3, MAX_TURN_RATE)))
    values = leg.section('speed', 'to_kn|to_mps duration_s acceleration_mps2')
    speed = values.speed('to', 0.0, MAX_SPEED)
    if values.one_of('duration_s', 'acceleration_mps2') == 'duration_s':
        return motion.SpeedChange(speed, duration=values.number('duration_s', 0.1, MAX_DURATION))
    return motion.SpeedChange(speed, acceleration=values.number(
        'acceleration_mps2', 1e-6, MAX_ACCELERATION))
