"""Radar video for the page: sectors of true directions as the beam passes them.

The page gets PARTS messages a revolution, each with the directions of a sector: strengths 0 to 15,
the greatest of the samples that share a place, as letters from A on. Nothing is made while nobody
looks.
"""

import math
import time

import numpy as np
from sensor_msgs.msg import PointCloud2

from ..display.server import DisplayServer
from ..types import Array, BoolArray, OwnShip, Spokes, StrengthArray
from ..video import placing
from ..video.stack import full_scale
from . import convert, topics
from .base_node import RunnableNode
from .diagnostics import Tally
from .display_own import OwnShipHeard
from .faults import ConversionError
from .spokes import cloud_to_sweep

DIRECTIONS, PARTS, SAMPLES = 1024, 32, 256
IN_PART = DIRECTIONS // PARTS
KIND = 'spokes'


class DisplaySpokes:
    """Hears `radar/spokes` and tells the page; bad: the counter of what cannot be read."""

    def __init__(
        self, node: RunnableNode, server: DisplayServer, own: OwnShipHeard, bad: Tally
    ) -> None:
        self._server, self._own, self._bad = server, own, bad
        self._placing, self._base_ns = placing.start(), 0
        self._full = 1
        self._part = -1
        self._strength = np.zeros((IN_PART, SAMPLES), np.uint8)
        self._seen = np.zeros(IN_PART, bool)
        self._range = 0.0
        node.subscription(
            PointCloud2, topics.SPOKES, self._on_spokes, topics.best_effort(topics.SPOKES_DEPTH)
        )

    def _on_spokes(self, message: PointCloud2) -> None:
        if not self._server.viewers:
            return
        try:
            stamp = convert.nanoseconds(message.header.stamp)
            self._base_ns = self._base_ns or stamp
            start = (stamp - self._base_ns) * 1e-9
            sweep = cloud_to_sweep(message, start)
        except ConversionError as error:
            self._bad.add(error.reason, time.monotonic(), detail=str(error))
            return
        own_ship = self._own.relative_to(self._base_ns)
        self._placing, spokes, _ = placing.place(self._placing, sweep, own_ship)
        if len(spokes.time):
            self._take(spokes, own_ship)

    def _take(self, spokes: Spokes, own_ship: OwnShip) -> None:
        """Puts the spokes into their directions; a sector that the beam has left goes out."""
        known = np.isfinite(spokes.bearing)
        bearing = spokes.bearing[known]
        self._full = full_scale(spokes.strength, self._full)
        reduced = shrunk(spokes.strength[known], self._full)
        reach = (spokes.range_step * spokes.strength.shape[1])[known]
        direction = np.floor(bearing * (DIRECTIONS / (2 * math.pi))).astype(np.int64) % DIRECTIONS
        # A spoke fills the directions up to the next one.
        gap = np.median(np.diff(bearing) % (2 * math.pi)) if len(bearing) > 1 else 0.0
        wide = min(max(math.ceil(float(gap) * DIRECTIONS / (2 * math.pi)), 1), IN_PART)
        for k in range(len(direction)):
            for step in range(wide):
                at = int(direction[k] + step) % DIRECTIONS
                if step and at // IN_PART != int(direction[k]) // IN_PART:
                    continue
                if at // IN_PART != self._part or reach[k] != self._range:
                    self._send(own_ship)
                    self._part, self._range = at // IN_PART, float(reach[k])
                    self._strength[:] = 0
                    self._seen[:] = False
                row = at % IN_PART
                if not self._seen[row] or not step:
                    if step or not self._seen[row]:
                        self._strength[row] = reduced[k]
                    else:
                        np.maximum(self._strength[row], reduced[k], out=self._strength[row])
                    self._seen[row] = True

    def _send(self, own_ship: OwnShip) -> None:
        if self._part < 0 or not self._seen.any():
            return
        position = own_ship.position[-1]
        self._server.publish(
            KIND,
            {
                'at': time.monotonic(),
                'x': round(float(position[0]), 1),
                'y': round(float(position[1]), 1),
                'range': self._range,
                'part': self._part,
                'parts': PARTS,
                'directions': DIRECTIONS,
                'samples': SAMPLES,
                'seen': letters(self._seen),
                'strength': letters(self._strength),
            },
            self._part,
        )


def shrunk(strength: StrengthArray, full: int) -> StrengthArray:
    """[S, SAMPLES] of 0 to 15: the greatest of the samples [S, B] that share a place."""
    samples = strength.shape[1]
    if samples >= SAMPLES:
        first = np.arange(SAMPLES) * samples // SAMPLES
        strength = np.maximum.reduceat(strength, first, axis=1)
    else:
        strength = strength[:, np.arange(SAMPLES) * samples // SAMPLES]
    found: StrengthArray = (strength.astype(np.uint32) * 15 // full).astype(np.uint8)
    return found


def letters(values: StrengthArray | BoolArray | Array) -> str:
    """Whole numbers 0 to 15 as letters from A on."""
    return (np.asarray(values).astype(np.uint8) + ord('A')).tobytes().decode('ascii')
