"""The experiment of crossings, in a short form."""

import numpy as np
import pytest

from marine_tracker.lab.crossings import crossings


def test_ships_that_cross_at_a_right_angle_keep_their_tracks():
    outcomes = [crossings.follow(83, 'imm', seed) for seed in (3, 4)]
    ways = max(len(crossings.WAYS), 1)
    assert outcomes == 2 * [ways * [crossings.CLEAN]]


@pytest.mark.parametrize(
    ('after', 'outcome'),
    [
        ([7, 4], crossings.CLEAN),
        ([4, 7], crossings.SWAPPED),
        ([4, 9], crossings.SWAPPED),
        ([7, 9], crossings.LOST),
        ([-1, 4], crossings.LOST),
    ],
)
def test_an_exchanged_track_is_a_swap_and_a_new_one_a_loss(after, outcome):
    assert crossings.judged(np.array([7, 4]), np.array(after)) == outcome


def test_figures_are_told_for_each_angle():
    found = crossings.run(2, 5, estimator='imm', angles=[75.0], workers=1)
    assert found.figures[0].name.startswith('75 deg, ')
    assert all(0 <= figure.value <= 2 for figure in found.figures)


@pytest.mark.parametrize('angle', [0.0, 180.0, -20.0])
def test_angles_at_which_nothing_crosses_are_refused(angle):
    with pytest.raises(ValueError, match='must be above 0 and below 180 degrees'):
        crossings.run(1, 1, angles=[40.0, angle])
