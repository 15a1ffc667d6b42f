"""What `targets`, `markers` and /diagnostics tell of hulls and of land, over DDS."""

import numpy as np
import pytest

pytest.importorskip('rclpy')
from visualization_msgs.msg import Marker, MarkerArray

from marine_tracker.nodes import hull_columns, topics
from marine_tracker.nodes.targets_message import COLUMNS
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.simulation import radar, scenario

TOLD = (
    'length_m',
    'length_sd_m',
    'beam_max_m',
    'heading_deg',
    'heading_sd_deg',
    'heading_from',
    'hull_clearance_nm',
    'extent_method',
)


def first_scans(name, count, seed=1):
    chosen = scenario.load(name)
    scans = [scan for (scan, _), _ in zip(radar.simulate(chosen, seed), range(count))]
    return chosen, scans, from_mapping(TrackerParameters, chosen.tracker_parameters())


@pytest.fixture(scope='module')
def hulls():
    return first_scans('hulls', 24)


def given(parameters, **more):
    return {
        **{
            name: getattr(parameters, name)
            for name in (
                'range_sigma_m',
                'bearing_sigma_deg',
                'max_range_m',
                'range_resolution_m',
                'beam_width_deg',
                'glint_sigma_m',
            )
        },
        **more,
    }


def polygons(message):
    """Points [P, 2] of the marker `hulls`; None where there is none."""
    found = [marker for marker in message.markers if marker.ns == 'hulls']
    assert len(found) <= 1
    if not found:
        return None
    assert found[0].type == Marker.LINE_LIST and found[0].header.frame_id == 'map'
    return np.array([[point.x, point.y] for point in found[0].points])


def test_targets_and_markers_show_hulls(rig, hulls):
    chosen, scans, parameters = hulls
    here = rig(**given(parameters, extent='gp'))
    markers = here.listen(MarkerArray, topics.MARKERS)
    here.play(scans)
    here.wait(lambda: len(markers) >= len(scans))
    rows = here.rows()
    assert len(rows) == 5
    end = scans[-1].end
    truth = chosen.truth_at(end)
    own = chosen.own_ship_at(end)
    lengths = {}
    for row in rows.values():
        assert tuple(row)[-len(TOLD) :] == TOLD
        offset = truth.position - own.position[0]
        bearing = np.degrees(np.arctan2(*offset.T)) % 360
        ship = int(np.abs((bearing - float(row['bearing_deg']) + 180) % 360 - 180).argmin())
        lengths[ship] = float(row['length_m'])
        assert lengths[ship] == pytest.approx(chosen.fleet.length[ship], abs=30)
        assert float(row['length_sd_m']) > 0
        assert float(row['beam_max_m']) >= 0.8 * chosen.fleet.hulls.beam[ship]
        course = np.degrees(np.arctan2(*truth.velocity[ship])) % 360
        off = (float(row['heading_deg']) - course + 180) % 360 - 180
        assert abs(off) < 6 and float(row['heading_sd_deg']) < 10
        assert row['heading_from'] in ('course', 'axis', 'outline')
        assert row['extent_method'] in ('random_matrix', 'gp')
        # Her hull comes nearer than her middle, by no more than half her length.
        nearer = float(row['cpa_nm']) - float(row['hull_clearance_nm'])
        assert -0.01 < nearer < (0.5 * chosen.fleet.length[ship] + 40) / 1852
    assert sorted(lengths) == [0, 1, 2, 3, 4]
    assert 'gp' in {row['extent_method'] for row in rows.values()}
    shown = polygons(markers[-1])
    assert len(shown) == 5 * 2 * 36
    for ship, length in lengths.items():
        off = shown - truth.position[ship]
        near = off[np.hypot(*off.T) < 0.5 * chosen.fleet.length[ship] + 60]
        ahead = truth.velocity[ship] / np.hypot(*truth.velocity[ship])
        assert np.ptp(near @ ahead) == pytest.approx(length, rel=0.1)


def test_with_extent_off_nothing_is_told_of_hulls_and_it_can_be_switched_on(rig, hulls):
    _, scans, parameters = hulls
    here = rig(**given(parameters))
    markers = here.listen(MarkerArray, topics.MARKERS)
    here.play(scans[:6])
    here.wait(lambda: len(markers) >= 6)
    assert tuple(next(iter(here.rows().values())))[2:] == COLUMNS
    assert polygons(markers[-1]) is None
    assert all(answer.successful for answer in here.set(extent='random_matrix'))
    here.play(scans[6:20])
    here.wait(lambda: len(markers) >= 20)
    rows = here.rows()
    assert all(tuple(row)[2:] == COLUMNS + hull_columns.COLUMNS for row in rows.values())
    assert any(row['extent_method'] == 'random_matrix' for row in rows.values())
    assert len(polygons(markers[-1]))


def test_diagnostics_count_clusters_of_land(rig):
    _, scans, parameters = first_scans('coast', 10)
    here = rig(**given(parameters, extent='random_matrix'))
    here.play(scans)
    assert here.tracker._operator.memory.extents.shores > 0
    values = {pair.key: pair.value for pair in here.tracker._tracking_status(0.0).values}
    assert values['clusters of land'] == str(here.tracker._operator.memory.extents.shores)
    assert len(here.rows()) <= 9
