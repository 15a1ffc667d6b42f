import json

import numpy as np
import pytest

from marine_tracker.estimators import cs_rough_nn
from marine_tracker.networks import rough_weights, weight_file

KINDS = tuple(rough_weights.NEURONS)


def changed(kind, **arrays):
    """The shipped weights with other arrays of the network."""
    good = cs_rough_nn.weights(kind)
    return good._replace(network=good.network._replace(**arrays))


@pytest.mark.parametrize('kind', KINDS)
def test_shipped_weights_load_and_tell_how_they_came_about(kind):
    file = rough_weights.shipped(kind)
    weights = rough_weights.load(file, kind)
    assert weights.manifest == json.loads(file.with_suffix('.json').read_text())
    assert weights.manifest['network'] == kind and weights.manifest['seed'] == 1
    assert (np.diff(weights.quiet.log_gamma) > 0).all() and (weights.quiet.variance > 0).all()


@pytest.mark.parametrize('kind', KINDS)
def test_what_is_saved_is_what_is_loaded(kind, tmp_path):
    weights = cs_rough_nn.weights(kind)
    rough_weights.save(tmp_path / 'w.npz', weights)
    assert (tmp_path / 'w.npz').read_bytes() == rough_weights.shipped(kind).read_bytes()


def test_a_wrong_bit_is_noticed_wherever_it_is(tmp_path):
    whole = rough_weights.shipped('rough').read_bytes()
    file = tmp_path / 'w.npz'
    for place in range(100, len(whole) - 1500, 37):  # the end is the archive's own index
        file.write_bytes(whole[:place] + bytes([whole[place] ^ 4]) + whole[place + 1 :])
        try:
            found = rough_weights.load(file, 'rough')
        except ValueError:
            continue
        # Some bytes of an archive mean nothing: then all must be as it was.
        for one, other in zip(
            found.network + found.quiet,
            cs_rough_nn.weights('rough').network + cs_rough_nn.weights('rough').quiet,
            strict=True,
        ):
            np.testing.assert_array_equal(one, other)


def test_files_that_are_none_are_refused(tmp_path):
    file = tmp_path / 'w.npz'
    with pytest.raises(ValueError, match=r'w\.npz cannot be read: No such file'):
        rough_weights.load(file, 'rough')
    whole = rough_weights.shipped('rough').read_bytes()
    for text in (b'', b'nothing', whole[: len(whole) // 2]):
        file.write_bytes(text)
        with pytest.raises(ValueError, match='no file of `marine_tracker train rough_nn`'):
            rough_weights.load(file, 'rough')


def test_weights_of_another_network_are_refused(tmp_path):
    with pytest.raises(
        ValueError,
        match=r'another network: inner has shape \(3, 1, 6, 1\); it '
        r'must be \(3, 2, 6, 2\)',
    ):
        rough_weights.load(rough_weights.shipped('bp'), 'rough')
    with pytest.raises(ValueError, match='does not hold the right arrays'):
        rough_weights.load(weight_file.FOLDER / 'gwnn_ship.npz', 'rough')
    rough_weights.save(tmp_path / 'w.npz', changed('rough', outer_theta=np.array([0.1, np.nan])))
    with pytest.raises(ValueError, match='outer_theta holds values that are not finite'):
        rough_weights.load(tmp_path / 'w.npz', 'rough')
