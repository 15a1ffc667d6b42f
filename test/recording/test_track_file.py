import io

import numpy as np
import pytest

from marine_tracker.recording import track_file
from marine_tracker.types import Extrapolation, OwnShip

AT_ORIGIN = OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))


def written(tmp_path):
    file = io.StringIO()
    covariance = np.zeros((2, 4, 4))
    covariance[:, range(4), range(4)] = [4.0, 9.0, 1.0, 1.0]
    tracks = Extrapolation(
        np.array([5.0, 5.5]),
        np.array([[300.0, 400.0], [-1e-9, 100.0]]),
        np.array([[0.0, -10.0], [5.0, 0.0]]),
        covariance,
    )
    track_file.write_header(file)
    track_file.write_scan(
        file,
        12,
        tracks,
        np.array([3, 8]),
        np.array(['confirmed', 'tentative']),
        np.array([[301.0, 402.0], [np.nan, np.nan]]),
        np.array([4, -1]),
        AT_ORIGIN,
        'imm',
        track_file.TargetColumns(
            np.array([2, 0]),
            np.array([0.25, np.nan]),
            np.array([12.5, np.nan]),
            np.array(['dangerous', '']),
            np.array([0.75, np.nan]),
            np.array([180.0, np.nan]),
            np.array([30.0, np.nan]),
            np.array([-1e-9, np.nan]),
        ),
    )
    path = tmp_path / 'tracks.csv'
    path.write_text(file.getvalue())
    return path


def test_rows_say_what_they_should(tmp_path):
    header, first, second = written(tmp_path).read_text().splitlines()
    row = dict(zip(header.split(','), first.split(',')))
    assert row == {
        'time_s': '5.0000',
        'track': '3',
        'status': 'confirmed',
        'north_m': '400.0000',
        'east_m': '300.0000',
        'vel_north_mps': '-10.0000',
        'vel_east_mps': '0.0000',
        'pred_north_m': '402.0000',
        'pred_east_m': '301.0000',
        'scan': '12',
        'sd_north_m': '3.000',
        'sd_east_m': '2.000',
        'course_deg': '180.00',
        'speed_kn': '19.438',
        'range_m': '500.00',
        'bearing_deg': '36.87',
        'plot': '4',
        'estimator': 'imm',
        'target': '2',
        'cpa_nm': '0.2500',
        'tcpa_min': '12.500',
        'danger': 'dangerous',
        'danger_probability': '0.750',
        'length_m': '180.0',
        'beam_m': '30.0',
        'heading_deg': '0.00',
    }
    row = dict(zip(header.split(','), second.split(',')))
    assert row['pred_north_m'] == row['pred_east_m'] == row['plot'] == ''
    assert row['bearing_deg'] == '0.00'  # not 360.00
    assert not any(row[name] for name in track_file.COLUMNS[18:])


def test_what_is_written_is_read_again(tmp_path):
    rows = track_file.read(written(tmp_path))
    assert rows.track.tolist() == ['3', '8'] and rows.scan.tolist() == [12, 12]
    assert rows.position[0].tolist() == [300.0, 400.0]
    assert rows.velocity[0].tolist() == [0.0, -10.0]
    assert rows.predicted[0].tolist() == [301.0, 402.0] and np.isnan(rows.predicted[1]).all()


def test_another_trackers_file_needs_seven_columns_in_any_order(tmp_path):
    path = tmp_path / 'other.csv'
    path.write_text(
        'track,status,time_s,east_m,north_m,vel_east_mps,vel_north_mps,note\n'
        'A7,confirmed,1,2,3,4,5,x\n'
    )
    rows = track_file.read(path)
    assert rows.track.tolist() == ['A7'] and rows.scan is None
    assert rows.position.tolist() == [[2.0, 3.0]] and rows.velocity.tolist() == [[4.0, 5.0]]


def test_a_missing_column_or_a_bad_cell_is_named(tmp_path):
    path = tmp_path / 'bad.csv'
    path.write_text('time_s,track,status,north_m,east_m,vel_north_mps\n')
    with pytest.raises(ValueError, match='bad.csv has no column vel_east_mps'):
        track_file.read(path)
    path.write_text(
        'time_s,track,status,north_m,east_m,vel_north_mps,vel_east_mps\n1,1,confirmed,nan,0,0,0\n'
    )
    with pytest.raises(ValueError, match='bad.csv, line 2: north_m is nan; it must be finite'):
        track_file.read(path)
