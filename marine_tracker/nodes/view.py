"""The confirmed targets of one scan as people see them: what `targets` and `markers` show."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..estimators import ACCOUNTS, Account
from ..geometry import to_range_bearing, wrap_bearing
from ..tracking import lifecycle
from ..tracking.lifecycle import CONFIRMED
from ..types import Array, Extrapolation, Tracks


class View(NamedTuple):
    """N targets at one moment, in the order of their numbers.

    number      [N]     the ARPA's target number
    status      [N]     CONFIRMED, COASTING, or LOST in this scan
    reason      [N]     why a lost one was lost: one of lifecycle.REASONS' numbers
    estimate    N rows, all at the end of the scan
    range       [N]     m, from own ship
    bearing     [N]     rad, true
    course      [N]     rad, over ground
    speed       [N]     m/s, over ground
    hits        [N]     plots in the last 10 scans
    misses      [N]     scans since the last plot
    age         [N]     s since the first plot
    account     how the estimator fares with them, N rows; without words where it gives none
    """

    number: NDArray[np.int64]
    status: NDArray[np.int8]
    reason: NDArray[np.int8]
    estimate: Extrapolation
    range: Array
    bearing: Array
    course: Array
    speed: Array
    hits: NDArray[np.int64]
    misses: NDArray[np.int64]
    age: Array
    account: Account


def view(tracks: Tracks, reason, estimate: Extrapolation, own_position, estimator: str) -> View:
    """The targets among tracks [N] with their estimates; own_position [2] m.

    estimator: the name of the one that their state belongs to.
    """
    distance, bearing = to_range_bearing(estimate.position - own_position)
    velocity = estimate.velocity
    return View(
        tracks.number, tracks.status, reason, estimate, distance, bearing,
        wrap_bearing(np.arctan2(velocity[:, 0], velocity[:, 1])),
        np.hypot(velocity[:, 0], velocity[:, 1]), lifecycle.hits(tracks.history, 10),
        lifecycle.misses_in_a_row(tracks.history), estimate.time - tracks.first_time,
        ACCOUNTS[estimator](tracks.state) if estimator in ACCOUNTS
        else no_account(len(tracks.id)))


class Standing(NamedTuple):
    """The account of the confirmed targets in sum.

    states   how many are in each state of the estimator; empty where it has none
    fallen   how many have fallen back
    reason   why most of them have; '' where none has
    """

    states: dict[str, int]
    fallen: int
    reason: str


def standing(seen: View) -> Standing:
    """How the estimator fares with the confirmed targets of a view."""
    account, confirmed = seen.account, seen.status == CONFIRMED
    states = np.bincount(account.state[confirmed], minlength=len(account.states))
    fallen = np.bincount(account.reason[confirmed], minlength=len(account.reasons))[1:]
    return Standing(
        {name: count for name, count in zip(account.states, states.tolist()) if name},
        int(fallen.sum()), account.reasons[1 + int(fallen.argmax())] if fallen.any() else '')


def no_account(count: int) -> Account:
    """That of an estimator that never falls back, of `count` tracks."""
    none, unknown = np.zeros(count, np.int8), np.full(count, np.nan)
    return Account(('',), none, unknown, unknown, unknown, ('',), none)


def names(number) -> list[str]:
    """TT01, TT02, ... as ECDIS and NMEA name tracked targets."""
    return [f'TT{n:02d}' for n in number.tolist()]
