import numpy as np
import pytest

from marine_tracker.recording import spokes_file
from marine_tracker.types import OwnShip, Sweep

OWN = OwnShip(
    np.array([0.0, 1.0, 2.0]),
    np.array([[0.0, 0.0], [3.0, 4.0], [6.0, 8.0]]),
    np.tile([3.0, 4.0], (3, 1)),
    np.radians([36.0, np.nan, 37.0]),
)


def sweep(count=50, dtype=np.uint8):
    random = np.random.default_rng(2)
    return Sweep(
        np.linspace(0, 2, count),
        np.radians(np.linspace(0, 250, count)),
        np.full(count, 0.6),
        np.full(count, 1500.0),
        random.integers(0, 16, (count, 24)).astype(dtype),
    )


@pytest.mark.parametrize('dtype', [np.uint8, np.uint16])
def test_what_is_written_is_read(tmp_path, dtype):
    path, one = tmp_path / 'it.npz', sweep(dtype=dtype)
    parts = [Sweep(*(column[:20] for column in one)), Sweep(*(column[20:] for column in one))]
    assert spokes_file.write(path, parts, OWN) == 50
    read = spokes_file.read(path)
    assert read.name == 'it' and read.heading_true.all() and not read.remarks
    for got, expected in zip(read.sweep, one):
        assert got == pytest.approx(expected, rel=1e-6)
    assert read.sweep.strength.dtype == dtype
    for got, expected in zip(read.own_ship, OWN):
        assert got == pytest.approx(expected, nan_ok=True)
    assert sum(len(part.time) for part in spokes_file.sweeps(read, 7)) == 50
    assert list(tmp_path.iterdir()) == [path]


def saved(path, **changes):
    arrays = {
        'time_s': np.arange(4.0),
        'angle_deg': np.arange(4.0),
        'heading_deg': np.full(4, np.nan),
        'heading_true': np.zeros(4, bool),
        'range_m': np.full(4, 500.0),
        'sample': np.ones((4, 8), np.uint8),
    }
    arrays.update(changes)
    np.savez(path, **{name: array for name, array in arrays.items() if array is not None})
    return path


def test_a_file_without_headings_says_so_and_takes_a_stated_one(tmp_path):
    path = saved(tmp_path / 'a.npz')
    assert 'tells no heading' in spokes_file.read(path).remarks[0]
    stated = spokes_file.read(path, 2.0)
    assert stated.sweep.heading == pytest.approx([2.0] * 4) and not stated.remarks


def test_magnetic_headings_are_named(tmp_path):
    video = spokes_file.read(saved(tmp_path / 'a.npz', heading_deg=np.full(4, 90.0)))
    assert 'magnetic' in video.remarks[0]


@pytest.mark.parametrize(
    ('changes', 'words'),
    [
        ({'range_m': None}, 'has no array range_m'),
        ({'sample': np.ones((4, 8))}, 'sample is float64'),
        ({'sample': np.ones((3, 8), np.uint8)}, 'one for each of the 3 spokes'),
        ({'sample': np.ones((4, 0), np.uint8)}, 'has 0 bytes'),
        ({'time_s': np.array(list('abcd'))}, 'time_s is <U1'),
        ({'own_ship': np.ones((2, 5))}, 'own_ship has shape (2, 5)'),
        ({'own_ship': np.ones((2, 6))}, 'times that increase'),
        ({'heading_deg': np.array([1, 2, 3, None])}, 'allow_pickle'),
    ],
)
def test_a_wrong_file_is_refused_by_name(tmp_path, changes, words):
    path = saved(tmp_path / 'wrong.npz', **changes)
    with pytest.raises(ValueError) as error:
        spokes_file.read(path)
    assert words in str(error.value) and 'wrong.npz' in str(error.value)


def test_a_cut_file_is_refused(tmp_path):
    path = saved(tmp_path / 'cut.npz')
    path.write_bytes(path.read_bytes()[:300])
    with pytest.raises(ValueError, match='cut.npz'):
        spokes_file.read(path)


def test_nothing_is_written_where_nothing_comes(tmp_path):
    with pytest.raises(ValueError, match='0 sweeps'):
        spokes_file.write(tmp_path / 'none.npz', [], OWN)
    assert not list(tmp_path.iterdir())
