"""Distributions of uncertain vectors, by direction: exact where a Jacobian is not.

Range and bearing, course and speed, and CPA all come from vectors that are Gaussian in east and
north. They are not nearly Gaussian themselves if the vector is not much longer than its error: a
ship at rest, a target close by, a CPA near 0. But for a given direction everything is Gaussian and
in closed form. So only one integral over the direction remains.

The direction is measured where the vector's errors are round: v = A z, z Gaussian of unit
covariance, A A' the covariance of v. There the density of the direction is a bell whose width
depends only on the length of the mean of z: the shorter the mean, the wider the bell.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from ..types import Array, take

NODES = 32
# Rules of nodes and weights: EVEN for bells and full turns.
EVEN = (np.arange(NODES) + 0.5) * 2 / NODES - 1, np.full(NODES, 2 / NODES)
GAUSS = np.polynomial.legendre.leggauss(NODES)  # for intervals that end at an edge
BENT = 0.1  # of the deviation along a vector: where the arc of the deviation across
# bends by less, a Jacobian is as good, and cheaper
WIDE = 5.0  # deviations beyond which a Gaussian is held to be over


class Round(NamedTuple):
    """Gaussian vectors [N] as z = A^-1 v.

    ee, ne, nn   [N]  the entries of A, lower triangular: v = [ee z0, ne z0 + nn z1]
    length       [N]  of the mean of z
    angle        [N]  rad, of the mean of z, from its first axis to its second
    arc          [N]  rad: largest angle between z and its mean; pi if z may point anywhere
    """

    ee: Array
    ne: Array
    nn: Array
    length: Array
    angle: Array
    arc: Array


class Directions(NamedTuple):
    """N vectors seen along Q directions each; all [N, Q].

    z = rho [cos, sin], rho > 0, cut off at 0 from a Gaussian of unit variance
    cos, sin   of the direction of z
    off        z's mean across it: [-sin, cos] . mean
    rho        rho's mean before the cut
    density    weight in the integral, without rho's part, E[rho; rho > 0]
    gain       m/s of v a unit of rho
    east, north  of the unit vector along v
    """

    cos: Array
    sin: Array
    off: Array
    rho: Array
    density: Array
    gain: Array
    east: Array
    north: Array


class Places(NamedTuple):
    """A Gaussian position p given the direction of v; all [N, Q].

    A target that keeps the direction will pass at distance `miss`, and has -`along` to go to its
    CPA.
    miss, miss_variance    m, m^2: p across the direction, positive to starboard
    along, along_variance  m, m^2: p along it
    with_rho               m: covariance of `along` and rho
    """

    miss: Array
    miss_variance: Array
    along: Array
    along_variance: Array
    with_rho: Array


def rounded(vector: Array, covariance: Array) -> Round:
    """Rounds vectors [N, 2] with invertible covariance [N, 2, 2]."""
    ee = np.sqrt(covariance[:, 0, 0])
    ne = covariance[:, 0, 1] / ee
    nn = np.sqrt(covariance[:, 1, 1] - ne * ne)
    first = vector[:, 0] / ee
    second = (vector[:, 1] - ne * first) / nn
    length = np.hypot(first, second)
    sine = WIDE / np.maximum(length, WIDE)
    return Round(
        ee,
        ne,
        nn,
        length,
        np.arctan2(second, first),
        np.where(length > WIDE, np.arcsin(sine), np.pi),
    )


def directions(of: Round, low: Array, high: Array, rule: tuple[Array, Array]) -> Directions:
    """Directions from low [N] to high [N] rad relative to the mean of z; rule: nodes and weights
    [Q].
    """
    nodes, weights = rule
    half = 0.5 * (high - low)[:, None]
    turn = 0.5 * (high + low)[:, None] + half * nodes
    off, rho = -of.length[:, None] * np.sin(turn), of.length[:, None] * np.cos(turn)
    density = half * weights * np.exp(-0.5 * off * off) / np.sqrt(2 * np.pi)
    turn += of.angle[:, None]
    cos, sin = np.cos(turn), np.sin(turn)
    east, north = of.ee[:, None] * cos, of.ne[:, None] * cos + of.nn[:, None] * sin
    gain = np.hypot(east, north)
    return Directions(cos, sin, off, rho, density, gain, east / gain, north / gain)


def places(position: Array, covariance: Array, of: Round, at: Directions) -> Places:
    """Positions [N, 2] of joint covariance [N, 4, 4] with the vectors `of`."""
    (ee, en, ce, cf), (_, nn, de, df) = covariance.transpose(1, 2, 0)[:2, :, :, None]
    # Regression on z: p = mean + G (z - mean of z) + rest; G = (covariance of p and v) A'^-1.
    a, b, d = of.ee[:, None], of.ne[:, None], of.nn[:, None]
    ge, he = ce / a, de / a
    gn, hn = (cf - b * ge) / d, (df - b * he) / d
    rest_ee, rest_nn = ee - ge * ge - gn * gn, nn - he * he - hn * hn
    rest_en = en - ge * he - gn * hn
    # Along the direction z - its mean is (rho - its mean) [cos, sin] - off [-sin, cos].
    east = position[:, :1] - at.off * (gn * at.cos - ge * at.sin)
    north = position[:, 1:] - at.off * (hn * at.cos - he * at.sin)
    by_rho_e, by_rho_n = ge * at.cos + gn * at.sin, he * at.cos + hn * at.sin
    across = by_rho_e * at.north - by_rho_n * at.east
    along = by_rho_e * at.east + by_rho_n * at.north
    both = 2 * rest_en * at.east * at.north
    e2, n2 = at.east * at.east, at.north * at.north
    return Places(
        east * at.north - north * at.east,
        rest_ee * n2 - both + rest_nn * e2 + across * across,
        east * at.east + north * at.north,
        rest_ee * e2 + both + rest_nn * n2 + along * along,
        along,
    )


def moments(mean: Array) -> tuple[Array, Array, Array, Array]:
    """E[x^k; mean + x > 0], k = 0..3, of a standard normal x."""
    over, bell = ndtr(mean), np.exp(-0.5 * mean * mean) / np.sqrt(2 * np.pi)
    return over, bell, over - mean * bell, (mean * mean + 2) * bell


def polar_sigma(vector: Array, covariance: Array) -> tuple[Array, Array]:
    """RMS deviations [N] of the length and [N] rad of the direction of Gaussian vectors.

    vector [N, 2]; covariance [N, 2, 2]. Both are counted from the length and direction of `vector`
    itself, because that is shown.
    """
    length = np.hypot(*vector.T)
    unit = vector / np.maximum(length, 1e-300)[:, None]
    of = rounded(vector, covariance)
    east, north = unit.T
    ee, en, nn = covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]
    both = 2 * en * east * north
    sigmas = np.sqrt(
        [ee * east * east + both + nn * north * north, ee * north * north - both + nn * east * east]
    )
    sigmas[1] /= np.maximum(length, 1e-300)
    trace, product = ee + nn, of.ee * of.nn  # product: of both deviations
    near = np.flatnonzero(trace * np.sqrt(trace) > BENT * length * product)
    sigmas[:, near] = _integrated(length[near], unit[near], take(of, near))
    return sigmas[0], sigmas[1]


def _integrated(length: Array, unit: Array, of: Round) -> Array:
    """The result of `polar_sigma`, [2, N], by quadrature over the direction."""
    at = directions(of, -of.arc, of.arc, EVEN)
    zeroth, first, second, third = moments(at.rho)
    weight = at.rho * zeroth + first  # E[rho; rho > 0]
    off = at.gain * at.rho - length[:, None]
    # E[(gain rho - length)^2 rho; rho > 0] with rho = its mean + x.
    square = (
        off * off * weight
        + 2 * off * at.gain * (at.rho * first + second)
        + at.gain * at.gain * (at.rho * second + third)
    )
    weight *= at.density
    total = weight.sum(1)
    turned = np.arctan2(
        unit[:, 1:] * at.east - unit[:, :1] * at.north,
        unit[:, :1] * at.east + unit[:, 1:] * at.north,
    )
    return np.sqrt(
        [(at.density * square).sum(1) / total, (weight * turned * turned).sum(1) / total]
    )
