"""Kalman filter on the "current" statistical model (Zhou and Kumar 1984; papers 001 and 003).

Per axis the state is [x, v, a]. The acceleration is a Singer process about a mean that is the
present estimate, with the variance of a modified Rayleigh density bounded by a_max:

    x(t+T) = F x + U abar + w,   cov w = 2 alpha sigma_a^2 q(T)

Symbols: y = alpha T, e = exp(-y); F, U, q are the exact discrete form of paper 003 eq 3. phi_d(T)
below is the d-fold integral of exp(-alpha t), so F = [[1, T, phi_2], [0, 1, phi_1], [0, 0, phi_0]].
"""

from math import factorial
from typing import NamedTuple

import numpy as np

from ..gaussian.linear import kalman_update, sandwich
from ..types import Array, Extrapolation, IntArray, Plots, put, take
from .contract import Estimator, Velocity, first_velocity

RAYLEIGH = (4 - np.pi) / np.pi  # variance of the Rayleigh density over its squared mean
# Without a floor the process noise vanishes when the estimate sits at a_max, and the filter
# diverges: 5,388 m RMS against 33 m with it (measured).
VARIANCE_FLOOR = 0.05
SERIES_BELOW = 0.5  # alpha T; the closed forms lose all digits near 0
SERIES_TERMS = 16  # the rest at y = 0.5 is below 1e-15
POSITION = (0, 3)
VELOCITY = (1, 4)
POSITION_VELOCITY = np.array([0, 3, 1, 4])
_SHOWN_BLOCK = POSITION_VELOCITY[:, None] + 6 * POSITION_VELOCITY  # of a flat covariance


class Manoeuvre(NamedTuple):
    """How a class of vessels accelerates.

    max_acceleration  m/s^2, per axis
    frequency         1/s, alpha: the inverse of a manoeuvre's duration
    """

    max_acceleration: float
    frequency: float


PRESETS = {
    'ship': Manoeuvre(max_acceleration=0.3, frequency=1 / 60),
    'small_craft': Manoeuvre(max_acceleration=2.0, frequency=1 / 20),
}


class CsState(NamedTuple):
    """time [N] s; mean [N, 6] = [x v a] east, then north; covariance [N, 6, 6]."""

    time: Array
    mean: Array
    covariance: Array


def _series_coefficients() -> Array:
    """Coefficients [terms, 9] of phi_0..2 / T^d and q11, q12, q13, q22, q23, q33 / T^n in y."""
    table = np.zeros((SERIES_TERMS, 9))
    for j in range(SERIES_TERMS):
        for d in range(3):
            table[j, d] = (-1) ** j / factorial(j + d)
    pairs = [(2, 2), (2, 1), (2, 0), (1, 1), (1, 0), (0, 0)]
    for column, (a, b) in enumerate(pairs, 3):  # integral of phi_a phi_b
        for i in range(SERIES_TERMS):
            for j in range(SERIES_TERMS - i):
                table[i + j, column] += (-1) ** (i + j) / (
                    factorial(i + a) * factorial(j + b) * (i + j + a + b + 1)
                )
    return table


_SERIES = _series_coefficients()


def model(frequency: float, step: Array) -> tuple[Array, Array]:
    """phi [3, N] and q [6, N] (q11, q12, q13, q22, q23, q33) for the time steps [N] s.

    Either sign of step for phi; q is that of |step|. Relative error below 1e-12.
    """
    y = frequency * step
    out = _SERIES.T @ _powers(y)
    if step.size and step.min() < 0:
        out[3:] = _SERIES.T[3:] @ _powers(np.abs(y))
    units = np.empty_like(out)
    units[0], units[1], units[2] = 1.0, step, step * step
    size = np.abs(step)
    units[8], units[7], units[5] = size, size * size, size**3
    units[6], units[4], units[3] = units[5], units[7] ** 2, units[7] * units[5]
    out *= units
    far = np.abs(y) > SERIES_BELOW
    if far.any():
        out[:3, far], out[3:, far] = _closed_form(frequency, step[far])
    return out[:3], out[3:]


def _powers(y: Array) -> Array:
    """y^0 ... y^(SERIES_TERMS - 1), [SERIES_TERMS, N], each doubling in one product."""
    powers = np.empty((SERIES_TERMS, len(y)))
    powers[0] = 1.0
    powers[1] = y
    known = 2
    while known < SERIES_TERMS:
        more = min(known - 1, SERIES_TERMS - known)
        np.multiply(powers[1 : 1 + more], powers[known - 1], out=powers[known : known + more])
        known += more
    return powers


def _closed_form(alpha: float, step: Array) -> tuple[Array, Array]:
    y = alpha * step
    e = np.exp(-y)
    phi = np.stack([e, (1 - e) / alpha, (y - 1 + e) / alpha**2])
    y = np.abs(y)
    e = np.exp(-y)
    e2 = e * e
    q = np.stack(
        [
            (1 - e2 + 2 * y + 2 * y**3 / 3 - 2 * y**2 - 4 * y * e) / (2 * alpha**5),
            (1 + e2 - 2 * e + 2 * e * y - 2 * y + y**2) / (2 * alpha**4),
            (1 - e2 - 2 * e * y) / (2 * alpha**3),
            (4 * e - 3 - e2 + 2 * y) / (2 * alpha**3),
            (e2 + 1 - 2 * e) / (2 * alpha**2),
            (1 - e2) / (2 * alpha),
        ]
    )
    return phi, q


def acceleration_variance(acceleration: float | Array, max_acceleration: float) -> Array:
    """sigma_a^2 [...] of the modified Rayleigh density about the estimate [...], with the floor."""
    room = max_acceleration - np.minimum(np.abs(acceleration), max_acceleration)
    return RAYLEIGH * np.maximum(room * room, VARIANCE_FLOOR * max_acceleration**2)


def _per_axis(rows: list[list[int]]) -> IntArray:
    """The layout of a state's matrix from that of one axis."""
    block = np.array(rows)
    zero = np.zeros_like(block)
    return np.block([[block, zero], [zero, block]])


class _Layout(NamedTuple):
    """Which coefficient stands where in the matrices of the wanted n entries of the state.

    transition  [n, 6]  rows of `predict`'s table: 0, 1, T, phi_0..2, U_1..3
    drive       [n]     likewise
    axis        [n]     whose mean acceleration drives it
    noise       [n, n]  rows of its noise table: 0, q11, q12, q13, q22, q23, q33 of east, of north
    """

    transition: IntArray
    drive: IntArray
    axis: IntArray
    noise: IntArray


def _layout(rows: IntArray) -> _Layout:
    noise = _per_axis([[1, 2, 3], [2, 4, 5], [3, 5, 6]])
    noise[3:, 3:] += 6
    return _Layout(
        _per_axis([[1, 2, 5], [0, 1, 4], [0, 0, 3]])[rows],
        np.array([6, 7, 8, 6, 7, 8])[rows],
        np.array([0, 0, 0, 1, 1, 1])[rows],
        noise[np.ix_(rows, rows)],
    )


WHOLE, SHOWN = _layout(np.arange(6)), _layout(POSITION_VELOCITY)


def predict(
    mean: Array, covariance: Array, step: Array, manoeuvre: Manoeuvre, wanted: _Layout = WHOLE
) -> tuple[Array, Array]:
    """States [N, 6] and covariances [N, 6, 6] moved by the steps [N] s.

    wanted: WHOLE, or SHOWN for position and velocity only (then [N, 4] and [N, 4, 4]).
    """
    phi, q = model(manoeuvre.frequency, step)
    limit = manoeuvre.max_acceleration
    variance = acceleration_variance(mean.take((2, 5), 1), limit)
    ahead, moved = move(mean, covariance, step, phi, limit, wanted)
    moved += process_noise(q, 2 * manoeuvre.frequency * variance, wanted)
    return ahead, moved


def move(
    mean: Array, covariance: Array, step: Array, phi: Array, limit: float, wanted: _Layout = WHOLE
) -> tuple[Array, Array]:
    """As `predict`, without process noise: for the phi [3, N] of `model`; limit m/s^2 of abar."""
    abar = np.minimum(np.maximum(mean.take((2, 5), 1), -limit), limit)
    table = np.empty((9, len(step)))
    table[0], table[1], table[2], table[3:6] = 0.0, 1.0, step, phi
    table[6], table[7] = 0.5 * step * step - phi[2], step - phi[1]
    table[8] = 1 - phi[0]
    table = table.T
    transition = table.take(wanted.transition, 1)
    drive = table.take(wanted.drive, 1) * abar.take(wanted.axis, 1)
    return np.matmul(transition, mean[..., None])[..., 0] + drive, sandwich(transition, covariance)


def process_noise(q: Array, density: Array, wanted: _Layout = WHOLE) -> Array:
    """Covariance [N, n, n] of w for the q [6, N] of `model`; density [N, 2] = 2 alpha sigma_a^2."""
    table = np.zeros((13, len(density)))
    table[1:7], table[7:] = q * density[:, 0], q * density[:, 1]
    return table.T.take(wanted.noise, 1)


def predict_mean(mean: Array, step: Array, manoeuvre: Manoeuvre) -> Array:
    """States [N, 6] moved by the steps [N] s, as `predict` does, without covariances."""
    (phi0, phi1, phi2), _ = model(manoeuvre.frequency, step)
    limit = manoeuvre.max_acceleration
    out = np.empty_like(mean)
    for x, v, a in ((0, 1, 2), (3, 4, 5)):
        held = np.clip(mean[:, a], -limit, limit)
        out[:, x] = (
            mean[:, x] + step * mean[:, v] + phi2 * mean[:, a] + (0.5 * step * step - phi2) * held
        )
        out[:, v] = mean[:, v] + phi1 * mean[:, a] + (step - phi1) * held
        out[:, a] = phi0 * mean[:, a] + (1 - phi0) * held
    return out


def cs_kalman(manoeuvre: Manoeuvre, max_speed: float) -> Estimator:
    """The CS-Kalman filter on joint [x v a] states of both axes.

    max_speed, m/s, of the targets sets the velocity variance before the second plot.
    """

    def init(plots: Plots, velocity: Velocity | None = None) -> CsState:
        count = len(plots.time)
        velocity = first_velocity(velocity, count, max_speed)
        mean = np.zeros((count, 6))
        mean[:, POSITION], mean[:, VELOCITY] = plots.position, velocity.mean
        covariance = np.zeros((count, 6, 6))
        covariance[:, [[0], [3]], POSITION] = plots.covariance
        covariance[:, [[1], [4]], VELOCITY] = velocity.covariance
        covariance[:, 2, 2] = covariance[:, 5, 5] = acceleration_variance(
            0.0, manoeuvre.max_acceleration
        )
        return CsState(plots.time.copy(), mean, covariance)

    def extrapolate(state: CsState, time: Array) -> Extrapolation:
        step = time - state.time
        late = step.nonzero()[0]
        if 2 * len(late) > len(step):
            mean, covariance = predict(state.mean, state.covariance, step, manoeuvre, SHOWN)
        else:  # the others are there already, as tracks are that have just been updated
            mean = state.mean.take(POSITION_VELOCITY, 1)
            covariance = state.covariance.reshape(-1, 36).take(_SHOWN_BLOCK, 1)
            mean[late], covariance[late] = predict(
                state.mean[late], state.covariance[late], step[late], manoeuvre, SHOWN
            )
        return Extrapolation(time, mean[:, :2], mean[:, 2:], covariance)

    def update(state: CsState, plots: Plots, rows: IntArray) -> CsState:
        before = take(state, rows)
        mean, covariance = predict(
            before.mean, before.covariance, plots.time - before.time, manoeuvre
        )
        innovation = plots.position - mean.take(POSITION, 1)
        mean, covariance, _, _ = kalman_update(
            mean, covariance, innovation, plots.covariance, POSITION
        )
        return put(state, rows, CsState(plots.time, mean, covariance))

    return Estimator(init, extrapolate, update)
