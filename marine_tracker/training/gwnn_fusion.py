"""Trains the network of `gwnn` that weights the filters: Adam on the errors of the fused states.

Each cell of samples (`gwnn_samples.Cell`) counts by its error relative to that of the better of the
bank's two four-mode IMMs. During the training, cells gain weight if the network gains little on
that IMM there. So the network learns to be as good as each IMM where that one is best.
"""

from typing import NamedTuple

import numpy as np

from ..estimators.gwnn import bank as filters
from ..estimators.gwnn import gwnn
from ..networks import wavelet_network as net
from ..types import Array, FloatArray, take
from . import adam
from .gwnn_samples import Samples, cell_count
from .gwnn_symmetry import apply, standardise, symmetries

HUBER = 10.0
MOST = 6.0  # times the mean; largest weight of a sample for its noise
BATCH, PEAK, WARM_UP = 1024, 4e-3, 200
REWEIGH_EVERY, REWEIGH_BY = 250, 0.5  # steps between checks of the worst cells; weight change
MOST_ERROR = 40.0  # true sigma^2; limit of squared errors in cells' means
NEVER = -60.0  # log weight
LARGE = 100.0  # sigma^2; likewise in the running errors
# Largest log weight of a cell, either way. With more, the worst cells would get what ships on
# straight courses could gain, which is much more.
MOST_EMPHASIS = 0.8
VELOCITY = 1.0  # weight of a velocity error; that of the position is 1
LAYOUT = net.Layout(levels=2, translations=5, q=1.2, outputs=gwnn.OUTPUTS)


def fuse(output: FloatArray, batch: Samples) -> tuple[FloatArray, FloatArray]:
    """Corrections [n, 4] as `gwnn.fuse` computes them, and the experts' weights [n, 13]."""
    log_weight = np.full((len(output), filters.EXPERTS), gwnn.OTHERS, np.float32)
    log_weight[:, :4] = batch.base
    log_weight += output[:, gwnn.LOGITS]
    weight = np.exp(log_weight - log_weight.max(1, keepdims=True))
    weight /= weight.sum(1, keepdims=True)
    out = np.matmul(weight[:, None], batch.apart)[:, 0]
    out[:, :2] += output[:, gwnn.AT_ONCE] + batch.scans[:, None] * output[:, gwnn.PER_SCAN]
    out[:, 2:] += output[:, gwnn.OF_VELOCITY]
    return out, weight


def fuse_backward(
    gradient: FloatArray, out: FloatArray, weight: FloatArray, batch: Samples
) -> FloatArray:
    """Gradient [n, 19] by the network's outputs, from the gradient by the corrections [n, 4]."""
    back = np.zeros((len(gradient), gwnn.OUTPUTS), np.float32)
    mixed = np.matmul(weight[:, None], batch.apart)[:, 0]
    toward = np.matmul(batch.apart, gradient[:, :, None])[..., 0]
    back[:, gwnn.LOGITS] = weight * (toward - (mixed * gradient).sum(1, keepdims=True))
    back[:, gwnn.AT_ONCE] = gradient[:, :2]
    back[:, gwnn.PER_SCAN] = gradient[:, :2] * batch.scans[:, None]
    back[:, gwnn.OF_VELOCITY] = gradient[:, 2:]
    return back


def cell_weights(samples: Samples) -> FloatArray:
    """[n, 2] for position and velocity: each cell counts by its error relative to an IMM's.

    Velocity errors count in m/s, not in sigma. So within its cell a sample of noisy plots counts
    more.
    """
    size = np.minimum(rivals(samples) / samples.truly[:, None, None] ** 2, MOST_ERROR)
    share = np.ones(size.shape[:2])
    share[:, 1] = np.minimum(samples.area / _mean_by_cell(samples.area, samples.cell), MOST)
    out = np.empty((len(samples.cell), 2), np.float32)
    for j in (0, 1):
        mean = np.minimum(*(_mean_by_cell(share[:, j] * one, samples.cell) for one in size[:, j].T))
        out[:, j] = share[:, j] / (mean * samples.truly**2)
    return out


def rivals(samples: Samples) -> Array:
    """Squared errors [n, 2, 2] of position and velocity, of the base IMM and of the second one."""
    error = np.stack([samples.truth, samples.truth - samples.apart[:, filters.SECOND_IMM]], 1)
    return np.square(error.astype(float)).reshape(-1, 2, 2, 2).sum(3).swapaxes(1, 2)


def _mean_by_cell(values, cell):
    """The mean [n] of the values [n] over each value's cell."""
    count = np.maximum(np.bincount(cell, minlength=cell.max() + 1), 1)
    return (np.bincount(cell, values) / count)[cell]


class Training(NamedTuple):
    """The state from which the training of the fusion network continues.

    network; moments of Adam; emphasis [cells, 2]: log weights of the cells for position and
    velocity; size [cells, 2] and against [cells, 2, 2]: running squared errors, the network's and
    those of the two IMMs.
    """

    network: net.Network
    moments: adam.Moments
    emphasis: Array
    size: Array
    against: Array


def begin(
    samples: Samples, kinds: int, seed: int, layout: net.Layout = LAYOUT, legs: bool = True
) -> Training:
    """An untrained network for these samples, which have `kinds` kinds of motion.

    legs  whether it may choose the straight legs
    """
    rng = np.random.default_rng([seed, 1 << 20])
    centre, scale = standardise(samples.seen)
    network = net.start(layout, centre, scale, rng)
    if not legs:  # no gradient reaches what has no weight: so it stays
        network.bias[gwnn.LOGITS][filters.LEG_EXPERTS] = NEVER
    cells = np.zeros((cell_count(kinds), 2))
    return Training(
        network,
        adam.start([network.inner, network.outer, network.bias]),
        cells,
        cells.copy(),
        np.full((*cells.shape, 2), 1e-9),
    )


def train(training: Training, samples: Samples, seed: int, steps: int, until: int) -> Training:
    """Steps of Adam from the present state up to step `until` of `steps`.

    The arrays of the network and of the moments are changed in place.
    """
    network, moments, emphasis, size, against = training
    parameters = [network.inner, network.outer, network.bias]
    form = net.units(network.layout, np.float32)
    ways, weights = symmetries(), cell_weights(samples)
    velocity = np.array([1, VELOCITY], np.float32)
    for step in range(moments.steps, until):
        rng = np.random.default_rng([seed, 1 << 20, step])
        pick = rng.integers(0, len(samples.cell), BATCH)
        batch = apply(ways[rng.integers(8)], take(samples, pick))
        layer = net.squash(network, batch.seen)
        value, tanh = net.hidden(form, layer @ network.inner)
        output = value @ net.connect(network.outer) + network.bias
        out, weight = fuse(output, batch)
        error = out - batch.truth
        length = np.sqrt(np.square(error).reshape(-1, 2, 2).sum(2))
        own = weights[pick]
        factor = np.minimum(1, HUBER / np.sqrt(own) / np.maximum(length, 1e-6)) * own
        cell = batch.cell
        size += _by_cell(cell, own * np.minimum(length**2, LARGE), len(size))
        against += _by_cell(cell, own[..., None] * np.minimum(rivals(batch), LARGE), len(size))
        factor *= np.exp(emphasis[cell]) * velocity / BATCH
        gradient = (error * np.repeat(factor, 2, 1)).astype(np.float32)
        gradients = net.backward(
            network, form, layer, value, tanh, fuse_backward(gradient, out, weight, batch)
        )
        moments = adam.step(parameters, gradients, moments, adam.cosine(step, steps, PEAK, WARM_UP))
        if (step + 1) % REWEIGH_EVERY == 0:
            emphasis = emphasize(emphasis, size, against)
            size *= 0.5
            against *= 0.5
    return Training(network, moments, emphasis, size, against)


def _by_cell(cell, values, count):
    """Sums [count, ...] of values [n, ...] over the cells."""
    columns = values.reshape(len(values), -1).T
    return np.stack([np.bincount(cell, column, count) for column in columns], 1).reshape(
        count, *values.shape[1:]
    )


def emphasize(emphasis: Array, size: Array, against: Array) -> Array:
    """Increases the weight of cells where the network gains least on the better IMM."""
    against = against.min(2)
    known = against[:, 0] > 1e-3
    ratio = np.sqrt(size / np.maximum(against, 1e-9))
    moved = emphasis + REWEIGH_BY * (ratio - ratio[known].mean(0))
    moved = np.clip(moved, -MOST_EMPHASIS, MOST_EMPHASIS)
    return np.where(known[:, None], moved - moved[known].mean(0), 0.0)
