"""Extrapolation by a generalised wavelet network over a bank of filters (after paper 000).

Thirteen filters follow every track (`bank`). After each plot a trained wavelet network looks at how
they disagree and how the plots fit them. It outputs a weight for each filter, and a correction for
the errors that all of them share:

    x(t) = base(t) + sum_j w_j (expert_j(t) - base(t)) + c(t),   w = softmax(l + network)

with l the log mode probabilities of the base IMM. The network never feeds back into the filters, so
a track can do without it at any time. This happens, track by track, when its expectations fit the
plots worse than CS-Kalman's, or when an output is not a number (see `monitor`).
"""

from typing import NamedTuple

import numpy as np

from ...gaussian import linear_modes
from ...gaussian.linear import sandwich
from ...networks import gwnn_weights
from ...networks.wavelet_network import forward
from ...types import Array, Extrapolation, IntArray, Plots, Rows, put, take, where
from .. import cs_kalman
from ..contract import Account, Estimator, Velocity
from . import adaptation, inputs
from . import bank as filters
from . import monitor as monitors
from .bank import BankState, Expected
from .inputs import ResidualMemory
from .monitor import FALLBACK, GWNN, TRUST, WARM, Monitor, Trust, judge

GATE, REFUSALS = 16.0, 2  # squared distance from the base; largest number of plots refused in a row
SETTLED = 10  # plots before any is refused
FADE = 3.0  # scans ahead up to which the network is used
MOST = 4.0  # largest correction by the network; when trained, it uses less than half
MISSED, SURE = 1.5, 1.0  # scans without a plot; sigma: limit of the correction after that
OTHERS = -5.0  # log weight of all experts except the base's modes, for network output 0

# The network's outputs: changes of the experts' log weights; corrections of the position now and
# per scan ahead, and of the velocity; in the units of `inputs`.
LOGITS = slice(0, filters.EXPERTS)
AT_ONCE, PER_SCAN, OF_VELOCITY = slice(13, 15), slice(15, 17), slice(17, 19)
POSITION = slice(13, 17)
OUTPUTS = 19
SPREADS = 8  # log ratio of the variances to the base's: now, a scan ahead
OF_POSITION = [0, 1, 4, 5]  # of these


class GwnnState(NamedTuple):
    """bank, memory, monitor; output [N, 27]: of the network after the last plot; adapted: what the
    track has learned.
    """

    bank: filters.BankState
    memory: inputs.ResidualMemory
    monitor: Monitor
    output: Array
    adapted: adaptation.Adapted


def account(state: GwnnState) -> Account:
    """Why each track is extrapolated as it is."""
    return monitors.account(state.monitor)


class Look(NamedTuple):
    """The filters at some time, in the form that the network's output refers to.

    apart       [4, 13, N]  experts relative to the base, in the units of `inputs`
    log_weight  [13, N]     weights of the experts for network output 0
    scans       [N]         ahead of the last plot
    """

    apart: Array
    log_weight: Array
    scans: Array


def look(state: filters.BankState, frame: Array, ahead: filters.Ahead, time: Array) -> Look:
    """The filters at the times [N] s, in the form that the network's output refers to."""
    log_weight = np.full((filters.EXPERTS, len(frame)), OTHERS)
    log_weight[:4] = np.log(ahead.weight[filters.BASE] + 1e-4)
    scans = (time - state.time) / inputs.SCAN
    return Look(inputs.apart(frame, ahead), log_weight, np.clip(scans, 0.0, FADE))


def fuse(output: Array, at: Look) -> Array:
    """The network's correction [4, N] of the base, from its outputs [N, 19 or more]."""
    output = output.T
    weight = at.log_weight + output[LOGITS]
    weight = np.exp(weight - weight.max(0))
    weight /= weight.sum(0)
    out = (at.apart * weight).sum(1)
    out[:2] += output[AT_ONCE] + at.scans * output[PER_SCAN]
    out[2:] += output[OF_VELOCITY]
    found: Array = out
    return found


def correct(state: GwnnState, at: Look) -> Array:
    """The correction [4, N] of the base, in the units of `inputs`, including what the tracks have
    learned.
    """
    shift = fuse(state.output, at)
    shift[:2] += adaptation.correction(state.adapted, at.scans)
    return shift


def flaw(output: Array) -> Array:
    """What is wrong with outputs [N, 27]: index into REASONS, 0 for nothing."""
    alone = np.abs(output[:, AT_ONCE.start : OF_VELOCITY.stop]).max(1)
    return np.where(~np.isfinite(output).all(1), 2.0, np.where(alone > MOST, 3.0, 0.0))


def advance(
    bank: filters.Filters, state: filters.BankState, memory: inputs.ResidualMemory, plots: Plots
) -> tuple[BankState, ResidualMemory, Expected]:
    """States and memories of N rows after one plot each, and what the filters had expected.

    A plot far from a settled track is refused by all filters alike, at most REFUSALS times in a
    row.
    """
    expected = filters.expect(bank, state, plots)
    used = ~((expected.nis > GATE) & (memory.refused < REFUSALS) & (memory.plots >= SETTLED))
    after = filters.correct(bank, state, expected, plots)
    if not used.all():
        after = where(used, after, state)
    memory = inputs.remember(memory, expected, plots, plots.time - state.time, used)
    return after, memory, expected


def weights(path: str = '', vessel_class: str = 'ship') -> gwnn_weights.Weights:
    """Trained weights from a file, or the shipped ones. ValueError if the file does not fit."""
    file = path or gwnn_weights.shipped(vessel_class)
    found = gwnn_weights.load(file, inputs.COUNT, {'fusion': OUTPUTS, 'spread': SPREADS})
    theirs = found.manifest.get('vessel_class', 'unknown'), found.manifest.get('filters', 'unknown')
    ours = vessel_class, filters.BANKS[vessel_class].mark
    if theirs[1] != ours[1]:
        raise ValueError(
            f'GWNN weights {file} were trained over the filters of vessel class {theirs[0]} '
            f'(settings {theirs[1]}), not those of {ours[0]} (settings {ours[1]}): train again '
            f'with --vessel-class {vessel_class}'
        )
    return found


def gwnn(
    weights: gwnn_weights.Weights,
    max_speed: float,
    period: float,
    trust: Trust = TRUST,
    learning: bool = False,
    vessel_class: str = 'ship',
) -> Estimator:
    """The estimator.

    max_speed     m/s, of the targets: the velocity variance before the second plot
    period        s, of the radar
    trust         when tracks fall back on CS-Kalman, and when they return
    learning      whether tracks adapt the output weights to their own plots (`adaptation`)
    vessel_class  the class of the filters
    """
    bank = filters.BANKS[vessel_class]

    def speak(state: BankState, memory: ResidualMemory) -> tuple[Array, Array]:
        """The network's outputs [N, 27] for rows, and the units that learn; 0 while warming up."""
        out = np.zeros((len(state.time), OUTPUTS + SPREADS))
        units = adaptation.begin(len(state.time), weights.fusion, learning).units
        warm = np.flatnonzero(memory.plots >= WARM)
        if len(warm):
            seen = inputs.inputs(bank, _chosen(state, warm), _chosen(memory, warm), period)
            out[warm, :OUTPUTS] = forward(weights.fusion, seen)
            out[warm, OUTPUTS:] = np.clip(forward(weights.spread, seen), -3.0, 3.0)
            if learning:
                units[warm] = adaptation.units_of(weights.fusion, seen, POSITION)
        return out, units

    def init(plots: Plots, velocity: Velocity | None = None) -> GwnnState:
        count = len(plots.time)
        return GwnnState(
            filters.begin(bank, plots, max_speed, velocity),
            inputs.begin(plots),
            monitors.begin(count),
            np.zeros((count, OUTPUTS + SPREADS)),
            adaptation.begin(count, weights.fusion, learning),
        )

    def extrapolate(state: GwnnState, time: Array) -> Extrapolation:
        begun, frame = state.bank.time, state.memory.frame
        near = np.clip(time, begun, begun + FADE * period)
        columns = filters.base(bank, state.bank, time)
        mean, covariance = linear_modes.unpack(columns.T)
        mean = mean.copy()
        heard = np.flatnonzero(state.monitor.status == GWNN)
        if len(heard):
            rows = _chosen(state, heard)
            at = look(
                rows.bank,
                frame[heard],
                filters.look(bank, rows.bank, (near - begun)[heard]),
                near[heard],
            )
            shift, ratio = correct(rows, at), rows.output[:, OUTPUTS:]
            # After a missed plot the base gives the uncertainty. If the network's was too small, no
            # plot would be near enough to correct it. If it was too large, wrong plots would be
            # taken.
            missed = (near - begun)[heard] > MISSED * period
            size = np.hypot(*shift[:2])
            shift = shift * np.where(missed, SURE / np.maximum(size, SURE), 1.0)
            ratio = np.where(missed[:, None], 0.0, ratio)
            shift = inputs.from_sigma(frame[heard], shift).T
            # The position is never surer than the base's, and the correction counts as uncertain,
            # too. Otherwise the first plots of a sharp turn would be refused.
            ratio[:, OF_POSITION] = np.maximum(ratio[:, OF_POSITION], 0.0)
            covariance[heard] = respread(covariance[heard], ratio, frame[heard], at.scans)
            covariance[heard, :2, :2] += shift[:, :2, None] * shift[:, None, :2]
            # Beyond the range of its training, the network's correction is continued in a straight
            # line.
            shift[:, :2] += (time - near)[heard, None] * shift[:, 2:]
            mean[heard] += shift
        fallen = np.flatnonzero(state.monitor.status == FALLBACK)
        if len(fallen):
            alone = take(state.bank, fallen)
            mean[fallen], covariance[fallen] = cs_kalman.predict(
                alone.cs_mean,
                alone.cs_covariance,
                (time - begun)[fallen],
                bank.settings.manoeuvre,
                cs_kalman.SHOWN,
            )
        return Extrapolation(time, mean[:, :2], mean[:, 2:], covariance)

    def update(state: GwnnState, plots: Plots, rows: IntArray) -> GwnnState:
        # If all rows had a plot, there is no need to copy them out and in again.
        whole = len(rows) == len(state.output) and bool((rows[1:] > rows[:-1]).all())
        before = state if whole else take(state, rows)
        frame = before.memory.frame
        after, memory, expected = advance(bank, before.bank, before.memory, plots)
        at = look(before.bank, frame, expected.ahead, plots.time)
        shift = inputs.from_sigma(frame, correct(before, at))
        output, units = speak(after, memory)
        wrong = flaw(output)
        sound = wrong == 0
        adapted = before.adapted
        if learning:
            residual = (
                inputs.turn(frame, plots.position.T - expected.ahead.mean[:2] - shift[:2])
                / frame[:, 2:].T
            )
            adapted = adaptation.learn(
                adapted, residual, at.scans, np.where(sound[:, None, None], units, 0.0)
            )
        monitor = judge(before.monitor, plots, expected.ahead, shift, memory, wrong, trust)
        output = np.where(sound[:, None], output, 0.0)
        updated = GwnnState(after, memory, monitor, output, adapted)
        return updated if whole else put(state, rows, updated)

    return Estimator(init, extrapolate, update, account)


def _chosen(state: Rows, rows: IntArray) -> Rows:
    """The rows (ascending) of a state; the state itself if these are all rows."""
    whole = len(rows) == len(state[0] if isinstance(state[0], np.ndarray) else state[0].time)
    return state if whole else take(state, rows)


def respread(covariance: Array, ratio: Array, frame: Array, scans: Array) -> Array:
    """Covariances [N, 4, 4] with variances along and across scaled, correlations kept.

    ratio [N, 8]: logs of the variances' ratios, at once and a scan ahead.
    """
    part = np.minimum(scans, 1.0)[:, None]
    scale = np.exp(0.5 * (ratio[:, :4] + part * (ratio[:, 4:] - ratio[:, :4])))
    line = np.stack([frame[:, :2], np.stack([frame[:, 1], -frame[:, 0]], 1)], 1)  # [N, 2, 2]
    stretch = np.zeros_like(covariance)
    for at in (slice(0, 2), slice(2, 4)):
        stretch[:, at, at] = np.matmul(line.swapaxes(1, 2), scale[:, at, None] * line)
    return sandwich(stretch, covariance)
