"""Which plots have the radial speed of the track they lie near, if the radar measures it."""

from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from ..geometry import to_range_bearing, unit_vector
from ..parameters import TrackerParameters
from ..types import Array, BoolArray, Extrapolation, IntArray, Plots, take
from .gate import Pairs


class Limits(NamedTuple):
    """How far radial speeds of one target may differ.

    sigma      m/s, of a measured radial speed
    max_speed  m/s, of the targets
    reach      number of deviations that count as chance
    """

    sigma: float
    max_speed: float
    reach: float


class Shares(NamedTuple):
    """Of the pairs in the gate, the part that radial speeds leave: of tracks, and of lone plots."""

    tracks: float
    lone: float


def limits(radar: TrackerParameters) -> Limits:
    """The limits from a radar's parameters; infinite if `doppler_gate` is off."""
    reach = float(ndtri(0.5 + 0.5 * radar.gate_probability)) if radar.doppler_gate else np.inf
    return Limits(radar.radial_speed_sigma_mps, radar.max_target_speed_mps, reach)


def agreeing(
    pairs: Pairs, ahead: Extrapolation, lone: Plots, plots: Plots, limits: Limits
) -> tuple[Pairs, Shares]:
    """The pairs of the gate that radial speeds do not exclude, and what shares of all they are.

    The rows of `pairs.track` are first those of `ahead`, the N tracks, then those of `lone`, the
    lone plots of the last scan. Of these only the radial speed is known. A plot without radial
    speed agrees with every track.
    """
    if plots.radial_speed is None:
        return pairs, Shares(1.0, 1.0)
    fit = _agree(pairs.track, pairs.plot, ahead, lone, plots, plots.radial_speed, limits)
    seam = pairs.track.searchsorted(len(ahead.time))
    shares = ((np.count_nonzero(of) + 1) / (len(of) + 1) for of in (fit[:seam], fit[seam:]))
    return take(pairs, fit), Shares(*shares)


def _agree(
    track: IntArray,
    plot: IntArray,
    ahead: Extrapolation,
    lone: Plots,
    plots: Plots,
    radial_speed: Array,
    limits: Limits,
) -> BoolArray:
    """Mask [P] of the pairs, for plots with known radial speeds [M] m/s."""
    sigma, max_speed, reach = limits
    count = len(ahead.time)
    seam = track.searchsorted(count)
    told = radial_speed[plot]

    # Tracks: on the line of sight to the expected position, because a plot's bearing is coarser.
    row = track[:seam]
    _, bearing = to_range_bearing(ahead.position[row] - plots.origin[plot[:seam]])
    along = unit_vector(bearing)
    expected = (along * ahead.velocity[row]).sum(1)
    variance = np.einsum('pi,pij,pj->p', along, ahead.covariance[row, 2:, 2:], along)
    off = np.abs(told[:seam] - expected) - reach * np.sqrt(variance + sigma**2)

    # Lone plots: for a target that crosses at max_speed, the radial speed changes in a second by
    # that squared over range.
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
