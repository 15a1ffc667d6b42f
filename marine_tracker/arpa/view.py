"""The targets of one scan as they are shown: the content of `targets` and `markers`."""

from typing import NamedTuple

import numpy as np

from ..estimators import Account, Estimator
from ..extent.hull_clearance import hull_clearance
from ..extent.hulls import Shapes
from ..geometry import wrap_bearing
from ..tracking import history, lifecycle
from ..tracking.lifecycle import CONFIRMED
from ..tracking.tracker import Report
from ..types import Array, BoolArray, CodeArray, IntArray, take
from . import alarms
from .alerts import ACTIVE
from .arpa import Picture
from .cpa import Approach
from .motion import Motion
from .stabilisation import NONE
from .stationary import Stationary
from .targets import label


class HullView(NamedTuple):
    """shapes of N targets; clearance [N] m: how near own ship will come to their hulls."""

    shapes: Shapes
    clearance: Array


class View(NamedTuple):
    """N targets at one moment: first those with a number, in its order, then those being acquired.

    name        TT07; Q and the track's id if there is no number yet
    id          [N]  of the track
    number      [N]  0 while the target is being acquired
    status      [N]  TENTATIVE, CONFIRMED, COASTING, or LOST in this scan
    reason      [N]  why a lost one was lost: index into lifecycle.REASONS
    acquired    [N]  AUTOMATIC or MANUAL
    motion      N rows, at the end of the scan
    approach    N rows; nan for what cannot be told, see `told`
    bow         [N]  rad, bearing relative to own ship's bow; nan without a heading
    reference   [N]  the stationary target that tells the motion of the ground
    stabilised  the reference of courses and speeds: ground, sea or none
    harmless    [N]  own ship is at anchor and the target does not certainly come nearer
    dangerous   [N]  a danger alarm is active
    swap_risk   [N]  probability that the track has exchanged its target with another one
    hits        [N]  plots in the last 10 scans
    misses      [N]  scans since the last plot
    age         [N]  s since the first plot
    account     state of the estimator for them, N rows; without words if it gives none
    hulls       their sizes, N rows; None with extent none
    fixed       stationary objects, which are no targets
    """

    name: list[str]
    id: IntArray
    number: IntArray
    status: CodeArray
    reason: CodeArray
    acquired: CodeArray
    motion: Motion
    approach: Approach
    bow: Array
    reference: BoolArray
    stabilised: str
    harmless: BoolArray
    dangerous: BoolArray
    swap_risk: Array
    hits: IntArray
    misses: IntArray
    age: Array
    account: Account
    hulls: HullView | None = None
    fixed: Stationary | None = None


def view(
    picture: Picture, report: Report, estimator: Estimator, shapes: Shapes | None = None
) -> View:
    """The picture's targets with the data of the tracker's report.

    estimator: the one to which the tracks' state belongs; shapes: of all the tracks.
    """
    targets, alerts = picture.targets, picture.alerts
    tracks = take(report.tracks, picture.row)
    active = (alerts.kind == alarms.DANGER) & np.isin(alerts.state, ACTIVE)
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
        picture.harmless,
        np.isin(targets.id, alerts.id[active]),
        picture.swapped,
        history.hits(tracks.history, lifecycle.TEN),
        history.misses_in_a_row(tracks.history),
        picture.time - tracks.first_time,
        estimator.account(tracks.state) if estimator.account else no_account(len(tracks.id)),
        None if shapes is None else _hulls(picture, take(shapes, picture.row)),
        picture.fixed,
    )


def told(picture: Picture) -> Approach:
    """The approach, with nan for what cannot be known: courses and speeds without stabilisation,
    and without a heading all that counts from north. Range, CPA, TCPA and bow crossing remain."""
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
    """Summary of the accounts of the confirmed tracks.

    states     number of tracks in each state of the estimator; empty if it has none
    fallen     number of tracks that have fallen back
    reason     why most of them have; '' if none has
    fallen_at  [N]  which of all tracks have
    """

    states: dict[str, int]
    fallen: int
    reason: str
    fallen_at: BoolArray


def standing(report: Report, estimator: Estimator) -> Standing:
    """The state of the estimator for the confirmed tracks of a report."""
    if estimator.account is None:
        return Standing({}, 0, '', np.zeros(len(report.tracks.id), bool))
    account = estimator.account(report.tracks.state)
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
    """The account of an estimator that never falls back, for `count` tracks."""
    none, unknown = np.zeros(count, np.int8), np.full(count, np.nan)
    return Account(('',), none, unknown, unknown, unknown, ('',), none)
