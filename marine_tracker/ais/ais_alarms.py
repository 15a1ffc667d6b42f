"""Alarms of the ships of AIS, and what becomes of them when a ship is joined or comes apart.

A danger is told once: when a ship is joined to a target, the alert of her danger becomes that of
the target, acknowledged if it was; when the target is lost and the ship goes on, it is hers again.
"""

import numpy as np

from .. import m1371
from ..arpa import alarms, encounters
from ..arpa.alarm_causes import of_tracks, single
from ..arpa.alarms import AIS_DANGER, DANGER, Named
from ..arpa.alerts import ACTIVE_ACKNOWLEDGED, KEEP, OFF, ON, WAITING, Alerts
from ..arpa.arpa import Arpa
from ..geometry import NAUTICAL_MILE
from ..parameters import AisParameters
from ..tracking.lifecycle import LOST
from ..types import Array, BoolArray, CodeArray, IntArray, Tracks, among, row_of, take
from .join import APART_STATE, BOTH, Joined, Seen
from .pairs import JOINED, Pairs
from .passing import Passing
from .ship_table import Ships

LIKELY = 0.5
FULL = 0.95  # share of the ships that may be activated, from which on it is told


def step(
    alerts: Alerts,
    arpa: Arpa,
    p: AisParameters,
    ships: Ships,
    joined: Joined,
    passing: Passing,
    active: BoolArray,
    seen: Seen,
    now: float,
) -> tuple[Alerts, Alerts]:
    """The alerts after a look at the ships, and those that changed.

    active  [S]  activated ships;  seen  the radar's tracks
    """
    of, limits, situation = AIS_DANGER, arpa.limits, passing.seen
    alerts = _to_tracks(alerts, ships, joined, seen)
    alerts = encounters.marked(alerts, alerts.kind == of, situation, limits, now)
    danger = encounters.level(passing.danger, alerts, alerts.kind == of, situation, limits, now)
    asked = active if not p.ais_sleeping_danger else np.ones(len(active), bool)
    # Of who is probably a radar target already the danger is told as of that.
    told_of = among(-ships.id, alerts.id[alerts.kind == of])
    alone = (joined.state != BOTH) & (told_of | (joined.probability < LIKELY))
    alone &= ships.placed & ~ships.lost & asked
    near = situation.range < p.ais_lost_range_nm * NAUTICAL_MILE
    ship = ~np.isin(ships.kind, (m1371.SART, m1371.AID))
    lost = np.where(ships.lost & near, ON, np.where(ships.lost, KEEP, OFF))
    lost = np.where(ship & active & p.ais_lost_alarm, lost, OFF)
    mismatch = np.where(joined.state == APART_STATE, ON, OFF)
    beacon = (ships.kind == m1371.SART) & ~ships.lost
    distress = np.where(beacon & (ships.status != m1371.TEST), ON, OFF)
    test = np.where(beacon & (ships.status == m1371.TEST), ON, OFF)
    twice = np.where(ships.double & ~ships.lost, ON, OFF)
    off = _off(ships, joined, situation.position, seen)
    used, most = int(active.sum()), p.ais_max_activated

    def of_ships(kind: int, level: CodeArray | IntArray, *values: Array) -> Named:
        """Of the ships that have a cause, or an alert that may end."""
        rows = (level != OFF) | among(situation.id, alerts.id[alerts.kind == kind])
        return kind, 0, of_tracks(situation, rows.nonzero()[0], level, *values)

    danger = np.where(alone, danger, OFF)
    causes = [
        of_ships(of, danger, situation.cpa, situation.tcpa, situation.probability),
        of_ships(alarms.AIS_LOST, lost),
        of_ships(alarms.AIS_MISMATCH, mismatch, off),
        of_ships(alarms.AIS_TWICE, twice),
        of_ships(alarms.AIS_SART, distress),
        of_ships(alarms.AIS_SART_TEST, test),
        (alarms.AIS_CAPACITY, 0, single(used, FULL * most, used, most)),
    ]
    return alarms.advance(alerts, causes, arpa.alarms, now)


def _off(ships: Ships, joined: Joined, position: Array, seen: Seen) -> Array:
    """m [S] between where AIS says each ship is and the track that is, or was, hers; nan: none."""
    row = row_of(seen.id, joined.track)
    track = np.append(seen.position, [[np.nan, np.nan]], 0)[row]
    found: Array = np.hypot(*(position - track).T)
    return found


def _to_tracks(alerts: Alerts, ships: Ships, joined: Joined, seen: Seen) -> Alerts:
    """The alerts; those of dangers of ships that are joined are now of their tracks."""
    of_ship = (alerts.kind == AIS_DANGER).nonzero()[0]
    row = row_of(-ships.id, alerts.id[of_ship])
    of_ship, row = of_ship[row >= 0], row[row >= 0]
    both = joined.state[row] == BOTH
    if not both.any():
        return alerts
    kind, id_, number = alerts.kind.copy(), alerts.id.copy(), alerts.number.copy()
    gone: list[int] = []
    state, until = alerts.state.copy(), alerts.until.copy()
    for alert, ship in zip(of_ship[both].tolist(), row[both].tolist()):
        track = joined.track[ship]
        same = ((alerts.kind == DANGER) & (alerts.id == track)).nonzero()[0]
        if not len(same):
            kind[alert], id_[alert] = DANGER, track
            number[alert] = seen.number[row_of(seen.id, np.array([track]))[0]]
            continue
        gone.append(alert)  # told twice: one is enough, acknowledged if either is
        if not np.isnan(until[alert]) and np.isnan(until[same[0]]):
            until[same[0]] = until[alert]
            if state[same[0]] in WAITING:
                state[same[0]] = ACTIVE_ACKNOWLEDGED
    alerts = alerts._replace(kind=kind, id=id_, number=number, state=state, until=until)
    return take(alerts, np.delete(np.arange(len(kind)), gone))


def to_ships(alerts: Alerts, ships: Ships, pairs: Pairs, tracks: Tracks) -> Alerts:
    """The alerts before a scan's; those of dangers of joined tracks that were lost in it are now of
    their ships, which go on."""
    lost = np.isin(alerts.id, tracks.id[tracks.status == LOST]) & (alerts.kind == DANGER)
    if not lost.any():
        return alerts
    joined = take(pairs, pairs.state == JOINED)
    pair = row_of(joined.track, alerts.id)
    ship = np.append(row_of(ships.id, joined.ship), -1)[pair]
    hers = lost & (pair >= 0) & (ship >= 0)
    return alerts._replace(
        kind=np.where(hers, AIS_DANGER, alerts.kind).astype(np.int8),
        id=np.where(hers, -np.append(ships.id, 0)[ship], alerts.id),
        number=np.where(hers, np.append(ships.mmsi, 0)[ship], alerts.number),
    )
