"""A piece of video measured: range, bearing, signal over noise, covariance, extent.

The place of a point is fitted: strengths become power over the local noise, the echo has the shape
of beam and pulse, and Fisher scoring finds place and power of greatest likelihood. For an echo of
power z in noise of mean 1 whose steady part is r, p(z) = exp(-z - r) I0(2 sqrt(z r)). The inverse
of the information is the covariance. Steps of the display and samples at full strength count less
or not at all. What is longer than a point is placed at the centroid of its power in nepers.

Source: Kay, Fundamentals of Statistical Signal Processing I, 3.7 and 7.7 (scoring, the bound).
"""

from typing import NamedTuple

import numpy as np
from scipy.special import i0e, i1e

from ..types import Array, BoolArray, IntArray, StrengthArray
from .lobes import BEAM_FALL, PULSE_FALL, Lobe

BY_LOGARITHM, ITERATIONS = 3, 6
AROUND = (0.8, 1.0)  # of beam and pulse: the cells that are fitted
FLOOR = np.array([0.002, 0.004])  # of beam and pulse: no place is known better
COARSE = 0.14  # times the square of a step of the display in nepers: of beam and pulse, likewise
LONG = 0.1  # of its extent: how well the middle of something long is known


class Measured(NamedTuple):
    """Pieces [K] in units of the picture.

    place       [K, 2]     row and sample, fractions; the middle of a sample is at + 0.5
    covariance  [K, 2, 2]  of it
    snr         [K]        power over noise, in nepers
    extent      [K, 2]     rows and samples over the threshold, without beam and pulse
    """

    place: Array
    covariance: Array
    snr: Array
    extent: Array


def points(
    peak: IntArray, power: Array, usable: BoolArray, lobe: Lobe, step: Array
) -> tuple[Array, Array, Array, BoolArray]:
    """Fits points: place [K, 2], covariance [K, 2, 2], snr [K] in nepers, and whether it held.

    peak    [K, 2]        row and sample about which the patches lie
    power   [K, R, C]     ln of power over noise, odd R and C
    usable  [K, R, C]     cells that belong to the piece and are not at full strength
    step    [K]           steps of the display in nepers
    """
    rows, columns = power.shape[1:]
    y = np.arange(rows) - rows // 2
    x = np.arange(columns) - columns // 2
    z = np.exp(np.minimum(power, 40.0))
    place: Array = np.zeros((len(peak), 2))
    top = np.where(usable, power, -np.inf).max((1, 2), initial=1.0)
    height = np.maximum(top, 1.0).astype(np.float64)
    beam, pulse = lobe.shape
    blur = (step**2 / 12)[:, None, None]
    covariance = np.tile(np.eye(2), (len(peak), 1, 1))
    for iteration in range(ITERATIONS + 1):
        dy = (y[None, :, None] - place[:, 0, None, None]) / beam
        dx = (x[None, None, :] - place[:, 1, None, None]) / pulse
        log_r = height[:, None, None] - BEAM_FALL * dy**2 - PULSE_FALL * dx**2
        r = np.exp(np.clip(log_r, -20.0, 40.0))
        own = r**2 / (1 + 2 * r)  # information about ln r
        weight = usable / (1 + own * blur)
        gradient = (
            np.ones_like(r),
            np.broadcast_to(2 * BEAM_FALL * dy / beam, r.shape),
            np.broadcast_to(2 * PULSE_FALL * dx / pulse, r.shape),
        )
        information = np.empty((len(peak), 3, 3))
        for i in range(3):
            for j in range(i, 3):
                information[:, i, j] = information[:, j, i] = (
                    weight * own * gradient[i] * gradient[j]
                ).sum((1, 2))
        information[:, [0, 1, 2], [0, 1, 2]] += 1e-6
        inverse = np.linalg.inv(information)
        if iteration == ITERATIONS:
            covariance = np.asarray(inverse[:, 1:, 1:], np.float64)
            break
        if iteration < BY_LOGARITHM:  # far off, the logarithms are more nearly linear
            score = own * np.clip(power - log_r, -3.0, 3.0) * weight
        else:
            root = 2 * np.sqrt(z * r)
            score = r * (np.sqrt(z / r) * (i1e(root) / i0e(root)) - 1) * weight
        slopes = np.stack([(score * one).sum((1, 2)) for one in gradient], 1)
        change = np.einsum('kij,kj->ki', inverse, slopes)
        longest = np.array([1.0, 0.3 * beam, 0.3 * pulse])
        change = np.clip(change, -longest, longest)
        height = np.clip(height + change[:, 0], 0.0, 38.0)
        place += change[:, 1:]
    held = (np.abs(place) < 0.75 * lobe.shape).all(1) & (usable.sum((1, 2)) >= 4)
    return peak + place, covariance, height, held


def lengths(
    row: IntArray, sample: IntArray, piece: IntArray, weight: Array, count: int, shape: Array
) -> tuple[Array, Array, Array]:
    """Centroid [K, 2], covariance [K, 2, 2] and extent [K, 2] of pieces from their cells [n].

    shape  [2]  rows and samples that a point is wide
    """
    total = np.bincount(piece, weight, count)
    centre = np.stack([np.bincount(piece, weight * a, count) / total for a in (row, sample)], 1)
    span = np.empty((count, 2))
    for axis, a in enumerate((row, sample)):
        low, high = np.full(count, np.iinfo(np.int64).max), np.full(count, -1)
        np.minimum.at(low, piece, a)
        np.maximum.at(high, piece, a)
        span[:, axis] = high - low + 1
    extent = np.maximum(span - shape, 0.0)
    sigma = np.maximum(0.2 * shape, LONG * extent)
    covariance = np.zeros((count, 2, 2))
    covariance[:, [0, 1], [0, 1]] = sigma**2
    return centre, covariance, extent


def patches(
    peak: IntArray, strength: StrengthArray, lobe: Lobe
) -> tuple[IntArray, IntArray, BoolArray]:
    """Rows [K, R, 1], samples [K, 1, C] about the peaks, and whether they lie in the stack."""
    half = np.maximum(np.ceil(np.array(AROUND) * lobe.shape).astype(np.int64), 1)
    rows = peak[:, :1, None] + np.arange(-half[0], half[0] + 1)[None, :, None]
    samples = peak[:, 1:, None] + np.arange(-half[1], half[1] + 1)[None, None, :]
    inside = (
        (rows >= 0) & (rows < strength.shape[0]) & (samples >= 0) & (samples < strength.shape[1])
    )
    return (
        np.clip(rows, 0, strength.shape[0] - 1),
        np.clip(samples, 0, strength.shape[1] - 1),
        inside,
    )
