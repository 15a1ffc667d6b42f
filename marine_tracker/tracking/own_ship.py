"""Screening of own ship's samples, and where she is during a scan.

Pure functions. A sample that implies more than `MAX_OWN_SPEED`, or whose stamp jumps back or
ahead (clocks.py), is rejected, until so many in a row agree with each other: `REBASE_OWN_AFTER`, or
`AGREE_AHEAD` of those that lie ahead. A velocity that is not told, or that her positions
contradict, is taken from the positions (own_velocity.py).
"""

import math
from typing import NamedTuple

import numpy as np

from ..geometry import KNOT, own_ship_at
from ..types import Array, OwnShip, append, take
from .clocks import Beat, paired
from .own_velocity import AUTO, Samples, chosen, follow, no_samples

MAX_OWN_SPEED = 100 * KNOT  # m/s
OWN_JITTER = 50.0  # m that a position may jump at any time step
REBASE_OWN_AFTER, AGREE_AHEAD = 5, 3  # samples
SLACK_S, SLACK_STEPS = 2.0, 1.5  # how far two clocks may differ: s, and usual steps
PAIR_S = 4.0  # s between the stamps of two inputs that belong to one clock
MAX_OWN_SAMPLES = 2000
MAX_COORDINATE = 1e7  # m from the origin of the local plane

# Reasons for which own-ship samples are rejected: the names of the counters.
OWN_NOT_FINITE = 'samples not finite'
OWN_REPEATED = 'samples repeated'
OWN_WENT_BACK = 'samples with time going back'
OWN_JUMPED_AHEAD = 'samples with time jumping ahead'
OWN_TELEPORTED = 'samples with impossible speed'
OWN_REBASED = 'own ship re-based'
OWN_REASONS = (
    OWN_NOT_FINITE,
    OWN_REPEATED,
    OWN_WENT_BACK,
    OWN_JUMPED_AHEAD,
    OWN_TELEPORTED,
    OWN_REBASED,
)

OWN_NEVER_HEARD = 'never heard: taken at rest at the origin'
OWN_SILENT = 'silent: taken at rest at the last known position'
OWN_BY_ARRIVAL = 'scans with stamps far from those of own ship: paired as they arrived'
OWN_RECKONED = 'silent: reckoned from the last known position'
OWN_NO_VELOCITY = 'velocity not known yet: taken at rest'


class OwnShipLog(NamedTuple):
    """What was heard of own ship.

    taken    samples taken lately, in time order
    waiting  those rejected since the last of them
    beat     of those taken
    newest   s, stamp of the last sample, taken or not; nan before it
    off      m/s, how far the velocity that is told is off that of the positions; 0: they agree
    number   of samples taken so far
    reckoned  whether the last of those taken was not heard, but reckoned
    """

    taken: Samples
    waiting: Samples
    beat: Beat = Beat()
    newest: float = math.nan
    off: float = 0.0
    number: int = 0
    reckoned: bool = False


def empty_log() -> OwnShipLog:
    """A log that has heard nothing."""
    return OwnShipLog(no_samples(), no_samples())


def admit_own_ship(
    log: OwnShipLog,
    time: float,
    position: Array,
    velocity: Array,
    arrival: float = math.nan,
    heading: float = math.nan,
) -> tuple[OwnShipLog, str]:
    """The log with the sample (position, velocity [2] m, m/s) taken; the reason to count, or ''.

    velocity  nan where it is not told
    arrival   s, when it came, by a clock of ours; nan where there is none
    heading   rad, true; nan where it is not told
    """
    numbers = (time, *position)
    finite = all(map(math.isfinite, numbers)) and not np.isinf(velocity).any()
    if not (finite and max(map(abs, position)) <= MAX_COORDINATE):
        return log, OWN_NOT_FINITE
    told = np.reshape(velocity, (1, 2)).astype(float)
    told[np.isnan(told).any(1)] = np.nan
    at = np.reshape(position, (1, 2)).astype(float)
    sample = Samples(
        np.array([float(time)]), at, told, np.full((1, 2), np.nan), np.array([heading])
    )
    log = log._replace(newest=float(time))
    reason = _against(log.taken, sample) or _ahead(log, time, arrival)
    if not reason:
        return _taken(log, log.taken, sample, arrival), ''
    fits = len(log.waiting.time) and not _against(log.waiting, sample)
    waiting, _ = follow(log.waiting if fits else no_samples(), sample, 0.0)
    enough = AGREE_AHEAD if reason == OWN_JUMPED_AHEAD else REBASE_OWN_AFTER
    if len(waiting.time) >= enough:
        log = log._replace(beat=Beat())
        return _taken(log, take(waiting, slice(-1)), take(waiting, slice(-1, None)), arrival), (
            OWN_REBASED
        )
    return log._replace(waiting=waiting), reason


def confirmed(log: OwnShipLog, end: float) -> OwnShipLog:
    """The log after a scan was taken that ends at `end` s of own ship's clock: samples that waited
    since they lie ahead, though no farther than the scan, are right."""
    waiting = log.waiting
    if not len(waiting.time) or not len(log.taken.time) or waiting.time[-1] > end + SLACK_S:
        return log
    if waiting.time[0] <= log.taken.time[-1] or _against(log.taken, take(waiting, slice(1))):
        return log
    for row in range(len(waiting.time)):
        log = _taken(log, log.taken, take(waiting, slice(row, row + 1)), math.nan)
    return log


def reckoned(
    log: OwnShipLog, end: float, arrival: float, timeout: float, velocity: Array, heading: float
) -> OwnShipLog:
    """The log moved on to `end` s, if own ship was not heard for over `timeout` s of our clock.

    velocity  [2] m/s, her way through the water; nan: not known, she goes on as she did
    heading   rad, of now

    The first step is by the velocity that she had, so nothing jumps: motion relative to her stays
    right.
    """
    waited, velocity = log.beat.waited(arrival), np.reshape(velocity, (1, 2))
    late = waited > timeout and len(log.taken.time) and end > log.taken.time[-1]
    if not late:
        return log
    last = take(log.taken, slice(-1, None))
    before = chosen(last, log.off, AUTO)[0]
    if np.isnan(velocity).any():
        velocity = before
    elif log.reckoned:
        before = velocity
    now = last.position + (end - last.time[0]) * before
    sample = Samples(np.array([end]), now, velocity, velocity, np.array([heading]))
    taken = take(append(log.taken, sample), slice(-MAX_OWN_SAMPLES, None))
    return log._replace(taken=taken, reckoned=True)


def own_ship_for(
    log: OwnShipLog, start: float, end: float, timeout: float, trust: str = AUTO, lead: float = 0.0
) -> tuple[OwnShip, str]:
    """Own ship during a revolution, and '' or the fallback that was used.

    start, end  s, of the revolution, on the clock of the samples
    timeout     s; when no sample is nearer than this to the revolution, own ship is silent
    trust       what tells her velocity: see own_velocity.chosen
    lead        s that her stamps seem to lie ahead of the plots'; beyond `timeout` s, either way,
                they are of another clock, and are moved by it

    A silent own ship is taken at rest where it was last; one never heard, at rest at the origin.
    """
    taken, fallback = log.taken, ''
    if not len(taken.time):
        return OwnShip(np.array([start]), np.zeros((1, 2)), np.zeros((1, 2))), OWN_NEVER_HEARD
    if not paired(lead, timeout)[1]:
        taken, fallback = taken._replace(time=taken.time - lead), OWN_BY_ARRIVAL
    near = _around(taken, start, end)
    if near.time[0] > end + timeout or near.time[-1] < start - timeout:
        return OwnShip(np.array([start]), near.position[-1:], np.zeros((1, 2))), OWN_SILENT
    velocity, known = chosen(near, log.off, trust)
    return OwnShip(near.time, near.position, velocity, near.heading), fallback or (
        '' if known else OWN_NO_VELOCITY
    )


def now(log: OwnShipLog, time: float, trust: str = AUTO) -> tuple[Array, Array, bool]:
    """Position and velocity [2] m, m/s of own ship at `time` s, nan if never heard; and whether the
    stamps could tell: `time` is near enough to the last sample, else that is where she is."""
    if not len(log.taken.time):
        return np.full(2, np.nan), np.full(2, np.nan), True
    last = take(log.taken, slice(-1, None))
    apart, told = paired(time - last.time[0], max(PAIR_S, SLACK_STEPS * log.beat.step))
    velocity, _ = chosen(last, log.off, trust)
    moved = own_ship_at(OwnShip(last.time, last.position, velocity), last.time[0] + apart)
    return moved[0], velocity[0], told


def _around(samples: Samples, start: float, end: float) -> Samples:
    first = max(np.searchsorted(samples.time, start, 'right') - 1, 0)
    return take(samples, slice(first, np.searchsorted(samples.time, end, 'left') + 1))


def _taken(log: OwnShipLog, before: Samples, sample: Samples, arrival: float) -> OwnShipLog:
    """The log with one more sample after those `before`."""
    taken, off = follow(before, sample, log.off)
    return OwnShipLog(
        take(taken, slice(-MAX_OWN_SAMPLES, None)),
        no_samples(),
        log.beat.then(float(sample.time[0]), arrival),
        log.newest,
        off,
        log.number + 1,
    )


def _against(earlier: Samples, sample: Samples) -> str:
    """Why the sample cannot follow the earlier ones; '' if it can."""
    if math.hypot(*sample.told[0]) > MAX_OWN_SPEED:
        return OWN_TELEPORTED
    if not len(earlier.time):
        return ''
    step = sample.time[0] - earlier.time[-1]
    if step <= 0:
        return OWN_REPEATED if step == 0 else OWN_WENT_BACK
    moved = math.hypot(*(sample.position[0] - earlier.position[-1]))
    return OWN_TELEPORTED if moved > MAX_OWN_SPEED * step + OWN_JITTER else ''


def _ahead(log: OwnShipLog, time: float, arrival: float) -> str:
    """Whether the stamp lies farther ahead than the time that we waited for it."""
    if len(log.beat.stamps) < AGREE_AHEAD:
        return ''
    room = log.beat.waited(arrival) + max(SLACK_S, SLACK_STEPS * log.beat.step)
    return OWN_JUMPED_AHEAD if time - log.taken.time[-1] > room else ''  # '' with nan
