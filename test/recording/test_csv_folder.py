import json
import re

import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters
from marine_tracker.recording import csv_folder
from marine_tracker.types import OwnShip, PolarPlots, Scan, Truth

PLOTS = 'scan,time_s,range_m,bearing_deg\n'
OWN_SHIP = 'scan,time_s,north_m,east_m\n'
TRUTH = 'scan,time_s,target,north_m,east_m,vel_north_mps,vel_east_mps\n'


@pytest.fixture
def folder(tmp_path):
    """Three scans, the second one empty, numbered 4, 5, 7; own ship goes north at 2 m/s."""
    (tmp_path / 'plots.csv').write_text(
        PLOTS + '4,10.0,100.0,90.0\n7,15.0,300.0,-90.0\n4,10.0,200.0,359.0\n'
    )
    (tmp_path / 'own_ship.csv').write_text(OWN_SHIP + '4,10.0,0,50\n5,12.5,5,50\n7,15.0,10,50\n')
    (tmp_path / 'truth.csv').write_text(
        TRUTH + '4,10.0,1,1000,2000,3,4\n4,10.0,2,0,0,nan,nan\n7,15.0,1,1015,2020,,\n'
    )
    return tmp_path


def test_every_scan_of_own_ship_is_a_scan_also_the_empty_one(folder):
    recording = csv_folder.read(folder)
    assert recording.name == folder.name
    assert recording.numbers.tolist() == [4, 5, 7]
    assert [len(scan.plots.time) for scan in recording.scans] == [2, 0, 1]
    assert [(scan.start, scan.end) for scan in recording.scans] == [
        (10.0, 10.0),
        (12.5, 12.5),
        (15.0, 15.0),
    ]


def test_plots_keep_their_order_and_have_bearings_in_radians_from_0_to_2_pi(folder):
    first, _, last = csv_folder.read(folder).scans
    assert first.plots.range.tolist() == [100.0, 200.0]
    np.testing.assert_allclose(first.plots.bearing, np.radians([90.0, 359.0]))
    np.testing.assert_allclose(last.plots.bearing, np.radians([270.0]))
    assert first.plots.amplitude.tolist() == [0.0, 0.0]


def test_truth_is_east_and_north_and_unknown_velocities_are_nan(folder):
    truths = csv_folder.read(folder).truths
    assert truths[0].target.tolist() == [1, 2]
    assert truths[0].position.tolist() == [[2000.0, 1000.0], [0.0, 0.0]]
    assert truths[0].velocity[0].tolist() == [4.0, 3.0]
    assert np.isnan(truths[0].velocity[1]).all() and np.isnan(truths[2].velocity).all()
    assert len(truths[1].time) == 0


def test_a_scan_knows_own_ship_before_at_and_after_it(folder):
    middle = csv_folder.read(folder).scans[1].own_ship
    assert middle.time.tolist() == [10.0, 12.5, 15.0]
    assert middle.position.tolist() == [[50.0, 0.0], [50.0, 5.0], [50.0, 10.0]]
    np.testing.assert_allclose(middle.velocity, [[0.0, 2.0]] * 3)


def test_own_ship_velocities_of_the_file_are_taken_where_they_stand(folder):
    (folder / 'own_ship.csv').write_text(
        OWN_SHIP.strip() + ',vel_north_mps,vel_east_mps\n4,10,0,50,9,8\n5,12.5,5,50,nan,nan\n'
        '7,15,10,50,7,6\n'
    )
    velocity = csv_folder.read(folder).own_ship.velocity
    np.testing.assert_allclose(velocity, [[8, 9], [0, 2], [6, 7]])


def test_with_plots_at_their_own_times_a_scan_lasts_to_the_next_row(folder):
    (folder / 'plots.csv').write_text(PLOTS + '4,10.2,100,90\n4,11.9,100,180\n7,17.1,100,120\n')
    assert [scan[:2] for scan in csv_folder.read(folder).scans] == [
        (10.0, 12.5),
        (12.5, 15.0),
        (15.0, 17.5),
    ]


def test_plots_outside_their_rows_times_make_the_scan_last_from_first_to_last(folder):
    (folder / 'plots.csv').write_text(PLOTS + '4,9.2,100,90\n4,11.9,100,180\n4,10.9,100,120\n')
    assert csv_folder.read(folder).scans[0][:2] == (9.2, 11.9)


def test_plots_stamped_alike_but_late_give_a_scan_without_length(folder):
    (folder / 'plots.csv').write_text(PLOTS + '4,10.3,100,90\n4,10.3,100,180\n')
    assert csv_folder.read(folder).scans[0][:2] == (10.3, 10.3)


def test_known_ends_are_taken(folder):
    (folder / 'own_ship.csv').write_text(
        OWN_SHIP.strip() + ',end_s\n4,10,0,50,12\n5,12.5,5,50,14.5\n7,15,10,50,17\n'
    )
    assert [scan[:2] for scan in csv_folder.read(folder).scans] == [
        (10.0, 12.0),
        (12.5, 14.5),
        (15.0, 17.0),
    ]


def test_a_folder_may_lack_truth_radar_and_notes(folder):
    (folder / 'truth.csv').unlink()
    recording = csv_folder.read(folder)
    assert [len(truth.time) for truth in recording.truths] == [0, 0, 0]
    assert recording.tracker_parameters == {} and recording.notes == {}


def test_radar_yaml_and_notes_are_read(folder):
    (folder / 'radar.yaml').write_text('range_sigma_m: 3.0\nvessel_class: small_craft\n')
    (folder / 'notes.json').write_text('{"cutoff_m": 60.0}')
    recording = csv_folder.read(folder)
    assert recording.tracker_parameters == {'range_sigma_m': 3.0, 'vessel_class': 'small_craft'}
    assert recording.notes == {'cutoff_m': 60.0}


@pytest.mark.parametrize(
    ('file', 'text', 'message'),
    [
        ('plots.csv', None, r'plots.csv does not exist'),
        ('own_ship.csv', None, r'own_ship.csv does not exist'),
        ('own_ship.csv', '', r'own_ship.csv is empty; its first line must name the columns'),
        ('own_ship.csv', OWN_SHIP, r'has no rows; it must have one for every scan'),
        (
            'plots.csv',
            'scan,time_s,range_m\n4,10,100\n',
            r'plots.csv has no column bearing_deg; it has scan, time_s, range_m',
        ),
        ('plots.csv', 'scan,scan,time_s,range_m,bearing_deg\n', r'names a column twice'),
        (
            'plots.csv',
            PLOTS + '4,10,100,90\n4,10,abc,90\n',
            r"plots.csv, line 3: range_m is 'abc'; it must be a number",
        ),
        (
            'plots.csv',
            PLOTS + '\n4,10,,90\n',
            r"plots.csv, line 3: range_m is ''; it must be a number",
        ),
        ('plots.csv', PLOTS + '4,10,nan,90\n', r'line 2: range_m is nan; it must be finite'),
        ('plots.csv', PLOTS + '4,10,inf,90\n', r'line 2: range_m is inf; it must be finite'),
        ('plots.csv', PLOTS + '4,10,-1,90\n', r'line 2: range_m is -1; it must be at least 0'),
        (
            'plots.csv',
            PLOTS + '4,10,1,361\n',
            r'line 2: bearing_deg is 361; it must be between -360 and 360',
        ),
        ('plots.csv', PLOTS + '4,10,1\n', r'plots.csv, line 2 has 3 cells; it must have 4'),
        ('plots.csv', PLOTS + '6,13,1,1\n', r'plots.csv, line 2: scan 6 is not in own_ship.csv'),
        ('plots.csv', PLOTS + '4.5,10,1,1\n', r'line 2: scan is 4.5; it must be a whole number'),
        (
            'plots.csv',
            PLOTS + '4,10,1,1\n5,9,1,1\n',
            r'plots.csv: scan 5 begins at 9 s, before the scan ahead of it, 10 s',
        ),
        (
            'own_ship.csv',
            OWN_SHIP + '4,10,0,0\n5,9,0,0\n',
            r'own_ship.csv, line 3: time_s is 9 after 10; it must increase',
        ),
        (
            'own_ship.csv',
            OWN_SHIP + '4,10,0,0\n4,11,0,0\n',
            r'own_ship.csv, line 3: scan is 4 after 4; it must increase',
        ),
        (
            'own_ship.csv',
            OWN_SHIP.strip() + ',end_s\n4,10,0,0,9\n5,11,0,0,\n7,12,0,0,\n',
            r'own_ship.csv, line 2: end_s is 9; it must not lie before time_s, 10',
        ),
        (
            'truth.csv',
            TRUTH + '4,10,1,0,0,1,1\n4,10,1,5,5,1,1\n',
            r'truth.csv, line 3: target 1 is at 10 s after 10 s; its time must increase',
        ),
        (
            'truth.csv',
            TRUTH + '4,10,one,0,0,1,1\n',
            r"line 2: target is 'one'; it must be a number",
        ),
        ('radar.yaml', '- 1\n', r'radar.yaml holds a list; it must hold a mapping'),
        ('notes.json', '{', r'notes.json, line 1 is not JSON'),
        ('notes.json', '[]', r'notes.json holds a list; it must hold an object'),
    ],
)
def test_what_is_wrong_is_named_with_its_file_and_line(folder, file, text, message):
    if text is None:
        (folder / file).unlink()
    else:
        (folder / file).write_text(text)
    with pytest.raises(ValueError, match=message):
        csv_folder.read(folder)


def test_a_file_that_is_not_text_is_an_error(folder):
    (folder / 'plots.csv').write_bytes(b'\x89PNG\r\n')
    with pytest.raises(ValueError, match='plots.csv, line 1: the byte 0x89 is not UTF-8'):
        csv_folder.read(folder)


def test_a_missing_folder_is_an_error(tmp_path):
    with pytest.raises(ValueError, match=re.escape(f'{tmp_path / "none"} is not a folder')):
        csv_folder.read(tmp_path / 'none')


def test_what_is_written_is_read_again(tmp_path):
    rng = np.random.default_rng(3)
    pairs = []
    for k in range(5):
        start, end, count = 2.7 * k, 2.7 * (k + 1), (3, 0, 1, 4, 2)[k]
        plots = PolarPlots(
            np.sort(rng.uniform(start, end, count)),
            rng.uniform(50, 2e4, count),
            rng.uniform(0, 2 * np.pi, count),
            rng.uniform(0, 30, count),
        )
        at = np.linspace(start, end, 4)
        own_ship = OwnShip(at, np.stack([3 * at, -5 * at], -1), np.tile([3.0, -5.0], (4, 1)))
        truth = Truth(
            rng.uniform(start, end, 2),
            np.array([7, 9]),
            rng.normal(size=(2, 2)) * 1e4,
            np.array([[1.5, -2.5], [np.nan, np.nan]]),
        )
        pairs.append((Scan(start, end, plots, own_ship), truth))
    parameters = {'range_sigma_m': 12.5, 'vessel_class': 'ship', 'max_range_m': 30000.0}
    csv_folder.write(
        tmp_path / 'new' / 'folder', 'my scenario', iter(pairs), parameters, {'cutoff_m': 250.0}
    )
    recording = csv_folder.read(tmp_path / 'new' / 'folder')
    assert recording.tracker_parameters == parameters
    assert TrackerParameters(**recording.tracker_parameters)
    assert recording.notes == {'name': 'my scenario', 'cutoff_m': 250.0}
    assert recording.numbers.tolist() == [0, 1, 2, 3, 4]
    for (scan, truth), read, read_truth in zip(pairs, recording.scans, recording.truths):
        assert (read.start, read.end) == pytest.approx((scan.start, scan.end), abs=1e-6)
        for field in ('time', 'range', 'bearing'):
            np.testing.assert_allclose(
                getattr(read.plots, field), getattr(scan.plots, field), atol=1e-6, rtol=0
            )
        np.testing.assert_allclose(read.plots.amplitude, scan.plots.amplitude, atol=1e-3)
        for mine, other in zip(read_truth, truth):
            np.testing.assert_allclose(mine, other, atol=1e-6, rtol=0)
    np.testing.assert_allclose(recording.own_ship.position[3], pairs[3][0].own_ship.position[0])


def test_a_folder_that_cannot_be_made_is_an_error(tmp_path):
    (tmp_path / 'file').write_text('')
    with pytest.raises(ValueError, match='cannot be made'):
        csv_folder.write(tmp_path / 'file' / 'folder', 'x', [], {})


def test_all_real_recordings_read(recordings):
    folders = sorted(path.parent for path in recordings.glob('*/own_ship.csv'))
    assert folders
    for folder in folders:
        recording = csv_folder.read(folder)
        rows = len((folder / 'plots.csv').read_text().splitlines()) - 1
        assert sum(len(scan.plots.time) for scan in recording.scans) == rows
        assert json.loads((folder / 'notes.json').read_text()) == recording.notes
        assert TrackerParameters(**recording.tracker_parameters)


def test_radial_speeds_are_read_where_the_file_has_them_and_empty_cells_are_nan(folder):
    assert all(scan.plots.radial_speed is None for scan in csv_folder.read(folder).scans)
    (folder / 'plots.csv').write_text(
        PLOTS.strip() + ',radial_speed_mps\n4,10.0,100.0,90.0,-3.5\n4,10.0,200.0,359.0,\n'
    )
    first, empty, last = csv_folder.read(folder).scans
    np.testing.assert_array_equal(first.plots.radial_speed, [-3.5, np.nan])
    assert len(empty.plots.radial_speed) == len(last.plots.radial_speed) == 0


def test_radial_speeds_are_written_and_come_back(tmp_path):
    own_ship = OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))
    no_truth = Truth(np.empty(0), np.empty(0, np.int64), np.empty((0, 2)), np.empty((0, 2)))
    two = np.array([1.0, 2.0])
    told = Scan(0.0, 2.5, PolarPlots(two, 100 * two, two, two, np.array([-7.25, np.nan])), own_ship)
    untold = Scan(2.5, 5.0, PolarPlots(two + 2.5, 100 * two, two, two), own_ship)
    csv_folder.write(tmp_path / 'out', 'x', [(told, no_truth), (untold, no_truth)], {})
    first, second = csv_folder.read(tmp_path / 'out').scans
    np.testing.assert_array_equal(first.plots.radial_speed, [-7.25, np.nan])
    assert np.isnan(second.plots.radial_speed).all()


def test_a_heading_is_written_and_read_where_it_is_known(tmp_path):
    none, still = np.empty(0), np.zeros((2, 2))
    nothing = Truth(none, np.empty(0, int), np.empty((0, 2)), np.empty((0, 2)))
    pairs = []
    for start, heading in ((0.0, 205.0), (2.0, np.nan)):
        own = OwnShip(np.array([start, start + 2]), still, still, np.radians([heading] * 2))
        pairs.append((Scan(start, start + 2, PolarPlots(none, none, none, none), own), nothing))
    csv_folder.write(tmp_path / 'moored', 'moored', pairs, {})
    told = csv_folder.read(tmp_path / 'moored').own_ship.heading
    np.testing.assert_allclose(np.degrees(told), [205.0, np.nan])
