"""Outlines of ships at sea: how they start, and the check against the course.

Only the side that faces the radar gives cells, so the centroid is shifted towards the radar. The
width of a ship can hardly be measured: a wider ship farther away gives the same cells. Small model
errors of constant sign would move an outline that way over hundreds of cells. So the outline starts
half a beam behind the centroid, with the usual width for its length, and it is stiff: it changes
by a few per cent.
"""

import numpy as np

from ..geometry import to_range_bearing, unit_vector, wrap_angle
from ..types import Array
from .gaussian_process import HEADING, GpState, Model, start
from .radial_function import contour
from .random_matrix import Measures, RandomMatrixState

PRIOR = contour(24, 0.03, 0.01, np.pi / 8, folds=2, mean=1.0, power=4.0)
SHIP = Model(PRIOR, 'gp_q15', noise=0.0025, turn_noise=1e-7, gate=16.0)
SLENDER = 6.3  # length over beam of ships
ALONG, ACROSS = 0.015, 0.25  # deviations of the first centre, relative to length and half beam
HEADING_SD = np.radians(2.0)  # least deviation of the first heading
RATE_SD = np.radians(0.1)  # rad/s


def from_random_matrix(matrix: RandomMatrixState, found: Measures, own: Array) -> GpState:
    """Outlines of N ships from their random matrices; model SHIP.

    found: their measures; own [2] or [N, 2] m: the radar.
    """
    bow = heading_of(matrix, found)
    ahead, abeam = unit_vector(bow), unit_vector(bow + np.pi / 2)
    semi_axes = 0.5 * found.length[:, None] * [1.0, 1 / SLENDER]
    sight = unit_vector(to_range_bearing(matrix.mean[:, :2] - own)[1])
    away = np.sign((abeam * sight).sum(1))
    motion = np.column_stack([matrix.mean, bow, np.zeros(len(bow))])
    motion[:, :2] += (away * semi_axes[:, 1])[:, None] * abeam
    covariance = np.zeros((len(bow), 6, 6))
    covariance[:, :4, :4] = matrix.covariance
    for axis, deviation in ((ahead, ALONG * found.length), (abeam, ACROSS * semi_axes[:, 1])):
        off = deviation[:, None] * axis
        covariance[:, :2, :2] += off[:, :, None] * off[:, None, :]
    covariance[:, 4, 4] = np.maximum(found.axis_sd, HEADING_SD) ** 2
    covariance[:, 5, 5] = RATE_SD**2
    return start(
        SHIP, matrix.time, motion, covariance, np.ones((len(bow), len(PRIOR.angle))), semi_axes
    )


def heading_of(matrix: RandomMatrixState, found: Measures) -> Array:
    """Bearing [N] rad of the bow: the end of the axis nearer to the course."""
    astern = (unit_vector(found.axis) * matrix.mean[:, 2:]).sum(1) < 0
    value: Array = found.axis + np.pi * astern
    return value


def off_course(state: GpState) -> Array:
    """Angle [N] rad in [0, pi] between heading and course; large where the outline is wrong."""
    course = to_range_bearing(state.mean[:, 2:4])[1]
    return np.abs(wrap_angle(state.mean[:, HEADING] - course))
