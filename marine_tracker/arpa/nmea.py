"""NMEA 0183 sentences of targets and own ship, from arrays (IEC 61162-1)."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import KNOT, NAUTICAL_MILE
from ..types import Array, IntArray
from .nmea_fields import (
    ANGLE,
    KNOTS,
    MILES,
    MINUTES,
    degrees,
    figure,
    hours,
    moment,
    position,
    sentence,
)

LOST, ACQUIRING, TRACKING = 'L', 'Q', 'T'
AUTOMATIC, MANUAL, REPORTED = 'A', 'M', 'R'
# References of OSD: position fixes, a log through the water, set by hand, a stationary target.
GROUND, WATER, BY_HAND, FIXED_TARGET = 'P', 'W', 'M', 'R'
NORTH_UP, HEAD_UP, COURSE_UP = 'N', 'H', 'C'
LENGTH = 82  # IEC 61162-1: characters of a sentence, $ and CR LF included
NAME = 20  # OpenCPN: characters of a target's name
TWO_DIGITS, THREE_DIGITS = 99, 999  # greatest target numbers: by the standard; as OpenCPN reads
NUMBERS = range(1, THREE_DIGITS + 1)  # 0 means "none"
NEAREST = 0.001  # NM; OpenCPN takes a range of 0 for a target switched off


class Targets(NamedTuple):
    """N targets for TTM and TLL; nan for an unknown value.

    number    [N]  1 to 99, or to 999 if receivers accept that (see nmea_targets.slots)
    status    [N]  LOST, ACQUIRING or TRACKING
    acquired  [N]  AUTOMATIC, MANUAL or REPORTED; '' if not given
    name      [N]  text
    range     [N]  m, from own ship      bearing  [N]  rad, true
    speed     [N]  m/s                   course   [N]  rad, true
    cpa       [N]  m                     tcpa     [N]  s, negative when past
    """

    number: IntArray
    status: NDArray[np.str_]
    acquired: NDArray[np.str_]
    name: NDArray[np.str_]
    range: Array
    bearing: Array
    speed: Array
    course: Array
    cpa: Array
    tcpa: Array


class OwnShipData(NamedTuple):
    """Own ship at one moment; nan for an unknown value.

    latitude, longitude  deg
    speed m/s, course rad  over ground or through the water, as `reference` says: GROUND, WATER,
                         BY_HAND or FIXED_TARGET
    heading              rad, true
    estimated            whether the position goes on from an old fix by dead reckoning
    water                m/s, speed through the water
    set rad, drift m/s   of the current, where they are set by hand
    """

    latitude: float = np.nan
    longitude: float = np.nan
    speed: float = np.nan
    course: float = np.nan
    heading: float = np.nan
    reference: str = GROUND
    estimated: bool = False
    water: float = np.nan
    set: float = np.nan
    drift: float = np.nan


def as_acquired(targets: Targets) -> Targets:
    """The same targets, without speed, course and TCPA while being acquired, as radars do."""
    acquiring = targets.status == ACQUIRING
    return targets._replace(
        **{
            name: np.where(acquiring, np.nan, getattr(targets, name))
            for name in ('speed', 'course', 'tcpa')
        }
    )


def ttm(
    targets: Targets,
    time: float,
    talker: str = 'RA',
    decimals: int = 3,
    reference: int = 0,
    relative: bool = False,
) -> list[str]:
    """TTM, tracked target message: always 15 fields, one sentence a target.

    time       s of UTC since 1970; nan for an empty field
    decimals   of the distances
    reference  number of the target from which own ship's drift is taken; 0 for none
    relative   whether bearings count from own ship's bow, as they do without a heading

    Distances in NM, speed in knots, TCPA in minutes. Targets without bearing, or without a range up
    to 999.999 NM, are left out. A range that would be written as 0 is written as the smallest value
    above 0, because 0 tells OpenCPN that the target was switched off. A name is cut to the space
    that the 82 characters of a sentence leave, at most 20. ValueError for a number, status or
    acquisition that has no code in TTM.
    """
    _check(targets)
    clock = hours(time)
    least = max(NEAREST, 10.0**-decimals)
    said = []
    for number, status, acquired, name, *figures in zip(*(a.tolist() for a in _units(targets))):
        distance, bearing, speed, course, cpa, tcpa = figures
        fields = [
            f'{number:02d}',
            figure(max(distance, least), MILES, decimals),
            degrees(bearing),
            'R' if relative else 'T',
            figure(speed, KNOTS, 2),
            degrees(course),
            'T',
            figure(cpa, MILES, decimals),
            figure(tcpa, MINUTES, 1, -MINUTES),
            'N',
            '',
            status,
            'R' if number == reference else '',
            clock,
            acquired,
        ]
        said.append(_named(talker, 'TTM', fields, 10, name))
    return said


def tll(
    targets: Targets,
    latitude: Array,
    longitude: Array,
    time: float,
    talker: str = 'RA',
    reference: int = 0,
) -> list[str]:
    """TLL, target latitude and longitude: [N] degrees for the N targets; arguments as for `ttm`.

    Those without a position on the globe are left out.
    """
    _check(targets)
    clock, said = hours(time), []
    for number, status, name, north, east in zip(
        targets.number.tolist(),
        targets.status.tolist(),
        targets.name.tolist(),
        np.asarray(latitude).tolist(),
        np.asarray(longitude).tolist(),
    ):
        place = position(north, east)
        if place[0]:
            fields = [
                f'{number:02d}',
                *place,
                '',
                clock,
                status,
                'R' if number == reference else '',
            ]
            said.append(_named(talker, 'TLL', fields, 5, name))
    return said


def osd(own: OwnShipData, talker: str = 'RA') -> str:
    """OSD, own ship data: heading, course and speed with their reference; set and drift by hand."""
    heading = degrees(own.heading)
    speed, course = figure(own.speed / KNOT, KNOTS, 2), degrees(own.course)
    return sentence(
        talker,
        'OSD',
        (
            heading,
            'A' if heading else 'V',
            course,
            own.reference if course else '',
            speed,
            own.reference if speed else '',
            degrees(own.set),
            figure(own.drift / KNOT, KNOTS, 2),
            'N',
        ),
    )


def rsd(
    range_scale: float,
    rotation: str = NORTH_UP,
    cursor: tuple[float, float] | None = None,
    markers: Sequence[tuple[float, float]] = (),
    talker: str = 'RA',
) -> str:
    """RSD, radar system data.

    range_scale  m; rotation NORTH_UP, HEAD_UP or COURSE_UP
    cursor       range m and bearing rad from own ship
    markers      up to two, each the range m of a VRM and the bearing rad of an EBL
    """

    def pair(range_: float, bearing: float) -> tuple[str, str]:
        return figure(range_ / NAUTICAL_MILE, MILES, 3), degrees(bearing)

    if len(markers) > 2:
        raise ValueError(f'{len(markers)} pairs of VRM and EBL; RSD takes 2 at most')
    none = (np.nan, np.nan)
    first, second = (*markers, none, none)[:2]
    return sentence(
        talker,
        'RSD',
        (
            '',
            '',
            *pair(*first),
            '',
            '',
            *pair(*second),
            *pair(*(cursor or none)),
            pair(range_scale, 0.0)[0],
            'N',
            rotation,
        ),
    )


def rmc(own: OwnShipData, time: float, talker: str = 'II') -> str:
    """RMC, own ship's position, course and speed over ground.

    Void (V) without a position (mode N), and with an estimated one (mode E), as IEC 61162-1 has it.
    """
    place = position(own.latitude, own.longitude)
    mode = 'N' if not place[0] else 'E' if own.estimated else 'A'
    return sentence(
        talker,
        'RMC',
        (
            hours(time),
            'A' if mode == 'A' else 'V',
            *place,
            figure(own.speed / KNOT, KNOTS, 2),
            degrees(own.course),
            moment(time, '%d%m%y'),
            '',
            '',
            mode,
        ),
    )


def vhw(own: OwnShipData, talker: str = 'II') -> str:
    """VHW, own ship's heading and speed through the water."""
    knots, kmh = (figure(own.water / unit, KNOTS, 2) for unit in (KNOT, 1 / 3.6))
    return sentence(talker, 'VHW', (degrees(own.heading), 'T', '', 'M', knots, 'N', kmh, 'K'))


def hdt(own: OwnShipData, talker: str = 'II') -> str:
    """HDT, own ship's true heading."""
    return sentence(talker, 'HDT', (degrees(own.heading), 'T'))


def _units(targets: Targets) -> list[NDArray[Any]]:
    """The columns of the targets that can be sent, in NM, rad, knots and minutes."""
    miles, bearing = targets.range / NAUTICAL_MILE, targets.bearing
    told = (miles >= 0) & (miles < MILES) & (np.abs(bearing) <= ANGLE)
    return [
        column[told]
        for column in (
            targets.number,
            targets.status,
            targets.acquired,
            targets.name,
            miles,
            bearing,
            targets.speed / KNOT,
            targets.course,
            targets.cpa / NAUTICAL_MILE,
            targets.tcpa / 60,
        )
    ]


def _named(talker: str, kind: str, fields: list[str], at: int, name: str) -> str:
    """The sentence with the name, cut to fit, as its field `at`."""
    room = LENGTH - len(sentence(talker, kind, fields)) - 2  # CR LF
    plain = ''.join(c for c in name if ' ' <= c <= '~' and c not in '$!*,\\^~').strip()
    fields[at] = plain[: min(room, NAME)].strip()
    return sentence(talker, kind, fields)


def _check(targets: Targets) -> None:
    for name, known, allowed in (
        ('number', NUMBERS, '1 to 999'),
        ('status', (LOST, ACQUIRING, TRACKING), 'L, Q, T'),
        ('acquired', (AUTOMATIC, MANUAL, REPORTED, ''), 'A, M, R'),
    ):
        for value in getattr(targets, name).tolist():
            if value not in known:
                raise ValueError(f'{name} of a target is {value!r}; it must be {allowed}')
