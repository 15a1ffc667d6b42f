"""Networks trained on line, one a row: the paper's rules of variable step and momentum.

Paper 000, section 2. B networks have one design, and each has its own weights (for tracks, or for
seeds of a Monte Carlo). Every function works on all of them at once. A design has three layers
(eq 15 with L = 2): S of the inputs and a bias, one hidden layer, linear outputs.

- `bp`: hidden units S, every output connected to all of them: the paper's baseline;
- `gwnn`: hidden units are scaling functions and wavelets; every output has its own group.

Symbols: E_R radial error; p step; mu momentum; delta the error signals of eq 8.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array, take
from .wavelets import Units, hidden, sigmoid, sigmoid_slope, slope, units

# The paper draws the weights from (0, 1]. Without scaling they saturate the hidden units.
INNER_SCALE, OUTER_SCALE = 0.3, 0.1
MAX_MOMENTUM = 0.9  # eq 7 gives 1 if one unit has all the error


class Design(NamedTuple):
    """The common design of all networks of a batch.

    inputs, outputs  I, O
    width            q of S
    groups, group    hidden units: C groups of G; C = O if connected locally, else 1
    form             the C G wavelet units; None for units S
    """

    inputs: int
    outputs: int
    width: float
    groups: int
    group: int
    form: Units | None


class Weights(NamedTuple):
    """Weights of B networks and their last changes, which the momentum uses.

    inner  [B, C G, I + 1]  the last column is the bias
    outer  [B, O, G]
    """

    inner: Array
    outer: Array
    inner_change: Array
    outer_change: Array


class Passed(NamedTuple):
    """A forward pass: layer [B, I + 1], units [B, C, G], slopes [B, C, G], output [B, O]."""

    layer: Array
    units: Array
    slopes: Array
    output: Array


class Rule(NamedTuple):
    """How a plot trains the networks.

    step            p of the equal-step rule; eta of eq 9 if `variable`
    variable        variable step and momentum (eq 6-10), else gradient descent with equal step
    rounds          largest number of corrections by one plot
    fast, slow      m/s, v1 > v2 of eq 9; fast_spread, slow_spread its b1 < b2
    grow, shrink    factors of the step (eq 10)
    """

    step: float
    variable: bool = True
    rounds: int = 1
    fast: float = 12.0
    slow: float = 5.0
    fast_spread: float = 2.0
    slow_spread: float = 4.0
    grow: float = 1.05
    shrink: float = 0.7


def bp(inputs: int, outputs: int, hidden_units: int, width: float) -> Design:
    """The plain backpropagation network."""
    return Design(inputs, outputs, width, 1, hidden_units, None)


def gwnn(inputs: int, outputs: int, levels: int, translations: int, width: float) -> Design:
    """The generalised wavelet network: n (M + 2) units to an output, M levels, n translations."""
    form = units(levels, translations, width, groups=outputs)
    return Design(inputs, outputs, width, outputs, translations * (levels + 2), form)


def draw(design: Design, count: int, rng: np.random.Generator) -> Weights:
    """Random weights of `count` networks."""
    inner = INNER_SCALE * (1 - rng.random((count, design.groups * design.group, design.inputs + 1)))
    outer = OUTER_SCALE * (1 - rng.random((count, design.outputs, design.group)))
    return Weights(inner, outer, np.zeros_like(inner), np.zeros_like(outer))


def forward(design: Design, weights: Weights, inputs: Array) -> Passed:
    """All networks on their inputs [B, I] (eq 1)."""
    layer = np.ones((len(inputs), design.inputs + 1))
    layer[:, :-1] = sigmoid(inputs, design.width)
    net = np.matmul(weights.inner, layer[..., None])[..., 0]
    if design.form is None:
        value, slopes = sigmoid(net, design.width), sigmoid_slope(net, design.width)
    else:
        value, tanh = hidden(design.form, net)
        slopes = slope(design.form, value, tanh)
    shape = (-1, design.groups, design.group)
    value = value.reshape(shape)
    return Passed(layer, value, slopes.reshape(shape), (weights.outer * value).sum(-1))


def correct(
    weights: Weights, passed: Passed, error: Array, step: Array, variable: bool = True
) -> Weights:
    """One step down the gradient of |error|^2 / 2 (eq 5), with momentum where `variable` (eq 6).

    error [B, O]: wanted output - output; step [B].
    """
    back = hidden_error(weights, passed, error)
    step = step[:, None, None]
    inner = step * back[..., None] * passed.layer[:, None]
    outer = step * error[..., None] * passed.units
    if variable:
        inner += momentum(back)[..., None] * weights.inner_change
        outer += momentum(error)[..., None] * weights.outer_change
    return Weights(weights.inner + inner, weights.outer + outer, inner, outer)


def hidden_error(weights: Weights, passed: Passed, error: Array) -> Array:
    """delta [B, C G] of the hidden units, from that of the outputs [B, O] (eq 8)."""
    back = weights.outer * error[..., None]
    if passed.units.shape[1] == 1:
        back = back.sum(1, keepdims=True)
    return (back * passed.slopes).reshape(len(error), -1)


def input_gradient(design: Design, weights: Weights, inputs: Array, error: Array) -> Array:
    """-dE/de0 [B, I]: how fast the squared error falls with the inputs [B, I] (eq 17)."""
    passed = forward(design, weights, inputs)
    back = hidden_error(weights, passed, error)[:, None]
    by_layer: Array = np.matmul(back, weights.inner)[:, 0, :-1]
    return by_layer * sigmoid_slope(inputs, design.width)


def momentum(delta: Array) -> Array:
    """mu [B, n] of the neurons of a layer: each one's share of its squared error [B, n] (eq 7)."""
    square = delta * delta
    total = square.sum(-1, keepdims=True)
    return np.minimum(square / np.where(total > 0, total, 1.0), MAX_MOMENTUM)


def first_step(rule: Rule, speed: Array) -> Array:
    """A(v): the first step [B] for a plot, for target speeds [B] m/s (eq 9)."""
    if not rule.variable:
        return np.full(len(speed), rule.step)
    # exp would overflow above the speed of any ship.
    speed = np.minimum(speed, 100.0)
    return rule.step * (
        1 / (1 + np.exp((speed - rule.fast) / rule.fast_spread))
        + 1 / (1 + np.exp((speed - rule.slow) / rule.slow_spread))
    )


def next_step(rule: Rule, step: Array, error: Array, before: Array, far: float | Array) -> Array:
    """p [B] after the radial error has changed from `before` to `error` [B] m (eq 10).

    far [B] or number, m: E2, above which the step grows.
    """
    return step * np.where(error >= before, rule.shrink, np.where(error > far, rule.grow, 1.0))


def learn(
    design: Design,
    weights: Weights,
    inputs: Array,
    wanted: Array,
    speed: Array,
    rule: Rule,
    unit: float,
    near: float | Array,
    far: float | Array,
) -> Weights:
    """The weights after one plot each: steps 1 to 5 of the paper's algorithm.

    inputs, wanted  [B, I], [B, O]  what the networks should have given; outputs 0 and 1: position
    speed           [B] m/s, for the first step
    unit            m, of a position output of 1
    near, far       E1, E2 [B] or number, m: corrected until E_R <= E1; the step grows above E2

    The step is reset for every plot. If it were kept, it would shrink to zero. Gradient descent
    with equal step makes `rounds` corrections for every plot.
    """
    count = len(wanted)
    near, far = np.broadcast_to(near, count), np.broadcast_to(far, count)
    rows, step, before = np.arange(count), first_step(rule, speed), np.full(count, np.inf)
    weights = Weights(*(array.copy() for array in weights))
    for _ in range(rule.rounds):
        mine = take(weights, rows)
        passed = forward(design, mine, inputs[rows])
        error = wanted[rows] - passed.output
        radial = unit * np.hypot(error[:, 0], error[:, 1])
        if rule.variable:
            step = np.where(
                np.isinf(before), step, next_step(rule, step, radial, before, far[rows])
            )
            on = np.flatnonzero(radial > near[rows])
            if not len(on):
                break
            mine, passed = take(mine, on), take(passed, on)
            rows, error, radial, step = rows[on], error[on], radial[on], step[on]
        for array, new in zip(weights, correct(mine, passed, error, step, rule.variable)):
            array[rows] = new
        before = radial
    return weights
