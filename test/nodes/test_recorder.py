"""The recorder over DDS: what is published is in the file, whatever happens to disk and process."""

import itertools
import json
import os
import random
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import psutil
import pytest

pytest.importorskip('rclpy')
pytest.importorskip('mcap_ros2', reason='the extra `record` is not installed')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import String, UInt32

from marine_tracker import cli
from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.convert import TRACK_TYPE
from marine_tracker.recording import track_file
from marine_tracker.recording.mcap_read import McapFiles
from marine_tracker.recording.mcap_topics import contents

RECORDER = 'nodes.run recorder'


def p(**parameters):
    pairs = [('-p', f'{name}:={value}') for name, value in parameters.items()]
    return ['--ros-args', *(word for pair in pairs for word in pair)]


class Sender:
    """Publishes on a few topics and remembers what."""

    def __init__(self, graph, wait):
        self.node, self.wait = graph.bystander('sender'), wait
        kinds = {'nmea': String, 'cancel': UInt32, 'targets': DiagnosticArray}
        qualities = {'targets': topics.latched()}
        self.publishers = {
            topic: self.node.create_publisher(
                kind, topic, qualities.get(topic, topics.reliable(50))
            )
            for topic, kind in kinds.items()
        }
        self.sent = []

    def heard(self):
        self.wait(lambda: all(one.get_subscription_count() for one in self.publishers.values()))
        time.sleep(0.7)  # the other side has to know us, too

    def send(self, k):
        for topic, message in (
            ('nmea', String(data=f'$RATTM,{k:02d}' + 'x' * 40)),
            ('cancel', UInt32(data=k)),
        ):
            self.publishers[topic].publish(message)
            self.sent.append((f'/{topic}', serialize_message(message).rstrip(b'\0')))


def in_file(path, *names):
    """Without the zeros with which some middlewares fill a message up to four bytes."""
    return [(one.topic, one.data.rstrip(b'\0')) for one in McapFiles(path).messages(names or None)]


@pytest.fixture
def sender(graph, node_helpers):
    return Sender(graph, node_helpers[0])


def test_every_message_is_in_the_file_as_it_was_published(launch, sender, tmp_path):
    recorder = launch(RECORDER, *p(folder=tmp_path / 'r', split_mb=1))
    assert recorder.says('records into')
    sender.heard()
    sender.publishers['targets'].publish(DiagnosticArray())
    for k in range(300):
        sender.send(k)
        time.sleep(0.002)
    recorder.stop()
    for topic in ('/nmea', '/cancel'):
        expected = [one for one in sender.sent if one[0] == topic]
        assert in_file(tmp_path / 'r', topic) == expected
    times = [one.log_ns for one in McapFiles(tmp_path / 'r').messages()]
    assert times == sorted(times) and abs(times[0] * 1e-9 - time.time()) < 60


def killed(launch, sender, folder, seconds, every=0.02):
    """Messages of a recorder that was killed, beside those sent more than a second before."""
    recorder = launch(RECORDER, *p(folder=folder))
    assert recorder.says('records into')
    sender.heard()
    sender.sent.clear()
    sent_at = []
    until, k = time.monotonic() + seconds, 0
    while time.monotonic() < until:
        sender.send(k)
        sent_at.append(time.monotonic())
        k += 1
        time.sleep(every)
    recorder.send(signal.SIGKILL)
    at = time.monotonic()
    recorder.ends()
    safe = sum(one < at - 1.0 for one in sent_at)
    found = in_file(folder / f'{folder.name}_0.mcap', '/cancel')
    assert safe and len(found) >= safe
    assert found == [one for one in sender.sent if one[0] == '/cancel'][: len(found)]


def test_a_killed_recorder_leaves_all_but_the_last_second(launch, sender, tmp_path):
    killed(launch, sender, tmp_path / 'k', 3.2, every=0.9)  # a topic that is nearly silent
    files = McapFiles(tmp_path / 'k')
    assert len(files.remarks) == 1 and 'lost' in files.remarks[0]


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_twenty_recorders_killed_at_any_moment(launch, sender, tmp_path):
    rng = random.Random(20)
    for k in range(20):
        seconds, every = rng.uniform(2.5, 10.0), rng.choice([0.02, 0.3, 1.0])
        killed(launch, sender, tmp_path / f'k{k}', seconds, every)
        sender.wait(lambda: not sender.publishers['cancel'].get_subscription_count())


def test_nothing_is_written_before_the_simulated_clock_runs_and_that_is_said_once(
    launch, sender, tmp_path
):
    from rosgraph_msgs.msg import Clock

    recorder = launch(RECORDER, *p(folder=tmp_path / 'r', use_sim_time='true'))
    assert recorder.says('records into')
    sender.heard()
    for k in range(5):
        sender.send(k)
    assert recorder.says('nothing is recorded before it runs')
    time.sleep(1.0)  # all that was sent has come
    clock = sender.node.create_publisher(Clock, '/clock', 10)
    sender.wait(clock.get_subscription_count)
    for _ in range(100):
        message = Clock()
        message.clock.sec = 77
        clock.publish(message)
        time.sleep(0.01)
    time.sleep(0.5)
    sender.send(6)
    time.sleep(0.5)
    recorder.stop()
    files = McapFiles(tmp_path / 'r')
    assert [files.decode(one).data for one in files.messages(['/cancel'])] == [6]
    assert {one.log_ns for one in files.messages(['/cancel'])} == {77_000_000_000}
    assert recorder.said.count('nothing is recorded') == 1


def health(messages):
    """The last word of the recorder on /diagnostics."""
    found = [
        entry
        for message in messages
        for entry in message.status
        if entry.name == 'recorder: recording'
    ]
    return found[-1] if found else None


def test_a_disk_that_is_nearly_full_ends_the_recording_whole_with_one_error_and_no_more(
    launch, sender, node_helpers, tmp_path
):
    wait, listener = node_helpers
    told = listener(sender.node, DiagnosticArray, topics.DIAGNOSTICS, topics.reliable(100))
    recorder = launch(RECORDER, *p(folder=tmp_path / 'r', keep_free_mb=90_000_000))
    assert recorder.says('the recording has ended'), recorder.said
    sender.heard()
    for k in range(20):
        sender.send(k)
    wait(lambda: (one := health(told.messages)) and one.level == DiagnosticStatus.ERROR)
    assert 'MB must stay so' in health(told.messages).message
    recorder.stop()  # it goes on, and ends well
    assert recorder.said.count('the recording has ended') == 1
    assert not McapFiles(tmp_path / 'r').remarks


def test_a_full_disk_is_one_alarm_and_a_whole_file(launch, sender, node_helpers, tmp_path):
    if subprocess.run(['unshare', '-m', 'true'], capture_output=True).returncode:
        pytest.skip('no mount namespace of our own: unshare -m fails here')
    wait, listener = node_helpers
    told = listener(sender.node, DiagnosticArray, topics.DIAGNOSTICS, topics.reliable(100))
    (tmp_path / 'disk').mkdir()
    script = (
        f'mount -t tmpfs -o size=9m none {tmp_path}/disk && "$@"; code=$?; '
        f'cp -r {tmp_path}/disk/r {tmp_path}/copy; exit $code'
    )
    recorder = launch(
        RECORDER,
        *p(folder=tmp_path / 'disk' / 'r', keep_free_mb=0),
        prefix=('unshare', '-m', '--kill-child', 'sh', '-c', script, 'sh'),
    )
    assert recorder.says('records into'), recorder.said
    sender.heard()
    rng = random.Random(5)
    ended = ''
    for k in range(4000):
        noise = ''.join(map(chr, rng.choices(range(33, 1000), k=4000)))
        sender.publishers['nmea'].publish(String(data=noise))
        sender.send(k)
        ended = ended or ('the recording has ended' in recorder.said)
        if ended:
            break
        time.sleep(0.004)
    assert ended
    wait(lambda: (one := health(told.messages)) and one.level == DiagnosticStatus.ERROR)
    child = psutil.Process(recorder.process.pid).children(recursive=True)[-1]
    child.send_signal(signal.SIGINT)
    assert recorder.ends() == 0, recorder.said
    assert recorder.said.count('No space left on device') == 1
    files = McapFiles(tmp_path / 'copy')
    assert not files.remarks
    found = [files.decode(one).data for one in files.messages(['/cancel'])]
    assert len(found) > 50 and found == list(range(len(found)))


@pytest.mark.parametrize(
    'starts', [3, pytest.param(20, marks=[pytest.mark.slow, pytest.mark.timeout(900)])]
)
def test_whoever_starts_first_the_same_topics_are_recorded(
    launch, graph, node_helpers, tmp_path, starts
):
    """A latched topic of ours, one of others that is latched, and one that is best effort."""
    from std_msgs.msg import Int16

    wait, _ = node_helpers
    rng = random.Random(starts)
    for k in range(starts):
        folder, recorder = tmp_path / f'r{k}', None
        node = graph.bystander(f'writer_{k}')
        steps = ['recorder', 'alarms', f'plan_{k}', f'lidar_{k}']
        rng.shuffle(steps)
        publishers = []
        for step in steps:
            if step == 'recorder':
                names = f'"/plan_{k} lidar_{k}"'
                recorder = launch(RECORDER, *p(folder=folder, topics=names))
                assert recorder.says('records into'), recorder.said
            elif step == 'alarms':
                publisher = node.create_publisher(DiagnosticArray, 'alarms', topics.latched())
                publisher.publish(DiagnosticArray(status=[DiagnosticStatus(name='TT09')]))
                publishers.append(publisher)
            elif step.startswith('plan'):
                publisher = node.create_publisher(UInt32, step, topics.latched())
                publisher.publish(UInt32(data=k))
                publishers.append(publisher)
            else:
                publishers.append(node.create_publisher(Int16, step, topics.best_effort()))
                effort = publishers[-1]
        wait(lambda some=publishers: all(one.get_subscription_count() for one in some))
        for number in range(30):
            effort.publish(Int16(data=number))
            time.sleep(0.01)
        time.sleep(0.6)
        recorder.stop()
        files = McapFiles(folder)
        wanted = {'/alarms', f'/plan_{k}', f'/lidar_{k}'}
        assert wanted <= set(files.topics), (steps, set(files.topics))
        assert files.topics['/alarms'].messages == files.topics[f'/plan_{k}'].messages == 1
        for publisher in publishers:
            node.destroy_publisher(publisher)


def test_lost_messages_and_silence_are_told_by_topic(launch, sender, graph, node_helpers, tmp_path):
    from marine_tracker.nodes import recorded_topics
    from marine_tracker.nodes.recorder_node import RecorderNode

    wait, listener = node_helpers
    told = listener(sender.node, DiagnosticArray, topics.DIAGNOSTICS, topics.reliable(100))
    node = graph.make(RecorderNode, folder=str(tmp_path / 'r'), keep_free_mb=0)
    sender.heard()
    heard = node._heard['/nmea']
    wait(lambda: heard.publishers == 1)
    sender.send(1)
    wait(lambda: heard.sequence is not None)
    heard.sequence -= 7  # as if seven had not come
    sender.send(2)
    wait(lambda: heard.lost == 7)
    wait(lambda: (one := health(told.messages)) and '7 messages lost' in one.message)
    values = {pair.key: pair.value for pair in health(told.messages).values}
    assert '2 written' in values['/nmea'] and '7 lost' in values['/nmea']
    plots = sender.node.create_publisher(PointCloud2, topics.PLOTS, topics.reliable())
    steady = node._heard['/radar/plots']
    wait(lambda: steady.publishers == 1)
    steady.at -= recorded_topics.SILENT_S
    wait(lambda: '/radar/plots is published, and nothing came' in health(told.messages).message)
    assert health(told.messages).level == DiagnosticStatus.WARN
    free = threading.Event()
    node._writing.log.write = lambda messages: free.wait(60)  # a disk that hangs
    for k in range(3, 100):
        sender.send(k)
        time.sleep(0.1)
        if health(told.messages).level == DiagnosticStatus.ERROR:
            break
    assert 'nothing was written for' in health(told.messages).message
    free.set()
    del plots


def test_a_split_on_a_slow_disk_delays_nothing(graph, sender, node_helpers, tmp_path):
    from marine_tracker.nodes.recorder_node import RecorderNode

    wait, _ = node_helpers
    node = graph.make(RecorderNode, folder=str(tmp_path / 'r'), keep_free_mb=0)
    sender.heard()
    log = node._writing.log
    log._split = 20_000
    slow = log._next

    def with_pause(now_ns):
        time.sleep(0.8)
        slow(now_ns)

    log._next = with_pause
    before = time.monotonic()
    for k in range(400):
        sender.send(k)
        time.sleep(0.004)
    passed = time.monotonic() - before
    wait(lambda: node._heard['/cancel'].count == 400)
    node.close()
    files = McapFiles(tmp_path / 'r')
    assert [files.decode(one).data for one in files.messages(['/cancel'])] == list(range(400))
    times = np.array([one.log_ns for one in files.messages(['/cancel'])]) * 1e-9
    assert len(files.paths) > 1 and np.diff(times).max() < 0.5 + passed / 400


def replayed_as_live(folder, tmp_path):
    """The table of a replay, run twice with the same bytes and with the tracks of the live run; and
    how many of these were compared."""
    tables = [tmp_path / name for name in ('once.csv', 'twice.csv')]
    for table in tables:
        assert cli.main(['replay', str(folder), '--out', str(table)]) == 0
    assert tables[0].read_bytes() == tables[1].read_bytes()
    rows, inside, compared = track_file.read(tables[0]), contents(folder), 0
    order = np.lexsort((rows.track.astype(int), rows.scan))
    scan, track, position = (a[order] for a in (rows.scan, rows.track.astype(int), rows.position))
    starts = [str(event.message.header.stamp) for event in inside.events('radar/plots')]
    number = {stamp: k for k, stamp in enumerate(starts)}
    for event in inside.events('tracks_cloud'):
        k = number[str(event.message.header.stamp)]
        mine = slice(*np.searchsorted(scan, [k, k + 1]))
        cloud = np.frombuffer(event.message.data, TRACK_TYPE)
        cloud = cloud[np.argsort(cloud['id'])]
        assert track[mine].tolist() == cloud['id'].tolist()
        place = np.stack([cloud['x'], cloud['y']], -1)
        np.testing.assert_allclose(position[mine], place, atol=0.01)
        compared += len(cloud)
    return tables[0], compared


def test_a_replay_tells_the_tracks_of_the_live_run_twice_the_same(
    launch, graph, node_helpers, tmp_path, capsys
):
    wait, listener = node_helpers
    folder = tmp_path / 'live'
    seen = listener(graph.bystander('audience'), PointCloud2, topics.TRACKS_CLOUD)
    sim = {'use_sim_time': 'true'}
    tracker = launch('nodes.run tracker', *p(**sim, estimator='imm', cpa_limit_nm=0.7))
    recorder = launch(RECORDER, *p(**sim, folder=folder))
    assert tracker.says('waiting for') and recorder.says('records into')
    simulator = launch('nodes.run radar_simulator', *p(scenario='busy_strait', rate=20.0))
    wait(lambda: len(seen) >= 40)
    simulator.stop()
    time.sleep(0.5)
    recorder.stop()
    tracker.stop()

    inside = contents(folder)
    assert inside.parameters['estimator'] == 'imm' and inside.parameters['cpa_limit_nm'] == 0.7
    table, compared = replayed_as_live(folder, tmp_path)
    assert compared > 800
    assert cli.main(['score', str(folder), str(table)]) == 0
    assert 'truth_targets' in capsys.readouterr().out
    assert cli.main(['incident', str(folder), '--at', '90']) == 0
    assert 'own ship: course' in capsys.readouterr().out


def test_a_player_has_no_topic_on_which_it_could_tell_old_alarms_targets_or_commands(
    graph, tmp_path
):
    """And on /rosout and /diagnostics, where each node has its own word, nothing recorded."""
    from marine_tracker.nodes.message_definitions import definition
    from marine_tracker.nodes.recording_player_node import RecordingPlayerNode
    from marine_tracker.recording.mcap_write import McapLog, Message, Topic
    from marine_tracker.simulation import radar, scenario

    log, second = McapLog(tmp_path / 'old', 1 << 30, 0), 1_000_000_000
    scans = radar.simulate(scenario.load('clean'), 4)
    for scan, _ in itertools.islice(scans, 3):
        at = 50 * second + round(scan.end * 1e9)
        for name, kind, message in (
            ('/radar/plots', 'sensor_msgs/msg/PointCloud2', convert.plots_to_cloud(scan, at)),
            ('/rosout', 'rcl_interfaces/msg/Log', Log(msg='an old trouble')),
            ('/alarms', 'diagnostic_msgs/msg/DiagnosticArray', DiagnosticArray()),
            ('/cancel', 'std_msgs/msg/UInt32', UInt32(data=4)),
        ):
            topic = Topic(name, kind, definition(kind), '', False)
            log.write([Message(topic, at, at, serialize_message(message))])
        log.flush()
    log.close()
    player = graph.make(RecordingPlayerNode, folder=str(tmp_path / 'old'), rate=2.0)
    of_player = player.get_publisher_names_and_types_by_node(player.get_name(), '/')
    assert {name for name, _ in of_player} == {
        *('/radar/plots', '/radar/plots_readable', '/own_ship/odometry', '/truth', '/clock'),
        *('/diagnostics', '/rosout', '/parameter_events'),
    }


@pytest.mark.slow
def test_a_recording_that_is_played_tells_no_old_logs_alarms_or_health(
    launch, graph, node_helpers, tmp_path
):
    wait, listener = node_helpers
    node = graph.bystander('audience')
    recorder = launch(RECORDER, *p(folder=tmp_path / 'r'))
    assert recorder.says('records into')
    simulator = launch('nodes.run radar_simulator', *p(scenario='clean'))
    log = node.create_publisher(Log, '/rosout', topics.reliable())
    alarms = node.create_publisher(DiagnosticArray, 'alarms', topics.latched())
    wait(lambda: log.get_subscription_count() and alarms.get_subscription_count())
    played = listener(node, PointCloud2, topics.PLOTS, topics.reliable(50))
    log.publish(Log(msg='an old trouble'))
    alarms.publish(DiagnosticArray(status=[DiagnosticStatus(name='TT77: danger')]))
    wait(lambda: len(played) >= 2)
    simulator.stop()
    recorder.stop()
    node.destroy_publisher(alarms)
    node.destroy_publisher(log)
    assert {'/rosout', '/alarms', '/radar/plots'} <= set(McapFiles(tmp_path / 'r').topics)

    wait(lambda: not node.count_publishers('alarms'))
    plots = listener(node, PointCloud2, topics.PLOTS, topics.reliable(50))
    own = listener(node, Odometry, topics.ODOMETRY, topics.reliable(500))
    old = listener(node, DiagnosticArray, topics.ALARMS, topics.latched(50))
    logs = listener(node, Log, '/rosout', topics.reliable(500))
    player = launch('nodes.run recording_player', *p(folder=tmp_path / 'r', rate=3.0))
    assert player.ends() == 0, player.said
    inside = contents(tmp_path / 'r')
    wait(lambda: len(plots) == inside.files.topics['/radar/plots'].messages)
    assert len(own) > 10 and not len(old)
    assert not any('old trouble' in one.msg for one in logs.messages)
    first = next(inside.events('radar/plots')).message
    assert bytes(plots[0].data)[12:16] == first.data[12:16]  # the first range


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_an_hour_of_a_busy_strait_is_read_back_by_rosbags_and_mcap_ros2_support(launch, tmp_path):
    """At rate 10; `HOUR_S` shortens it."""
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    folder, hour = tmp_path / 'hour', float(os.environ.get('HOUR_S', 3600))
    sim = {'use_sim_time': 'true'}
    tracker = launch('nodes.run tracker', *p(**sim))
    recorder = launch(RECORDER, *p(**sim, folder=folder))
    assert tracker.says('waiting for') and recorder.says('records into')
    scenario = p(scenario='busy_strait', rate=10.0, loop='true')
    simulator = launch('nodes.run radar_simulator', *scenario)
    time.sleep(hour / 10)
    ticks = os.sysconf('SC_CLK_TCK')
    stat = Path(f'/proc/{recorder.process.pid}/stat').read_text()
    used = sum(map(int, stat.rpartition(')')[2].split()[11:13])) / ticks
    print(f'recorder: {used:.1f} s of CPU in {hour / 10:.0f} s')
    simulator.stop()
    recorder.stop()
    tracker.stop()
    files = McapFiles(folder)
    assert not files.remarks
    wanted = ['/own_ship/odometry', '/targets', '/radar/plots', '/alarms', '/tracks_cloud']
    mine = [(one.topic, one.log_ns, one.data) for one in files.messages(wanted)]
    theirs = []
    with AnyReader([folder], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as bag:
        connections = [one for one in bag.connections if one.topic in wanted]
        for connection, at, raw in bag.messages(connections=connections):
            theirs.append((connection.topic, at, raw))
            if len(theirs) % 50 == 0:
                bag.deserialize(raw, connection.msgtype)
    assert sorted(theirs) == sorted(mine)
    other = []
    for path in files.paths:
        with open(path, 'rb') as file:
            reader = make_reader(file, decoder_factories=[DecoderFactory()])
            for _, channel, message, decoded in reader.iter_decoded_messages(topics=wanted):
                other.append((channel.topic, message.log_time, message.data))
                assert decoded is not None
    assert sorted(other) == sorted(mine)
    print(json.dumps({name: files.topics[name].messages for name in files.topics}))
    _, compared = replayed_as_live(folder, tmp_path)
    assert compared > 10 * hour


def test_the_command_records_for_a_while_and_shows_what_there_is(domain, tmp_path):
    words = ['record', str(tmp_path / '2026'), '--duration', '5', '--set', 'keep_free_mb=1']
    done = subprocess.run(
        [sys.executable, '-m', 'marine_tracker', *words],
        capture_output=True,
        text=True,
        timeout=100,
        cwd=Path(__file__).parents[2],
    )
    assert done.returncode == 0, done.stderr
    assert '/diagnostics' in done.stdout and 'diagnostic_msgs/msg/DiagnosticArray' in done.stdout
    assert not McapFiles(tmp_path / '2026').remarks
