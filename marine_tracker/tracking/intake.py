"""Screening of what comes in: bad plots, bad times and bad own-ship data, each with a named reason.

Pure functions; what has to be remembered between two messages goes in and comes out. Times are
seconds of the sender's clock unless said otherwise. Nothing here ever drops a track: what is
rejected is counted by its reason, and the tracks coast.

How time is handled. A scan must begin after the last one. One that begins earlier, again at the
same time, or far ahead (`AHEAD_SCANS` scans, at least `AHEAD_S`) is rejected, for a single wrong
stamp must not move the tracks. When `REBASE_AFTER` scans in a row agree with each other on a new
time, the clock was set: the new time is taken, as if the first of them had followed the last good
scan by one revolution. The tracker's own time never jumps, so its tracks live through it.
Each radar has an order of its own. A scan that agrees with another radar's time is not far ahead,
however long its own was silent; and a clock that was set for one radar may be set for the others.

Own ship's position is treated likewise: a sample that implies more than `MAX_OWN_SPEED` is
rejected, until `REBASE_OWN_AFTER` samples in a row agree with each other.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry import KNOT, own_ship_at, wrap_bearing
from ..types import Array, OwnShip, PolarPlots, append, take

MAX_RANGE = 500e3  # m; no surface radar measures farther
MAX_RADIAL_SPEED = 100.0  # m/s, over ground; no target that a tracker is told of is faster
REBASE_AFTER = 3  # scans
AHEAD_SCANS, AHEAD_S = 10, 30.0
OFFSET_SCANS = 4  # a plot's time lies in its revolution; slow radars get some room
MAX_OWN_SPEED = 100 * KNOT  # m/s
OWN_JITTER = 50.0  # m that a position may jump at any time step
REBASE_OWN_AFTER = 5  # samples
MAX_OWN_SAMPLES = 2000
MAX_COORDINATE = 1e7  # m from the origin of the local plane

# Reasons for which plots, scans and own-ship samples are rejected: the names of the counters.
NOT_FINITE = 'plots not finite'
BAD_RANGE = 'plots with range not positive'
TOO_FAR = 'plots beyond 500 km'
BAD_BEARING = 'plots with bearing out of range'
BAD_OFFSET = 'plots with time out of the scan'
TOO_MANY = 'plots over max_plots'
SPEED_NOT_FINITE = 'radial speeds not finite'
SPEED_TOO_HIGH = 'radial speeds above 100 m/s'
PLOT_REASONS = (
    NOT_FINITE,
    BAD_RANGE,
    TOO_FAR,
    BAD_BEARING,
    BAD_OFFSET,
    TOO_MANY,
    SPEED_NOT_FINITE,
    SPEED_TOO_HIGH,
)

REPEATED = 'scans repeated'
WENT_BACK = 'scans with time going back'
JUMPED_AHEAD = 'scans with time jumping ahead'
REBASED = 'clock re-based'
CLOCKS_DIFFER = 'scans with a time far from other radars'
SCAN_REASONS = (REPEATED, WENT_BACK, JUMPED_AHEAD, REBASED, CLOCKS_DIFFER)

OWN_NOT_FINITE = 'samples not finite'
OWN_REPEATED = 'samples repeated'
OWN_WENT_BACK = 'samples with time going back'
OWN_TELEPORTED = 'samples with impossible speed'
OWN_REBASED = 'own ship re-based'
OWN_REASONS = (OWN_NOT_FINITE, OWN_REPEATED, OWN_WENT_BACK, OWN_TELEPORTED, OWN_REBASED)

OWN_NEVER_HEARD = 'never heard: taken at rest at the origin'
OWN_SILENT = 'silent: taken at rest at the last known position'


def screen_plots(
    plots: PolarPlots, scan_period: float, max_plots: int
) -> tuple[PolarPlots, dict[str, int]]:
    """The usable plots of one revolution, and how many others there were by reason.

    plots        M plots; `time` counts from the start of the revolution, s
    scan_period  s, of one revolution
    max_plots    the strongest so many are kept (of equals, the first)

    Bearings in [-pi, 2 pi] are wrapped to [0, 2 pi); others are rejected. A plot whose radial speed
    alone is bad stays: where it lies is sound. The radial speed becomes nan and is counted.
    """
    counts = {}
    ok = np.ones(len(plots.range), bool)
    finite = (
        np.isfinite(plots.range)
        & np.isfinite(plots.bearing)
        & np.isfinite(plots.time)
        & np.isfinite(plots.amplitude)
    )
    margin = 1e-6  # float32 rounds 2 pi up
    with np.errstate(invalid='ignore'):
        checks = (
            (NOT_FINITE, finite),
            (BAD_RANGE, plots.range > 0),
            (TOO_FAR, plots.range <= MAX_RANGE),
            (
                BAD_BEARING,
                (plots.bearing >= -np.pi - margin) & (plots.bearing <= 2 * np.pi + margin),
            ),
            (BAD_OFFSET, (plots.time >= -1e-3) & (plots.time <= OFFSET_SCANS * scan_period)),
        )
    for reason, good in checks:
        rejected = int(np.count_nonzero(ok & ~good))
        if rejected:
            counts[reason] = rejected
            ok &= good
    if not ok.all():
        plots = take(plots, ok)
    if len(plots.range) > max_plots:
        counts[TOO_MANY] = len(plots.range) - max_plots
        strongest = np.argsort(-plots.amplitude, kind='stable')[:max_plots]
        plots = take(plots, np.sort(strongest))
    if plots.radial_speed is not None:
        speed = np.abs(plots.radial_speed)
        for reason, bad in (
            (SPEED_NOT_FINITE, ~np.isfinite(speed)),
            (SPEED_TOO_HIGH, np.isfinite(speed) & (speed > MAX_RADIAL_SPEED)),
        ):
            if bad.any():
                counts[reason] = int(np.count_nonzero(bad))
        sound = speed <= MAX_RADIAL_SPEED
        plots = plots._replace(radial_speed=np.where(sound, plots.radial_speed, np.nan))
    return plots._replace(bearing=wrap_bearing(plots.bearing)), counts


class TimeOrder(NamedTuple):
    """What the time of the next scan is judged by.

    last     s, start of the last scan taken; nan before the first
    shift    s, the tracker's time minus the sender's
    waiting  s, starts of the scans rejected since, in the order they came
    """

    last: float = np.nan
    shift: float = 0.0
    waiting: tuple[float, ...] = ()


def admit_scan(
    order: TimeOrder, start: float, scan_period: float, others: Sequence[TimeOrder] = ()
) -> tuple[TimeOrder, bool, str]:
    """Whether a scan that begins at `start` is to be taken, and the reason to count or ''.

    others  the orders of the other radars
    """
    ahead, new = max(AHEAD_S, AHEAD_SCANS * scan_period), math.isnan(order.last)
    others = [other for other in others if not math.isnan(other.last)]
    for shift in dict.fromkeys((order.shift, *(other.shift for other in others))):
        after = start + shift - (order.last + order.shift)  # nan for a new radar
        beside = any(abs(start + shift - other.last - other.shift) <= ahead for other in others)
        if (0 < after <= ahead) or ((new or after > 0) and beside) or (new and not others):
            same = new or shift == order.shift
            return TimeOrder(start, shift), True, '' if same else REBASED
    if new:
        return order, False, CLOCKS_DIFFER
    follows = order.waiting and order.waiting[-1] < start <= order.waiting[-1] + ahead
    waiting = (*order.waiting, start) if follows else (start,)
    if len(waiting) >= REBASE_AFTER:
        # The tracker's time of waiting[0] becomes that of the last good scan plus one period.
        shift = order.shift + order.last + scan_period - waiting[0]
        return TimeOrder(start, shift, ()), True, REBASED
    reason = REPEATED if start == order.last else WENT_BACK if start < order.last else JUMPED_AHEAD
    return order._replace(waiting=waiting), False, reason


class OwnShipLog(NamedTuple):
    """Own-ship samples taken lately, in time order, and those rejected since the last of them."""

    taken: OwnShip
    waiting: OwnShip


def empty_log() -> OwnShipLog:
    """A log that has heard nothing."""
    none = OwnShip(np.empty(0), np.empty((0, 2)), np.empty((0, 2)))
    return OwnShipLog(none, none)


def admit_own_ship(
    log: OwnShipLog, time: float, position: Array, velocity: Array
) -> tuple[OwnShipLog, str]:
    """The log with the sample (position, velocity [2] m, m/s) taken; the reason to count, or ''."""
    sample = OwnShip(
        np.array([time]),
        np.reshape(position, (1, 2)).astype(float),
        np.reshape(velocity, (1, 2)).astype(float),
    )
    numbers = (time, *position, *velocity)
    if not (all(map(math.isfinite, numbers)) and max(map(abs, position)) <= MAX_COORDINATE):
        return log, OWN_NOT_FINITE
    reason = _against(log.taken, sample)
    if not reason:
        taken = append(log.taken, sample)
        if len(taken.time) > MAX_OWN_SAMPLES:
            taken = take(taken, slice(-MAX_OWN_SAMPLES, None))
        return OwnShipLog(taken, take(log.waiting, slice(0))), ''
    waiting = sample if _against(log.waiting, sample) else append(log.waiting, sample)
    if len(waiting.time) >= REBASE_OWN_AFTER:
        return OwnShipLog(waiting, take(waiting, slice(0))), OWN_REBASED
    return log._replace(waiting=waiting), reason


def _against(earlier: OwnShip, sample: OwnShip) -> str:
    """Why the sample cannot follow the earlier ones; '' if it can."""
    if math.hypot(*sample.velocity[0]) > MAX_OWN_SPEED:
        return OWN_TELEPORTED
    if not len(earlier.time):
        return ''
    step = sample.time[0] - earlier.time[-1]
    if step <= 0:
        return OWN_REPEATED if step == 0 else OWN_WENT_BACK
    moved = math.hypot(*(sample.position[0] - earlier.position[-1]))
    return OWN_TELEPORTED if moved > MAX_OWN_SPEED * step + OWN_JITTER else ''


def own_ship_for(log: OwnShipLog, start: float, end: float, timeout: float) -> tuple[OwnShip, str]:
    """Own ship during a revolution, and '' or the fallback that was used.

    start, end  s, of the revolution, on the clock of the samples
    timeout     s; when no sample is nearer than this to the revolution, own ship is silent

    A silent own ship is taken at rest where it was last; one never heard, at rest at the origin.
    """
    taken = log.taken
    if not len(taken.time):
        return OwnShip(np.array([start]), np.zeros((1, 2)), np.zeros((1, 2))), OWN_NEVER_HEARD
    first = max(np.searchsorted(taken.time, start, 'right') - 1, 0)
    last = np.searchsorted(taken.time, end, 'left') + 1
    near = take(taken, slice(first, last))
    if near.time[0] > end + timeout or near.time[-1] < start - timeout:
        position, _ = own_ship_at(near, near.time[-1:])
        return OwnShip(np.array([start]), position, np.zeros((1, 2))), OWN_SILENT
    return near, ''
