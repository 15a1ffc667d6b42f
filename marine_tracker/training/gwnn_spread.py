"""Trains the network of `gwnn` that predicts the variances of the fused states.

Its outputs are the log ratios of these variances to the base IMM's. The loss is the Gaussian
likelihood.
"""

import numpy as np

from ..estimators.gwnn import gwnn
from ..networks import wavelet_network as net
from ..types import take
from . import adam
from .gwnn_fusion import BATCH, WARM_UP, fuse
from .gwnn_samples import Samples
from .gwnn_symmetry import apply, symmetries

LAYOUT = net.Layout(levels=2, translations=2, q=1.2, outputs=gwnn.SPREADS)
STEPS = 4000
LEVEL = (-8.0, 6.0)  # log of the smallest and the largest variance, sigma^2
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
    error = np.concatenate(
        [
            fuse(net.forward(network, part.seen), part)[0] - part.truth
            for part in (take(samples, slice(i, i + 10000)) for i in range(0, len(pick), 10000))
        ]
    )
    square = np.minimum(error * error, largest)
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
        level = batch.spread + ratio[:, :4] + part * (ratio[:, 4:] - ratio[:, :4])
        slope = np.clip(0.5 * (1 - off * np.exp(-np.clip(level, *LEVEL))), steepest, 0.5)
        slope /= len(pick)
        back = np.concatenate([slope * (1 - part), slope * part], 1).astype(np.float32)
        moments = adam.step(
            parameters,
            net.backward(spread, form, layer, value, tanh, back),
            moments,
            adam.cosine(step, steps, PEAK, WARM_UP),
        )
    return spread
