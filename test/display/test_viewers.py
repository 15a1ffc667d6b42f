"""Viewers that read slowly or never, clients that mean no good: none costs another one."""

import asyncio
import contextlib
import json
import random
import socket
import time

import psutil
import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
import aiohttp

SECTORS = 24


def knock(port):
    return (
        b'GET /live HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
        b'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n\r\n' % port
    )


class Sleeper:
    """A viewer that asks for the live data, and reads only when it is told to."""

    def __init__(self, port):
        self.socket = socket.socket()
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8192)
        self.socket.connect(('127.0.0.1', port))
        self.socket.sendall(knock(port))

    def texts(self, until):
        """Messages as they come, until one of them contains the text."""
        data = b''
        self.socket.settimeout(20)
        while (end := data.find(b'\r\n\r\n')) < 0:
            data += self.socket.recv(8192)
        data = data[end + 4 :]
        while True:
            size, at = (data[1] & 127 if len(data) > 1 else 0), 2
            if size == 126:
                size, at = int.from_bytes(data[2:4], 'big'), 4
            elif size == 127:
                size, at = int.from_bytes(data[2:10], 'big'), 10
            if len(data) < max(at + size, 10):
                data += self.socket.recv(65536)
                continue
            assert data[0] == 0x81  # a text, whole: neither a farewell nor a piece
            text, data = data[at : at + size], data[at + size :]
            yield text
            if until in text:
                return


async def newest(link, kind):
    while True:
        heard = json.loads((await link.receive(20)).data)
        if heard['kind'] == kind:
            return heard


def test_a_viewer_that_never_reads_costs_no_memory_and_makes_nobody_late(sea_server):
    sea = sea_server(ships=180, plots=700)
    sleeper = Sleeper(sea.server.port)
    process = psutil.Process()

    async def look():
        async with aiohttp.ClientSession() as session:
            async with session.ws_connect(f'http://127.0.0.1:{sea.server.port}/live') as link:
                used = []
                for scan in range(90):  # four minutes at 24 turns a minute
                    for _ in range(25):
                        sea.tell_own()
                    sea.tell_scan()
                    # Each scan is there before the next one is told.
                    while (await newest(link, 'targets'))['time'] < 7e8 + sea.count:
                        pass
                    if scan in (20, 89):
                        used.append(process.memory_info().rss)
                return used

    early, late = asyncio.run(look())
    assert late - early < 8e6
    asleep = max(sea.server._viewers, key=lambda viewer: viewer.replaced)
    assert len(asleep) <= 5 and asleep.replaced > 80
    sleeper.socket.close()


def test_a_slow_viewer_loses_its_oldest_sectors_and_then_has_one_whole_turn(sea_server):
    sea = sea_server()
    sleeper = Sleeper(sea.server.port)
    while not sea.server.viewers:
        time.sleep(0.01)
    echoes = 'e' * 6000
    for turn in range(70):
        for sector in range(SECTORS):
            sea.server.publish('spokes', {'turn': turn, 'sector': sector, 'e': echoes}, sector)
        time.sleep(0.001)
    sea.server.publish('own', {'last': True})
    seen, amount = {}, 0
    for text in sleeper.texts(b'"last"'):
        heard = json.loads(text)
        amount += len(text)
        if heard['kind'] == 'spokes':
            seen[heard['sector']] = heard['turn']
    assert seen == dict.fromkeys(range(SECTORS), 69)
    # What it got late is what its queue and the system's buffers hold, not the ten megabytes.
    assert amount < 700_000
    # Nobody was sent away for being slow, and what fell out is counted.
    assert sea.server.viewers == 1
    assert sea.server.replaced > 60 * SECTORS
    sea.server.publish('own', {'fresh': 5})
    assert any(b'fresh' in text for text in _more(sleeper))
    sleeper.socket.close()


def _more(sleeper):
    with contextlib.suppress(TimeoutError):
        sleeper.socket.settimeout(5)
        yield sleeper.socket.recv(100_000)


@pytest.mark.parametrize('part', [-1, 512])
def test_a_part_out_of_bounds_is_refused(sea_server, part):
    with pytest.raises(ValueError, match='from 0 to 511'):
        sea_server().server.publish('spokes', {}, part)


RAW = [
    b'',
    b'\x00' * 300,
    b'GET / HTTP/9.9\r\n\r\n',
    b'GET /live HTTP/1.1\r\n\r\n',
    b'GET ' + b'/a' * 20000 + b' HTTP/1.1\r\nHost: x\r\n\r\n',
    b'GET / HTTP/1.1\r\n' + b'X: y\r\n' * 5000 + b'\r\n',
    b'POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999999\r\n\r\n',
    b'POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\nfffffffff\r\n',
    b'GET /\xff\xfe HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n',
    b'GET /%c0%ae%c0%ae/server.py HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n',
    b'GET /static/..%5c..%5cserver.py HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n',
    b'GET http://127.0.0.1/../../access.py HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n',
    b'GET /openbridge.js/ HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n',
    b'OPTIONS * HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n',
    b'\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03',  # asks for TLS
]
FRAMES = [
    b'\x81\xfe\xff\xff',  # ends in the middle of its head
    b'\x81\x05hello',  # not masked
    b'\xf1\x80abcd',  # bits that nobody agreed on
    b'\x89\xff' + b'\xff' * 8,  # a ping of 2^64 bytes
    b'\x80\x80abcd',  # goes on with what never began
    b'\x81\xff\x00\x00\x00\x10\x00\x00\x00\x00abcd',  # 64 GB are announced
    b'\x81\x82\x00\x00\x00\x00\xff\xfe',  # text that is none
    b'\x88\x82\x00\x00\x00\x00\x00\x01',  # a farewell of a kind that there is not
]


def test_clients_that_speak_nonsense_get_no_file_and_end_nothing(sea_server):
    sea = sea_server(ships=3)
    chance = random.Random(5)

    def say(*pieces):
        with contextlib.closing(socket.create_connection(('127.0.0.1', sea.server.port))) as raw:
            raw.settimeout(0.2)
            heard = b''
            with contextlib.suppress(OSError):
                for piece in pieces:
                    raw.sendall(piece)
                while data := raw.recv(65536):
                    heard += data
            return heard

    for piece in RAW:
        heard = say(piece)
        assert not heard or heard.split(b' ')[1] in (b'400', b'403', b'404', b'405', b'413'), heard[
            :200
        ]
        assert b'import ' not in heard and b'def ' not in heard
    for piece in FRAMES:
        say(knock(sea.server.port), piece)
    for _ in range(20):
        say(knock(sea.server.port), chance.randbytes(600))
    idle = [socket.create_connection(('127.0.0.1', sea.server.port)) for _ in range(150)]

    async def look():
        async with aiohttp.ClientSession() as session:
            base = f'http://127.0.0.1:{sea.server.port}/'
            async with session.ws_connect(base + 'live') as link:
                sea.tell_own()
                assert (await newest(link, 'own'))['latitude'] == 58.3
            async with session.get(base) as page:
                assert page.status == 200

    asyncio.run(look())
    for one in idle:
        one.close()
    assert not sea.commands.given


def test_a_viewer_more_than_there_is_room_for_is_told_so(sea_server, monkeypatch):
    from marine_tracker.display import server

    monkeypatch.setattr(server, 'MOST_VIEWERS', 3)
    sea = sea_server()

    async def crowd():
        base = f'http://127.0.0.1:{sea.server.port}/live'
        async with aiohttp.ClientSession() as session, contextlib.AsyncExitStack() as stack:
            for _ in range(3):
                await stack.enter_async_context(session.ws_connect(base))
            with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
                await session.ws_connect(base)
            assert refused.value.status == 503
        async with aiohttp.ClientSession() as session, session.ws_connect(base):
            return True  # there is room again

    assert asyncio.run(crowd())
    assert sea.server.counts['viewers refused for want of room'] == 1


def test_pages_that_say_no_are_dark_too(sea_server):
    sea = sea_server()

    async def get(path, host=None):
        headers = {'Host': host} if host else {}
        async with aiohttp.ClientSession() as session:
            async with session.get(
                f'http://127.0.0.1:{sea.server.port}{path}', headers=headers
            ) as page:
                return page.status, await page.text()

    for path, host, status in (('/chart', None, 404), ('/', 'ship.example', 403)):
        found = asyncio.run(get(path, host))
        assert found[0] == status
        assert 'content="dark"' in found[1] and 'bgcolor="#000000"' in found[1]
