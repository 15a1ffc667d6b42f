"""Tracks against AIS: made worlds whose figures are known by hand, and a scene driven by AIS."""

import math

import numpy as np
import pytest
from pyproj import Geod

from marine_tracker.evaluation import ais_score
from marine_tracker.evaluation.replay import write_tracks
from marine_tracker.geodesy import LocalFrame
from marine_tracker.recording import csv_folder, track_file
from marine_tracker.recording.csv_folder import Recording
from marine_tracker.recording.track_file import TrackRows
from marine_tracker.service import service_for
from marine_tracker.simulation import radar, scenario
from marine_tracker.types import OwnShip, PolarPlots, Scan, Truth

ORIGIN = (55.0, 7.0)
SCANS, PERIOD, SPEED = 60, 5.0, 6.0
START = 3000.0  # m north of the radar, where the ship begins to go north


def north(time):
    return START + SPEED * np.asarray(time, float)


@pytest.fixture
def ais_file(tmp_path):
    """An AIS file of vessels {name: (times as reported, east m, north m)}."""

    def make(vessels, name='ais.csv'):
        lines = ['time_s,vessel,lat_deg,lon_deg']
        for vessel, (time, east, north) in vessels.items():
            latitude, longitude = LocalFrame(*ORIGIN).to_geodetic(np.stack([east, north], -1))
            lines += [
                f'{t:.3f},{vessel},{a:.9f},{o:.9f}'
                for t, a, o in zip(time, latitude, longitude, strict=True)
            ]
        (tmp_path / name).write_text('\n'.join(lines) + '\n')
        return tmp_path / name

    return make


def northbound(late=0.0, noise=0.0, without=(0, 0), shift=0.0):
    """Reports every 8 s of the ship that goes north; stamped `late` s after they were true."""
    rng = np.random.default_rng(4)
    time = np.arange(-16.0, SCANS * PERIOD + 40, 8.0)
    time = time[(time < without[0]) | (time > without[1])]
    return (
        time + late + shift,
        rng.normal(0, noise, len(time)),
        north(time) + rng.normal(0, noise, len(time)),
    )


@pytest.fixture
def recording():
    """A radar at rest at the origin; plots at 1 and 9 km say what ranges it sees."""
    still = OwnShip(np.array([0.0, SCANS * PERIOD]), np.zeros((2, 2)), np.zeros((2, 2)))
    none = Truth(np.empty(0), np.empty(0, np.int64), np.empty((0, 2)), np.empty((0, 2)))
    two = np.ones(2)
    scans = tuple(
        Scan(
            k * PERIOD,
            k * PERIOD,
            PolarPlots(k * PERIOD * two, np.array([1000.0, 9000.0]), two, two),
            still,
        )
        for k in range(SCANS)
    )
    return Recording('made', scans, (none,) * SCANS, {}, {}, np.arange(SCANS), still)


def tracks(*parts):
    """Rows of tracks (name, scans, offset [2] m, excess speed m/s north) on the ship."""
    scan, name, position, velocity = [], [], [], []
    for track, scans, offset, excess in parts:
        for k in scans:
            scan.append(k)
            name.append(track)
            position.append([offset[0], north(PERIOD * k) + offset[1]])
            velocity.append([0.0, SPEED + excess])
    count = len(scan)
    return TrackRows(
        PERIOD * np.array(scan, float),
        np.array(name, np.str_),
        np.array(['confirmed'] * count),
        np.array(position),
        np.array(velocity),
        np.full((count, 2), math.nan),
        np.array(scan),
    )


def score(recording, rows, file, **options):
    return ais_score.score(
        recording, rows if isinstance(rows, list) else [rows], file, ORIGIN, **options
    )


def test_a_known_offset_is_found_in_range_bearing_and_radial_speed(recording, ais_file):
    found = score(
        recording, tracks(('a', range(SCANS), (0.0, 25.0), 0.5)), ais_file({'ship': northbound()})
    )
    assert found['vessels'] == 1 and found['held'] == 1 and found['lost_percent'] == 0
    assert found['range_error_mean_m'] == pytest.approx(25, abs=0.1)
    assert found['range_error_sd_m'] == pytest.approx(0, abs=0.1)
    assert found['range_error_max_m'] == pytest.approx(25, abs=0.2)
    assert found['radial_speed_error_mean_mps'] == pytest.approx(0.5, abs=0.01)
    assert found['bearing_error_max_deg'] == pytest.approx(0, abs=1e-3)
    assert found['ahead_s'] == pytest.approx(25 / SPEED, abs=0.02)
    assert list(found) == list(ais_score.FIGURES)


@pytest.mark.parametrize('origin', [(-17.0, 179.9999), (81.0, -179.9999), (84.5, 20.0)])
def test_scores_are_the_same_across_the_date_line_and_far_north(recording, tmp_path, origin):
    """Reports along the geodesic that leaves the origin at 3 deg; tracks are 25 m too far."""
    bearing, lines = 3.0, ['time_s,vessel,lat_deg,lon_deg']
    for time in np.arange(-16.0, SCANS * PERIOD + 40, 8.0):
        lon, lat, _ = Geod(ellps='WGS84').fwd(*origin[::-1], bearing, north(time))
        lines.append(f'{time},ship,{lat:.9f},{lon:.9f}')
    (tmp_path / 'ais.csv').write_text('\n'.join(lines) + '\n')
    rows = tracks(('a', range(SCANS), (0.0, 25.0), 0.0))
    sin, cos = np.sin(np.radians(bearing)), np.cos(np.radians(bearing))
    turned = rows._replace(
        position=rows.position @ [[cos, -sin], [sin, cos]],
        velocity=rows.velocity @ [[cos, -sin], [sin, cos]],
    )
    found = ais_score.score(recording, [turned], tmp_path / 'ais.csv', origin)
    assert found['range_error_mean_m'] == pytest.approx(25, abs=0.1)
    assert found['bearing_error_max_deg'] == pytest.approx(0, abs=1e-3)


def test_bearings_count_clockwise(recording, ais_file):
    found = score(
        recording, tracks(('a', range(SCANS), (40.0, 0.0), 0.0)), ais_file({'ship': northbound()})
    )
    bearing = np.degrees(np.arctan2(40, north(PERIOD * np.arange(SCANS))))
    assert found['bearing_error_mean_deg'] == pytest.approx(bearing.mean(), abs=1e-3)
    assert found['bearing_error_max_deg'] == pytest.approx(bearing.max(), abs=1e-3)


def test_late_reports_show_as_tracks_that_run_ahead(recording, ais_file):
    found = score(
        recording,
        tracks(('a', range(SCANS), (0.0, 0.0), 0.0)),
        ais_file({'ship': northbound(late=7.0)}),
    )
    assert found['ahead_s'] == pytest.approx(7.0, abs=0.02)
    assert found['range_error_mean_m'] == pytest.approx(7 * SPEED, abs=0.2)


def test_noise_of_reports_shows_in_the_deviations_alone(recording, ais_file):
    """Reports of 20 m; smoothed to less. Means within 4 sd / sqrt of some ten independent ones."""
    found = score(
        recording,
        tracks(('a', range(SCANS), (0.0, 0.0), 0.0)),
        ais_file({'ship': northbound(noise=20.0)}),
    )
    assert 1 < found['range_error_sd_m'] < 20
    assert abs(found['range_error_mean_m']) < 4 * 20 / np.sqrt(10)
    assert found['held'] == 1


def test_a_vessel_is_not_scored_where_its_reports_are_missing(recording, ais_file):
    """From 60 to 200 s, 28 scans, neither vessel nor track is known; nobody is blamed."""
    away = [k for k in range(SCANS) if not 56 < PERIOD * k < 204]
    found = score(
        recording,
        tracks(('a', away, (0.0, 0.0), 0.0)),
        ais_file({'ship': northbound(without=(60, 200))}),
        max_gap=60.0,
    )
    assert found['held'] == 1 and found['lost_percent'] == 0
    bridged = score(
        recording,
        tracks(('a', away, (0.0, 0.0), 0.0)),
        ais_file({'ship': northbound(without=(60, 200))}),
        max_gap=200.0,
    )
    assert bridged['held'] == pytest.approx(len(away) / SCANS, abs=0.02)


def test_the_files_clock_may_begin_elsewhere(recording, ais_file):
    found = score(
        recording,
        tracks(('a', range(SCANS), (0.0, 0.0), 0.0)),
        ais_file({'ship': northbound(shift=5000.0)}),
        start=5000.0,
    )
    assert found['range_error_max_m'] == pytest.approx(0, abs=0.2)
    with pytest.raises(ValueError, match='has no vessel between 0 s and'):
        score(recording, tracks(('a', [1], (0, 0), 0)), ais_file({'s': northbound(shift=5e3)}))


def test_lost_is_who_has_no_track_at_the_end_of_his_time_in_view(recording, ais_file):
    """Of four runs one ends early, one has a gap in the middle, one never a track."""
    whole, early = range(SCANS), range(SCANS - 10)
    gap = [*range(20), *range(40, SCANS)]
    file = ais_file({'ship': northbound()})
    runs = [tracks(('a', scans, (0.0, 5.0), 0.0)) for scans in (whole, early, gap)]
    far = tracks(('a', whole, (0.0, 900.0), 0.0))
    found = score(recording, [*runs, far], file)
    assert found['runs'] == 4 and found['lost_percent'] == 50
    assert found['held'] == pytest.approx((60 + 50 + 40) / 240)
    assert found['strangers'] == 0.25


def test_tracks_are_counted_by_length(recording, ais_file):
    found = score(
        recording,
        tracks(
            ('short', range(0, 9), (0, 0), 0),
            ('some', range(10, 20), (0, 0), 0),
            ('more', range(20, 59), (0, 0), 0),
        ),
        ais_file({'ship': northbound()}),
    )
    assert found['tracks'] == 3
    assert [found[name] for name in ais_score.FIGURES if name.startswith('tracks_of')] == [
        1,
        1,
        1,
        0,
    ]
    assert found['mean_length_scans'] == pytest.approx((9 + 10 + 39) / 3)
    assert found['mean_length_s'] == pytest.approx(PERIOD * (8 + 9 + 38) / 3)


def test_roughness_is_the_second_difference(recording, ais_file):
    """Steady: 0. Alternating by 10 m either way: 40 m."""
    file = ais_file({'ship': northbound()})
    steady = tracks(('a', range(SCANS), (0.0, 3.0), 0.0))
    assert score(recording, steady, file)['roughness_m'] == pytest.approx(0, abs=1e-9)
    steady.position[::2, 0] += 10
    steady.position[1::2, 0] -= 10
    assert score(recording, steady, file)['roughness_m'] == pytest.approx(40)


def test_nothing_to_take_a_figure_from_is_none(recording, ais_file):
    found = score(
        recording,
        tracks(('a', [], (0, 0), 0))._replace(position=np.zeros((0, 2)), velocity=np.zeros((0, 2))),
        ais_file({'ship': northbound()}),
    )
    assert found['held'] == 0 and found['lost_percent'] == 100
    assert found['range_error_mean_m'] is None and found['ahead_s'] is None


@pytest.fixture(scope='module')
def scene(tmp_path_factory):
    """Three ships driven by AIS, tracked; the folder, the track file, and the true reports."""
    folder = tmp_path_factory.mktemp('scene')
    time = np.arange(0.0, 640, 7.0)
    ways = {
        '1': (4000 + 0 * time, -3000 + 8 * time),
        '2': (-5000 + 7 * time, 2500 + 0 * time),
        '3': (-3000 - 3 * time, -2000 - 5 * time),
    }

    def write(name, late=0.0, noise=0.0, drop=0.0):
        rng = np.random.default_rng(6)
        lines = ['time_s,vessel,lat_deg,lon_deg']
        for vessel, way in ways.items():
            place = np.stack(way, -1) + rng.normal(0, noise, (len(time), 2))
            latitude, longitude = LocalFrame(*ORIGIN).to_geodetic(place)
            lines += [
                f'{t + late:.3f},{vessel},{a:.9f},{o:.9f}'
                for t, a, o in zip(time, latitude, longitude)
                if rng.random() >= drop
            ]
        (folder / name).write_text('\n'.join(lines) + '\n')
        return folder / name

    write('true.csv')
    (folder / 'scene.yaml').write_text(
        'duration_s: 600\nradar: {range_sigma_m: 10, bearing_sigma_deg: 0.3}\n'
        'clutter: {uniform: 10}\nais: {file: true.csv}\n'
        'own_ship: {start: {lat_deg: 55, lon_deg: 7}}\n'
    )
    loaded = scenario.load(folder / 'scene.yaml')
    csv_folder.write(
        folder / 'made', 'scene', radar.simulate(loaded, 2), loaded.tracker_parameters()
    )
    recording = csv_folder.read(folder / 'made')
    with open(folder / 'tracks.csv', 'w') as file:
        write_tracks(
            service_for(recording.tracker_parameters),
            zip(recording.numbers.tolist(), recording.scans),
            file,
        )
    return recording, track_file.read(folder / 'tracks.csv'), write


def test_a_tracked_scene_scores_against_the_reports_that_drove_it(scene):
    recording, rows, write = scene
    found = score(recording, rows, write('same.csv'))
    assert found['vessels'] == 3 and found['lost_percent'] == 0 and found['held'] > 0.95
    assert found['strangers'] <= 1
    assert abs(found['range_error_mean_m']) < 2 and found['range_error_sd_m'] < 10
    assert abs(found['bearing_error_mean_deg']) < 0.05 and abs(found['ahead_s']) < 0.5


@pytest.mark.parametrize(
    'fault, ahead',
    [
        ({'noise': 30.0}, 0.0),
        ({'late': 12.0}, 12.0),
        ({'drop': 0.6}, 0.0),
        ({'noise': 15.0, 'late': 6.0, 'drop': 0.4}, 6.0),
    ],
)
def test_noisy_late_and_missing_reports_are_told_from_bad_tracks(scene, fault, ahead):
    recording, rows, write = scene
    # 12 s of 8 m/s are near the default cutoff: who expects late reports gives a wider one.
    found = score(recording, rows, write('bad.csv', **fault), cutoff=300.0)
    assert found['vessels'] == 3 and found['lost_percent'] == 0 and found['held'] > 0.9
    assert found['ahead_s'] == pytest.approx(ahead, abs=1.0)
