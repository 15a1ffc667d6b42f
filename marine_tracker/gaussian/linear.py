"""Operations on many small matrices at once, shared by the Kalman filters.

Shapes may have any leading axes [...]. H picks the two position entries of a state.
"""

import numpy as np

from ..types import Array


def invert_2x2(matrix: Array) -> tuple[Array, Array]:
    """Inverse [..., 2, 2] and determinant [...] of symmetric 2 x 2 matrices."""
    a, b, d = matrix[..., 0, 0], matrix[..., 0, 1], matrix[..., 1, 1]
    determinant = a * d - b * b
    inverse = np.empty_like(matrix)
    inverse[..., 0, 0] = d
    inverse[..., 1, 1] = a
    inverse[..., 0, 1] = inverse[..., 1, 0] = -b
    inverse /= determinant[..., None, None]
    return inverse, determinant


def sandwich(matrix: Array, symmetric: Array) -> Array:
    """A P A' [..., m, m] for A [..., m, n] and symmetric P [..., n, n].

    The transpose is copied: a product with a transposed view takes twice the time.
    """
    half = np.matmul(matrix, symmetric)
    found: Array = np.matmul(matrix, np.ascontiguousarray(half.swapaxes(-1, -2)))
    return found


def kalman_update(
    mean: Array, covariance: Array, innovation: Array, noise: Array, position: tuple[int, int]
) -> tuple[Array, Array, Array, Array]:
    """Joint Kalman update of states [..., n] with one position measurement each.

    covariance [..., n, n]; innovation [..., 2] m; noise [..., 2, 2] m^2; position: the two
    indices of the position in the state. Returns mean, covariance and the inverse
    [..., 2, 2] and determinant [...] of the innovation covariance.
    """
    cross = covariance.take(position, -2)  # H P
    spread = cross.take(position, -1) + noise  # S = H P H' + R
    inverse, determinant = invert_2x2(spread)
    gain = np.matmul(inverse, cross)  # K'
    mean = mean + np.matmul(innovation[..., None, :], gain)[..., 0, :]
    covariance = covariance - np.matmul(gain.swapaxes(-1, -2), cross)
    return mean, covariance, inverse, determinant


def weighted_fusion(
    first: Array, first_noise: Array, second: Array, second_noise: Array
) -> tuple[Array, Array]:
    """Combines two measurements of one position: positions [..., 2] m and covariances [..., 2, 2]
    m^2.

    Weighted by their accuracy. A Kalman update with the result equals updates with both, one after
    the other.
    """
    gain = np.matmul(first_noise, invert_2x2(first_noise + second_noise)[0])
    return (
        first + np.matmul(gain, (second - first)[..., None])[..., 0],
        first_noise - np.matmul(gain, first_noise),
    )


def squared_distance(innovation: Array, inverse: Array) -> Array:
    """Squared Mahalanobis distance [...] of innovations [..., 2] by the inverse [..., 2, 2]."""
    east, north = innovation[..., 0], innovation[..., 1]
    return (
        inverse[..., 0, 0] * east * east
        + 2 * inverse[..., 0, 1] * east * north
        + inverse[..., 1, 1] * north * north
    )
