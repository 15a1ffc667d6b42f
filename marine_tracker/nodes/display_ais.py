"""Ships of AIS for the page: `ais/targets` as plain values."""

import time
from typing import Any

import numpy as np
from sensor_msgs.msg import PointCloud2

from ..display.server import DisplayServer
from . import ais_targets_cloud, topics
from .ais_cloud import text_of
from .base_node import RunnableNode
from .diagnostics import Tally, one_line
from .display_messages import plain
from .faults import ConversionError

BAD_SHIPS = 'AIS targets not readable'
WHOLE = ('mmsi', 'track', 'kind', 'state', 'shown', 'danger', 'lost')
DECIMALS = {
    **{'x': 1, 'y': 1, 'vx': 2, 'vy': 2, 'heading': 3, 'course': 3, 'turn': 4, 'speed': 2},
    **{'range': 0, 'bearing': 4, 'cpa': 0, 'tcpa': 0, 'probability': 3, 'age': 0},
}


class DisplayAis:
    """Hears the ships, hands them to the page."""

    def __init__(self, node: RunnableNode, server: DisplayServer, bad: Tally) -> None:
        self._server, self._bad = server, bad
        node.subscription(PointCloud2, topics.AIS_TARGETS, self._on_ships, topics.latched())

    def _on_ships(self, message: PointCloud2) -> None:
        try:
            rows = ais_targets_cloud.read(message)
        except ConversionError as error:
            self._bad.add(BAD_SHIPS, time.monotonic(), detail=str(error))
            return
        self._server.publish('ships', {'at': time.monotonic(), 'columns': ships(rows)})


def ships(rows: np.ndarray) -> dict[str, list[Any]]:
    """The columns that the page shows; None for what is not known."""
    return {
        **{name: rows[name].tolist() for name in WHOLE},
        **{name: plain(rows[name], digits) for name, digits in DECIMALS.items()},
        'name': [one_line(name) for name in text_of(rows['name']).tolist()],
    }
