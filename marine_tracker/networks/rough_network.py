"""The rough neural network of paper 001, section 1, and the plain one it is compared with.

A node holds K neurons. Each is connected with every neuron of the next layer. In a rough node
(K = 2) the lower neuron puts out the smaller of the two activations, and the upper one the larger:

    a = f(In - theta),   f(x) = 2 / (1 + exp(-x)) - 1 = tanh(x / 2)

So a node holds an interval. The network's output is the middle of its last interval. With K = 1 the
same equations are the plain backpropagation network. Inputs are [lower, upper] of each input, or
one value if K = 1. W_IU in the printed In_U is read as W_LU, from lower to upper neurons.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array


class Network(NamedTuple):
    """I inputs, H hidden nodes, one output node, all of K neurons.

    inner        [I, K, H, K]  from each input neuron to each hidden one
    inner_theta  [H, K]        their thresholds
    outer        [H, K, K]     from each hidden neuron to those of the output
    outer_theta  [K]
    """

    inner: Array
    inner_theta: Array
    outer: Array
    outer_theta: Array


Shapes = tuple[tuple[int, ...], ...]


def shapes(inputs: int, hidden: int, neurons: int) -> Shapes:
    """The shapes of a network's arrays."""
    return (
        (inputs, neurons, hidden, neurons),
        (hidden, neurons),
        (hidden, neurons, neurons),
        (neurons,),
    )


def from_vector(vector: Array, form: Shapes) -> Network:
    """The network with arrays of the shapes `form`, taken from the vector one after another."""
    ends = np.cumsum([np.prod(shape, dtype=int) for shape in form])
    return Network._make(
        part.reshape(shape) for part, shape in zip(np.split(vector, ends[:-1]), form)
    )


def to_vector(network: Network) -> Array:
    """All weights and thresholds in one vector."""
    return np.concatenate([array.ravel() for array in network])


def draw(form: Shapes, rng: np.random.Generator, scale: float = 0.35) -> Network:
    """Random weights of that deviation."""
    return Network._make(rng.normal(0, scale, shape) for shape in form)


def _activations(network: Network, inputs: Array) -> Array:
    """Activations of the hidden neurons [N, H, K], before they are sorted."""
    nodes = network.inner_theta
    net = _flat(inputs) @ network.inner.reshape(-1, nodes.size)
    return np.tanh(0.5 * (net - nodes.ravel())).reshape(-1, *nodes.shape)


def _flat(array: Array) -> Array:
    """[N, ...] as [N, M]; N may be 0."""
    return array.reshape(len(array), int(np.prod(array.shape[1:])))


def bounds(network: Network, inputs: Array) -> Array:
    """[lower, upper] of the output node, [N, K], for inputs [N, I, K]."""
    hidden = _flat(np.sort(_activations(network, inputs), -1))
    net = hidden @ network.outer.reshape(hidden.shape[1], -1)
    return np.sort(np.tanh(0.5 * (net - network.outer_theta)), -1)


def forward(network: Network, inputs: Array) -> Array:
    """Outputs [N] for inputs [N, I, K]."""
    middle: Array = bounds(network, inputs).mean(-1)
    return middle


def jacobian(network: Network, inputs: Array) -> Array:
    """d outputs / d `to_vector` [N, P] at inputs [N, I, K]."""
    activation = _activations(network, inputs)
    order = np.argsort(activation, -1)
    hidden = _flat(np.take_along_axis(activation, order, -1))
    outer = network.outer.reshape(hidden.shape[1], -1)
    out = np.tanh(0.5 * (hidden @ outer - network.outer_theta))
    last = 0.5 * (1 - out * out) / out.shape[1]  # d output / d net
    back = np.empty_like(activation)
    np.put_along_axis(back, order, (last @ outer.T).reshape(activation.shape), -1)
    first = _flat(back * 0.5 * (1 - activation * activation))
    parts = (
        _flat(inputs)[:, :, None] * first[:, None],
        -first,
        hidden[:, :, None] * last[:, None],
        -last,
    )
    return np.concatenate([_flat(part) for part in parts], 1)
