"""When the antenna beam passes a bearing."""

from typing import NamedTuple

import numpy as np

from ..geometry import wrap_bearing
from ..types import Array, BoolArray, Scan

TURN = 2 * np.pi


class Sweep(NamedTuple):
    """One antenna revolution, clockwise at constant rate.

    start     s
    period    s; 0 if all plots have the same time
    bearing0  rad, direction of the beam at `start`
    """

    start: float
    period: float
    bearing0: float

    def time_at(self, bearing: Array) -> Array:
        """s, when the beam passes the bearings [...] rad."""
        if self.period == 0:
            return np.full(np.shape(bearing), self.start)
        turned = np.mod(bearing - self.bearing0, 2 * np.pi)
        return self.start + self.period / (2 * np.pi) * turned


def sweep_of(scan: Scan) -> Sweep:
    """The sweep of a scan; of a sector the revolution that ends with it.

    The start direction of the beam in a whole revolution is derived from its plots. If their times
    do not follow the bearing clockwise (no plots, or another kind of antenna), every bearing is
    taken as swept in the middle of the scan.
    """
    period = scan.end - scan.start
    if scan.sector is not None:
        period *= TURN / scan.sector.angle
        last = scan.sector.bearing + scan.sector.angle
        return Sweep(scan.end - period, period, float(np.mod(last, TURN)))
    time, bearing = scan.plots.time, scan.plots.bearing
    if period > 0 and len(time):
        phase = bearing - (time - scan.start) * (2 * np.pi / period)
        sin, cos = np.sin(phase).mean(), np.cos(phase).mean()
        if np.hypot(sin, cos) > 0.9:
            return Sweep(scan.start, period, float(np.arctan2(sin, cos)))
    return Sweep(0.5 * (scan.start + scan.end), 0.0, 0.0)


def swept(scan: Scan, bearing: Array) -> BoolArray:
    """[N] whether the beam swept the bearings [N] rad, that is whether no gap is there."""
    if scan.unswept is None:
        return np.ones(len(bearing), bool)
    first, width = scan.unswept.T
    found: BoolArray = (wrap_bearing(bearing[:, None] - first) > width).all(1)
    return found
