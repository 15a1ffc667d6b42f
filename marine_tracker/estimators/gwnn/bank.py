"""The banks of filters that `gwnn` fuses: three IMMs, straight legs and CS-Kalman.

All take the same plots. They give 13 experts, each with its own estimate of the target:

    0-3    the modes of the base IMM: straight, any, turning right, turning left
    4-6    the nine-mode IMM: its mean, that of its right turns, that of its left turns
    7-10   straight legs since a likely change (`gaussian.leg_hypotheses`): the mean of the likely
           ones, the likeliest, the one that began first, the manoeuvre
    11     CS-Kalman, also the fallback of `gwnn`
    12     a second IMM, good where the base is not

With a network output of 0, the track is at the mean of the base IMM. There is one bank for each
vessel class (`BANKS`). They differ in data only (`BankSettings`).
"""

import hashlib
from typing import NamedTuple

import numpy as np

from ...gaussian import leg_hypotheses, linear_modes
from ...gaussian.leg_hypotheses import Legs
from ...gaussian.linear import kalman_update
from ...types import Array, Plots
from .. import cs_kalman
from ..contract import Velocity, first_velocity
from .bank_settings import SETTINGS, BankSettings

EXPERTS = 13
BASE, RICH, SECOND = slice(0, 4), slice(4, 13), slice(13, 17)
LEG_EXPERTS = slice(7, 11)
CS, SECOND_IMM = 11, 12  # experts
TURNS = ((2, 3), (5, 6))  # experts right and left
CERTAINTY = 10.0  # degrees of freedom of the plots' stated noise, for the legs
OLD = 0.01  # least probability of the leg that began first
CHANGES_KEEP = 0.98  # share of the counted changes that is kept at a plot


class Filters(NamedTuple):
    """A bank, built of its settings.

    modes  all 17 with the three chains over them
    base   the base IMM alone
    start  [17]    mode probabilities of a track of one plot
    sides  [2, 9]  which of the nine modes turn right, and left
    mark   of the settings: weights belong to the filters that they were trained over
    """

    settings: BankSettings
    modes: linear_modes.Bank
    base: linear_modes.Bank
    start: Array
    sides: Array
    mark: str


def build(settings: BankSettings) -> Filters:
    """The bank with these settings."""
    groups = (settings.base, settings.nine, settings.second)
    chains = [
        linear_modes.Chain(at, linear_modes.transition_power(modes.stay, modes.period, entered))
        for at, modes, entered in (
            (BASE, settings.base, None),
            (RICH, settings.nine, settings.entered),
            (SECOND, settings.second, None),
        )
    ]
    modes = linear_modes.bank(
        sum((m.noise for m in groups), ()), sum((m.turn_rate for m in groups), ()), chains
    )
    start = np.ones(len(modes.noise))
    for chain in chains:
        start[chain.modes] = linear_modes.stationary(chain)
    turn_rate = modes.turn_rate[RICH, 0]
    base = linear_modes.bank(settings.base.noise, settings.base.turn_rate, chains[:1])
    return Filters(
        settings,
        modes,
        base,
        start,
        np.stack([turn_rate > 0, turn_rate < 0]).astype(float),
        _mark(settings),
    )


def _mark(settings: BankSettings) -> str:
    numbers = [
        number
        for modes in (settings.base, settings.nine, settings.second)
        for number in (*modes.noise, *modes.turn_rate, *modes.stay, modes.period)
    ]
    numbers += [*settings.entered, *settings.habits, *settings.manoeuvre]
    return hashlib.sha256(' '.join(f'{number:.9g}' for number in numbers).encode()).hexdigest()[:16]


BANKS = {name: build(settings) for name, settings in SETTINGS.items()}


class BankState(NamedTuple):
    """All filters' states.

    time           [N]         s, last plot
    weight         [N, 17]     mode probabilities, summing to 1 in each IMM
    rows           [N, 17, 14] means and packed covariances of the modes (`linear_modes`)
    legs                       hypotheses about the target's last change (`leg_hypotheses`)
    likely         [N, 14]     mean and packed covariance of the likely ones
    changes        [N]         how often a manoeuvre was believed in lately, in plots
    cs_mean        [N, 6]      of CS-Kalman
    cs_covariance  [N, 6, 6]
    """

    time: Array
    weight: Array
    rows: Array
    legs: Legs
    likely: Array
    changes: Array
    cs_mean: Array
    cs_covariance: Array


class Ahead(NamedTuple):
    """What the filters expect at some time, axes last to first as in `linear_modes`.

    mean          [4, N]      of the base IMM: position m, velocity m/s
    experts       [4, 13, N]
    weight        [17, N]     mode probabilities
    acceleration  [2, N]      m/s^2, of CS-Kalman
    """

    mean: Array
    experts: Array
    weight: Array
    acceleration: Array


def begin(
    bank: Filters, plots: Plots, max_speed: float, velocity: Velocity | None = None
) -> BankState:
    """States of one plot each; max_speed m/s of the targets; what else is known of velocities."""
    count, j = len(plots.time), len(bank.start)
    velocity = first_velocity(velocity, count, max_speed)
    rows = np.zeros((count, j, 14))
    rows[..., :2], rows[..., 2:4] = plots.position[:, None], velocity.mean[:, None]
    rows[..., [4, 5, 8]] = linear_modes.packed_noise(plots.covariance).T[:, None]
    rows[..., 11:] = linear_modes.packed_noise(velocity.covariance).T[:, None]
    cs = cs_kalman.cs_kalman(bank.settings.manoeuvre, max_speed).init(plots, velocity)
    legs = Legs(
        rows[:, : 1 + leg_hypotheses.LEGS].copy(),
        np.tile(leg_hypotheses.START, (count, 1)),
        np.tile(plots.time[:, None], leg_hypotheses.LEGS),
    )
    return BankState(
        plots.time.copy(),
        np.tile(bank.start, (count, 1)),
        rows,
        legs,
        rows[:, 0].copy(),
        np.zeros(count),
        cs.mean,
        cs.covariance,
    )


def look(bank: Filters, state: BankState, step: Array) -> Ahead:
    """What the filters expect after steps [N] s, or [1] for all; means only, which is cheap."""
    columns = linear_modes.columns_of(state.rows[..., :4])
    columns, weight = linear_modes.mix_means(bank.modes, columns, state.weight.T, step)
    columns = linear_modes.move_means(bank.modes, columns, step)
    cs = cs_kalman.predict_mean(state.cs_mean, step, bank.settings.manoeuvre)
    return _ahead(bank, state, columns, weight, cs, step)


def base(bank: Filters, state: BankState, time: Array) -> Array:
    """Columns [14, N] of the base IMM at the times [N] s: mean and packed covariance."""
    step = time - state.time
    columns, weight = linear_modes.mix(bank.base, state.rows[:, BASE], state.weight[:, BASE], step)
    columns = linear_modes.move(bank.base, columns, step)
    return linear_modes.combine(columns, weight.T)


def _ahead(
    bank: Filters, state: BankState, columns: Array, weight: Array, cs: Array, step: Array
) -> Ahead:
    mean = (columns[:, BASE] * weight[BASE]).sum(1)
    experts = np.empty((4, EXPERTS, len(cs)))
    experts[:, :4] = columns[:, BASE]
    experts[:, 4] = (columns[:, RICH] * weight[RICH]).sum(1)
    for k in (0, 1):
        side = weight[RICH] * bank.sides[k][:, None]
        experts[:, 5 + k] = (columns[:, RICH] * (side / side.sum(0))).sum(1)
    experts[:, LEG_EXPERTS] = _legs_ahead(state, step)
    experts[:, CS] = cs[:, cs_kalman.POSITION_VELOCITY].T
    experts[:, SECOND_IMM] = (columns[:, SECOND] * weight[SECOND]).sum(1)
    return Ahead(mean, experts, weight, cs[:, [2, 5]].T)


def _legs_ahead(state: BankState, step: Array) -> Array:
    """The experts [4, 4, N] of the legs as they were after the last plot, straight on."""
    mean, weight = state.legs.rows[..., :4], state.legs.weight[:, 1:]
    row = np.arange(len(mean))
    first = np.where(weight > OLD, state.legs.begun, np.inf).argmin(1)
    found = np.stack(
        [
            state.likely[:, :4].T,
            mean[row, 1 + weight.argmax(1)].T,
            mean[row, 1 + first].T,
            mean[:, 0].T,
        ],
        1,
    )
    found[:2] += step * found[2:]
    return found


class Expected(NamedTuple):
    """The filters just before a plot, and how well it fits.

    ahead    what they expect at the plot's time
    columns  [14, 17, N]  the modes
    cs       CS-Kalman's mean [N, 6] and covariance [N, 6, 6]
    nis      [N]  squared Mahalanobis distance of the plot by the base IMM
    """

    ahead: Ahead
    columns: Array
    cs: tuple[Array, Array]
    nis: Array


def expect(bank: Filters, state: BankState, plots: Plots) -> Expected:
    """The filters of N rows moved to the times of one plot each."""
    step = plots.time - state.time
    columns, weight = linear_modes.mix(bank.modes, state.rows, state.weight, step)
    columns = linear_modes.move(bank.modes, columns, step)
    weight = np.ascontiguousarray(weight.T)
    cs = cs_kalman.predict(state.cs_mean, state.cs_covariance, step, bank.settings.manoeuvre)
    mixture = linear_modes.combine(columns[:, BASE], weight[BASE])
    _, nis, _ = linear_modes.innovate(
        mixture, plots.position.T, linear_modes.packed_noise(plots.covariance)
    )
    ahead = _ahead(bank, state, columns[:4], weight, cs[0], step)
    return Expected(ahead, columns, cs, nis)


def correct(bank: Filters, state: BankState, expected: Expected, plots: Plots) -> BankState:
    """The filters after the plots that `expect` was given."""
    columns, score = linear_modes.correct(
        expected.columns, plots.position.T, linear_modes.packed_noise(plots.covariance)
    )
    weight = expected.ahead.weight.copy()
    for chain in bank.modes.chains:
        weight[chain.modes] = linear_modes.reweigh(weight[chain.modes], score[chain.modes])
    mean, covariance = expected.cs
    mean, covariance, _, _ = kalman_update(
        mean,
        covariance,
        plots.position - mean[:, cs_kalman.POSITION],
        plots.covariance,
        cs_kalman.POSITION,
    )
    legs, likely = leg_hypotheses.update(
        state.legs,
        plots.time,
        plots.time - state.time,
        plots.position,
        plots.covariance,
        None,
        CERTAINTY,
        bank.settings.habits,
    )
    return BankState(
        plots.time,
        np.ascontiguousarray(weight.T),
        linear_modes.rows_of(columns),
        legs,
        likely,
        CHANGES_KEEP * state.changes + legs.weight[:, 0],
        mean,
        covariance,
    )
