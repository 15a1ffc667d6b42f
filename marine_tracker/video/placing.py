"""Spokes as they come, screened and placed: each at its own bearing and scale.

Bad spokes are left out and counted by name; the good ones beside them are kept. Nothing is made up
where spokes are missing.
"""

from collections import Counter
from typing import NamedTuple

import numpy as np

from ..geometry import wrap_angle, wrap_bearing
from ..types import Array, BoolArray, OwnShip, Spokes, Sweep, take
from . import headings

LONGEST_RANGE = 200_000.0  # m
MOST_SAMPLES = 16_384
MOST_SPOKES = 16_384  # at once
MOST_CHANGES = 4  # changes of the range among 64 spokes; more is a header misread
TURNED_S = 0.4  # s without a spoke; the beam may be anywhere after it
BACKWARD = np.radians(20.0)  # a beam that comes back by less has not turned once

NO_SPOKES = 'sweeps without spokes or samples'
TOO_LARGE = f'sweeps of more than {MOST_SPOKES} spokes or {MOST_SAMPLES} samples'
BAD_TIME = 'spokes with a wrong time'
BAD_ANGLE = 'spokes with a wrong angle'
BAD_RANGE = 'spokes with a wrong range'
CHANGING = 'spokes whose range changes too often'
DOUBLED = 'spokes doubled'
BACK = 'spokes out of order'
MISSING = 'spokes missing'
JUMPED = 'spokes whose heading jumps'
NO_HEADING = 'spokes without a heading'
REASONS = (
    NO_SPOKES,
    TOO_LARGE,
    BAD_TIME,
    BAD_ANGLE,
    BAD_RANGE,
    CHANGING,
    DOUBLED,
    BACK,
    MISSING,
    JUMPED,
    NO_HEADING,
)


class Placing(NamedTuple):
    """What is known from the spokes before: the last time and angle, the usual step of the angle
    (rad, nan: not known yet), the headings told."""

    time: float
    angle: float
    spacing: float
    headings: headings.Log


def start() -> Placing:
    """No spokes yet."""
    return Placing(-np.inf, np.nan, np.nan, headings.start())


def place(known: Placing, sweep: Sweep, own_ship: OwnShip) -> tuple[Placing, Spokes, Counter[str]]:
    """The good spokes at true bearings, and how many were left out or are missing, by reason.

    A spoke's heading is the one told with it, else own ship's; without either it has no bearing.
    """
    counts: Counter[str] = Counter()
    spokes, samples = sweep.strength.shape
    if not spokes or not samples:
        counts[NO_SPOKES] += 1
    elif spokes > MOST_SPOKES or samples > MOST_SAMPLES:
        counts[TOO_LARGE] += 1
    if counts:
        return known, _placed(take(sweep, slice(0, 0)), np.empty(0), own_ship), counts
    sweep = _readable(sweep, counts)
    known, sweep = _in_order(known, sweep, counts)
    log, heading, jumped = headings.follow(known.headings, sweep.time, sweep.heading)
    by_own = np.isnan(heading) & ~jumped
    if by_own.any():
        heading = np.where(by_own, headings.of_own_ship(own_ship, sweep.time), heading)
    counts[JUMPED] += int(jumped.sum())
    counts[NO_HEADING] += int((np.isnan(heading) & ~jumped).sum())
    return known._replace(headings=log), _placed(sweep, heading, own_ship), +counts


def _placed(sweep: Sweep, heading: Array, own_ship: OwnShip) -> Spokes:
    step = sweep.range / max(sweep.strength.shape[1], 1)
    bearing = wrap_bearing(sweep.angle + heading)
    return Spokes(sweep.time, bearing, step, sweep.strength, own_ship)


def _readable(sweep: Sweep, counts: Counter[str]) -> Sweep:
    """The spokes whose numbers make sense."""
    with np.errstate(invalid='ignore'):
        tests = (
            (BAD_TIME, np.isfinite(sweep.time)),
            (BAD_ANGLE, np.abs(sweep.angle) <= 4 * np.pi),
            (BAD_RANGE, (sweep.range > 0) & (sweep.range <= LONGEST_RANGE)),
        )
    good = np.ones(len(sweep.time), bool)
    for reason, passed in tests:
        counts[reason] += int((good & ~passed).sum())
        good &= passed
    sweep = take(sweep, good) if not good.all() else sweep
    changes = int((np.diff(sweep.range) != 0).sum())
    if changes > MOST_CHANGES * (1 + len(sweep.range) // 64):
        # A header misread gives a new range nearly every spoke. The one that most have may be true.
        values, count = np.unique(sweep.range, return_counts=True)
        usual = values[count.argmax()] if count.max() > len(sweep.range) / 2 else np.nan
        counts[CHANGING] += int((sweep.range != usual).sum())
        sweep = take(sweep, sweep.range == usual)
    return sweep


def _in_order(known: Placing, sweep: Sweep, counts: Counter[str]) -> tuple[Placing, Sweep]:
    """The spokes that go forward in angle and time."""
    if not len(sweep.time):
        return known, sweep
    late = sweep.time < np.maximum.accumulate(np.append(known.time, sweep.time)[:-1])
    if late.all() and sweep.time[-1] < known.time - 10.0:
        late[:] = False  # a clock set back: begin again
        known = known._replace(time=-np.inf, angle=np.nan, headings=headings.start())
        late = sweep.time < np.maximum.accumulate(np.append(-np.inf, sweep.time)[:-1])
    counts[BACK] += int(late.sum())
    sweep = take(sweep, ~late) if late.any() else sweep
    if not len(sweep.time):
        return known, sweep
    spacing = known.spacing
    turn = wrap_angle(np.diff(sweep.angle))
    forward = turn[turn > 0]
    if len(forward) >= 8:
        spacing = float(np.median(forward))
    keep = _forward(sweep, known, spacing, counts)
    sweep = take(sweep, keep) if not keep.all() else sweep
    if not len(sweep.time):
        return known, sweep
    steps = wrap_angle(np.diff(sweep.angle, prepend=known.angle)) if np.isfinite(spacing) else turn
    steps = np.where(steps < 0, steps + 2 * np.pi, steps)
    wide = steps[np.isfinite(steps) & (steps > 1.5 * spacing)]
    counts[MISSING] += int(np.rint(wide / spacing - 1).sum()) if len(wide) else 0
    last = known._replace(time=float(sweep.time[-1]), angle=float(sweep.angle[-1]), spacing=spacing)
    return last, sweep


def _forward(sweep: Sweep, known: Placing, spacing: float, counts: Counter[str]) -> BoolArray:
    """Which spokes lie ahead of all that came before them in the turn."""
    angle, before = sweep.angle, known.angle
    steps = wrap_angle(np.diff(angle, prepend=before))
    steps[np.isnan(steps)] = spacing if np.isfinite(spacing) else 1e-3
    small = 0.25 * spacing if np.isfinite(spacing) else 1e-9
    keep = np.ones(len(angle), bool)
    if (steps > small).all():
        return keep
    front = before if np.isfinite(before) else angle[0] - 1e-3
    since = known.time
    for k in range(len(angle)):
        step = float(wrap_angle(np.float64(angle[k] - front)))
        now = float(sweep.time[k])
        if now - since > TURNED_S:
            front, since = angle[k], now
        elif abs(step) <= small:
            counts[DOUBLED] += 1
            keep[k] = False
        elif -BACKWARD < step < 0:
            counts[BACK] += 1
            keep[k] = False
        else:
            front, since = angle[k], now
    return keep
