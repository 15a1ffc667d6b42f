"""Two ships that meet at one place and time, their courses some degrees apart: see `crossing`."""

import math
from typing import Any

from ..geometry import KNOT, unit_vector

ANGLES = (5, 10, 15, 30, 45, 60, 90)  # deg, of the shipped ones
APART = 400.0  # m, between the ships at the start and at the end
LEAST_S = 150.0  # before and after they meet
SPEEDS = 11.0, 10.0  # kn
PLACE = 2000.0  # m north of own ship, where they meet
COURSE = 70.0  # deg, of the middle between both courses


def crossing(angle_deg: float) -> dict[str, Any]:
    """What a scenario file of this crossing would hold (see scenario.py).

    Both begin at least 400 m apart, so each has a track of its own long before they meet.
    """
    ways = [
        speed * KNOT * unit_vector(math.radians(COURSE + side * 0.5 * angle_deg))
        for speed, side in zip(SPEEDS, (-1, 1))
    ]
    before = max(LEAST_S, APART / float(math.hypot(*(ways[1] - ways[0]))))
    return {
        'description': f'Two ships that meet at one place, courses {angle_deg:g} deg apart',
        'duration_s': 2 * before,
        'radar': {
            'max_range_nm': 6,
            'range_sigma_m': 10,
            'bearing_sigma_deg': 0.4,
            'range_resolution_m': 15,
            'beam_width_deg': 0.7,
            'pd_near': 0.95,
            'pd_far': 0.9,
        },
        'clutter': {'uniform': 20},
        'own_ship': {'course_deg': 0.0, 'speed_kn': 0.0},
        'targets': [
            {
                'start': {
                    'east_m': -before * float(way[0]),
                    'north_m': PLACE - before * float(way[1]),
                },
                'course_deg': math.degrees(math.atan2(*way)),
                'speed_mps': float(math.hypot(*way)),
            }
            for way in ways
        ],
    }
