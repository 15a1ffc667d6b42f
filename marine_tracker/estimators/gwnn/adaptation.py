"""Learning on the track, for `gwnn`: each track adapts its own output weights of the position.

The shipped weights do not change. A track adds its own weights, and forgets them by LEAK a plot.
Off by default: the trained network already knows the filters' errors, and one track has few plots.
It helps against errors that last long, such as a bias of the radar.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...networks import wavelet_network as net
from ...types import Array

STEP = 0.001  # of the error, a plot, along the units' values
LEAK = 0.01  # share of a track's own weights forgotten a plot
MOST_MOMENTUM = 0.9  # with 1 a change would never decay
CLIP = 3.0  # sigma: larger residuals count as this


class Adapted(NamedTuple):
    """What tracks have learned; C weights to an axis, none if learning is off.

    units    [N, 2, C]  output of the hidden units after the last plot, along and across; the second
                        half is for the correction one scan ahead
    weights  [N, 2, C]  the track's own
    moved    [N, 2, C]  their last change
    """

    units: Array
    weights: Array
    moved: Array


def begin(count: int, network: net.Network, learning: bool) -> Adapted:
    """Nothing learned yet."""
    width = 2 * (net.group_size(network.layout) + 1) if learning else 0
    zero = np.zeros((count, 2, width))
    return Adapted(zero, zero.copy(), zero.copy())


def units_of(network: net.Network, inputs: NDArray[np.floating], outputs: slice) -> Array:
    """The hidden units [N, 2, C] of four outputs: position at once, then per scan ahead."""
    group = net.group_size(network.layout)
    layout = network.layout._replace(outputs=4)
    inner = network.inner[:, outputs.start * group : outputs.stop * group]
    value, _ = net.hidden(net.units(layout, inner.dtype), net.squash(network, inputs) @ inner)
    out = np.ones((len(inputs), 4, group + 1))
    out[:, :, :-1] = value.reshape(-1, 4, group)
    return np.concatenate([out[:, :2], out[:, 2:]], 2)


def _asked(adapted: Adapted, scans: Array) -> Array:
    """The units' values [N, 2, C], weighted for a number of scans ahead [N]."""
    half = adapted.units.shape[2] // 2
    return adapted.units * np.where(np.arange(2 * half) < half, 1.0, scans[:, None])[:, None]


def correction(adapted: Adapted, scans: Array) -> Array:
    """The learned correction of the position [2, N], sigma."""
    found: Array = (_asked(adapted, scans) * adapted.weights).sum(2).T
    return found


def learn(adapted: Adapted, residual: Array, scans: Array, units: Array) -> Adapted:
    """After plots whose residuals were [2, N] sigma, so many scans ahead; units for the next.

    Normalised gradient, with the momentum of paper 000: that of a neuron is its share in the
    layer's squared errors (eq 7-8).
    """
    error = np.clip(residual, -CLIP, CLIP).T  # [N, 2]
    asked = _asked(adapted, scans)
    share = error**2 / np.maximum((error**2).sum(1, keepdims=True), 1e-12)
    share = np.minimum(share, MOST_MOMENTUM)
    size = np.maximum((asked * asked).sum(2), 1e-12)
    moved = (STEP * error / size)[..., None] * asked + share[..., None] * adapted.moved
    return Adapted(units, (1 - LEAK) * adapted.weights + moved, moved)
