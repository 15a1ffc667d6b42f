"""`markers`: targets for RViz and Foxglove, like IMO SN.1/Circ.243 as far as markers allow.

A few LINE_LIST and POINTS markers hold all targets, because thousands of single markers would cost
more than the tracking. Only each label is a marker of its own. A lost target's label is deleted.
"""

import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from ..arpa import past_positions
from ..arpa.arpa import Picture
from ..arpa.own_motion import vectors
from ..arpa.stabilisation import NONE
from ..arpa.view import View
from ..arpa.zone_outlines import outlines as zone_outlines
from ..arpa.zones import Zones
from ..parameters import ArpaParameters
from ..tracking.lifecycle import LOST
from ..types import row_of
from .convert import header
from .hull_columns import outlines

SYMBOL_M = 60.0  # radius of a target's circle
ELLIPSE_SIGMA = 2.0
CORNERS = np.linspace(0, 2 * np.pi, 17)
GREEN, RED, GREY, WHITE = (0.2, 0.9, 0.3), (1.0, 0.2, 0.2), (0.5, 0.6, 0.5), (0.9, 0.9, 0.9)
AMBER, MAGENTA = (1.0, 0.7, 0.1), (0.8, 0.3, 0.8)


class MarkersWriter:
    """Builds the message. Remembers which labels are shown."""

    def __init__(self) -> None:
        self._labelled: set[int] = set()

    def message(
        self, seen: View, picture: Picture, zones: Zones, parameters: ArpaParameters, time_ns: int
    ) -> MarkerArray:
        """All targets of a view. Dangerous ones are red; acquired ones without a number yet are
        grey.
        """
        alive = (seen.status != LOST) & np.isfinite(seen.motion.position).all(1)
        ids, position = seen.id[alive], seen.motion.position[alive]
        covariance = seen.motion.covariance[alive, :2, :2]
        relative = parameters.vectors == 'relative' or seen.stabilised == NONE
        ends = vectors(seen.motion, picture.own, 60 * parameters.vector_time_min, relative)[alive]
        arrows = np.stack([position, ends], 1)
        circle = np.stack([np.cos(CORNERS), np.sin(CORNERS)], -1)
        symbols = _outline(position[:, None] + SYMBOL_M * circle)
        # A covariance's Cholesky factor turns the unit circle into its ellipse.
        ellipse = ELLIPSE_SIGMA * np.einsum('nij,cj->nci', np.linalg.cholesky(covariance), circle)
        past = picture.past
        dots = (
            past_positions.relative(past) + picture.own.position if relative else past.position
        )[row_of(past.id, ids)].reshape(-1, 2)
        red, number = seen.dangerous[alive], seen.number[alive]
        markers = [
            _marker('symbols', Marker.LINE_LIST, 6.0, GREEN, symbols[~red]),
            _marker(
                'dangerous',
                Marker.LINE_LIST,
                10.0,
                RED,
                np.concatenate([symbols[red].reshape(-1, 2), arrows[red].reshape(-1, 2)]),
            ),
            _marker('vectors', Marker.LINE_LIST, 6.0, GREEN, arrows[~red]),
            _marker('past_positions', Marker.POINTS, 25.0, GREY, dots[np.isfinite(dots[:, 0])]),
            _marker('ellipses', Marker.LINE_LIST, 3.0, GREY, _outline(position[:, None] + ellipse)),
        ]
        if seen.hulls is not None:
            hulls, rows = outlines(seen.hulls, alive)
            hull = _marker(
                'hulls',
                Marker.LINE_LIST,
                4.0,
                WHITE,
                _outline(seen.motion.position[rows][:, None] + hulls),
            )
            hull.lifetime.sec = 10  # removed some scans after extents were switched off
            markers.append(hull)
        for guard, color in ((True, AMBER), (False, MAGENTA)):
            markers.append(
                _marker(
                    'guard_zones' if guard else 'exclusion_zones',
                    Marker.LINE_LIST,
                    5.0,
                    color,
                    zone_outlines(zones, guard, picture.own.position, picture.own.heading),
                )
            )
        names = [name for name, lives in zip(seen.name, alive.tolist()) if lives]
        for n, name, red_, (x, y) in zip(number.tolist(), names, red.tolist(), position.tolist()):
            if n:
                label = _marker(
                    'labels',
                    Marker.TEXT_VIEW_FACING,
                    120.0,
                    RED if red_ else WHITE,
                    np.empty((0, 2)),
                    n,
                )
                label.text = name
                label.pose.position.x, label.pose.position.y = x + 2 * SYMBOL_M, y + 2 * SYMBOL_M
                markers.append(label)
        shown = set(number.tolist()) - {0}
        markers += [
            Marker(ns='labels', id=n, action=Marker.DELETE) for n in sorted(self._labelled - shown)
        ]
        self._labelled = shown
        stamp = header(time_ns)
        for marker in markers:
            marker.header = stamp
        return MarkerArray(markers=markers)


def _outline(corners):
    """Line-list points [N, 2 (C - 1), 2] of polygons with corners [N, C, 2]."""
    count, corner, _ = corners.shape
    return np.stack([corners[:, :-1], corners[:, 1:]], 2).reshape(count, 2 * (corner - 1), 2)


def _marker(namespace: str, kind: int, size: float, color, points, number: int = 0) -> Marker:
    red, green, blue = color
    marker = Marker(
        ns=namespace,
        id=number,
        type=kind,
        action=Marker.ADD,
        color=ColorRGBA(r=red, g=green, b=blue, a=1.0),
        points=[Point(x=x, y=y) for x, y in points.reshape(-1, 2).tolist()],
    )
    marker.pose.orientation.w = 1.0
    marker.scale.x = marker.scale.y = marker.scale.z = size
    return marker
