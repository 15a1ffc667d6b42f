"""A simulator with AIS, ais_input over UDP, the tracker: what becomes of one ship."""

import socket

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import NavSatFix, PointCloud2

from marine_tracker.ais.join import AIS_ONLY, APART_STATE, BOTH
from marine_tracker.nodes import ais_targets_cloud, convert, topics
from marine_tracker.nodes.ais_input_node import AisInputNode
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.simulation import ais_sentences, radar, scenario, transponders

from .conftest import Rig

SPOOFED, SILENT = 235123456, 235123457
SCENE = {
    'duration_s': 420,
    'origin': {'lat_deg': 50.2, 'lon_deg': -1.4},
    'radar': {'max_range_nm': 6, 'pd_near': 1.0, 'pd_far': 1.0},
    'own_ship': {'course_deg': 10, 'speed_kn': 8},
    'ais': {'send': {'share': 0, 'latency_s': 0.4}},
    'targets': [
        {
            'name': 'honest then not',
            'start': {'range_nm': 3, 'bearing_deg': 60},
            'course_deg': 20,
            'speed_kn': 9,
            'ais': {
                'class': 'a',
                'mmsi': SPOOFED,
                'spoof': {'from_s': 240, 'shift_m': 1500, 'bearing_deg': 140},
            },
        },
        {
            'name': 'falls silent',
            'start': {'range_nm': 2.5, 'bearing_deg': 300},
            'course_deg': 350,
            'speed_kn': 10,
            'ais': {'class': 'a', 'mmsi': SILENT, 'silent_s': [110, 215]},
        },
        {
            'name': 'no ais',
            'start': {'range_nm': 3.5, 'bearing_deg': 180},
            'course_deg': 30,
            'speed_kn': 7,
        },
    ],
}


def ships(cloud):
    return np.frombuffer(cloud.data, ais_targets_cloud.SHIP_TYPE)


def values(entry):
    return {pair.key: pair.value for pair in entry.values}


@pytest.fixture
def port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(('127.0.0.1', 0))
        return one.getsockname()[1]


@pytest.mark.slow
def test_a_ship_joins_falls_silent_joins_again_and_is_told_to_lie(graph, node_helpers, port):
    wait, listener = node_helpers
    chosen = scenario.build(SCENE, 'one of each')
    scans = [scan for scan, _ in radar.simulate(chosen, 4)]
    parameters = from_mapping(TrackerParameters, chosen.tracker_parameters())
    rig = Rig(graph, node_helpers, (scans, parameters))
    node = graph.make(AisInputNode, udp=f'127.0.0.1:{port}', topics='')
    fixes = rig.other.create_publisher(NavSatFix, topics.FIX, 10)
    wait(lambda: fixes.get_subscription_count() and node._to_reports.get_subscription_count())
    heard = listener(rig.other, PointCloud2, topics.AIS_TARGETS, topics.latched(500))
    alarms = listener(rig.other, DiagnosticArray, topics.ALARMS, topics.latched(500))
    wait(lambda: heard.connected and alarms.connected)
    rig.shift_ns = rig.tracker.get_clock().now().nanoseconds
    epoch = rig.shift_ns * 1e-9
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    out.connect(('127.0.0.1', port))
    sent = transponders.transmit(
        chosen.fleet.ais, chosen.fleet.paths, chosen.fleet.length, chosen.duration, 4
    )
    lines = [
        pair
        for some in sent
        for pair in ais_sentences.encode(some, chosen.fleet.origin, chosen.fleet.names, epoch)
    ]
    states: dict[int, list[int]] = {SPOOFED: [], SILENT: []}
    told: dict[str, int] = {}
    counted = 0
    # Scans are sent faster than they turn: reports get the scan's time, as the clock has not moved.
    with pytest.MonkeyPatch.context() as patch:
        now = [epoch]
        patch.setattr(node, '_now', lambda: now[0])
        for scan in scans:
            rig.send_own_ship_of([scan])
            place = chosen.fleet.origin.to_geodetic(scan.own_ship.position[-1])
            fixes.publish(convert.fix_message(rig.stamp(scan.end), *map(float, place)))
            while lines and lines[0][0] <= scan.end:
                now[0] = epoch + lines[0][0]
                for line in lines.pop(0)[1]:
                    out.send(line.encode())
                    counted += 1
                wait(lambda counted=counted: node._sentences.lines == counted)
            rig.send([scan])
            if not heard:
                continue
            rows = {int(row['mmsi']): row for row in ships(heard[-1])}
            for mmsi, of in states.items():
                if mmsi in rows and (not of or of[-1] != rows[mmsi]['state']):
                    of.append(int(rows[mmsi]['state']))
    for message in alarms:
        for entry in message.status:
            told.setdefault(entry.name, 0)
            told[entry.name] = max(told[entry.name], int(values(entry)['sounds']))
    out.close()
    assert states[SPOOFED] == [AIS_ONLY, BOTH, APART_STATE]
    assert states[SILENT] == [AIS_ONLY, BOTH, AIS_ONLY, BOTH]
    assert told[f'AIS {SILENT}: AIS lost'] == 1
    assert f'AIS {SPOOFED}: AIS mismatch' in told
