"""The areas of danger for the page: asked of the tracker only while somebody looks at them."""

import time
from typing import Any

import numpy as np
from sensor_msgs.msg import PointCloud2

from ..display.server import AREAS, DisplayServer
from . import targets_cloud, topics
from .base_node import RunnableNode
from .danger_areas_cloud import AREA_TYPE, RING
from .display_messages import plain


class DangerAreas:
    """Of one display node."""

    def __init__(self, node: RunnableNode, server: DisplayServer) -> None:
        self._node, self._server = node, server
        self._subscription: Any = None

    def look(self) -> None:
        """To be called every second: listens while a viewer wants the areas."""
        wanted = self._server.wanted(AREAS) > 0
        if wanted and self._subscription is None:
            self._subscription = self._node.subscription(
                PointCloud2, topics.DANGER_AREAS, self._on_areas, topics.latched()
            )
        elif not wanted and self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None
            self._server.forget(AREAS)

    def _on_areas(self, message: PointCloud2) -> None:
        rows = targets_cloud.read(message, AREA_TYPE)
        self._server.publish(AREAS, {'at': time.monotonic(), **areas(rows)})


def areas(rows: np.ndarray) -> dict[str, Any]:
    """Plain values of AREA_TYPE rows: own ship's place, sectors of safe courses in degrees, areas.

    safe is None where there is no ring: own ship's course and speed are not known.
    """
    ring, rest = rows[rows['area'] == RING], rows[rows['area'] != RING]
    if not len(ring):
        return {'safe': None, 'areas': []}
    starts = np.flatnonzero(np.diff(rest['area'], prepend=RING))
    return {
        'x': round(float(ring['x'][0]), 1),
        'y': round(float(ring['y'][0]), 1),
        'safe': _sectors(ring),
        'areas': [
            {
                'number': int(one['number'][0]),
                'id': int(one['id'][0]),
                'course': plain(np.degrees(one['course']), 2),
                'near': plain(one['near'], 0),
                'far': plain(one['far'], 0),
                'probability': plain(one['probability'], 2),
            }
            for one in np.split(rest, starts[1:])
            if len(one)
        ],
    }


def _sectors(ring: np.ndarray) -> list[list[float]]:
    """First and last course, degrees, of each run of safe ones, clockwise; all: [0, 360]."""
    safe, course = ring['safe'] > 0, np.degrees(ring['course'])
    if safe.all():
        return [[0.0, 360.0]]
    first = course[safe & ~np.roll(safe, 1)]
    last = course[safe & ~np.roll(safe, -1)]
    if len(first) and last[0] < first[0]:
        last = np.roll(last, -1)  # the run across north
    return [[round(a, 1), round(b, 1)] for a, b in zip(first.tolist(), last.tolist())]
