"""Which plots have the radial speed of the track they lie near, where the radar tells it."""

import numpy as np

from ..geometry import to_range_bearing, unit_vector
from ..types import Extrapolation, Plots


def agree(
    track,
    plot,
    ahead: Extrapolation,
    lone: Plots,
    plots: Plots,
    sigma: float,
    max_speed: float,
    reach: float,
):
    """Mask [P] of the pairs (track [P], plot [P]) of the gate that radial speeds do not rule out.

    track      row of `ahead`, the N tracks, and beyond them of `lone`, the lone plots of the last
               scan, which know but their radial speed
    sigma      m/s, of a radial speed; max_speed m/s, of the targets
    reach      deviations that are taken for chance

    A plot that tells no radial speed agrees with every track.
    """
    assert plots.radial_speed is not None
    count = len(ahead.time)
    seam = track.searchsorted(count)
    told = plots.radial_speed[plot]

    # Tracks: on the line of sight to where they are expected, for a plot's bearing is coarser.
    row = track[:seam]
    _, bearing = to_range_bearing(ahead.position[row] - plots.origin[plot[:seam]])
    along = unit_vector(bearing)
    expected = (along * ahead.velocity[row]).sum(1)
    variance = np.einsum('pi,pij,pj->p', along, ahead.covariance[row, 2:, 2:], along)
    off = np.abs(told[:seam] - expected) - reach * np.sqrt(variance + sigma**2)

    # Lone plots: a target that crosses at max_speed changes its radial speed by that squared
    # over range in a second.
    row = track[seam:] - count
    if lone.radial_speed is None:
        return np.append(~(off > 0), np.ones(len(row), bool))
    turned = (
        max_speed**2
        / np.maximum(lone.range[row], max_speed)
        * np.abs(plots.time[plot[seam:]] - lone.time[row])
    )
    first_off = np.abs(told[seam:] - lone.radial_speed[row]) - turned - reach * np.sqrt(2) * sigma
    return np.append(~(off > 0), ~(first_off > 0))
