"""The bank of filters that `gwnn` fuses: three IMMs, four slow CV filters and CS-Kalman.

All take the same plots. From them come 13 experts, each with its own opinion where the target is:

    0-3    the modes of the base IMM: straight, any, turning right, turning left
    4-6    the nine-mode IMM: its mean, that of its right turns, that of its left turns
    7-10   constant velocity with little to much noise
    11     CS-Kalman, also what `gwnn` falls back to
    12     the IMM tuned for manoeuvre

The base IMM's mean is where a network that says nothing leaves the track.
"""

import hashlib
from typing import NamedTuple

import numpy as np

from ..types import Array, Plots
from . import cs_kalman, linear_modes
from .contract import Velocity
from .imm import Modes
from .linear import first_velocity, kalman_update

PERIOD = 60 / 22                # s, to which the settings refer
EXPERTS = 13
BASE, RICH, SLOW, TUNED = slice(0, 4), slice(4, 13), slice(13, 17), slice(17, 21)
CS = 11                         # the expert
TURNS = ((2, 3), (5, 6))        # experts right and left


def _modes(acceleration, turn_rate, stay):
    """Modes by the deviation, m/s^2, of their white acceleration over a scan."""
    return Modes(tuple(PERIOD * a * a for a in acceleration), tuple(turn_rate), stay, PERIOD)


# Tuned on the training tracks of `evaluation.gwnn_training`, every kind and phase alike.
TUNED_ON_ALL = _modes((0.0010256, 0.79201, 0.014074, 0.014074), (0, 0, 0.020922, -0.020922),
                      (0.99797, 0.78744, 0.78744, 0.78744))
# Likewise, with four times the weight on manoeuvres.
TUNED_FOR_MANOEUVRE = _modes((0.0046012, 0.27837, 0.0073317, 0.0073317),
                             (0, 0, 0.051609, -0.051609), (0.98887, 0.80141, 0.80141, 0.80141))
NINE = _modes((0.0005, 0.05, 0.6) + (0.03,) * 6,
              (0, 0, 0, *np.radians((1, -1, 2.5, -2.5, 6, -6))), (0.992,) + (0.85,) * 8)
NINE_ENTERED = (1, 1, 0.5, 1, 1, 1, 1, 0.5, 0.5)
SLOW_ACCELERATION = (0.0005, 0.006, 0.03, 0.12)
MANOEUVRE = cs_kalman.Manoeuvre(max_acceleration=1.0, frequency=1 / 60)


def settings() -> str:
    """A mark of the filters' settings: weights belong to the filters they were trained over."""
    numbers = [number for modes in (TUNED_ON_ALL, NINE, TUNED_FOR_MANOEUVRE)
               for number in (*modes.noise, *modes.turn_rate, *modes.stay)]
    numbers += [*NINE_ENTERED, *SLOW_ACCELERATION, *MANOEUVRE]
    return hashlib.sha256(' '.join(f'{number:.9g}' for number in numbers).encode()).hexdigest()[:16]


class BankState(NamedTuple):
    """All filters' states.

    time           [N]         s, last plot
    weight         [N, 21]     mode probabilities, summing to 1 in each IMM
    rows           [N, 21, 14] means and packed covariances of the modes (`linear_modes`)
    cs_mean        [N, 6]      of CS-Kalman
    cs_covariance  [N, 6, 6]
    """

    time: Array
    weight: Array
    rows: Array
    cs_mean: Array
    cs_covariance: Array


class Ahead(NamedTuple):
    """What the filters expect at some time, axes last to first as in `linear_modes`.

    mean          [4, N]      of the base IMM: position m, velocity m/s
    experts       [4, 13, N]
    weight        [21, N]     mode probabilities
    acceleration  [2, N]      m/s^2, of CS-Kalman
    """

    mean: Array
    experts: Array
    weight: Array
    acceleration: Array


def _bank():
    """The 21 modes and the three chains over them."""
    slow = _modes(SLOW_ACCELERATION, (0, 0, 0, 0), (1, 1, 1, 1))
    groups = (TUNED_ON_ALL, NINE, slow, TUNED_FOR_MANOEUVRE)
    chains = [linear_modes.Chain(at, linear_modes.transition_power(modes.stay, PERIOD, entered))
              for at, modes, entered in ((BASE, TUNED_ON_ALL, None), (RICH, NINE, NINE_ENTERED),
                                         (TUNED, TUNED_FOR_MANOEUVRE, None))]
    return linear_modes.bank(sum((m.noise for m in groups), ()),
                             sum((m.turn_rate for m in groups), ()), chains)


BANK = _bank()
_BASE_ONLY = linear_modes.bank(BANK.noise[BASE, 0], BANK.turn_rate[BASE, 0], BANK.chains[:1])
_START = np.ones(len(BANK.noise))
for _chain in BANK.chains:
    _START[_chain.modes] = linear_modes.stationary(_chain)
# The right and the left turns of the nine modes, as rows to multiply their weights with.
_SIDES = np.stack([BANK.turn_rate[RICH, 0] > 0, BANK.turn_rate[RICH, 0] < 0]).astype(float)


def begin(plots: Plots, max_speed: float, velocity: Velocity | None = None) -> BankState:
    """States of one plot each; max_speed m/s of the targets; what else is known of velocities."""
    count, j = len(plots.time), len(_START)
    velocity = first_velocity(velocity, count, max_speed)
    rows = np.zeros((count, j, 14))
    rows[..., :2], rows[..., 2:4] = plots.position[:, None], velocity.mean[:, None]
    rows[..., [4, 5, 8]] = linear_modes.packed_noise(plots.covariance).T[:, None]
    rows[..., 11:] = linear_modes.packed_noise(velocity.covariance).T[:, None]
    cs = cs_kalman.cs_kalman(MANOEUVRE, max_speed).init(plots, velocity)
    return BankState(plots.time.copy(), np.tile(_START, (count, 1)), rows, cs.mean, cs.covariance)


def look(state: BankState, step) -> Ahead:
    """What the filters expect after steps [N] s, or [1] for all; means only, which is cheap."""
    mean, weight = linear_modes.mix_means(BANK, state.rows[..., :4], state.weight, step)
    columns = linear_modes.move_means(BANK, linear_modes.columns_of(mean), step)
    cs = cs_kalman.predict_mean(state.cs_mean, step, MANOEUVRE)
    return _ahead(columns, np.ascontiguousarray(weight.T), cs)


def base(state: BankState, time):
    """Columns [14, N] of the base IMM at the times [N] s: mean and packed covariance."""
    step = time - state.time
    columns, weight = linear_modes.mix(_BASE_ONLY, state.rows[:, BASE], state.weight[:, BASE],
                                       step)
    columns = linear_modes.move(_BASE_ONLY, columns, step)
    return linear_modes.combine(columns, weight.T)


def _ahead(columns, weight, cs):
    mean = (columns[:, BASE] * weight[BASE]).sum(1)
    experts = np.empty((4, EXPERTS, len(cs)))
    experts[:, :4] = columns[:, BASE]
    experts[:, 4] = (columns[:, RICH] * weight[RICH]).sum(1)
    for k in (0, 1):
        side = weight[RICH] * _SIDES[k][:, None]
        experts[:, 5 + k] = (columns[:, RICH] * (side / side.sum(0))).sum(1)
    experts[:, 7:11] = columns[:, SLOW]
    experts[:, CS] = cs[:, cs_kalman.POSITION_VELOCITY].T
    experts[:, 12] = (columns[:, TUNED] * weight[TUNED]).sum(1)
    return Ahead(mean, experts, weight, cs[:, [2, 5]].T)


class Expected(NamedTuple):
    """The filters just before a plot, and how well it fits.

    ahead    what they expect at the plot's time
    columns  [14, 21, N]  the modes
    cs       CS-Kalman's mean [N, 6] and covariance [N, 6, 6]
    nis      [N]  squared Mahalanobis distance of the plot by the base IMM
    """

    ahead: Ahead
    columns: Array
    cs: tuple[Array, Array]
    nis: Array


def expect(state: BankState, plots: Plots) -> Expected:
    """The filters of N rows moved to the times of one plot each."""
    step = plots.time - state.time
    columns, weight = linear_modes.mix(BANK, state.rows, state.weight, step)
    columns = linear_modes.move(BANK, columns, step)
    weight = np.ascontiguousarray(weight.T)
    cs = cs_kalman.predict(state.cs_mean, state.cs_covariance, step, MANOEUVRE)
    mixture = linear_modes.combine(columns[:, BASE], weight[BASE])
    _, nis, _ = linear_modes.innovate(mixture, plots.position.T,
                                      linear_modes.packed_noise(plots.covariance))
    return Expected(_ahead(columns[:4], weight, cs[0]), columns, cs, nis)


def correct(expected: Expected, plots: Plots) -> BankState:
    """The filters after the plots that `expect` was given."""
    columns, score = linear_modes.correct(expected.columns, plots.position.T,
                                          linear_modes.packed_noise(plots.covariance))
    weight = expected.ahead.weight.copy()
    for chain in BANK.chains:
        weight[chain.modes] = linear_modes.reweigh(weight[chain.modes], score[chain.modes])
    mean, covariance = expected.cs
    mean, covariance, _, _ = kalman_update(
        mean, covariance, plots.position - mean[:, cs_kalman.POSITION], plots.covariance,
        cs_kalman.POSITION)
    return BankState(plots.time, np.ascontiguousarray(weight.T), linear_modes.rows_of(columns),
                     mean, covariance)
