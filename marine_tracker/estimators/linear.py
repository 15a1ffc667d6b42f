"""Small matrices, many at once: what the Kalman filters share.

Shapes lead with any axes [...]; H picks the two position entries of a state.
"""

import numpy as np


def first_velocity_variance(max_speed: float) -> float:
    """Variance, m^2/s^2 an axis, of a velocity known only to be of at most max_speed, m/s."""
    return (max_speed / 2) ** 2         # that of a uniform density on the disc


def invert_2x2(matrix):
    """Inverse [..., 2, 2] and determinant [...] of symmetric 2 x 2 matrices."""
    a, b, d = matrix[..., 0, 0], matrix[..., 0, 1], matrix[..., 1, 1]
    determinant = a * d - b * b
    inverse = np.empty_like(matrix)
    inverse[..., 0, 0] = d
    inverse[..., 1, 1] = a
    inverse[..., 0, 1] = inverse[..., 1, 0] = -b
    inverse /= determinant[..., None, None]
    return inverse, determinant


def kalman_update(mean, covariance, innovation, noise, position):
    """Joint Kalman update of states [..., n] with one position measurement each.

    covariance [..., n, n]; innovation [..., 2] m; noise [..., 2, 2] m^2; position: the two
    indices of the position in the state. Returns mean, covariance and (nis [...], determinant
    of the innovation covariance [...]), from which a model likelihood follows.
    """
    east, north = position
    cross = covariance[..., [east, north]]                          # P H'
    spread = cross[..., [east, north], :] + noise                   # S = H P H' + R
    inverse, determinant = invert_2x2(spread)
    gain_e = cross[..., 0] * inverse[..., 0, 0, None] + cross[..., 1] * inverse[..., 0, 1, None]
    gain_n = cross[..., 0] * inverse[..., 0, 1, None] + cross[..., 1] * inverse[..., 1, 1, None]
    de, dn = innovation[..., 0, None], innovation[..., 1, None]
    covariance = covariance - gain_e[..., None] * cross[..., None, :, 0]
    covariance -= gain_n[..., None] * cross[..., None, :, 1]
    nis = (inverse[..., 0, 0] * de[..., 0] ** 2 + 2 * inverse[..., 0, 1] * de[..., 0] * dn[..., 0]
           + inverse[..., 1, 1] * dn[..., 0] ** 2)
    return mean + gain_e * de + gain_n * dn, covariance, (nis, determinant)
