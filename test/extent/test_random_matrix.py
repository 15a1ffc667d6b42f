"""The random matrix against known ellipses, boxes and an exact joint Gaussian."""

import numpy as np
import pytest
from scipy.linalg import expm, sqrtm

from marine_tracker.estimators.contract import Velocity
from marine_tracker.extent import random_matrix as rm
from marine_tracker.extent.smear import smear
from marine_tracker.geometry import unit_vector
from marine_tracker.types import take


def still(count, extent, weight=6.0):
    """Rows at rest at the origin."""

    def each(matrix):
        return np.tile(matrix, (count, 1, 1))

    return rm.start(
        np.zeros(count),
        np.zeros((count, 2)),
        each(4.0 * np.eye(2)),
        Velocity(np.zeros((count, 2)), each(0.1 * np.eye(2))),
        each(extent),
        weight,
    )


def box(rng, shape, length, beam, heading):
    """Points all over a box, east and north."""
    ahead, abeam = (size * rng.uniform(-0.5, 0.5, shape) for size in (length, beam))
    return ahead[..., None] * unit_vector(heading) + abeam[..., None] * unit_vector(
        heading + np.pi / 2
    )


def scans(state, points, noise, step=2.7, model=rm.SHIP):
    """The state after scans of points [scans, N, cells, 2] of targets that lie still."""
    every = np.arange(points.shape[1])
    for k, cells in enumerate(points):
        state = rm.predict(state, np.full(len(every), k * step), model)
        centroid = cells.mean(1)
        off = cells - centroid[:, None]
        state = rm.update(
            state,
            every,
            centroid,
            np.einsum('nci,ncj->nij', off, off),
            np.full(len(every), cells.shape[1]),
            noise,
            model,
        )
    return state


@pytest.mark.parametrize('heading', np.radians([0, 30, 90, 160]))
def test_a_box_is_found_in_spite_of_smear(heading):
    """60 ships of 40 scans with 20 cells: the mean lies within 4 of its own deviations or 2 %."""
    rng = np.random.default_rng(1)
    noise = np.tile(smear(2000.0, np.radians(20.0), 10.0, np.radians(0.75)), (60, 1, 1))
    points = box(rng, (40, 60, 20), 200.0, 30.0, heading)
    points += rng.multivariate_normal(np.zeros(2), noise[0], points.shape[:-1])
    found = rm.measures(scans(still(60, 40.0**2 * np.eye(2)), points, noise), noise)
    assert abs(found.length.mean() / 200 - 1) < 0.02
    assert abs(found.beam.mean() / 30 - 1) < 0.15
    off = np.mod(found.axis - heading + np.pi / 2, np.pi) - np.pi / 2
    assert abs(off.mean()) < 4 * off.std() / np.sqrt(60) + 0.002


def test_deviations_are_those_of_repeated_trials():
    """200 ships: a deviation is known to within 5 % (one sigma), the model's to within a third."""
    rng = np.random.default_rng(2)
    noise = np.tile(25.0 * np.eye(2), (200, 1, 1))
    forgetful = rm.SHIP._replace(memory=1e9)
    points = rng.multivariate_normal(np.zeros(2), np.diag([400.0, 6400.0]) / 4, (30, 200, 15))
    points += 5 * rng.standard_normal(points.shape)
    found = rm.measures(
        scans(still(200, 40.0**2 * np.eye(2)), points, noise, model=forgetful),
        noise,
        size=rm.ELLIPSE,
    )
    axis = np.mod(found.axis + np.pi / 2, np.pi) - np.pi / 2
    for values, told in (
        (found.length, found.length_sd),
        (found.beam, found.beam_sd),
        (axis, found.axis_sd),
    ):
        assert values.std() / told.mean() == pytest.approx(1, abs=0.35)


def test_cells_along_the_outline_need_their_own_spread():
    rng = np.random.default_rng(3)
    angle = rng.uniform(0, 2 * np.pi, (50, 40, 30))
    points = np.stack([30 * np.cos(angle), 30 * np.sin(angle)], -1)
    model = rm.SHIP._replace(spread=rm.CONTOUR)
    noise = np.tile(0.01 * np.eye(2), (40, 1, 1))
    state = scans(still(40, 100.0 * np.eye(2)), points, noise, model=model)
    found = rm.measures(state, noise, model, rm.ELLIPSE)
    assert 0.5 * (found.length + found.beam).mean() == pytest.approx(60, rel=0.02)


def test_one_update_is_that_of_the_paper():
    """Matrix by matrix with scipy's root, one row of three."""
    rng = np.random.default_rng(4)
    state = still(3, np.array([[900.0, 200.0], [200.0, 300.0]]), weight=12.0)
    noise = np.array([[30.0, -5.0], [-5.0, 60.0]])
    cells = rng.normal(5, 20, (7, 2))
    centroid = cells.mean(0)
    scatter = (cells - centroid).T @ (cells - centroid)
    found = rm.update(state, np.array([1]), centroid[None], scatter[None], [7], noise[None])
    X, P = state.extent[1], state.covariance[1]
    Y = X / 4 + noise
    S = P[:2, :2] + Y / 7
    K = P[:, :2] @ np.linalg.inv(S)
    root = sqrtm(X)
    A, B = root @ np.linalg.inv(sqrtm(S)), root @ np.linalg.inv(sqrtm(Y))
    N = np.outer(centroid, centroid)
    np.testing.assert_allclose(found.extent[1], (12 * X + A @ N @ A.T + B @ scatter @ B.T) / 19)
    np.testing.assert_allclose(found.mean[1], K @ centroid)
    np.testing.assert_allclose(found.covariance[1], P - K @ S @ K.T)
    assert found.weight[1] == 19
    for before, after in zip(take(state, np.array([0, 2])), take(found, np.array([0, 2]))):
        np.testing.assert_array_equal(before, after)


@pytest.mark.parametrize('step', [0.0, 2.7, 60.0])
def test_prediction_is_that_of_white_acceleration(step):
    """Against the matrix exponential of the flow (Van Loan)."""
    flow = np.kron(np.array([[0.0, 1.0], [0.0, 0.0]]), np.eye(2))
    noise = np.kron(np.diag([0.0, rm.SHIP.noise]), np.eye(2))
    both = expm(np.block([[-flow, noise], [np.zeros((4, 4)), flow.T]]) * step)
    F = both[4:, 4:].T
    state = still(1, 100.0 * np.eye(2), weight=50.0)
    state = state._replace(mean=np.array([[1.0, 2.0, 3.0, -4.0]]))
    moved = rm.predict(state, np.array([step]))
    np.testing.assert_allclose(moved.mean[0], F @ state.mean[0])
    expected = F @ state.covariance[0] @ F.T + F @ both[:4, 4:]
    np.testing.assert_allclose(moved.covariance[0], expected, atol=1e-12)
    assert moved.weight[0] == pytest.approx(2 + 48 * np.exp(-step / rm.SHIP.memory))


def test_a_known_extent_leaves_a_plain_kalman_filter(condition):
    """Weight without bound: the centroids' posterior is that of the joint Gaussian."""
    rng = np.random.default_rng(5)
    extent = np.array([[400.0, 100.0], [100.0, 250.0]])
    state = still(1, extent, weight=1e12)
    mean, covariance = state.mean[0], state.covariance[0]
    noise = 9 * np.eye(2)
    steps, plots = [], []
    for k, count in enumerate((3, 8, 1, 5), 1):
        transition, kick = (m[0] for m in rm.constant_velocity(np.array([2.5])))
        steps.append(
            (np.kron(transition, np.eye(2)), np.zeros(4), rm.SHIP.noise * np.kron(kick, np.eye(2)))
        )
        z = rng.normal(0, 10, 2)
        plots.append((z, (extent / 4 + noise) / count))
        state = rm.predict(state, np.array([2.5 * k]), rm.SHIP._replace(memory=1e30))
        state = rm.update(state, np.array([0]), z[None], np.zeros((1, 2, 2)), [count], noise[None])
    expected = condition(mean, covariance, steps, np.eye(2, 4), plots)
    np.testing.assert_allclose(state.mean[0], expected[0], rtol=1e-6)
    np.testing.assert_allclose(state.covariance[0], expected[1], rtol=1e-6, atol=1e-9)


def test_a_round_extent_tells_no_axis():
    found = rm.measures(still(1, 100.0 * np.eye(2)), np.zeros((1, 2, 2)))
    assert found.axis_sd[0] == rm.AXIS_UNKNOWN


def test_smear_lies_along_and_across_the_line_of_sight():
    found = smear(np.array([2000.0, 1000.0]), np.radians([90.0, 0.0]), 10.0, np.radians(1.0))
    far, near = (0.4 * np.radians(1.0) * range_ for range_ in (2000, 1000))
    np.testing.assert_allclose(found[0], np.diag([5.5**2, far**2]), atol=1e-9)
    np.testing.assert_allclose(found[1], np.diag([near**2, 5.5**2]), atol=1e-9)
