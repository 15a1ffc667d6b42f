import numpy as np
import pytest

pytest.importorskip('rclpy')
from marine_tracker.ais import ships
from marine_tracker.ais.reports import positions
from marine_tracker.ais.ship_table import none
from marine_tracker.arpa.cpa import OwnMotion
from marine_tracker.nodes import ais_cloud, ais_columns, ais_targets_cloud, display_ais
from marine_tracker.nodes.targets_message import degrees, figure
from marine_tracker.parameters import AisParameters, TrackerParameters
from marine_tracker.service import Service


def reports(**more):
    nothing = np.zeros(2)
    return positions(
        np.array([219000001, 219000002]), nothing + 10, nothing, nothing, nothing + 4,
        np.array([0.0, np.nan]), **more,
    )  # fmt: skip


@pytest.fixture
def picture():
    service = Service(TrackerParameters(), ais=AisParameters(ais_activation='all'))
    told = reports(name=np.array(['SKAGEN', '']), heading=np.array([0.0, np.nan]))
    memory = service.hear(service.start(), told, np.array([[900.0, 0], [0, 4000.0]]))
    own = OwnMotion(np.zeros(2), np.zeros(2), 0.0, np.zeros((4, 4)))
    return service.without_radar(memory, own, 12.0)[1]


def test_what_a_ship_does_not_tell_is_missing_not_zero(picture):
    names, _, messages, rows = ais_columns.alone(picture, figure, degrees)
    assert names == ['AIS 219000001', 'AIS 219000002'] and messages == ['AIS', 'AIS']
    first, second = rows
    assert (first['ship_name'], second['ship_name']) == ('SKAGEN', 'missing')
    assert (first['heading_deg'], second['heading_deg']) == ('000.0', 'missing')
    assert (first['ais_course_deg'], second['ais_course_deg']) == ('000.0', 'missing')
    assert first['turn_deg_per_min'] == second['navigational_status'] == 'missing'
    assert first['range_nm'] and not second['cpa_nm']


def test_ships_go_out_as_numbers_and_come_back(picture):
    rows = ais_targets_cloud.read(ais_targets_cloud.message(picture, 12_000_000_000))
    assert rows['mmsi'].tolist() == [219000001, 219000002]
    assert ais_cloud.text_of(rows['name']).tolist() == ['SKAGEN', '']
    assert np.isnan(rows['heading']).tolist() == [False, True]
    assert rows['range'][0] == pytest.approx(900, abs=1)


def test_the_page_gets_none_where_nothing_is_known(picture):
    rows = ais_targets_cloud.read(ais_targets_cloud.message(picture, 12_000_000_000))
    columns = display_ais.ships(rows)
    assert columns['heading'] == [0.0, None] and columns['name'] == ['SKAGEN', '']
    assert columns['course'][1] is None and columns['cpa'][1] is None
    assert columns['mmsi'] == [219000001, 219000002]


def test_reports_go_out_as_numbers_and_come_back():
    told = reports(
        name=np.array(['ANHOLT', '']), size=np.array([[80.0, 20, 7, 9], [np.nan] * 4]), status=5
    )
    back = ais_cloud.read(ais_cloud.message(told, 10.5, 77_000_000_000), 77.0)
    assert back.heard == pytest.approx(told.heard + 66.5)
    for name in ('mmsi', 'type', 'name', 'ship_type', 'status', 'timed'):
        assert getattr(back, name).tolist() == getattr(told, name).tolist(), name
    assert np.allclose(back.size, told.size, equal_nan=True)
    known, _ = ships.hear(none(), back, np.zeros((2, 2)), 1)
    assert known.name.tolist() == ['ANHOLT', '']
