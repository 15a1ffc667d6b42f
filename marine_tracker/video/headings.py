"""Own ship's heading at the time of each spoke.

A radar often tells the last heading that it heard, once a second, with every spoke. So a heading is
taken to be new when it changes, and to be straight in time between changes. After the last one it
goes on turning as before, for as long as that change took. Without this the picture swings in a
turn: at 6 degrees a second by 6 degrees.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import wrap_angle, wrap_bearing
from ..types import Array, BoolArray, OwnShip

TIMEOUT_S = 3.0  # an older heading is none
FASTEST = np.radians(40.0)  # rad/s; what turns faster is no ship ...
STEP = np.radians(3.0)  # ... beyond this
BELIEVED_S = 0.5  # a heading that has jumped and stays so for that long is believed


class Log(NamedTuple):
    """What was told of the heading.

    time, heading  [n]  s, rad without jumps at north: the last changes, at most two
    told           s, when one was told last
    odd            s, since when one is told to which no ship could have turned; nan: it is not
    """

    time: Array
    heading: Array
    told: float
    odd: float


def start() -> Log:
    """No heading told yet."""
    return Log(np.empty(0), np.empty(0), -np.inf, np.nan)


def follow(log: Log, time: Array, heading: Array) -> tuple[Log, Array, BoolArray]:
    """The log, the heading [S] rad at the time of each spoke [S], and which [S] told a jump.

    heading  [S]  rad, as told with the spokes; nan where it is not
    A spoke with a jump has no heading: nan.
    """
    jumped = np.zeros(len(time), bool)
    known = np.flatnonzero(np.isfinite(heading))
    if len(known):
        log, odd = _taken(log, time[known], heading[known])
        jumped[known] = odd
    found = np.where(jumped, np.nan, at(log.time, log.heading, log.told, time))
    return log._replace(time=log.time[-2:], heading=log.heading[-2:]), found, jumped


def _taken(log: Log, time: Array, told: Array) -> tuple[Log, BoolArray]:
    """The log with headings [n] told at times [n], and which [n] of them are jumps."""
    first = np.flatnonzero(np.diff(told, prepend=np.nan) != 0)
    times, headings = log.time.tolist(), log.heading.tolist()
    odd, rejected = log.odd, np.zeros(len(told), bool)
    last = np.append(first[1:], len(told))
    for begin, end in zip(first.tolist(), last.tolist()):
        now, value = float(time[begin]), float(told[begin])
        if headings:
            turned = float(wrap_angle(np.float64(value - headings[-1])))
            value = headings[-1] + turned
            quick = abs(turned) > STEP + FASTEST * min(max(now - times[-1], 0.0), TIMEOUT_S)
            before = float(time[begin - 1]) if begin else log.told
            if quick and now - before < TIMEOUT_S:
                odd = now if np.isnan(odd) else odd
                if time[end - 1] - odd < BELIEVED_S:
                    rejected[begin:end] = True
                    continue
                times, headings = [], []
            odd = np.nan
            if turned == 0:
                continue
        times.append(now)
        headings.append(value)
    return Log(np.array(times), np.array(headings), float(time[-1]), odd), rejected


def at(time: Array, heading: Array, told: float, wanted: Array) -> Array:
    """Heading [S] rad at the times `wanted` [S], from changes at times [n] to headings [n].

    told  s, until when the last heading was told; nan where the last one is older than TIMEOUT_S
    """
    if not len(time):
        return np.full(len(wanted), np.nan)
    found = np.interp(wanted, time, heading)
    if len(time) > 1:
        took = time[-1] - time[-2]
        after = wanted - time[-1]
        if 0 < took <= TIMEOUT_S:
            rate = (heading[-1] - heading[-2]) / took
            found = found + np.where((after > 0) & (after <= 1.2 * took), rate * after, 0.0)
    usable = (wanted <= max(told, time[-1]) + TIMEOUT_S) & (wanted >= time[0] - TIMEOUT_S)
    return np.where(usable, wrap_bearing(found), np.nan)


def of_own_ship(own_ship: OwnShip, wanted: Array) -> Array:
    """Heading [S] rad at the times `wanted` [S], from own ship's samples."""
    if own_ship.heading is None:
        return np.full(len(wanted), np.nan)
    known = np.isfinite(own_ship.heading)
    time, heading = own_ship.time[known], np.unwrap(own_ship.heading[known])
    return at(time, heading, float(time[-1]) if len(time) else -np.inf, wanted)
