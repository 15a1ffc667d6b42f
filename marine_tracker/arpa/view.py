"""The targets of one scan as people see them: what `targets` and `markers` show."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..estimators import ACCOUNTS, Account
from ..extent.hull_clearance import hull_clearance
from ..extent.hulls import Shapes
from ..geometry import wrap_bearing
from ..tracking import lifecycle
from ..tracking.lifecycle import CONFIRMED
from ..tracking.tracker import Report
from ..types import Array, take
from . import alarms
from .alerts import ACTIVE_ACKNOWLEDGED, ACTIVE_UNACKNOWLEDGED
from .arpa import Picture
from .cpa import Approach
from .motion import Motion
from .stabilisation import NONE
from .targets import label


class View(NamedTuple):
    """N targets at one moment: those with a number in its order, then those being acquired.

    name        TT07; Q and the track's id where there is no number yet
    id          [N]  of the track
    number      [N]  0 while the target is being acquired
    status      [N]  TENTATIVE, CONFIRMED, COASTING, or LOST in this scan
    reason      [N]  why a lost one was lost: one of lifecycle.REASONS' numbers
    acquired    [N]  AUTOMATIC or MANUAL
    motion      N rows, at the end of the scan
    approach    N rows; nan for what cannot be told: see `told`
    bow         [N]  rad, bearing from own ship's bow; nan without a heading
    reference   [N]  the stationary target that the ground is known by
    stabilised  what courses and speeds are measured against: ground, sea or none
    at_rest     [N]  neither the target nor own ship makes way
    dangerous   [N]  a danger alarm is active
    swap_risk   [N]  the gate overlaps that of another track
    hits        [N]  plots in the last 10 scans
    misses      [N]  scans since the last plot
    age         [N]  s since the first plot
    account     how the estimator fares with them, N rows; without words where it gives none
    hulls       their sizes, N rows; None with extent off
    """

    name: list[str]
    id: NDArray[np.int64]
    number: NDArray[np.int64]
    status: NDArray[np.int8]
    reason: NDArray[np.int8]
    acquired: NDArray[np.int8]
    motion: Motion
    approach: Approach
    bow: Array
    reference: NDArray[np.bool_]
    stabilised: str
    at_rest: NDArray[np.bool_]
    dangerous: NDArray[np.bool_]
    swap_risk: NDArray[np.bool_]
    hits: NDArray[np.int64]
    misses: NDArray[np.int64]
    age: Array
    account: Account
    hulls: 'HullView | None' = None


class HullView(NamedTuple):
    """shapes: of N targets; clearance [N] m: how near own ship comes to their hulls."""

    shapes: Shapes
    clearance: Array


def view(picture: Picture, report: Report, estimator: str, shapes: Shapes | None = None) -> View:
    """The picture's targets with what the tracker's report tells of them.

    estimator: the name of the one that the tracks' state belongs to; shapes: of all the tracks.
    """
    targets, alerts = picture.targets, picture.alerts
    tracks = take(report.tracks, picture.row)
    active = (alerts.kind == alarms.DANGER) & np.isin(
        alerts.state, (ACTIVE_UNACKNOWLEDGED, ACTIVE_ACKNOWLEDGED)
    )
    return View(
        label(targets.id, tracks.number),
        targets.id,
        tracks.number,
        tracks.status,
        report.reason[picture.row],
        targets.acquired,
        picture.motion,
        told(picture),
        wrap_bearing(picture.approach.bearing - picture.own.heading),
        (tracks.number > 0) & (tracks.number == picture.stabilised.target),
        picture.stabilised.reference,
        picture.at_rest,
        np.isin(targets.id, alerts.id[active]),
        picture.overlap < 1,
        lifecycle.hits(tracks.history, lifecycle.TEN),
        lifecycle.misses_in_a_row(tracks.history),
        picture.time - tracks.first_time,
        ACCOUNTS[estimator](tracks.state) if estimator in ACCOUNTS else no_account(len(tracks.id)),
        None if shapes is None else _hulls(picture, take(shapes, picture.row)),
    )


def told(picture: Picture) -> Approach:
    """The approach, nan where it cannot be known: courses and speeds without a stabilisation; and
    without a heading all that counts from north. Range, CPA, TCPA and bow crossing stay."""
    fields: list[str] = []
    if picture.stabilised.reference == NONE:
        fields += ['course', 'speed']
    if not picture.own.north:
        fields += ['bearing', 'course', 'relative_course']
    unknown = np.full_like(picture.approach.range, np.nan)
    return picture.approach._replace(
        **{name + sigma: unknown for name in fields for sigma in ('', '_sigma')}
    )


def _hulls(picture: Picture, shapes: Shapes) -> HullView:
    motion, own = picture.motion, picture.own
    return HullView(
        shapes,
        hull_clearance(
            shapes.outline, motion.position - own.position, motion.velocity - own.velocity
        ),
    )


class Standing(NamedTuple):
    """The account of the confirmed tracks in sum.

    states     how many are in each state of the estimator; empty where it has none
    fallen     how many have fallen back
    reason     why most of them have; '' where none has
    fallen_at  [N]  which of all tracks have
    """

    states: dict[str, int]
    fallen: int
    reason: str
    fallen_at: NDArray[np.bool_]


def standing(report: Report, estimator: str) -> Standing:
    """How the estimator fares with the confirmed tracks of a report."""
    if estimator not in ACCOUNTS:
        return Standing({}, 0, '', np.zeros(len(report.tracks.id), bool))
    account = ACCOUNTS[estimator](report.tracks.state)
    confirmed = report.tracks.status == CONFIRMED
    states = np.bincount(account.state[confirmed], minlength=len(account.states))
    fallen = np.bincount(account.reason[confirmed], minlength=len(account.reasons))[1:]
    return Standing(
        {name: count for name, count in zip(account.states, states.tolist()) if name},
        int(fallen.sum()),
        account.reasons[1 + int(fallen.argmax())] if fallen.any() else '',
        account.reason > 0,
    )


def no_account(count: int) -> Account:
    """That of an estimator that never falls back, of `count` tracks."""
    none, unknown = np.zeros(count, np.int8), np.full(count, np.nan)
    return Account(('',), none, unknown, unknown, unknown, ('',), none)
