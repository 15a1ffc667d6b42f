"""The inputs of the network of `gwnn`: how a track's filters disagree, and how plots fit them.

All inputs are in the line of sight of the last plot, [along, across]. Positions are in the plot's
deviations sigma, and velocities in sigma / (4 scans), so near and far targets look alike. Turning
or mirroring the scene permutes the inputs and changes signs; `KINDS` says how.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...gaussian import linear_modes
from ...types import Array, BoolArray, Plots
from . import bank as filters
from .bank_settings import PERIOD

SCAN = PERIOD  # s; the unit of time of every input, for any period of the radar
VELOCITY = 4 * SCAN  # s
VAGUER = 1.5  # times; sigma grows by no more from plot to plot: a plot shared
# by several targets may be as vague as it likes
TELLS = 100.0  # times; a plot still vaguer is no plot to count
FARTHEST = 25.0  # sigma; larger distances of experts from the base are cut to this
MEMORIES = (2.0, 5.0, 12.0)  # plots over which the base's innovations are averaged
LEGS_KEEP = (0.6, 0.85)  # share of the legs' mean innovations that is kept at a plot
NIS_KEEP = (0.8, 0.95)
WORST = 25.0  # largest squared residual that counts
DETAIL_KEEP = 0.96
DETAIL_SCALE = float(np.sqrt(np.pi / 2))  # makes the mean size of a unit normal 1
TRENDS = len(MEMORIES) + len(LEGS_KEEP) * 4
# Experts whose residuals are kept in addition to the base's.
JUDGED = (4, 7, filters.CS, filters.SECOND_IMM)
LEGS_TELL = 8  # what the legs say of themselves: `_legs`
LONE = (0, 1, 4, 7, 8, 9, 10, 11, 12)  # experts without a mirror image

# How each block of inputs changes with the axes: vector; vector that also changes sign when the
# picture is mirrored; pair without signs; number; number that changes sign when mirrored.
V, PV, E, S, P = 'vector', 'pseudovector', 'even pair', 'scalar', 'pseudoscalar'
_LEGS = range(filters.LEG_EXPERTS.start, filters.LEG_EXPERTS.stop)
_BLOCKS = (
    [(V, expert in _LEGS) for expert in LONE for _ in range(2)]
    + [(kind, False) for kind in (V, PV) * 4]
    + [(kind, False) for kind in (S, S, S, P) + (S, S, S) + (S, P) * 3 + (S, S, S, P)]
    + [(S, True)] * LEGS_TELL
    + [(E, False)] * 3
    + [(E, True)] * 2
    + [(V, trend >= len(MEMORIES)) for trend in range(TRENDS)]
    + [(S, False)] * 2
    + [(S, expert in _LEGS) for _ in NIS_KEEP for expert in (None, *JUDGED)]
    + [(kind, False) for kind in (E, V, E, V) + (S,) * 3]
)
KINDS = tuple(kind for kind, _ in _BLOCKS)
COUNT = sum(1 if kind in (S, P) else 2 for kind in KINDS)
# [COUNT] whether an input tells of the legs.
OF_LEGS = np.array([legs for kind, legs in _BLOCKS for _ in range(1 if kind in (S, P) else 2)])
_KEEP = np.array([1 - 1 / m for m in MEMORIES] + [keep for keep in LEGS_KEEP for _ in range(4)])


class ResidualMemory(NamedTuple):
    """What is kept of the plots beside the filters.

    frame     [N, 4]      unit vector east and north to the last plot; its sigma along, across, m
    trend     [N, 11, 2]  averaged innovations, sigma: the base's, then the legs'
    nis       [N, 2]      averaged squared distances of the plots from the base
    fit       [N, 2, 5]   averaged squared residuals, sigma^2, of the base and the experts JUDGED
    detail    [N, 2]      deviation of the plots as their own differences tell it, over the
                          stated one: level 1 of a Haar decomposition of the innovations
    last      [N, 2]      innovation of the last plot, sigma
    used      [N]         1 where the filters took the last plot, 0 where they refused it
    refused   [N]         plots refused in a row
    step      [N]         s, from the last plot taken to the one before
    plots     [N]         plots so far that told something
    """

    frame: Array
    trend: Array
    nis: Array
    fit: Array
    detail: Array
    last: Array
    used: Array
    refused: Array
    step: Array
    plots: Array


def begin(plots: Plots) -> ResidualMemory:
    """Memories of one plot each."""
    count = len(plots.time)
    zero, pair = np.zeros(count), np.zeros((count, 2))
    return ResidualMemory(
        frame_of(plots),
        np.zeros((count, TRENDS, 2)),
        pair,
        np.full((count, 2, 1 + len(JUDGED)), 2.0),
        pair + 1,
        pair.copy(),
        zero,
        zero.copy(),
        zero + SCAN,
        zero + 1,
    )


def frame_of(plots: Plots) -> Array:
    """The line of sight [N, 4] of plots: unit vector, sigma along and across it, m."""
    offset = plots.position - plots.origin
    distance = np.hypot(offset[:, 0], offset[:, 1])
    east, north = (offset / np.maximum(distance, 1e-9)[:, None]).T
    spread = _along_across(np.stack([east, north], 1), linear_modes.packed_noise(plots.covariance))
    return np.column_stack([east, north, *np.sqrt(spread)])


def turn(frame: Array, vectors: Array) -> Array:
    """Vectors [2, ..., N] turned into the line of sight [along, across], or back again."""
    east, north = frame[:, 0], frame[:, 1]
    out = np.empty(vectors.shape)
    out[0] = vectors[0] * east + vectors[1] * north
    out[1] = vectors[0] * north - vectors[1] * east
    return out


def to_sigma(frame: Array, states: Array) -> Array:
    """States [4, ..., N], m and m/s, in the units of the network."""
    sigma = frame[:, 2:].T.reshape((2,) + (1,) * (states.ndim - 2) + (-1,))
    return np.concatenate(
        [turn(frame, states[:2]) / sigma, turn(frame, states[2:]) * (VELOCITY / sigma)]
    )


def from_sigma(frame: Array, states: Array) -> Array:
    """The way back from `to_sigma`, for states [4, N]."""
    sigma = frame[:, 2:].T
    return np.concatenate(
        [turn(frame, states[:2] * sigma), turn(frame, states[2:] * sigma / VELOCITY)]
    )


def apart(frame: Array, ahead: filters.Ahead) -> Array:
    """How far the experts are from the base [4, 13, N], in the units of the network."""
    off = to_sigma(frame, ahead.experts - ahead.mean[:, None])
    return np.minimum(np.maximum(off, -FARTHEST), FARTHEST)


def variances(frame: Array, covariance: Array) -> Array:
    """Variances [4, N] of covariances [N, 4, 4], in the units of the network."""
    sigma = frame[:, 2:].T
    return np.concatenate(
        [
            _along_across(frame, linear_modes.packed_noise(covariance[:, at, at])) / (unit * unit)
            for at, unit in ((slice(0, 2), sigma), (slice(2, 4), sigma / VELOCITY))
        ]
    )


def remember(
    memory: ResidualMemory, expected: filters.Expected, plots: Plots, step: Array, used: BoolArray
) -> ResidualMemory:
    """Memories after one plot each, which the filters took where `used` [N] holds."""
    frame = frame_of(plots)
    tells = (frame[:, 2:] < TELLS * memory.frame[:, 2:]).all(1)
    frame[:, 2:] = np.minimum(frame[:, 2:], VAGUER * memory.frame[:, 2:])
    sigma = frame[:, 2:].T
    off = turn(frame, plots.position.T - expected.ahead.mean[:2]) / sigma  # [2, N]
    legs = expected.ahead.experts[:2, filters.LEG_EXPERTS]
    slow = turn(frame, plots.position.T[:, None] - legs) / sigma[:, None]  # [2, 4, N]
    new = np.concatenate(
        [np.repeat(off[:, None], len(MEMORIES), 1)] + [slow] * len(LEGS_KEEP), 1
    ).transpose(2, 1, 0)
    keep = _KEEP[:, None]
    trend = keep * memory.trend + (1 - keep) * np.minimum(np.maximum(new, -8.0), 8.0)
    judged = (
        turn(frame, plots.position.T[:, None] - expected.ahead.experts[:2, JUDGED]) / sigma[:, None]
    )  # [2, 3, N]
    square = np.concatenate([(off * off).sum(0)[None], (judged * judged).sum(0)]).T[:, None]
    keep = np.array(NIS_KEEP)[:, None]
    fit = keep * memory.fit + (1 - keep) * np.minimum(square, WORST)
    off = off.T
    nis = (
        np.array(NIS_KEEP) * memory.nis
        + (1 - np.array(NIS_KEEP)) * np.minimum(expected.nis, WORST)[:, None]
    )
    differ = DETAIL_SCALE * np.minimum(np.abs(off - memory.last) / np.sqrt(2), 4.0)
    both = (used & (memory.used > 0))[:, None]
    detail = np.where(both, DETAIL_KEEP * memory.detail + (1 - DETAIL_KEEP) * differ, memory.detail)
    taken = used[:, None]
    return ResidualMemory(
        frame,
        np.where(taken[..., None], trend, memory.trend),
        nis,
        fit,
        detail,
        np.where(taken, off, memory.last),
        used.astype(float),
        np.where(used, 0.0, memory.refused + 1),
        step,
        memory.plots + tells,
    )


def inputs(
    bank: filters.Filters, state: filters.BankState, memory: ResidualMemory, period: float
) -> NDArray[np.float32]:
    """The network's inputs [N, COUNT] after a plot; period s of the radar (or [N]).

    They are float32, as the weights: it takes half the time.
    """
    frame, sigma = memory.frame, memory.frame[:, 2:].T
    ahead = filters.look(bank, state, np.atleast_1d(np.asarray(period, float)))
    off, weight = apart(frame, ahead), ahead.weight
    blocks = [np.arcsinh(off[:, LONE]).transpose(1, 0, 2).reshape(4 * len(LONE), -1)]
    for right, left in filters.TURNS:
        both = np.arcsinh(off[:, right] + off[:, left])
        differ = np.arcsinh(off[:, right] - off[:, left])
        blocks += [both[:2], differ[:2], both[2:], differ[2:]]
    blocks.append(_modes(weight[filters.BASE], 2))
    blocks.append(_modes(weight[filters.RICH], 3))
    blocks.append(_modes(weight[filters.SECOND], 2))

    blocks.append(_legs(state))
    columns = linear_modes.columns_of(state.rows[:, : filters.RICH.stop])
    posterior = state.weight.T
    base = linear_modes.combine(columns[:, filters.BASE], posterior[filters.BASE])
    rich = linear_modes.combine(columns[:, filters.RICH], posterior[filters.RICH])
    legs = state.likely.T
    for spread, unit in (
        (base[[4, 5, 8]], sigma),
        (base[[11, 12, 13]], sigma / VELOCITY),
        (rich[[4, 5, 8]], sigma),
        (legs[[4, 5, 8]], sigma),
        (legs[[11, 12, 13]], sigma / VELOCITY),
    ):
        blocks.append(0.5 * np.log(_along_across(frame, spread) / (unit * unit) + 1e-6))
    blocks.append(np.arcsinh(memory.trend).transpose(1, 2, 0).reshape(2 * TRENDS, -1))
    blocks.append(np.log(memory.nis + 0.1).T)
    fit = np.log(memory.fit + 0.1)
    fit[..., 1:] -= fit[..., :1]  # better or worse than the base
    blocks.append(fit.reshape(len(fit), -1).T)
    blocks.append(np.log(memory.detail + 0.05).T)
    blocks.append(np.arcsinh(turn(frame, ahead.mean[2:]) * (SCAN / sigma)))
    blocks.append(np.log(sigma / 25))
    blocks.append(np.arcsinh(turn(frame, ahead.acceleration) * (4 * SCAN**2 / sigma)))
    blocks.append(
        np.stack(
            [memory.step / SCAN - 1, np.full(len(frame), period) / SCAN - 1, 10 / memory.plots]
        )
    )
    found: NDArray[np.float32] = np.concatenate(blocks).T.astype(np.float32, 'C')
    return found


def _modes(weight: Array, straight: int) -> Array:
    """Logarithms of mode probabilities [J, N], and by how much right turns exceed left ones.

    The first `straight` modes go straight, the others turn right and left by turns.
    """
    blocks = [np.log(weight[:straight] + 1e-4)]
    for k in range(straight, len(weight), 2):
        right, left = weight[k], weight[k + 1]
        blocks.append(np.stack([np.log(right + left + 1e-4), right - left]))
    return np.concatenate(blocks)


def _legs(state: filters.BankState) -> Array:
    """What the legs say of themselves [LEGS_TELL, N].

    The logarithms of: the probability of a manoeuvre; that of each leg, the one that began first
    first; the mean age of the legs in scans; that of the likeliest leg; the changes believed in
    lately.
    """
    weight, begun = state.legs.weight, state.legs.begun
    legs = weight[:, 1:]
    order = np.argsort(np.where(legs > 1e-9, begun, np.inf), 1)
    age = (state.time[:, None] - begun) / SCAN
    mean = (legs * age).sum(1) / legs.sum(1)
    likeliest = np.take_along_axis(age, legs.argmax(1)[:, None], 1)[:, 0]
    return np.concatenate(
        [
            np.log(weight[:, :1] + 1e-4).T,
            np.log(np.take_along_axis(legs, order, 1) + 1e-4).T,
            np.log1p(np.maximum(np.stack([mean, likeliest, state.changes]), 0.0)),
        ]
    )


def _along_across(frame: Array, spread: Array) -> Array:
    """Variances [2, N] along and across the line of sight, of ee, en, nn [3, N]."""
    east, north = frame[:, 0], frame[:, 1]
    ee, en, nn = spread
    return np.stack(
        [
            ee * east * east + 2 * en * east * north + nn * north * north,
            ee * north * north - 2 * en * east * north + nn * east * east,
        ]
    )
