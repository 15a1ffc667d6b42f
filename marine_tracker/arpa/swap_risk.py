"""Targets that may take each other's plots, because their gates overlap."""

import numpy as np

from ..geometry import to_range_bearing
from ..tracking.gate import window_pairs
from ..types import Array, IntArray

MIXTURES = 0.5 - 0.49 * np.cos(np.linspace(0, np.pi, 15))[:, None]  # denser at the ends
EASE = 1.25  # gates are searched at this factor of their size


def swap_risk(
    position: Array, covariance: Array, origin: Array, size: float
) -> tuple[Array, IntArray]:
    """Overlap [N] of each track's gate with that of another, and the row [N] of that track.

    position    [N, 2]     m, where the tracks are expected next
    covariance  [N, 2, 2]  m^2, of a plot about it
    origin      [2]        m, of the radar
    size        of the gate, squared Mahalanobis distance (tracking.gate.gate_size)

    The overlap is the squared factor by which the two gates must be scaled to touch. Below 1 they
    overlap; inf and -1 if no other track is near. It is the maximum of l (1 - l) d' [(1 - l) A + l
    B]^-1 d over 0 < l < 1 (Perram and Wertheim 1985, "Statistical mechanics of hard ellipsoids", J.
    Comput. Phys. 58). The maximum is taken on a grid, so the result is at most some per cent too
    small: on the safe side. In a crowd only the nearest others are looked at
    (tracking.pair_budget).
    """
    count = len(position)
    overlap, other = np.full(count, np.inf), np.full(count, -1)
    distance, bearing = to_range_bearing(position - origin)
    a, b, d = covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]
    reach = np.sqrt(size * (0.5 * (a + d) + np.hypot(0.5 * (a - d), b)))
    # In each pair, the track with the longer reach finds the other one within twice that reach.
    far = 2 * EASE * reach
    half_width = np.where(
        far < distance, np.arcsin(np.minimum(far / np.maximum(distance, 1e-9), 1.0)), np.pi
    )
    one, two, _ = window_pairs(
        distance, distance - far, distance + far, bearing, half_width, distance, bearing
    )
    apart = position[one] - position[two]
    close = np.hypot(*apart.T) < EASE * (reach[one] + reach[two])
    close &= (reach[one] > reach[two]) | ((reach[one] == reach[two]) & (one < two))
    one, two, (x, y) = one[close], two[close], apart[close].T
    if not len(one):
        return overlap, other

    def mixed(part: Array) -> Array:
        return (1 - MIXTURES) * part[one] + MIXTURES * part[two]

    a, b, d = mixed(a), mixed(b), mixed(d)
    form = (d * x * x - 2 * b * x * y + a * y * y) / (a * d - b * b)
    value = (MIXTURES * (1 - MIXTURES) * form).max(0) / size
    one, two, value = np.append(one, two), np.append(two, one), np.append(value, value)
    order = np.lexsort((value, one))
    first = order[np.unique(one[order], return_index=True)[1]]
    overlap[one[first]], other[one[first]] = value[first], two[first]
    return overlap, other
