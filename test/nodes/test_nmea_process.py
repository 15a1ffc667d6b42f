"""The NMEA output as a process: many clients, targets without end, hosts of one family."""

import contextlib
import re
import socket
import struct
import threading
import time

import numpy as np
import psutil
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import PointCloud2

from marine_tracker.nodes import convert, targets_cloud, topics
from marine_tracker.nodes.nmea_output_links import CLIENTS
from marine_tracker.nodes.nmea_output_node import NO_ROOM, NOT_SENT, REFUSED
from marine_tracker.tracking.lifecycle import CONFIRMED

LOOPBACK = '127.0.0.1'
GROWTH_MB = 100.0


def targets(numbers):
    """Rows of `targets_cloud`."""
    rows = np.zeros(len(numbers), targets_cloud.TARGET_TYPE)
    rows['number'], rows['status'] = numbers, CONFIRMED
    for name, value in (('range', 6019.0), ('bearing', 2.05), ('course', 5.25), ('speed', 7.46)):
        rows[name] = value
    rows['cpa'], rows['tcpa'] = 1611.2, 570.0
    return rows


class Output:
    """The node, and who publishes `targets` and listens to /diagnostics."""

    def __init__(self, launch, graph, node_helpers, prefix=(), **parameters):
        self.wait, listener = node_helpers
        given = {'udp': '""', **parameters}
        words = [word for key, value in given.items() for word in ('-p', f'{key}:={value}')]
        self.process = launch('nodes.run nmea_output', '--ros-args', *words, prefix=prefix)
        assert self.process.says('TTM'), self.process.said
        self.other = graph.bystander()
        self._targets = self.other.create_publisher(
            PointCloud2, topics.TARGETS_CLOUD, topics.latched()
        )
        self._diagnostics = listener(self.other, DiagnosticArray, topics.DIAGNOSTICS)
        self.wait(lambda: self._targets.get_subscription_count() and len(self._diagnostics))
        self.scans = 0

    def scan(self, numbers):
        self.scans += 1
        stamp = 1_700_000_000_000_000_000 + self.scans
        self._targets.publish(convert.cloud_message(targets(numbers), stamp))

    def values(self):
        """The last word on /diagnostics."""
        return {pair.key: pair.value for pair in self._diagnostics[-1].status[0].values}

    def peak_mb(self):
        """The most memory the process ever had, by the kernel."""
        with open(f'/proc/{self.process.process.pid}/status') as lines:
            return int(re.search(r'VmHWM:\s+(\d+) kB', lines.read())[1]) / 1024


@pytest.fixture
def output(launch, graph, node_helpers):
    return lambda **given: Output(launch, graph, node_helpers, **given)


@pytest.fixture
def free_port():
    with socket.socket() as one:
        one.bind((LOOPBACK, 0))
        return one.getsockname()[1]


def test_who_listens_on_ipv4_is_reached_where_localhost_is_ipv6_alone(output, private_hosts):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ear:
        ear.bind((LOOPBACK, 0))
        ear.settimeout(20)
        here = output(
            prefix=private_hosts('::1 localhost'),
            udp=f'localhost:{ear.getsockname()[1]}',
            sentences='TTM',
        )
        here.scan(range(41, 45))
        heard = [ear.recv(200)[:9] for _ in range(4)]
    assert heard == [b'$RATTM,%d' % number for number in range(41, 45)]
    here.wait(lambda: here.values()['datagrams'] == '4')
    assert here.values()[REFUSED] == here.values()[NOT_SENT] == '0'
    here.scan(range(41, 45))  # nobody listens any more
    here.wait(lambda: here.values()[REFUSED] == '4')
    assert here.values()['datagrams'] == '4'
    here.process.stop()


def test_targets_without_end_cost_no_memory(output):
    here = output(signalk_udp=f'{LOOPBACK}:9')
    here.scan(range(1, 2_301))
    here.wait(lambda: here.values()['targets'] == '99')
    before = here.peak_mb()
    here.scan(range(1, 50_000))
    here.scan((1, 2))
    here.wait(lambda: here.values()['targets'] == '2')
    print(f'memory {before:.0f} MB, at most {here.peak_mb():.0f} MB')
    assert here.peak_mb() - before < GROWTH_MB
    here.process.stop()


class Client:
    """Reads all that comes, in a thread of its own, until the other side or `leave` ends it."""

    def __init__(self, port):
        self.socket = socket.create_connection((LOOPBACK, port), 20)
        self.heard = b''
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self):
        with contextlib.suppress(OSError):
            while data := self.socket.recv(1 << 16):
                self.heard += data

    @property
    def here(self):
        return self._thread.is_alive()

    def leave(self):
        with contextlib.suppress(OSError):
            self.socket.shutdown(socket.SHUT_RDWR)
        self._thread.join(20)
        self.socket.close()


def comes_and_goes(port, k):
    """A client that leaves at once, every third with a reset."""
    with contextlib.suppress(OSError):
        one = socket.create_connection((LOOPBACK, port), 20)
        if k % 3 == 0:
            one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        one.close()


def deaf(port):
    """A client that never reads, and has little room for what waits."""
    one = socket.socket()
    one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    one.connect((LOOPBACK, port))
    return one


@pytest.mark.parametrize(
    ('clients', 'deaf_ones', 'reconnects'),
    [
        pytest.param(58, 9, 60, id='58'),
        pytest.param(220, 44, 2_200, id='220', marks=[pytest.mark.slow, pytest.mark.timeout(600)]),
    ],
)
def test_a_crowd_of_clients_is_served_or_refused_and_counted(
    output, free_port, clients, deaf_ones, reconnects
):
    here = output(tcp=f'{LOOPBACK}:{free_port}', sentences='TTM')
    node = psutil.Process(here.process.process.pid)
    before, files = here.peak_mb(), node.num_fds()
    silent = [deaf(free_port) for _ in range(deaf_ones)]
    here.wait(lambda: here.values()['TCP clients'] == str(deaf_ones))
    readers = [Client(free_port) for _ in range(clients - deaf_ones)]
    room = CLIENTS - deaf_ones
    here.wait(lambda: sum(reader.here for reader in readers) == room)
    served = [reader for reader in readers if reader.here]
    here.wait(lambda: here.values()[NO_ROOM] == str(clients - CLIENTS))

    entries = range(1, 100)
    for k in range(reconnects):
        comes_and_goes(free_port, k)
        if k % 5 == 0:
            here.scan(entries)

    # Those that never read are dropped once too much waits for them; nobody else is.
    def dropped():
        here.scan(entries)
        time.sleep(0.02)
        return here.values()['TCP clients dropped as too slow'] == str(deaf_ones)

    here.wait(dropped)
    last = f'$RATTM,{99:02d},'.encode()
    here.wait(
        lambda: all(
            reader.heard.count(last) == served[0].heard.count(last) > 0 for reader in served
        )
    )
    assert all(reader.here for reader in served)
    for reader in served:
        assert reader.heard.startswith(b'$RATTM,01,') and reader.heard.endswith(b'\r\n')
        assert reader.heard == served[0].heard
    latecomers = [Client(free_port) for _ in range(deaf_ones)]  # their places are free again
    here.wait(lambda: here.values()['TCP clients'] == str(CLIENTS))
    assert all(reader.here for reader in latecomers)
    print(f'memory {before:.0f} MB, at most {here.peak_mb():.0f} MB; {here.values()}')
    assert here.peak_mb() - before < GROWTH_MB
    for one in readers + latecomers:
        one.leave()
    for one in silent:
        one.close()

    def all_left():
        here.scan(entries)
        time.sleep(0.02)
        return here.values()['TCP clients'] == '0'

    here.wait(all_left)
    assert node.num_fds() <= files
    here.process.stop()
