"""CPU cost of a scan, for this tracker and for Stone Soup, on the same plots in the same run."""

import contextlib
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..estimators import ESTIMATORS, Estimator
from ..geometry import KNOT, NAUTICAL_MILE, unit_vector, wrap_bearing
from ..parameters import TrackerParameters
from ..service import Service
from ..types import OwnShip, PolarPlots, Scan

PERIOD = 60 / 22  # s
RANGE_SIGMA = 20.0  # m
BEARING_SIGMA = float(np.radians(0.5))
DETECTION = 0.9
NEAREST, FARTHEST = 0.25 * NAUTICAL_MILE, 24 * NAUTICAL_MILE
STONE_SOUP = 'Stone Soup'
JPDA = 'Stone Soup JPDA (EHM2)'
PATIENCE_S = 120.0  # CPU time of one scan by a peer, after which it does not finish
WARM_UP = 12  # scans in which the tracker finds the targets
TURN_CPU = 0.1  # s, least CPU time of one turn of this tracker
KEPT_WITHIN = 4.0  # plot deviations at that range, plus 50 m


class Traffic(NamedTuple):
    """scans: K scans of plots; position [K, N, 2] m and velocity [K, N, 2] m/s: the truth."""

    scans: list[Scan]
    position: np.ndarray
    velocity: np.ndarray


class BenchmarkResult(NamedTuple):
    """One turn: CPU time of a scan, s; the estimator's part of it (nan if unknown); the tracks'
    positions [., 2] m after each scan.
    """

    cpu_s: float
    estimator_s: float
    positions: list[np.ndarray]


class Result(NamedTuple):
    """cpu_s: mean CPU time of a scan; estimator_s: the part for extrapolation and update; kept:
    share of targets with a track; rmse of the kept ones, m.
    """

    cpu_s: float
    estimator_s: float
    kept: float
    rmse: float


def traffic(targets: int, clutter: int, scans: int, seed: int) -> Traffic:
    """Ships of up to 30 kn spread over 24 NM; one in ten turns; own ship is at rest.

    All plots of a scan have the same time, because then both trackers extrapolate every track once.
    """
    rng = np.random.default_rng(seed)
    distance = np.sqrt(rng.uniform(NEAREST**2, FARTHEST**2, targets))
    position = distance[:, None] * unit_vector(rng.uniform(0, 2 * np.pi, targets))
    speed, course = rng.uniform(0, 30 * KNOT, targets), rng.uniform(0, 2 * np.pi, targets)
    turning = np.where(
        np.arange(targets) < targets // 10, np.radians(rng.uniform(0.5, 1.5, targets)), 0.0
    )
    own = np.zeros((1, 2))
    out, positions, velocities = [], [], []
    for k in range(scans):
        velocity = speed[:, None] * unit_vector(course)
        positions.append(position)
        velocities.append(velocity)
        seen = rng.random(targets) < DETECTION
        range_ = np.hypot(*position[seen].T) + rng.normal(0, RANGE_SIGMA, seen.sum())
        bearing = np.arctan2(*position[seen].T) + rng.normal(0, BEARING_SIGMA, seen.sum())
        range_ = np.r_[range_, np.sqrt(rng.uniform(NEAREST**2, FARTHEST**2, clutter))]
        bearing = np.r_[bearing, rng.uniform(0, 2 * np.pi, clutter)]
        order = rng.permutation(len(range_))
        at = np.full(len(range_), k * PERIOD)
        out.append(
            Scan(
                k * PERIOD,
                k * PERIOD,
                PolarPlots(at, range_[order], wrap_bearing(bearing[order]), np.zeros(len(at))),
                OwnShip(np.array([k * PERIOD]), own, own),
            )
        )
        course = course + (turning * PERIOD if scans // 3 <= k < 2 * scans // 3 else 0.0)
        position = position + velocity * PERIOD
    return Traffic(out, np.stack(positions), np.stack(velocities))


class Clock:
    """Measures CPU time, s, spent in extrapolation and update."""

    def __init__(self) -> None:
        self.spent = 0.0

    def time(self, estimator: Estimator) -> Estimator:
        """The same estimator, with its time measured."""

        def timed(function):
            def run(*arguments):
                begin = time.process_time()
                found = function(*arguments)
                self.spent += time.process_time() - begin
                return found

            return run

        return Estimator(estimator.init, timed(estimator.extrapolate), timed(estimator.update))


def run_tracker(scene: Traffic, estimator: str) -> Iterator[BenchmarkResult]:
    """Runs this tracker: whole steps, from extrapolation to the initiation of new tracks.

    Each turn repeats the timed scans from the same memory.
    """
    targets = scene.position.shape[1]
    parameters = TrackerParameters(
        estimator=estimator,
        range_sigma_m=RANGE_SIGMA,
        bearing_sigma_deg=0.5,
        glint_sigma_m=0.0,
        scan_period_s=PERIOD,
        max_tracks=min(2 * targets + 1000, 100000),
        association='nearest',  # as Stone Soup does it
    )
    clock = Clock()
    service = Service(parameters, estimator=clock.time(ESTIMATORS[estimator](parameters)))
    warm = service.start()
    for scan in scene.scans[:WARM_UP]:
        warm, _ = service.track(warm, scan)
    timed = scene.scans[WARM_UP:]
    while True:
        memory, after = warm, []
        clock.spent, begin = 0.0, time.process_time()
        for scan in timed:
            memory, _ = service.track(memory, scan)
            after.append(memory.tracker.tracks)
        cpu = time.process_time() - begin
        yield BenchmarkResult(
            cpu / len(timed),
            clock.spent / len(timed),
            [
                service.tracker.extrapolate(tracks, scan.end).position[tracks.number > 0]
                for tracks, scan in zip(after, timed, strict=True)
            ],
        )


def run_stone_soup(scene: Traffic, joint: bool = False) -> Iterator[BenchmarkResult]:
    """Runs Stone Soup's EKF and DetectionKDTreeGNN2D with five neighbours, its fastest setup; or,
    `joint`, its JPDA with EHM2 and the same tree.

    Each turn takes one timed scan; the last turn is that which takes longer than PATIENCE_S.

    It is given its tracks (truth with noise) and neither initiates nor deletes any. So its figure
    is a lower bound of the cost of a whole step.
    """
    import datetime

    from stonesoup.dataassociator.probability import JPDAwithEHM2
    from stonesoup.dataassociator.tree import DetectionKDTreeGNN2D, DetectionKDTreeMixIn
    from stonesoup.hypothesiser.distance import DistanceHypothesiser
    from stonesoup.hypothesiser.probability import PDAHypothesiser
    from stonesoup.measures import Mahalanobis
    from stonesoup.models.measurement.nonlinear import CartesianToBearingRange
    from stonesoup.models.transition.linear import (
        CombinedLinearGaussianTransitionModel,
        ConstantVelocity,
    )
    from stonesoup.predictor.kalman import ExtendedKalmanPredictor
    from stonesoup.types.detection import Detection
    from stonesoup.types.state import GaussianState
    from stonesoup.types.track import Track
    from stonesoup.updater.kalman import ExtendedKalmanUpdater
    from stonesoup.updater.probability import PDAUpdater

    class DetectionKDTreeJPDA(DetectionKDTreeMixIn, JPDAwithEHM2):
        """As DetectionKDTreeGNN2D is made."""

    start = datetime.datetime(2000, 1, 1)
    axis = ConstantVelocity(0.05)
    predictor = ExtendedKalmanPredictor(CombinedLinearGaussianTransitionModel([axis, axis]))
    radar = CartesianToBearingRange(
        ndim_state=4, mapping=(0, 2), noise_covar=np.diag([BEARING_SIGMA**2, RANGE_SIGMA**2])
    )
    updater = (PDAUpdater if joint else ExtendedKalmanUpdater)(radar)
    if joint:
        every = float(np.mean([len(scan.plots.time) for scan in scene.scans]))
        false = max(every - DETECTION * scene.position.shape[1], 0.1)
        density = false / (2 * np.pi * (FARTHEST - NEAREST))
        kind, hypothesiser = (
            DetectionKDTreeJPDA,
            PDAHypothesiser(predictor, updater, density, DETECTION, 0.99),
        )
    else:
        kind, hypothesiser = (
            DetectionKDTreeGNN2D,
            DistanceHypothesiser(predictor, updater, Mahalanobis(), missed_distance=4),
        )
    associator = kind(
        hypothesiser,
        predictor,
        updater,
        number_of_neighbours=5,
        max_distance_covariance_multiplier=3,
    )

    rng = np.random.default_rng(0)
    first = WARM_UP - 1
    position, velocity = scene.position[first], scene.velocity[first]
    distance = np.hypot(*position.T)
    tracks = set()
    for (e, n), (ve, vn), r in zip(position, velocity, distance, strict=True):
        sigma = np.array([RANGE_SIGMA + r * BEARING_SIGMA, 3, RANGE_SIGMA + r * BEARING_SIGMA, 3])
        state = np.array([e, ve, n, vn]) + rng.normal(0, 0.5, 4) * sigma
        tracks.add(
            Track(
                [
                    GaussianState(
                        state, np.diag(sigma**2), start + datetime.timedelta(seconds=first * PERIOD)
                    )
                ]
            )
        )
    for k in range(WARM_UP, len(scene.scans)):
        plots = scene.scans[k].plots
        now = start + datetime.timedelta(seconds=k * PERIOD)
        detections = {
            Detection(np.array([[np.pi / 2 - b], [r]]), timestamp=now, measurement_model=radar)
            for b, r in zip(plots.bearing, plots.range, strict=True)
        }
        begin = time.process_time()
        try:
            with _at_most(PATIENCE_S):
                for track, hypothesis in associator.associate(tracks, detections, now).items():
                    sure = joint or hypothesis
                    track.append(updater.update(hypothesis) if sure else hypothesis.prediction)
        except TimeoutError:
            return
        cpu = time.process_time() - begin
        yield BenchmarkResult(
            cpu,
            np.nan,
            [np.array([[float(t.state_vector[0]), float(t.state_vector[2])] for t in tracks])],
        )


@contextlib.contextmanager
def _at_most(seconds: float) -> Iterator[None]:
    """TimeoutError after so much CPU time of this process; only in its main thread."""

    def over(*_: object) -> None:
        raise TimeoutError(f'{seconds:g} s of CPU time are over')

    before = signal.signal(signal.SIGPROF, over)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def _nearest(truth, found):
    """Distance [N] m from each target to the nearest track."""
    if not len(found):
        return np.full(len(truth), np.inf)
    return cKDTree(found).query(truth)[0]


def _result(turns: Sequence[BenchmarkResult], found, scene: Traffic) -> Result:
    truth = scene.position[WARM_UP:]
    errors = np.array([_nearest(*pair) for pair in zip(truth, found, strict=True)])
    distance = np.hypot(*np.moveaxis(truth, -1, 0))
    kept = errors < KEPT_WITHIN * np.hypot(RANGE_SIGMA, distance * BEARING_SIGMA) + 50
    rmse = float(np.sqrt(np.mean(errors[kept] ** 2))) if kept.any() else float('nan')
    cpu, estimator = np.mean([turn[:2] for turn in turns], 0).tolist()
    return Result(cpu, estimator, float(kept[-1].mean()), rmse)


def benchmark(
    targets: int,
    clutter: int,
    estimators: Sequence[str],
    timed_scans: int,
    seed: int,
    alone: bool = False,
) -> dict[str, Result]:
    """Runs this tracker with each of the estimators, and Stone Soup, on one scene; results by name.

    They take turns, one scan of Stone Soup at a time, so other load on the machine affects all
    alike. Stone Soup is left out if it is not installed, or with `alone`, and each of its
    associators if it does not finish.
    """
    scene = traffic(targets, clutter, WARM_UP + timed_scans, seed)
    ours = {name: run_tracker(scene, name) for name in estimators}
    for turns in ours.values():
        next(turns)  # the first pass loads its memory pages
    peers: dict[str, Iterator[BenchmarkResult]] = {}
    if not alone and find_spec('stonesoup'):
        peers = {STONE_SOUP: run_stone_soup(scene), JPDA: run_stone_soup(scene, joint=True)}
    found: dict[str, list[BenchmarkResult]] = {name: [] for name in (*ours, *peers)}
    for _ in range(timed_scans):
        for name, turns in ours.items():
            spent = 0.0
            while spent < TURN_CPU:
                found[name].append(next(turns))
                spent += found[name][-1].cpu_s * timed_scans
        for name, turns in peers.items():
            found[name] += [turn for turn in [next(turns, None)] if turn]
    results = {name: _result(found[name], found[name][-1].positions, scene) for name in ours}
    for name in peers:
        if len(found[name]) == timed_scans:
            results[name] = _result(found[name], [turn.positions[0] for turn in found[name]], scene)
        else:
            print(f'{name} does not finish a scan in {PATIENCE_S:g} s', file=sys.stderr)
    return results
