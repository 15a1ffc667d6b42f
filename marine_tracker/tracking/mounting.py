"""Where the antennas are on board: one reference point for all that is measured.

A ship has one reference point (IMO MSC.192(79), 5.9: CCRP), mostly where the officer of the watch
stands. Positions are told for the GPS antenna and plots are measured from the radar antenna; here,
and nowhere else, both are brought to the reference point. That takes own ship's heading. Where it
was never told, nothing is moved, and `needs_heading` says so.
"""

from collections.abc import Iterable

import numpy as np

from ..geometry import heading_at, on_deck, wrap_angle, wrap_bearing
from ..parameters import TrackerParameters
from ..types import Array, OwnShip, Scan, Sector


def mounted(scan: Scan, radar: TrackerParameters, heading: float) -> Scan:
    """The scan with own ship's reference point, its antenna's place, and true bearings.

    scan     as it came: own ship is where the GPS antenna is, bearings are as the radar counts them
    radar    the parameters of its radar
    heading  rad, own ship's where a sample does not tell hers; nan: not known

    A radar whose bearings count from the bow takes the bow for north while no heading is known.
    """
    gps = radar.gps_ahead_m, radar.gps_starboard_m
    antenna = radar.antenna_ahead_m, radar.antenna_starboard_m
    relative = radar.bearings == 'bow'
    if not (any(gps) or any(antenna) or radar.bearing_offset_deg or relative):
        return scan
    own, headings = scan.own_ship, _headings(scan.own_ship, heading)

    def true(bearing: Array, time: Array) -> Array:
        bow = heading_at(own._replace(heading=headings), time) if relative else np.zeros(1)
        found: Array = bearing + np.radians(radar.bearing_offset_deg) + np.nan_to_num(bow)
        return found

    bearing = true(scan.plots.bearing, scan.plots.time)
    scan = scan._replace(plots=scan.plots._replace(bearing=wrap_bearing(bearing)))
    if scan.sector is not None:  # of a turning ship also the angle differs
        first, angle = scan.sector
        edges = true(np.array([first, first + angle]), np.array([scan.start, scan.end]))
        turned = angle + wrap_angle(np.diff(edges) - angle)
        scan = scan._replace(sector=Sector(float(edges[0]), float(turned[0])))
    if scan.unswept is not None:
        first, width = scan.unswept.T
        middle = np.full(len(first), 0.5 * (scan.start + scan.end))
        turned_gaps = np.stack([wrap_bearing(true(first, middle)), width], 1)
        scan = scan._replace(unswept=turned_gaps)
    if np.isnan(headings).any():
        return scan
    own = _moved(own, -gps[0], -gps[1], headings)
    return scan._replace(
        own_ship=own, antenna=_moved(own, *antenna, headings) if any(antenna) else None
    )


def needs_heading(radars: Iterable[TrackerParameters]) -> bool:
    """Whether anything that the parameters tell can be applied with a heading only."""
    return any(
        radar.bearings == 'bow'
        or radar.gps_ahead_m
        or radar.gps_starboard_m
        or radar.antenna_ahead_m
        or radar.antenna_starboard_m
        for radar in radars
    )


def _headings(own: OwnShip, heading: float) -> Array:
    """The headings [K] rad of the samples; `heading` for those that do not tell theirs."""
    told = np.full(len(own.time), np.nan) if own.heading is None else own.heading
    return np.where(np.isnan(told), heading, told)


def _moved(own: OwnShip, ahead: float, starboard: float, headings: Array) -> OwnShip:
    """The samples of a place so many m ahead and to starboard; a turn moves it, too."""
    step = on_deck(ahead, starboard, headings)
    return own._replace(position=own.position + step, velocity=own.velocity + _rate(own.time, step))


def _rate(time: Array, step: Array) -> Array:
    """m/s [2], how the step [K, 2] m changes: of a straight line in time through all samples."""
    centred = time - time.mean()
    rate: Array = centred @ step / max(float(centred @ centred), 1e-9)
    return rate
