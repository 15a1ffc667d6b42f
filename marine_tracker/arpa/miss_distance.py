"""The distribution of CPA and TCPA: the deviation of the CPA, and the probability of danger.

On a straight relative track the CPA depends on the target's position and direction, not on its
speed. For a given direction its signed miss distance is Gaussian, and |miss distance| is the CPA.
The TCPA is the distance left divided by the relative speed.
"""

import numpy as np
from scipy.special import ndtr

from ..geometry import wrap_angle
from ..types import Array, take
from .directions import EVEN, GAUSS, WIDE, Round, directions, moments, places, rounded


def cpa_sigma(position: Array, velocity: Array, covariance: Array, cpa: Array) -> Array:
    """RMS deviation [N] m of the CPA from the shown value `cpa` [N] m.

    position [N, 2] m, velocity [N, 2] m/s of the targets relative to own ship and their covariance
    [N, 4, 4].

    Accurate to a few per cent, except if the relative speed is below 5 of its deviations and these
    are more than three times as long as wide.
    """
    of = rounded(velocity, covariance[:, 2:, 2:])
    at = directions(of, -of.arc, of.arc, EVEN)
    place = places(position, covariance, of, at)
    miss, sigma = place.miss, np.sqrt(place.miss_variance)
    over, bell, _, _ = moments(miss / sigma)
    folded = miss * (2 * over - 1) + 2 * sigma * bell  # E |miss distance|
    square = (miss - cpa[:, None]) ** 2 + sigma**2 - 2 * cpa[:, None] * (folded - miss)
    over, bell, _, _ = moments(at.rho)
    weight = at.density * (at.rho * over + bell)
    found: Array = np.sqrt(np.maximum((weight * square).sum(1) / weight.sum(1), 0.0))
    return found


def danger_probability(
    position: Array, velocity: Array, covariance: Array, cpa_limit: float, tcpa_limit: float
) -> Array:
    """[N] P(CPA < cpa_limit m and 0 <= TCPA < tcpa_limit s), from the same arguments.

    For a given direction, the events "not passed" and "in time" are taken as independent of the
    miss distance. That is true if position errors are round. Otherwise the probability is wrong by
    one hundredth, and only near the TCPA limit.
    """
    of = rounded(velocity, covariance[:, 2:, 2:])
    low, high = _dangerous(of, position, covariance, cpa_limit)
    out, some = np.zeros(len(position)), np.flatnonzero(high > low)
    of = take(of, some)
    at = directions(of, low[some], high[some], GAUSS)
    place = places(position[some], covariance[some], of, at)
    sigma = np.sqrt(place.miss_variance)
    near = ndtr((cpa_limit - place.miss) / sigma) - ndtr((-cpa_limit - place.miss) / sigma)
    # Not past: along < 0. Its effect on along and rho: moments of a truncated Gaussian.
    along_sigma = np.sqrt(place.along_variance)
    left = -place.along / along_sigma
    ahead, bell, _, _ = moments(left)
    shift = -bell / np.maximum(ahead, 1e-100)  # of along, in its deviations
    kept = np.maximum(1 + shift * (left - shift), 0.0)  # of its variance
    with_rho = place.with_rho / along_sigma
    along = place.along + shift * along_sigma
    rho = at.rho + shift * with_rho
    rho_variance = 1 - with_rho * with_rho * (1 - kept)
    # In time: slack = speed + along / T > 0. E[rho; slack > 0] in closed form.
    slack = at.gain * rho + along / tcpa_limit
    step, both = along_sigma / tcpa_limit, with_rho * kept
    with_slack = at.gain * rho_variance + both * step
    slack_sigma = np.sqrt(at.gain * (with_slack + both * step) + kept * step * step)
    over, bell, _, _ = moments(slack / slack_sigma)
    in_time = rho * over + with_slack / slack_sigma * bell
    out[some] = np.clip((at.density * near * ahead * in_time).sum(1), 0.0, 1.0)
    return out


def _dangerous(
    of: Round, position: Array, covariance: Array, cpa_limit: float
) -> tuple[Array, Array]:
    """Range [N] to [N], rad from the mean of z, of the velocities that may lead to danger."""
    # Directions that pass own ship within the limit and do not lead away from it, with a margin for
    # position errors.
    distance = np.maximum(np.hypot(*position.T), 1e-300)
    blur = WIDE * np.sqrt(np.trace(covariance[:, :2, :2], axis1=1, axis2=2)) / distance
    wide = cpa_limit / distance + blur
    half = np.where(wide < 1, np.arcsin(np.minimum(wide, 1.0)), 0.5 * np.pi + blur)
    everywhere = half >= np.pi
    towards = np.arctan2(*-position.T)
    edges = np.stack([towards + half, towards, towards - half])  # counter-clockwise, as z turns
    first = np.sin(edges) / of.ee
    turn = np.arctan2((np.cos(edges) - of.ne * first) / of.nn, first) - of.angle
    middle = wrap_angle(turn[1])
    low = middle - np.mod(turn[1] - turn[0], 2 * np.pi)
    high = middle + np.mod(turn[2] - turn[1], 2 * np.pi)
    # The part beyond the arc of z is left out, except for arcs that meet twice.
    beyond = (high > 2 * np.pi - of.arc) | (low < of.arc - 2 * np.pi) | everywhere
    limited = of.arc < np.pi
    low = np.where(
        limited,
        np.where(beyond, -of.arc, np.maximum(low, -of.arc)),
        np.where(everywhere, -np.pi, low),
    )
    high = np.where(
        limited,
        np.where(beyond, of.arc, np.minimum(high, of.arc)),
        np.where(everywhere, np.pi, high),
    )
    return low, np.maximum(low, high)  # no overlap: an empty range
