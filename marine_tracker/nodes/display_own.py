"""Own ship for the page: where she and her plots are, by the same mounting as the tracker's.

Positions are told for the GPS antenna and plots are measured from the radar's antenna; with the
tracker's parameters both are brought to the reference point (tracking/mounting.py), and plots that
are stated from the bow to true bearings, each by the heading at its own time.
"""

import math
from collections import deque
from typing import Any, NamedTuple

import numpy as np
from nav_msgs.msg import Odometry
from sensor_msgs.msg import NavSatFix, NavSatStatus

from ..geodesy import LocalFrame
from ..geometry import on_deck, own_ship_at
from ..parameters import TrackerParameters
from ..tracking.mounting import mounted
from ..types import Array, OwnShip, PolarPlots, Scan
from . import convert
from .display_messages import plain

SAMPLES = 400  # of own ship, to place plots by
FIX_S = 10.0  # a position on Earth that is older is not shown
PAIRED_S = 2.0  # how far the stamp of a fix may lie beside the samples


class Sample(NamedTuple):
    """One odometry message: ns, [2] m, [2] m/s, rad (nan: not told)."""

    time_ns: int
    position: Array
    velocity: Array
    heading: float


class Fixed(NamedTuple):
    """A fix: deg, deg, own ship's position [2] m then, and s of the wall when it was heard."""

    latitude: float
    longitude: float
    position: Array
    heard: float


class OwnShipHeard:
    """What was heard of own ship. `radars`: the parameters of each of the tracker's radars."""

    def __init__(self) -> None:
        self.radars = [TrackerParameters()]
        self._samples: deque[Sample] = deque(maxlen=SAMPLES)
        self._last_heading = math.nan
        self._fix: Fixed | None = None

    def begin_anew(self) -> None:
        """What was heard so far is of another run."""
        self._samples.clear()
        self._last_heading, self._fix = math.nan, None

    def hear(self, message: Odometry) -> bool:
        """Take an odometry message; False where its position is not finite."""
        position, velocity = convert.odometry_to_own_ship(message)
        if not np.isfinite(position).all():
            return False
        heading = convert.heading_of_odometry(message)
        sample = Sample(convert.nanoseconds(message.header.stamp), position, velocity, heading)
        if self._samples and sample.time_ns < self._samples[-1].time_ns:  # another run
            self._samples.clear()
            self._fix = None
        self._samples.append(sample)
        if math.isfinite(heading):
            self._last_heading = heading
        return True

    def hear_fix(self, message: NavSatFix, wall: float) -> bool:
        """Take a fix; False where it is none. Where it belongs to is told by its stamp."""
        self._fix = None
        place = message.latitude, message.longitude
        if not np.isfinite(place).all() or abs(place[0]) > 90 or abs(place[1]) > 180:
            return False
        if message.status.status < NavSatStatus.STATUS_FIX:
            return False
        if self._samples:
            newest = self._samples[-1]
            after = (convert.nanoseconds(message.header.stamp) - newest.time_ns) * 1e-9
            if not -self._span() - PAIRED_S <= after <= PAIRED_S:
                after = 0.0  # of another clock, or without a stamp
            position, _ = own_ship_at(self._own_ship(), np.array([after]))
            self._fix = Fixed(*place, position[0], wall)
        return True

    def relative_to(self, time_ns: int) -> OwnShip:
        """Her last samples, their times in s after a stamp; at rest where none was heard."""
        if not self._samples:
            return OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))
        own = self._own_ship()
        return own._replace(time=own.time + (self._samples[-1].time_ns - time_ns) * 1e-9)

    @property
    def bow(self) -> float | None:
        """rad: the heading, or the last one that was told; without any it is 0 where a radar counts
        from the bow, for then the bow stands for north, else None."""
        if math.isfinite(self._last_heading):
            return self._last_heading
        return 0.0 if any(radar.bearings == 'bow' for radar in self.radars) else None

    @property
    def position(self) -> Array | None:
        """[2] m of the reference point; None before the first sample."""
        if not self._samples:
            return None
        first = self.radars[0]
        offset = -first.gps_ahead_m, -first.gps_starboard_m
        position: Array = self._samples[-1].position
        bow = self.bow
        return position if bow is None else position + on_deck(*offset, bow)

    def plain(self, wall: float) -> dict[str, Any]:
        """The message `own` of the page."""
        sample, position = self._samples[-1], self.position
        assert position is not None
        x, y, vx, vy = plain(np.hstack([position, sample.velocity]), 3)
        return {
            'at': wall,
            'time': sample.time_ns * 1e-9,
            'x': x,
            'y': y,
            'vx': vx,
            'vy': vy,
            'heading': sample.heading if math.isfinite(sample.heading) else None,
            'bow': self.bow,
            **self._on_earth(position, wall),
        }

    def _on_earth(self, position: Array, wall: float) -> dict[str, float | None]:
        """Her place now, reckoned from the last fix by her way since."""
        fix = self._fix
        if fix is None or wall - fix.heard > FIX_S:
            return {'latitude': None, 'longitude': None}
        frame = LocalFrame(fix.latitude, fix.longitude)
        latitude, longitude = frame.to_geodetic(position - fix.position)
        return {'latitude': round(float(latitude), 7), 'longitude': round(float(longitude), 7)}

    def place(self, plots: PolarPlots, stamp_ns: int, radar: int) -> Array | None:
        """Where the plots [M, 2] of a radar lie in the map, m; their times count from the stamp.

        None while own ship was not heard.
        """
        if not self._samples:
            return None
        start = (stamp_ns - self._samples[-1].time_ns) * 1e-9
        plots = plots._replace(time=plots.time + start)
        end = start + float(plots.time.max(initial=start) - start)
        scan = Scan(start, end, plots, self._own_ship(), radar)
        scan = mounted(scan, self.radars[radar], self._last_heading)
        return convert.plots_positions(scan)

    def _span(self) -> float:
        return (self._samples[-1].time_ns - self._samples[0].time_ns) * 1e-9

    def _own_ship(self) -> OwnShip:
        """The samples; time counts from the newest, s."""
        times, position, velocity, heading = zip(*self._samples, strict=True)
        moving = np.nan_to_num(np.array(velocity))  # not told: she stays where she was heard
        since = (np.array(times) - times[-1]) * 1e-9
        return OwnShip(since, np.array(position), moving, np.array(heading))
