"""Stationary objects in `targets`, `targets_cloud` and on the page: by number, without a vector."""

import numpy as np
import pytest

pytest.importorskip('rclpy')

from marine_tracker.arpa import alerts
from marine_tracker.arpa.situation import DANGEROUS
from marine_tracker.arpa.view import view
from marine_tracker.nodes import display_messages, targets_cloud
from marine_tracker.nodes.diagnostics import OK, WARN
from marine_tracker.nodes.targets_message import TargetsWriter
from marine_tracker.service import service_for
from marine_tracker.simulation import radar, scenario

PIER = {
    'duration_s': 120,
    'radar': {'rotation_rpm': 30, 'max_range_m': 2000, 'range_sigma_m': 4},
    'reflectors': [{'corners_m': [[900, -200], [900, 200]], 'spacing_m': 50, 'pd': 0.9}],
    'own_ship': {'course_deg': 2, 'speed_kn': 7},
    'targets': [{'start': {'range_m': 1500, 'bearing_deg': 250}, 'course_deg': 0, 'speed_kn': 9}],
}


@pytest.fixture(scope='module')
def seen():
    scene = scenario.build(PIER, 'pier')
    service = service_for(scene.tracker_parameters(), estimator='imm', stationary_places=True)
    memory = service.start()
    for scan, _ in radar.simulate(scene, 6):
        memory, output = service.step(memory, scan)
    return view(output.picture, output.report, service.tracker.estimator)


def test_targets_name_them_and_warn_of_those_ahead(seen):
    message = TargetsWriter('here').message(seen, 'imm', 120.0, 120_000_000_000)
    entries = {entry.name: entry for entry in message.status}
    fixed = [entry for name, entry in entries.items() if name.startswith('ST')]
    assert 8 <= len(fixed) <= 10 and len(entries) == len(fixed) + len(seen.name)
    for entry, danger in zip(fixed, seen.fixed.danger, strict=True):
        told = {pair.key: pair.value for pair in entry.values}
        assert entry.message == 'STATIONARY' and told['course_deg'] == ''
        assert entry.level == (WARN if danger == DANGEROUS else OK)
        assert 0.1 < float(told['range_nm']) < 0.6
    assert (seen.fixed.danger == DANGEROUS).any()


def test_the_cloud_has_a_point_for_each_without_an_id(seen):
    cloud = targets_cloud.message(seen, alerts.begin(), 5)
    rows = targets_cloud.read(cloud)
    fixed = rows[rows['status'] == 4]
    assert fixed['number'].tolist() == seen.fixed.shown.number.tolist()
    assert not fixed['id'].any() and not fixed['vx'].any()
    assert fixed['y'] == pytest.approx(np.full(len(fixed), 900.0), abs=12)
    columns = display_messages.targets(rows)
    assert columns['number'] == seen.number.tolist()  # the page's targets are without them
    shown = display_messages.stationary(rows)
    assert [one[0] for one in shown] == fixed['number'].tolist()
    assert [one[2] for one in shown] == pytest.approx(fixed['y'].tolist(), abs=0.1)
