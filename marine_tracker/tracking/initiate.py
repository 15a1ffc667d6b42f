"""New tracks from the plots that no track took."""

import numpy as np

from ..geometry import to_range_bearing
from ..types import Plots
from .gate import window_pairs


def pair_up(before: Plots, now: Plots, max_speed: float, size: float):
    """Rows (first [P], second [P]) of plots of two scans that one target may have given.

    A pair fits when the way between its plots, less what noise explains (squared Mahalanobis
    distance `size`), asks for no more than max_speed, m/s. Every plot is used at most once, the
    slowest pair first: a plot has one target, and clutter does not breed.
    """
    nothing = np.zeros(0, np.int64)
    if not len(before.time) or not len(now.time):
        return nothing, nothing
    period = now.time.max() - before.time.min()
    reach = np.sqrt(size)
    origin = now.origin[0]
    distance, bearing = to_range_bearing(before.position - origin)
    noise = reach * np.sqrt(2 * np.trace(before.covariance, axis1=1, axis2=2))
    away = max_speed * period + 1.5 * noise + np.hypot(*(now.origin - origin).T).max()
    half_width = np.where(distance > away,
                          np.arcsin(np.minimum(away / np.maximum(distance, away), 1.0)), np.pi)
    where, towards = to_range_bearing(now.position - origin)
    first, second = window_pairs(distance - away, distance + away, bearing, half_width,
                                 where, towards)
    step = now.time[second] - before.time[first]
    way = now.position[second] - before.position[first]
    length = np.hypot(*way.T)
    spread = before.covariance[first] + now.covariance[second]
    # Noise along the way, then the speed that remains.
    unit = way / np.maximum(length, 1e-9)[:, None]
    sigma = np.sqrt(np.einsum('pi,pij,pj->p', unit, spread, unit))
    excess = np.maximum(length - max_speed * step, 0.0) / sigma
    fits = (excess ** 2 <= size) & (step > 0)
    first, second = first[fits], second[fits]
    return _greedy(first, second, (length / sigma)[fits])


def _greedy(first, second, cost):
    """One-to-one pairs, cheapest first."""
    order = np.argsort(cost, kind='stable')
    first, second = first[order], second[order]
    keep = []
    while len(first):
        # A pair that is the first to name both its plots is certainly taken.
        lead = np.zeros(len(first), bool)
        lead[np.unique(first, return_index=True)[1]] = True
        other = np.zeros(len(second), bool)
        other[np.unique(second, return_index=True)[1]] = True
        taken = lead & other
        keep.append((first[taken], second[taken]))
        rest = ~(np.isin(first, first[taken]) | np.isin(second, second[taken]))
        first, second = first[rest], second[rest]
    if not keep:
        return first, second
    return np.concatenate([a for a, _ in keep]), np.concatenate([b for _, b in keep])
