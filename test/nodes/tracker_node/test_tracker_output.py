"""What the tracker node publishes is what the core says."""

import re

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import Marker, MarkerArray

from marine_tracker.arpa.alarms import DANGER
from marine_tracker.arpa.alerts import NORMAL
from marine_tracker.arpa.motion import MEMORY_NAMES
from marine_tracker.geometry import NAUTICAL_MILE, unit_vector
from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.targets_message import MEASURED
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking.lifecycle import CONFIRMED, LOST, TENTATIVE
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import PolarPlots

EPOCH_NS = 1_700_000_000 * 1_000_000_000


def test_what_is_published_is_what_the_core_says(rig, clean):
    scans, parameters = clean
    here = rig()
    tracks = here.listen(Odometry, topics.TRACKS)
    ahead = here.listen(Odometry, topics.EXTRAPOLATIONS)
    cloud = here.listen(PointCloud2, topics.TRACKS_CLOUD)
    core = Tracker(here.tracker._operator.service.tracker.parameters)
    memory, expected, further, rows = core.start(), [], [], []
    for scan in scans[:15]:
        memory, report = core.step(memory, scan)
        chosen = np.flatnonzero((report.tracks.number > 0) & (report.tracks.status != LOST))
        chosen = chosen[np.argsort(report.tracks.number[chosen])]
        estimate = core.extrapolate(report.tracks, report.time)
        later = core.extrapolate(report.tracks, report.time + parameters.scan_period_s)
        expected += [(report.tracks.number[k], estimate, k) for k in chosen]
        further += [(report.tracks.number[k], later, k) for k in chosen]
        rows += [
            (report.tracks.id[k], report.tracks.status[k], estimate, k)
            for k in range(len(report.tracks.id))
        ]
    here.play(scans[:15])
    here.wait(
        lambda: len(tracks) >= len(expected) and len(ahead) >= len(expected) and len(cloud) >= 15
    )
    assert len(expected) > 50
    for got, wanted in ((tracks, expected), (ahead, further)):
        assert len(got) == len(wanted)
        for message, (number, estimate, k) in zip(got.messages, wanted):
            assert message.child_frame_id == f'track_{number:02d}'
            assert message.header.frame_id == 'map'
            stamp = convert.nanoseconds(message.header.stamp) - EPOCH_NS
            assert stamp * 1e-9 == pytest.approx(estimate.time[k], abs=1e-5)
            pose, speed = message.pose.pose, message.twist.twist.linear.x
            yaw = convert.yaw_of(pose.orientation)
            position = [pose.position.x, pose.position.y]
            velocity = [speed * np.cos(yaw), speed * np.sin(yaw)]
            assert position == pytest.approx(estimate.position[k], abs=0.05)
            assert velocity == pytest.approx(estimate.velocity[k], abs=0.01)
            assert message.pose.covariance.reshape(6, 6)[:2, :2] == pytest.approx(
                estimate.covariance[k, :2, :2], rel=1e-3, abs=1e-2
            )
    got = np.concatenate(
        [np.frombuffer(message.data, convert.TRACK_TYPE) for message in cloud.messages]
    )
    assert got['id'].tolist() == [id_ for id_, *_ in rows]
    assert got['status'].tolist() == [status for _, status, *_ in rows]
    assert {TENTATIVE, CONFIRMED} <= set(got['status'].tolist())
    for row, (_, _, estimate, k) in zip(got, rows):
        assert [row['x'], row['y']] == pytest.approx(estimate.position[k], abs=0.05)
        assert [row['vx'], row['vy']] == pytest.approx(estimate.velocity[k], abs=0.01)
        assert [row['xx'], row['xvx'], row['vyvy']] == pytest.approx(
            estimate.covariance[k][[0, 0, 3], [0, 2, 3]], rel=1e-3, abs=1e-2
        )


def printed(value, unit, digits):
    """A printed figure may be off by half its last digit, and what the wire's float32 leaves."""
    return pytest.approx(value, abs=0.51 * 10.0**-digits + 1e-4, nan_ok=True)


def in_danger(picture):
    """Mask [T]: a danger alarm stands; the pictures here have no other alerts of targets."""
    assert set(picture.alerts.kind.tolist()) <= {DANGER}
    return np.isin(picture.targets.id, picture.alerts.id[picture.alerts.state != NORMAL])


def test_targets_read_like_a_table_of_what_the_core_says(rig, clean, core):
    here = rig(cpa_limit_nm=2.0)
    scans = clean[0][:15]
    here.play(scans)
    message = here.targets[-1]
    assert [entry.name for entry in message.status] == [f'TT{n:02d}' for n in range(1, 7)]
    assert convert.nanoseconds(message.header.stamp) == pytest.approx(
        here.stamp(scans[-1].end), abs=1e6
    )
    *_, picture = core(scans, np.radians(20), here.tracker)
    assert picture.targets.number.tolist() == [1, 2, 3, 4, 5, 6]
    compared, danger = 0, in_danger(picture)
    assert 1 <= danger.sum() < 6
    for k, (entry, values) in enumerate(zip(message.status, here.rows().values())):
        assert (values['status'], values['level']) == (
            'TRACKING',
            DiagnosticStatus.ERROR if danger[k] else DiagnosticStatus.OK,
        )
        assert entry.hardware_id == 'tracker'
        for key, unit, field, size, digits in MEASURED:
            for name, value in (
                (f'{key}_{unit}', getattr(picture.approach, field)),
                (f'{key}_sd_{unit}', getattr(picture.approach, f'{field}_sigma')),
            ):
                text, number = values[name], value[k] / size
                assert (text == '') == bool(np.isnan(number)), name
                if text:
                    number = number % 360 if unit == 'deg' and '_sd_' not in name else number
                    assert float(text) == printed(number, unit, digits), name
                    compared += 1
        assert float(values['danger_probability']) == printed(
            picture.approach.danger_probability[k], '', 2
        )
        assert values['motion'] == MEMORY_NAMES[picture.motion.memory[k]]
        assert float(values['motion_since_min']) == printed(
            (picture.time - picture.motion.since[k]) / 60, 'min', 1
        )
        assert (values['acquired'], values['swap_risk'], values['stabilised']) == (
            'A',
            '',
            'ground',
        )
        assert values['estimator'] == 'gwnn' and int(values['hits_in_10']) >= 9
    assert compared >= 6 * 16
    assert len(re.fullmatch(r'\d+\.(\d+)', values['range_nm'])[1]) == 3


def test_a_target_that_vanishes_coasts_and_is_told_lost_once(rig, clean):
    here = rig()
    markers = here.listen(MarkerArray, topics.MARKERS, 50)
    here.play(clean[0][:15])
    here.wait(lambda: len(markers) >= len(here.targets))
    labels = {
        marker.id
        for marker in markers[-1].markers
        if marker.ns == 'labels' and marker.action == Marker.ADD
    }
    assert labels == {1, 2, 3, 4, 5, 6}
    empty = PolarPlots(*(np.empty(0) for _ in range(4)))
    here.play([scan._replace(plots=empty) for scan in clean[0][15:]])
    seen = {}
    for message in here.targets.messages:
        for entry in message.status:
            seen.setdefault(entry.name, []).append((entry.message, entry.level))
    for name in ('TT01', 'TT06'):
        words = [word for word, _ in seen[name]]
        assert words.count('LOST') == 1 and words[-1] == 'LOST' and 'COASTING' in words
        assert ('COASTING', DiagnosticStatus.WARN) in seen[name]
        assert seen[name][-1] == ('LOST', DiagnosticStatus.STALE)
    here.wait(lambda: len(markers) >= len(here.targets))
    deleted = [
        marker.id
        for message in markers.messages
        for marker in message.markers
        if marker.action == Marker.DELETE
    ]
    assert sorted(deleted) == [1, 2, 3, 4, 5, 6]
    assert {len(marker.points) for marker in markers[-1].markers} == {0}


def test_markers_show_symbols_vectors_ellipses_and_past_positions(rig, clean, core):
    here = rig(cpa_limit_nm=2.0)
    markers = here.listen(MarkerArray, topics.MARKERS, 50)
    here.play(clean[0])
    here.wait(lambda: len(markers) == len(here.targets))
    kinds = {marker.ns: points(marker) for marker in markers[-1].markers if marker.ns != 'labels'}
    *_, picture = core(clean[0], np.radians(20), here.tracker)
    motion, red = picture.motion, in_danger(picture)
    count = red.sum()
    assert 1 <= count < 6 and len(kinds['dangerous']) == (32 + 2) * count
    circles, vectors = np.split(kinds['dangerous'], [32 * count])
    corners = np.concatenate([kinds['symbols'], circles]).reshape(6, -1, 2)
    order = np.concatenate([np.flatnonzero(~red), np.flatnonzero(red)])
    assert corners.mean(1) == pytest.approx(motion.position[order], abs=0.1)
    vectors = np.concatenate([kinds['vectors'], vectors]).reshape(6, 2, 2)
    assert vectors[:, 0] == pytest.approx(motion.position[order], abs=0.1)
    assert vectors[:, 1] - vectors[:, 0] == pytest.approx(360 * motion.velocity[order], abs=1.0)
    ellipses = kinds['ellipses'].reshape(6, -1, 2)
    for corner, middle, covariance in zip(ellipses, motion.position, motion.covariance):
        offset = corner - middle
        assert np.einsum(
            'ci,ij,cj->c', offset, np.linalg.inv(covariance[:2, :2]), offset
        ) == pytest.approx(4.0, rel=0.02)
    past = picture.past.position[np.isin(picture.past.id, picture.targets.id)].reshape(-1, 2)
    past = past[np.isfinite(past[:, 0])]
    assert len(past) == 6 * 3  # 109 s, one each 30 s
    assert np.sort(kinds['past_positions'], 0) == pytest.approx(np.sort(past, 0), abs=0.5)
    assert {marker.text for marker in markers[-1].markers if marker.ns == 'labels'} == {
        f'TT{n:02d}' for n in range(1, 7)
    }


def points(marker):
    return np.array([(p.x, p.y) for p in marker.points]).reshape(-1, 2)


def test_nobody_who_listens_means_no_markers_and_no_odometry(rig, clean, monkeypatch):
    here = rig()
    published = []
    output = here.tracker._output
    for publisher in (output._to_markers, output._to_tracks):
        monkeypatch.setattr(publisher, 'publish', published.append)
    here.play(clean[0][:8])
    assert here.names() and not published


def test_who_comes_late_gets_the_targets_at_once(rig, node_helpers, clean):
    here = rig()
    here.play(clean[0][:10])
    late = node_helpers[1](here.other, DiagnosticArray, topics.TARGETS, topics.latched())
    here.wait(lambda: len(late))
    assert late[0] == here.targets[-1]


def test_the_hf_radars_ships_are_targets_after_some_minutes(rig):
    """450 false plots a scan: Doppler goes from the radar over DDS to gate and filter."""
    loaded = scenario.load('hf_radar')
    scans = [scan for (scan, _), _ in zip(radar.simulate(loaded, 3), range(15))]
    given = loaded.tracker_parameters()
    here = rig(estimator='alpha_beta', **given)
    here.play(scans)
    truth = loaded.truth_at(scans[-1].end)
    rows = here.rows().values()
    place = np.array(
        [
            float(row['range_nm'])
            * NAUTICAL_MILE
            * unit_vector(np.radians(float(row['bearing_deg'])))
            for row in rows
        ]
    )
    apart = np.linalg.norm(place[:, None] - truth.position, axis=-1)
    assert (apart.min(0) < 6000).sum() >= 4 and len(place) <= 8
    assert not here.tracker.failures.counts
