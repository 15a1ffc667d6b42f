"""The life of alerts: raised, acknowledged, rectified, normal again.

States and transitions are those of bridge alert management (IEC 62923-1):

    normal                  -- cause --> active unacknowledged
    active unacknowledged   -- acknowledged --> active acknowledged, -- cause gone --> rectified
    active acknowledged     -- cause gone --> normal
    rectified               -- acknowledged --> normal, -- cause back --> active unacknowledged

An active unacknowledged alert may be silenced for a time (sounding.py): active silenced. In all
else that is as before.

There is hysteresis in time and in value. A cause must last for a time before it raises an alert,
and it must be gone for a time before the alert ends. Between the level that raises and the level
that ends there is a middle level: it does neither, and it does not interrupt either.

An acknowledgement may have a time limit. For kinds that are remembered, it lasts longer than the
alert: a cause that comes back raises the alert as acknowledged, until the cause has been clearly
gone for a time. A cause that becomes clearly worse raises the alert again. Cautions need no
acknowledgement: they are raised as acknowledged.

An alert on a momentary event (a loss) has no cause that could end. It stays active until it is
acknowledged. An alert without a cause that is never acknowledged lapses after some time. Otherwise
alerts would pile up in a tracker without an operator.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, BoolArray, CodeArray, IntArray, append, row_of, take

STATES = (
    'normal',
    'active unacknowledged',
    'active acknowledged',
    'rectified unacknowledged',
    'active silenced',
)
(NORMAL, ACTIVE_UNACKNOWLEDGED, ACTIVE_ACKNOWLEDGED, RECTIFIED_UNACKNOWLEDGED, ACTIVE_SILENCED) = (
    range(len(STATES))
)
ACTIVE = (ACTIVE_UNACKNOWLEDGED, ACTIVE_ACKNOWLEDGED, ACTIVE_SILENCED)
WAITING = (ACTIVE_UNACKNOWLEDGED, ACTIVE_SILENCED)  # active, for somebody to acknowledge
IS_ACTIVE, IS_WAITING = (np.isin(np.arange(len(STATES)), some) for some in (ACTIVE, WAITING))
VALUES = 5  # numbers that an alert has for its text
# Levels of a cause: clearly gone, gone, not enough to raise, there, worse than acknowledged.
CLEAR, OFF, KEEP, ON, WORSE = range(-1, 4)


class Alerts(NamedTuple):
    """All alerts that are not normal, and causes that have not lasted long enough; one row each.

    kind      [A]     what it is about, index of alarms.NAMES
    zone      [A]     key of the zone (zones.Zones.key), 0 for none; for missing plots the radar,
                      counted from 0
    id        [A]     of the track, 0 for none
    number    [A]     of the target, 0 for none
    state     [A]     index into STATES; a cause that must still last is here as NORMAL
    since     [A]     s, when the state began
    turn      [A]     s, since when the cause asks for a change of state; nan: it does not
    position  [A, 2]  m, of the target when the state began; nan for none
    values    [A, 5]  numbers for the text at that time; see alarms.py
    until     [A]     s, end of the acknowledgement; inf: until its cause has ended; nan: it is not
                      acknowledged, or needs no acknowledgement. In state NORMAL: a cause that comes
                      back is acknowledged already
    mark      [A, 2]  what would be clearly worse, see encounters.py; nan: not checked yet
    instance  [A]     number of the alert, from 1 on, that no other has as long as it lives
    raised    [A]     s, when it was last normal no more; nan: not yet
    seen      [A]     s, when it was last acknowledged since then; nan: not yet
    sounded   [A]     s, when it last began to sound; nan: it never did
    sounds    [A]     how often it has begun to sound
    """

    kind: CodeArray
    zone: IntArray
    id: IntArray
    number: IntArray
    state: CodeArray
    since: Array
    turn: Array
    position: Array
    values: Array
    until: Array
    mark: Array
    instance: IntArray
    raised: Array
    seen: Array
    sounded: Array
    sounds: IntArray


class Causes(NamedTuple):
    """What may raise alerts of one kind: one row a subject. A subject without a row has gone away.

    id, number  [S]     as in Alerts
    level       [S]     CLEAR, OFF, KEEP, ON or WORSE
    position    [S, 2]  m
    values      [S, 5]
    """

    id: IntArray
    number: IntArray
    level: CodeArray
    position: Array
    values: Array


class Rule(NamedTuple):
    """How a kind of alert behaves. It is raised, and it ends, after its cause lasted, or was gone,
    for a time.

    raise_after, end_after, lapse_after  s
    caution       needs no acknowledgement
    momentary     active until acknowledged
    remembered    the acknowledgement lasts longer than the alert ...
    forget_after  s, ... until the cause has been CLEAR for this time
    worse_after   s, time that the cause must be WORSE to end the acknowledgement
    """

    raise_after: float = 0.0
    end_after: float = 0.0
    lapse_after: float = 1800.0
    caution: bool = False
    momentary: bool = False
    remembered: bool = False
    forget_after: float = 60.0
    worse_after: float = 15.0


def begin() -> Alerts:
    """All normal."""
    ids, times, kinds = np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.int8)
    pairs = np.zeros((0, 2))
    return Alerts(
        kinds,
        ids,
        ids,
        ids,
        kinds,
        times,
        times,
        pairs,
        np.zeros((0, VALUES)),
        times,
        pairs,
        ids,
        times,
        times,
        times,
        ids,
    )


def advance(
    alerts: Alerts, kind: int, zone: int, causes: Causes, rule: Rule, now: float, first: int = 1
) -> tuple[Alerts, Alerts]:
    """The alerts, all of this kind and zone, after a check of their causes; and those that changed.

    New ones get the instances from `first` on. A change to NORMAL is only in the changed rows.
    """
    row = row_of(causes.id, alerts.id)
    level = np.append(causes.level, OFF)[row]  # -1, gone away: the last
    gone = row < 0
    active = IS_ACTIVE[alerts.state]
    known = ~np.isnan(alerts.until)  # acknowledged
    worse = known & (level == WORSE)
    calls = np.where(
        active,
        ((level <= OFF) & (not rule.momentary)) | worse,
        (level >= ON) | (known & (level == CLEAR)),
    )
    holds = calls | (~active & (level == KEEP))
    turn = np.where(calls & np.isnan(alerts.turn), now, np.where(holds, alerts.turn, np.nan))
    wait = np.where(level >= ON, rule.raise_after, rule.forget_after)
    wait = np.where(worse, rule.worse_after, np.where(active, rule.end_after, wait))
    due = calls & (now - turn >= np.where(gone, 0.0, wait))
    over = known & (now >= alerts.until)
    raised = ACTIVE_ACKNOWLEDGED if rule.caution else ACTIVE_UNACKNOWLEDGED
    again = np.where(known & ~worse, ACTIVE_ACKNOWLEDGED, raised)
    ended = np.where(IS_WAITING[alerts.state], RECTIFIED_UNACKNOWLEDGED, NORMAL)
    idle = (alerts.state == RECTIFIED_UNACKNOWLEDGED) | (active & rule.momentary)
    lapsed = idle & (now - alerts.since > rule.lapse_after)
    calls_again = (due & (level >= ON)) | (over & active & (level >= KEEP))
    state = np.where(lapsed, NORMAL, alerts.state)
    state = np.where(calls_again, np.where(over, raised, again), state)
    state = np.where(due & active & ~worse, ended, state).astype(np.int8)
    changed = state != alerts.state
    forgotten = (not rule.remembered) | gone | over | (due & ~active & (level == CLEAR))
    told = in_state(alerts, state, now)._replace(
        turn=np.where(changed | (due & ~active), np.nan, turn),
        until=np.where(
            np.where(state == NORMAL, forgotten, state == ACTIVE_UNACKNOWLEDGED),
            np.nan,
            alerts.until,
        ),
    )
    fresh = (changed & ~gone).nonzero()[0]
    if len(fresh):
        position, values = told.position.copy(), told.values.copy()
        position[fresh], values[fresh] = causes.position[row[fresh]], causes.values[row[fresh]]
        told = told._replace(position=position, values=values)

    new = ((causes.level >= ON) & (row_of(alerts.id, causes.id) < 0)).nonzero()[0]
    at_once = rule.raise_after <= 0
    count, unknown = len(new), np.full(len(new), np.nan)
    begun = Alerts(
        np.full(count, kind, np.int8),
        np.full(count, zone),
        causes.id[new],
        causes.number[new],
        np.full(count, NORMAL, np.int8),
        np.full(count, now),
        np.full(count, np.nan if at_once else now),
        causes.position[new],
        causes.values[new],
        unknown,
        np.full((count, 2), np.nan),
        first + np.arange(count),
        unknown,
        unknown,
        unknown,
        np.zeros(count, np.int64),
    )
    if at_once:
        begun = in_state(begun, np.full(count, raised, np.int8), now)
    everything = append(told, begun)
    return (
        take(everything, _alive(everything)),
        take(everything, np.append(changed, np.full(count, at_once))),
    )


def acknowledge(
    alerts: Alerts,
    now: float,
    momentary: BoolArray,
    kind: int | None = None,
    number: int | None = None,
    until: float = np.inf,
    remembered: BoolArray | None = None,
    instance: int | None = None,
) -> tuple[Alerts, Alerts]:
    """Acknowledges the alerts of this kind, target number, instance for the operator; None: all.

    momentary   [kinds]  kinds whose cause does not last
    until       s, when the acknowledgement ends if the cause lasts; inf: not before the cause ends
    remembered  [kinds]  kinds whose acknowledgement lasts longer than the alert (Rule); None: no
    kind

    Returns the alerts and those that changed. An alert that is acknowledged already does not
    change. But if its target is named, it is then acknowledged until `until`. ValueError if one of
    the three is given and there is no such alert.
    """
    chosen, what = alerts.state != NORMAL, []
    for name, value, column in (
        ('kind', kind, alerts.kind),
        ('target', number, alerts.number),
        ('instance', instance, alerts.instance),
    ):
        if value is not None:
            chosen &= column == value
            what.append(f'{name} {value}')
    if not chosen.any() and what:
        raise ValueError(f'there is no alert of {" and ".join(what)} to acknowledge')
    active = chosen & np.isin(alerts.state, WAITING)
    rectified = chosen & (alerts.state == RECTIFIED_UNACKNOWLEDGED)
    ends = rectified | (active & momentary[alerts.kind])
    kept = active & ~momentary[alerts.kind]
    if remembered is not None:
        kept |= rectified & remembered[alerts.kind]
    longer = chosen & ~np.isnan(alerts.until) & (number is not None)
    return _change(
        alerts._replace(
            until=np.where(kept | longer, until, alerts.until),
            mark=np.where(kept[:, None], np.nan, alerts.mark),
            seen=np.where(active | rectified, now, alerts.seen),
        ),
        np.where(ends, NORMAL, np.where(active, ACTIVE_ACKNOWLEDGED, alerts.state)),
        now,
    )


def dismiss(alerts: Alerts, ids: IntArray, now: float) -> tuple[Alerts, Alerts]:
    """All alerts of these tracks become normal, as the operator cancels them. As `acknowledge`."""
    chosen = np.isin(alerts.id, ids) & (alerts.id > 0)
    return _change(
        alerts._replace(
            turn=np.where(chosen, np.nan, alerts.turn), until=np.where(chosen, np.nan, alerts.until)
        ),
        np.where(chosen, NORMAL, alerts.state),
        now,
    )


def _change(alerts: Alerts, state: CodeArray, now: float) -> tuple[Alerts, Alerts]:
    changed = state != alerts.state
    alerts = in_state(alerts, state, now)
    return take(alerts, _alive(alerts)), take(alerts, changed)


def in_state(alerts: Alerts, state: CodeArray, now: float) -> Alerts:
    """The alerts in the states [A]; of those that change, what began at `now` s is noted."""
    changed = state != alerts.state
    begins, sounds = changed & (alerts.state == NORMAL), changed & (state == ACTIVE_UNACKNOWLEDGED)
    return alerts._replace(
        state=state.astype(np.int8),
        since=np.where(changed, now, alerts.since),
        raised=np.where(begins, now, alerts.raised),
        seen=np.where(begins, np.nan, alerts.seen),
        sounded=np.where(sounds, now, alerts.sounded),
        sounds=alerts.sounds + sounds,
    )


def _alive(alerts: Alerts) -> BoolArray:
    """Mask of the rows to keep: not normal, about to be raised, or acknowledged."""
    found: BoolArray = (alerts.state != NORMAL) | np.isfinite(alerts.turn) | ~np.isnan(alerts.until)
    return found


class Raised:
    """Which of the alerts that change are new: raised, and not raised already."""

    def __init__(self) -> None:
        self._standing: set[tuple[int, ...]] = set()  # kind, zone and id of those not normal

    def rows(self, changed: Alerts) -> list[int]:
        """The rows of the new ones among the alerts that changed in a scan."""
        new = []
        keys = zip(changed.kind.tolist(), changed.zone.tolist(), changed.id.tolist())
        for row, (key, state) in enumerate(zip(keys, changed.state.tolist())):
            if state == NORMAL:
                self._standing.discard(key)
            elif key not in self._standing:
                self._standing.add(key)
                new.append(row)
        return new
