"""Interacting multiple models: two constant-velocity and two coordinated-turn Kalman filters.

Blom and Bar-Shalom, IEEE T-AC 33(8), 1988. The state of every mode is [position, velocity], so
the modes mix without padding. Mode changes happen in time, not per plot: the transition matrix
over a step is that of the continuous-time chain, the identity at step 0.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, Extrapolation, put, take
from .contract import Estimator
from .linear import first_velocity_variance, kalman_update, sandwich, squared_distance

POSITION = (0, 1)


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
    'ship': Modes(noise=(0.0005, 0.4, 0.015, 0.015), turn_rate=(0, 0, 0.021, -0.021),
                  stay=(0.995, 0.85, 0.93, 0.93), period=60 / 22),
    'small_craft': Modes(noise=(0.01, 8.0, 0.5, 0.5), turn_rate=(0, 0, 0.262, -0.262),
                         stay=(0.96, 0.8, 0.8, 0.8), period=60 / 22),
}


def transition_power(stay, period):
    """Eigen-form of the mode chain: function of steps [N] s to transition matrices [N, J, J].

    A mode left is left for each other mode alike.
    """
    stay = np.asarray(stay, float)
    count = len(stay)
    matrix = np.tile(((1 - stay) / max(count - 1, 1))[:, None], (1, count))
    np.fill_diagonal(matrix, stay)
    values, vectors = np.linalg.eig(matrix)
    values, vectors = values.real, vectors.real
    if values.min() <= 0:
        raise ValueError(f'stay probabilities {tuple(stay)} are too small for a chain in '
                         'continuous time; they must be well above 1 / number of modes')
    inverse = np.linalg.inv(vectors)
    decay = np.log(values) / period

    def over(step):
        powers = np.exp(np.abs(step)[:, None] * decay)
        flat = powers @ (vectors.T[:, :, None] * inverse[:, None, :]).reshape(count, -1)
        return np.clip(flat.reshape(-1, count, count), 0.0, 1.0)
    return over


def turn_matrices(turn_rate, step):
    """Transition matrices [N, J, 4, 4] of coordinated turns (clockwise) over the steps [N] s."""
    angle = step[:, None] * turn_rate
    sin, cos = np.sin(angle), np.cos(angle)
    straight = turn_rate == 0
    divisor = np.where(straight, 1.0, turn_rate)
    along = np.where(straight, step[:, None], sin / divisor)
    across = np.where(straight, 0.0, (1 - cos) / divisor)
    matrix = np.zeros(angle.shape + (4, 4))
    matrix[..., 0, 0] = matrix[..., 1, 1] = 1.0
    matrix[..., 0, 2] = matrix[..., 1, 3] = along
    matrix[..., 0, 3], matrix[..., 1, 2] = across, -across
    matrix[..., 2, 2] = matrix[..., 3, 3] = cos
    matrix[..., 2, 3], matrix[..., 3, 2] = sin, -sin
    return matrix


def imm(modes: Modes, max_speed: float) -> Estimator:
    """The IMM filter over a bank of J modes.

    max_speed, m/s, of the targets sets the velocity variance before the second plot.
    """
    noise = np.asarray(modes.noise, float)
    turn_rate = np.asarray(modes.turn_rate, float)
    transition = transition_power(modes.stay, modes.period)
    start = transition(np.array([1e6]))[0, 0]                       # the chain's stationary law

    def predict(state, time):
        step = time - state.time
        chain = transition(step)
        joint = chain * state.weight[:, :, None]                    # from i to j
        weight = joint.sum(1)
        share = joint / weight[:, None, :]
        mean = np.matmul(share.transpose(0, 2, 1), state.mean)
        apart = state.mean[:, :, None] - mean[:, None]              # [N, i, j, 4]
        spread = state.covariance[:, :, None] + apart[..., None] * apart[..., None, :]
        count, j = weight.shape
        covariance = np.matmul(
            share.transpose(0, 2, 1)[:, :, None, :],
            spread.transpose(0, 2, 1, 3, 4).reshape(count, j, j, 16)).reshape(count, j, 4, 4)

        move = turn_matrices(turn_rate, step)
        mean = np.matmul(move, mean[..., None])[..., 0]
        covariance = sandwich(move, covariance)
        size = np.abs(step)[:, None]
        for axis in (0, 1):
            covariance[:, :, axis, axis] += noise * size ** 3 / 3
            covariance[:, :, axis, axis + 2] += noise * size ** 2 / 2
            covariance[:, :, axis + 2, axis] += noise * size ** 2 / 2
            covariance[:, :, axis + 2, axis + 2] += noise * size
        return ImmState(time, weight, mean, covariance)

    def init(plots):
        count, j = len(plots.time), len(noise)
        mean = np.zeros((count, j, 4))
        mean[..., :2] = plots.position[:, None]
        covariance = np.zeros((count, j, 4, 4))
        covariance[..., :2, :2] = plots.covariance[:, None]
        covariance[..., 2, 2] = covariance[..., 3, 3] = first_velocity_variance(max_speed)
        return ImmState(plots.time.copy(), np.tile(start, (count, 1)), mean, covariance)

    def extrapolate(state, time):
        ahead = predict(state, time)
        mean = np.matmul(ahead.weight[:, None, :], ahead.mean)[:, 0]
        apart = ahead.mean - mean[:, None]
        count, j = ahead.weight.shape
        spread = ahead.covariance + apart[..., None] * apart[..., None, :]
        covariance = np.matmul(ahead.weight[:, None, :], spread.reshape(count, j, 16))
        return Extrapolation(time, mean[:, :2], mean[:, 2:], covariance.reshape(count, 4, 4))

    def update(state, plots, rows):
        ahead = predict(take(state, rows), plots.time)
        innovation = plots.position[:, None] - ahead.mean[..., :2]
        mean, covariance, inverse, determinant = kalman_update(
            ahead.mean, ahead.covariance, innovation, plots.covariance[:, None], POSITION)
        score = -0.5 * (squared_distance(innovation, inverse) + np.log(determinant))
        likelihood = np.exp(score - score.max(1, keepdims=True))
        weight = ahead.weight * likelihood + 1e-12                  # no mode is ruled out for ever
        weight /= weight.sum(1, keepdims=True)
        return put(state, rows, ImmState(plots.time, weight, mean, covariance))

    return Estimator(init, extrapolate, update)
