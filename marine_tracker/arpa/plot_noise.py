"""Measures the real scatter of each target's plots, independent of the radar's stated figures.

A ship hardly accelerates from one scan to the next. So three plots in a row lie on a line except
for their errors. Their second difference shows the noise of sensor, glint and quantisation
together, on straight courses and in turns. Each track compares it with the configured noise, along
and across the line of sight, starting from the configured noise. So vectors, CPA and their
deviations are right for a target 300 m long, for a boat, and for a radar better or worse than its
description.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import unit_vector
from ..types import Array, Plots

BEGIN, MOST = 10.0, 60.0  # plots that the configured noise counts as; and that are remembered
SHARE = 0.03  # share of the configured noise that always stays
CLIP = 3.0  # deviations; a larger scatter may be a wrong plot, and counts as this
FREEDOM = 0.25  # degrees of freedom a plot; differences share plots, so each tells less
LONGEST = 3.0  # a gap longer than this many times the previous one is not used


class Scatter(NamedTuple):
    """The scatter of the plots of N tracks.

    position  [N, 2, 2]  m, of the last plot and the one before; nan before there were any
    time      [N, 2]     s, of them
    ratio     [N, 2, 2]  scatter in units of the configured deviations, along and across the line
                         of sight: the identity if plots scatter as configured
    plots     [N]        that `ratio` is based on, including those for the configured noise
    """

    position: Array
    time: Array
    ratio: Array
    plots: Array


def begin(count: int) -> Scatter:
    """No plots yet."""
    return Scatter(
        np.full((count, 2, 2), np.nan),
        np.full((count, 2), np.nan),
        np.tile(np.eye(2), (count, 1, 1)),
        np.full(count, BEGIN),
    )


def observe(scatter: Scatter, plots: Plots, glint_sigma: float) -> tuple[Scatter, Array, Array]:
    """Takes one plot a track.

    Also returns the covariances [N, 2, 2] m^2 that the plots really have, and the matrices [N, 2,
    2] that change errors as judged before into those as judged now.

    glint_sigma  m, of the echoing point, each axis; adds to the plots' own covariance
    """
    along = unit_vector(plots.bearing)
    axes = np.stack([along, np.stack([along[:, 1], -along[:, 0]], -1)], 1)  # along, across
    noise = plots.covariance + glint_sigma**2 * np.eye(2)
    sigma = np.sqrt(((axes @ noise) * axes).sum(2))

    last, before = scatter.position[:, 0], scatter.position[:, 1]
    step, earlier = plots.time - scatter.time[:, 0], scatter.time[:, 0] - scatter.time[:, 1]
    tells = (earlier > 0) & (step >= 0) & (step <= LONGEST * earlier)
    ahead = np.where(tells, step / np.where(tells, earlier, 1.0), 1.0)[:, None]
    bend = plots.position - last - ahead * (last - before)
    noises = np.sqrt(1 + (1 + ahead) ** 2 + ahead**2)  # of three plots in it
    seen = (axes @ bend[..., None])[..., 0] / (sigma * noises)
    most = CLIP * np.sqrt(scatter.ratio[:, [0, 1], [0, 1]])
    seen = np.clip(seen, -most, most)
    count = np.minimum(scatter.plots + 1, MOST)
    found = (1 - SHARE) * seen[:, :, None] * seen[:, None, :] + SHARE * np.eye(2)
    ratio = np.where(
        tells[:, None, None],
        scatter.ratio + (found - scatter.ratio) / count[:, None, None],
        scatter.ratio,
    )
    root, inverse = _root(ratio), np.linalg.inv(_root(scatter.ratio))
    scaled = axes.swapaxes(1, 2) * sigma[:, None]  # from units of sigma to m
    stretch = scaled @ root @ inverse @ (axes / sigma[..., None])
    return (
        Scatter(
            np.stack([plots.position, last], 1),
            np.stack([plots.time, scatter.time[:, 0]], 1),
            ratio,
            np.where(tells, count, scatter.plots),
        ),
        scaled @ ratio @ scaled.swapaxes(1, 2),
        stretch,
    )


def _root(matrix: Array) -> Array:
    """Lower triangular root [N, 2, 2] of positive definite matrices [N, 2, 2]."""
    root = np.zeros_like(matrix)
    root[:, 0, 0] = np.sqrt(matrix[:, 0, 0])
    root[:, 1, 0] = matrix[:, 1, 0] / root[:, 0, 0]
    root[:, 1, 1] = np.sqrt(matrix[:, 1, 1] - root[:, 1, 0] ** 2)
    return root
