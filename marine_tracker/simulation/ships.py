"""The ships of a scenario file: own ship and targets by start and legs, or by AIS reports."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..files import shortened, shown
from ..geodesy import LocalFrame
from ..geometry import KNOT, NAUTICAL_MILE, unit_vector
from ..types import Array
from . import ais, ais_file, motion, transponders
from .fields import Section

MAX_SPEED = 100 * KNOT  # m/s; the highest relative speed that an ARPA must handle
MAX_LENGTH = 200 * NAUTICAL_MILE  # m
MAX_DURATION = 7 * 86400.0  # s
SHIP_LENGTH = 100.0  # m, if not stated
HULL_SNR_DB = 25.0  # likewise
NO_HULL = (math.nan,) * 3

AIS_KEYS = 'file vessels start_s max_gap_s pd pd_factor send'
SHIP_KEYS = 'start course_deg speed_kn|speed_mps speed_wave legs'
TARGET_KEYS = 'name ' + SHIP_KEYS + ' length_m|length_nm hull pd pd_factor ais'
HULL_KEYS = 'beam_m|beam_nm heading_deg snr_db'
START_KEYS = {
    'range': 'range_m|range_nm bearing_deg',
    'north': 'north_m|north_nm east_m|east_nm',
    'lat_deg': 'lat_deg lon_deg',
}


class Hulls(NamedTuple):
    """The ships among T targets that the radar sees as hulls; nan for the others.

    beam     [T]  m
    heading  [T]  rad; nan: along the course over ground, at rest north
    snr_db   [T]  mean power over noise of one scatterer of the hull, dB
    """

    beam: Array
    heading: Array
    snr_db: Array


class Fleet(NamedTuple):
    """Own ship and T targets.

    origin     the frame of all positions; None: the place on Earth is unknown
    paths      of own ship, ship 0, and the targets by their numbers, from 1
    names      T texts
    pd         [T]  probability of detection at every range, nan where the radar's curve is used
    pd_factor  [T]  of the radar's curve
    length     [T]  m
    hulls      T rows
    remarks    what people should know of the files that were read
    steers     whether own ship's course is stated: then she heads there at rest, too
    ais        what the ships send by AIS; None: nothing
    """

    origin: LocalFrame | None
    paths: motion.Paths
    names: tuple[str, ...]
    pd: Array
    pd_factor: Array
    length: Array
    hulls: Hulls
    remarks: tuple[str, ...] = ()
    steers: bool = False
    ais: transponders.Transponders | None = None


def read(top: Section, folder: Path, duration: float) -> Fleet:
    """The ships of the file whose mapping is `top`. AIS files are relative to its `folder`."""
    traffic, options = None, top.section('ais', AIS_KEYS)
    remarks: tuple[str, ...] = ()
    if 'ais' in top and ('send' not in options or 'file' in options):
        file = folder / options.text('file')
        start = options.number('start_s', 0.0, 1e11) if 'start_s' in options else None
        read = ais_file.read(file, start, duration, options.number('max_gap_s', 1.0, 3600.0, 120.0))
        traffic, remark = read.vessels, ais_file.told(read.skipped)
        if remark:
            remarks = (f'AIS file {shortened(file)}{remark}',)
    own = top.section('own_ship', SHIP_KEYS + ' vessel')
    own_vessel = _vessel(own.values['vessel'], traffic) if 'vessel' in own else None
    origin = _origin(top, own, traffic, own_vessel)
    own_way = (
        _way(own, origin, None)
        if own_vessel is None
        else _driven_own_ship(own, origin, traffic, own_vessel, duration)
    )
    own_start, _ = motion.locate_ships(motion.table([own_way], duration), np.array(0), 0.0)

    ways, names, chances, lengths, hulls = [own_way], [], [], [], []
    sets: list[transponders.Target] = []
    for number, item in enumerate(top.items('targets')):
        section = Section(item, f'targets[{number}]', TARGET_KEYS)
        ways.append(_way(section, origin, own_start))
        names.append(section.text('name', f'target {number + 1}'))
        chances.append(_chance(section))
        lengths.append(section.length('length', 1.0, 500.0, SHIP_LENGTH))
        hulls.append(_hull(section, lengths[-1]))
        sets.append(transponders.read_target(section.section('ais', transponders.TARGET_KEYS)))
    if traffic is not None:
        for vessel in _chosen_vessels(options, traffic, own_vessel):
            ways.append(ais.way(traffic[vessel], origin))
            names.append(f'AIS {vessel}')
            chances.append(_chance(options))
            length = traffic[vessel].length
            lengths.append(length if math.isfinite(length) else SHIP_LENGTH)
            hulls.append(NO_HULL)
            sets.append(transponders.of_vessel(vessel))
    if not names:
        raise ValueError('the scenario has no targets; give targets: or ais:')
    pd, pd_factor = np.array(chances).T
    return Fleet(
        origin,
        motion.table(ways, duration),
        tuple(names),
        pd,
        pd_factor,
        np.array(lengths),
        Hulls(*np.array(hulls).T),
        remarks,
        'course_deg' in own,
        _sent(options, origin, tuple(sets)),
    )


def _sent(options, origin, sets):
    if 'send' not in options:
        return None
    if origin is None:
        raise ValueError('ais.send tells places on Earth, but the scenario has no origin')
    return transponders.read_send(options.section('send', transponders.SEND_KEYS), sets)


def _origin(top, own, traffic, own_vessel):
    """The place of the frame's [0, 0]: as stated, else the start of own ship or of the first
    vessel.
    """
    if 'origin' in top:
        return LocalFrame(*_geodetic(top.section('origin', 'lat_deg lon_deg')))
    start = own.values.get('start')
    if isinstance(start, dict) and 'lat_deg' in start:
        return LocalFrame(*_geodetic(own.section('start', START_KEYS['lat_deg'])))
    if traffic:
        reports = traffic.get(own_vessel) or next(iter(traffic.values()))
        return LocalFrame(float(reports.latitude[0]), float(reports.longitude[0]))
    return None


def _geodetic(section):
    return section.number('lat_deg', -90.0, 90.0), section.number('lon_deg', -180.0, 180.0)


def _driven_own_ship(own, origin, traffic, vessel, duration):
    if traffic is None:
        raise ValueError('own_ship.vessel names an AIS vessel, but the scenario has no ais.file')
    if len(own.values) > 1:
        raise ValueError('own_ship.vessel drives own ship; it must be the only key of own_ship')
    if vessel not in traffic:
        raise ValueError(
            f'own_ship.vessel is {vessel}; the AIS file has no such vessel in the '
            'time of the scenario'
        )
    way = ais.way(traffic[vessel], origin)
    ends = [piece.start for piece in way[1:]] + [duration]
    for piece, end in zip(way, ends, strict=True):
        if not piece.exists and piece.start < duration and end > 0:
            raise ValueError(
                f'own_ship.vessel {vessel} has no reports from {piece.start:g} s to '
                f'{end:g} s; own ship must be known throughout'
            )
    return way


def _chosen_vessels(options, traffic, own_vessel):
    asked = [_vessel(vessel, traffic) for vessel in options.items('vessels')]
    for vessel in asked:
        if vessel not in traffic:
            raise ValueError(
                f'ais.vessels names {vessel}; the AIS file has no such vessel in the '
                'time of the scenario'
            )
    return [vessel for vessel in asked or traffic if vessel != own_vessel]


def _vessel(value, traffic) -> str:
    """The vessel's name in the AIS file; a number is also found with noughts before it."""
    name = shortened(value) if isinstance(value, str) else shown(value)
    if traffic and name not in traffic and type(value) is int:
        same = [one for one in traffic if one.isdecimal() and int(one) == value]
        return same[0] if len(same) == 1 else name
    return name


def _chance(section):
    """Stated probability of detection (nan: use the radar's curve) and the curve's factor."""
    if 'pd' in section and 'pd_factor' in section:
        raise ValueError(f'{section.where} has both pd and pd_factor; give one')
    pd = section.number('pd', 0.0, 1.0) if 'pd' in section else math.nan
    return pd, section.number('pd_factor', 0.0, 1.0, 1.0)


def _hull(section, length):
    """Beam, heading and power of a target's hull; nan if it has none."""
    if 'hull' not in section:
        return NO_HULL
    for key in ('pd', 'pd_factor'):
        if key in section:
            raise ValueError(
                f'{section.where} has {key} beside hull, whose cells are seen or not '
                'by their own echo; leave it out'
            )
    if not section.has('length'):
        raise ValueError(f'{section.where} has a hull, but no length_m')
    values = section.section('hull', HULL_KEYS)
    heading = (
        math.radians(values.number('heading_deg', -360.0, 360.0))
        if 'heading_deg' in values
        else math.nan
    )
    return (
        values.length('beam', 2.0, length),
        heading,
        values.number('snr_db', 0.0, 60.0, HULL_SNR_DB),
    )


def _way(section, origin, own_start):
    """The path of a target, or of own ship, which has no `own_start` and may be at rest."""
    if own_start is not None and 'start' not in section:
        raise ValueError(f'{section.where} has no start')
    position = _start(section, origin, own_start) if 'start' in section else np.zeros(2)
    speed = section.speed('speed', 0.0, MAX_SPEED, None if own_start is not None else 0.0)
    course = section.number('course_deg', -360.0, 360.0, 0.0 if speed == 0.0 else None)
    wave = None
    if 'speed_wave' in section:
        swing = section.section('speed_wave', 'amplitude_kn|amplitude_mps period_s')
        wave = motion.Wave(
            swing.speed('amplitude', 0.0, MAX_SPEED), swing.number('period_s', 1.0, MAX_DURATION)
        )
    legs = [
        _leg(item, f'{section.where}.legs[{number}]')
        for number, item in enumerate(section.items('legs'))
    ]
    try:
        return motion.sail(position, math.radians(course), speed, legs, wave)
    except ValueError as error:
        raise ValueError(f'{section.where}.{error}') from error


def _start(ship, origin, own_start):
    kind = ship.section('start', ' '.join(START_KEYS.values())).one_of(*START_KEYS)
    section = ship.section('start', START_KEYS[kind])
    if kind == 'range':
        if own_start is None:
            raise ValueError(
                f'{section.where} gives range and bearing, which count from own ship; '
                'give north and east, or lat_deg and lon_deg'
            )
        distance = section.length('range', 0.0, MAX_LENGTH)
        return own_start + distance * unit_vector(
            math.radians(section.number('bearing_deg', -360.0, 360.0))
        )
    if kind == 'north':
        return np.array(
            [
                section.length('east', -MAX_LENGTH, MAX_LENGTH),
                section.length('north', -MAX_LENGTH, MAX_LENGTH),
            ]
        )
    if origin is None:
        raise ValueError(
            f'{section.where} gives lat_deg and lon_deg, but the scenario has no origin'
        )
    return origin.to_local(*_geodetic(section))


def _leg(item, where):
    leg = Section(item, where, 'straight turn speed')
    kind = leg.one_of('straight', 'turn', 'speed')
    if kind == 'straight':
        values = leg.section('straight', 'duration_s')
        return motion.Straight(
            values.number('duration_s', 0.0, MAX_DURATION) if 'duration_s' in values else None
        )
    if kind == 'turn':
        values = leg.section('turn', 'angle_deg radius_m|radius_nm rate_deg_per_s')
        angle = math.radians(values.number('angle_deg', -3600.0, 3600.0))
        if values.one_of('radius', 'rate_deg_per_s') == 'radius':
            return motion.Turn(angle, radius=values.length('radius', 1.0, MAX_LENGTH))
        return motion.Turn(
            angle,
            rate=math.radians(
                values.number('rate_deg_per_s', 1e-3, math.degrees(motion.MAX_TURN_RATE))
            ),
        )
    values = leg.section('speed', 'to_kn|to_mps duration_s acceleration_mps2')
    speed = values.speed('to', 0.0, MAX_SPEED)
    if values.one_of('duration_s', 'acceleration_mps2') == 'duration_s':
        return motion.SpeedChange(speed, duration=values.number('duration_s', 0.1, MAX_DURATION))
    return motion.SpeedChange(
        speed, acceleration=values.number('acceleration_mps2', 1e-6, motion.MAX_ACCELERATION)
    )
