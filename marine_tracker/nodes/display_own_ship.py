"""Own ship for the page: her way as the targets' courses and speeds are measured, her size."""

import math
import re
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node

from ..arpa.stabilisation import GROUND, NONE
from ..geometry import KNOT
from ..parameters import PpiDisplayParameters
from .display_messages import number, values_of

TARGET = re.compile(r'target TT(\d+)')
SIMULATION, RECORDING, RADAR = 'simulation', 'recording', 'radar'
SOURCES = {'radar_simulator': SIMULATION, 'recording_player': RECORDING}


class OwnWay:
    """As the last `own_ship/state` told; over ground, as the odometry tells, before the first."""

    def __init__(self) -> None:
        self._told: dict[str, Any] | None = None

    def hear(self, message: DiagnosticArray) -> None:
        """A message of `own_ship/state`."""
        about = values_of(message.status[0]) if message.status else {}
        if 'stabilised' not in about:
            return
        speed, course = number(about.get('speed_kn')), number(about.get('course_deg'))
        way: list[float | None] = [None, None]
        if speed is not None and (course is not None or speed == 0):
            bearing = math.radians(course or 0.0)
            way = [
                round(speed * KNOT * math.sin(bearing), 3),
                round(speed * KNOT * math.cos(bearing), 3),
            ]
        target = TARGET.fullmatch(about.get('stabilised by', ''))
        self._told = {
            'wx': way[0],
            'wy': way[1],
            'stabilised': NONE if way[0] is None else about['stabilised'],
            'by': about.get('stabilised by', ''),
            'reference': int(target[1]) if target else 0,
        }

    def told(self, vx: float | None, vy: float | None) -> dict[str, Any]:
        """For the message `own`; vx, vy m/s over ground."""
        return self._told or {'wx': vx, 'wy': vy, 'stabilised': GROUND, 'by': '', 'reference': 0}


def ship(p: PpiDisplayParameters, node: Node) -> dict[str, Any]:
    """Her size, m, and what the picture comes from: a radar, a simulation, a recording."""
    heard = {
        SOURCES.get(publisher.node_name, RADAR)
        for publisher in node.get_publishers_info_by_topic(p.plots_topic)
    }
    return {
        'length': p.own_length_m,
        'beam': p.own_beam_m,
        'bow': p.own_bow_m if p.own_bow_m >= 0 else p.own_length_m / 2,
        'source': next((source for source in SOURCES.values() if source in heard), RADAR),
    }
