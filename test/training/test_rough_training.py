import numpy as np
import pytest

from marine_tracker.networks import rough_network as net
from marine_tracker.networks import rough_weights
from marine_tracker.training import rough_training as training


def test_wanted_shares_are_those_of_the_rule():
    """All low: near 0; all high: near 1; one or two high: already much; never falling."""
    quiet, one, two, three = (
        float(training.label(np.array(v))) for v in ((0, 0, 0), (0, 1, 0), (1, 0, 1), (1, 1, 1))
    )
    assert (quiet, three) == pytest.approx((0.02, 0.98))
    assert 0.6 < one < 0.8 < two < 0.95
    levels = np.linspace(0, 1, 9)
    grid = training.label(np.stack(np.meshgrid(levels, levels, levels, indexing='ij'), -1))
    assert all((np.diff(grid, axis=axis) >= 0).all() for axis in range(3))


def test_the_table_is_of_c_alone_and_of_no_units():
    """c of a ship's radar: gamma 0.08, alpha T 0.045, as a Monte Carlo finds it elsewhere."""
    c, deviation = training.quiet(0.08, 0.045)
    assert (c > 0).all() and (c < 0.5).all()
    # As gamma falls there is less to tell the filters apart by.
    assert (training.quiet(0.001, 0.045)[0] < c).all()
    assert (deviation > 1).all()


@pytest.mark.parametrize('kind', rough_weights.NEURONS)
def test_training_is_repeatable(kind, monkeypatch, tmp_path):
    monkeypatch.setattr(training, 'STARTS', 2)
    monkeypatch.setattr(training, 'ROUNDS', 5)
    told = []
    files = []
    for i, seed in enumerate((5, 5, 6)):
        weights = training.train(kind, seed, lambda done, whole: told.append((done, whole)))
        rough_weights.save(tmp_path / f'{i}.npz', weights)
        files.append((tmp_path / f'{i}.npz').read_bytes())
    assert files[0] == files[1] != files[2]
    assert told[:3] == [(0, 2), (1, 2), (2, 2)]


@pytest.mark.slow
def test_the_rough_network_that_is_shipped_comes_out_again(tmp_path):
    """The plain one takes seconds: the test of the command makes it again."""
    rough_weights.save(tmp_path / 'w.npz', training.train('rough', 1))
    assert (tmp_path / 'w.npz').read_bytes() == rough_weights.shipped('rough').read_bytes()


@pytest.mark.parametrize('kind', rough_weights.NEURONS)
def test_the_shipped_networks_say_what_they_were_taught(kind):
    weights = rough_weights.load(rough_weights.shipped(kind), kind)
    _, deviations = training.normalisation()
    given = training.samples(deviations, rough_weights.NEURONS[kind])
    off = net.forward(weights.network, given.inputs) - given.wanted
    assert np.sqrt(np.mean(off**2)) == pytest.approx(weights.manifest['rms_error'], abs=2e-4)
    assert np.abs(off).max() < 0.03
