"""`markers`: targets for RViz and Foxglove, after IMO SN.1/Circ.243 as far as markers go.

A few LINE_LIST and POINTS markers hold all targets: thousands of single markers would cost more
than the tracking. Only the labels are one marker each; a lost target's label is deleted.
"""

from collections import deque

import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from ..tracking.lifecycle import LOST
from .convert import header
from .view import View, names

SYMBOL_M = 60.0             # radius of a target's circle
VECTOR_S = 360.0            # 6 minutes ahead
PAST_DOTS, PAST_EVERY_S = 8, 30.0
ELLIPSE_SIGMA = 2.0
CORNERS = np.linspace(0, 2 * np.pi, 17)
GREEN, GREY, WHITE = (0.2, 0.9, 0.3), (0.5, 0.6, 0.5), (0.9, 0.9, 0.9)


class MarkersWriter:
    """Builds the message; remembers past positions and which labels are shown."""

    def __init__(self):
        self._past: deque[tuple[float, np.ndarray, np.ndarray]] = deque(maxlen=PAST_DOTS)
        self._labelled: set[int] = set()

    def remember(self, seen: View, time: float) -> None:
        """Keep the positions for the past-position dots, equal in time; time in s."""
        if not self._past or abs(time - self._past[-1][0]) >= PAST_EVERY_S:
            self._past.append((time, seen.number, seen.estimate.position))

    def message(self, seen: View, time_ns: int) -> MarkerArray:
        """All targets of a view."""
        alive = seen.status != LOST
        number, position = seen.number[alive], seen.estimate.position[alive]
        velocity = seen.estimate.velocity[alive]
        covariance = seen.estimate.covariance[alive, :2, :2]
        circle = np.stack([np.cos(CORNERS), np.sin(CORNERS)], -1)
        # A covariance's Cholesky factor turns the unit circle into its ellipse.
        ellipse = ELLIPSE_SIGMA * np.einsum('nij,cj->nci', np.linalg.cholesky(covariance), circle)
        past = [of[np.isin(numbers, number)] for _, numbers, of in self._past]
        markers = [
            _marker('symbols', Marker.LINE_LIST, 6.0, GREEN,
                    _outline(position[:, None] + SYMBOL_M * circle)),
            _marker('vectors', Marker.LINE_LIST, 6.0, GREEN,
                    np.stack([position, position + VECTOR_S * velocity], 1)),
            _marker('past_positions', Marker.POINTS, 25.0, GREY,
                    np.concatenate(past) if past else np.empty((0, 2))),
            _marker('ellipses', Marker.LINE_LIST, 3.0, GREY,
                    _outline(position[:, None] + ellipse)),
        ]
        for n, name, (x, y) in zip(number.tolist(), names(number), position.tolist()):
            label = _marker('labels', Marker.TEXT_VIEW_FACING, 120.0, WHITE, np.empty((0, 2)), n)
            label.text = name
            label.pose.position.x, label.pose.position.y = x + 2 * SYMBOL_M, y + 2 * SYMBOL_M
            markers.append(label)
        shown = set(number.tolist())
        markers += [Marker(ns='labels', id=n, action=Marker.DELETE)
                    for n in sorted(self._labelled - shown)]
        self._labelled = shown
        stamp = header(time_ns)
        for marker in markers:
            marker.header = stamp
        return MarkerArray(markers=markers)


def _outline(corners):
    """Line-list points [N * 2 (C - 1), 2] of polygons with corners [N, C, 2]."""
    return np.stack([corners[:, :-1], corners[:, 1:]], 2).reshape(-1, 2)


def _marker(namespace: str, kind: int, size: float, color, points, number: int = 0) -> Marker:
    red, green, blue = color
    marker = Marker(ns=namespace, id=number, type=kind, action=Marker.ADD,
                    color=ColorRGBA(r=red, g=green, b=blue, a=1.0),
                    points=[Point(x=x, y=y) for x, y in points.reshape(-1, 2).tolist()])
    marker.pose.orientation.w = 1.0
    marker.scale.x = marker.scale.y = marker.scale.z = size
    return marker
