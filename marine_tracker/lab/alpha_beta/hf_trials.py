"""The HF surface-wave radar of paper 002: filters on its ships among clutter, many runs at once.

Ships, radar deviations and detection probability are those of the scenario `hf_radar`. Every minute
a run has a plot of each ship that is seen, and false plots. False plots are uniform in range,
bearing and radial speed over the station's sector. Each ship's track begins with its first two
plots. After that it takes the plot nearest in deviations, out of all plots inside its gate. This is
the paper's own association. It is the same for every filter, so only the filters differ.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import config, yaml_file
from ...estimators.contract import Estimator
from ...estimators.polar_motion import to_polar
from ...geometry import polar_to_position, wrap_angle
from ...simulation import scenario
from ...types import Array, Plots, take

CLUTTER = 150  # false plots a scan in the station's sector:
NEAR, FAR = 20e3, 180e3  # m
SECTOR = np.radians(60)  # either side of north
BAND = 12.5  # m/s, largest radial speed in either direction
GATE = np.array([4.0, 3.0, 6.0])  # sigma of range, radial speed, bearing
LOST_AFTER = 8  # scans in a row without a plot in the gate
CROSSING = 4  # the paper's fifth ship


class Scene(NamedTuple):
    """The ships as the station at the origin sees them, and the radar.

    time   [K]        s
    truth  [K, T, 3]  range m, radial speed m/s, bearing rad
    sigma  [3]        of a plot, likewise
    detection, max_speed  probability; m/s
    """

    time: Array
    truth: Array
    sigma: Array
    detection: float
    max_speed: float


class Outcome(NamedTuple):
    """How a filter did in B runs.

    error  [K, B, T, 3]  estimate less truth: m, m/s, rad; nan before the second plot and when lost
    lost   [K, B, T]     whether the track is lost
    place  [K, T, 2]     m, east and north: the first run's tracks; nan when lost
    """

    error: Array
    lost: NDArray[np.bool_]
    place: Array


def scene(crossing_speed: float | None = None) -> Scene:
    """The scenario as the station sees it: one scan at a time, all ships at once.

    crossing_speed  m/s, of the fifth ship; by default the scenario's
    """
    values = yaml_file.read_mapping(config.path('scenarios', 'hf_radar.yaml'))
    if crossing_speed is not None:
        values['targets'][CROSSING]['speed_mps'] = crossing_speed
    loaded = scenario.build(values, 'hf_radar')
    time = loaded.radar.scan_period * np.arange(loaded.scans, dtype=float)
    truths = [loaded.truth_at(at) for at in time]
    truth = np.stack(
        [
            to_polar(np.concatenate([t.position, t.velocity], 1), np.zeros((len(t.time), 2)))[0][
                :, :3
            ]
            for t in truths
        ]
    )
    radar = loaded.radar
    assert radar.radial_speed_sigma is not None
    return Scene(
        time,
        np.asarray(truth, float),
        np.array([radar.range_sigma, radar.radial_speed_sigma, radar.bearing_sigma]),
        radar.pd_near,
        loaded.tracker_parameters()['max_target_speed_mps'],
    )


def observe(on: Scene, runs: int, seed: int) -> Iterator[tuple[Array, NDArray[np.bool_]]]:
    """For each scan the plots [B, T + CLUTTER, 3], ships first, and which of them exist.

    The ships are always seen in the first two scans.
    """
    rng = np.random.default_rng(seed)
    ships = on.truth.shape[1]
    for k, truth in enumerate(on.truth):
        seen = (rng.random((runs, ships)) < on.detection) | (k < 2)
        plots = truth + on.sigma * rng.standard_normal((runs, ships, 3))
        false = rng.uniform([NEAR, -BAND, -SECTOR], [FAR, BAND, SECTOR], (runs, CLUTTER, 3))
        yield (
            np.concatenate([plots, false], 1),
            np.concatenate([seen, np.ones((runs, CLUTTER), bool)], 1),
        )


def as_plots(polar: Array, time: float, sigma: Array) -> Plots:
    """Plots from range, radial speed and bearing [N, 3], for a radar at the origin."""
    distance, speed, bearing = polar.T
    position, covariance = polar_to_position(distance, bearing, sigma[0], sigma[2])
    none = np.zeros(len(distance))
    return Plots(
        none + time,
        distance,
        bearing,
        none,
        np.zeros((len(distance), 2)),
        position,
        covariance,
        speed,
    )


def run(estimator: Estimator, on: Scene, runs: int, seed: int, gate: Array = GATE) -> Outcome:
    """Runs the filter on all runs and ships. The same seed gives every filter the same plots.

    gate  [3]  sigma of range, radial speed and bearing; inf where a filter cannot judge
    """
    scans, ships, _ = on.truth.shape
    error = np.full((scans, runs, ships, 3), np.nan)
    lost = np.zeros((scans, runs, ships), bool)
    place = np.full((scans, ships, 2), np.nan)
    missed, strayed = np.zeros((2, runs, ships), int)
    gone = np.zeros((runs, ships), bool)
    state = None
    for k, (plots, exists) in enumerate(observe(on, runs, seed)):
        if state is None:
            state = estimator.init(as_plots(plots[:, :ships].reshape(-1, 3), on.time[k], on.sigma))
            continue
        expected = _polar(estimator, state, on.time[k]).reshape(runs, ships, 3)
        apart = _apart(plots[:, None], expected[:, :, None]) / on.sigma
        apart[..., np.isinf(gate)] = 0.0
        inside = (np.abs(apart) < gate).all(-1) & exists[:, None]
        if k == 1:
            inside = np.broadcast_to(np.eye(ships, plots.shape[1], dtype=bool), inside.shape)
        distance = np.where(inside, np.square(apart).sum(-1), np.inf)
        nearest = distance.argmin(-1)
        has = np.isfinite(distance.min(-1)) & ~gone
        rows = np.flatnonzero(has)
        chosen = np.take_along_axis(plots, nearest[..., None], 1).reshape(-1, 3)
        state = estimator.update(state, take(as_plots(chosen, on.time[k], on.sigma), rows), rows)
        found = _polar(estimator, state, on.time[k]).reshape(runs, ships, 3)
        off = _apart(found, on.truth[k])
        missed = np.where(has, 0, missed + 1)
        strayed = np.where((np.abs(off) > gate * on.sigma).any(-1), strayed + 1, 0)
        gone = gone | (missed >= LOST_AFTER) | (strayed >= LOST_AFTER)
        lost[k], error[k] = gone, np.where(gone[..., None], np.nan, off)
        now = estimator.extrapolate(state, np.full(runs * ships, on.time[k])).position[:ships]
        place[k] = np.where(gone[0][:, None], np.nan, now)
    return Outcome(error, lost, place)


def _polar(estimator, state, time):
    now = estimator.extrapolate(state, np.full(len(state.time), time))
    mean = np.concatenate([now.position, now.velocity], 1)
    return to_polar(mean, np.zeros((len(mean), 2)))[0][:, :3]


def _apart(one, other):
    """Differences [..., 3] of range, radial speed and bearing; the bearing wraps."""
    apart = one - other
    apart[..., 2] = wrap_angle(apart[..., 2])
    return apart
