"""Trains the network of `gwnn` that predicts the variances of the fused states.

Its outputs are the log ratios of these variances to the base IMM's. As in use, those of the
position are at least 0, and the correction counts as uncertain (`variances`). The loss is the
Gaussian likelihood.
"""

import numpy as np

from ..estimators.gwnn import gwnn
from ..networks import wavelet_network as net
from ..types import FloatArray, take
from . import adam
from .gwnn_fusion import BATCH, WARM_UP, fuse
from .gwnn_samples import Samples
from .gwnn_symmetry import apply, symmetries

LAYOUT = net.Layout(levels=2, translations=2, q=1.2, outputs=gwnn.SPREADS)
STEPS = 4000
LEAST_MOST = tuple(np.exp([-8.0, 6.0]))  # smallest and largest variance, sigma^2
# By vessel class: largest squared error, sigma^2, and steepest slope of the loss by log variance.
# Ships: they hold back single wild samples only, so that errors are on the whole as large as the
# variances say. Boats' plots jump over the hull: with the same values the variance of their
# velocity would be ten times too large on quiet straight courses.
HELD_BACK = {'ship': (400.0, -50.0), 'small_craft': (110.0, -7.0)}
SAMPLES = 300000  # at most
PEAK = 3e-3


def train(
    network: net.Network,
    samples: Samples,
    seed: int,
    steps: int = STEPS,
    layout: net.Layout = LAYOUT,
    vessel_class: str = 'ship',
) -> net.Network:
    """The network that predicts the error of the fusion network."""
    largest, steepest = HELD_BACK[vessel_class]
    rng = np.random.default_rng([seed, 1 << 21])
    pick = np.sort(rng.permutation(len(samples.cell))[:SAMPLES])
    samples = take(samples, pick)
    shift = np.concatenate(
        [
            fuse(net.forward(network, part.seen), part)[0]
            for part in (take(samples, slice(i, i + 10000)) for i in range(0, len(pick), 10000))
        ]
    )
    square = np.minimum(np.square(shift - samples.truth), largest)
    spread = net.start(layout, network.centre, network.scale, rng)
    parameters = [spread.inner, spread.outer, spread.bias]
    form, ways = net.units(layout, np.float32), symmetries()
    moments = adam.start(parameters)
    for step in range(steps):
        pick = rng.integers(0, len(square), BATCH // 2)
        way = ways[rng.integers(8)]
        batch, off = apply(way, take(samples, pick)), square[pick][:, way.state]
        layer = net.squash(spread, batch.seen)
        value, tanh = net.hidden(form, layer @ spread.inner)
        ratio = value @ net.connect(spread.outer) + spread.bias
        part = np.minimum(batch.scans, 1.0)[:, None]
        variance, share = variances(ratio, part, batch.spread, shift[pick][:, way.state])
        slope = np.clip(0.5 * (1 - off / np.clip(variance, *LEAST_MOST)), steepest, 0.5) * share
        slope /= len(pick)
        back = np.concatenate([slope * (1 - part), slope * part], 1).astype(np.float32)
        # Below 0 a ratio of the position has no effect. It may only come back.
        low = ratio[:, gwnn.OF_POSITION] < 0
        back[:, gwnn.OF_POSITION] = np.minimum(
            back[:, gwnn.OF_POSITION], np.where(low, 0.0, np.inf)
        )
        moments = adam.step(
            parameters,
            net.backward(spread, form, layer, value, tanh, back),
            moments,
            adam.cosine(step, steps, PEAK, WARM_UP),
        )
    return spread


def variances(
    ratio: FloatArray, part: FloatArray, base: FloatArray, shift: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Variances [n, 4] as the estimator states them, and the share of them that ratios change.

    ratio [n, 8]: the network's outputs; part [n, 1]: of a scan ahead; base [n, 4]: log variances of
    the base; shift [n, 4]: the correction of the base
    """
    ratio = ratio.copy()
    ratio[:, gwnn.OF_POSITION] = np.maximum(ratio[:, gwnn.OF_POSITION], 0.0)
    scaled = np.exp(base + ratio[:, :4] + part * (ratio[:, 4:] - ratio[:, :4]))
    whole = scaled.copy()
    whole[:, :2] += np.square(shift[:, :2])
    return whole, scaled / whole
