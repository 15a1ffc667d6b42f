"""The probability that a track follows a target: its existence.

A scan multiplies the odds of existence by the likelihood ratio of what it showed. With P_D the
probability that the target gives a plot, P_G that the gate holds it, N the density of the
innovation and lambda that of false plots, it is (IPDA: Musicki, Evans and Stankovic 1994)

    1 - P_D P_G + P_D * sum over the plots in the gate of N / lambda

Plots that another track took do not count. Between scans a target ceases to be with a small
probability, so no track is ever quite certain.
"""

import numpy as np

from ..types import Array, BoolArray, IntArray, Plots, Tracks
from .gate import Pairs
from .history import hits

SURVIVAL = 0.999  # a scan
EVEN = 0.5  # existence of a new track before its plots are weighed
RECENT, PRIOR_SCANS = 20, 5.0  # scans that tell a track's P_D; what is known before weighs as five
LEAST_DETECTION, MOST_DETECTION = 0.5, 0.95


def detection(tracks: Tracks, prior: Array) -> Array:
    """P_D [N] of each track: of a young one the prior [N]; later from its last scans as well."""
    old = tracks.age >= RECENT
    found = hits(tracks.history, RECENT) + PRIOR_SCANS * prior
    found = np.where(old, found / (RECENT + PRIOR_SCANS), prior)
    clipped: Array = np.minimum(np.maximum(found, LEAST_DETECTION), MOST_DETECTION)
    return clipped


def likelihood(pairs: Pairs, density: Array) -> Array:
    """N / lambda [P] of each pair; density [M] of false plots, 1 / m^2, at the plots."""
    found: Array = np.exp(-0.5 * (pairs.nis + pairs.log_det)) / (2 * np.pi * density[pairs.plot])
    return found


def ratio(
    pairs: Pairs,
    plot_of: IntArray,
    likelihood: Array,
    detected: Array,
    gate_probability: float,
    plots: int,
) -> Array:
    """Likelihood ratio [N] of what a scan of so many plots showed of each track.

    plot_of [N]: the plot that each track took, -1 for none; likelihood [P]; detected [N]: P_D
    """
    taker = np.full(plots, -1)
    has = (plot_of >= 0).nonzero()[0]
    taker[plot_of[has]] = has
    counts = (taker[pairs.plot] < 0) | (taker[pairs.plot] == pairs.track)
    total = np.bincount(pairs.track, likelihood * counts, len(plot_of))
    found: Array = 1 - detected * gate_probability + detected * total
    return found


def ratio_of_two(
    before: Plots, now: Plots, density: Array, begins: Array, max_speed: float, detected: float
) -> Array:
    """Likelihood ratio [P] of the two plots that begin each track.

    density [P] of false plots, and begins [P] of first plots of targets, 1 / m^2 and scan. The
    target's second plot may be anywhere that max_speed, m/s, and the noise allow.
    """
    away = max_speed * (now.time - before.time)
    noise = np.sqrt(np.linalg.det(before.covariance + now.covariance))
    area = np.pi * away**2 + 2 * np.pi * noise
    found: Array = begins / density * detected / (density * area)
    return found


def after(existence: Array, ratio: Array, counted: BoolArray) -> Array:
    """Existence [N] after a scan with the likelihood ratios [N]; as before where it does not
    count."""
    expected = SURVIVAL * existence
    found = ratio * expected / (1 - expected + ratio * expected)
    return np.where(counted, found, existence)
