"""Scaling functions and wavelets made of sigmoids: the units of the wavelet network.

Paper 000, eq 12-15 (after Pati and Krishnaprasad 1993), with S(t) = tanh(t / 2q):

    phi(t) = S(t + d) - S(t - d),        psi(t) = phi(t + p) - phi(t - p),
    psi_mk(t) = a^(-m/2) psi(a^-m t - k b),   phi_mk likewise,   a = 2, 0 < b <= 3.5, d = p = 1.

A group of hidden units is phi_Mk and psi_mk, m = 0..M, over n translations k centred on 0. By the
addition theorem of tanh each is a fraction in one T = S(t). `hidden` computes them this way:

    phi = 2 g (1 - T^2) / (1 - g^2 T^2),          g = S(1)
    psi = -2 h^2 T (1 - T^2) / (1 - h^2 T^2),     h = S(2)
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import DTypeLike
from scipy.optimize import minimize_scalar

from ..types import Array

D = P = 1.0  # half widths of phi and psi
DILATION = 2.0  # a
MAX_SPACING = 3.5  # b, the paper's upper limit for a frame
MIN_Q = 0.2  # below this, S(2) is so near 1 that the quotients lose precision


def sigmoid(t: float | Array, q: float) -> Array:
    """S(t)."""
    return np.tanh(t / (2 * q))


def sigmoid_slope(t: float | Array, q: float) -> Array:
    """S'(t), at most 1 / 2q."""
    return (1 - np.tanh(t / (2 * q)) ** 2) / (2 * q)


def scaling(t: float | Array, q: float, d: float = D) -> Array:
    """phi(t): even, positive, bell-shaped (eq 12)."""
    return sigmoid(t + d, q) - sigmoid(t - d, q)


def scaling_slope(t: float | Array, q: float, d: float = D) -> Array:
    """phi'(t)."""
    return sigmoid_slope(t + d, q) - sigmoid_slope(t - d, q)


def wavelet(t: float | Array, q: float, d: float = D, p: float = P) -> Array:
    """psi(t): odd, of zero mean (eq 13)."""
    return scaling(t + p, q, d) - scaling(t - p, q, d)


def wavelet_slope(t: float | Array, q: float, d: float = D, p: float = P) -> Array:
    """psi'(t): even."""
    return scaling_slope(t + p, q, d) - scaling_slope(t - p, q, d)


def steepest(q: float, d: float = D, p: float = P) -> float:
    """max |psi'|; for d = p = 1 it is tanh(1/q)^2 / q, below S's own 1 / 2q iff 1/q < .8814."""
    t = np.linspace(0, d + p + 6 * q, 2001)
    best = t[np.argmax(np.abs(wavelet_slope(t, q, d, p)))]
    near = minimize_scalar(
        lambda x: -abs(wavelet_slope(x, q, d, p)),
        method='bounded',
        bounds=(best - t[1], best + t[1]),
        options={'xatol': 1e-10},
    )
    return float(-near.fun)


class Units(NamedTuple):
    """The form of H hidden units: unit(e) = (1 - T^2) (even + odd T) / (1 - pole T^2).

    With T = tanh(dilation e - shift); each field is [H], in the order of `units`.
    """

    dilation: Array
    shift: Array
    even: Array
    odd: Array
    pole: Array


def units(
    levels: int,
    translations: int,
    q: float,
    spacing: float = 1.0,
    groups: int = 1,
    dtype: DTypeLike = np.float64,
) -> Units:
    """`groups` equal groups of n (M + 2) units for M = `levels`, n = `translations`, b = `spacing`.

    A group is phi_Mk for all k, then psi_0k, psi_1k, ... psi_Mk. ValueError if a value is outside
    its limits.
    """
    if levels < 0 or translations < 1:
        raise ValueError(
            f'a wavelet family of {levels} levels and {translations} translations; '
            'there must be at least 0 and 1'
        )
    if not q >= MIN_Q:
        raise ValueError(f'wavelet width q is {q:g}; it must be at least {MIN_Q:g}')
    if not 0 < spacing <= MAX_SPACING:
        raise ValueError(
            f'wavelet spacing b is {spacing:g}; it must be above 0 and at most {MAX_SPACING:g}'
        )
    level = np.repeat([levels, *range(levels + 1)], translations).astype(float)
    shift = np.tile((np.arange(translations) - (translations - 1) / 2) * spacing, levels + 2)
    is_scaling = np.arange(len(level)) < translations
    g, h = sigmoid(D, q), sigmoid(D + P, q)
    height = DILATION ** (-level / 2)
    group = (
        DILATION**-level / (2 * q),
        shift / (2 * q),
        np.where(is_scaling, 2 * g, 0) * height,
        np.where(is_scaling, 0, -2 * h * h) * height,
        np.where(is_scaling, g * g, h * h),
    )
    return Units(*(np.tile(column, groups).astype(dtype) for column in group))


def hidden(form: Units, net: Array) -> tuple[Array, Array]:
    """Values [..., H] of the units at the net inputs [..., H], and their T [..., H]."""
    tanh = net * form.dilation
    tanh -= form.shift
    np.tanh(tanh, out=tanh)
    square = tanh * tanh
    value = form.odd * tanh
    value += form.even
    rest = 1 - square
    value *= rest
    square *= form.pole
    value /= np.subtract(1, square, out=rest)
    return value, tanh


def slope(form: Units, value: Array, tanh: Array) -> Array:
    """Derivatives [..., H] of the units by their net inputs, from the results of `hidden`."""
    square = tanh * tanh
    rest = 1 - square
    inside = form.pole * value - (form.even + form.odd * tanh)
    inside *= 2 * tanh
    inside += rest * form.odd
    inside /= 1 - form.pole * square
    inside *= rest
    inside *= form.dilation
    return inside
