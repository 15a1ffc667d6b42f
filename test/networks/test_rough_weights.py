import json
import os
import zipfile

import numpy as np
import pytest

from marine_tracker.estimators import cs_rough_nn
from marine_tracker.networks import array_file, rough_weights, weight_file

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


def member(header, content=b''):
    """A .npy file with a header of any kind."""
    return b'\x93NUMPY\x01\x00' + len(header).to_bytes(2, 'little') + header + content


def archive(path, packed=zipfile.ZIP_DEFLATED, **members):
    with zipfile.ZipFile(path, 'w', packed) as file:
        for name, content in members.items():
            file.writestr(f'{name}.npy', content)


@pytest.mark.parametrize(
    'header',
    [
        b'{',
        b"{'descr': '<f4', 'fortran_order': False, 'shape': (2,",
        b"{'descr': '|O', 'fortran_order': False, 'shape': (1,), }",
        b"{'descr': '<f4', 'fortran_order': False, 'shape': (70000, 70000), }",
        b"{'descr': '<f4', 'fortran_order': False, 'shape': (-1,), }",
        b"{'descr': '<U999999999', 'fortran_order': False, 'shape': (3,), }",
        b"{'descr': '<U0', 'fortran_order': False, 'shape': (3,), }",
        b"{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (1,), }",
        b'[' * 9000,
        b'\xff' * 40,
        b'',
    ],
)
def test_a_bad_header_is_refused_in_one_line(tmp_path, header):
    file = tmp_path / 'w.npz'
    archive(file, manifest=member(header, b'\0' * 8))
    with pytest.raises(ValueError, match=r'w\.npz: this is no file of .*, or it is damaged') as no:
        rough_weights.load(file, 'rough')
    assert '\n' not in str(no.value) and len(str(no.value)) < 600


def test_what_unpacks_to_more_than_weights_need_is_refused_unread(tmp_path):
    file = tmp_path / 'w.npz'
    archive(file, manifest=b'\0' * (array_file.MAX_UNPACKED + 1))
    assert file.stat().st_size < 100_000
    with pytest.raises(ValueError, match=f'{array_file.MAX_UNPACKED} are allowed'):
        rough_weights.load(file, 'rough')
    archive(file, **{f'a{k}': member(b'{') for k in range(array_file.MAX_ARRAYS + 1)})
    with pytest.raises(ValueError, match='it holds 201 arrays; 200 are allowed'):
        rough_weights.load(file, 'rough')
    archive(file, zipfile.ZIP_LZMA, manifest=member(b'{'))
    with pytest.raises(ValueError, match='packed in a way that is not read'):
        rough_weights.load(file, 'rough')


def test_what_is_no_regular_file_of_some_size_is_not_opened(tmp_path):
    pipe, large = tmp_path / 'pipe', tmp_path / 'large'
    os.mkfifo(pipe)
    large.touch()
    os.truncate(large, 10**12)
    for file, said in (
        (pipe, 'not a regular file'),
        ('/dev/zero', 'not a regular file'),
        (large, f'{array_file.MAX_BYTES} are allowed'),
    ):
        with pytest.raises(ValueError, match=said):
            rough_weights.load(file, 'rough')


@pytest.mark.parametrize(
    ('manifest', 'said'),
    [
        ('[1]', 'holds a list; it must hold an object'),
        ('{"format": 1, "format": 2}', "'format' is there twice"),
        ('{"a": ' + '[' * 50 + ']' * 50 + '}', 'nested too deep'),
        ('{}', 'has format None; this version reads 1'),
        ('{"format": "' + 'x' * 5000 + '"}', r"has format 'xxx.*\.\.\..*xxx'; this version"),
    ],
)
def test_the_manifest_is_read_like_every_json(tmp_path, manifest, said):
    file = tmp_path / 'w.npz'
    np.savez(file, manifest=np.array(manifest))
    with pytest.raises(ValueError, match=said):
        rough_weights.load(file, 'rough')


@pytest.mark.parametrize('array', [np.float32(3), np.arange(6.0).reshape(2, 3), np.array(['é'])])
def test_arrays_of_all_shapes_are_read_as_numpy_reads_them(tmp_path, array):
    file = tmp_path / 'a.npz'
    np.savez(file, one=array, turned=np.asfortranarray(array))
    found = array_file.read(file)
    with np.load(file) as expected:
        assert set(found) == set(expected)
        for name in expected:
            np.testing.assert_array_equal(found[name], expected[name])
            assert found[name].dtype == expected[name].dtype
