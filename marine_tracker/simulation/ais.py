"""Ships driven by AIS reports: positions turned into smooth paths (ais_file.py reads them).

Times are whole seconds and sometimes late, so positions are metres wrong along the path. The path
is therefore a cubic smoothing spline, which does not go through every report.
"""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import PPoly, make_smoothing_spline

from ..geodesy import LocalFrame
from ..types import Array
from .motion import Piece

SMOOTHED_PERIOD = 40.0  # s; slower motion is followed, faster motion is treated as noise


class Reports(NamedTuple):
    """One vessel's reports near the scenario's time.

    time       [R]  s, from the scenario's start, strictly increasing
    latitude   [R]  deg
    longitude  [R]  deg
    length     m, nan if unknown
    max_gap    s; in a longer gap between reports the vessel does not exist
    """

    time: Array
    latitude: Array
    longitude: Array
    length: float
    max_gap: float


def way(reports: Reports, frame: LocalFrame) -> list[Piece]:
    """The vessel's path in the frame: a spline over each stretch without gaps."""
    position = frame.to_local(reports.latitude, reports.longitude)
    ends = np.flatnonzero(np.diff(reports.time) > reports.max_gap) + 1
    pieces = [Piece(min(0.0, reports.time[0]) - 1.0, tuple(position[0]), exists=False)]
    for time, place in zip(np.split(reports.time, ends), np.split(position, ends), strict=True):
        if len(time) > 1:
            curve = _spline(time, place)
            pieces += [
                Piece(start, tuple(c[3]), cubic=(tuple(c[2]), tuple(c[1]), tuple(c[0])))
                for start, c in zip(curve.x[:-1], np.moveaxis(curve.c, 1, 0), strict=True)
                if start < time[-1]
            ]
        pieces.append(Piece(time[-1], tuple(place[-1]), exists=False))
    return pieces


def _spline(time, place):
    """A piecewise cubic [4, pieces, 2] over the reports of one stretch."""
    if len(time) < 5:  # too few to smooth: straight lines between them
        slope = np.diff(place, axis=0) / np.diff(time)[:, None]
        zero = np.zeros_like(slope)
        return PPoly(np.stack([zero, zero, slope, place[:-1]]), time)
    # Reports T apart, smoothed with this weight, pass slow motion w as 1 / (1 + weight T w^4).
    weight = (SMOOTHED_PERIOD / (2 * np.pi)) ** 4 / np.diff(time).mean()
    columns = [
        PPoly.from_spline(make_smoothing_spline(time, column, lam=weight)) for column in place.T
    ]
    curve = PPoly(np.stack([column.c for column in columns], -1), columns[0].x)
    inside = np.flatnonzero(np.diff(curve.x) > 0)  # without the spline's repeated ends
    return PPoly(curve.c[:, inside], np.append(curve.x[inside], curve.x[inside[-1] + 1]))
