"""Wavelet multiresolution CS-Kalman without latency (paper 003, `wavelet_block` made causal).

Four chains of blocks are interleaved, so with every plot the block of one chain ends. Its last
state is the present estimate. A chain is corrected at the coarsest resolution only, by the mean of
its four innovations; the details keep their prediction. So the noise of single plots has little
effect, whatever acceleration the model allows.

The coarsest row of every periodised orthonormal wavelet is the mean of the block, so the wavelet
makes no difference. Plots of different accuracy are weighted by it in the mean.

The gain: taken literally, eq 13 to 15 leave the variance of the details in P. It grows there until
the gain has nearly one shape for every a_max and plot noise: [1, .56 / tau, .16 / tau^2] for a
block of tau seconds (the last is reduced by alpha tau). This makes the filter insensitive to a_max.
But P is then ten times the error at sea, and after a track's first plots it is not even a
covariance. So here the position is corrected by the Kalman gain of the block's mean, velocity and
acceleration by that limiting shape, and the covariance is that of the error (Joseph's form).
"""

from typing import NamedTuple

import numpy as np

from ..gaussian.linear import invert_2x2, kalman_update, sandwich, squared_distance
from ..types import Array, BoolArray, Extrapolation, IntArray, Plots, put, take
from . import cs_kalman
from .contract import Estimator, Velocity
from .cs_kalman import POSITION, SHOWN, CsState, Manoeuvre, acceleration_variance
from .wavelet_block import SIZE

# The first block of each chain uses all resolutions, a plain Kalman filter, because the velocity of
# a new track is in the details.
WARM_UP = 2 * SIZE - 1
# A plot this many times less accurate than the track has no effect. It must not push another plot
# out of the block either.
FAINT = 1e6
# Limits of the paper's gains: of velocity times tau, and of acceleration times tau^2, which falls
# with alpha tau.
VELOCITY_GAIN, ACCELERATION_GAIN, FALL = 0.5593, 0.1559, 0.83
# Squared distance of an innovation at which the limiting gain is too slow to follow, as it is when
# plots are missed. One in ten is larger in normal operation.
SURPRISE = 4.6

# The allowed acceleration affects the stated uncertainty of a track more than its position. Agile
# craft are not followed better with more (six recordings), and their gates grow.
MANOEUVRE = cs_kalman.PRESETS['ship']


class WaveletState(NamedTuple):
    """The ends of the four chains, oldest first, and the plots that the next block shares.

    time        [N, 4]        s, of the last four plots
    mean        [N, 4, 6]     of the chain that ended at each, [x v a] east, then north
    covariance  [N, 4, 6, 6]
    position    [N, 3, 2]     m, of the last three plots
    noise       [N, 3, 2, 2]  m^2, likewise
    plots       [N]           number of plots so far
    """

    time: Array
    mean: Array
    covariance: Array
    position: Array
    noise: Array
    plots: Array


def begin(time: Array, mean: Array, covariance: Array) -> WaveletState:
    """New rows from known states [N, 6], [N, 6, 6] at the times [N], without plots."""
    rows = len(time)
    return WaveletState(
        np.repeat(time[:, None], SIZE, 1),
        np.repeat(mean[:, None], SIZE, 1),
        np.repeat(covariance[:, None], SIZE, 1),
        np.zeros((rows, SIZE - 1, 2)),
        np.ones((rows, SIZE - 1, 1, 1)) * np.eye(2),
        np.zeros(rows),
    )


def newest(state: WaveletState) -> CsState:
    """The chain that ended last."""
    return CsState(state.time[:, -1], state.mean[:, -1], state.covariance[:, -1])


def wavelet_cs(manoeuvre: Manoeuvre, max_speed: float) -> Estimator:
    """The causal filter.

    max_speed, m/s, of the targets sets the velocity variance before the second plot.
    """
    plain = cs_kalman.cs_kalman(manoeuvre, max_speed)

    def init(plots: Plots, velocity: Velocity | None = None) -> WaveletState:
        return begin(*plain.init(plots, velocity))._replace(plots=np.ones(len(plots.time)))

    def extrapolate(state: WaveletState, time: Array) -> Extrapolation:
        last = newest(state)
        mean, covariance = cs_kalman.predict(
            last.mean, last.covariance, time - last.time, manoeuvre, SHOWN
        )
        return Extrapolation(time, mean[:, :2], mean[:, 2:], covariance)

    def update(state: WaveletState, plots: Plots, rows: IntArray) -> WaveletState:
        before = take(state, rows)
        mean, covariance = np.empty((len(rows), 6)), np.empty((len(rows), 6, 6))
        told = np.empty(len(rows), bool)
        young = before.plots < WARM_UP
        for chosen, method in ((young, _plot), (~young, _block)):
            at = np.flatnonzero(chosen)
            if len(at):
                mean[at], covariance[at], told[at] = method(
                    take(before, at), take(plots, at), manoeuvre
                )
        after = WaveletState(
            _push(before.time, plots.time),
            _push(before.mean, mean),
            _push(before.covariance, covariance),
            _push(before.position, plots.position),
            _push(before.noise, plots.covariance),
            before.plots + 1,
        )
        return put(state, rows[told], take(after, told))

    return Estimator(init, extrapolate, update)


def _push(ring: Array, new: Array) -> Array:
    """The oldest of each row of ring [N, m, ...] dropped, new [N, ...] added."""
    return np.concatenate([ring[:, 1:], new[:, None]], 1)


def _tells(covariance: Array, noise: Array) -> BoolArray:
    """Whether plots with covariance noise [N, 2, 2] give tracks [N, 6, 6] any information.

    A plot that is not a number counts as yes: it harms its own track, as in every estimator.
    """
    own = covariance[:, 0, 0] + covariance[:, 3, 3]
    found: BoolArray = ~(np.trace(noise, axis1=1, axis2=2) > FAINT * own)
    return found


def _plot(
    state: WaveletState, plots: Plots, manoeuvre: Manoeuvre
) -> tuple[Array, Array, BoolArray]:
    """All resolutions: the Kalman update of the chain that ended last."""
    last = newest(state)
    mean, covariance = cs_kalman.predict(
        last.mean, last.covariance, plots.time - last.time, manoeuvre
    )
    told = _tells(covariance, plots.covariance)
    mean, covariance, _, _ = kalman_update(
        mean, covariance, plots.position - mean.take(POSITION, 1), plots.covariance, POSITION
    )
    return mean, covariance, told


def _block(
    state: WaveletState, plots: Plots, manoeuvre: Manoeuvre
) -> tuple[Array, Array, BoolArray]:
    """The coarsest resolution: the oldest chain, corrected by the mean of four innovations."""
    rows = len(plots.time)
    places = np.concatenate([state.position, plots.position[:, None]], 1)
    noise = np.concatenate([state.noise, plots.covariance[:, None]], 1)
    weight = 1 / np.trace(noise, axis1=2, axis2=3)
    weight /= weight.sum(1, keepdims=True)
    mean, expected, both = _predict(state, plots.time, weight, manoeuvre)
    innovation = (weight[..., None] * (places - expected)).sum(1)

    covariance = both[..., :3, :3].swapaxes(2, 3).reshape(rows, 6, 6)
    told = _tells(covariance, plots.covariance)
    toward, own = both[..., 3, :3].reshape(rows, 2, 6), both[..., 3, 3:]  # C cov(m, x), of m
    spread = own[..., 0] + ((weight**2)[..., None, None] * noise).sum(1)
    inverse, _ = invert_2x2(spread)
    behind = squared_distance(innovation, inverse) > SURPRISE
    shape = _shape(manoeuvre.frequency, plots.time - state.time[:, 0], own, behind)
    gain = np.matmul(own[..., 0], inverse)  # of the position
    gain = (gain[:, :, None] * shape[:, None, :, None]).reshape(rows, 6, 2)
    mean = mean + np.matmul(gain, innovation[..., None])[..., 0]
    cross = np.matmul(gain, toward)
    covariance = covariance - cross - cross.swapaxes(1, 2) + sandwich(gain, spread)
    return mean, 0.5 * (covariance + covariance.swapaxes(1, 2)), told


def _predict(
    state: WaveletState, time: Array, weight: Array, manoeuvre: Manoeuvre
) -> tuple[Array, Array, Array]:
    """The oldest chain moved through the block that ends at the times [N] s.

    weight [N, 4] of the states in their mean m. Returns the last state x [N, 6], the expected
    positions [N, 4, 2] of all four states, and the covariance [N, axis, axis, 6, 6] of [x, m].

    [x, m] of one axis is moved from plot to plot by [[F, 0], [w F, 1]]. Both axes share this matrix
    and the noise in units of their sigma_a^2, so small matrices are enough.
    """
    rows = len(time)
    limit = manoeuvre.max_acceleration
    moves, noises, drives = _steps(
        manoeuvre.frequency, np.diff(np.concatenate([state.time, time[:, None]], 1), axis=1)
    )
    x = state.mean[:, 0].reshape(rows, 2, 3)
    held = np.clip(x[:, :, 2:], -limit, limit)
    variance = 2 * manoeuvre.frequency * acceleration_variance(x[:, :, 2], limit)
    expected = np.empty((rows, SIZE, 2))
    joint, spread = np.zeros((rows, 6, 3)), np.zeros((rows, 6, 6))
    joint[:, :3] = np.eye(3)
    for j in range(SIZE):
        w, q = weight[:, j, None, None], noises[:, j]
        x = np.matmul(x, moves[:, j].swapaxes(1, 2)) + held * drives[:, j, None]
        expected[:, j] = x[:, :, 0]
        step = np.zeros((rows, 6, 6))
        step[:, :3, :3], step[:, 3:, :3], step[:, 3:, 3:] = moves[:, j], w * moves[:, j], np.eye(3)
        joint, spread = np.matmul(step, joint), sandwich(step, spread)
        spread[:, :3, :3] += q
        spread[:, :3, 3:] += w * q
        spread[:, 3:, :3] += w * q
        spread[:, 3:, 3:] += w * w * q
    start = state.covariance[:, 0].reshape(rows, 2, 3, 2, 3).swapaxes(2, 3)
    joint = joint[:, None, None]
    both = np.matmul(np.matmul(joint, start), joint.swapaxes(-1, -2))
    for axis in (0, 1):
        both[:, axis, axis] += variance[:, axis, None, None] * spread
    return x.reshape(rows, 6), expected, both


def _shape(frequency: float, tau: Array, own: Array, behind: BoolArray) -> Array:
    """Gains [N, 3] of position, velocity and acceleration over that of the position.

    The paper's limit for blocks of tau [N] s, but never more than the Kalman filter's, and the
    Kalman filter's where a track is `behind` [N]. own [N, 2, 2, 3]: C cov(m, m).
    """
    kalman = own[:, 0, 0] + own[:, 1, 1]
    kalman = kalman / kalman[:, :1]
    limited = (tau > 0) & ~behind
    tau = np.where(limited, tau, 1.0)
    limit = np.stack(
        [
            np.ones_like(tau),
            VELOCITY_GAIN / tau,
            ACCELERATION_GAIN / (1 + FALL * frequency * tau) / tau**2,
        ],
        1,
    )
    return np.where(limited[:, None], np.minimum(limit, kalman), kalman)


def _steps(frequency: float, steps: Array) -> tuple[Array, Array, Array]:
    """F [N, n, 3, 3], q [N, n, 3, 3] and U [N, n, 3] of one axis over the steps [N, n] s."""
    step = steps.ravel()
    (phi0, phi1, phi2), q = cs_kalman.model(frequency, step)
    one, none = np.ones_like(step), np.zeros_like(step)
    move = np.stack([one, step, phi2, none, one, phi1, none, none, phi0], -1)
    drive = np.stack([0.5 * step * step - phi2, step - phi1, 1 - phi0], -1)
    noise = q.T.take([0, 1, 2, 1, 3, 4, 2, 4, 5], 1)
    return (
        move.reshape(*steps.shape, 3, 3),
        noise.reshape(*steps.shape, 3, 3),
        drive.reshape(*steps.shape, 3),
    )
