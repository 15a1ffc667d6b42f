"""The paper's own form of the wavelet network on the paper's own tracks (paper 000).

22 rpm; the target starts at 4.6 km, 30 deg, on course 70 deg at 9.26 + 1.03 sin(2 pi t / 1000)
m/s. If it turns, it turns through 50 deg on a radius of 200 m at scan 500. Networks of many seeds
learn side by side; a figure is the median over the seeds. The paper gives only the speed, so units
and network sizes are those of `estimators.gwnn_paper`. Each plot corrects the weights once, since
the paper's figures count iterations. `LOOP` corrects until E_R <= E1, as the paper's algorithm
says; only `LOOP` changes the step by eq 10.
"""

from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from ...estimators.gwnn.gwnn_paper import (
    LEVELS,
    POSITION_UNIT,
    TRANSLATIONS,
    WIDTH,
    difference,
    network_inputs,
    output_unit,
)
from ...evaluation.result import Progress, silent
from ...networks import backpropagation as net
from ...networks import wavelets
from ...simulation import motion
from ...types import Array, IntArray
from .frame import spectrum

PERIOD = 60 / 22  # s
START = 4600 * np.array([np.sin(np.radians(30)), np.cos(np.radians(30))])
COURSE, SPEED, WAVE = np.radians(70), 9.26, motion.Wave(1.03, 1000.0)
TURN, TURN_RADIUS, TURN_AT = np.radians(50), 200.0, 500  # rad, m, scan
NEAR, FAR = 1.852, 9.26  # E1, E2, m
NOISE_MEAN, NOISE_SIGMA = 0.5, 0.3  # m, of Fig 4
RADAR_SIGMA = 15.0  # m, along and across, of a real radar at 2 km
NOISY_WINDOW = 10  # scans over which speed and course are taken
STEADY = 100  # last scans of a run, over which errors are RMS

GWNN = net.gwnn(4, 4, LEVELS, TRANSLATIONS, WIDTH)
BP = net.bp(4, 4, GWNN.groups * GWNN.group, WIDTH)
EQUAL = net.Rule(step=0.02, variable=False)
VARIABLE = net.Rule(step=0.1)
STRONG = VARIABLE._replace(step=0.5)
LOOP = VARIABLE._replace(rounds=10)
LEARNERS = {
    'BP, equal step': (BP, EQUAL),
    'BP, variable step': (BP, VARIABLE),
    'GWNN, equal step': (GWNN, EQUAL),
    'GWNN, variable step': (GWNN, VARIABLE),
    'BP, to E1 in each scan': (BP, LOOP),
    'GWNN, to E1 in each scan': (GWNN, LOOP),
}
TURNERS = {
    'BP, eta .1': (BP, VARIABLE),
    'GWNN, eta .1': (GWNN, VARIABLE),
    'BP, eta .5': (BP, STRONG),
    'GWNN, eta .5': (GWNN, STRONG),
    'BP, to E1 in each scan': (BP, LOOP),
    'GWNN, to E1 in each scan': (GWNN, LOOP),
}


def track(
    scans: int, speed: float = SPEED, wave: motion.Wave | None = WAVE, turn_at: int | None = None
) -> Array:
    """z [scans, 4]: range m, bearing rad, speed m/s, course rad of the paper's target."""
    legs = (
        ()
        if turn_at is None
        else (motion.Straight(turn_at * PERIOD), motion.Turn(TURN, radius=TURN_RADIUS))
    )
    paths = motion.table([motion.sail(START, COURSE, speed, legs, wave)], scans * PERIOD)
    position, velocity = motion.locate_ships(paths, np.zeros(scans, int), np.arange(scans) * PERIOD)
    return to_z(position, velocity)


def to_z(position: Array, velocity: Array) -> Array:
    """z [..., 4] of positions and velocities [..., 2]."""
    return np.stack(
        [
            np.hypot(*np.moveaxis(position, -1, 0)),
            np.arctan2(position[..., 0], position[..., 1]),
            np.hypot(*np.moveaxis(velocity, -1, 0)),
            np.arctan2(velocity[..., 0], velocity[..., 1]),
        ],
        -1,
    )


def noisy(
    truth: Array,
    runs: int,
    rng: np.random.Generator,
    mean: float = NOISE_MEAN,
    sigma: float = NOISE_SIGMA,
) -> Array:
    """The track [N, 4] as seen with N(mean, sigma) m on range and across, [runs, N, 4].

    The paper does not give the noise of speed and course. A radar computes them from positions.
    Here they are the difference over ten scans; in the first ten scans they are the truth.
    """

    def draw():
        return rng.normal(mean, sigma, (runs, len(truth)))

    distance = truth[:, 0] + draw()
    bearing = truth[:, 1] + draw() / truth[:, 0]
    position = distance[..., None] * np.stack([np.sin(bearing), np.cos(bearing)], -1)
    w = NOISY_WINDOW
    velocity = (position[:, w:] - position[:, :-w]) / (w * PERIOD)
    seen = np.tile(truth, (runs, 1, 1))
    seen[:, :, 0], seen[:, :, 1] = distance, bearing
    seen[:, w:, 2:] = to_z(position[:, w:], velocity)[..., 2:]
    return seen


def predict(design: net.Design, rule: net.Rule, seen: Array, rng: np.random.Generator) -> Array:
    """Prediction one scan ahead of each plot [B, N, 4], learning on line; nan for the first two
    plots.
    """
    count, scans, _ = seen.shape
    weights = net.draw(design, count, rng)
    centre = seen[:, 0]
    ahead = np.full_like(seen, np.nan)
    for k in range(1, scans - 1):
        before, now = seen[:, k - 1], seen[:, k]
        wanted = difference(now, before) / output_unit(before)
        weights = net.learn(
            design,
            weights,
            network_inputs(before, centre),
            wanted,
            now[:, 2],
            rule,
            POSITION_UNIT,
            NEAR,
            FAR,
        )
        output = net.forward(design, weights, network_inputs(now, centre)).output
        ahead[:, k + 1] = now + output_unit(now) * output
    return ahead


def two_point(z: Array) -> Array:
    """Prediction [N, 4] by the straight line through the last two plots of a track [N, 4]."""
    position = z[:, :1] * np.stack([np.sin(z[:, 1]), np.cos(z[:, 1])], 1)
    ahead = np.full_like(z, np.nan)
    ahead[2:, :2] = to_z(2 * position[1:-1] - position[:-2], np.zeros((len(z) - 2, 2)))[:, :2]
    return ahead


def radial_error(ahead: Array, truth: Array) -> Array:
    """E_R [..., N] m."""
    return np.hypot(ahead[..., 0] - truth[..., 0], truth[..., 0] * (ahead[..., 1] - truth[..., 1]))


def plots_to_converge(error: Array, over: int = 10) -> IntArray:
    """Plots learnt from [B] until errors [B, N] are RMS at most E1 over ten scans; N if never.

    Column j of the errors is the error after j + 1 plots.
    """
    sums = np.concatenate([np.zeros((len(error), 1)), np.cumsum(np.square(error), 1)], 1)
    good = sums[:, over:] - sums[:, :-over] <= over * NEAR**2
    return np.where(good.any(1), np.argmax(good, 1) + 1, error.shape[1])


def rms(values: Array, axis: int | None = None) -> Array:
    """Root mean square, ignoring nan."""
    return np.sqrt(np.nanmean(np.square(values), axis))


class Study(NamedTuple):
    """The data of all figures and pictures. Errors are medians over the seeds.

    speeds [S] m/s, range_error m and bearing_error deg [S]: steady, RMS (Fig 1)
    learning, plots  by learner: E_R [N] m after 1, 2, ... plots; plots to converge [runs]
                (Fig 2, 3)
    noise       [N, 4] absolute errors m, deg, m/s, deg under noise (Fig 4)
    noise_rms   RMS of E_R m, speed m/s and course deg, last scans
    real_noise  RMS of E_R m at a radar's noise, and RMS of the plots themselves
    turning, peak  by learner: E_R [N] m around the turn, and its maximum m (Fig 5)
    ratio, steep  1/q and 2q max|psi'|; crossing: 1/q at which that is 1 (eq 20-22)
    broken      by 1/q: shares in which the GWNN's norm, and its gradient, is not the smaller one
    bands       by q: lowest and highest frequency at which psi's spectrum is half its peak
    """

    speeds: Array
    range_error: Array
    bearing_error: Array
    learning: dict[str, Any]
    plots: dict[str, Any]
    noise: Array
    noise_rms: tuple[float, float, float]
    real_noise: tuple[float, float]
    turning: dict[str, Any]
    peak: dict[str, float]
    ratio: Array
    steep: Array
    crossing: float
    broken: dict[float, tuple[float, float]]
    bands: dict[float, tuple[float, float]]


def study(runs: int, seed: int, progress: Progress = silent) -> Study:
    """Every experiment with `runs` seeds; about 10 s for 40."""
    parts = 5
    progress(0, parts)
    ratio = np.linspace(0.05, 1.5, 59)
    steep = np.array([wavelets.steepest(1 / r) * 2 / r for r in ratio])
    crossing = brentq(lambda r: wavelets.steepest(1 / r) * 2 / r - 1, 0.5, 1.5)
    rng = np.random.default_rng(seed)
    speeds, along, bearing = steady(runs, rng)
    progress(1, parts)
    learnt, plots = learning(runs, rng)
    progress(2, parts)
    noise, noise_rms, real_noise = under_noise(runs, rng)
    progress(3, parts)
    turned, peak = turning(runs, rng)
    progress(4, parts)
    of_units = {r: broken(1 / r, rng) for r in (0.6, 0.8, 0.9)}
    progress(5, parts)
    return Study(
        speeds,
        along,
        bearing,
        learnt,
        plots,
        noise,
        noise_rms,
        real_noise,
        turned,
        peak,
        ratio,
        steep,
        float(crossing),
        of_units,
        {q: half_band(q) for q in (0.5, WIDTH, 2.0)},
    )


def steady(runs: int, rng: np.random.Generator, scans: int = 400) -> tuple[Array, Array, Array]:
    """Fig 1: speeds, range and bearing errors."""
    speeds = np.arange(2.0, 20.5, 2.0)
    truth = np.repeat([track(scans, speed, None) for speed in speeds], runs, 0)
    off = (predict(GWNN, VARIABLE, truth, rng) - truth)[:, -STEADY:]
    off = np.median(rms(off, 1).reshape(len(speeds), runs, 4), 1)
    return speeds, off[:, 0], np.degrees(off[:, 1])


def learning(
    runs: int, rng: np.random.Generator, scans: int = 500
) -> tuple[dict[str, Array], dict[str, IntArray]]:
    """Fig 2 and 3: error curves of the learners, and the number of plots until they converge."""
    truth = np.repeat(track(scans)[None], runs, 0)
    error = {
        name: radial_error(predict(design, rule, truth, rng), truth)[:, 2:]
        for name, (design, rule) in LEARNERS.items()
    }
    return (
        {name: np.median(e, 0) for name, e in error.items()},
        {name: plots_to_converge(e) for name, e in error.items()},
    )


def under_noise(
    runs: int, rng: np.random.Generator, scans: int = 500
) -> tuple[Array, tuple[float, float, float], tuple[float, float]]:
    """Fig 4: errors of all four outputs against the truth; and at the noise of a real radar."""
    truth = track(scans)
    ahead = predict(GWNN, VARIABLE, noisy(truth, runs, rng), rng)
    off = ahead - truth
    off[..., [1, 3]] = np.degrees(off[..., [1, 3]])
    late = off[:, -STEADY:]
    seen = noisy(truth, runs, rng, 0.0, RADAR_SIGMA)
    real = predict(GWNN, VARIABLE, seen, rng)
    radial = [float(rms(radial_error(z, truth)[:, -STEADY:])) for z in (ahead, real, seen)]
    return (
        np.median(np.abs(off), 0),
        (radial[0], float(rms(late[..., 2])), float(rms(late[..., 3]))),
        (radial[1], radial[2]),
    )


def turning(runs: int, rng: np.random.Generator) -> tuple[dict[str, Array], dict[str, float]]:
    """Fig 5: errors and peaks around the sharp turn, and those of the two-point line."""
    truth = track(TURN_AT + 40, turn_at=TURN_AT)
    around = slice(TURN_AT - 10, TURN_AT + 40)
    every = np.repeat(truth[None], runs, 0)
    error = {
        name: radial_error(predict(design, rule, every, rng), every)[:, around]
        for name, (design, rule) in TURNERS.items()
    }
    error['line through two plots'] = radial_error(two_point(truth), truth)[None, around]
    return (
        {name: np.median(e, 0) for name, e in error.items()},
        {name: float(np.median(e.max(1))) for name, e in error.items()},
    )


def broken(width: float, rng: np.random.Generator, tries: int = 20000) -> tuple[float, float]:
    """Shares of random inputs at which the inequalities behind eq 22 fail.

    Norm: |D| of a group of wavelet units against that of as many units S, all at one net input,
    drawn evenly from -5 to 5. Gradient: |dE/de0| of random networks with inputs drawn evenly from
    -6 to 6 and equal output errors. The GWNN is connected locally, the BP network fully.
    """
    common = rng.uniform(-5, 5, (tries, 1))
    form = wavelets.units(LEVELS, TRANSLATIONS, width)
    across = np.broadcast_to(common, (tries, len(form.shift)))
    ours = np.sum(wavelets.slope(form, *wavelets.hidden(form, across)) ** 2, 1)
    theirs = np.sum(wavelets.sigmoid_slope(across, width) ** 2, 1)
    tries //= 5
    inputs, error = rng.uniform(-6, 6, (tries, 4)), rng.normal(size=(tries, 4))
    gradient = []
    for design in (net.gwnn(4, 4, LEVELS, TRANSLATIONS, width), net.bp(4, 4, BP.group, width)):
        weights = net.draw(design, tries, rng)
        gradient.append(np.linalg.norm(net.input_gradient(design, weights, inputs, error), axis=1))
    return float(np.mean(ours >= theirs)), float(np.mean(gradient[0] >= gradient[1]))


def half_band(width: float) -> tuple[float, float]:
    """Lowest and highest frequency, rad, at which psi's spectrum reaches half its peak."""
    w = np.linspace(0.001, np.pi, 20001)
    size = np.abs(spectrum(w, width))
    inside = w[size >= 0.5 * size.max()]
    return float(inside[0]), float(inside[-1])
