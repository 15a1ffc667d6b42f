"""The alarms of the ARPA: their causes, and the values for their texts.

alerts.py has the states of an alert. These are the kinds and their causes:

    danger           CPA and TCPA of a target are below the limits, or probably so
                     (situation.danger). It is raised only in a scan with a plot of the target,
                     because a track that clutter began gets no more plots. After an
                     acknowledgement: see encounters.py
    lost target      its track ended because plots were missing. Not if the target moved out of
                     range, was merged, was cancelled, was in an exclusion zone, or was acquired
                     only a short time before
    new target       a confirmed track is in a guard zone, whether it entered or was first seen
                     there, and whether it is a target already or not; one alert for each zone
    near capacity    NEARLY_FULL of the largest number of targets
    capacity         the largest number of targets
    heading, position, plots, log missing    not received for too long; plots of each radar;
                     the log if it is to be used
    fallback         at least a share of the confirmed targets have fallen back from their filter
    swap risk        the gate of a target overlaps that of another track, or the two have probably
                     exchanged their targets when they met
    own speed        what is told of own ship's velocity is not the way that her positions make
    stationary danger    own ship will pass stationary objects (stationary.py) within the limits;
                     one alert for all of them
    AIS danger       as danger, of a ship of AIS that is not joined to a target
    AIS lost         an activated or joined ship of AIS is silent for too long
    AIS mismatch     a target and its ship of AIS have come apart: one of them is wrong
    AIS number twice two ships send one number
    AIS-SART         a distress beacon is heard, wherever it is; a test of one is a caution
    AIS capacity     nearly as many ships of AIS as may be
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..tracking.lifecycle import CONFIRMED, LOST, STATIONARY
from ..types import Array, CodeArray, IntArray, row_of, take
from . import alerts as machine
from . import encounters, sounding
from .acquisition import Acquisition, how_acquired
from .alarm_causes import causes_of, of_tracks, single
from .alerts import KEEP, OFF, ON, Alerts, Causes, Rule
from .situation import Limits, Situation
from .targets import LOST_FROM_SIGHT, Events
from .zones import Zones

NAMES = (
    'danger',
    'lost target',
    'new target',
    'near capacity',
    'capacity',
    'heading missing',
    'position missing',
    'plots missing',
    'fallback',
    'swap risk',
    'own speed doubtful',
    'log missing',
    'stationary danger',
    'AIS danger',
    'AIS lost',
    'AIS mismatch',
    'AIS number twice',
    'AIS-SART',
    'AIS-SART test',
    'AIS capacity',
)
(
    DANGER,
    LOST_TARGET,
    NEW_TARGET,
    NEAR_CAPACITY,
    CAPACITY,
    HEADING_MISSING,
    POSITION_MISSING,
    PLOTS_MISSING,
    FALLBACK,
    SWAP_RISK,
    OWN_SPEED,
    LOG_MISSING,
    STATIONARY_DANGER,
    AIS_DANGER,
    AIS_LOST,
    AIS_MISMATCH,
    AIS_TWICE,
    AIS_SART,
    AIS_SART_TEST,
    AIS_CAPACITY,
) = range(len(NAMES))
PRIORITY = (
    'alarm',
    'warning',
    'warning',
    'caution',
    'warning',
    'warning',
    'warning',
    'warning',
    'caution',
    'caution',
    'warning',
    'warning',
    'warning',
    'alarm',
    'warning',
    'caution',
    'caution',
    'alarm',
    'caution',
    'caution',
)
PRIORITIES = ('alarm', 'warning', 'caution')
RANK = np.array([PRIORITIES.index(priority) for priority in PRIORITY])
WARNING, CAUTION = RANK == 1, RANK == 2
MOMENTARY = np.arange(len(NAMES)) == LOST_TARGET
REMEMBERED = np.isin(np.arange(len(NAMES)), (DANGER, AIS_DANGER))
# Categories of MSC.302: A is judged by the picture, B needs none. C, beyond the bridge, are none.
OF_AIS = (AIS_DANGER, AIS_LOST, AIS_MISMATCH, AIS_TWICE, AIS_SART, AIS_SART_TEST)
BY_PICTURE = (DANGER, LOST_TARGET, NEW_TARGET, SWAP_RISK, STATIONARY_DANGER, *OF_AIS)
CATEGORY = tuple('A' if kind in BY_PICTURE else 'B' for kind in range(len(NAMES)))
IDENTIFIER = tuple(10001 + kind for kind in range(len(NAMES)))  # makers' own begin at 10000
NEARLY_FULL = 0.9  # share of the capacity
APART = 1.44  # overlap of gates (see swap_risk) that ends a swap risk
SWAPPED = 0.05  # probability that two tracks have exchanged their targets, from which it is told


Named = tuple[int, int, Causes]  # the kind of alert, its zone or radar, and its causes


class AlarmSettings(NamedTuple):
    """How alarms behave.

    danger_after    s, how long a danger must show before it raises
    end_after       s, how long any cause must be gone before its alert ends
    lapse_after     s, after which an alert without a cause lapses that nobody acknowledged
    sensor_timeout  s without heading, position or plots
    fallback_share  of the confirmed targets
    limits          of danger
    """

    danger_after: float = 5.0
    end_after: float = 15.0
    lapse_after: float = 1800.0
    sensor_timeout: float = 10.0
    fallback_share: float = 0.5
    limits: Limits = Limits()


class Tracking(NamedTuple):
    """The state of the tracking in a scan.

    capacity  largest number of targets
    fallen    confirmed targets that have fallen back from their filter
    overlap   [N]  of the gates and
    other     [N]  row of the track they overlap with, as swap_risk gives them
    swapped   [N]  probability that they have exchanged their target with another track and
    rival     [N]  row of that track, as tracking.meetings tells them
    in_the_way  of stationary objects, as Stationary.way tells it
    nearly    stationary objects are nearly dangerous
    """

    capacity: int
    fallen: int
    overlap: Array
    other: IntArray
    swapped: Array
    rival: IntArray
    in_the_way: tuple[float, ...] = (0.0, np.nan, np.nan, np.nan, np.nan)
    nearly: bool = False


class Silence(NamedTuple):
    """Time, s, since each was last received; inf for never. plots: of each radar.

    speed_off  m/s, how far own ship's velocity as told is off that of her positions; 0: they agree
    log        s; 0 where it is not asked for
    bow_only   whether bearings are told relative to the bow only, for want of the heading
    """

    heading: float
    position: float
    plots: tuple[float, ...]
    speed_off: float = 0.0
    log: float = 0.0
    bow_only: bool = False


def step(
    alerts: Alerts,
    settings: AlarmSettings,
    situation: Situation,
    acquisition: Acquisition,
    events: Events,
    zones: Zones,
    tracking: Tracking,
    now: float,
) -> tuple[Alerts, Alerts]:
    """The alerts after a scan, and those that changed; now s.

    acquisition and its events are those of the same scan. The sensors have a step of their own.
    """
    target = how_acquired(acquisition, situation.id) >= 0
    numbered = (target & (situation.number > 0)).nonzero()[0]
    confirmed = int((target & (situation.status == CONFIRMED)).sum())
    alerts = encounters.marked(alerts, alerts.kind == DANGER, situation, settings.limits, now)
    plotted = np.isin(situation.status, (CONFIRMED, STATIONARY))
    danger = np.minimum(situation.danger, np.where(plotted, ON, KEEP))
    danger = encounters.level(
        danger, alerts, alerts.kind == DANGER, situation, settings.limits, now
    )
    lost = row_of(situation.id, events.id[events.kind == LOST_FROM_SIGHT])
    count, capacity, fallen = len(acquisition.targets.id), tracking.capacity, tracking.fallen
    swap, partner = _swaps(situation, tracking)
    causes = [
        (
            DANGER,
            0,
            of_tracks(
                situation, numbered, danger, situation.cpa, situation.tcpa, situation.probability
            ),
        ),
        (LOST_TARGET, 0, of_tracks(situation, lost, np.full(len(situation.id), ON))),
        (NEAR_CAPACITY, 0, single(count, np.ceil(NEARLY_FULL * capacity), count, capacity)),
        (CAPACITY, 0, single(count, capacity, count, capacity, acquisition.waiting)),
        (
            FALLBACK,
            0,
            single(fallen, max(settings.fallback_share * confirmed, 1), fallen, confirmed),
        ),
        (SWAP_RISK, 0, of_tracks(situation, numbered, swap, partner.astype(float))),
        (
            STATIONARY_DANGER,
            0,
            causes_of(tracking.in_the_way[0] > 0, *tracking.in_the_way, keep=tracking.nearly),
        ),
        *_in_guard_zones(alerts, situation, acquisition, zones),
    ]
    return advance(alerts, causes, settings, now)


def _swaps(situation: Situation, tracking: Tracking) -> tuple[CodeArray, IntArray]:
    """Whether each track [N] may be swapped, and the number [N] of the other one, 0 for none."""
    meet, doubted = tracking.overlap < 1, tracking.swapped >= SWAPPED
    level = np.where(meet | doubted, ON, np.where(tracking.overlap < APART, KEEP, OFF))
    other = np.where(doubted & ~meet, tracking.rival, tracking.other)
    return level.astype(np.int8), np.append(situation.number, 0)[other]


def watch(
    alerts: Alerts, settings: AlarmSettings, silence: Silence, now: float
) -> tuple[Alerts, Alerts]:
    """The alerts after a look at the sensors, and those that changed: to be called by the clock.

    Where plots are missing there is no scan to call `step`. now s, of the same time as scans'.
    """
    sensors = [
        (HEADING_MISSING, 0, silence.heading),
        (POSITION_MISSING, 0, silence.position),
        (LOG_MISSING, 0, silence.log),
        *((PLOTS_MISSING, radar, silent) for radar, silent in enumerate(silence.plots)),
    ]
    causes = [
        (kind, part, causes_of(silent > settings.sensor_timeout, silent, silence.bow_only))
        for kind, part, silent in sensors
    ]
    causes.append((OWN_SPEED, 0, causes_of(silence.speed_off > 0, silence.speed_off)))
    return advance(alerts, causes, settings, now)


def acknowledge(
    alerts: Alerts,
    now: float,
    kind: int | None = None,
    number: int | None = None,
    duration: float = 0.0,
    instance: int | None = None,
) -> tuple[Alerts, Alerts]:
    """The operator has seen one alert, all of a kind, all of a target, or all (alerts.py).

    duration  s, after which it must be acknowledged again; 0: not before its cause has ended
    """
    until = now + duration if duration > 0 else np.inf
    return machine.acknowledge(alerts, now, MOMENTARY, kind, number, until, REMEMBERED, instance)


def rules(settings: AlarmSettings) -> tuple[Rule, ...]:
    """How each kind behaves."""
    return tuple(
        Rule(
            settings.danger_after if kind in (DANGER, AIS_DANGER) else 0.0,
            settings.end_after,
            settings.lapse_after,
            bool(CAUTION[kind]),
            bool(MOMENTARY[kind]),
            bool(REMEMBERED[kind]),
        )
        for kind in range(len(NAMES))
    )


def advance(
    alerts: Alerts, causes: Sequence[Named], settings: AlarmSettings, now: float
) -> tuple[Alerts, Alerts]:
    """The alerts after a check of these causes, each kind and zone separately; then what the time
    brings to all."""
    by_kind, parts, changes = rules(settings), [], [machine.begin()]
    first = 1 + int(alerts.instance.max(initial=0))
    rest = np.ones(len(alerts.kind), bool)
    for kind, zone, cause in causes:
        rows = (alerts.kind == kind) & (alerts.zone == zone)
        if not rows.any() and not (cause.level == ON).any():
            continue
        rest &= ~rows
        rule = by_kind[kind]
        part, changed = machine.advance(take(alerts, rows), kind, zone, cause, rule, now, first)
        first = max(first, 1 + int(part.instance.max(initial=0)))
        parts.append(part)
        changes.append(changed)
    alerts, loud = sounding.pass_time(_join([take(alerts, rest), *parts]), WARNING, now)
    return alerts, _join([*changes, loud])


def _in_guard_zones(
    alerts: Alerts, situation: Situation, acquisition: Acquisition, zones: Zones
) -> list[Named]:
    """Causes of `new target` for each zone. A zone that no longer exists has none."""
    cancelled = acquisition.barred.id[acquisition.barred.cancelled]
    rows = (
        (situation.number > 0)
        & ~np.isin(situation.status, (LOST, STATIONARY))
        & ~situation.excluded
        & ~np.isin(situation.id, cancelled)
    ).nonzero()[0]
    guard = zones.guard.nonzero()[0]
    keys = zones.key[guard].tolist()
    gone = set(alerts.zone[alerts.kind == NEW_TARGET].tolist()) - set(keys)
    return [
        (NEW_TARGET, key, of_tracks(situation, rows, ON * situation.inside[:, zone]))
        for key, zone in zip(keys, guard)
    ] + [
        (NEW_TARGET, key, of_tracks(situation, rows[:0], situation.danger)) for key in sorted(gone)
    ]


def _join(parts: list[Alerts]) -> Alerts:
    return Alerts(*(np.concatenate(column) for column in zip(*parts)))
