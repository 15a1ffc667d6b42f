"""Acquisition: decides which tracks are targets.

The tracker initiates and confirms tracks by itself. This module has the operator's rules. Automatic
acquisition takes confirmed tracks everywhere, or in guard zones only, and never in exclusion zones.
A click acquires any track near it, tentative ones too. Such a target is shown at once as acquiring,
by its track's id, because it gets a number only when the tracker confirms it (targets.label).

A target ends when its track is lost or moves out of range; when the operator cancels it; when it
enters an exclusion zone, or its track turns out to be one of a crowd of places where plots always
are, unless it was acquired by hand; or when it is displaced because there are too many targets
(capacity.py). If its track is merged into another, that track becomes the target.
"""

from typing import NamedTuple

import numpy as np

from ..tracking.lifecycle import LOST, STATIONARY
from ..types import Array, BoolArray, CodeArray, IntArray, append, row_of, take
from .capacity import make_room
from .situation import Situation
from .targets import (
    ACQUIRED,
    AUTOMATIC,
    CANCELLED,
    DISPLACED,
    EXCLUDED,
    MANUAL,
    NO_ROOM,
    NOTHING_THERE,
    Events,
    Targets,
    at_tracks,
    carry_over,
    join,
    nearest_track,
)

EVERYWHERE, ZONES, NOWHERE = WHERE = ('everywhere', 'zones', 'nowhere')
MAX_CLICKS = 20  # clicks that may be pending


class AcquisitionSettings(NamedTuple):
    """How targets are acquired.

    automatic     where tracks are acquired automatically: everywhere, zones or nowhere
    capacity      largest number of targets
    click_radius  m, largest distance of a track from a click
    click_wait    s, how long a click waits for a track to appear
    border        s, how long a target must be outside of a zone before it can enter or leave
                  again; so a target at the border is not acquired and dropped again and again
    brief         s; if a target that was acquired automatically is lost within this time, it is an
                  event but not an alarm, because most such tracks are clutter; 0: always an alarm
    """

    automatic: str = EVERYWHERE
    capacity: int = 200
    click_radius: float = 500.0
    click_wait: float = 20.0
    border: float = 20.0
    brief: float = 40.0


class Barred(NamedTuple):
    """Tracks that are not acquired automatically for now, one row each.

    id         [R]  track id
    cancelled  [R]  True: by the operator, until it enters a guard zone again; False: it was in an
                    exclusion zone, until it has left it
    last       [R]  s, when it was last inside that zone; nan: not checked yet, -inf: never
    """

    id: IntArray
    cancelled: BoolArray
    last: Array


class Clicks(NamedTuple):
    """Clicks that have no track yet: position [C, 2] m and since [C] s."""

    position: Array
    since: Array


class Acquisition(NamedTuple):
    """The memory between two scans.

    waiting  number of tracks that were not acquired in the last scan because there was no room
    """

    targets: Targets
    barred: Barred
    clicks: Clicks
    waiting: int


def begin() -> Acquisition:
    """No targets yet."""
    ids, times = np.zeros(0, np.int64), np.zeros(0)
    return Acquisition(
        Targets(ids, ids, np.zeros(0, np.int8), times),
        Barred(ids, np.zeros(0, bool), times),
        Clicks(np.zeros((0, 2)), times),
        0,
    )


def acquire(state: Acquisition, position: Array, now: float) -> Acquisition:
    """The operator's click at position [2] m. The next `step` finds its track.

    ValueError if the position is not finite, or if MAX_CLICKS are pending already.
    """
    position = np.asarray(position, float)
    if position.shape != (2,) or not np.isfinite(position).all():
        raise ValueError(f'the position to acquire is {position}; it must be two finite numbers')
    if len(state.clicks.since) >= MAX_CLICKS:
        raise ValueError(f'{MAX_CLICKS} clicks are waiting for a track already')
    return state._replace(clicks=append(state.clicks, Clicks(position[None], np.array([now]))))


def cancel(state: Acquisition, number: int) -> tuple[Acquisition, Events]:
    """Ends a target. ValueError if there is no target with that number.

    It is acquired automatically again only if it enters a guard zone again. A click acquires it
    too.
    """
    row = (state.targets.number == number).nonzero()[0]
    if number <= 0 or not len(row):
        raise ValueError(f'there is no target {number} to cancel')
    return _cancel(state, row)


def cancel_all(state: Acquisition) -> tuple[Acquisition, Events]:
    """Ends all targets, including those being acquired, and all waiting clicks."""
    nothing = state._replace(clicks=begin().clicks, waiting=0)
    return _cancel(nothing, np.arange(len(state.targets.id)))


def how_acquired(state: Acquisition, ids: IntArray) -> CodeArray:
    """AUTOMATIC or MANUAL [N] for the tracks that are targets, -1 for the others."""
    row = row_of(state.targets.id, ids)
    return np.where(row >= 0, np.append(state.targets.acquired, 0)[row], -1).astype(np.int8)


def step(
    state: Acquisition, settings: AcquisitionSettings, situation: Situation, now: float
) -> tuple[Acquisition, Events]:
    """Processes one scan; now s. Afterwards all targets are live tracks of the situation.

    ValueError if the settings do not say where targets are acquired.
    """
    if settings.automatic not in WHERE:
        raise ValueError(
            f'automatic acquisition is {settings.automatic!r}; it must be one of {", ".join(WHERE)}'
        )
    how, since, events = carry_over(
        state.targets, situation, settings.click_radius, settings.brief, now
    )
    how[(how == AUTOMATIC) & (situation.status == STATIONARY)] = -1
    before = how >= 0
    barred = _bar(state.barred, settings, situation, events, now)

    clicks, clicked, lapsed = _answer_clicks(state.clicks, settings, situation, how, now)
    how[clicked] = MANUAL
    candidate = (how < 0) & ~np.isin(situation.status, (LOST, STATIONARY))
    candidate &= (situation.number > 0) & ~situation.excluded
    if settings.automatic != EVERYWHERE:
        candidate &= situation.guarded & (settings.automatic == ZONES)
    candidate[row_of(situation.id, barred.id)] = False
    taken, dropped, refused = make_room(
        settings.capacity, situation, how, candidate, clicked[~before[clicked]]
    )
    how[taken] = AUTOMATIC
    how[np.concatenate([dropped, refused])] = -1

    rows = (how >= 0).nonzero()[0]
    begun = np.union1d(rows[~before[rows]], clicked[how[clicked] >= 0])
    targets = Targets(situation.id[rows], situation.number[rows], how[rows], since[rows])
    return Acquisition(
        targets,
        take(barred, row_of(targets.id, barred.id) < 0),
        clicks,
        int(candidate.sum()) - len(taken) + len(dropped),
    ), join(
        events,
        at_tracks(ACQUIRED, situation, begun),
        at_tracks(DISPLACED, situation, dropped),
        at_tracks(NO_ROOM, situation, refused),
        Events(
            np.full(len(lapsed), NOTHING_THERE, np.int8),
            np.zeros(len(lapsed), np.int64),
            np.zeros(len(lapsed), np.int64),
            lapsed,
        ),
    )


def _bar(
    barred: Barred, settings: AcquisitionSettings, situation: Situation, events: Events, now: float
) -> Barred:
    """Who stays barred, and those that dropped out of the targets in an exclusion zone."""
    row = row_of(situation.id, barred.id)
    here = row >= 0
    here[here] = situation.status[row[here]] != LOST
    barred, row = take(barred, here), row[here]
    within = np.where(barred.cancelled, situation.guarded[row], situation.excluded[row])
    last = np.where(np.isnan(barred.last), np.where(within, now, -np.inf), barred.last)
    free = (within == barred.cancelled) & (now - last > settings.border)
    stay = take(barred._replace(last=np.where(within, now, last)), ~free)
    new = events.id[events.kind == EXCLUDED]
    new = new[situation.status[row_of(situation.id, new)] != LOST]
    return append(stay, Barred(new, np.zeros(len(new), bool), np.full(len(new), now)))


def _answer_clicks(
    clicks: Clicks, settings: AcquisitionSettings, situation: Situation, how: CodeArray, now: float
) -> tuple[Clicks, IntArray, Array]:
    """Clicks that still wait, rows of the tracks clicked, and positions of clicks that lapse.

    A click takes the nearest track that is not a target yet. If there are only targets, the nearest
    one becomes acquired by hand.
    """
    free, clicked, wait = (how < 0) & (situation.status != LOST), [], []
    targets = how >= 0
    for position in clicks.position:
        row = nearest_track(situation, position, free, settings.click_radius)
        if row < 0:
            row = nearest_track(situation, position, targets, settings.click_radius)
        wait.append(row < 0)
        if row >= 0:
            free[row] = False
            clicked.append(row)
    waiting = np.array(wait, bool)
    lapse = waiting & (now - clicks.since > settings.click_wait)
    return (
        take(clicks, waiting & ~lapse),
        np.array(list(dict.fromkeys(clicked)), np.int64),
        clicks.position[lapse],
    )


def _cancel(state: Acquisition, rows: IntArray) -> tuple[Acquisition, Events]:
    chosen = take(state.targets, rows)
    count = len(chosen.id)
    stay = np.ones(len(state.targets.id), bool)
    stay[rows] = False
    barred = append(state.barred, Barred(chosen.id, np.ones(count, bool), np.full(count, np.nan)))
    return state._replace(targets=take(state.targets, stay), barred=barred), Events(
        np.full(count, CANCELLED, np.int8), chosen.id, chosen.number, np.full((count, 2), np.nan)
    )
