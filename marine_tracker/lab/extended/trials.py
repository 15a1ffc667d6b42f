"""The scenario of paper 004: a target with an outline, seen as a few noisy points a second.

It starts at [10 m, 10 m] with [2, 2] m/s and moves almost straight on. Points lie evenly along its
outline, with a deviation of 1 m on each axis. Their number is Poisson distributed. Filters start
from the paper's state and covariance, and from a circle of 1 m. Every run is one track of a batch.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...estimators.contract import Velocity
from ...extent import gaussian_process, outline_measures, random_matrix
from ...extent.gaussian_process import FIRST_RADIUS, GpState, Model
from ...extent.radial_function import contour as contour_prior
from ...geometry import unit_vector
from ...types import Array, IntArray
from .pcrlb import bound_step

PERIOD, SCANS = 1.0, 100  # s
START = np.array([10.0, 10.0, 2.0, 2.0, np.pi / 4, 0.0])  # e n ve vn psi psi'
START_VARIANCE = np.array([1.0, 1.0, 0.1, 0.1, 0.1, 0.001])
SIGMA = 1.0  # m
NOISE, TURN_NOISE = 0.01**2, 1e-4**2  # m^2/s^3, rad^2/s^3
PRIOR = contour_prior(points=36, deviation=2.0, mean_deviation=2.0, scale=np.pi / 18)
ELLIPSE = random_matrix.Model(NOISE, memory=1e9, spread=random_matrix.CONTOUR)
RANDOM_MATRIX = 'rm'
NOTHING = np.empty(0)
FINE = 2000  # points of an outline, used to measure errors

SHAPES: dict[str, Callable[[Array], Array]] = {
    'complex': lambda b: 4 + 1.2 * np.cos(2 * b) + 0.8 * np.sin(3 * b) + 0.5 * np.cos(5 * b),
    'cross': lambda b: 3.5 + 1.8 * np.cos(4 * b) + 0.8 * np.cos(b),
    'diamond': lambda b: 1 / (np.abs(np.cos(b)) / 5 + np.abs(np.sin(b)) / 3),
}


class Case(NamedTuple):
    """shape: one of SHAPES; rate: mean number of points a scan, or per metre of outline."""

    shape: str
    rate: float
    per_metre: bool = False


class Scene(NamedTuple):
    """Truth and points of all scans and N runs.

    truth   [scans, N, 6]     e n ve vn psi psi'
    cells   [scans, N, C, 2]  m; the first `number` of them are points
    number  [scans, N]
    """

    truth: Array
    cells: Array
    number: NDArray[np.int64]


class Drawn(NamedTuple):
    """The first run after its last scan, relative to the true centre.

    outline, inner, outer  [A, 2]  m, east and north; inner and outer are 3 deviations off
    error, deviation       [M]     m, of the radii at the angles of f
    The random matrix has an outline only.
    """

    outline: Array
    inner: Array = NOTHING
    outer: Array = NOTHING
    error: Array = NOTHING
    deviation: Array = NOTHING


class ExtendedTrial(NamedTuple):
    """Results of N runs of one filter; nan for figures that a random matrix does not have.

    rmse         m, of the outline in its own frame, RMS over angles and runs
    mahalanobis  mean over the runs
    coverage     share of the truth within 3 deviations
    bound        m, PCRLB of the outline, RMS over its angles
    shape        m, RMS error of the outline against the true one at its true place
    place        m, RMS error of the centre
    """

    rmse: float
    mahalanobis: float
    coverage: float
    bound: float
    shape: float
    place: float
    drawn: Drawn


def scene(case: Case, runs: int, rng: np.random.Generator) -> Scene:
    """Truth and points."""
    angle = np.linspace(0, 2 * np.pi, FINE + 1)
    outline = SHAPES[case.shape](angle)[:, None] * unit_vector(angle)
    along = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(outline, axis=0).T))])
    mean = case.rate * along[-1] if case.per_metre else case.rate
    count = rng.poisson(mean, (SCANS, runs))
    kick = np.linalg.cholesky(NOISE * random_matrix.constant_velocity(np.array([PERIOD]))[1][0])
    truth = np.tile(START, (SCANS, runs, 1))
    now = truth[0]
    for k in range(SCANS):
        now = now.copy()
        now[:, :2] += PERIOD * now[:, 2:4]
        now[:, :4] += (kick @ rng.standard_normal((runs, 2, 2))).reshape(runs, 4)
        truth[k] = now
    b = np.interp(rng.uniform(0, along[-1], (SCANS, runs, count.max())), along, angle)
    cells = truth[:, :, None, :2] + SHAPES[case.shape](b)[..., None] * unit_vector(
        b + truth[:, :, None, 4]
    )
    return Scene(truth, cells + SIGMA * rng.standard_normal(cells.shape), count)


def first_guess(runs: int, drawn: bool, rng: np.random.Generator) -> Array:
    """[N, 6] where the filters start: at the true start, as in the paper, or drawn around it."""
    off = np.sqrt(START_VARIANCE) * rng.standard_normal((runs, 6))
    return START + drawn * off


def gaussian_process_trial(
    case: Case, variant: str, runs: int, seed: int, full: bool = True, drawn: bool = False
) -> ExtendedTrial:
    """All runs of one variant on the scenes of the seed, with its bound."""
    rng = np.random.default_rng(seed)
    seen, guess = scene(case, runs, rng), first_guess(runs, drawn, rng)
    at_angles = np.tile(SHAPES[case.shape](PRIOR.angle), (runs, 1))
    model = Model(PRIOR, variant, NOISE, TURN_NOISE, full)
    state = gaussian_process.start(
        model,
        np.zeros(runs),
        guess,
        np.diag(START_VARIANCE),
        np.ones((runs, len(PRIOR.angle))),
        np.ones((runs, 2)),
    )
    bound, every = state.covariance[0], np.arange(runs)
    noise = np.tile(SIGMA**2 * np.eye(2), (runs, 1, 1))
    for k in range(SCANS):
        time = np.full(runs, (k + 1) * PERIOD)
        state = gaussian_process.predict(state, time, model)
        known = GpState(
            time, np.concatenate([seen.truth[k], at_angles], 1), state.covariance, state.semi_axes
        )
        bound = bound_step(
            bound, k * PERIOD, known, seen.cells[k], seen.number[k], noise, model, rng
        )
        state, _ = gaussian_process.update(
            state, every, seen.cells[k], seen.number[k], noise, model, rng
        )
    off = outline_measures.error(state, PRIOR, at_angles)
    found = outline_measures.of_gaussian_process(state, PRIOR)
    shape, place = _against(found, case, seen, state.mean)
    return ExtendedTrial(
        _rms(off.rmse),
        float(off.mahalanobis.mean()),
        float(off.coverage.mean()),
        _rms(np.sqrt(np.diag(bound)[FIRST_RADIUS:])),
        shape,
        place,
        _drawn(state, found, at_angles, seen),
    )


def _drawn(state: GpState, found: outline_measures.Outline, at_angles, seen: Scene) -> Drawn:
    middle, centre = state.mean[0, :2], seen.truth[-1, 0, :2]
    share = 3 * (found.radius_sd[0] / found.radius[0])[:, None]
    inner, outer = (
        middle - centre + np.maximum(1 + side * share, 0) * (found.points[0] - middle)
        for side in (-1, 1)
    )
    at = outline_measures.of_gaussian_process(state, PRIOR, PRIOR.angle)
    return Drawn(
        found.points[0] - centre, inner, outer, at.radius[0] - at_angles[0], at.radius_sd[0]
    )


def random_matrix_trial(case: Case, runs: int, seed: int) -> ExtendedTrial:
    """The same scenes with a random matrix, which takes the points of a scan as one cluster."""
    rng = np.random.default_rng(seed)
    seen, guess = scene(case, runs, rng), first_guess(runs, False, rng)
    spread = [np.tile(np.diag(START_VARIANCE[at]), (runs, 1, 1)) for at in ([0, 1], [2, 3])]
    state = random_matrix.start(
        np.zeros(runs),
        guess[:, :2],
        spread[0],
        Velocity(guess[:, 2:4], spread[1]),
        np.tile(np.eye(2), (runs, 1, 1)),
        weight=4.0,
    )
    noise = np.tile(SIGMA**2 * np.eye(2), (runs, 1, 1))
    for k in range(SCANS):
        state = random_matrix.predict(state, np.full(runs, (k + 1) * PERIOD), ELLIPSE)
        rows, centroid, scatter, count = cluster_of(seen.cells[k], seen.number[k])
        state = random_matrix.update(state, rows, centroid, scatter, count, noise[rows], ELLIPSE)
    found = outline_measures.of_random_matrix(state)
    shape, place = _against(found, case, seen, state.mean)
    return ExtendedTrial(
        np.nan, np.nan, np.nan, np.nan, shape, place, Drawn(found.points[0] - seen.truth[-1, 0, :2])
    )


def _rms(values) -> float:
    return float(np.sqrt(np.square(values).mean()))


def _against(found: outline_measures.Outline, case: Case, seen: Scene, mean):
    """`shape` and `place` of an `ExtendedTrial`."""
    truth = seen.truth[-1]
    shape = outline_measures.shape_error(
        found.points, truth[:, :2], truth[:, 4], SHAPES[case.shape]
    )
    return _rms(shape), _rms(np.hypot(*(mean[:, :2] - truth[:, :2]).T))


def cluster_of(cells: Array, number: IntArray) -> tuple[IntArray, Array, Array, IntArray]:
    """The rows [K] that have any cells, and centroid, scatter and count of each.

    cells [N, C, 2] m, of which the first `number` [N] of each row are points.
    """
    rows = (number > 0).nonzero()[0]
    cells, count = cells[rows], number[rows]
    some = (np.arange(cells.shape[1]) < count[:, None])[..., None]
    centroid = (cells * some).sum(1) / count[:, None]
    off = (cells - centroid[:, None]) * some
    return rows, centroid, off.swapaxes(1, 2) @ off, count
