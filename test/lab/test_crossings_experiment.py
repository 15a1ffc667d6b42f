"""The experiment of crossings, in a short form."""

import numpy as np
import pytest

from marine_tracker.lab.crossings import crossings


def test_ships_that_cross_at_a_right_angle_keep_their_tracks():
    outcomes = [crossings.follow(83, 'imm', seed) for seed in (3, 4)]
    ways = max(len(crossings.WAYS), 1)
    assert [[one.what for one in run] for run in outcomes] == 2 * [ways * [crossings.CLEAN]]
    assert all(one.risk < 0.05 for run in outcomes for one in run)


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


def test_what_was_told_is_compared_with_what_happened_bin_by_bin():
    """Ten runs with a risk of 0.3, three of them swapped; one that was lost does not count."""
    risk = np.array(10 * [0.3] + 5 * [0.0] + [0.4])
    what = np.array(3 * [crossings.SWAPPED] + 12 * [crossings.CLEAN] + [crossings.LOST])
    found = {figure.name: figure for figure in crossings.calibration(risk, what)}
    assert found['swap risk 0.2 to 0.5: swapped'].value == pytest.approx(0.3)
    assert found['swap risk 0 to 0.02: swapped'].value == 0
    assert found['swap risk: told and happened differ by'].value == pytest.approx(0)
    wrong = crossings.calibration(risk, np.full(16, crossings.CLEAN))[-1]
    assert wrong.ok is False and wrong.value == pytest.approx(0.4 / 16 + 0.3 * 10 / 16)


@pytest.mark.slow
def test_told_swap_risk_is_what_happens():
    found = crossings.run(30, 700, angles=[6.0, 12.0, 25.0, 60.0])
    assert found.figures[-1].ok, found.figures


def test_figures_are_told_for_each_angle():
    found = crossings.run(2, 5, estimator='imm', angles=[75.0], workers=1)
    assert found.figures[0].name.startswith('75 deg, ')
    assert all(0 <= figure.value <= 2 for figure in found.figures[:4])


@pytest.mark.parametrize('angle', [0.0, 180.0, -20.0])
def test_angles_at_which_nothing_crosses_are_refused(angle):
    with pytest.raises(ValueError, match='must be above 0 and below 180 degrees'):
        crossings.run(1, 1, angles=[40.0, angle])
