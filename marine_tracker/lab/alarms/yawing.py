"""A yawing own ship that six steady ships pass at about the CPA limit."""

from typing import Any

import numpy as np

from ...geometry import KNOT, NAUTICAL_MILE, unit_vector
from ...simulation import scenario
from ...simulation.scenario import Scenario

OWN_SPEED = 12.0  # kn, course north
LIMIT = 0.5  # NM
# Course deg and speed kn of the ships, and the minute of their closest approach.
SHIPS = ((180, 13, 13), (225, 10, 15), (265, 15, 17), (100, 11, 19), (5, 20, 22), (2, 4, 24))
SHARES = (0.6, 0.8, 0.9, 1.1, 1.2, 1.4)  # CPA divided by the CPA limit
MINUTES = 26


def passing(amplitude: float, period: float, turn: int) -> Scenario:
    """The scene: own ship yaws by `amplitude` deg to either side, with a period of `period` s.

    turn  shifts which of SHARES each ship gets, and the side of own ship on which she passes
    """
    duration = 60.0 * MINUTES
    own: dict[str, Any] = {'course_deg': 0.0, 'speed_kn': OWN_SPEED}
    share = 1.0
    if amplitude:
        # Swings evenly from side to side. The first and the last swing are half swings.
        rate = 4 * amplitude / period
        halves = int(2 * duration / period) + 1
        angles = [amplitude] + [2 * amplitude * (-1) ** (k + 1) for k in range(halves)]
        own['legs'] = [{'turn': {'angle_deg': angle, 'rate_deg_per_s': rate}} for angle in angles]
        share = float(np.sinc(np.radians(amplitude) / np.pi))
    made_good = share * OWN_SPEED * KNOT * unit_vector(0.0)
    targets = []
    for k, (course, speed, minute) in enumerate(SHIPS):
        velocity = speed * KNOT * unit_vector(np.radians(course))
        relative = velocity - made_good
        side = 1 if (k + turn) % 2 else -1
        across = side * np.array([relative[1], -relative[0]]) / np.hypot(*relative)
        cpa = SHARES[(k + turn) % len(SHARES)] * LIMIT * NAUTICAL_MILE
        east, north = cpa * across - 60.0 * minute * relative
        targets.append(
            {
                'start': {'east_m': float(east), 'north_m': float(north)},
                'course_deg': course,
                'speed_kn': speed,
            }
        )
    return scenario.build(
        {
            'duration_s': duration,
            'radar': {'max_range_nm': 12, 'range_sigma_m': 15, 'bearing_sigma_deg': 0.4},
            'clutter': {'uniform': 20},
            'own_ship': own,
            'targets': targets,
        },
        f'yaw of {amplitude:g} deg in {period:g} s',
    )


def shares(turn: int) -> list[float]:
    """True CPA of each ship, divided by the CPA limit."""
    return [SHARES[(k + turn) % len(SHARES)] for k in range(len(SHIPS))]
