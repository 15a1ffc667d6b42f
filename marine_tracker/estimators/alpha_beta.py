"""Adaptive alpha-beta filter in polar coordinates, with Doppler (paper 002; HF surface-wave radar).

A plot has range R, bearing theta and, if the radar measures it, the radial speed v. T is the time
since the track's last plot. Between plots the radial speed and the bearing rate omega are constant.
Then each value moves by a share of its difference to the plot (eq 2 and 3):

    R = R_p + alpha_r (R_m - R_p)                   v = v_p + beta_v (v_m - v_p)
    theta = theta_p + alpha_a (theta_m - theta_p)   omega = omega_p + beta_w (theta_m - theta_p) / T

The modes differ in the shares (alpha_beta_gains.py). All start from two plots, which give the first
rates. Without Doppler v_m - v_p is (R_m - R_p) / T, with deviation sqrt 2 sigma_r / T. That is
noisy and no longer independent of the range, so the filter loses its advantage.

The state is position and velocity on the ground. Each plot is taken in the polar coordinates of the
antenna at the plot's time, so own ship may move. Radial speeds are over ground.

Departures: `hf_soft` keeps the ground velocity between plots, not radial speed and bearing rate. At
110 km both are the same for several plots. But for a target that crosses at 1 NM, the radial speed
changes from plot to plot by as much as its noise. The speed across is limited to max_speed, because
two plots at long range would give more. If plots of several radars follow each other within a
revolution, their share of the rates falls with the square of the step, as their information does.
"""

from typing import NamedTuple

import numpy as np

from ..gaussian.linear import sandwich
from ..geometry import to_range_bearing, wrap_angle
from ..types import Array, BoolArray, Extrapolation, IntArray, Plots, put, take
from .alpha_beta_gains import GAINS, WINDOW, Misfit
from .contract import Estimator, Velocity, first_velocity
from .polar_motion import NEAREST, axes, to_ground, to_polar

# White acceleration, m^2/s^3 each axis. It affects only the covariance, not the estimate.
NOISE = {'ship': 0.01, 'small_craft': 0.5}
SHORTEST = 0.5  # s; plots closer in time say little about rates
VAGUE = 100.0  # times the track's deviation; a plot with a larger one is ignored
HARMLESS = 0.125  # of the radial speed's deviation; a shift below this does not matter
UNKNOWN = 1e12  # m^2/s^2, variance of an unknown radial speed
RATES_LAST = np.array([0, 2, 1, 3])  # from polar order to values before rates, and back


class AlphaBetaState(NamedTuple):
    """N tracks.

    time        [N]        s
    mean        [N, 4]     east, north m, and their rates m/s
    covariance  [N, 4, 4]  of it
    origin      [N, 2]     m, the antenna when the last plot was taken
    since       [N]        s, time of the last plot that had information
    plots       [N]        number of such plots so far
    misfit      [N, 2]     m^2, rad^2: mean squared differences in range and bearing, recently
    """

    time: Array
    mean: Array
    covariance: Array
    origin: Array
    since: Array
    plots: Array
    misfit: Array


def alpha_beta(
    mode: str, max_speed: float, speed_sigma: float, noise: float, period: float = 0.0
) -> Estimator:
    """The filter in one of the modes of GAINS.

    max_speed    m/s, of the targets
    speed_sigma  m/s, deviation of a measured radial speed
    noise        m^2/s^3, white acceleration for the covariance
    period       s; plots closer in time, as those of several radars, count for the rates with the
                 square of their step
    """
    gains, straight, shortest = GAINS[mode], mode == 'hf_soft', max(period, SHORTEST)

    def init(plots: Plots, velocity: Velocity | None = None) -> AlphaBetaState:
        count = len(plots.time)
        known = np.full(count, 1.0 if velocity is None else 2.0)
        velocity = first_velocity(velocity, count, max_speed)
        mean = np.concatenate([plots.position, velocity.mean], 1)
        covariance = np.zeros((count, 4, 4))
        covariance[:, :2, :2], covariance[:, 2:, 2:] = plots.covariance, velocity.covariance
        _, _, range_sigma, bearing_sigma = _measured(plots)
        polar, by_mean = to_polar(mean, plots.origin)
        told, speed = _doppler(plots)
        off = np.where(told, speed - polar[:, 1], 0.0)
        noise_of = np.where(told, speed_sigma**2, UNKNOWN)
        along = by_mean[:, 1]  # of the radial speed, an update with it alone
        cross = np.matmul(covariance, along[..., None])[..., 0]
        gain = cross / ((along * cross).sum(1) + noise_of)[:, None]
        return AlphaBetaState(
            plots.time.copy(),
            mean + gain * off[:, None],
            covariance - gain[:, :, None] * cross[:, None],
            plots.origin.copy(),
            plots.time.copy(),
            known,
            2 * np.stack([range_sigma, bearing_sigma], -1) ** 2,
        )

    def extrapolate(state: AlphaBetaState, time: Array) -> Extrapolation:
        mean, covariance = _predict(state, time, noise, straight)
        return Extrapolation(time, mean[:, :2], mean[:, 2:], covariance)

    def update(state: AlphaBetaState, plots: Plots, rows: IntArray) -> AlphaBetaState:
        before = take(state, rows)
        mean, covariance = _predict(before, plots.time, noise, straight)
        polar, by_mean = to_polar(mean, plots.origin)
        spread = sandwich(by_mean, covariance)
        told, m = _misfit(plots, polar, before, speed_sigma)

        # Two plots give the first rates. From the third plot on the mode decides.
        alpha_r, beta_v, alpha_a, beta_w = (np.where(m.plots == 2, 1.0, gain) for gain in gains(m))
        # Plots with almost the same time would give a rate with unlimited noise.
        step = plots.time - before.since
        a_second = np.maximum(step, 0.0) / np.maximum(step, shortest) ** 2
        after = polar + np.stack(
            [
                alpha_r * m.range,
                beta_v * np.where(told, m.speed, m.range * a_second),
                alpha_a * m.bearing,
                beta_w * m.bearing * a_second,
            ],
            -1,
        )
        after[:, 0] = np.maximum(after[:, 0], NEAREST)
        fastest = max_speed / after[:, 0]
        after[:, 3] = np.clip(after[:, 3], -fastest, fastest)

        mean, by_polar = to_ground(after, plots.origin)
        covariance = sandwich(
            by_polar,
            _spread_after(
                spread, m, np.where(told, speed_sigma**2, UNKNOWN), told * m.speed, after - polar
            ),
        )
        vague = (m.range_sigma > VAGUE * np.sqrt(spread[:, 0, 0])) & (
            m.bearing_sigma > VAGUE * np.sqrt(spread[:, 2, 2])
        )
        return put(
            state,
            rows,
            AlphaBetaState(
                plots.time,
                mean,
                covariance,
                plots.origin,
                np.where(vague, before.since, plots.time),
                np.where(vague, before.plots, m.plots),
                np.where(vague[:, None], before.misfit, m.mean_square),
            ),
        )

    return Estimator(init, extrapolate, update)


def _predict(
    state: AlphaBetaState, time: Array, noise: float, straight: bool
) -> tuple[Array, Array]:
    """mean [N, 4] and covariance [N, 4, 4] on the ground at the times [N].

    The paper's targets keep radial speed and bearing rate. With `straight` they keep the ground
    velocity if the bearing rate is known well enough. On a straight course the square of the
    bearing rate gives radial acceleration, so its noise would spoil a radial speed known by
    Doppler.
    """
    step = time - state.time
    polar, by_mean = to_polar(state.mean, state.origin)
    spread = sandwich(by_mean, state.covariance)
    order = np.ix_(np.arange(len(step)), RATES_LAST, RATES_LAST)
    density = noise * np.stack([np.ones(len(step)), polar[:, 0] ** -2], -1)
    kept, moved = _moved(polar[:, RATES_LAST], spread[order], step, density)
    mean, by_polar = to_ground(kept[:, RATES_LAST], state.origin)
    if not straight:
        return mean, sandwich(by_polar, moved[order])
    ahead, covariance = _moved(state.mean, state.covariance, step, np.full((len(step), 2), noise))
    noise_of_speed = polar[:, 0] * spread[:, 3, 3] * np.abs(step)
    harm = noise_of_speed / (HARMLESS * np.sqrt(spread[:, 1, 1]))
    return mean + np.clip(2 - harm, 0.0, 1.0)[:, None] * (ahead - mean), covariance


def _moved(mean: Array, covariance: Array, step: Array, noise: Array) -> tuple[Array, Array]:
    """Two values, then their rates [K, 4], and the covariance after the steps [K] s.

    noise  [K, 2]  density of white noise in the rates
    """
    out = mean.copy()
    out[:, :2] += step[:, None] * mean[:, 2:]
    transition = np.tile(np.eye(4), (len(step), 1, 1))
    transition[:, [0, 1], [2, 3]] = step[:, None]
    spread = sandwich(transition, covariance)
    size = np.abs(step)[:, None]
    spread[:, [0, 1], [0, 1]] += noise * size**3 / 3
    spread[:, [2, 3], [2, 3]] += noise * size
    spread[:, [0, 1, 2, 3], [2, 3, 0, 1]] += np.tile(noise * size**2 / 2, 2)
    return out, spread


def _measured(plots: Plots) -> tuple[Array, Array, Array, Array]:
    """Range m and bearing rad of the plots [K], and the standard deviations of both."""
    distance, bearing = to_range_bearing(plots.position - plots.origin)
    range_sigma, across_sigma = (
        np.sqrt(np.einsum('ni,nij,nj->n', side, plots.covariance, side)) for side in axes(bearing)
    )
    return distance, bearing, range_sigma, across_sigma / np.maximum(distance, NEAREST)


def _doppler(plots: Plots) -> tuple[BoolArray, Array]:
    """Which plots [K] have a radial speed, and the radial speeds m/s, 0 where there is none."""
    if plots.radial_speed is None:
        return np.zeros(len(plots.time), bool), np.zeros(len(plots.time))
    told = np.isfinite(plots.radial_speed)
    return told, np.where(told, plots.radial_speed, 0.0)


def _misfit(
    plots: Plots, polar: Array, before: AlphaBetaState, speed_sigma: float
) -> tuple[BoolArray, Misfit]:
    """Which plots have a radial speed, and the Misfit of all to the expectation, polar [K, 4]."""
    distance, bearing, range_sigma, bearing_sigma = _measured(plots)
    told, speed = _doppler(plots)
    off_range = distance - polar[:, 0]
    off_bearing = wrap_angle(bearing - polar[:, 2])
    count = before.plots + 1
    square = np.stack([off_range, off_bearing], -1) ** 2
    mean_square = before.misfit + (square - before.misfit) / np.minimum(count, WINDOW)[:, None]
    # Without Doppler both are T times a speed. Only their ratio counts, and T cancels in it.
    return told, Misfit(
        off_range,
        np.where(told, speed - polar[:, 1], off_range),
        off_bearing,
        range_sigma,
        np.where(told, speed_sigma, np.sqrt(2) * range_sigma),
        bearing_sigma,
        count,
        mean_square,
    )


def _spread_after(
    spread: Array, m: Misfit, speed_variance: Array, off_speed: Array, shift: Array
) -> Array:
    """Covariance [K, 4, 4] in polar order after the shifts [K, 4], which are not Kalman's.

    Before the plot the error has covariance P. Given the plot's difference d, its mean is -K d and
    its covariance is P - K S K' (Kalman). The filter adds its own shift g. So its mean square is P
    - K S K' + (g - K d)(g - K d)', for any shift.
    """
    noise = np.zeros((len(shift), 3, 3))
    noise[:, 0, 0], noise[:, 1, 1] = m.range_sigma**2, speed_variance
    noise[:, 2, 2] = m.bearing_sigma**2
    off = np.stack([m.range, off_speed, m.bearing], -1)
    cross = spread[:, :3]
    gain = np.matmul(np.linalg.inv(cross[:, :, :3] + noise), cross)  # K'
    apart = shift - np.matmul(off[:, None], gain)[:, 0]
    out = spread - np.matmul(gain.swapaxes(1, 2), cross) + apart[:, :, None] * apart[:, None, :]
    found: Array = 0.5 * (out + out.swapaxes(1, 2))
    return found
