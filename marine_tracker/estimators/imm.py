"""Interacting multiple models: two constant-velocity and two coordinated-turn Kalman filters.

Blom and Bar-Shalom, IEEE T-AC 33(8), 1988. The state of every mode is [position, velocity], so the
modes mix without padding. Modes change with time, not with plots: the transition matrix over a step
is that of a continuous-time chain, and the identity at step 0.
"""

from typing import NamedTuple

import numpy as np

from ..gaussian import linear_modes
from ..types import Array, Extrapolation, IntArray, Plots, put, take
from .contract import Estimator, Velocity, first_velocity


class Modes(NamedTuple):
    """A bank of J modes.

    noise       [J]  m^2/s^3, density of the white acceleration of each axis
    turn_rate   [J]  rad/s, clockwise positive; 0 for constant velocity
    stay        [J]  probability to be in the same mode `scan_period` later
    period      s    the step to which `stay` refers
    """

    noise: tuple[float, ...]
    turn_rate: tuple[float, ...]
    stay: tuple[float, ...]
    period: float


class ImmState(NamedTuple):
    """time [N] s; weight [N, J]; mean [N, J, 4] and covariance [N, J, 4, 4] of [e n ve vn]."""

    time: Array
    weight: Array
    mean: Array
    covariance: Array


PRESETS = {
    'ship': Modes(
        noise=(0.0005, 0.4, 0.015, 0.015),
        turn_rate=(0, 0, 0.021, -0.021),
        stay=(0.995, 0.85, 0.93, 0.93),
        period=60 / 22,
    ),
    'small_craft': Modes(
        noise=(0.01, 8.0, 0.5, 0.5),
        turn_rate=(0, 0, 0.262, -0.262),
        stay=(0.96, 0.8, 0.8, 0.8),
        period=60 / 22,
    ),
}


def bank_of(modes: Modes) -> linear_modes.Bank:
    """The modes as one chain. A mode that is left is followed by each other mode with equal
    probability.
    """
    chain = linear_modes.Chain(
        slice(0, len(modes.noise)), linear_modes.transition_power(modes.stay, modes.period)
    )
    return linear_modes.bank(modes.noise, modes.turn_rate, [chain])


def imm(modes: Modes, max_speed: float) -> Estimator:
    """The IMM filter over a bank of J modes.

    max_speed, m/s, of the targets sets the velocity variance before the second plot.
    """
    bank = bank_of(modes)
    start = linear_modes.stationary(bank.chains[0])

    def predict(state: ImmState, time: Array) -> tuple[Array, Array]:
        """Columns [14, J, N] of the modes and their weights [J, N] at the times [N] s."""
        step = time - state.time
        columns, weight = linear_modes.mix(
            bank, linear_modes.pack(state.mean, state.covariance), state.weight, step
        )
        return linear_modes.move(bank, columns, step), weight.T

    def init(plots: Plots, velocity: Velocity | None = None) -> ImmState:
        count, j = len(plots.time), len(start)
        velocity = first_velocity(velocity, count, max_speed)
        mean = np.empty((count, j, 4))
        mean[..., :2], mean[..., 2:] = plots.position[:, None], velocity.mean[:, None]
        covariance = np.zeros((count, j, 4, 4))
        covariance[..., :2, :2] = plots.covariance[:, None]
        covariance[..., 2:, 2:] = velocity.covariance[:, None]
        return ImmState(plots.time.copy(), np.tile(start, (count, 1)), mean, covariance)

    def extrapolate(state: ImmState, time: Array) -> Extrapolation:
        mean, covariance = linear_modes.unpack(linear_modes.combine(*predict(state, time)).T)
        return Extrapolation(time, mean[:, :2], mean[:, 2:], covariance)

    def update(state: ImmState, plots: Plots, rows: IntArray) -> ImmState:
        columns, weight = predict(take(state, rows), plots.time)
        columns, score = linear_modes.correct(
            columns, plots.position.T, linear_modes.packed_noise(plots.covariance)
        )
        weight = linear_modes.reweigh(weight, score)
        mean, covariance = linear_modes.unpack(linear_modes.rows_of(columns))
        return put(state, rows, ImmState(plots.time, weight.T, mean, covariance))

    return Estimator(init, extrapolate, update)
