"""Linear-Gaussian modes of motion, many at once: the basis of `imm` and of the bank of `gwnn`.

A mode is constant velocity or a coordinated turn, with the state [e n ve vn]. All J modes of all N
tracks are computed together, as *columns* [14, J, N]: the four means, then the ten different
entries of the covariance, row by row (`PACKED`). Sums and products of whole columns cost a tenth of
products of stacked 4 x 4 matrices.

Modes may belong to several chains (IMM filters). `Chain` says which modes, and how they change.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ..types import Array, IntArray, Numbers

# Entry [i, j] of a covariance by its index among the ten packed ones, and the reverse.
ROW, COLUMN = np.triu_indices(4)
PACKED = ROW * 4 + COLUMN
UNPACKED = np.zeros((4, 4), int)
UNPACKED[ROW, COLUMN] = UNPACKED[COLUMN, ROW] = np.arange(10)
LEAST_WEIGHT = 1e-12  # keeps every mode possible


class Transition(NamedTuple):
    """A mode chain in continuous time: its eigenvectors as columns, their inverse [J, J] each, and
    the rates [J] 1/s of decay.
    """

    vectors: Array
    inverse: Array
    decay: Array

    def __call__(self, step: Array) -> Array:
        """The transition matrices [N, J, J] over steps [N] s."""
        count = len(self.decay)
        outer = (self.vectors.T[:, :, None] * self.inverse[:, None, :]).reshape(count, -1)
        powers = np.exp(np.abs(step)[:, None] * self.decay)
        found = (powers @ outer).reshape(-1, count, count)
        value: Array = np.minimum(np.maximum(found, 0.0, out=found), 1.0, out=found)
        return value

    def carry(self, values: Array, step: Array) -> Array:
        """The sums [..., J, N] over the modes from which each is entered, of the values [..., J, N]
        of these. step [N] s, or [1] for all. No matrix for each track: a third of the time.
        """
        powers = np.exp(self.decay[:, None] * np.abs(step))
        found: Array = self.inverse.T @ ((self.vectors.T @ values) * powers)
        return found


class Chain(NamedTuple):
    """Modes that a target changes between.

    modes  a slice of the bank's modes
    over   the transition matrices, by the step
    """

    modes: slice
    over: Transition


class Bank(NamedTuple):
    """The modes of a bank. A mode in no chain is a filter of its own.

    noise      [J, 1]  m^2/s^3, density of the white acceleration of each axis
    turn_rate  [J, 1]  rad/s, clockwise positive; 0 for constant velocity
    chains     the IMM filters among them
    rates      [U, 1]  rad/s, the different absolute values of turn_rate
    size       [J]     index into rates for each mode; modes with equal rates share a sine, which
    costs as much as twenty products
    """

    noise: Array
    turn_rate: Array
    chains: tuple[Chain, ...]
    rates: Array
    size: IntArray


def bank(noise: Numbers, turn_rate: Numbers, chains: Iterable[Chain]) -> Bank:
    """A bank from plain sequences."""
    turn = np.array(turn_rate, float)
    rates, size = np.unique(np.abs(turn), return_inverse=True)
    return Bank(np.array(noise, float)[:, None], turn[:, None], tuple(chains), rates[:, None], size)


def straight(noise: Array) -> Bank:
    """A bank of constant-velocity filters: noise [J, 1], or [J, N] where tracks differ."""
    count = len(noise)
    return Bank(noise, np.zeros((count, 1)), (), np.zeros((1, 1)), np.zeros(count, int))


def transition_power(stay: Numbers, period: float, entered: Numbers | None = None) -> Transition:
    """A mode chain in continuous time.

    stay     [J]  probability to be in the same mode `period` s later
    entered  [J]  relative probability of each mode when another one is left; equal by default
    """
    staying = np.asarray(stay, float)
    count = len(staying)
    share = np.ones(count) if entered is None else np.asarray(entered, float)
    # Such a chain is reversible: after rescaling, its matrix is symmetric. A symmetric matrix
    # allows equal eigenvalues, which equal modes have. The floor is for modes that are never left.
    rate = np.maximum(1 - staying, 1e-12) / np.maximum(share.sum() - share, 1e-12)
    matrix = np.sqrt(np.outer(rate * share, rate * share))
    np.fill_diagonal(matrix, staying)
    values, vectors = np.linalg.eigh(matrix)
    if values.min() <= 0:
        raise ValueError(
            f'stay probabilities {tuple(staying)} are too small for a chain in '
            'continuous time; they must be well above 1 / number of modes'
        )
    scale = np.sqrt(rate / share)[:, None]
    vectors, inverse = scale * vectors, vectors.T / scale.T
    return Transition(vectors, inverse, np.log(values) / period)


def stationary(chain: Chain) -> Array:
    """The stationary distribution [J] of a chain."""
    found: Array = chain.over(np.array([1e6]))[0, 0]
    return found


def pack(mean: Array, covariance: Array) -> Array:
    """Rows [N, J, 14] of means [N, J, 4] and covariances [N, J, 4, 4]."""
    entries = covariance.reshape(covariance.shape[:2] + (16,)).take(PACKED, 2)
    return np.concatenate([mean, entries], 2)


def unpack(rows: Array) -> tuple[Array, Array]:
    """Means [..., 4] and covariances [..., 4, 4] of rows [..., 14]."""
    return rows[..., :4], rows[..., 4:].take(UNPACKED, -1)


def columns_of(rows: Array) -> Array:
    """Columns [14, J, N] of rows [N, J, 14], always a copy."""
    return rows.transpose(2, 1, 0).copy()


def rows_of(columns: Array) -> Array:
    """Rows [N, J, 14] of columns [14, J, N], always a copy."""
    return columns.transpose(2, 1, 0).copy()


def _shares(chain: Chain, weight: Array, step: Array) -> tuple[Array, Array]:
    """Mode probabilities after the step, and the mixing weights [N, to, from] of each mode.

    step [N] s, or [1] for all.
    """
    joint = chain.over(step).swapaxes(1, 2) * weight[:, None, :]  # to j from i
    ahead = joint.sum(2)
    joint /= ahead[:, :, None]
    return ahead, joint


def mix(bank: Bank, rows: Array, weight: Array, step: Array) -> tuple[Array, Array]:
    """Columns [14, J, N] and weights [N, J] after the mode changes over the steps [N] s.

    Takes rows [N, J, 14]. Blom and Bar-Shalom, IEEE T-AC 33(8), 1988, eq 7-9, in second moments:
    the moments of a mixture are the mixture of the moments of its parts.
    """
    columns = columns_of(rows)
    centre = columns[:4, :1].copy()  # keeps the squares small
    columns[:4] -= centre
    _add_squares(columns, np.add)
    moments, weight = rows_of(columns), weight.copy()
    for chain in bank.chains:
        weight[:, chain.modes], share = _shares(chain, weight[:, chain.modes], step)
        moments[:, chain.modes] = np.matmul(share, moments[:, chain.modes])
    columns = columns_of(moments)
    _add_squares(columns, np.subtract)
    columns[:4] += centre
    return columns, weight


def _add_squares(columns: Array, add: np.ufunc) -> None:
    """Add the square of the means to the covariances (or subtract it), in place."""
    for k, (i, j) in enumerate(zip(ROW, COLUMN), 4):
        add(columns[k], columns[i] * columns[j], out=columns[k])


def mix_means(bank: Bank, columns: Array, weight: Array, step: Array) -> tuple[Array, Array]:
    """As `mix`, for the means only: columns [4, J, N] and weights [J, N], before and after.

    step [N] s, or [1] for all.
    """
    columns, weight = columns.copy(), weight.copy()
    centre = columns[:, :1].copy()  # keeps the products small
    columns -= centre
    for chain in bank.chains:
        own = columns[:, chain.modes]
        own *= weight[chain.modes]
        columns[:, chain.modes] = chain.over.carry(own, step)
        weight[chain.modes] = chain.over.carry(weight[chain.modes], step)
        columns[:, chain.modes] /= weight[chain.modes]
    columns += centre
    return columns, weight


def _turn(bank: Bank, step: Array) -> tuple[Array, Array, Array, Array]:
    """sin and cos [J, N] of the turn angles; metres along and across per m/s of velocity."""
    angle = bank.rates * step
    sin, cos = np.sin(angle), np.cos(angle)
    none = bank.rates == 0
    divisor = np.where(none, 1.0, bank.rates)
    along, across = np.where(none, step, sin / divisor), (1 - cos) / divisor
    side = np.sign(bank.turn_rate)
    return side * sin[bank.size], cos[bank.size], along[bank.size], side * across[bank.size]


def move_means(bank: Bank, mean: Array, step: Array) -> Array:
    """Means [4, J, N] moved by the steps [N] s, or [1] for all."""
    sin, cos, along, across = _turn(bank, step)
    e, n, ve, vn = mean
    return np.stack(
        [
            e + along * ve + across * vn,
            n - across * ve + along * vn,
            cos * ve + sin * vn,
            cos * vn - sin * ve,
        ]
    )


def move(bank: Bank, columns: Array, step: Array) -> Array:
    """Columns [14, J, N] moved by the steps [N] s, of either sign; noise grows with |step|.

    With A = [[1, G], [0, R]] and P = [[X, C], [C', V]]: D = C + G V, then X + G C' + D G',
    D R' and R V R'.
    """
    s, c, a, b = _turn(bank, step)
    e, n, ve, vn, xee, xen, cee, cen, xnn, cne, cnn, vee, ven, vnn = columns
    out = np.empty_like(columns)
    out[0], out[1] = e + a * ve + b * vn, n - b * ve + a * vn
    out[2], out[3] = c * ve + s * vn, c * vn - s * ve
    dee, den = cee + a * vee + b * ven, cen + a * ven + b * vnn
    dne, dnn = cne - b * vee + a * ven, cnn - b * ven + a * vnn
    size = np.abs(step)
    noise = bank.noise * size
    out[4] = xee + a * (cee + dee) + b * (cen + den) + noise * (size * size / 3)
    out[5] = xen + a * (cne + den) + b * (cnn - dee)
    out[8] = xnn + a * (cnn + dnn) - b * (cne + dne) + noise * (size * size / 3)
    half = noise * (size / 2)
    out[6], out[7] = c * dee + s * den + half, c * den - s * dee
    out[9], out[10] = c * dne + s * dnn, c * dnn - s * dne + half
    cc, ss, cs = c * c, s * s, c * s
    out[11] = cc * vee + 2 * cs * ven + ss * vnn + noise
    out[12] = (cc - ss) * ven + cs * (vnn - vee)
    out[13] = ss * vee - 2 * cs * ven + cc * vnn + noise
    return out


def innovate(
    columns: Array, plot: Array, noise: Array
) -> tuple[tuple[Array, Array], Array, tuple[Array, Array, Array, Array]]:
    """Innovations [2, J, N], their squared distances [J, N] and the parts of their inverse
    covariances.

    plot [2, N] m; noise [3, N] m^2: its covariance's ee, en, nn. The parts are ee, en, nn and the
    determinant of S, each [J, N].
    """
    de, dn = plot[0] - columns[0], plot[1] - columns[1]
    see, sen, snn = columns[4] + noise[0], columns[5] + noise[1], columns[8] + noise[2]
    determinant = see * snn - sen * sen
    distance = (snn * de * de - 2 * sen * de * dn + see * dn * dn) / determinant
    return (de, dn), distance, (see, sen, snn, determinant)


def correct(columns: Array, plot: Array, noise: Array) -> tuple[Array, Array]:
    """Kalman update of columns [14, J, N] with one plot a track; also the log-likelihoods [J, N].

    plot [2, N] m; noise [3, N] m^2: its covariance's ee, en, nn. Log-likelihoods are up to a
    constant.
    """
    (de, dn), distance, (see, sen, snn, determinant) = innovate(columns, plot, noise)
    iee, ien, inn = snn / determinant, -sen / determinant, see / determinant
    ye, yn = iee * de + ien * dn, ien * de + inn * dn  # inv(S) innovation
    first, second = columns[[4, 5, 6, 7]], columns[[5, 8, 9, 10]]  # rows of H P
    out = np.empty_like(columns)
    out[:4] = columns[:4] + first * ye + second * yn
    gain_first, gain_second = iee * first + ien * second, ien * first + inn * second
    for k, (i, j) in enumerate(zip(ROW, COLUMN)):
        out[4 + k] = columns[4 + k] - first[i] * gain_first[j] - second[i] * gain_second[j]
    return out, -0.5 * (distance + np.log(determinant))


def reweigh(weight: Array, score: Array) -> Array:
    """Mode probabilities [J, N] of one chain after plots with the log-likelihoods [J, N]."""
    weight = weight * np.exp(score - score.max(0)) + LEAST_WEIGHT
    found: Array = weight / weight.sum(0)
    return found


def combine(columns: Array, weight: Array) -> Array:
    """Mean and covariance [14, N] of mixtures of columns [14, J, N] with the weights [J, N]."""
    mean = (columns[:4] * weight).sum(1)
    apart = columns[:4] - mean[:, None]
    out = np.empty((14, columns.shape[2]))
    out[:4] = mean
    for k, (i, j) in enumerate(zip(ROW, COLUMN)):
        out[4 + k] = ((columns[4 + k] + apart[i] * apart[j]) * weight).sum(0)
    return out


def packed_noise(covariance: Array) -> Array:
    """[3, N] ee, en, nn of plots' covariances [N, 2, 2]."""
    return np.stack([covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]])
