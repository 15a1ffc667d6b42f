"""Land by a file of polygons."""

import json

import numpy as np
import pytest

from marine_tracker.geodesy import LocalFrame
from marine_tracker.parameters import TrackerParameters
from marine_tracker.tracking import land_mask
from marine_tracker.tracking.tracker import Tracker

SQUARE = [[0, 0], [400, 0], [400, 300], [0, 300], [0, 0]]
POND = [[100, 100], [200, 100], [200, 200], [100, 200], [100, 100]]
ISLE = [[900, -50], [1000, 50], [900, 150], [900, -50]]


@pytest.fixture
def file(tmp_path):
    """Writes GeoJSON and gives its path."""

    def write(document):
        path = tmp_path / 'land.geojson'
        path.write_text(document if isinstance(document, str) else json.dumps(document))
        return str(path)

    return write


def polygon(*rings):
    return {'type': 'Polygon', 'coordinates': list(rings)}


def test_points_in_polygons_and_not_in_their_holes_are_on_land(file):
    both = {
        'type': 'FeatureCollection',
        'features': [
            {'type': 'Feature', 'properties': {}, 'geometry': polygon(SQUARE, POND)},
            {'type': 'Feature', 'properties': None, 'geometry': None},
            {
                'type': 'Feature',
                'geometry': {'type': 'MultiPolygon', 'coordinates': [[ISLE], [SQUARE]]},
            },
        ],
    }
    mask = land_mask.read(file(both), '')
    at = np.array([[50, 50], [950, 40], [450, 100], [-1, 20], [50, 310], [999, 120], [50, 1e6]])
    assert land_mask.on_land(mask, at).tolist() == [True, True, False, False, False, False, False]
    alone = land_mask.read(file(polygon(SQUARE, POND)), '')
    assert land_mask.on_land(alone, np.array([[150.0, 150], [99, 150]])).tolist() == [False, True]
    # In the pond, but on the same square of the other polygon: land.
    assert land_mask.on_land(mask, np.array([[150.0, 150.0]])).tolist() == [True]


def test_a_winding_coast_agrees_with_matplotlib():
    path = pytest.importorskip('matplotlib.path')
    rng = np.random.default_rng(4)
    turn = np.sort(rng.uniform(0, 2 * np.pi, 3000))
    ring = (2000 + 500 * rng.random(3000))[:, None] * np.stack([np.cos(turn), np.sin(turn)], 1)
    ring = np.append(ring, ring[:1], 0)
    at = rng.uniform(-2600, 2600, (5000, 2))
    found = land_mask.on_land(land_mask.of_polygons([[ring]]), at)
    assert found.tolist() == path.Path(ring).contains_points(at).tolist()
    assert 0.3 < found.mean() < 0.8


def test_longitude_and_latitude_count_from_the_origin(file):
    frame = LocalFrame(63.2, 9.4)
    latitude, longitude = frame.to_geodetic(np.array(SQUARE, float))
    corners = np.stack([longitude, latitude], 1).tolist()
    mask = land_mask.read(file(polygon(corners)), ' 63.2, 9.4 ')
    at = np.array([[20.0, 20], [390, 290], [410, 20], [-10, 20]])
    assert land_mask.on_land(mask, at).tolist() == [True, True, False, False]


@pytest.mark.parametrize(
    ('document', 'said'),
    [
        ('{"type": ', r'line 1: Expecting value'),
        ({'type': 'Square'}, r"\{'type': 'Square'\} is no GeoJSON object"),
        ([1, 2], r'\[1, 2\] is no GeoJSON object'),
        (polygon(SQUARE[:3]), r'a ring is .*; it must be a list of 4 or more pairs'),
        (polygon([['a', 'b']] * 4), r'it must be a list of 4 or more pairs'),
        (polygon([[0, 0], [1, float('nan')], [1, 1], [0, 0]]), r'4 or more pairs of numbers'),
        ({'type': 'Polygon'}, r'a polygon has the coordinates None; it must have rings'),
        ({'type': 'FeatureCollection'}, r'FeatureCollection has no list of features'),
        ({'type': 'LineString', 'coordinates': SQUARE}, r'there is no polygon in it'),
        ('[' * 100_000, r'nested too deep'),
    ],
)
def test_a_file_that_is_none_is_refused_by_its_name(file, document, said):
    with pytest.raises(ValueError, match=rf'land_mask .*land.geojson.*{said}'):
        land_mask.read(file(document), '')


def test_metres_with_an_origin_are_refused(file):
    with pytest.raises(ValueError, match='longitudes must be within 180'):
        land_mask.read(file(polygon(SQUARE)), '63 10')


@pytest.mark.parametrize('origin', ['63', '91 10', '10 200', 'north', '63 10 5', 'nan 3'])
def test_a_wrong_origin_is_refused(origin):
    with pytest.raises(ValueError, match='land_mask_origin is .*; it must be a latitude within 90'):
        land_mask.read('', origin)


def test_a_file_that_is_not_there_is_named():
    with pytest.raises(ValueError, match='land_mask .*/nowhere.json cannot be read: No such file'):
        Tracker(TrackerParameters(land_mask='/nowhere.json'))


def test_plots_on_land_begin_no_track_and_tracks_go_on_there(file, revolution):
    ashore, afloat, landing = [150.0, 250.0], [-800.0, 900.0], [-300.0, 250.0]
    way = [[0.0, 0.0], [0.0, 0.0], [5.0, 0.0]]
    tracker = Tracker(
        TrackerParameters(
            estimator='imm', vessel_class='small_craft', land_mask=file(polygon(SQUARE))
        )
    )
    memory = tracker.start()
    rng = np.random.default_rng(6)
    for k in range(35):
        scan = revolution(k, [ashore, afloat, landing], way, own_position=(-100.0, -500.0), rng=rng)
        memory, _ = tracker.step(memory, scan)
    east = tracker.extrapolate(memory.tracks, scan.end).position[:, 0]
    assert len(east) == 2  # a boat that goes alongside inside the mask is kept
    assert sorted(east) == pytest.approx([-800, -300 + 5 * scan.end], abs=30)
