"""The generalised wavelet network of paper 000: sigmoid inputs, wavelets hidden, local outputs.

S(t) = tanh(t / 2q), phi(t) = S(t + 1) - S(t - 1), psi(t) = phi(t + 1) - phi(t - 1) (eq 12-13 with
d = p = 1). Each linear output has its own group of hidden units (local connection): the scaling
functions phi_{M,k} and the wavelets psi_{m,k}, m = 0..M, each over n translations k, so n (M + 2)
units a group. The number of hidden units follows from M, n and the number of outputs.

A network may have the same number of plain units S(t) instead, to measure the value of wavelets.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import DTypeLike

from ..types import Array, FloatArray
from . import wavelets

BLOCK = 128  # rows at once; their hidden units fit into the processor's cache
WAVELET, TANH = 'wavelet', 'tanh'


class Layout(NamedTuple):
    """levels M; translations n, centred; q of the sigmoid; outputs O; units WAVELET or TANH."""

    levels: int
    translations: int
    q: float
    outputs: int
    units: str = WAVELET


class Sigmoids(NamedTuple):
    """The form of plain units: S(t) = tanh(dilation t)."""

    dilation: float


Form = wavelets.Units | Sigmoids


class Network(NamedTuple):
    """A network of I inputs, O outputs and H = O G hidden units, G to a group.

    centre, scale  [I]         standardise the inputs
    inner          [I + 1, H]  weights of the hidden units; the last row is their bias
    outer          [O, G]      weights of each output's own units
    bias           [O]         of the outputs
    layout
    """

    centre: Array
    scale: Array
    inner: Array
    outer: Array
    bias: Array
    layout: Layout


def group_size(layout: Layout) -> int:
    """G: number of hidden units for each output."""
    return layout.translations * (layout.levels + 2)


@lru_cache
def units(layout: Layout, dtype: DTypeLike = np.float64) -> Form:
    """The form of all H hidden units. ValueError for an unknown kind of units."""
    if layout.units == TANH:
        return Sigmoids(0.5 / layout.q)
    if layout.units != WAVELET:
        raise ValueError(f'hidden units are {layout.units!r}; they must be {WAVELET!r} or {TANH!r}')
    return wavelets.units(
        layout.levels, layout.translations, layout.q, groups=layout.outputs, dtype=dtype
    )


def hidden(form: Form, net: Array) -> tuple[Array, Array]:
    """Values [..., H] of the units at the net inputs [..., H], and their T [..., H]."""
    if isinstance(form, Sigmoids):
        tanh = np.tanh(form.dilation * net)
        return tanh, tanh
    return wavelets.hidden(form, net)


def slope(form: Form, value: Array, tanh: Array) -> Array:
    """Derivatives [..., H] of the units by their net inputs, from the results of `hidden`."""
    if isinstance(form, Sigmoids):
        return form.dilation * (1 - tanh * tanh)
    return wavelets.slope(form, value, tanh)


def squash(network: Network, inputs: FloatArray) -> Array:
    """The input layer [N, I + 1]: S of the standardised inputs [N, I], and 1 for the bias."""
    out = np.empty((len(inputs), inputs.shape[1] + 1), network.inner.dtype)
    np.tanh((inputs - network.centre) * (0.5 / network.scale), out=out[:, :-1])
    out[:, -1] = 1.0
    return out


def forward(network: Network, inputs: FloatArray) -> Array:
    """Outputs [N, O] for inputs [N, I]."""
    form, outer = units(network.layout, network.inner.dtype), connect(network.outer)
    out = np.empty((len(inputs), network.layout.outputs), network.inner.dtype)
    for i in range(0, len(inputs), BLOCK):
        value, _ = hidden(form, squash(network, inputs[i : i + BLOCK]) @ network.inner)
        np.matmul(value, outer, out=out[i : i + BLOCK])
    out += network.bias
    return out


def connect(outer: Array) -> Array:
    """The local connection [O, G] as one matrix [H, O], zero elsewhere."""
    count, group = outer.shape
    matrix = np.zeros((count, group, count), outer.dtype)
    every = np.arange(count)
    matrix[every, :, every] = outer
    return matrix.reshape(-1, count)


def backward(
    network: Network, form: Form, layer: Array, value: Array, tanh: Array, gradient: FloatArray
) -> tuple[Array, Array, Array]:
    """Gradients of a loss by inner, outer and bias, from its gradient [N, O] by the outputs.

    layer, value, tanh: the results of `squash` and `hidden` in the forward pass.
    """
    count, group = network.outer.shape
    spread = np.repeat(gradient, group, 1)
    outer = (spread * value).sum(0).reshape(count, group)
    spread *= network.outer.reshape(-1)
    spread *= slope(form, value, tanh)
    return layer.T @ spread, outer, gradient.sum(0)


def jacobian(network: Network, inputs: FloatArray) -> Array:
    """d outputs / d inputs [N, O, I] at the inputs [N, I]."""
    form = units(network.layout, network.inner.dtype)
    layer = squash(network, inputs)
    value, tanh = hidden(form, layer @ network.inner)
    count, group = network.outer.shape
    slopes = (slope(form, value, tanh) * network.outer.reshape(-1)).reshape(-1, count, group)
    inner = network.inner[:-1].reshape(-1, count, group).transpose(1, 2, 0)
    by_layer: Array = np.matmul(slopes.transpose(1, 0, 2), inner).transpose(1, 0, 2)
    return by_layer * ((1 - layer[:, None, :-1] ** 2) * (0.5 / network.scale))


def start(
    layout: Layout,
    centre: FloatArray,
    scale: FloatArray,
    rng: np.random.Generator,
    dtype: DTypeLike = np.float32,
) -> Network:
    """Random weights: net inputs that spread over the translations, and small outputs."""
    inputs, group = len(centre), group_size(layout)
    inner = rng.normal(0, 1.5 * layout.q / np.sqrt(inputs), (inputs + 1, layout.outputs * group))
    outer = rng.normal(0, 0.1 / np.sqrt(group), (layout.outputs, group))
    arrays = (centre, scale, inner, outer, np.zeros(layout.outputs))
    return Network._make([*(np.asarray(array, dtype) for array in arrays), layout])
