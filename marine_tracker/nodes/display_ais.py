"""Ships of AIS for the page: `ais/targets` as plain values."""

import time
from typing import Any

import numpy as np
from sensor_msgs.msg import PointCloud2

from .. import m1371
from ..ais.ais import ACTIVATED
from ..ais.join import BOTH
from ..display.server import DisplayServer
from ..types import Array, IntArray
from . import ais_targets_cloud, topics
from .ais_cloud import NONE, text_of
from .base_node import RunnableNode
from .diagnostics import Tally, one_line
from .display_messages import plain
from .faults import ConversionError

BAD_SHIPS = 'AIS targets not readable'
WHOLE = ('id', 'mmsi', 'track', 'kind', 'state', 'shown', 'danger')
FLAGS = ('lost', 'double', 'accurate', 'coarse')
DECIMALS = {
    **{'x': 1, 'y': 1, 'vx': 2, 'vy': 2, 'heading': 3, 'course': 3, 'turn': 4, 'speed': 2},
    **{'range': 0, 'bearing': 4, 'cpa': 0, 'tcpa': 0, 'cpa_sd': 0, 'tcpa_sd': 0},
    **{'probability': 3, 'danger_probability': 3, 'length': 0, 'beam': 0, 'age': 0},
}


class DisplayAis:
    """Hears the ships, hands them to the page."""

    def __init__(self, node: RunnableNode, server: DisplayServer, bad: Tally) -> None:
        self._server, self._bad = server, bad
        self._rows = np.zeros(0, ais_targets_cloud.SHIP_TYPE)
        node.subscription(PointCloud2, topics.AIS_TARGETS, self._on_ships, topics.latched())

    def _on_ships(self, message: PointCloud2) -> None:
        try:
            rows = ais_targets_cloud.read(message)
        except ConversionError as error:
            self._bad.add(BAD_SHIPS, time.monotonic(), detail=str(error))
            return
        self._rows = rows
        words = {'statuses': m1371.STATUSES, 'kinds': m1371.KINDS}
        self._server.publish('ships', {'at': time.monotonic(), 'columns': ships(rows), **words})

    def places(self) -> tuple[IntArray, Array]:
        """For past positions, as `places`."""
        return places(self._rows)


def places(rows: np.ndarray) -> tuple[IntArray, Array]:
    """Of the activated ships that are no radar target: ids below 0 [K], places [K, 2] m."""
    alone = rows[(rows['shown'] == ACTIVATED) & (rows['state'] != BOTH)]
    return -alone['id'].astype(int), np.stack([alone['x'], alone['y']], 1).astype(float)


def ships(rows: np.ndarray) -> dict[str, list[Any]]:
    """The columns that the page shows; None for what is not known."""
    return {
        **{name: rows[name].tolist() for name in (*WHOLE, *FLAGS)},
        **{name: plain(rows[name], digits) for name, digits in DECIMALS.items()},
        'nav': [None if status == NONE else status for status in rows['status'].tolist()],
        **{
            name: [one_line(text) for text in text_of(rows[name]).tolist()]
            for name in ('name', 'call_sign')
        },
    }
