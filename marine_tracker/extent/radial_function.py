"""A star-convex outline as a radial function, with a Gaussian process over the angle.

Wahlstroem and Oezkan, IEEE T-SP 63(16), 2015; paper 004, eq 12-14. The radius at the angle b,
clockwise from the bow, is given by its values f at M angles U:

    r(b) = base(b) [m + h(b) (f - m) + e],  h(b) = k(b, U) K^-1,  e ~ N(0, v(b))
    k(a, b) = sf^2 exp(-2 sin^2(|a - b| / 2) / l^2) + sr^2

base is the radius of a plain outline (`lame`). In the paper it is a circle of 1 m, with m = 0. For
ships it is a rounded box of the size known before, and f stays near m = 1. With folds = 2 the
angle counts twice, so the stern half looks like the bow half.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array

JITTER = 1e-6  # of sf^2; keeps K invertible


class Contour(NamedTuple):
    """The prior of a radial function.

    angle       [M]     rad, U
    deviation           sf, about the mean radius; in units of base, as all that follow
    mean_deviation      sr, of the mean radius
    scale               rad, l
    folds               1, or 2 for outlines that look the same from bow and stern
    mean                m
    power               p of the base, see `lame`
    covariance  [M, M]  K
    precision   [M, M]  K^-1
    """

    angle: Array
    deviation: float
    mean_deviation: float
    scale: float
    folds: int
    mean: float
    power: float
    covariance: Array
    precision: Array


class Radius(NamedTuple):
    """Radii r(b) at any angles [..., S] of each target.

    mean      [..., S]     m
    slope     [..., S]     m/rad, dr/db
    weight    [..., S, M]  m, dr/df
    variance  [..., S]     m^2, the part that f does not determine
    """

    mean: Array
    slope: Array
    weight: Array
    variance: Array


def contour(
    points: int,
    deviation: float,
    mean_deviation: float,
    scale: float,
    folds: int = 1,
    mean: float = 0.0,
    power: float = 2.0,
) -> Contour:
    """The prior over `points` angles; ValueError unless there are 3 or more and folds is 1 or 2."""
    if points < 3:
        raise ValueError(f'an outline of {points} points; it must have at least 3')
    if folds not in (1, 2):
        raise ValueError(f'folds is {folds}; it must be 1 or 2')
    angle = np.arange(points) * 2 * np.pi / (folds * points)
    empty = np.empty((0, 0))
    prior = Contour(angle, deviation, mean_deviation, scale, folds, mean, power, empty, empty)
    covariance = kernel(prior, angle)[0] + JITTER * deviation**2 * np.eye(points)
    return prior._replace(covariance=covariance, precision=np.linalg.inv(covariance).astype(float))


def kernel(prior: Contour, angle: Array) -> tuple[Array, Array]:
    """k(b, U) and dk/db, both [..., M], at the angles [...] rad."""
    turned, points = prior.folds * np.asarray(angle)[..., None], prior.folds * prior.angle
    cosine, sine = np.cos(turned), np.sin(turned)  # of few angles; then of all differences
    along, across = np.cos(points), np.sin(points)
    squared = prior.scale**2
    # 2 sin^2(d / 2) = 1 - cos d
    bell = prior.deviation**2 * np.exp((cosine * along + sine * across - 1) / squared)
    slope = (cosine * across - sine * along) * (prior.folds / squared) * bell
    return bell + prior.mean_deviation**2, slope


def radius(prior: Contour, semi_axes: Array, f: Array, angle: Array) -> Radius:
    """Radii at the angles [N, S] rad of N targets with f [N, M] and bases of the semi-axes
    [N, 2] m, ahead and abeam."""
    k, dk = kernel(prior, angle)
    h = k @ prior.precision
    off = f - prior.mean
    base, base_slope = lame(semi_axes[:, None], prior.power, angle)
    relative = prior.mean + _dot(h, off)
    relative_slope = _dot(dk, off @ prior.precision)
    left = prior.deviation**2 + prior.mean_deviation**2 - (h * k).sum(-1)
    return Radius(
        base * relative,
        base_slope * relative + base * relative_slope,
        base[..., None] * h,
        base * base * np.maximum(left, 0.0),
    )


def lame(semi_axes: Array, power: float, angle: Array) -> tuple[Array, Array]:
    """Radius m and slope m/rad [...] of |x / a|^p + |y / b|^p = 1 (Lame's curve) at the angles
    [...] off the first of its semi-axes [..., 2] m; power p > 1: 2 for an ellipse, more for boxes.
    """
    cosine, sine = np.cos(angle), np.sin(angle)
    ahead = np.abs(cosine / semi_axes[..., 0]) ** (power - 1)
    abeam = np.abs(sine / semi_axes[..., 1]) ** (power - 1)
    ahead, abeam = (
        np.copysign(ahead, cosine) / semi_axes[..., 0],
        np.copysign(abeam, sine) / semi_axes[..., 1],
    )
    total = ahead * cosine + abeam * sine
    size = total ** (-1 / power)
    return size, (ahead * sine - abeam * cosine) * size / total


def _dot(rows: Array, vector: Array) -> Array:
    """[N, S] of rows [N, S, M] with vectors [N, M]."""
    return (rows @ vector[..., None])[..., 0]
