import contextlib
import socket

import numpy as np
import pytest

pytest.importorskip('rclpy')
from pyais import encode_dict
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import String

from marine_tracker.nodes import ais_cloud, topics
from marine_tracker.nodes.ais_input_node import AisInputNode

MMSI = 235077777


def lines(**fields):
    given = {'type': 1, 'mmsi': MMSI, 'lat': 51.0, 'lon': 2.0, 'speed': 7.5, **fields}
    return encode_dict(given, talker_id='AI', sentence_type='VDM')


def free_port(kind=socket.SOCK_DGRAM):
    with socket.socket(socket.AF_INET, kind) as one:
        one.bind(('127.0.0.1', 0))
        return one.getsockname()[1]


def accepted(rig, server):
    """The next connection; the node must be spun to make it."""
    found = []

    def there():
        with contextlib.suppress(BlockingIOError):
            found.append(server.accept()[0])
        return found

    rig.wait(there)
    return found[0]


class Rig:
    def __init__(self, graph, node_helpers, **parameters):
        self.wait, listener = node_helpers
        self.other = graph.bystander()
        self.reports = listener(self.other, PointCloud2, topics.AIS_REPORTS, topics.reliable(100))
        self.sentences = listener(self.other, String, topics.AIS_SENTENCES, topics.reliable(100))
        self.node = graph.make(AisInputNode, **{'udp': '', **parameters})
        self.wait(lambda: self.reports.connected and self.sentences.connected)

    def numbers(self):
        """MMSI of the reports so far."""
        return [int(one) for message in self.reports for one in ais_cloud.read(message, 0.0).mmsi]


def test_datagrams_become_reports_and_are_passed_on(graph, node_helpers):
    port = free_port()
    rig = Rig(graph, node_helpers, udp=f'127.0.0.1:{port}')
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        text = lines() + ['$GPGLL,,,,,,V*00', 'rubbish']
        out.sendto('\r\n'.join(text).encode(), ('127.0.0.1', port))
        rig.wait(lambda: len(rig.reports))
    report = ais_cloud.read(rig.reports[0], 0.0)
    assert report.mmsi.tolist() == [MMSI]
    assert report.latitude[0] == pytest.approx(51.0, abs=1e-5)
    assert np.isnan(report.size).all() and report.status[0] == -1
    rig.wait(lambda: len(rig.sentences))
    assert [message.data for message in rig.sentences] == lines()


def test_a_connection_is_made_and_made_again(graph, node_helpers, monkeypatch):
    monkeypatch.setattr('marine_tracker.nodes.ais_input_links.AGAIN', 0.2)
    with socket.create_server(('127.0.0.1', 0)) as server:
        port = server.getsockname()[1]
        rig = Rig(graph, node_helpers, tcp=f'127.0.0.1:{port}')
        server.setblocking(False)
        for mmsi in (MMSI, MMSI + 1):
            client = accepted(rig, server)
            first, second = lines(mmsi=mmsi, type=5, shipname='BRENT')
            client.sendall(f'{first}\r\n{second[:20]}'.encode())  # a line in two pieces
            client.sendall(f'{second[20:]}\r\n'.encode())
            rig.wait(lambda mmsi=mmsi: mmsi in rig.numbers())
            client.close()
    assert rig.numbers() == [MMSI, MMSI + 1]


def test_who_connects_may_send(graph, node_helpers):
    port = free_port(socket.SOCK_STREAM)
    rig = Rig(graph, node_helpers, tcp_server=f'127.0.0.1:{port}')
    with socket.create_connection(('127.0.0.1', port)) as client:
        client.sendall((lines()[0] + '\n').encode())
        rig.wait(lambda: rig.numbers() == [MMSI])


def test_a_file_is_played_in_its_time_and_a_topic_is_heard(graph, node_helpers, tmp_path):
    file = tmp_path / 'port.nmea'
    (first,), (second,) = lines(), lines(mmsi=MMSI + 5)
    file.write_text(f'17.25 {first}\n17.5 $GPHDT,1,T*00\n18.0 {second}\n')
    rig = Rig(graph, node_helpers, file=str(file), rate=20.0)
    rig.wait(lambda: rig.numbers() == [MMSI, MMSI + 5])
    simulator = rig.other.create_publisher(String, topics.AIS_SIMULATED, 10)
    rig.wait(simulator.get_subscription_count)
    simulator.publish(String(data=lines(mmsi=MMSI + 9)[0]))
    rig.wait(lambda: MMSI + 9 in rig.numbers())


def test_what_is_wrong_is_told_at_the_start(graph, tmp_path):
    with pytest.raises(ValueError, match='parameter udp'):
        graph.make(AisInputNode, udp='nowhere')
    with pytest.raises(ValueError, match='parameter file'):
        graph.make(AisInputNode, udp='', file=str(tmp_path / 'none.nmea'))
    with pytest.raises(ValueError, match='parameter serial'):
        graph.make(AisInputNode, udp='', serial=str(tmp_path / 'ttyNONE'))
