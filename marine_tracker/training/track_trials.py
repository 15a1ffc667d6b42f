"""Runs estimators on many tracks at once. Each plot is given to its own track: no association.

Errors are those of the expectation one scan ahead, along and across the line of sight: positions
in deviations sigma of the plots, velocities in m/s.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..estimators.contract import Estimator
from ..gaussian.linear import invert_2x2, squared_distance
from ..geometry import unit_vector
from ..types import Array, BoolArray, take
from .ship_tracks import RunRadar, Ships, observe, phase

SETTLED = 20  # first scans, left out
GATE, REFUSALS = 16.0, 2  # squared distance; largest number of plots refused in a row


class TrackTrial(NamedTuple):
    """B tracks of K scans and their plots.

    ships, radar; plots: K of B rows; seen [B, K]; counts [B, K]: scans that count; phase [B, K]: in
    a manoeuvre, or just after it.
    """

    ships: Ships
    radar: RunRadar
    plots: list
    seen: NDArray[np.bool_]
    counts: NDArray[np.bool_]
    phase: NDArray[np.bool_]


class Outcome(NamedTuple):
    """position [B, K] squared errors, sigma^2, sum of both axes; velocity likewise, m^2/s^2; nis
    [B, K] of the plots; nees [B, K] of position and velocity by the covariance, 1 in theory; state:
    the estimator's after the last scan.
    """

    position: Array
    velocity: Array
    nis: Array
    nees: Array
    state: Any


def trial(
    ships: Ships, radar: RunRadar, rng: np.random.Generator, hull: Array | None = None
) -> TrackTrial:
    """The tracks and a radar's plots of them, which wander over the hull [B] m (`observe`)."""
    plots, seen = observe(ships, radar, rng, hull)
    counts = np.zeros(seen.shape, bool)
    counts[:, SETTLED:] = True
    return TrackTrial(ships, radar, plots, seen, counts, phase(ships.manoeuvre))


def run(
    estimator: Estimator,
    on: TrackTrial,
    gated: bool,
    watch: Callable[[int, Any], Estimator | None] | None = None,
) -> Outcome:
    """Runs one estimator over the trial.

    gated  refuse plots far off, as the bank of `gwnn` always does
    watch  called after each scan k with (k, state); may return another estimator to continue with
    """
    ships, plots = on.ships, on.plots
    count, scans = ships.time.shape
    state = estimator.init(plots[0])
    refused = np.zeros(count)
    position, velocity, nis, nees = np.zeros((4, count, scans))
    for k in range(1, scans):
        ahead = estimator.extrapolate(state, ships.time[:, k])
        position[:, k] = _in_sigma(
            ahead.position - ships.position[:, k], ships.position[:, k], on.radar
        )
        velocity[:, k] = np.square(ahead.velocity - ships.velocity[:, k]).sum(1)
        off = np.concatenate(
            [ahead.position - ships.position[:, k], ahead.velocity - ships.velocity[:, k]], 1
        )
        nees[:, k] = (off * np.linalg.solve(ahead.covariance, off[..., None])[..., 0]).sum(1) / 4
        inverse, _ = invert_2x2(ahead.covariance[:, :2, :2] + plots[k].covariance)
        nis[:, k] = squared_distance(plots[k].position - ahead.position, inverse)
        taken = on.seen[:, k]
        if gated and k >= SETTLED // 2:
            bad = taken & (nis[:, k] > GATE) & (refused < REFUSALS)
            refused = np.where(bad, refused + 1, np.where(taken, 0, refused))
            taken = taken & ~bad
        rows = np.flatnonzero(taken)
        state = estimator.update(state, take(plots[k], rows), rows)
        if watch is not None:
            estimator = watch(k, state) or estimator
    return Outcome(position, velocity, nis, nees, state)


def _in_sigma(off, place, radar):
    """Squared length [B] of offsets [B, 2] m, in the plots' deviations at the places [B, 2] m."""
    distance = np.hypot(*place.T)
    line = unit_vector(np.arctan2(*place.T))
    along = (off * line).sum(1) / radar.range_sigma
    across = (off[:, 0] * line[:, 1] - off[:, 1] * line[:, 0]) / (distance * radar.bearing_sigma)
    return along**2 + across**2


class Ratio(NamedTuple):
    """A ratio of root mean square errors with its 95 % interval over the tracks."""

    value: float
    low: float
    high: float


def rms(square: Array, chosen: BoolArray) -> float:
    """Root mean square per axis of squared errors [B, K] where chosen [B, K]."""
    return float(np.sqrt(square[chosen].mean() / 2))


def ratio(
    square: Array, against: Array, chosen: BoolArray, rng: np.random.Generator, resamples: int = 500
) -> Ratio:
    """RMS of `square` over that of `against` [B, K], where chosen [B, K]. The interval resamples
    tracks.
    """
    has = chosen.any(1)
    one, other = (np.where(chosen, s, 0.0).sum(1)[has] for s in (square, against))
    pick = rng.integers(0, len(one), (resamples, len(one)))
    spread = np.sqrt(one[pick].sum(1) / other[pick].sum(1))
    low, high = np.percentile(spread, [2.5, 97.5])
    return Ratio(float(np.sqrt(one.sum() / other.sum())), float(low), float(high))
