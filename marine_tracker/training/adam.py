"""Adam (Kingma and Ba 2015) on a list of arrays."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..types import Array

FIRST, SECOND, TINY = 0.9, 0.999, 1e-9


class Moments(NamedTuple):
    """Running means of the gradients and of their squares, shaped as the parameters; steps."""

    mean: list[Array]
    square: list[Array]
    steps: int


def start(parameters: Sequence[Array]) -> Moments:
    """The start: no gradients yet."""
    return Moments(
        [np.zeros_like(p) for p in parameters], [np.zeros_like(p) for p in parameters], 0
    )


def step(
    parameters: Sequence[Array], gradients: Sequence[Array], moments: Moments, rate: float
) -> Moments:
    """One step down the gradients; parameters and moments are changed in place."""
    count = moments.steps + 1
    for p, g, mean, square in zip(parameters, gradients, moments.mean, moments.square):
        mean += (1 - FIRST) * (g - mean)
        square += (1 - SECOND) * (g * g - square)
        size = np.sqrt(square / (1 - SECOND**count))
        size += TINY
        p -= (rate / (1 - FIRST**count)) * mean / size
    return moments._replace(steps=count)


def cosine(step_: int, steps: int, peak: float, warm_up: int) -> float:
    """A rate that rises over `warm_up` steps and then falls as a cosine to zero."""
    return peak * min(1.0, (step_ + 1) / warm_up) * (0.5 + 0.5 * np.cos(np.pi * step_ / steps))
