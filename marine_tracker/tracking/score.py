"""What plots add to the score of a track: the log-odds that they come from a target."""

import numpy as np

from ..parameters import TrackerParameters
from ..types import Array, IntArray, Plots, take
from . import clutter_map
from .clutter_map import ClutterMap
from .gate import Pairs


def gained(
    pairs: Pairs,
    plot_of: IntArray,
    begun: Plots,
    chosen: Plots,
    clutter: ClutterMap,
    radar: TrackerParameters,
) -> Array:
    """What the chosen plots [K] add to the scores of their tracks, in the order of the tracks.

    pairs    of the gate; plot_of [N]: the plot that each track took, -1 for none
    begun    the first plots of the tracks just initiated, which are the last
    """
    density = clutter_map.density(clutter, chosen.range, chosen.bearing)
    detected = radar.detection_probability
    taken = (plot_of[pairs.track] == pairs.plot).nonzero()[0]
    held, new = slice(len(taken)), slice(len(taken), None)
    of_held = evidence(pairs.nis[taken], pairs.log_det[taken], density[held], detected)
    if not len(begun.time):
        return of_held
    of_new = first_score(
        begun, take(chosen, new), density[new], radar.max_target_speed_mps, detected
    )
    return np.append(of_held, of_new)


def evidence(nis: Array, log_det: Array, density: Array, detection_probability: float) -> Array:
    """Log-likelihood ratio [K] of plots: from the track against from clutter.

    nis [K], log_det [K] of the innovations; density [K] of false plots, 1 / m^2. Sittler 1964;
    Blackman and Popoli 1999, 6.2.
    """
    return np.log(detection_probability / (2 * np.pi * density)) - 0.5 * (nis + log_det)


def first_score(
    before: Plots, now: Plots, density: Array, max_speed: float, detection_probability: float
) -> Array:
    """Score [P] of tracks begun by two plots each, for known densities [P] of false plots.

    A target's second plot may be anywhere that max_speed, m/s, and the noise allow.
    """
    away = max_speed * (now.time - before.time)
    noise = np.sqrt(np.linalg.det(before.covariance + now.covariance))
    area = np.pi * away**2 + 2 * np.pi * noise
    found: Array = np.log(detection_probability / (density * area))
    return found
