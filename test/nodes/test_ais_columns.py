import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip('rclpy')
from marine_tracker.ais import ships
from marine_tracker.ais.join import AIS_ONLY, BOTH
from marine_tracker.ais.reports import positions
from marine_tracker.ais.ship_table import none
from marine_tracker.arpa.cpa import OwnMotion
from marine_tracker.display.trails import Trails
from marine_tracker.geometry import KNOT, NAUTICAL_MILE
from marine_tracker.nodes import (
    ais_cloud,
    ais_columns,
    ais_targets_cloud,
    arpa_messages,
    danger_areas_cloud,
    display_ais,
    targets_cloud,
)
from marine_tracker.nodes.diagnostics import ERROR, OK
from marine_tracker.nodes.targets_message import degrees, figure
from marine_tracker.parameters import AisParameters, ArpaParameters, TrackerParameters
from marine_tracker.service import Service
from marine_tracker.types import OwnShip, PolarPlots, Scan

STATIC = Path(display_ais.__file__).parents[1] / 'display/static'


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


def test_a_trial_and_the_areas_of_danger_take_activated_ships_that_radar_does_not_see():
    arpa = ArpaParameters(trial_course_deg=0.0, trial_speed_kn=12.0, own_ship_status='under_way')
    service = Service(TrackerParameters(), arpa, ais=AisParameters(ais_activation='range'))
    nothing = np.zeros(4)
    told = positions(
        219000001 + np.arange(4), nothing, nothing, nothing,
        np.array([6, np.nan, 5, 6]), np.radians([180.0, np.nan, 90, 180]),
    )  # fmt: skip
    place = np.array([[0.05, 2.7], [0.7, 0.4], [0.5, 1.8], [0.0, 9.0]]) * NAUTICAL_MILE
    memory = service.hear(service.start(), told, place)
    way = np.array([[0.0, 12 * KNOT]])
    for now in (3.0, 6.0):
        own = OwnShip(np.array([now]), now * way, way, np.zeros(1))
        scan = Scan(now - 3, now, PolarPlots(*[np.zeros(0)] * 4), own)
        memory, output = service.step(memory, scan)

    def trial(course):
        tried = Service(TrackerParameters(), replace(arpa, trial_course_deg=course)).arpa
        message = arpa_messages.trial_message(tried, output.picture, output.ais, 0.0, 9, 'mine')
        return {entry.name: entry for entry in message.status}

    ahead, aside = trial(0.0), trial(250.0)
    names = [f'AIS {mmsi}' for mmsi in (219000001, 219000002, 219000003)]
    assert list(ahead) == ['T', *names]  # the last one sleeps beyond 3 NM
    assert [ahead[name].level for name in names] == [ERROR, OK, OK]
    assert [aside[name].level for name in names] == [OK, OK, OK]
    values = {pair.key: pair.value for pair in ahead[names[0]].values}
    assert float(values['cpa_nm']) == pytest.approx(0.05, abs=0.01)
    assert not {pair.key: pair.value for pair in ahead[names[1]].values}['cpa_nm']
    cloud = danger_areas_cloud.message(service.arpa, output.picture, output.ais, 9)
    rows = targets_cloud.read(cloud, danger_areas_cloud.AREA_TYPE)
    areas = rows[rows['area'] > 0]
    assert 219000001 in areas['number'] and not areas['id'].any()
    ring = rows[rows['area'] == 0]
    assert not ring['safe'][0] and ring['safe'][len(ring) // 2]


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
    assert columns['nav'] == [None, None] and columns['length'] == [None, None]
    page = (STATIC / 'ships.js').read_text() + (STATIC / 'ship_words.js').read_text()
    for name in re.findall(r'\bship\.([a-z_]+)', page):
        assert name in columns or name in ('wx', 'wy', 'what', 'alarm'), name


def test_activated_ships_leave_past_positions(picture):
    joined = picture.joined._replace(state=np.array([BOTH, AIS_ONLY], np.int8))
    seen = ais_targets_cloud.points(picture._replace(joined=joined))
    ids, places = display_ais.places(seen)
    assert ids.tolist() == [-2] and places == pytest.approx(np.array([[0.0, 4000.0]]), abs=1)
    trails = Trails()
    assert trails.add(20.0, np.zeros(2), ids, places)
    assert trails.plain()['targets'] == {'-2': [[0.0, 4000.0]]}


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
