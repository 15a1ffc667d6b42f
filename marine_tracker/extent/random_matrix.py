"""Centroid, motion and elliptic extent of targets by a random matrix.

Feldmann, Fraenken, Koch, IEEE T-SP 59(4), 2011. The extent X is a symmetric matrix, m^2. Its
outline is the ellipse p' X^-1 p = 1 about the centroid. Cells have the covariance Y = z_s X + R
about the centroid. z_s describes how the scatterers are distributed; R is the noise of one cell.

All functions take and return rows of N targets. Rows that had no cluster are not named.
"""

from typing import NamedTuple

import numpy as np

from ..estimators.contract import Velocity
from ..gaussian.linear import invert_2x2, kalman_update
from ..geometry import unit_vector
from ..types import Array, IntArray, put, take

SURFACE, CONTOUR = 1 / 4, 1 / 2  # z_s of scatterers over a whole ellipse, and along its outline
NO_MEMORY = 2.0  # at this weight an extent carries no information
BOX_SPREAD = np.sqrt(3.0)  # length over sqrt(X) of a filled box: L^2 / 12 = X / 4
ELLIPSE = 2.0  # the same of the ellipse itself
AXIS_UNKNOWN = np.pi / np.sqrt(12)  # rad, deviation of an axis of unknown direction


class Model(NamedTuple):
    """The assumptions about a class of targets.

    noise   m^2/s^3, density of the white acceleration of each axis
    memory  s, in which the weight of the past extent falls to 1/e
    spread  z_s
    """

    noise: float
    memory: float
    spread: float


SHIP = Model(noise=0.0025, memory=120.0, spread=SURFACE)


class RandomMatrixState(NamedTuple):
    """One row a target.

    time        [N]        s
    mean        [N, 4]     centroid m and velocity m/s, [e n ve vn]
    covariance  [N, 4, 4]
    extent      [N, 2, 2]  m^2, X
    weight      [N]        degrees of freedom of X: about the number of cells that it is based on
    """

    time: Array
    mean: Array
    covariance: Array
    extent: Array
    weight: Array


class Measures(NamedTuple):
    """A target's size and heading with standard deviations, one row a target.

    length, length_sd  [N]  m
    beam, beam_sd      [N]  m; an upper bound where the smear is as wide as the ship
    axis, axis_sd      [N]  rad in [0, pi) clockwise from north: the heading, bow or stern
    """

    length: Array
    length_sd: Array
    beam: Array
    beam_sd: Array
    axis: Array
    axis_sd: Array


def start(
    time: Array,
    position: Array,
    covariance: Array,
    velocity: Velocity,
    extent: Array,
    weight: Array | float = 6.0,
) -> RandomMatrixState:
    """New rows.

    time [N] s; position [N, 2] m of the centroid with covariance [N, 2, 2] m^2; velocity a
    `contract.Velocity` of N rows; extent [N, 2, 2] m^2, a first guess; weight of that guess, a
    number or [N].
    """
    count = len(time)
    mean = np.concatenate([position, velocity.mean], 1)
    joint = np.zeros((count, 4, 4))
    joint[:, :2, :2], joint[:, 2:, 2:] = covariance, velocity.covariance
    return RandomMatrixState(
        np.array(time, float), mean, joint, np.array(extent, float), np.full(count, weight, float)
    )


def predict(state: RandomMatrixState, time: Array, model: Model = SHIP) -> RandomMatrixState:
    """Predicts all rows to the times [N] s: straight motion; the extent stays and loses weight."""
    step = time - state.time
    mean = state.mean.copy()
    mean[:, :2] += step[:, None] * mean[:, 2:]
    of_axis, noise = constant_velocity(step)
    transition = np.kron(of_axis, np.eye(2))
    covariance = transition @ state.covariance @ transition.swapaxes(1, 2) + model.noise * np.kron(
        noise, np.eye(2)
    )
    kept = np.exp(-np.abs(step) / model.memory)
    return RandomMatrixState(
        np.array(time, float),
        mean,
        covariance,
        state.extent,
        NO_MEMORY + kept * (state.weight - NO_MEMORY),
    )


def constant_velocity(step: Array) -> tuple[Array, Array]:
    """Transition [N, 2, 2] of [x v] over the steps [N] s; and the process covariance [N, 2, 2] of
    white acceleration with unit density.
    """
    size = np.abs(step)
    transition = np.tile(np.eye(2), (len(step), 1, 1))
    transition[:, 0, 1] = step
    noise = np.empty_like(transition)
    noise[:, 0, 0], noise[:, 1, 1] = size**3 / 3, size
    noise[:, 0, 1] = noise[:, 1, 0] = step * size / 2
    return transition, noise


def update(
    state: RandomMatrixState,
    rows: IntArray,
    centroid: Array,
    scatter: Array,
    count: IntArray,
    noise: Array,
    model: Model = SHIP,
) -> RandomMatrixState:
    """Updates the K named rows, which are predicted to their clusters' times, with one cluster
    each.

    centroid [K, 2] m; scatter [K, 2, 2] m^2, the sum over the cells of d d' with d from the
    centroid; count [K] >= 1 cells; noise [K, 2, 2] m^2, R of a single cell.
    """
    before = take(state, rows)
    count = np.asarray(count, float)[:, None, None]
    cells = cell_covariance(before.extent, noise, model)  # Y
    innovation = centroid - before.mean[:, :2]
    mean, covariance, inverse, _ = kalman_update(
        before.mean, before.covariance, innovation, cells / count, (0, 1)
    )
    root = root_2x2(before.extent)
    by_centroid = root @ root_2x2(inverse)  # X^.5 S^-.5
    by_cells = root @ root_2x2(invert_2x2(cells)[0])  # X^.5 Y^-.5
    pulled = by_centroid @ innovation[..., None]
    weight = before.weight + count[:, 0, 0]
    extent = (
        before.weight[:, None, None] * before.extent
        + pulled @ pulled.swapaxes(1, 2)
        + by_cells @ scatter @ by_cells.swapaxes(1, 2)
    ) / weight[:, None, None]
    return put(state, rows, RandomMatrixState(before.time, mean, covariance, extent, weight))


def cell_covariance(extent: Array, noise: Array, model: Model = SHIP) -> Array:
    """Y [..., 2, 2] m^2 of cells about their centroid; extent and noise [..., 2, 2] m^2."""
    return model.spread * extent + noise


def root_2x2(matrix: Array) -> Array:
    """The symmetric root [..., 2, 2] of symmetric positive definite 2 x 2 matrices."""
    root = np.sqrt(
        np.maximum(
            matrix[..., 0, 0] * matrix[..., 1, 1] - matrix[..., 0, 1] * matrix[..., 1, 0], 0.0
        )
    )
    trace = matrix[..., 0, 0] + matrix[..., 1, 1]
    found: Array = (matrix + root[..., None, None] * np.eye(2)) / np.sqrt(trace + 2 * root)[
        ..., None, None
    ]
    return found


def measures(
    state: RandomMatrixState, noise: Array, model: Model = SHIP, size: float = BOX_SPREAD
) -> Measures:
    """Length, beam and axis of all rows; size: BOX for hulls, ELLIPSE.

    noise [N, 2, 2] m^2, R of a single cell, widens the deviations. The deviations hold for `weight`
    independent cells. If cells share an echo, they are wrong by a factor.
    """
    axis = axis_of(state.extent)
    line = unit_vector(axis)
    side = unit_vector(axis + np.pi / 2)

    def between(matrix: Array, a: Array, b: Array) -> Array:
        found: Array = np.einsum('ni,nij,nj->n', a, matrix, b)
        return found

    along, across = (between(state.extent, unit, unit) for unit in (line, side))
    cells = cell_covariance(state.extent, noise, model)
    lengthwise, abeam = between(cells, line, line), between(cells, side, side)
    # A sample covariance of n cells has the variance (Y_ij^2 + Y_ii Y_jj) / n.
    share = model.spread * np.sqrt(state.weight)
    length, beam = size * np.sqrt(along), size * np.sqrt(across)
    turn = np.sqrt(lengthwise * abeam + between(cells, line, side) ** 2) / share
    return Measures(
        length,
        length * np.sqrt(0.5) * lengthwise / (share * along),
        beam,
        beam * np.sqrt(0.5) * abeam / (share * across),
        axis,
        np.minimum(turn / np.maximum(along - across, 1e-9), AXIS_UNKNOWN),
    )


def axis_of(extent: Array) -> Array:
    """Bearing [...] rad in [0, pi) of the long axis of extents [..., 2, 2]."""
    half = 0.5 * np.arctan2(2 * extent[..., 0, 1], extent[..., 1, 1] - extent[..., 0, 0])
    return np.mod(half, np.pi)
