"""Measures of outlines, and their errors against a true star-convex outline."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing, unit_vector
from ..types import Array
from .gaussian_process import FIRST_RADIUS, HEADING, GpState
from .radial_function import Contour, Radius, radius
from .random_matrix import Measures, RandomMatrixState

AROUND = np.arange(360) * np.pi / 180  # rad: angles at which outlines are evaluated


class Outline(NamedTuple):
    """Outlines of N targets at A angles.

    radius       [N, A]     m, from the centre
    radius_sd    [N, A]     m; nan where unknown
    points       [N, A, 2]  m, east and north, clockwise
    """

    radius: Array
    radius_sd: Array
    points: Array


class Error(NamedTuple):
    """Errors of estimated outlines, one row a target.

    rmse         [N]  m, over the angles of f
    mahalanobis  [N]  about sqrt(M) for M angles if the covariance is right
    coverage     [N]  share of the angles at which the truth is within 3 deviations
    """

    rmse: Array
    mahalanobis: Array
    coverage: Array


def of_gaussian_process(state: GpState, prior: Contour, angle: Array = AROUND) -> Outline:
    """The outline at the angles [A] rad clockwise from the bow."""
    at = _radius(state, prior, angle)
    variance = _form(at.weight, _outline_covariance(state)) + at.variance
    return Outline(
        at.mean,
        np.sqrt(variance),
        _points(state.mean[:, :2], at.mean, angle + state.mean[:, HEADING, None]),
    )


def of_random_matrix(
    state: RandomMatrixState, bearing: Array = AROUND, size: float = 1.0
) -> Outline:
    """The ellipse p' X^-1 p = size^2, at the bearings [A] rad from its centroid."""
    line = unit_vector(bearing)
    inverse = np.linalg.inv(state.extent)
    found = size / np.sqrt(np.einsum('ai,nij,aj->na', line, inverse, line))
    return Outline(
        found,
        np.full_like(found, np.nan),
        _points(state.mean[:, :2], found, np.broadcast_to(bearing, found.shape)),
    )


def area(points: Array) -> Array:
    """m^2 [N] inside polygons [N, A, 2] m."""
    east, north = points[..., 0], points[..., 1]
    doubled = east * np.roll(north, -1, 1) - np.roll(east, -1, 1) * north
    found: Array = 0.5 * np.abs(doubled.sum(1))
    return found


def measures(state: GpState, prior: Contour) -> Measures:
    """Length along the heading, beam across it; the axis is the heading, bow or stern."""
    found = _radius(state, prior, AROUND).mean
    length, length_sd = _width(state, prior, found, 0.0)
    beam, beam_sd = _width(state, prior, found, np.pi / 2)
    return Measures(
        length,
        length_sd,
        beam,
        beam_sd,
        np.mod(state.mean[:, HEADING], np.pi),
        np.sqrt(state.covariance[:, HEADING, HEADING]),
    )


def error(state: GpState, prior: Contour, truth: Array) -> Error:
    """Against the true radii [M] or [N, M] m at the angles of f."""
    at = _radius(state, prior, prior.angle)
    off = at.mean - truth
    covariance = at.weight @ _outline_covariance(state) @ at.weight.swapaxes(1, 2)
    deviation = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))
    squared = (off * np.linalg.solve(covariance, off[..., None])[..., 0]).sum(1)
    return Error(
        np.sqrt(np.square(off).mean(1)), np.sqrt(squared), (np.abs(off) < 3 * deviation).mean(1)
    )


def shape_error(
    points: Array, centre: Array, heading: Array, true_radius: Callable[[Array], Array]
) -> Array:
    """RMS distance m [N] of polygons [N, A, 2] m from the true outline, along rays from its true
    centre.

    centre [N, 2] m and heading [N] rad of the truth; true_radius(angle [N, A]) m. Errors of
    position and heading count. So it can compare estimates that have no heading.
    """
    distance, bearing = to_range_bearing(points - centre[:, None])
    off = distance - true_radius(bearing - heading[:, None])
    found: Array = np.sqrt(np.square(off).mean(1))
    return found


def _radius(state: GpState, prior: Contour, angle: Array) -> Radius:
    each = np.broadcast_to(angle, (len(state.time), len(angle)))
    return radius(prior, state.semi_axes, state.mean[:, FIRST_RADIUS:], each)


def _outline_covariance(state: GpState) -> Array:
    return state.covariance[:, FIRST_RADIUS:, FIRST_RADIUS:]


def _points(centre: Array, distance: Array, bearing: Array) -> Array:
    return centre[:, None] + distance[..., None] * unit_vector(bearing)


def _form(rows: Array, matrix: Array) -> Array:
    """a' M a [N, S] of rows [N, S, M] and matrices [N, M, M]."""
    found: Array = ((rows @ matrix) * rows).sum(-1)
    return found


def _width(state: GpState, prior: Contour, found: Array, direction: float) -> tuple[Array, Array]:
    """Width m [N] along an angle off the bow, and its deviation; found [N, A] m at AROUND."""
    share = np.cos(AROUND - direction)
    ends = np.stack([(found * share).argmax(1), (found * share).argmin(1)], 1)  # [N, 2]
    at = radius(prior, state.semi_axes, state.mean[:, FIRST_RADIUS:], AROUND[ends])
    share = share[ends]
    gradient = share[:, 0, None] * at.weight[:, 0] - share[:, 1, None] * at.weight[:, 1]
    variance = _form(gradient[:, None], _outline_covariance(state))[:, 0] + (
        share**2 * at.variance
    ).sum(1)
    return share[:, 0] * at.mean[:, 0] - share[:, 1] * at.mean[:, 1], np.sqrt(variance)
