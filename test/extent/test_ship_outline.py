"""The start of outlines, and what tells that they are worth having."""

import numpy as np
import pytest

from marine_tracker.estimators.contract import Velocity
from marine_tracker.extent import outline_measures, random_matrix, ship_outline
from marine_tracker.extent.gaussian_process import HEADING
from marine_tracker.extent.random_matrix import BOX_SPREAD
from marine_tracker.geometry import unit_vector


def ship(heading, course, position=(1000.0, 1000.0), length=200.0, beam=32.0):
    """A random matrix of that length and beam, and its measures."""
    ahead = unit_vector(np.array(heading))
    abeam = unit_vector(np.array(heading + np.pi / 2))
    extent = (length**2 * np.outer(ahead, ahead) + beam**2 * np.outer(abeam, abeam)) / BOX_SPREAD**2
    matrix = random_matrix.start(
        np.array([5.0]),
        np.array([position]),
        4.0 * np.eye(2)[None],
        Velocity(6 * unit_vector(np.array([course])), 0.01 * np.eye(2)[None]),
        extent[None],
        500.0,
    )
    return matrix, random_matrix.measures(matrix, np.zeros((1, 2, 2)))


@pytest.mark.parametrize('heading', np.radians([10, 100, 190, 280]))
def test_the_bow_points_where_the_ship_goes(heading):
    matrix, found = ship(heading, heading + 0.1)
    assert np.cos(ship_outline.heading_of(matrix, found)[0] - heading) > 0.999
    state = ship_outline.from_random_matrix(matrix, found, np.zeros(2))
    assert ship_outline.off_course(state)[0] == pytest.approx(0.1, abs=1e-6)


@pytest.mark.parametrize('heading', np.radians([0, 100, 180, 300]))
def test_the_outline_begins_behind_the_lit_side(heading):
    """Half a beam further off, across the ship; as long as measured, as wide as ships are."""
    matrix, found = ship(heading, heading)
    state = ship_outline.from_random_matrix(matrix, found, np.zeros(2))
    moved = state.mean[0, :2] - matrix.mean[0, :2]
    half = 100 / ship_outline.SLENDER
    assert np.hypot(*moved) == pytest.approx(half, rel=1e-6)
    assert moved @ unit_vector(heading) == pytest.approx(0, abs=1e-6)
    assert np.hypot(*state.mean[0, :2]) > np.hypot(*matrix.mean[0, :2])
    measured = outline_measures.measures(state, ship_outline.PRIOR)
    assert measured.length[0] == pytest.approx(200, rel=0.01)
    assert measured.beam[0] == pytest.approx(2 * half, rel=0.01)
    assert np.linalg.eigvalsh(state.covariance).min() > 0
    assert state.covariance[0, HEADING, HEADING] >= ship_outline.HEADING_SD**2
