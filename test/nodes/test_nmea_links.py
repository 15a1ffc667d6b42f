"""Datagrams and TCP clients over real sockets."""

import contextlib
import os
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytest.importorskip('rclpy')
from marine_tracker.nodes.nmea_output_links import CLIENTS, PENDING, Clients, Datagrams, endpoints

CHECKOUT = Path(__file__).resolve().parents[2]
LOOPBACK, LOOPBACK_6 = '127.0.0.1', '::1'


def ear(host, port=0):
    """A socket that hears datagrams at an address, and only there."""
    one = socket.socket(socket.AF_INET6 if ':' in host else socket.AF_INET, socket.SOCK_DGRAM)
    if one.family == socket.AF_INET6:
        one.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
    one.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
    one.bind((host, port))
    one.settimeout(10)
    return one


def heard(one):
    """All that waits there, and nothing more."""
    one.setblocking(False)
    lines = []
    with contextlib.suppress(BlockingIOError):
        while True:
            lines.append(one.recv(1 << 16))
    return lines


@pytest.fixture
def free_port():
    with socket.socket() as one:
        one.bind((LOOPBACK, 0))
        return one.getsockname()[1]


def test_a_broadcast_reaches_who_listens_to_it():
    one = ear('127.255.255.255')
    link = Datagrams('udp', f'127.255.255.255:{one.getsockname()[1]}')
    assert link.send([b'one', b'two']) == 0
    assert heard(one) == [b'one', b'two'] and (link.sent, link.refused) == (2, 0)
    link.close()


def test_a_datagram_that_cannot_be_sent_is_counted_with_its_reason():
    one = ear(LOOPBACK)
    where = f'{LOOPBACK}:{one.getsockname()[1]}'
    link = Datagrams('udp', where)
    assert link.send([b'x' * 70_000, b'short']) == 1
    assert link.error == f'{where}: Message too long' and link.sent == 1
    assert heard(one) == [b'short']
    link.close()


def test_datagrams_that_nobody_listens_to_do_not_count_as_sent(free_port):
    link = Datagrams('udp', f'{LOOPBACK}:{free_port}')
    assert link.send([b'a', b'b', b'c']) == 0 and (link.sent, link.refused) == (0, 3)
    one = ear(LOOPBACK, free_port)  # who comes late is heard from then on
    link.send([b'd', b'e'])
    assert heard(one) == [b'd', b'e'] and (link.sent, link.refused) == (2, 3)
    link.close()


@pytest.fixture
def said_with_hosts(private_hosts):
    """said_with_hosts(text, script): what a Python script prints where this is /etc/hosts."""

    def run(hosts, script):
        return subprocess.run(
            [*private_hosts(hosts), sys.executable, '-c', script],
            cwd=CHECKOUT,
            env={**os.environ, 'PYTHONPATH': str(CHECKOUT)},
            stdout=subprocess.PIPE,
            text=True,
            timeout=60,
        ).stdout

    return run


@pytest.mark.parametrize(
    'hosts',
    [
        '::1 chartplotter',
        '127.0.0.1 chartplotter',
        '::1 chartplotter\n127.0.0.1 chartplotter',
        '127.0.0.1 chartplotter\n::1 chartplotter',
    ],
    ids=['6', '4', '6 and 4', '4 and 6'],
)
def test_a_name_reaches_who_listens_in_either_family(said_with_hosts, hosts):
    listeners = {host: ear(host) for host in (LOOPBACK, LOOPBACK_6)}
    for host, one in listeners.items():
        if LOOPBACK_6 not in hosts and host == LOOPBACK_6:
            continue
        script = (
            'from marine_tracker.nodes.nmea_output_links import Datagrams\n'
            f"link = Datagrams('udp', 'chartplotter:{one.getsockname()[1]}')\n"
            "print(link.send([b'x', b'y', b'z']), link.sent, link.refused)\n"
        )
        assert said_with_hosts(hosts, script) == '0 3 0\n'
        assert heard(one) == [b'x', b'y', b'z']


def test_a_name_that_nobody_listens_at_is_not_counted_as_sent(said_with_hosts, free_port):
    script = (
        'from marine_tracker.nodes.nmea_output_links import Datagrams\n'
        f"link = Datagrams('udp', 'localhost:{free_port}')\n"
        "print(link.send([b'x'] * 7), link.sent, link.refused)\n"
    )
    assert said_with_hosts('::1 localhost', script) == '0 0 7\n'


@pytest.mark.parametrize('hosts', ['::1 bridge', '127.0.0.1 bridge\n::1 bridge'])
def test_a_server_at_a_name_lets_clients_of_either_family_in(said_with_hosts, hosts, free_port):
    script = (
        'import socket\n'
        'from marine_tracker.nodes.nmea_output_links import Clients\n'
        f"server = Clients('tcp', 'bridge:{free_port}')\n"
        "for host in ('127.0.0.1', '::1'):\n"
        f'    client = socket.create_connection((host, {free_port}), 10)\n'
        "    server.send([host.encode() + b';'])\n"
        "    print(client.recv(99), end='')\n"
    )
    assert said_with_hosts(hosts, script) == "b'127.0.0.1;'b'::1;'"


@pytest.mark.parametrize(
    ('at', 'reached_from'),
    [
        ('[::]', (LOOPBACK, LOOPBACK_6)),
        ('0.0.0.0', (LOOPBACK,)),
        ('[::1]', (LOOPBACK_6,)),
        (LOOPBACK, (LOOPBACK,)),
    ],
)
def test_a_server_listens_on_the_networks_that_its_address_names(at, reached_from, free_port):
    server = Clients('tcp', f'{at}:{free_port}')
    for host in (LOOPBACK, LOOPBACK_6):
        if host in reached_from:
            with socket.create_connection((host, free_port), 10) as client:
                server.send([b'ahoy'])
                assert client.recv(9) == b'ahoy'
        else:
            with pytest.raises(ConnectionRefusedError):
                socket.create_connection((host, free_port), 10)
    server.close()


def connect(server, port, patience=10.0):
    client = socket.create_connection((LOOPBACK, port), patience)
    count, until = len(server), time.monotonic() + patience
    while len(server) == count and time.monotonic() < until:
        server.serve()
    return client


def test_a_slow_tcp_client_is_dropped_and_never_blocks_the_others(free_port):
    server = Clients('tcp', f'{LOOPBACK}:{free_port}')
    slow, quick = connect(server, free_port), connect(server, free_port)
    line, count, heard = b'x' * 1022 + b'\r\n', 0, 0
    quick.setblocking(False)
    while not server.dropped:
        server.send([line] * 16)
        count += 16
        with contextlib.suppress(BlockingIOError):
            while True:
                heard += len(quick.recv(1 << 20))
        assert count < 100_000
    assert len(server) == 1 and count * 1024 > PENDING
    quick.settimeout(10)
    while heard < count * 1024:
        server.serve()
        heard += len(quick.recv(1 << 20))
    assert heard == count * 1024
    slow.close()
    quick.close()
    server.close()


def test_tcp_clients_come_and_go(free_port):
    server = Clients('tcp', f'{LOOPBACK}:{free_port}')
    server.send([b'to nobody\r\n'])
    first, second = connect(server, free_port), connect(server, free_port)
    server.send([b'a\r\n'])
    assert first.recv(100) == second.recv(100) == b'a\r\n'
    first.close()
    until = time.monotonic() + 10
    while len(server) == 2 and time.monotonic() < until:  # the first one only tells it
        server.send([b'b\r\n'])
    assert len(server) == 1
    assert second.recv(3) == b'b\r\n'
    server.close()
    while second.recv(1000):  # the rest, then the end
        pass
    second.close()
    Clients('tcp', f'{LOOPBACK}:{free_port}').close()  # the port is free again at once


def test_no_server_where_none_is_asked_for():
    server = Clients('tcp', '')
    server.send([b'nothing'])
    assert len(server) == 0
    server.close()


@pytest.mark.parametrize(
    'text',
    [
        'localhost',
        ':10110',
        'host:',
        '127.0.0.1:0',
        '127.0.0.1:70000',
        '127.0.0.1:x',
        '127.0.0.1:10110 other',
    ],
)
def test_what_is_no_host_and_port_is_refused(text):
    with pytest.raises(ValueError, match="parameter udp has '.*'; it must be host:port"):
        endpoints('udp', text)


def test_addresses_of_version_6_stand_in_brackets():
    (found,) = endpoints('udp', '[::1]:10110')
    assert found.addresses == {socket.AF_INET6: [('::1', 10110, 0, 0)]}


def test_an_address_of_100_000_characters_is_refused_in_a_short_line():
    for text in ('h' * 100_000, 'h' * 100_000 + ':10110', 'host:' + '1' * 100_000):
        with pytest.raises(ValueError, match='parameter udp has ') as refused:
            endpoints('udp', text)
        assert len(str(refused.value)) < 600


def test_clients_that_have_left_make_room_before_a_new_one_is_refused(free_port):
    server = Clients('tcp', f'{LOOPBACK}:{free_port}')
    first = [connect(server, free_port) for _ in range(CLIENTS)]
    assert len(server) == CLIENTS and server.refused == 0
    for client in first[: CLIENTS // 3]:
        client.close()
    for _ in range(CLIENTS // 3):  # nothing was sent meanwhile: only room shows who has left
        first.append(connect(server, free_port))
    assert len(server) == CLIENTS and server.refused == 0
    one_more = socket.create_connection((LOOPBACK, free_port), 10)
    until = time.monotonic() + 10
    while not server.refused and time.monotonic() < until:
        server.serve()
    assert server.refused == 1 and one_more.recv(9) == b''
    server.send([b'line'])
    assert {client.recv(9) for client in first[CLIENTS // 3 :]} == {b'line'}
    server.close()


def test_a_client_that_only_listens_stays_while_there_is_room(free_port):
    server = Clients('tcp', f'{LOOPBACK}:{free_port}')
    client = connect(server, free_port)
    client.sendall(b'hello?')
    client.shutdown(socket.SHUT_WR)  # as `nc HOST PORT < /dev/null` does
    server.send([b'1'])
    connect(server, free_port).close()
    server.send([b'2'])
    assert client.recv(1) + client.recv(1) == b'12'
    server.close()


def test_a_name_of_the_server_in_use_in_one_family_is_refused(free_port):
    with socket.create_server((LOOPBACK, free_port)):
        with pytest.raises(ValueError, match='cannot listen there: Address already in use'):
            Clients('tcp', f'[::]:{free_port}')
