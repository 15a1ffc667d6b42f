"""Trains the weights of `cs_rough_nn` and `cs_bp_nn` (paper 001, section 4).

The paper gives the rule for its samples, but not the samples: all inputs low, no manoeuvre, O near
0; all high, a hard one, O near 1; some high, O already large. Here the samples are a grid of 5^3
places v between quiet (0) and hard (1), with

    O = .02 + .96 (1 - prod(1 - .72 v_i^1.5)) / (1 - .28^3),

and a sixth level below: no difference at all. Without it the network fails there, where it has no
samples. The rough network sees each sample through the intervals that several radars' noise makes.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_are, solve_discrete_lyapunov
from scipy.optimize import least_squares

from ..estimators.cs_kalman import model
from ..estimators.rough_features import HIGH, KAPPA, LAMBDA, LOW, inputs
from ..networks import rough_network as net
from ..networks.rough_weights import HIDDEN, INPUTS, NEURONS, Quiet, Weights
from ..types import Array

NARROW = 0.02  # O of F2 while a target keeps its course
LOG_GAMMA = np.log(10.0) * np.arange(-3, 1.01, 0.5)
LOG_Y = np.log([0.01, 0.03, 0.1, 0.3])
LEVELS = np.linspace(0, 1, 5)
SAMPLED = [(3, 0), (3, 2), (5, 1), (7, 0), (7, 2)]  # places of the intervals
STARTS, DECAY, ROUNDS = 12, 1e-3, 200  # starts; weight decay; evaluations each
EXACT, LAST_ROUNDS = 1e-15, 3000  # of the last fit: tolerance; evaluations
ALIKE = 1.02  # ratio of costs up to which fits count as equally good
DIGITS = 4  # digits of the weights that are kept


class Samples(NamedTuple):
    """inputs [M, 3, K]; wanted [M]."""

    inputs: np.ndarray
    wanted: np.ndarray


def quiet(gamma: float, y: float) -> tuple[Array, Array]:
    """For a target at rest in noise, without missed plots: c [3], and (sqrt p1 + sqrt p2) / sqrt(c
    s).

    In units of T and sigma_plot; y = alpha T. The filters have settled (their Riccati equations are
    solved), F2 with the share NARROW. Their errors are one linear system driven by the plot noise.
    Its covariance solves a Lyapunov equation.
    """
    phi, q = (part[:, 0] for part in model(y, np.ones(1)))
    decaying = np.array([[1, 1, phi[2]], [0, 1, phi[1]], [0, 0, phi[0]]])
    steady = np.array([[1, 1, 0.5], [0, 1, 1], [0, 0, 1.0]])  # F + U [0 0 1]
    noise = 2 * y * gamma**2 * q[[[0, 1, 2], [1, 3, 4], [2, 4, 5]]]
    seen = np.array([[1.0, 0, 0]])
    spread, transition, drive = [], np.zeros((6, 6)), np.zeros((6, 1))
    for i, share in enumerate((1.0, NARROW)):
        P = solve_discrete_are(decaying.T, seen.T, share * noise, np.eye(1))
        gain = P[:, :1] / (P[0, 0] + 1)
        spread.append(np.diag(P))
        own = slice(3 * i, 3 * i + 3)
        transition[own, own] = steady @ (np.eye(3) - gain @ seen)
        drive[own] = steady @ gain
    joint = solve_discrete_lyapunov(transition, drive @ drive.T)
    apart = np.hstack([np.eye(3), -np.eye(3)])
    variance = np.diag(apart @ joint @ apart.T)
    s = spread[0] + spread[1] + np.array([2, 0, 0])
    return variance / s, (np.sqrt(spread[0]) + np.sqrt(spread[1])) / np.sqrt(variance)


@cache
def normalisation() -> tuple[Quiet, Array]:
    """The table of c, and the deviations [G, Y, 3] that belong to it."""
    found = np.array([[quiet(np.exp(g), np.exp(y)) for y in LOG_Y] for g in LOG_GAMMA])
    return Quiet(LOG_GAMMA, LOG_Y, found[:, :, 0]), found[:, :, 1]


def label(v: Array) -> Array:
    """Wanted O [...] for places v [..., 3] between quiet (0) and hard (1)."""
    return 0.02 + 0.96 * (1 - np.prod(1 - 0.72 * v**1.5, -1)) / (1 - 0.28**3)


def samples(deviations: Array, neurons: int) -> Samples:
    """The grid as seen by networks with `neurons` neurons to a node; deviations from
    `normalisation`.
    """
    square = np.concatenate([[0], LOW + LEVELS * (HIGH - LOW)])
    square = np.stack(np.meshgrid(*[square] * INPUTS, indexing='ij'), -1).reshape(-1, INPUTS)
    v, apart = np.maximum(square - LOW, 0) / (HIGH - LOW), np.sqrt(square)
    if neurons == 1:
        return Samples(inputs(apart, None, 1), label(v))
    seen = [inputs(apart, deviations[place], neurons) for place in SAMPLED]
    return Samples(np.concatenate(seen), np.tile(label(v), len(SAMPLED)))


def train(
    kind: str, seed: int, progress: Callable[[int, int], None] = lambda done, whole: None
) -> Weights:
    """One of the best of STARTS networks of a kind, fitted by the Levenberg-Marquardt method."""
    neurons = NEURONS[kind]
    table, deviations = normalisation()
    given = samples(deviations, neurons)
    form = net.shapes(INPUTS, HIDDEN, neurons)
    rng = np.random.default_rng(seed)

    def error(vector):
        return np.concatenate(
            [
                net.forward(net.from_vector(vector, form), given.inputs) - given.wanted,
                DECAY * vector,
            ]
        )

    def slope(vector):
        return np.concatenate(
            [net.jacobian(net.from_vector(vector, form), given.inputs), DECAY * np.eye(len(vector))]
        )

    fits = []
    for start in range(STARTS):
        progress(start, STARTS)
        fits.append(
            least_squares(
                error, net.to_vector(net.draw(form, rng)), slope, method='lm', max_nfev=ROUNDS
            )
        )
    # Fit the first good one to full convergence, so that the rounding of the processor makes no
    # difference.
    least = min(fit.cost for fit in fits)
    good = next(fit for fit in fits if fit.cost <= ALIKE * least)
    best = least_squares(
        error, good.x, slope, method='lm', ftol=EXACT, xtol=EXACT, gtol=EXACT, max_nfev=LAST_ROUNDS
    )
    network = net.from_vector(np.round(best.x, DIGITS), form)
    off = net.forward(network, given.inputs) - given.wanted
    progress(STARTS, STARTS)
    return Weights(
        network,
        table,
        {
            'made_by': 'marine_tracker train rough_nn',
            'network': kind,
            'seed': seed,
            'layout': f'{INPUTS}-{HIDDEN}-1',
            'lambda': LAMBDA,
            'kappa': KAPPA,
            'samples': len(given.wanted),
            'rms_error': round(float(np.sqrt(np.mean(off**2))), 4),
        },
    )
