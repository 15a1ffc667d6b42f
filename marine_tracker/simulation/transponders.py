"""The AIS of simulated ships: who has it, when she reports, and how wrong that is.

    ais:
      send: {share: 0.7, class_b: 0.1, latency_s: 5, dropout: 0.05,     # all have defaults
             position_sigma_m: 5, heading_sigma_deg: 1, own_mmsi: 244000000}
    targets:
      - {name: ferry, ...,
         ais: {class: a, mmsi: 244123456, silent_s: [300, 420],
               spoof: {from_s: 600, shift_m: 1000, walk_mps: 0, bearing_deg: 90}}}

Reports come at the intervals of ITU-R M.1371: class A by speed, turn and status, class B by speed;
names and sizes every six minutes. A ship's place has an error of her own that changes within
minutes. A report comes up to `latency_s` after the moment it is of, and some do not come. Spoofed
places lie aside by a shift, and walk off at a speed, from a time on; her echo stays where she is.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import m1371
from ..geometry import unit_vector, wrap_bearing
from ..types import Array, BoolArray, CodeArray, IntArray, take
from . import motion
from .fields import Section

SEND_KEYS = 'share class_b latency_s dropout position_sigma_m heading_sigma_deg own_mmsi'
TARGET_KEYS = 'class mmsi silent_s spoof'
SPOOF_KEYS = 'from_s shift_m walk_mps bearing_deg'
CLASSES = ('a', 'b', 'none')
BY_SHARE, NO_AIS = -1, -2  # of who sends what
FIRST_MMSI = 244_100_001
MEMORY = 120.0  # s of the error of a place
STATIC_EVERY = 360.0  # s
BEAM, AFT = 0.15, 0.7  # of the length: her beam; how far from the bow the antenna stands
LONGEST = 7 * 86400.0  # s, of a scenario
TURN_STEP = 5.0  # s over which a rate of turn is taken


class Target(NamedTuple):
    """One target's: its class, or BY_SHARE; mmsi 0: of its number; silent from, to s; spoofed from
    s by shift m and walk m/s towards bearing rad."""

    kind: int = BY_SHARE
    mmsi: int = 0
    silent: tuple[float, float] = (np.inf, np.inf)
    spoofed: tuple[float, float, float, float] = (np.inf, 0.0, 0.0, 0.0)


class Transponders(NamedTuple):
    """What a scenario says of AIS; see the module."""

    share: float
    class_b: float
    latency: float
    dropout: float
    position_sigma: float
    heading_sigma: float
    own_mmsi: int
    targets: tuple[Target, ...]


class Sent(NamedTuple):
    """R reports that arrived, in the order of arrival.

    heard, time  [R]  s
    ship       [R]     0 own ship, targets from 1 on
    mmsi       [R]
    kind       [R]     of m1371.KINDS
    static     [R]     names and sizes, no place
    position   [R, 2]  m, of the antenna, as told
    speed, course, heading, turn  [R]  m/s, rad, rad/s, as told
    status     [R]
    size       [R, 4]  m from the antenna to bow, stern, port and starboard
    """

    heard: Array
    time: Array
    ship: IntArray
    mmsi: IntArray
    kind: CodeArray
    static: BoolArray
    position: Array
    speed: Array
    course: Array
    heading: Array
    turn: Array
    status: CodeArray
    size: Array


def read_send(section: Section, targets: tuple[Target, ...]) -> Transponders:
    """The section `send`; ValueError names what is wrong in it."""
    return Transponders(
        section.number('share', 0.0, 1.0, 1.0),
        section.number('class_b', 0.0, 1.0, 0.0),
        section.number('latency_s', 0.0, 60.0, 0.5),
        section.number('dropout', 0.0, 1.0, 0.0),
        section.number('position_sigma_m', 0.0, 1000.0, 5.0),
        section.number('heading_sigma_deg', 0.0, 180.0, 0.5),
        int(section.number('own_mmsi', 0, m1371.MOST, 0)),
        targets,
    )


def read_target(section: Section) -> Target:
    """The section `ais` of a target; ValueError names what is wrong in it."""
    kind = section.choice('class', CLASSES, '') if 'class' in section else ''
    silent = section.items('silent_s')
    if silent and not (len(silent) == 2 and all(type(one) in (int, float) for one in silent)):
        raise ValueError(f'{section.where}.silent_s is {silent}; it must be two times, s')
    spoof = section.section('spoof', SPOOF_KEYS)
    return Target(
        BY_SHARE if not kind else (m1371.CLASS_A, m1371.CLASS_B, NO_AIS)[CLASSES.index(kind)],
        int(section.number('mmsi', 1, m1371.MOST, 0)) if 'mmsi' in section else 0,
        (float(silent[0]), float(silent[1])) if silent else Target().silent,
        (
            spoof.number('from_s', 0.0, LONGEST, np.inf),
            spoof.number('shift_m', 0.0, 1e5, 0.0),
            spoof.number('walk_mps', 0.0, 100.0, 0.0),
            float(np.radians(spoof.number('bearing_deg', -360.0, 360.0, 0.0))),
        )
        if 'spoof' in section
        else Target().spoofed,
    )


def of_vessel(name: str) -> Target:
    """That of a ship driven by AIS reports: by share, under her own number if her name is one."""
    mmsi = int(name) if name.isdecimal() and len(name) <= 9 else 0
    return Target(mmsi=mmsi)


def transmit(
    of: Transponders,
    paths: motion.Paths,
    length: Array,
    duration: float,
    seed: int,
    step: float = 1.0,
) -> Iterator[Sent]:
    """What arrives in each `step` s of the duration, in order. The same seed, the same reports.

    length  [T]  m, of the targets
    """
    rng = np.random.default_rng(np.random.SeedSequence([seed, 17]))
    ships = np.arange(1, paths.ships)
    kind, mmsi = _equipped(of, len(ships), rng)
    size = _sizes(length)
    due = rng.uniform(0.0, 10.0, len(ships))
    static_due = rng.uniform(0.0, 60.0, len(ships))
    own_due = 0.0
    error = rng.normal(0.0, of.position_sigma, (len(ships), 2))
    silent = np.array([one.silent for one in of.targets]).reshape(-1, 2)
    spoofed = np.array([one.spoofed for one in of.targets]).reshape(-1, 4)
    waiting: list[Sent] = []
    for start in np.arange(0.0, duration, step).tolist():
        end = start + step
        keep = np.exp(-step / MEMORY)
        error = keep * error + rng.normal(
            0.0, of.position_sigma * np.sqrt(1 - keep**2), error.shape
        )
        chosen = ((due < end) & (kind >= 0)).nonzero()[0]
        if len(chosen):
            said = _reports(of, paths, ships[chosen], due[chosen], kind, mmsi, size, rng)
            told = said.position + error[chosen]
            told = told + rng.normal(0.0, 0.1 * of.position_sigma, told.shape)
            since = said.time - spoofed[chosen, 0]
            off = spoofed[chosen, 1] + spoofed[chosen, 2] * np.maximum(since, 0.0)
            off[~(since >= 0)] = 0.0
            told = told + off[:, None] * unit_vector(spoofed[chosen, 3])
            said = said._replace(position=told)
            due[chosen] += m1371.interval(
                kind[chosen], said.status, said.speed, said.turn
            ) * rng.uniform(0.9, 1.1, len(chosen))
            waiting.append(_through(said, silent[chosen], paths, of, rng))
        named = ((static_due < end) & (kind >= 0)).nonzero()[0]
        if len(named):
            said = _reports(of, paths, ships[named], static_due[named], kind, mmsi, size, rng)
            said = said._replace(static=np.ones(len(named), bool))
            static_due[named] += STATIC_EVERY
            waiting.append(_through(said, silent[named], paths, of, rng))
        if of.own_mmsi and own_due < end:
            waiting.append(_own(of, paths, own_due))
            own_due += 2.0
        whole = Sent(*(np.concatenate(column) for column in zip(*waiting))) if waiting else None
        if whole is not None:
            here = whole.heard < end
            out = take(whole, here)
            yield take(out, np.argsort(out.heard, kind='stable'))
            waiting = [take(whole, ~here)]


def _equipped(of: Transponders, count: int, rng: np.random.Generator) -> tuple[CodeArray, IntArray]:
    """Kind [T], NO_AIS for none, and MMSI [T] of the targets."""
    given = np.array([one.kind for one in of.targets], np.int64)
    luck = rng.permutation(count) / max(count, 1)
    small = rng.permutation(count) / max(count, 1)
    by_share = np.where(
        luck < of.share, np.where(small < of.class_b, m1371.CLASS_B, m1371.CLASS_A), NO_AIS
    )
    kind = np.where(given == BY_SHARE, by_share, given).astype(np.int8)
    numbers = np.array([one.mmsi for one in of.targets], np.int64)
    return kind, np.where(numbers > 0, numbers, FIRST_MMSI + np.arange(count))


def _sizes(length: Array) -> Array:
    whole, beam = np.round(length), np.round(np.maximum(BEAM * length, 2.0))
    bow, port = np.round(AFT * whole), np.round(0.5 * beam)
    return np.stack([bow, whole - bow, port, beam - port], 1)


def _reports(
    of: Transponders,
    paths: motion.Paths,
    ship: IntArray,
    time: Array,
    kind: CodeArray,
    mmsi: IntArray,
    size: Array,
    rng: np.random.Generator,
) -> Sent:
    """What the ships [R] say at the times [R], without errors of place, not yet heard."""
    position, velocity = motion.locate_ships(paths, ship, time)
    _, before = motion.locate_ships(paths, ship, np.maximum(time - TURN_STEP, 0.0))
    speed = np.hypot(*velocity.T)
    course = np.arctan2(*velocity.T)
    turn = np.arctan2(*before.T)
    turn = (np.mod(course - turn + np.pi, 2 * np.pi) - np.pi) / TURN_STEP
    turn = np.where((speed > 0.5) & (time > TURN_STEP), turn, 0.0)
    row = ship - 1
    its, whose = size[row], kind[row]
    ahead = unit_vector(course)
    right = np.stack([ahead[:, 1], -ahead[:, 0]], -1)
    position = position - (0.5 * (its[:, 0] - its[:, 1]))[:, None] * ahead
    position = position - (0.5 * (its[:, 3] - its[:, 2]))[:, None] * right
    count = len(ship)
    heading = course + rng.normal(0.0, np.radians(of.heading_sigma), count)
    told = np.maximum(speed + rng.normal(0.0, 0.05, count), 0.0)
    course = course + rng.normal(0.0, 0.05 / np.maximum(speed, 0.5), count)
    small = whose == m1371.CLASS_B
    return Sent(
        time,
        time,
        ship,
        mmsi[row],
        whose,
        np.zeros(count, bool),
        position,
        told,
        wrap_bearing(course),
        np.where(small, np.nan, wrap_bearing(heading)),
        np.where(small, np.nan, turn),
        np.where(small, m1371.NO_STATUS, 0).astype(np.int8),
        its,
    )


def _through(
    said: Sent,
    silent: NDArray[np.float64],
    paths: motion.Paths,
    of: Transponders,
    rng: np.random.Generator,
) -> Sent:
    """Those that are heard, and when."""
    count = len(said.time)
    heard = said.time + rng.uniform(0.0, of.latency, count)
    lost = rng.random(count) < of.dropout
    lost |= (said.time >= silent[:, 0]) & (said.time < silent[:, 1])
    lost |= ~motion.exist(paths, said.ship, said.time)
    return take(said._replace(heard=heard), ~lost)


def _own(of: Transponders, paths: motion.Paths, time: float) -> Sent:
    """Own ship's own report."""
    ship, at = np.zeros(1, np.int64), np.array([time])
    position, velocity = motion.locate_ships(paths, ship, at)
    speed, course = np.hypot(*velocity.T), wrap_bearing(np.arctan2(*velocity.T))
    return Sent(
        at,
        at,
        ship,
        np.array([of.own_mmsi]),
        np.zeros(1, np.int8),
        np.zeros(1, bool),
        position,
        speed,
        course,
        course,
        np.zeros(1),
        np.zeros(1, np.int8),
        np.array([[70.0, 30.0, 8.0, 8.0]]),
    )
