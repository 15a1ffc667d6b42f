"""Screening of plots and of the times of scans, each fault with a named reason.

Pure functions; what has to be remembered between two messages goes in and comes out. Times are
seconds of the sender's clock unless said otherwise. Nothing here ever drops a track: what is
rejected is counted by its reason, and the tracks coast. Own ship is screened likewise (own_ship).

How time is handled. A scan must begin after the last one. How far ahead it may begin, another clock
tells (clocks.py): `SLACK_SCANS` more than the time that we waited for it, or that own ship's stamps
went on, or other radars'. So a pause is a pause, however long: tracks are extrapolated over it. One
stamp that nothing agrees with moves nothing: its scan is rejected. Without any clock to compare
with, a step of `AHEAD_SCANS` scans, at least `AHEAD_S`, is taken.

Where scans go on at times that cannot be silence, the clock was set or a recording began again:
after `REBASE_AFTER` of them in a row the new time is taken, as if the first of them had followed
the last good scan by the time that passed meanwhile, or one revolution. The tracker's time never
jumps, so its tracks live through it. A step ahead of less than `AHEAD_S` that neither clock can
judge is taken for silence once a second scan agrees with it.
Each radar has an order of its own. A clock that was set for one radar may be set for the others.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry import wrap_bearing
from ..types import BoolArray, PolarPlots, take
from .clocks import Beat

MAX_RANGE = 500e3  # m; no surface radar measures farther
MAX_RADIAL_SPEED = 100.0  # m/s, over ground; no target that a tracker is told of is faster
REBASE_AFTER, AGREE = 3, 2  # scans
AHEAD_SCANS, AHEAD_S = 10, 30.0
OFFSET_SCANS = 4  # a plot's time lies in its revolution; slow radars get some room
SLACK_SCANS = 1.5  # how far two clocks may differ: arrivals jitter
LONGEST_S = 600.0  # silence that own ship's stamps alone can tell of

# Reasons for which plots and scans are rejected: the names of the counters.
NOT_FINITE = 'plots not finite'
BAD_RANGE = 'plots with range not positive'
TOO_FAR = 'plots beyond 500 km'
BAD_BEARING = 'plots with bearing out of range'
BAD_OFFSET = 'plots with time out of the scan'
TOO_MANY = 'plots over max_plots'
BAD_COVARIANCE = 'plots with a wrong covariance'
SPEED_NOT_FINITE = 'radial speeds not finite'
SPEED_TOO_HIGH = 'radial speeds above 100 m/s'
PLOT_REASONS = (
    NOT_FINITE,
    BAD_RANGE,
    TOO_FAR,
    BAD_BEARING,
    BAD_OFFSET,
    TOO_MANY,
    BAD_COVARIANCE,
    SPEED_NOT_FINITE,
    SPEED_TOO_HIGH,
)

REPEATED = 'scans repeated'
WENT_BACK = 'scans with time going back'
JUMPED_AHEAD = 'scans with time jumping ahead'
REBASED = 'clock re-based'
CLOCKS_DIFFER = 'scans with a time far from other radars'
SCAN_REASONS = (REPEATED, WENT_BACK, JUMPED_AHEAD, REBASED, CLOCKS_DIFFER)


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
            (BAD_COVARIANCE, _covariance_good(plots)),
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


def _covariance_good(plots: PolarPlots) -> BoolArray:
    """[M] whether each plot's covariance is one; True where plots have none."""
    if plots.covariance is None:
        return np.ones(len(plots.range), bool)
    xx, xy, yy = plots.covariance[:, [0, 0, 1], [0, 1, 1]].T
    good: BoolArray = (xx > 0) & (yy > 0) & (xx * yy > xy * xy) & np.isfinite(xx + yy)
    return good


class TimeOrder(NamedTuple):
    """What the time of the next scan is judged by.

    last     s, start of the last scan taken; nan before the first
    shift    s, the tracker's time minus the sender's
    waiting  (start, arrival) s of the scans rejected since, in the order they came
    beat     of the scans taken
    own      s, own ship's newest stamp when the last scan was taken; nan: none
    """

    last: float = np.nan
    shift: float = 0.0
    waiting: tuple[tuple[float, float], ...] = ()
    beat: Beat = Beat()
    own: float = np.nan


def admit_scan(
    order: TimeOrder,
    start: float,
    scan_period: float,
    others: Sequence[TimeOrder] = (),
    arrival: float = np.nan,
    own: float = np.nan,
) -> tuple[TimeOrder, bool, str]:
    """Whether a scan that begins at `start` is to be taken, and the reason to count or ''.

    others   the orders of the other radars
    arrival  s, when it came, by a clock of ours; nan where there is none
    own      s, own ship's newest stamp, on whatever clock; nan: none
    """
    new = math.isnan(order.last)
    ahead, slack = max(AHEAD_S, AHEAD_SCANS * scan_period), SLACK_SCANS * scan_period
    others = [other for other in others if not math.isnan(other.last)]
    for shift in dict.fromkeys((order.shift, *(other.shift for other in others))):
        after = start + shift - (order.last + order.shift)  # nan for a new radar
        beside = any(
            _beside(other, start + shift, ahead, slack + other.beat.waited(arrival))
            for other in others
        )
        if new:
            fits = beside or not others
        else:
            silent = shift == order.shift and _silence(order, after, ahead, slack, arrival, own)
            fits = after > 0 and (after <= slack or beside or silent)
        if fits:
            beat = order.beat if shift == order.shift else Beat()
            taken = TimeOrder(start, shift, (), beat.then(start, arrival), own)
            return taken, True, '' if new or shift == order.shift else REBASED
    if new:
        return order, False, CLOCKS_DIFFER
    waiting = order.waiting
    follows = waiting and waiting[-1][0] < start <= waiting[-1][0] + ahead
    waiting = (*waiting, (start, arrival)) if follows else ((start, arrival),)
    after = start - order.last
    if len(waiting) == AGREE and 0 < after <= ahead and not order.beat.in_time:
        return TimeOrder(start, order.shift, (), Beat((start,), (arrival,)), own), True, ''
    if len(waiting) >= REBASE_AFTER:
        # The tracker's time of waiting[0]: as much later as passed meanwhile.
        passed = order.beat.waited(waiting[0][1]) if order.beat.in_time else scan_period
        shift = order.shift + order.last + max(passed, scan_period) - waiting[0][0]
        return TimeOrder(start, shift, (), Beat((start,), (arrival,)), own), True, REBASED
    reason = REPEATED if after == 0 else WENT_BACK if after < 0 else JUMPED_AHEAD
    return order._replace(waiting=waiting), False, reason


def _silence(
    order: TimeOrder, after: float, ahead: float, slack: float, arrival: float, own: float
) -> bool:
    """Whether the clocks that there are tell of `after` s without scans."""
    waited = order.beat.waited(arrival)
    if math.isnan(waited):
        return after <= ahead
    if after <= waited + slack or order.beat.in_time:
        return after <= waited + slack
    return after <= min(own - order.own + slack, LONGEST_S)  # False with nan


def _beside(other: TimeOrder, time: float, ahead: float, room: float) -> bool:
    """Whether a scan at the tracker's `time` agrees with another radar, whose next may be `room` s
    after its last; nan: not known."""
    after = time - (other.last + other.shift)
    return -ahead <= after <= (ahead if math.isnan(room) else room)
