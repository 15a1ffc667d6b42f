"""What one radar has learnt of its surroundings: where false plots come, and how targets show."""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing
from ..parameters import TrackerParameters
from ..types import Array, BoolArray, IntArray, Plots, Tracks, take
from . import clutter_map, detection_map, existence
from .doppler import Shares
from .expected import Expected
from .gate import Pairs
from .look import Look

BEGIN = 0.25  # of the false plots of an empty sea: so many new targets may appear in a scan
FIRST = 0.01  # of the plots that the radar sees first: so many targets may be there already


class Surroundings(NamedTuple):
    """The density of false plots, and the probability of detection.

    before  the density as it was known a revolution ago: for plots that came before
    since   s, when the last revolution was learnt from
    """

    clutter: clutter_map.ClutterMap
    detection: detection_map.DetectionMap
    before: clutter_map.ClutterMap
    since: float


class Evidence(NamedTuple):
    """What a scan tells of targets and clutter.

    density     [M]  of false plots at the plots, per scan and m^2
    likelihood  [P]  of each pair: of the track, if its target was seen, over clutter
    detected    [N]  probability that the target of a track gives a plot
    unseen           of the plots that begin tracks, the part that is of targets which were there
                     when the radar began
    share            of false second plots that would pass for a target's by their radial speed
    """

    density: Array
    likelihood: Array
    detected: Array
    unseen: float
    share: float


def unknown() -> Surroundings:
    """Nothing is known: an empty sea."""
    nothing = clutter_map.empty()
    return Surroundings(nothing, detection_map.empty(), nothing, -np.inf)


def weigh(
    known: Surroundings,
    pairs: Pairs,
    share: Shares,
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
    density = clutter_map.density(known.clutter, plots.range, plots.bearing)
    old = (plots.time < known.since).nonzero()[0]
    if len(old):  # sectors: of the last revolution, whose own plots are not to count
        place = plots.range[old], plots.bearing[old]
        density[old] = clutter_map.density(known.before, *place)
    unseen = FIRST * (1 - radar.detection_probability) ** max(known.clutter.scans - 1, 0)
    likelihood = existence.likelihood(pairs, share.tracks * density)
    detected = existence.detection(tracks, prior)
    return Evidence(density, likelihood, detected, unseen, share.lone)


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
    if seam == len(plot_of):
        return of_old
    second = plot_of[seam:]
    now, density = take(plots, second), evidence.share * evidence.density[second]
    of_new = existence.ratio_of_two(
        begun,
        now,
        density,
        # A first plot may have any radial speed: of false ones none are left out.
        BEGIN * clutter_map.least(now.range) * evidence.share + evidence.unseen * density,
        radar.max_target_speed_mps,
        radar.detection_probability,
    )
    return np.append(of_old, of_new)


def found(sure: BoolArray, given_up: IntArray, seen: Look, nowhere: Plots) -> tuple[Array, ...]:
    """What `learn` takes from a scan, or a sector.

    sure      [N]  the tracks whose targets are beyond doubt: they tell how targets show
    given_up  [N]  plots of each track that has just ended as none of a target
    nowhere        plots of the scan before that led to nothing
    """
    return (
        np.append(nowhere.range, seen.distance.repeat(given_up)),
        np.append(nowhere.bearing, seen.bearing.repeat(given_up)),
        *(seen.distance[sure], seen.bearing[sure], seen.hit[sure].astype(float)),
    )


def learn(known: Surroundings, end: float, lone: Plots, *of_revolution: Array) -> Surroundings:
    """The surroundings after a revolution that ended at `end` s: what was `found`, put together.

    lone  plots of this revolution that are of no track: the first one has nothing else to tell
    """
    nowhere, (range_, bearing, hit) = of_revolution[:2], of_revolution[2:]
    if not known.clutter.scans:
        nowhere = lone.range, lone.bearing
    return Surroundings(
        clutter_map.learn(known.clutter, *nowhere),
        detection_map.learn(known.detection, range_, bearing, hit > 0),
        known.clutter,
        end,
    )


def prospects(
    known: Surroundings, range_: Array, bearing: Array, log_det: float, radar: TrackerParameters
) -> tuple[Array, Array]:
    """Density of false plots [N] at the places [N] (m, rad), and the existence [N] that a target
    there reaches at most with `confirm_scans` plots in a row.

    log_det  of the covariance of its innovations, m^4
    """
    density = clutter_map.density(known.clutter, range_, bearing)
    a_plot = radar.detection_probability * np.exp(-1 - 0.5 * log_det) / (2 * np.pi * density)
    begins = BEGIN * clutter_map.least(range_) / density
    odds = begins * np.maximum(a_plot, 1.0) ** (radar.confirm_scans - 1)
    return density, odds / (1 + odds)
