"""Plots gathered into scans: whole revolutions, or sectors of any width."""

import math
from typing import NamedTuple

import numpy as np

from ..geometry import wrap_bearing
from ..types import OwnShip, PolarPlots, Scan, Sector, append, take
from .found import Found, nothing

LOST_S = 30.0  # without a spoke for so long the antenna was off: the scan ends there


class Gathering(NamedTuple):
    """Plots of the scan that is under way.

    plots    all that have come out and lie in no scan yet
    start    s, when it began; nan: before the first spoke
    time, bearing  s, rad: up to where all plots have come out
    turned   rad since the start
    """

    plots: PolarPlots
    start: float
    time: float
    bearing: float
    turned: float


def start() -> Gathering:
    """No plots yet."""
    return Gathering(nothing().plots, math.nan, math.nan, math.nan, 0.0)


def gather(
    known: Gathering, found: Found, own_ship: OwnShip, width: float = 2 * math.pi
) -> tuple[Gathering, list[Scan]]:
    """The plots found go into scans `width` rad wide; the scans that are whole come out.

    A scan's start and end are when the beam passed its edges. Where spokes are missing the beam is
    taken to have turned on evenly.
    """
    plots = append(known.plots, found.plots)
    time, bearing = found.until
    if math.isnan(time):
        return known._replace(plots=plots), []
    if math.isnan(known.start):
        first = min(time, float(plots.time.min(initial=time)))
        return Gathering(plots, first, time, bearing, 0.0), []
    turn = float(wrap_bearing(np.float64(bearing - known.bearing)))
    if turn > 1.9 * math.pi:  # a hair backwards: a heading that was corrected
        turn = 0.0
    if time - known.time > LOST_S:
        turn = width
    scans = []
    turned, began = known.turned, known.time
    start_, known_bearing = known.start, known.bearing
    while turned + turn >= width - 1e-6:
        share = min(max((width - turned) / turn, 0.0), 1.0) if turn > 0 else 1.0
        end = began + share * (time - began)
        inside = plots.time <= end
        sector = None
        if width < 2 * math.pi:
            last = known_bearing + share * turn
            sector = Sector(float(wrap_bearing(np.float64(last - width))), width)
        scans.append(Scan(start_, end, take(plots, inside), own_ship, sector=sector))
        known_bearing += share * turn
        plots, start_, began = take(plots, ~inside), end, end
        turn, turned = turn - (width - turned), 0.0
    return Gathering(plots, start_, time, bearing, turned + max(turn, 0.0)), scans


def rest(known: Gathering, own_ship: OwnShip) -> list[Scan]:
    """What is left when no spoke follows, as a scan; none if there is nothing."""
    if not len(known.plots.time):
        return []
    end = max(known.time, float(known.plots.time.max()))
    return [Scan(min(known.start, float(known.plots.time.min())), end, known.plots, own_ship)]
