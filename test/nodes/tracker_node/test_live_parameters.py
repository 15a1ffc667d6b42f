"""Parameters that change while the node runs, and what it says of itself each second."""

import struct
import time
import zipfile

import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.parameter import Parameter
from sensor_msgs.msg import PointCloud2

from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.radar_input import MISSED
from marine_tracker.tracking import intake, own_ship


def test_a_live_change_keeps_every_track(rig, clean):
    here = rig()
    here.play(clean[0][:12])
    before, ids = here.names(), here.tracker._operator.memory.tracker.tracks.id.tolist()
    assert len(before) == 6
    for k, (name, value) in enumerate(
        (
            ('estimator', 'cs_kalman'),
            ('vessel_class', 'small_craft'),
            ('estimator', 'imm'),
            ('gate_probability', 0.99),
            ('confirm_hits', 5),
            ('max_target_speed_mps', 30.0),
        )
    ):
        assert here.tracker.set_parameters([Parameter(name, value=value)])[0].successful
        assert getattr(here.tracker._operator.service.tracker.parameters, name) == value
        here.play(clean[0][12 + k : 13 + k])
        assert here.names() == before
        assert all(entry.message == 'TRACKING' for entry in here.targets[-1].status)
    assert here.tracker._operator.memory.tracker.tracks.id.tolist()[:6] == ids[:6]
    used = {pair.value for pair in here.targets[12].status[0].values if pair.key == 'estimator'}
    assert used == {'cs_kalman'}
    assert not here.tracker.failures.counts


def wrong_weights(file, header):
    """A weights file, one of whose arrays has this for its header."""
    with zipfile.ZipFile(file, 'w') as archive:
        text = header.encode() + b'\n'
        archive.writestr('w.npy', b'\x93NUMPY\x01\x00' + struct.pack('<H', len(text)) + text)
    return str(file)


def test_a_live_change_that_cannot_be_read_is_refused_by_name_and_tracks_go_on(
    rig, clean, tmp_path
):
    here = rig()
    here.play(clean[0][:12])
    before = here.names()
    assert len(before) == 6
    zones = (
        '[' * 7_300,
        '{a: ' * 4_100,
        '- ' * 6_000,
        '[' * 900 + ']' * 900,
        '&a [*a]',
        '!!set {7}',
    )
    weights = (
        wrong_weights(tmp_path / 'old.npz', "{'descr': '<f8', 'shape': (2L, 3L"),
        wrong_weights(tmp_path / 'deep.npz', '(' * 3_000),
        str(tmp_path),
        '/dev/null',
    )
    changes = [('zones', value) for value in zones] + [('gwnn_weights', file) for file in weights]
    for k, (name, value) in enumerate(changes):
        (answer,) = here.set(**{name: value})
        assert not answer.successful
        assert name in answer.reason and len(answer.reason.splitlines()) == 1
        assert len(answer.reason) < 400
        here.play(clean[0][12 + k : 13 + k])
        assert here.names() == before
        assert all(entry.message == 'TRACKING' for entry in here.targets[-1].status)
    assert here.set(zones='[{name: bow, kind: guard, range_nm: [1.5, 2.5]}]')[0].successful
    here.play(clean[0][30:32])
    assert here.names() == before


def test_diagnostics_come_each_second_with_names_and_hardware_ids(rig, clean):
    here = rig()
    here.shift_ns = time.time_ns()  # else the plots come late, which would be told
    diagnostics = here.listen(DiagnosticArray, topics.DIAGNOSTICS)
    here.wait(lambda: len(diagnostics) >= 1)
    first = {entry.name: entry for entry in diagnostics[0].status}
    assert list(first) == ['tracker: input', 'tracker: tracking', 'tracker: own ship']
    assert first['tracker: input'].level == DiagnosticStatus.WARN
    assert 'no plots yet' in first['tracker: input'].message
    here.play(clean[0][:8])
    here.wait(lambda: diagnostics[-1].status[0].values[0].value == '8')
    entries = {entry.name: entry for entry in diagnostics[-1].status}
    assert all(entry.hardware_id == 'tracker' for entry in entries.values())
    assert [entry.level for entry in entries.values()] == [DiagnosticStatus.OK] * 3
    values = {pair.key: pair.value for entry in entries.values() for pair in entry.values}
    assert values['scans taken'] == '8' and values['samples'] == '8'
    assert values['confirmed'] == '6'
    assert float(values['processing_p99_ms']) > 0
    for reason in (
        *convert.CLOUD_REASONS,
        *intake.PLOT_REASONS,
        *intake.SCAN_REASONS,
        *own_ship.OWN_REASONS,
        MISSED,
    ):
        assert values[reason] == '0'
    here.radar.publish(convert.plots_to_cloud(clean[0][7], here.stamp(clean[0][7].start)))
    here.wait(lambda: diagnostics[-1].status[0].level == DiagnosticStatus.WARN)
    assert intake.REPEATED in diagnostics[-1].status[0].message


def test_a_radar_that_publishes_best_effort_is_heard(rig, clean, graph):
    here = rig()  # its subscriptions asked for reliable, for everyone was
    driver = here.other.create_publisher(PointCloud2, topics.PLOTS, topics.best_effort())
    here.other.destroy_publisher(here.radar)
    scans = iter(range(10**6))

    def heard():
        k = next(scans)
        driver.publish(
            convert.plots_to_cloud(clean[0][0], here.stamp(clean[0][0].start + 0.02 * k))
        )
        return here.tracker.inputs[0].taken > 0

    here.wait(heard)
