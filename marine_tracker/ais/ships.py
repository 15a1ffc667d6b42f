"""Ships in time: what is known of each from her reports, and where she is at any moment.

    hear       reports come in: places, motion, names
    at         places, velocities and covariances at a time
    pass_time  who is silent for too long is lost, then forgotten

A place counts where the ship could have come to from her last one. Another place is refused at
first. A second report that agrees with it makes it the new one: then place, time and all else are
of that report. But where the ship went on reporting from her old place meanwhile, two senders use
one number: there are two rows with it, marked `double`, and neither gets a speed from the leap.

A message 27 (long range, steps of 0.1 minutes) counts only while there is no better report; it
changes no class.
"""

import numpy as np

from .. import m1371
from ..geometry import KNOT, unit_vector
from ..types import Array, BoolArray, IntArray, append, put, take
from .reports import LONG_RANGE, STATIC_ONLY, Reports
from .ship_motion import COARSE, INACCURATE, at, to_middle
from .ship_table import Ships

FORGET_AFTER = 600.0  # s after she was lost
MOST_SHIPS = 20_000
MISORDERED = 0.5  # s; a place so much older than the last one is not used

# A place is refused that is farther off than so many deviations, and a little; fastest m/s.
JUMP, HAIR, FASTEST = 5.0, 60.0, 100 * KNOT


def hear(ships: Ships, reports: Reports, position: Array, next_id: int) -> tuple[Ships, int]:
    """The ships after reports, in the order of their arrival; and the next ship's id.

    position  [R, 2]  m, of their places; nan for none
    """
    order = np.argsort(reports.heard, kind='stable')
    reports, position = take(reports, order), position[order]
    while len(reports.mmsi):
        _, first = np.unique(reports.mmsi, return_index=True)
        ships, next_id = _hear_once(ships, take(reports, first), position[first], next_id)
        rest = np.delete(np.arange(len(reports.mmsi)), first)
        reports, position = take(reports, rest), position[rest]
    return ships, next_id


def _hear_once(ships: Ships, reports: Reports, position: Array, next_id: int) -> tuple[Ships, int]:
    """As `hear`, of reports whose numbers all differ."""
    row = _row_of(ships, reports, position)
    new = row < 0
    if new.any():
        room = max(MOST_SHIPS - len(ships.id), 0)
        fresh = new.nonzero()[0][:room]
        begun = _begin(take(reports, fresh), position[fresh], next_id)
        row[fresh] = len(ships.id) + np.arange(len(fresh))
        ships, next_id = append(ships, begun), next_id + len(fresh)
        there = row >= 0
        reports, position, row = take(reports, there), position[there], row[there]
        new = new[there]
    before = take(ships, row)
    after = _identified(before, reports)
    after = after._replace(
        heard=np.maximum(before.heard, reports.heard), lost=np.zeros(len(row), bool)
    )
    told = np.isfinite(position[:, 0]) & ~new
    coarse = reports.type == LONG_RANGE
    if coarse.any():
        better = ~before.coarse & before.placed
        better &= reports.heard - before.time < before.timeout
        told &= ~(coarse & better)
    told &= ~(reports.time < before.time - MISORDERED)
    fits, agrees = _fits(before, reports, position)
    refused = told & ~fits
    placed = told & (fits | agrees)
    # While a place was refused, did she report from the old one? Then there are two of her.
    twin = refused & agrees & (before.time > before.other_time) & ~before.double
    placed &= ~twin
    after = _placed(after, reports, position, placed)
    noted = refused & ~placed & ~twin
    after = after._replace(
        other=np.where(
            noted[:, None],
            position,
            np.where(placed[:, None] & agrees[:, None] & ~fits[:, None], np.nan, after.other),
        ),
        other_time=np.where(
            noted, reports.time, np.where(placed & ~fits, np.nan, after.other_time)
        ),
        begun=np.where(placed & ~fits, reports.time, after.begun),
        jumps=after.jumps + noted,
    )
    # What has no place (a silent SART, a ship without a fix) still has status and motion.
    ships = put(ships, row, after)
    if twin.any():
        second = _begin(take(reports, twin), position[twin], next_id)
        second = second._replace(
            double=np.ones(len(second.id), bool),
            **{name: getattr(before, name)[twin] for name in ('name', 'call_sign', 'kind')},
        )
        double, other = ships.double.copy(), ships.other.copy()
        double[row[twin]], other[row[twin]] = True, np.nan
        ships = append(ships._replace(double=double, other=other), second)
        next_id += len(second.id)
    return ships, next_id


def _row_of(ships: Ships, reports: Reports, position: Array) -> IntArray:
    """Row [R] of each report's ship; of two with its number the nearer one; -1 for none."""
    order = np.argsort(ships.mmsi, kind='stable')
    sorted_ = ships.mmsi[order]
    first = np.searchsorted(sorted_, reports.mmsi)
    last = np.searchsorted(sorted_, reports.mmsi, 'right') - 1
    known = last >= first
    row = np.where(known, np.append(order, 0)[np.where(known, first, -1)], -1)
    for r in (last > first).nonzero()[0].tolist():  # rare: two senders
        rows = order[first[r] : last[r] + 1]
        if np.isfinite(position[r, 0]):
            away = np.hypot(*(ships.position[rows] - position[r]).T)
            row[r] = rows[int(np.nanargmin(np.where(np.isnan(away), np.inf, away)))]
    return row


def _begin(reports: Reports, position: Array, next_id: int) -> Ships:
    """New ships of one report each."""
    count = len(reports.mmsi)
    kind = m1371.kind_of_number(reports.mmsi)
    told = np.select(
        [np.isin(reports.type, (18, 19, 24)), reports.type == 9, reports.type == 21],
        [m1371.CLASS_B, m1371.AIRCRAFT, m1371.AID],
        m1371.CLASS_A,
    )
    nothing, flags = np.full(count, np.nan), np.zeros(count, bool)
    return Ships(
        next_id + np.arange(count),
        reports.mmsi,
        np.where(kind >= 0, kind, told).astype(np.int8),
        reports.heard,
        reports.time,
        position,
        *(reports.speed, reports.course, reports.heading, reports.turn, reports.status),
        *(reports.accurate, reports.timed, reports.type == LONG_RANGE),
        reports.name,
        reports.call_sign,
        reports.ship_type,
        reports.size,
        reports.time,
        np.full((count, 2), np.nan),
        nothing,
        np.zeros(count, np.int64),
        flags,
        flags,
    )


def _identified(ships: Ships, reports: Reports) -> Ships:
    """The ships [R] with what their reports tell of name, kind and size."""
    if not np.isin(reports.type, (5, 18, 19, 21, 24)).any() and (reports.name == '').all():
        return ships  # nothing new
    kind = np.select(
        [np.isin(reports.type, (1, 2, 3, 5)), np.isin(reports.type, (18, 19, 24))],
        [m1371.CLASS_A, m1371.CLASS_B],
        ships.kind,
    )
    kind = np.where(m1371.kind_of_number(ships.mmsi) >= 0, ships.kind, kind)
    sized = np.isfinite(reports.size[:, 1])
    return ships._replace(
        kind=kind.astype(np.int8),
        name=np.where(reports.name != '', reports.name, ships.name),
        call_sign=np.where(reports.call_sign != '', reports.call_sign, ships.call_sign),
        ship_type=np.where(reports.ship_type >= 0, reports.ship_type, ships.ship_type),
        size=np.where(sized[:, None], reports.size, ships.size),
    )


def _fits(ships: Ships, reports: Reports, position: Array) -> tuple[BoolArray, BoolArray]:
    """Masks [R]: the place can be reached from the last one; from the one refused before."""
    expected = at(ships, reports.time)
    step, _ = to_middle(ships, ships.heading)
    off = np.hypot(*(position - (expected.position - step)).T)
    spread = np.sqrt(np.trace(expected.covariance[:, :2, :2], axis1=1, axis2=2))
    rough = np.where(reports.type == LONG_RANGE, COARSE, INACCURATE)
    after = np.abs(reports.time - ships.time)
    reach = np.minimum(JUMP * np.hypot(spread, rough), 250.0 + FASTEST * after) + HAIR
    fits = ~ships.placed | (off <= reach)
    since = np.abs(reports.time - ships.other_time)
    way = np.nan_to_num(reports.speed[:, None] * unit_vector(reports.course))
    away = np.hypot(*(position - ships.other - since[:, None] * way).T)
    speed = np.where(np.isnan(reports.speed), 0.5 * FASTEST, 2.0 + 0.3 * reports.speed)
    agrees = away <= HAIR + 5 * rough + since * speed  # nan: no
    return fits, agrees


def _placed(ships: Ships, reports: Reports, position: Array, rows: BoolArray) -> Ships:
    """The ships with place and motion of the reports where the mask [R] says so. The status is
    also of a report without a place."""
    motion = ~np.isin(reports.type, STATIC_ONLY)
    moved = {
        name: np.where(rows, getattr(reports, name), getattr(ships, name))
        for name in ('time', 'speed', 'course', 'heading', 'turn', 'accurate', 'timed')
    }
    status = motion & ((reports.status >= 0) | np.isin(reports.type, (1, 2, 3)))
    status &= rows | (np.isnan(position[:, 0]) & (reports.type != LONG_RANGE))
    return ships._replace(
        position=np.where(rows[:, None], position, ships.position),
        coarse=np.where(rows, reports.type == LONG_RANGE, ships.coarse),
        status=np.where(status, reports.status, ships.status).astype(np.int8),
        **moved,
    )


def pass_time(ships: Ships, now: float, own: int = 0) -> Ships:
    """The ships at a time, s: those that are silent for too long are lost, then forgotten; so is
    own ship, whose number is `own`."""
    silent = now - ships.heard
    kept = (silent <= ships.timeout + FORGET_AFTER) & ((ships.mmsi != own) | (own == 0))
    lost = silent > ships.timeout
    # A second sender that falls silent leaves the first one alone.
    kept &= ~(ships.double & lost)
    ships = take(ships._replace(lost=lost), kept) if not kept.all() else ships._replace(lost=lost)
    if ships.double.any():
        _, which, count = np.unique(ships.mmsi, return_inverse=True, return_counts=True)
        ships = ships._replace(double=ships.double & (count[which] > 1))
    return ships
