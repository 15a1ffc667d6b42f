import numpy as np
import pytest

from marine_tracker.lab.ais import ais, fused, speed, tallies


@pytest.fixture(scope='module')
def short():
    """The beginning of a scene."""
    return tallies.of_scene(3, minutes=1.4)


def test_ships_are_joined_to_their_own_tracks_after_a_minute(short):
    whole = (short.right + short.wrong + short.missed).sum()
    assert whole > 200
    assert short.right.sum() >= 0.98 * whole
    assert short.wrong.sum() <= 0.002 * whole


def test_probabilities_are_compared_with_what_is(short):
    probability, same = short.chance.T
    assert len(same) > 300
    assert same[probability > 0.98].mean() > 0.98
    assert same[probability < 0.1].mean() < 0.2


def test_of_broken_sentences_none_is_uncounted():
    assert speed.not_counted(np.random.default_rng(5)) == 0


@pytest.mark.slow
def test_the_experiment_has_all_its_figures():
    found = ais.run(1, 4)
    names = {figure.name for figure in found.figures}
    assert {'joined rightly, in the lane', '1 km off: told within 60 s'} <= names
    assert {'gwnn: off with both, RMS', 'imm: off with both, RMS'} <= names
    assert [picture.name for picture in found.pictures] == ['join_probability']


@pytest.mark.slow
def test_fusion_makes_tracks_better_and_a_liar_moves_none():
    found = fused.of_scene(2, 'imm')
    assert found.fused < 0.5 * found.alone
    assert found.moved < 1.5


@pytest.mark.slow
def test_recorded_spokes_and_sentences_go_through(recordings):
    from marine_tracker.lab.ais import recorded

    file = recordings / 'radar_video' / 'navico_halo_harbour.npz'
    if not file.exists():
        pytest.skip(f'{file} does not exist')
    found = recorded.follow(file)
    assert found.moving.sum() > 30
    assert -2.0 < np.degrees(found.errors.value[1]) < -0.5
