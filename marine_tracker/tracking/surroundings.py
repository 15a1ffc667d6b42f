"""What one radar has learnt of its surroundings: where false plots come, and how targets show."""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing
from ..parameters import TrackerParameters
from ..types import Array, BoolArray, IntArray, Plots, Tracks, take
from . import clutter_map, detection_map, existence
from .expected import Expected
from .gate import Pairs
from .look import Look

BEGIN = 0.1  # of the false plots of an empty sea: so many new targets may appear


class Surroundings(NamedTuple):
    """The density of false plots, and the probability of detection."""

    clutter: clutter_map.ClutterMap
    detection: detection_map.DetectionMap


class Evidence(NamedTuple):
    """What a scan tells of targets and clutter.

    density     [M]  of false plots at the plots that would pass for a target's, per scan and m^2
    likelihood  [P]  of each pair: of the track, if its target was seen, over clutter
    detected    [N]  probability that the target of a track gives a plot
    """

    density: Array
    likelihood: Array
    detected: Array


def unknown() -> Surroundings:
    """Nothing is known: an empty sea."""
    return Surroundings(clutter_map.empty(), detection_map.empty())


def weigh(
    known: Surroundings,
    pairs: Pairs,
    share: float,
    tracks: Tracks,
    expected: Expected,
    plots: Plots,
    radar: TrackerParameters,
) -> Evidence:
    """The evidence of a scan's pairs; the rows of `expected` begin with the N tracks.

    share  of the pairs that radial speeds left, where the radar tells them: of the false plots in a
           gate so many at most pass for the target's
    """
    count = len(tracks.id)
    place = to_range_bearing(expected.position[:count] - expected.origin[:count])
    prior = detection_map.probability(known.detection, *place, radar.detection_probability)
    density = share * clutter_map.density(known.clutter, plots.range, plots.bearing)
    return Evidence(
        density, existence.likelihood(pairs, density), existence.detection(tracks, prior)
    )


def ratio(
    evidence: Evidence,
    pairs: Pairs,
    plot_of: IntArray,
    begun: Plots,
    plots: Plots,
    radar: TrackerParameters,
) -> Array:
    """Likelihood ratio [N] of what the scan showed of each track, for existence.after.

    plot_of [N]: the plot that each track took, -1 for none; begun: the first plots of new tracks,
    which are the last
    """
    seam = len(plot_of) - len(begun.time)
    of_old = existence.ratio(
        pairs,
        plot_of[:seam],
        evidence.likelihood,
        evidence.detected,
        radar.gate_probability,
        len(plots.time),
    )
    second = plot_of[seam:]
    now = take(plots, second)
    of_new = existence.ratio_of_two(
        begun,
        now,
        evidence.density[second],
        BEGIN * clutter_map.least(now.range),
        radar.max_target_speed_mps,
        radar.detection_probability,
    )
    return np.append(of_old, of_new)


def learn(
    known: Surroundings, sure: BoolArray, seen: Look, plot_of: IntArray, plots: Plots, lone: Plots
) -> Surroundings:
    """The surroundings after one more scan.

    sure  [N]  the tracks whose targets are beyond doubt: their plots are no clutter, and they tell
               how targets show
    lone       plots of the scan before that led to nothing
    """
    doubtful = np.ones(len(plots.time), bool)
    doubtful[plot_of[sure & (plot_of >= 0)]] = False
    clutter = clutter_map.learn(
        known.clutter, (plots.range[doubtful], plots.bearing[doubtful]), (lone.range, lone.bearing)
    )
    detection = detection_map.learn(
        known.detection, seen.distance[sure], seen.bearing[sure], seen.hit[sure]
    )
    return Surroundings(clutter, detection)
