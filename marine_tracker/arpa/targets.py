"""Targets: the tracks that were acquired, how they end, and the events about them."""

from typing import NamedTuple

import numpy as np

from ..tracking.lifecycle import LOST, MERGED, OUT_OF_RANGE
from ..types import Array, BoolArray, CodeArray, IntArray, row_of, take
from .situation import Situation

AUTOMATIC, MANUAL = range(2)
LETTERS = ('A', 'M')  # as TTM has them
EVENTS = (
    'acquired',
    'lost',
    'lost at once',
    'left by range',
    'merged into another track',
    'never confirmed',
    'entered an exclusion zone',
    'gave way to a nearer target',
    'cancelled',
    'no track there',
    'no room',
    'track gone',
)
(
    ACQUIRED,
    LOST_FROM_SIGHT,
    LOST_AT_ONCE,
    LEFT,
    MERGED_AWAY,
    UNCONFIRMED,
    EXCLUDED,
    DISPLACED,
    CANCELLED,
    NOTHING_THERE,
    NO_ROOM,
    GONE,
) = range(len(EVENTS))


class Targets(NamedTuple):
    """The targets, one row each: track id, number (0 while acquiring), AUTOMATIC or MANUAL, s."""

    id: IntArray
    number: IntArray
    acquired: CodeArray
    since: Array


class Events(NamedTuple):
    """What happened, one row each.

    kind      [E]     index into EVENTS
    id        [E]     of the track, 0 for none
    number    [E]     of the target, 0 for none
    position  [E, 2]  m: of the track, or of the click; nan if unknown
    """

    kind: CodeArray
    id: IntArray
    number: IntArray
    position: Array


def label(ids: IntArray, number: IntArray) -> list[str]:
    """TT07 for a target with a number; Q and the track's id, as Q123, for one without; AIS and the
    MMSI for a ship of AIS, whose id is below 0."""
    return [
        f'AIS {n:09d}' if i < 0 else f'TT{n:02d}' if n else f'Q{i}'
        for i, n in zip(ids.tolist(), number.tolist())
    ]


def carry_over(
    targets: Targets, situation: Situation, radius: float, brief: float, now: float
) -> tuple[CodeArray, Array, Events]:
    """The targets that continue: how [N] acquired (-1: not a target), since [N] s; and the events.

    radius, brief  acquisition.AcquisitionSettings.click_radius and .brief
    """
    row = row_of(situation.id, targets.id)
    gone, held, row = take(targets, row < 0), take(targets, row >= 0), row[row >= 0]
    how, since = np.full(len(situation.id), -1, np.int8), np.full(len(situation.id), now)
    how[row], since[row] = held.acquired, held.since
    target, over = how >= 0, situation.status == LOST
    # The first reason that applies is used: a target lost in an exclusion zone raises no alarm.
    ends = {
        MERGED_AWAY: over & (situation.reason == MERGED),
        UNCONFIRMED: over & (situation.number == 0),
        EXCLUDED: situation.excluded & (over | (how == AUTOMATIC)),
        LEFT: over & (situation.reason == OUT_OF_RANGE),
        LOST_AT_ONCE: over & (how == AUTOMATIC) & (now - since < brief),
        LOST_FROM_SIGHT: over,
    }
    kind = np.select(list(ends.values()), list(ends), -1)
    heirs = _heirs(situation, target & (kind == MERGED_AWAY), radius)
    for merged, heir in heirs:
        how[heir] = max(how[heir], how[merged])
        since[heir] = min(since[heir], since[merged])
    how[kind >= 0] = -1
    events = [at_tracks(end, situation, (target & (kind == end)).nonzero()[0]) for end in ends]
    return (
        how,
        since,
        join(
            *events,
            Events(
                np.full(len(gone.id), GONE, np.int8),
                gone.id,
                gone.number,
                np.full((len(gone.id), 2), np.nan),
            ),
        ),
    )


def _heirs(situation: Situation, merged: BoolArray, radius: float) -> list[tuple[int, int]]:
    """Rows (merged, heir): the nearest track continues a merged target [N].

    A confirmed track is merged into confirmed ones only.
    """
    heirs = []
    for row in merged.nonzero()[0].tolist():
        fit = situation.status != LOST
        if situation.number[row]:
            fit = fit & (situation.number > 0)
        heir = nearest_track(situation, situation.position[row], fit, radius)
        if heir >= 0:
            heirs.append((row, heir))
    return heirs


def nearest_track(situation: Situation, position: Array, fit: BoolArray, radius: float) -> int:
    """Row of the nearest fit track within the radius of a position; -1 if there is none."""
    rows = fit.nonzero()[0]
    away = np.hypot(*(situation.position[rows] - position).T)
    near = (away <= radius).nonzero()[0]
    return int(rows[near[away[near].argmin()]]) if len(near) else -1


def at_tracks(kind: int, situation: Situation, rows: IntArray) -> Events:
    """The same event of some tracks."""
    return Events(
        np.full(len(rows), kind, np.int8),
        situation.id[rows],
        situation.number[rows],
        situation.position[rows],
    )


def join(*events: Events) -> Events:
    """All of them, in order."""
    return Events(*(np.concatenate(column) for column in zip(*events)))
