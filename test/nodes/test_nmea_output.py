"""The NMEA output over real DDS, UDP and TCP."""

import contextlib
import json
import signal
import socket
import sys
import time

import numpy as np
import pynmea2
import pytest
from pyproj import Geod

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from nav_msgs.msg import Odometry
from sensor_msgs.msg import NavSatFix, PointCloud2
from std_msgs.msg import String

from marine_tracker.geometry import KNOT, NAUTICAL_MILE, unit_vector
from marine_tracker.nodes import convert, targets_cloud, topics
from marine_tracker.nodes.nmea_output_input import FIX_BY_ARRIVAL, TIME_BY_ARRIVAL
from marine_tracker.nodes.nmea_output_node import NmeaOutputNode

OUTPUT = 'nodes.run nmea_output'
SECOND = 1_000_000_000
NOON = 1_700_049_600 * SECOND  # 2023-11-15 12:00 UTC
LOOPBACK = '127.0.0.1'
EARTH = Geod(ellps='WGS84')


STATUS = {'ACQUIRING': 0, 'TRACKING': 1, 'COASTING': 2, 'LOST': 3}


def entry(title, status='TRACKING', by_hand=False, **values):
    """A row of `targets_cloud`: TT07 or Q123; values in NM, deg, kn, min."""
    row = np.zeros(1, targets_cloud.TARGET_TYPE)
    row['number' if title.startswith('TT') else 'id'] = int(title.lstrip('TQ'))
    row['status'], row['acquired'] = STATUS[status], by_hand
    shown = {
        'range': 2.0,
        'bearing': 45.0,
        'course': 225.0,
        'speed': 10.0,
        'cpa': 0.1,
        'tcpa': 12.0,
    }
    units = {'bearing': np.pi / 180, 'course': np.pi / 180, 'speed': KNOT, 'tcpa': 60.0}
    for name, value in {**shown, **values}.items():
        row[name] = value * units.get(name, NAUTICAL_MILE)
    return row


class Ear:
    """A UDP socket that hears at most so long."""

    def __init__(self, patience=10.0, host=LOOPBACK):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        self.socket.bind((host, 0))
        self.socket.settimeout(patience)
        self.port = self.socket.getsockname()[1]

    def hear(self, count):
        return [self.socket.recv(4096).decode() for _ in range(count)]


@pytest.fixture
def ears():
    with contextlib.ExitStack() as stack:

        def make(**arguments):
            ear = Ear(**arguments)
            stack.callback(ear.socket.close)
            return ear

        yield make


@pytest.fixture
def free_port():
    with socket.socket() as one:
        one.bind((LOOPBACK, 0))
        return one.getsockname()[1]


def cloud(entries, seconds):
    """A message on `targets_cloud`."""
    rows = np.concatenate([np.zeros(0, targets_cloud.TARGET_TYPE), *entries])
    return convert.cloud_message(rows, NOON + round(seconds * SECOND))


class Rig:
    """The node, and someone who publishes what it hears and hears what it publishes."""

    def __init__(self, graph, node_helpers, **parameters):
        self.wait, listener = node_helpers
        self.node = graph.make(NmeaOutputNode, **{'udp': '', **parameters})
        self.other = graph.bystander()
        self.nmea = listener(self.other, String, topics.NMEA, topics.reliable(topics.BURST))
        self.diagnostics = listener(self.other, DiagnosticArray, topics.DIAGNOSTICS)
        self.targets, self.odometry, self.fix = (
            self.other.create_publisher(kind, topic, topics.reliable(50))
            for kind, topic in (
                (Odometry, topics.ODOMETRY),
                (Odometry, topics.ODOMETRY),
                (NavSatFix, topics.FIX),
            )
        )
        self.targets = self.other.create_publisher(
            PointCloud2, topics.TARGETS_CLOUD, topics.latched()
        )
        self.wait(
            lambda: (
                self.targets.get_subscription_count()
                and self.odometry.get_subscription_count()
                and self.fix.get_subscription_count()
                and self.nmea.connected
                and self.node.count_subscribers(topics.NMEA)
            )
        )
        self.scans = 0

    def send_own_ship(
        self, seconds=0.0, position=(0.0, 0.0), speed=10 * KNOT, course_deg=90.0, fix=(54.5, 10.25)
    ):
        stamp = NOON + round(seconds * SECOND)
        velocity = speed * unit_vector(np.radians(course_deg))
        self.odometry.publish(convert.own_ship_to_odometry(stamp, position, velocity))
        self.wait(lambda: self.node._own.time_ns == stamp)
        if fix:
            self.fix.publish(convert.fix_message(stamp, *fix))
            self.wait(lambda: self.node._own.anchor is not None)

    def scan(self, *entries, seconds=None):
        """Publish targets; the sentences of this scan."""
        self.scans += 1
        seconds = self.scans if seconds is None else seconds
        before = len(self.nmea)
        message = cloud(entries, seconds)
        sent = self.node._count['sentences']
        self.targets.publish(message)
        self.wait(lambda: self.node._count['sentences'] > sent)
        self.wait(lambda: len(self.nmea) == self.node._count['sentences'])
        return [one.data for one in self.nmea[before:]]

    def output(self):
        """The last word on /diagnostics."""
        for message in reversed(self.diagnostics.messages):
            return message.status[0]
        return None


@pytest.fixture
def rig(graph, node_helpers):
    return lambda **parameters: Rig(graph, node_helpers, **parameters)


def kinds(lines):
    return [line[3:6] for line in lines]


def test_a_scan_gives_own_ship_and_one_ttm_a_target_alike_on_topic_udp_and_tcp(
    rig, ears, free_port
):
    ear = ears()
    here = rig(udp=f'{LOOPBACK}:{ear.port}', tcp=f'{LOOPBACK}:{free_port}', own_ship_period_s=60.0)
    with socket.create_connection((LOOPBACK, free_port), 10) as client:
        here.wait(lambda: len(here.node._tcp) == 1)
        here.send_own_ship()
        said = here.scan(
            entry('TT01'), entry('TT02', range=0.5, tcpa=-3.0, by_hand=True), seconds=2.0
        )
        first = [one.data for one in here.nmea.messages]  # with those of the odometry
        heard = ear.hear(len(first))
        with client.makefile(newline='') as stream:
            served = [stream.readline() for _ in first]
    assert kinds(said) == ['RMC', 'HDT', 'OSD', 'TTM', 'TTM']
    assert heard == served == [f'{line}\r\n' for line in first]
    assert said[3].startswith(
        '$RATTM,01,2.000,045.0,T,10.00,225.0,T,0.100,12.0,N,TT01,T,,120002.00,A*'
    )
    assert said[4].startswith(
        '$RATTM,02,0.500,045.0,T,10.00,225.0,T,0.100,-3.0,N,TT02,T,,120002.00,M*'
    )
    assert said[2].startswith('$RAOSD,090.0,A,090.0,P,10.00,P,,,N*')
    rmc = pynmea2.parse(said[0], check=True)
    # Two seconds on at 10 knots from where the fix was.
    bearing, _, distance = EARTH.inv(10.25, 54.5, rmc.longitude, rmc.latitude)
    assert rmc.is_valid and distance == pytest.approx(20 * KNOT, abs=0.2)
    assert bearing == pytest.approx(90, abs=1.0)


def test_lost_and_cancelled_targets_get_one_last_word_and_then_no_more(rig):
    here = rig()

    def status(lines):
        return {line.split(',')[1]: line.split(',')[12] for line in lines if 'TTM' in line}

    assert status(here.scan(*map(entry, ('TT01', 'TT02', 'TT03')))) == {
        '01': 'T',
        '02': 'T',
        '03': 'T',
    }
    assert status(here.scan(entry('TT01'), entry('TT02', 'LOST'))) == {
        '01': 'T',
        '02': 'L',
        '03': 'L',
    }
    assert status(here.scan(entry('TT01'))) == {'01': 'T'}
    assert status(here.scan()) == {'01': 'L'}
    assert status(here.scan()) == {}


def test_what_is_not_known_is_left_empty(rig):
    here = rig(sentences='TTM')
    unknown = {'course': np.nan, 'speed': np.inf, 'cpa': np.nan, 'tcpa': np.nan}
    said = here.scan(
        entry('TT05', 'COASTING', range=1.5, bearing=359.9, **unknown),
        entry('Q123', 'ACQUIRING', by_hand=True),
        entry('TT07', range=np.nan),
    )
    assert [line.rpartition('*')[0] for line in said] == [
        '$RATTM,05,1.500,359.9,T,,,T,,,N,TT05,T,,120001.00,A',
        '$RATTM,99,2.000,045.0,T,,,T,0.100,,N,Q123,Q,,120001.00,M',
    ]


def test_a_receiver_of_three_digits_is_told_each_target_by_its_own_number(rig):
    here = rig(sentences='TTM', target_numbers=500)
    said = here.scan(entry('TT08'), entry('TT108'), entry('TT499'), entry('TT3000'))
    parsed = [pynmea2.parse(line, check=True) for line in said]
    assert [(one.target_number, one.name) for one in parsed] == [
        (8, 'TT08'),
        (108, 'TT108'),
        (499, 'TT499'),
        (1, 'TT3000'),
    ]


def test_the_same_message_twice_is_one_scan(rig):
    here = rig(sentences='TTM')
    assert len(here.scan(entry('TT01'), seconds=5.0)) == 1
    here.targets.publish(cloud([entry('TT01')], 5.0))
    assert len(here.scan(entry('TT01'), seconds=6.0)) == 1


def test_all_sentences_and_talkers_as_chosen(rig):
    here = rig(
        sentences='TLL RSD TTM OSD HDT RMC',
        talker='II',
        own_ship_talker='GP',
        origin='54.0 10.0',
        range_scale_nm=12.0,
        own_ship_period_s=60.0,
    )
    here.send_own_ship(seconds=1.0, position=(0.0, 1852.0), fix=None)
    # Own ship may have been told once before the scan came.
    said = here.scan(entry('TT01', range=1.0, bearing=0.0), seconds=1.0)[-6:]
    assert [line[1:6] for line in said] == ['GPRMC', 'GPHDT', 'IIOSD', 'IIRSD', 'IITTM', 'IITLL']
    rmc, tll = (pynmea2.parse(said[k], check=True) for k in (0, 5))
    assert rmc.latitude == pytest.approx(EARTH.fwd(10, 54, 0, 1852)[1], abs=2e-6)
    assert tll.latitude == pytest.approx(EARTH.fwd(10, 54, 0, 2 * 1852)[1], abs=2e-6)
    assert tll.longitude == pytest.approx(10.0, abs=2e-6)
    assert ',12.000,N,N*' in said[3]


@pytest.mark.parametrize(
    ('origin', 'own', 'miles', 'bearing'),
    [
        ((-17.0, 179.9), (5000.0, -3000.0), 8.0, 77.0),
        ((52.0, -179.7), (-30 * 1852.0, 2000.0), 12.0, 200.0),
        ((80.0, 15.0), (22 * 1852.0, 4 * 1852.0), 10.0, 350.0),
        ((-84.0, 179.5), (9000.0, 0.0), 24.0, 45.0),
    ],
)
@pytest.mark.parametrize('by', ['origin', 'fix'])
def test_targets_are_at_range_and_true_bearing_from_own_ship_wherever_she_is(
    rig, ears, by, origin, own, miles, bearing
):
    """By the geodesics of pyproj, to what the sentences can tell (0.2 m)."""
    ear = ears()
    where = f'{origin[0]} {origin[1]}' if by == 'origin' else ''
    here = rig(
        sentences='RMC TTM TLL',
        origin=where,
        signalk_udp=f'{LOOPBACK}:{ear.port}',
        own_ship_period_s=60.0,
    )
    own_bearing = np.degrees(np.arctan2(*own))
    own_lon, own_lat, _ = EARTH.fwd(*origin[::-1], own_bearing, np.hypot(*own))
    # A fix tells nothing of the origin of `map`.
    fix = (own_lat, own_lon) if by == 'fix' else None
    here.send_own_ship(seconds=1.0, position=own, fix=fix)
    told = here.scan(entry('TT01', range=miles, bearing=bearing), seconds=1.0)
    # Own ship's RMC may also come by her own clock, just before that of the scan.
    said = {one.sentence_type: one for one in (pynmea2.parse(t, check=True) for t in told)}
    rmc, tll = said['RMC'], said['TLL']
    assert EARTH.inv(rmc.longitude, rmc.latitude, own_lon, own_lat)[2] < 0.3
    lon, lat, _ = EARTH.fwd(own_lon, own_lat, bearing, miles * 1852)
    assert EARTH.inv(tll.longitude, tll.latitude, lon, lat)[2] < 0.3
    (delta,) = map(json.loads, ear.hear(1))
    place = next(
        one['value']
        for one in delta['updates'][0]['values']
        if one['path'] == 'navigation.position'
    )
    assert EARTH.inv(place['longitude'], place['latitude'], lon, lat)[2] < 0.1
    assert -180 <= place['longitude'] < 180


def test_odometry_off_the_earth_makes_rmc_void_and_the_next_one_is_told(rig):
    here = rig(sentences='RMC TLL', origin='54.0 10.0')
    here.send_own_ship(seconds=1.0, position=(3e7, 0.0), fix=None)
    assert kinds(said := here.scan(entry('TT01'), seconds=1.0)) == ['RMC'] and ',V,,,,,' in said[0]
    here.send_own_ship(seconds=2.0, position=(300.0, 0.0), fix=None)
    assert kinds(here.scan(entry('TT01'), seconds=2.0)) == ['RMC', 'TLL']


def test_own_ship_sails_over_the_date_line(rig):
    here = rig(sentences='RMC')
    here.send_own_ship(seconds=1.0, fix=(-17.0, 179.99999))
    rmc = pynmea2.parse(here.scan(entry('TT01'), seconds=4.0)[0], check=True)
    lon, lat, _ = EARTH.fwd(179.99999, -17.0, 90.0, 30 * KNOT)
    assert rmc.lon_dir == 'W' and lon < 0
    assert EARTH.inv(rmc.longitude, rmc.latitude, lon, lat)[2] < 0.3


def test_own_ship_is_told_between_scans_as_often_as_asked(rig):
    here = rig(own_ship_period_s=0.3)
    began = time.monotonic()
    for k in range(20):
        here.send_own_ship(seconds=0.1 * k)
        time.sleep(0.05)
    passed = time.monotonic() - began
    here.wait(lambda: len(here.nmea) == here.node._count['sentences'])
    told = kinds(one.data for one in here.nmea.messages).count('RMC')
    assert 2 <= told <= passed / 0.3 + 1


def test_without_own_ship_rmc_is_void_and_diagnostics_say_why(rig):
    here = rig()
    said = here.scan(entry('TT01'))
    assert kinds(said) == ['RMC', 'OSD', 'TTM']  # no heading: no HDT
    assert ',V,,,,,,,' in said[0] and said[1].startswith('$RAOSD,,V,')
    here.wait(
        lambda: (
            here.output()
            and here.output().message == 'nothing on own_ship/odometry: RMC void, no HDT'
        )
    )
    assert here.output().level == DiagnosticStatus.WARN
    assert here.output().name == 'nmea_output: output'
    # With odometry, but no place on earth.
    here.send_own_ship(fix=None)
    assert ',V,,,,,10.00,090.0,' in here.scan(entry('TT01'))[0]
    here.wait(lambda: 'nothing on own_ship/fix' in here.output().message)
    here.send_own_ship()
    here.wait(lambda: here.output().level == DiagnosticStatus.OK)
    assert here.output().message == '1 targets'


def test_broken_input_is_counted_and_the_last_good_one_kept(rig):
    here = rig(own_ship_period_s=60.0)
    here.send_own_ship()
    broken = convert.own_ship_to_odometry(NOON, (np.nan, 0.0), (1.0, 1.0))
    here.odometry.publish(broken)
    no_fix = convert.fix_message(NOON, 0.0, 0.0)
    no_fix.status.status = -1
    here.fix.publish(no_fix)
    here.fix.publish(convert.fix_message(NOON, np.nan, 10.0))
    here.fix.publish(convert.fix_message(NOON, 54.0, 190.0))
    counts = here.node._bad.counts
    here.wait(
        lambda: (
            (counts['own-ship messages not finite'], counts['fixes without a position']) == (1, 3)
        )
    )
    assert pynmea2.parse(here.scan(entry('TT01'))[0]).latitude == pytest.approx(54.5, abs=1e-6)


def test_signalk_deltas_go_out_as_datagrams(rig, ears):
    ear = ears()
    here = rig(signalk_udp=f'{LOOPBACK}:{ear.port}')
    here.send_own_ship(seconds=1.0)
    here.scan(entry('TT01'), entry('TT02'), seconds=1.0)
    first, second = map(json.loads, ear.hear(2))
    assert first['context'] != second['context']
    values = {one['path']: one['value'] for one in first['updates'][0]['values']}
    assert values['navigation.closestApproach'] == {
        'distance': pytest.approx(185.2),
        'timeTo': 720.0,
    }
    assert values['navigation.position']['latitude'] == pytest.approx(54.5 + 1.4142 / 60, abs=1e-4)
    here.scan(entry('TT02'), seconds=2.0)
    gone = [delta for delta in map(json.loads, ear.hear(2)) if delta['context'] == first['context']]
    assert all(one['value'] is None for one in gone[0]['updates'][0]['values'] if one['path'])


def test_targets_go_out_as_nmea_2000(rig, ears):
    pytest.importorskip('nmea2000')
    from nmea2000.decoder import NMEA2000Decoder

    ear, decoder = ears(), NMEA2000Decoder()
    here = rig(nmea2000_udp=f'{LOOPBACK}:{ear.port}')
    here.send_own_ship(seconds=1.0)
    here.scan(entry('TT05', range=2.25, bearing=140.5), seconds=1.0)
    frames = ear.hear(5)
    (told,) = filter(None, (decoder.decode(frame.strip()) for frame in frames))
    values = {field.id: field.value for field in told.fields}
    assert values['name'] == 'TT05' and values['targetId'] == 5
    assert values['distance'] == pytest.approx(2.25 * 1852, abs=0.01)
    assert values['bearing'] == pytest.approx(np.radians(140.5), abs=1e-4)


def test_nmea_2000_without_its_package_stops_the_start_by_name(graph, monkeypatch):
    monkeypatch.setitem(sys.modules, 'nmea2000', None)
    monkeypatch.delitem(sys.modules, 'nmea2000.message', raising=False)
    with pytest.raises(ValueError, match='parameter nmea2000_udp asks for the package nmea2000'):
        graph.make(NmeaOutputNode, nmea2000_udp=f'{LOOPBACK}:2000')


def test_alarms_go_to_signalk_as_notifications_of_own_ship(rig, ears):
    ear = ears()
    here = rig(signalk_udp=f'{LOOPBACK}:{ear.port}')
    alarms = here.other.create_publisher(DiagnosticArray, topics.ALARMS, topics.latched())
    here.wait(alarms.get_subscription_count)
    values = {'priority': 'alarm', 'state': 'active acknowledged'}
    alarms.publish(
        DiagnosticArray(
            status=[
                DiagnosticStatus(
                    name='TT12: danger',
                    message='TT12 dangerous: CPA 0.21 NM',
                    values=[KeyValue(key=key, value=value) for key, value in values.items()],
                )
            ]
        )
    )
    (delta,) = map(json.loads, ear.hear(1))
    (entry,) = delta['updates'][0]['values']
    assert entry['path'] == 'notifications.radar.nmea_output.TT12_danger'
    assert entry['value']['message'] == 'TT12 dangerous: CPA 0.21 NM'
    assert entry['value']['method'] == ['visual']


def p(**parameters):
    """Command-line parameters."""
    assignments = [('-p', f'{name}:={value}') for name, value in parameters.items()]
    return ['--ros-args', *(word for pair in assignments for word in pair)]


@pytest.mark.parametrize(
    ('parameters', 'said'),
    [
        ({'sentences': 'TTM GGA'}, "parameter sentences has 'GGA'; it must be of RMC, HDT, OSD"),
        ({'udp': 'nowhere'}, "parameter udp has 'nowhere'; it must be host:port"),
        ({'talker': 'radar'}, "talker is 'radar'; it must be two capital letters"),
        ({'origin': '"91 10"'}, "parameter origin is '91 10'; it must be latitude and longitude"),
    ],
)
def test_a_wrong_parameter_stops_the_start_in_one_line(launch, parameters, said):
    process = launch(OUTPUT, *p(**parameters))
    assert process.ends() == 1
    assert process.said.startswith(f'nmea_output: {said}'), process.said
    assert len(process.said.splitlines()) == 1


def test_a_port_in_use_stops_the_start_in_one_line(launch, free_port):
    with socket.create_server((LOOPBACK, free_port)):
        process = launch(OUTPUT, *p(tcp=f'{LOOPBACK}:{free_port}'))
        assert process.ends() == 1
    assert 'cannot listen there: Address already in use' in process.said


def test_simulator_tracker_and_output_as_processes_tell_every_target_once_a_scan(launch, ears):
    ear = ears(patience=60.0)
    output = launch(
        OUTPUT, *p(udp=f'{LOOPBACK}:{ear.port}', use_sim_time='true', own_ship_period_s=60.0)
    )
    tracker = launch(
        'nodes.run tracker',
        *p(use_sim_time='true', range_sigma_m=15.0, bearing_sigma_deg=0.4, max_range_m=22224.0),
    )
    simulator = launch('nodes.run radar_simulator', *p(scenario='encounters', rate=20.0))
    told = {}  # scans in which each target was told
    while len(told) < 3 or sorted(map(len, told.values()))[-3] < 20:
        (line,) = ear.hear(1)
        parsed = pynmea2.parse(line.strip(), check=True)
        if parsed.sentence_type == 'TTM':
            assert parsed.status in ('Q', 'T', 'L') and parsed.brg_ref == 'T'
            scans = told.setdefault(parsed.target_number, [])
            assert parsed.timestamp not in scans
            scans.append(parsed.timestamp)
    simulator.stop()
    tracker.stop()
    output.stop(signal.SIGTERM)


def place_of(line):
    """Degrees of latitude and longitude, status and mode of an RMC."""
    rmc = pynmea2.parse(line, check=True)
    return rmc.latitude, rmc.longitude, line.split(',')[2], line.split('*')[0].split(',')[-1]


def warned(here, text):
    """Wait until /diagnostics says so."""
    here.wait(lambda: here.output() and text in here.output().message)
    return here.output().level == DiagnosticStatus.WARN


@pytest.mark.parametrize('apart_s', [-37, 21, -7200, None])
def test_a_fix_whose_stamp_is_of_another_clock_is_paired_as_it_arrived(rig, apart_s):
    """None: no stamp at all."""
    here = rig(own_ship_period_s=60.0)
    speed = 6.0  # m/s, east; at 60 N a degree of longitude is half as long
    for k in range(6):
        here.send_own_ship(k, (speed * k, 0.0), speed, fix=None)
        fix = convert.fix_message(NOON, 60.0, 10.25 + np.degrees(speed * k / 6371008.8 / 0.5))
        stamp = 0 if apart_s is None else NOON + (k + apart_s) * SECOND
        fix.header.stamp = convert.time_message(stamp)
        here.fix.publish(fix)
        here.wait(lambda k=k: here.node._bad.counts[FIX_BY_ARRIVAL] == k + 1)
    latitude, longitude, status, _ = place_of(here.scan(seconds=7.0)[0])
    away = np.radians(longitude - 10.25) * 6371008.8 * 0.5
    assert status == 'A' and away == pytest.approx(speed * 7, abs=1.0)
    assert latitude == pytest.approx(60.0, abs=1e-6)
    assert warned(here, 'paired as they arrived')


def test_a_moored_ship_stays_where_she_is_whatever_the_stamps_are(rig):
    here = rig(own_ship_period_s=60.0)
    for k in range(4):
        here.send_own_ship(k, speed=0.002)
    for stamp in (1_000_000, 86_400 * 400):  # s: a clock that was never set
        here.fix.publish(convert.fix_message(stamp * SECOND, 54.5, 10.25))
    here.wait(lambda: here.node._bad.counts[FIX_BY_ARRIVAL] == 2)
    assert place_of(here.scan(seconds=4.0)[0])[:3] == (
        pytest.approx(54.5, abs=1e-6),
        pytest.approx(10.25, abs=1e-6),
        'A',
    )
    # Targets of another clock: own ship is told where she was last.
    assert place_of(here.scan(seconds=5000.0)[0])[0] == pytest.approx(54.5, abs=1e-6)
    assert here.node._bad.counts[TIME_BY_ARRIVAL]


def test_a_lost_fix_is_told_as_an_estimate_then_as_none_and_warned_of(rig):
    here = rig(fix_timeout_s=0.7, own_ship_period_s=60.0)
    here.send_own_ship()
    assert place_of(here.scan(seconds=0.1)[0])[2:] == ('A', 'A')
    here.wait(lambda: here.node._own.fix_age > 0.7)
    latitude, *told = place_of(here.scan(seconds=0.2)[0])
    assert told[1:] == ['V', 'E'] and latitude == pytest.approx(54.5, abs=1e-6)
    assert warned(here, 'position estimated (mode E)')
    here.wait(lambda: here.node._own.fix_age > 6 * 0.7)
    said = here.scan(entry('TT01'), seconds=0.3)
    assert ',V,,,,,10.00,' in said[0] and said[0].split('*')[0].endswith(',N')
    assert warned(here, 'no TLL')
    here.send_own_ship(0.4)
    fixed = here.node._own.fix_age
    here.wait(lambda: here.node._own.fix_age < min(fixed, 0.5))
    assert place_of(here.scan(seconds=0.5)[0])[2:] == ('A', 'A')
