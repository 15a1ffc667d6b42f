"""The form of every estimator: three pure functions over arrays with a leading track axis.

A fourth function gives its account, if it can fall back on another estimator.
"""

from typing import Any, NamedTuple, Protocol, TypeAlias

import numpy as np

from ..types import Array, CodeArray, Extrapolation, IntArray, Plots

State: TypeAlias = Any  # of an estimator; only the estimator itself looks into it


class Velocity(NamedTuple):
    """Velocities known in advance: mean [K, 2] m/s and covariance [K, 2, 2] m^2/s^2."""

    mean: Array
    covariance: Array


def first_velocity(velocity: Velocity | None, count: int, max_speed: float) -> Velocity:
    """Velocities of `count` new rows: as given, or 0 with an uncertainty of max_speed, m/s."""
    if velocity is not None:
        return velocity
    variance = (max_speed / 2) ** 2  # that of a uniform density on the disc
    return Velocity(np.zeros((count, 2)), np.tile(variance * np.eye(2), (count, 1, 1)))


class Account(NamedTuple):
    """The state of an estimator that can fall back on another, for N tracks; for people to read.

    states      names of the states a track may be in
    state       [N]  index into states
    rho         [N]  j / j_fallback; this and both J are nan if there is nothing to judge yet
    j           [N]  mean squared residual of its expectations, used or not, sigma^2
    j_fallback  [N]  the same of the estimator it falls back on
    reasons     why a track may have fallen back; the first is '': it has not
    reason      [N]  index into reasons
    """

    states: tuple[str, ...]
    state: CodeArray
    rho: Array
    j: Array
    j_fallback: Array
    reasons: tuple[str, ...]
    reason: CodeArray


class Init(Protocol):
    """One new row of state for each plot."""

    def __call__(self, plots: Plots, velocity: Velocity | None = None) -> State:
        """The state; see `Estimator`."""


class Extrapolate(Protocol):
    """Where the rows are at their times."""

    def __call__(self, state: State, time: Array) -> Extrapolation:
        """The extrapolation; see `Estimator`."""


class Update(Protocol):
    """One plot each for the named rows."""

    def __call__(self, state: State, plots: Plots, rows: IntArray) -> State:
        """The state after the plots; see `Estimator`."""


class GiveAccount(Protocol):
    """How the estimator fares."""

    def __call__(self, state: State) -> Account:
        """The account; see `Estimator`."""


class Estimator(NamedTuple):
    """A filter bank that runs any number of tracks at once.

    init(plots, velocity=None) -> state
        One new row for each plot. `velocity` gives what is known of the targets' velocities.
        Without
        it they may have any velocity up to the targets' maximum speed.
    extrapolate(state, time) -> Extrapolation
        Every row to its own time [N] s, which may be before or after the row's last plot; state is
        not changed.
    update(state, plots, rows) -> state
        The K named rows (int [K], each at most once) take one plot each. Rows that are not named
        had
        no plot: their time stays behind, and the next `extrapolate` covers the gap.

    account(state) -> Account
        The state of the estimator for each track; None if it never falls back on another.

    State is a NamedTuple of arrays with one row a track (it may nest). Use only `types.take`,
    `append` and `where` on it. The functions never write to their arguments.
    """

    init: Init
    extrapolate: Extrapolate
    update: Update
    account: GiveAccount | None = None
