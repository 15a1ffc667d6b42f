"""Handover from a random matrix to an outline, for a ship of 200 x 32 m whose near side is seen.

She passes at 1 km with 6 m/s. A radar at 22 rpm sees her as about 20 points a scan, spread evenly
along the part of her hull that faces the radar, with a deviation of 3 m on each axis. After 10
scans the random matrix is handed over. After 60 scans both are judged.
"""

from typing import NamedTuple

import numpy as np

from ...estimators.contract import Velocity
from ...evaluation.report import Figure, at_most
from ...extent import gaussian_process, outline_measures, random_matrix, ship_outline
from ...extent.gaussian_process import GpState
from ...extent.random_matrix import RandomMatrixState
from ...geometry import unit_vector
from ...types import Array, IntArray
from .trials import cluster_of

LENGTH, BEAM = 200.0, 32.0  # m
# Corners of the hull in half lengths ahead and half beams to starboard, clockwise from the bow.
HULL = np.array([[1.0, 0.0], [0.6, 1.0], [-1.0, 1.0], [-1.0, -1.0], [0.6, -1.0]])
SIGMA, CELLS = 3.0, 20.0  # m; mean number of points a scan
DISTANCE, SPEED, PERIOD = 1000.0, 6.0, 60 / 22  # m, m/s, s
SCANS, HANDED_OVER = 60, 10
BEARING = np.radians(45)  # of the ship at the middle of the run
ASPECTS = (20, 45, 90, 135, 160)  # deg, between her course and the line of sight
FIRST_EXTENT = 40.0  # m, half axes


class Errors(NamedTuple):
    """RMS over the runs, m: error of the length, and of the centre."""

    length: float
    centre: float


def points(
    middle: Array, course: float, rng: np.random.Generator, runs: int
) -> tuple[Array, IntArray]:
    """Points [runs, C, 2] m of a ship whose middle is at [2] m from the radar, and their number
    [runs].
    """
    corners = HULL * [0.5 * LENGTH, 0.5 * BEAM]
    sides = np.roll(corners, -1, 0) - corners
    size = np.hypot(*sides.T)
    axes = unit_vector(course + np.array([0, np.pi / 2]))  # ahead and to starboard
    outward = np.stack([sides[:, 1], -sides[:, 0]], 1) @ axes
    lit = (outward @ middle < 0) * size
    number = rng.poisson(CELLS, runs)
    shape = (runs, max(number.max(), 1))
    side = rng.choice(len(size), shape, p=lit / lit.sum())
    place = corners[side] + rng.uniform(size=shape)[..., None] * sides[side]
    return middle + place @ axes + SIGMA * rng.standard_normal((*shape, 2)), number


def trial(aspect: float, runs: int, seed: int) -> tuple[Errors, Errors]:
    """Errors of the random matrix and of the outline."""
    rng = np.random.default_rng(seed)
    course = float(BEARING + np.radians(aspect))
    velocity = SPEED * unit_vector(course)
    noise = np.tile(SIGMA**2 * np.eye(2), (runs, 1, 1))
    matrix: RandomMatrixState
    outline: GpState
    for k in range(SCANS):
        time = np.full(runs, k * PERIOD)
        middle = DISTANCE * unit_vector(BEARING) + (time[0] - 0.5 * SCANS * PERIOD) * velocity
        cells, number = points(middle, course, rng, runs)
        rows, centroid, scatter, count = cluster_of(cells, number)
        if k == 0:
            matrix = first_matrix(centroid, velocity + rng.standard_normal((runs, 2)))
        else:
            matrix = random_matrix.update(
                random_matrix.predict(matrix, time), rows, centroid, scatter, count, noise[rows]
            )
        if k == HANDED_OVER:
            outline = ship_outline.from_random_matrix(
                matrix, random_matrix.measures(matrix, noise), np.zeros(2)
            )
        elif k > HANDED_OVER:
            outline = gaussian_process.predict(outline, time, ship_outline.SHIP)
            outline, _ = gaussian_process.update(
                outline, np.arange(runs), cells, number, noise, ship_outline.SHIP
            )
    return (
        _errors(random_matrix.measures(matrix, noise).length, matrix.mean, middle),
        _errors(
            outline_measures.measures(outline, ship_outline.PRIOR).length, outline.mean, middle
        ),
    )


def first_matrix(centroid: Array, velocity: Array) -> RandomMatrixState:
    """For ships first seen at [N, 2] m, with velocities [N, 2] m/s known to 1 m/s."""
    count = len(centroid)

    def each(variance: float) -> Array:
        return np.tile(variance * np.eye(2), (count, 1, 1))

    return random_matrix.start(
        np.zeros(count),
        centroid,
        each(20.0**2),
        Velocity(velocity, each(1.0)),
        each(FIRST_EXTENT**2),
    )


def figures(found: dict[int, tuple[Errors, Errors]]) -> list[Figure]:
    """Figures for each aspect, then RMS over all aspects."""
    made, squares = [], np.square(list(found.values()))  # [aspects, filters, length and centre]
    for aspect, pair in found.items():
        for name, errors in zip(('rm', 'gp_q15'), pair):
            made += [
                Figure(f'handover, aspect {aspect} deg, {name}: {what}', value, 'm')
                for what, value in zip(('length', 'centre'), errors)
            ]
    matrix, outline = np.sqrt(squares.mean(0))
    return made + [
        at_most('handover, all aspects, gp_q15: length', outline[0], 5.0, 'm', 'prototype'),
        at_most('handover, all aspects, gp_q15: centre', outline[1], 6.0, 'm', 'prototype'),
        at_most(
            'handover, all aspects: centre, gp_q15 over rm',
            outline[1] / matrix[1],
            0.5,
            '',
            'prototype',
        ),
    ]


def _errors(length, mean, middle) -> Errors:
    return Errors(
        float(np.sqrt(np.square(length - LENGTH).mean())),
        float(np.sqrt(np.square(mean[:, :2] - middle).sum(1).mean())),
    )
