"""The eight ways to turn or mirror what the network of `gwnn` sees.

The axes along and across the line of sight can be exchanged, and each can change sign. The side
that is starboard changes with them. Training on turned samples teaches the network that no
direction is special.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..estimators.gwnn import bank as filters
from ..estimators.gwnn import inputs
from ..types import Array, FloatArray
from .gwnn_samples import Samples


class Symmetry(NamedTuple):
    """One way to turn or mirror: exchanged places, and signs.

    order, sign of the inputs; of a state of four; experts' order.
    """

    inputs: NDArray[np.int64]
    sign: Array
    state: NDArray[np.int64]
    state_sign: Array
    experts: NDArray[np.int64]


def symmetries() -> list[Symmetry]:
    """All eight."""
    return [
        _symmetry(np.array([x, y]), swap)
        for x in (1, -1)
        for y in (1, -1)
        for swap in (False, True)
    ]


def _symmetry(signs, swap) -> Symmetry:
    mirrored = -1 if (signs.prod() < 0) != swap else 1
    order: list[int] = []
    sign: list[float] = []
    for kind in inputs.KINDS:
        i = len(order)
        if kind in (inputs.S, inputs.P):
            order.append(i)
            sign.append(mirrored if kind == inputs.P else 1)
            continue
        order += [i + 1, i] if swap else [i, i + 1]
        factor = {inputs.V: signs, inputs.PV: signs * mirrored, inputs.E: np.ones(2)}[kind]
        sign += list(factor)
    experts = np.arange(filters.EXPERTS)
    if mirrored < 0:
        for right, left in filters.TURNS:
            experts[[right, left]] = left, right
    pair = np.array([1, 0] if swap else [0, 1])
    return Symmetry(
        np.array(order),
        np.array(sign, np.float32),
        np.concatenate([pair, pair + 2]),
        np.tile(signs, 2).astype(np.float32),
        experts,
    )


def apply(symmetry: Symmetry, batch: Samples) -> Samples:
    """The samples after turning or mirroring."""
    state, sign = symmetry.state, symmetry.state_sign
    modes = symmetry.experts[:4]
    return batch._replace(
        seen=batch.seen[:, symmetry.inputs] * symmetry.sign,
        apart=batch.apart[:, symmetry.experts][:, :, state] * sign,
        base=batch.base[:, modes],
        truth=batch.truth[:, state] * sign,
        spread=batch.spread[:, state],
    )


def standardise(seen: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Centre and scale [I] of the inputs.

    Pairs share them. Inputs that change sign are centred on 0. So the symmetries stay exact.
    """
    centre, scale = np.zeros(seen.shape[1], np.float32), np.ones(seen.shape[1], np.float32)
    i = 0
    for kind in inputs.KINDS:
        width = 1 if kind in (inputs.S, inputs.P) else 2
        columns = seen[:, i : i + width]
        if kind in (inputs.S, inputs.E):
            centre[i : i + width] = columns.mean(dtype=float)
        scale[i : i + width] = np.sqrt(np.square(columns - centre[i]).mean(dtype=float)) + 1e-3
        i += width
    return centre, scale
