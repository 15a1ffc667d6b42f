"""Scenarios made by rule: the IMO's test conditions, Imazu's encounters, one scene for two radars,
and crossings (crossings.py).

Each function returns what a scenario file would hold (see scenario.py).
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..geometry import KNOT, NAUTICAL_MILE, to_range_bearing, unit_vector
from . import motion
from .crossings import ANGLES, crossing

ROTATION = 22.0  # rpm
REVOLUTION = 60 / ROTATION  # s

# Resolution A.823(19), appendix 2: own course deg, speed kn; the target's range NM, bearing deg,
# relative course deg and relative speed kn at the time when its data are judged.
A823 = {
    1: (0, 10, 8, 0, 180, 20),
    2: (0, 10, 1, 0, 90, 10),
    3: (0, 5, 8, 45, 225, 20),
    4: (0, 25, 8, 45, 225, 20),
}
A823_RADAR = {
    'rotation_rpm': ROTATION,
    'max_range_nm': 12,
    'pd_near': 1,
    'pd_far': 1,
    'sensor_errors': 'imo',
}
A823_LENGTH = 200  # m, of the target
OWN_TURN = 60.0  # s; own ship's turn of 45 degrees takes a minute

# The encounters of H. Imazu: the targets' courses, deg; own ship's is 0. All ships reach the origin
# together. They have one speed, but those marked 's' have 0.7 of it.
IMAZU_SPEED, IMAZU_SLOW = 25.0, 0.7  # kn
IMAZU_DISTANCE = 6.0  # NM, from the origin at the start
IMAZU_RADAR = {
    'rotation_rpm': ROTATION,
    'max_range_nm': 16,
    'range_sigma_m': 6,
    'bearing_sigma_deg': 0.15,
    'pd_near': 0.98,
    'pd_far': 0.9,
}
IMAZU: tuple[tuple[int | str, ...], ...] = (
    (180,),
    (-90,),
    ('0s',),
    (45,),
    (180, -90),
    (-10, -45),
    ('0s', -45),
    (180, 90),
    (-30, -90),
    (-90, 15),
    (90, -30),
    (180, -45, -10),
    (180, 10, 45),
    (-10, -45, -90),
    ('0s', -45, -90),
    (45, 90, -90),
    ('0s', 10, -45),
    (-135, -15, -30),
    (15, -15, -135),
    ('0s', -15, -90),
    (-15, 15, -90),
    ('0s', -45, -90),
)


def a823(
    number: int, judged_after: float = 180.0, own_turn_deg: float = 0.0, duration: float = 1800.0
) -> dict[str, Any]:
    """Scenario 1 to 4 of the IMO. Its target is at the required place when it is judged.

    judged_after  s from the first plot to the last one before that moment, or, with
    own_turn_deg  (to starboard) from the end of own ship's turn, which follows 3 minutes on the
                  course before it and lasts one minute
    duration      s
    The moment is the end of a revolution: see `judged_at`.
    """
    own_course, own_speed, distance, bearing, course, speed = A823[number]
    moment = judged_at(judged_after, own_turn_deg)
    relative = speed * KNOT * unit_vector(math.radians(course))
    true = relative + own_speed * KNOT * unit_vector(math.radians(own_course))
    before = math.radians(own_course - own_turn_deg)
    legs: list[dict[str, Any]] = []
    way: list[motion.Leg] = []
    if own_turn_deg:
        legs = [
            {'straight': {'duration_s': judged_at(180.0)}},
            {'turn': {'angle_deg': own_turn_deg, 'rate_deg_per_s': abs(own_turn_deg) / OWN_TURN}},
        ]
        way = [
            motion.Straight(judged_at(180.0)),
            motion.Turn(
                math.radians(own_turn_deg), rate=math.radians(abs(own_turn_deg)) / OWN_TURN
            ),
        ]
    path = motion.table([motion.sail(np.zeros(2), before, own_speed * KNOT, way)], moment)
    own, _ = motion.locate_ships(path, np.array(0), moment)
    start = own + distance * NAUTICAL_MILE * unit_vector(math.radians(bearing)) - moment * true
    turned = f', after own ship has turned {own_turn_deg:+g} deg' if own_turn_deg else ''
    return {
        'description': f'Test scenario {number} of IMO A.823{turned} - all sensor errors, data '
        f'judged at {moment:.1f} s',
        'duration_s': duration,
        'radar': dict(A823_RADAR),
        'own_ship': {'course_deg': math.degrees(before), 'speed_kn': own_speed, 'legs': legs},
        'targets': [_target(start, true) | {'length_m': A823_LENGTH}],
    }


def judged_at(judged_after: float, own_turn_deg: float = 0.0) -> float:
    """The moment at which the data of `a823` are judged, s: the end of a revolution."""
    scans = math.floor(judged_after / REVOLUTION + 1e-9)
    before = judged_at(180.0) + OWN_TURN if own_turn_deg else REVOLUTION
    return before + scans * REVOLUTION


def imazu(number: int) -> dict[str, Any]:
    """Encounter 1 to 22. Without an evasion all ships meet at the origin at the end."""
    ships = []
    for text in IMAZU[number - 1]:
        slow = str(text).endswith('s')
        course = float(str(text).rstrip('s'))
        speed = IMAZU_SPEED * (IMAZU_SLOW if slow else 1.0)
        way = IMAZU_DISTANCE * (IMAZU_SLOW if slow else 1.0) * unit_vector(math.radians(course))
        ships.append(
            {
                'name': f'course {course % 360:03.0f}' + (' slow' if slow else ''),
                'start': {'east_nm': -float(way[0]), 'north_nm': -float(way[1])},
                'course_deg': course,
                'speed_kn': speed,
            }
        )
    return {
        'description': f'Imazu encounter {number} - {len(ships)} on collision course',
        'duration_s': IMAZU_DISTANCE / IMAZU_SPEED * 3600,
        'radar': dict(IMAZU_RADAR),
        'own_ship': {
            'start': {'east_nm': 0.0, 'north_nm': -IMAZU_DISTANCE},
            'course_deg': 0.0,
            'speed_kn': IMAZU_SPEED,
        },
        'targets': ships,
    }


# Two radars on one ship. Ships by range NM, bearing deg, course deg, speed kn, turn deg (1 deg/s
# after 5 minutes, back after 10). The last is a boat that the second radar hardly sees.
TWO_RADARS = {
    'x': {
        'rotation_rpm': 24,
        'range_sigma_m': 12,
        'bearing_sigma_deg': 0.5,
        'beam_width_deg': 0.9,
        'pd_near': 0.95,
        'pd_far': 0.7,
        'max_range_nm': 6,
    },
    's': {
        'rotation_rpm': 20,
        'range_sigma_m': 25,
        'bearing_sigma_deg': 0.7,
        'beam_width_deg': 1.9,
        'pd_near': 0.97,
        'pd_far': 0.85,
        'max_range_nm': 12,
    },
}
TWO_RADARS_CLUTTER = {'x': {'uniform': 20, 'sea': 30}, 's': {'uniform': 20, 'sea': 5}}
TWO_RADARS_SHIPS = (
    (4.5, 40, 235, 14, 0),
    (3.2, 310, 95, 11, 60),
    (5.2, 85, 262, 9, -45),
    (2.4, 200, 20, 16, 0),
    (4.0, 150, 330, 12, 90),
    (3.6, 260, 60, 18, 0),
    (2.6, 120, 15, 8, 0),
)


def two_radars(which: str) -> dict[str, Any]:
    """The scene as the radar 'x' or 's' sees it; the ships are the same."""
    ships: list[dict[str, Any]] = []
    for distance, bearing, course, speed, turn in TWO_RADARS_SHIPS:
        legs = [
            leg
            for way in (turn, -turn)
            if way
            for leg in (
                {'straight': {'duration_s': 300}},
                {'turn': {'angle_deg': way, 'rate_deg_per_s': 1}},
            )
        ]
        ships.append(
            {
                'start': {'range_nm': distance, 'bearing_deg': bearing},
                'course_deg': course,
                'speed_kn': speed,
                **({'legs': legs} if legs else {}),
            }
        )
    if which == 's':
        ships[-1]['pd'] = 0.05
    return {
        'description': f'Seven ships and two radars on ours - the {which.upper()} band radar',
        'duration_s': 900,
        'radar': dict(TWO_RADARS[which]),
        'clutter': dict(TWO_RADARS_CLUTTER[which]),
        'own_ship': {'course_deg': 10.0, 'speed_kn': 10.0},
        'targets': ships,
    }


def _target(start, velocity):
    speed, course = to_range_bearing(velocity)
    return {
        'start': {'east_m': float(start[0]), 'north_m': float(start[1])},
        'course_deg': math.degrees(course),
        'speed_mps': float(speed),
    }


STANDARD: dict[str, Callable[[], dict[str, Any]]] = {
    **{f'imo_{number}': lambda number=number: a823(number) for number in A823},  # type: ignore
    **{
        f'imazu_{number:02d}': lambda number=number: imazu(number)  # type: ignore
        for number in range(1, len(IMAZU) + 1)
    },
    **{
        f'two_radars_{which}': lambda which=which: two_radars(which)  # type: ignore
        for which in TWO_RADARS
    },
    **{
        f'crossing_{angle:02d}': lambda angle=angle: crossing(angle)  # type: ignore
        for angle in ANGLES
    },
}
