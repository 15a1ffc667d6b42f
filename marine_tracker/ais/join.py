"""Which ship of AIS is which radar track: evidence over time, one assignment over all.

Each pair of a ship and a track that may be the same has a log-likelihood ratio: of the differences
of place and velocity if they are one, against those of any other track there. It accumulates and is
forgotten, because differences of a moment are those of the next. All pairs together are assigned
(tracking.associate); a pair that is joined has a start on others, and stays until its evidence is
gone.

A pair that was surely joined and comes apart, while ship and track both go on and neither finds
another, is a mismatch: AIS says there, radar says elsewhere. It comes apart when its evidence is
gone; or sooner, when the ship leaves the place beside her echo that she has kept so far.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..tracking.associate import associate
from ..types import Array, BoolArray, CodeArray, IntArray, row_of, take
from . import registration
from .pairs import (
    APART,
    CANDIDATE,
    JOINED,
    LEFT_FOR,
    MISMATCH,
    SURELY,
    Pairs,
    beside,
    judged,
    probability_of,
    remembered,
)
from .registration import Registration
from .ship_motion import Moving
from .ship_table import LOST_AFTER, Ships

MEMORY, INDEPENDENT = 40.0, 30.0  # s, of evidence; s after which a difference is a new one
FIRST = 0.8  # what the first look at a pair counts, once the registration is known
LOW, HIGH = -12.0, 5.0  # log-likelihood ratio of one moment
SPACE = 1500.0**2  # m^2 in which another track is to be expected
OTHERS = 4.0  # m/s, deviation of the difference of velocities of two ships that meet
MIDDLE, WAY = 8.0, 0.25  # m, m/s: echo and antenna are not the same place
LEAST, START = 3.0, 2.0  # evidence that joins; what a joined pair has before others
AGAINST = -4.0  # no evidence is remembered that is worse: who is wrong may be right again soon
NEAR, WIDE = 400.0, 3.5  # m; deviations of the registration: pairs that may be
FARTHEST = 2500.0  # m
SWAPPED = 400.0  # m; tracks of ships that meet change places no farther than this
THERE = 80.0  # m; another track so near where AIS says may be the ship
AGREE = 2.0  # deviations beside the place beside her echo, within which AIS counts in fusion
SLOW = 12.0  # s; of who reports so seldom a place that is refused counts

STATES = ('radar_only', 'ais_only', 'joined', 'mismatch')
RADAR_ONLY, AIS_ONLY, BOTH, APART_STATE = range(4)


class Seen(NamedTuple):
    """N radar tracks at a time.

    id, number  [N]        number: of the target
    position    [N, 2]     m
    velocity    [N, 2]     m/s over ground
    covariance  [N, 4, 4]
    sure        [N]        confirmed: others only say that something is there
    fresh       [N]        with a plot in the last scan
    """

    id: IntArray
    number: IntArray
    position: Array
    velocity: Array
    covariance: Array
    sure: BoolArray
    fresh: BoolArray


class Joined(NamedTuple):
    """What each of S ships is.

    state        [S]  AIS_ONLY, BOTH or APART_STATE, of STATES
    track        [S]  id of the track that is the same, or was; 0 for none
    probability  [S]  that they are the same; of a ship that is not joined of the likeliest track
    agrees       [S]  joined, and now where she is expected beside her echo
    """

    state: CodeArray
    track: IntArray
    probability: Array
    agrees: BoolArray


def alone(ships: int) -> Joined:
    """No ship is joined."""
    none = np.zeros(ships)
    return Joined(np.full(ships, AIS_ONLY, np.int8), none.astype(np.int64), none, none > 0)


def as_before(pairs: Pairs, ships: Ships) -> Joined:
    """What each ship was when radar was last heard."""
    row = row_of(ships.id, pairs.ship)
    there = (row >= 0) & ~np.append(ships.lost, True)[row]
    return _joined(take(pairs, there), row[there], len(ships.id))


def nothing_seen() -> Seen:
    """No tracks."""
    ids, no = np.zeros(0, np.int64), np.zeros(0, bool)
    pairs = np.zeros((0, 2))
    return Seen(ids, ids, pairs, pairs, np.zeros((0, 4, 4)), no, no)


def step(
    before: Pairs,
    errors: Registration,
    ships: Ships,
    moving: Moving,
    seen: Seen,
    own: Array,
    now: float,
    elapsed: float,
) -> tuple[Pairs, Registration, Joined]:
    """The pairs at the time now, s, `elapsed` s after the last; own: own ship's position [2] m.

    moving  of the ships at that time
    """
    ship, track = _candidates(before, errors, ships, moving, seen, own)
    if not errors.settled:
        errors = _searched(errors, ships, moving, seen, own, ship, track, elapsed)
        if errors.settled:  # all is looked at anew
            before = take(before, before.state != CANDIDATE)
            ship, track = _candidates(before, errors, ships, moving, seen, own)
    offset, told, differ, covariance = _differ(errors, ships, moving, seen, own, ship, track)
    ratio, distance = _ratio(differ, covariance, errors, told, moving.told[ship])
    # Of who reports seldom, the place that was refused is the newest there is.
    pending = ships.other_time > ships.time
    if pending.any():
        pending &= ships.timeout > LOST_AFTER * SLOW
    ratio = np.where(pending[ship], LOW, ratio)
    pairs = remembered(before, ships.id[ship], seen.id[track], now)
    keep = np.exp(-elapsed / MEMORY)
    ratio = np.where(seen.fresh[track] | (ratio < 0), ratio, 0.5 * ratio)
    counts = np.full(len(ship), min(elapsed / INDEPENDENT, 1.0))
    if errors.settled:
        counts[pairs.since == now] = FIRST
    evidence = keep * pairs.evidence + counts * ratio
    pairs = pairs._replace(evidence=np.maximum(evidence, AGAINST))
    pairs = beside(pairs, differ[:, :2], covariance, pending[ship], elapsed)
    chosen = _assigned(pairs, ship, track, len(ships.id), len(seen.id))
    differs = (distance > APART**2) | (pairs.left >= LEFT_FOR) | pending[ship]
    far = np.hypot(*differ[:, :2].T) > SWAPPED
    differs &= seen.fresh[track]
    maybe = differs & ~far & (pairs.state != CANDIDATE)
    differs[maybe] &= ~_something_there(moving, seen, errors, own, ship[maybe], track[maybe])
    pairs = judged(pairs, chosen, ship, track, differs, now, elapsed)
    good = (pairs.state == JOINED) & (pairs.evidence > LEAST)
    variance = _places(covariance)[good]
    errors = registration.learn(errors, offset[good], told[good], variance, elapsed)
    joined = _joined(pairs, ship, len(ships.id))
    joined.agrees[ship[good & (pairs.sure >= SURELY) & (pairs.off < AGREE)]] = True
    useful = (pairs.evidence > AGAINST) | (pairs.state != CANDIDATE)
    return take(pairs, useful), errors, joined


def _candidates(
    before: Pairs, errors: Registration, ships: Ships, moving: Moving, seen: Seen, own: Array
) -> tuple[IntArray, IntArray]:
    """Rows [P] of ships and tracks that may be the same, and of those that are remembered."""
    placed = (np.isfinite(moving.position[:, 0]) & ~ships.lost).nonzero()[0]
    sure = (seen.sure & np.isfinite(seen.position[:, 0])).nonzero()[0]
    known_ship, known_track = row_of(ships.id, before.ship), row_of(seen.id, before.track)
    known = (known_ship >= 0) & (known_track >= 0)
    known[known] = ~ships.lost[known_ship[known]] & seen.sure[known_track[known]]
    ship, track = known_ship[known], known_track[known]
    if len(placed) and len(sure):
        corrected = own + registration.corrected(errors, seen.position[sure] - own)
        h = registration.jacobian(corrected - own)
        reach = NEAR + WIDE * np.sqrt(np.einsum('nij,jk,nik->n', h, errors.covariance, h))
        reach = np.minimum(reach, FARTHEST)
        near = cKDTree(corrected).sparse_distance_matrix(
            cKDTree(moving.position[placed]), float(reach.max()), output_type='ndarray'
        )
        near = near[near['v'] <= reach[near['i']]]
        ship = np.append(ship, placed[near['j']])
        track = np.append(track, sure[near['i']])
    key = np.unique(ship * max(len(seen.id), 1) + track)
    return np.divmod(key, max(len(seen.id), 1))


def _covariance(ships: Ships, moving: Moving, seen: Seen, ship: IntArray, track: IntArray) -> Array:
    """[P, 4, 4] of the differences, without that of the registration."""
    found = moving.covariance[ship] + seen.covariance[track]
    length = np.where(np.isnan(ships.length), 0.0, ships.length)[ship]
    middle = MIDDLE**2 + (0.15 * length) ** 2
    for axis in (0, 1):
        found[:, axis, axis] += middle
        found[:, axis + 2, axis + 2] += WAY**2
    return found


def _ratio(
    differ: Array, covariance: Array, errors: Registration, told: Array, moves: BoolArray
) -> tuple[Array, Array]:
    """Log-likelihood ratio [P] of one moment, and squared deviations [P] of place by which they
    differ. Velocities count where the ship tells hers."""
    h = registration.jacobian(told)
    covariance = covariance.copy()
    covariance[:, :2, :2] += h @ errors.covariance @ h.swapaxes(1, 2)
    silent = ~moves
    for axis in (2, 3):
        covariance[silent, axis, :] = covariance[silent, :, axis] = 0.0
        covariance[silent, axis, axis] = OTHERS**2
    differ = np.where(np.arange(4) < 2, differ, np.where(silent[:, None], 0.0, differ))
    factor = np.linalg.cholesky(covariance)
    white = np.linalg.solve(factor, differ[:, :, None])[:, :, 0]
    log_det = 2 * np.log(np.diagonal(factor, axis1=1, axis2=2)).sum(1)
    same = -0.5 * (white**2).sum(1) - 0.5 * log_det - 2 * np.log(2 * np.pi)
    speed = (differ[:, 2:] ** 2).sum(1)
    any_ = -np.log(SPACE) - np.log(2 * np.pi * OTHERS**2) - 0.5 * speed / OTHERS**2
    place = (white[:, :2] ** 2).sum(1)  # the factor is lower: the first two are of the place
    return np.clip(same - any_, LOW, HIGH), place


def _assigned(pairs: Pairs, ship: IntArray, track: IntArray, ships: int, tracks: int) -> BoolArray:
    """Mask [P] of the pairs that the best assignment of all joins."""
    worth = pairs.evidence + START * (pairs.state == JOINED)
    able = (worth > LEAST).nonzero()[0]
    chosen = np.zeros(len(ship), bool)
    if len(able):
        partner = associate(ship[able], track[able], worth[able], ships, tracks)
        chosen[able] = partner[ship[able]] == track[able]
    return chosen


def _something_there(
    moving: Moving, seen: Seen, errors: Registration, own: Array, ship: IntArray, track: IntArray
) -> BoolArray:
    """Mask [P]: near where AIS says is another track than that of the pair."""
    found = np.zeros(len(ship), bool)
    there = np.isfinite(seen.position[:, 0]).nonzero()[0]
    if not len(ship) or not len(there):
        return found
    tree = cKDTree(own + registration.corrected(errors, seen.position[there] - own))
    spread = np.sqrt(np.trace(moving.covariance[ship][:, :2, :2], axis1=1, axis2=2))
    near = tree.query_ball_point(moving.position[ship], THERE + 2 * spread)
    for row, those in enumerate(near):
        found[row] = bool(set(there[those].tolist()) - {int(track[row])})
    return found


def _differ(
    errors: Registration,
    ships: Ships,
    moving: Moving,
    seen: Seen,
    own: Array,
    ship: IntArray,
    track: IntArray,
) -> tuple[Array, Array, Array, Array]:
    """Of pairs at these rows: places [P, 2] m from own ship by radar as it is, and by AIS; by how
    much place and velocity differ [P, 4] without the errors; and the covariance [P, 4, 4] of that,
    but for the registration."""
    offset = seen.position[track] - own
    told = moving.position[ship] - own
    differ = np.concatenate(
        [
            registration.corrected(errors, offset) - told,
            registration.turned(errors, seen.velocity[track]) - moving.velocity[ship],
        ],
        1,
    )
    return offset, told, differ, _covariance(ships, moving, seen, ship, track)


def _places(covariance: Array) -> Array:
    """m^2 [P], each axis."""
    found: Array = 0.5 * np.trace(covariance[:, :2, :2], axis1=1, axis2=2)
    return found


def _searched(
    errors: Registration,
    ships: Ships,
    moving: Moving,
    seen: Seen,
    own: Array,
    ship: IntArray,
    track: IntArray,
    elapsed: float,
) -> Registration:
    """The registration after a look at all pairs that may be."""
    offset, told, differ, covariance = _differ(errors, ships, moving, seen, own, ship, track)
    ways = 0.5 * np.trace(covariance[:, 2:, 2:], axis1=1, axis2=2)
    square = (differ[:, 2:] ** 2).sum(1)
    worth = np.where(
        moving.told[ship],
        0.5 * square * (1 / OTHERS**2 - 1 / ways) + 2 * np.log(OTHERS) - np.log(ways),
        0.0,
    ) + np.log(SPACE / (2 * np.pi))
    return registration.search(errors, ship, offset, told, _places(covariance), worth, elapsed)


def _joined(pairs: Pairs, ship: IntArray, ships: int) -> Joined:
    """What each ship is; the probability that of the evidence among all tracks of hers."""
    likely = probability_of(pairs)
    state = np.full(ships, AIS_ONLY, np.int8)
    track, probability = np.zeros(ships, np.int64), np.zeros(ships)
    np.maximum.at(probability, ship, np.where(pairs.state == CANDIDATE, likely, 0.0))
    for of, told in ((MISMATCH, APART_STATE), (JOINED, BOTH)):
        rows = (pairs.state == of).nonzero()[0]
        state[ship[rows]], track[ship[rows]] = told, pairs.track[rows]
        probability[ship[rows]] = likely[rows]
    return Joined(state, track, probability, np.zeros(ships, bool))


def joined_to(joined: Joined, ships: Ships, tracks: IntArray) -> IntArray:
    """Row [N] of the ship that is joined to each track id [N]; -1 for none."""
    rows = (joined.state == BOTH).nonzero()[0]
    row = row_of(joined.track[rows], tracks)
    return np.where(row >= 0, np.append(rows, -1)[row], -1)
