"""Blocks of four states, corrected in the wavelet domain: late but smooth (paper 003).

A block is X = [x(4m+1) .. x(4m+4)], predicted at once from the last state of the block before. The
orthonormal rows of a periodised wavelet transform take states and plots to other resolutions: with
rows H, X_H = H X and z_H = H z. A Kalman filter there gives the correction H' K nu. The rows that
are left out, the details, keep their prediction. With all rows, this equals the Kalman filter with
its smoother inside the block. With the coarsest row only, the block moves as a whole.

Departures: the paper's diag(F^4) for the prediction of a block ignores that its states are
correlated. Its eq 14 drops the predicted details, and so the target's motion within the block. The
covariance is Joseph's form, because H' K is not the gain of least variance.
"""

from functools import cache
from typing import NamedTuple

import numpy as np
import pywt

from ..types import Array
from . import cs_kalman
from .cs_kalman import POSITION, Manoeuvre

SIZE = 4  # states of a block: N = 3 resolutions
COARSEST = 2  # depth of the decomposition: one row for the whole block


class Block(NamedTuple):
    """mean [B, n, 6], [x v a] east, then north; covariance [B, 6n, 6n], state by state."""

    mean: Array
    covariance: Array


@cache
def analysis(wavelet: str, depth: int, size: int = SIZE) -> Array:
    """The orthonormal transform [size, size] of a block as rows: low-pass, then details.

    The first size / 2^depth rows are the low-pass at that depth. The details follow from coarse to
    fine (paper 003, eq 4 and 5). ValueError for a size that cannot be halved that often, and for a
    wavelet that is not orthogonal.
    """
    if size % 2**depth:
        raise ValueError(f'a block of {size} cannot be halved {depth} times')
    if not pywt.Wavelet(wavelet).orthogonal:
        raise ValueError(f'the wavelet {wavelet} is not orthogonal')
    low = np.eye(size)
    details: list[Array] = []
    for _ in range(depth):
        low, detail = pywt.dwt(low, wavelet, 'periodization', axis=0)
        details.insert(0, detail)
    rows = np.concatenate([low, *details])
    rows.setflags(write=False)
    return rows


def coarse(wavelet: str, depth: int) -> Array:
    """The low-pass rows [r, SIZE] alone."""
    return analysis(wavelet, depth)[: SIZE >> depth]


def transition(frequency: float, step: Array) -> Array:
    """F [B, 6, 6] of the "current" statistical model over the steps [B] s."""
    phi, _ = cs_kalman.model(frequency, step)
    out = np.zeros((len(step), 6, 6))
    for x, v, a in ((0, 1, 2), (3, 4, 5)):
        out[:, x, x] = out[:, v, v] = 1.0
        out[:, x, v] = step
        out[:, a, a], out[:, v, a], out[:, x, a] = phi
    return out


def predict(mean: Array, covariance: Array, steps: Array, manoeuvre: Manoeuvre) -> Block:
    """The block of n states ahead of the states [B, 6], [B, 6, 6].

    steps [B, n] s, from each state to the next. Mean acceleration and its variance are those of the
    start, because an acceleration that is not corrected is its own mean. The covariance is G P G' +
    sum N_i Q N_i', here state by state: cov(x_j, x_i) = F_j cov(x_j-1, x_i), i < j.
    """
    count, size = steps.shape
    means = np.empty((count, size, 6))
    parts = np.empty((count, size, size, 6, 6))
    for j in range(size):
        mean, covariance = cs_kalman.predict(mean, covariance, steps[:, j], manoeuvre)
        means[:, j], parts[:, j, j] = mean, covariance
        if j:
            move = transition(manoeuvre.frequency, steps[:, j])[:, None]
            parts[:, j, :j] = move @ parts[:, j - 1, :j]
            parts[:, :j, j] = parts[:, j, :j].swapaxes(-1, -2)
    return Block(means, parts.swapaxes(2, 3).reshape(count, 6 * size, 6 * size))


def correct(
    block: Block,
    position: Array,
    noise: Array,
    rows: Array,
    details: Array | None = None,
    threshold: float = 0.0,
) -> Block:
    """The block after its plots [B, n, 2] m of covariance [B, n, 2, 2] m^2.

    rows     [r, n]  of the transform: the resolutions that are corrected
    details  [d, n]  further rows; their innovations are first reduced by `threshold` deviations
                     (soft), so noise is removed but the start of a manoeuvre is kept. The
                     covariance
                     ignores them.
    """
    count, size = position.shape[:2]
    blocks = np.zeros((count, size, 2, size, 2))
    for j in range(size):
        blocks[:, j, :, j] = noise[:, j]
    spread = blocks.reshape(count, 2 * size, 2 * size)
    innovation = position - block.mean[..., POSITION]
    mean = block.mean.reshape(count, -1)
    gain, shift, _ = _gain(block.covariance, innovation, spread, rows)
    mean = mean + np.matmul(gain, shift[..., None])[..., 0]
    if details is not None:
        more, shift, deviation = _gain(block.covariance, innovation, spread, details)
        shift = deviation * pywt.threshold(shift / deviation, threshold, 'soft')
        mean = mean + np.matmul(more, shift[..., None])[..., 0]
    seen = np.kron(rows, _OBSERVE)
    keep = np.eye(6 * size) - gain @ seen
    through = gain @ np.kron(rows, np.eye(2))
    covariance = keep @ block.covariance @ keep.swapaxes(
        1, 2
    ) + through @ spread @ through.swapaxes(1, 2)
    return Block(mean.reshape(block.mean.shape), 0.5 * (covariance + covariance.swapaxes(1, 2)))


_OBSERVE = np.eye(6)[list(POSITION)]


def _gain(
    covariance: Array, innovation: Array, spread: Array, rows: Array
) -> tuple[Array, Array, Array]:
    """H' K [B, 6n, 2r], innovations [B, 2r] at the rows' resolution, and their deviations."""
    states, plots = np.kron(rows, np.eye(6)), np.kron(rows, np.eye(2))
    observe = np.kron(np.eye(len(rows)), _OBSERVE)
    own = states @ covariance @ states.T  # P_i = H P H'
    expected = observe @ own @ observe.T + plots @ spread @ plots.T  # S = C P_i C' + R_i
    gain: Array = np.linalg.solve(expected, observe @ own).swapaxes(1, 2)  # K
    return (
        states.T @ gain,
        innovation.reshape(len(innovation), -1) @ plots.T,
        np.sqrt(np.diagonal(expected, axis1=1, axis2=2)),
    )


class Smoothed(NamedTuple):
    """mean [B, K, 6] and covariance [B, K, 6, 6] of every state, each late by up to a block."""

    mean: Array
    covariance: Array


def smooth(
    mean: Array,
    covariance: Array,
    time: Array,
    position: Array,
    noise: Array,
    manoeuvre: Manoeuvre,
    wavelet: str = 'haar',
    depth: int = COARSEST,
    threshold: float | None = None,
) -> Smoothed:
    """Smooths a history of plots block by block.

    mean [B, 6], covariance [B, 6, 6]  the state at time[:, 0]
    time [B, K+1] s; position [B, K, 2] m, noise [B, K, 2, 2] m^2: the K plots after it
    depth      of the low-pass rows that are corrected; 0 corrects all: a Kalman filter with its
               smoother inside each block
    threshold  deviations above which details count too; None for never
    ValueError if K is not a multiple of SIZE.
    """
    count = position.shape[1]
    if count % SIZE:
        raise ValueError(f'a history of {count} plots; it must be a multiple of {SIZE}')
    rows = coarse(wavelet, depth)
    details = None if threshold is None else analysis(wavelet, depth)[len(rows) :]
    steps = np.diff(time, axis=1)
    means, covariances = [], []
    for at in range(0, count, SIZE):
        part = slice(at, at + SIZE)
        block = predict(mean, covariance, steps[:, part], manoeuvre)
        block = correct(block, position[:, part], noise[:, part], rows, details, threshold or 0.0)
        mean, covariance = block.mean[:, -1], block.covariance[:, -6:, -6:]
        parts = block.covariance.reshape(-1, SIZE, 6, SIZE, 6)
        means.append(block.mean)
        covariances.append(np.stack([parts[:, j, :, j] for j in range(SIZE)], 1))
    return Smoothed(np.concatenate(means, 1), np.concatenate(covariances, 1))
