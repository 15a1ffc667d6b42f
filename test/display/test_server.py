"""The page's server, with real clients: what it serves, what it refuses, and that it lives on."""

import asyncio
import json
import random
import socket
import time
from concurrent.futures import Future

import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
import aiohttp

from marine_tracker.display import access, server
from marine_tracker.display.server import BAD, DENIED, FOREIGN, DisplayServer


class Served:
    """A server that answers every command with its name, and remembers them."""

    def __init__(self, **options):
        self.commands = []
        self.server = DisplayServer('127.0.0.1:0', self.run, **options)
        self.base = f'http://127.0.0.1:{self.server.port}'

    def run(self, command):
        self.commands.append(command)
        answer = Future()
        if command.name == 'cancel':
            answer.set_exception(ValueError(f'no target {command.values["number"]}'))
        else:
            answer.set_result(f'{command.name} done')
        return answer


@pytest.fixture
def served():
    made = []

    def start(**options):
        made.append(Served(**options))
        return made[-1]

    yield start
    for one in made:
        one.server.close()


async def answers(link, kind='answer'):
    """The next message of the kind."""
    while True:
        heard = json.loads((await link.receive(20)).data)
        if heard['kind'] == kind:
            return heard


def test_nothing_but_the_files_of_the_page_is_served(served):
    base = served().base

    async def get():
        async with aiohttp.ClientSession() as session:
            found = {}
            for path in ('/', '/main.js', '/style.css', '/icon.svg'):
                async with session.get(base + path) as response:
                    found[path] = response.status, response.content_type, response.headers
            for path in (
                '/../server.py',
                '/%2e%2e/server.py',
                '/..%2fserver.py',
                '//etc/passwd',
                '/static/../../__init__.py',
                '/main.js/../../server.py',
                '/server.py',
                '/main.js%00',
            ):
                async with session.get(aiohttp.client.URL(base + path, encoded=True)) as response:
                    found[path] = response.status, None, response.headers
            async with session.post(base + '/', data=b'x') as response:
                found['post'] = response.status, None, response.headers
            return found

    found = asyncio.run(get())
    assert [found[path][:2] for path in ('/', '/main.js', '/style.css', '/icon.svg')] == [
        (200, 'text/html'),
        (200, 'text/javascript'),
        (200, 'text/css'),
        (200, 'image/svg+xml'),
    ]
    assert "default-src 'self'" in found['/'][2]['Content-Security-Policy']
    others = [found[path][0] for path in list(found)[4:]]
    assert all(status in (400, 404, 405) for status in others), found


def test_a_new_viewer_gets_the_newest_state_and_then_what_comes(served):
    one = served()
    for x in (1.5, 2.5):
        one.server.publish('own', {'x': x})
    one.server.publish('alarms', {'alarms': []})

    async def look():
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(one.base + '/live') as link,
        ):
            first = await answers(link, 'own')
            one.server.publish('own', {'x': 3.5})
            return first, await answers(link, 'own')

    first, second = asyncio.run(look())
    assert (first['x'], second['x']) == (2.5, 3.5)
    assert 0 <= second['now'] - first['now'] < 60
    assert abs(time.monotonic() - second['now']) < 60


def test_pages_of_other_servers_are_refused_before_the_upgrade(served):
    one = served()
    port = one.server.port
    tried = [
        ({'Origin': 'http://evil.example'}, 403),
        ({'Origin': f'http://localhost.evil.example:{port}'}, 403),
        ({'Origin': 'null'}, 403),
        ({'Origin': f'http://127.0.0.1:{port + 1}'}, 403),
        # A name of somebody else that was made to point here.
        ({'Origin': f'http://evil.example:{port}', 'Host': f'evil.example:{port}'}, 403),
        ({'Origin': f'http://127.0.0.1:{port}'}, 101),
        ({'Origin': f'http://localhost:{port}', 'Host': f'localhost:{port}'}, 101),
        ({}, 101),
    ]

    async def knock(headers):
        async with aiohttp.ClientSession() as session:
            try:
                async with session.ws_connect(one.base + '/live', headers=headers) as link:
                    return 101 if (await answers(link, 'pulse')) else 0
            except aiohttp.WSServerHandshakeError as error:
                return error.status

    for headers, status in tried:
        assert asyncio.run(knock(headers)) == status, headers
    assert one.server.counts[FOREIGN] == 5


def test_a_proxy_has_a_name_that_is_told_to_the_server(served):
    one = served(names=['ppi.example.org'])

    async def get(host):
        async with aiohttp.ClientSession() as session:
            headers = {'Host': host, 'Origin': f'https://{host}'}
            try:
                async with session.ws_connect(one.base + '/live', headers=headers):
                    return 101
            except aiohttp.WSServerHandshakeError as error:
                return error.status

    assert asyncio.run(get('ppi.example.org')) == asyncio.run(get('PPI.example.org:443')) == 101
    assert asyncio.run(get('other.example.org')) == 403


def test_commands_need_the_token(served):
    one = served(token='sesame')
    acquire = {'command': 'acquire', 'x': -741.5, 'y': 3.0, 'id': 7}

    async def say():
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(one.base + '/live') as link,
        ):
            said = []
            await link.send_json(acquire)
            said.append(await answers(link))
            await link.send_json({'command': 'login', 'token': 'sesam'})
            said.append(await answers(link, 'role'))
            await link.send_json(acquire)
            said.append(await answers(link))
            await link.send_json({'command': 'login', 'token': 'sesame'})
            said.append(await answers(link, 'role'))
            await link.send_json(acquire)
            said.append(await answers(link))
            await link.send_json({'command': 'cancel', 'number': 12, 'id': 8})
            said.append(await answers(link))
            return said

    no, wrong, still_no, right, done, refused = asyncio.run(say())
    assert not no['ok'] and not still_no['ok'] and 'token' in no['text']
    assert not wrong['commands'] and right['commands']
    assert done['ok'] and done['id'] == 7 and done['text'] == 'acquire done'
    assert not refused['ok'] and refused['text'] == 'no target 12'
    assert [command.name for command in one.commands] == ['acquire', 'cancel']
    assert one.commands[0].values == {'x': -741.5, 'y': 3.0}
    assert one.server.counts[DENIED] == 2


@pytest.mark.parametrize('anybody', [False, True])
def test_other_machines_only_look_unless_they_are_allowed(served, anybody, monkeypatch):
    one = served(token='t', anybody_commands=anybody)
    # There is one machine here: what this one is taken for is all that differs.
    monkeypatch.setattr(access, 'is_loopback', lambda address: False)

    async def login():
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(one.base + '/live') as link,
        ):
            await link.send_json({'command': 'login', 'token': 't'})
            return await answers(link, 'role')

    assert asyncio.run(login())['commands'] == anybody


@pytest.mark.parametrize(
    ('address', 'near'),
    [
        ('127.0.0.1', True),
        ('127.3.2.1', True),
        ('::1', True),
        ('::ffff:127.0.0.1', True),
        ('192.168.4.7', False),
        ('::ffff:10.1.1.1', False),
        ('fe80::1%eth0', False),
        ('', False),
        (None, False),
    ],
)
def test_addresses_of_this_machine_are_told_from_others(address, near):
    assert access.is_loopback(address) is near


def test_a_thousand_bad_messages_harm_nobody(served):
    one = served(token='t')
    chance = random.Random(11)
    bad = [
        '',
        'null',
        '[1]',
        '{"command":',
        '{"command": "acquire"}',
        '{"command": "acquire", "x": NaN, "y": 1}',
        '{"command": "acquire", "x": 1e999, "y": 1}',
        '{"command": "acquire", "x": ' + '9' * 400 + ', "y": 1}',
        '{"command": "acquire", "x": true, "y": 1}',
        '{"command": "cancel", "number": -3}',
        '{"command": "cancel", "number": 2.5}',
        '{"command": "cancel", "number": 4294967296}',
        '{"command": "trial", "course_deg": 361, "speed_kn": 5, "delay_min": 0}',
        '{"command": "cancel_all", "why": 1}',
        '{"command": "login", "token": 7}',
        '{"command": ["cancel_all"]}',
        '{"command": "cancel_all", "id": "one"}',
        '[' * 1500,
        b'\x00\xff binary',
    ]

    async def shout():
        async with aiohttp.ClientSession() as session:
            async with session.ws_connect(one.base + '/live') as link:
                await link.send_json({'command': 'login', 'token': 't'})
                await answers(link, 'role')
                for _ in range(1000):
                    message = chance.choice(bad)
                    await (link.send_bytes if isinstance(message, bytes) else link.send_str)(
                        message
                    )
                await link.send_json({'command': 'cancel_all', 'id': 99})
                while (last := await answers(link))['id'] != 99:
                    assert not last['ok'] and '\n' not in last['text'] and len(last['text']) < 300
            async with session.ws_connect(one.base + '/live') as link:  # a frame without measure
                await link.send_str('x' * 1_000_000)
                try:
                    while (await link.receive(20)).type not in (
                        aiohttp.WSMsgType.CLOSE,
                        aiohttp.WSMsgType.CLOSED,
                        aiohttp.WSMsgType.ERROR,
                    ):
                        pass
                except ConnectionError:
                    pass
            async with session.get(one.base + '/') as response:
                assert response.status == 200
        return last

    assert asyncio.run(shout())['ok']
    assert one.server.counts[BAD] == 1001  # the frame without measure is one as well
    assert [command.name for command in one.commands] == ['cancel_all']


def test_a_viewer_that_does_not_read_holds_nobody_up_and_gets_the_newest_state(served):
    one = served()
    heavy = 'x' * 200_000

    async def look():
        async with aiohttp.ClientSession() as session:
            reader, writer = await asyncio.open_connection('127.0.0.1', one.server.port)
            writer.transport.pause_reading()  # never reads again
            writer.write(
                b'GET /live HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nUpgrade: websocket\r\n'
                b'Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n'
                b'Sec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n\r\n' % one.server.port
            )
            while one.server.viewers < 1:
                await asyncio.sleep(0.01)
            async with session.ws_connect(one.base + '/live') as link:
                for count in range(300):
                    one.server.publish('own', {'count': count, 'heavy': heavy})
                    one.server.publish('targets', {'count': count, 'heavy': heavy})
                while (await answers(link, 'targets'))['count'] < 299:
                    pass
            waiting = [len(viewer) for viewer in one.server._viewers]
            writer.transport.resume_reading()
            newest = 0
            data = b''
            while newest < 299:
                data = (data + await reader.read(1 << 20))[-1_000_000:]
                at = data.rfind(b'"kind":"targets"')
                found = data[at : at + 80].split(b'"count":')
                if len(found) > 1 and b',' in found[1]:
                    newest = int(found[1].split(b',')[0])
            writer.close()
            return waiting

    waiting = asyncio.run(asyncio.wait_for(look(), 60))
    assert max(waiting) <= 4  # own, targets, pulse: one of each


def test_a_port_that_is_taken_is_an_error_at_the_start():
    with socket.socket() as taken:
        taken.bind(('127.0.0.1', 0))
        taken.listen()
        with pytest.raises(OSError, match=str(taken.getsockname()[1])):
            DisplayServer(f'127.0.0.1:{taken.getsockname()[1]}', lambda command: Future())


@pytest.mark.parametrize('address', ['8080', 'localhost', ':80', '127.0.0.1:http', 'host:70000'])
def test_addresses_without_host_and_port_are_refused_by_name(address):
    with pytest.raises(ValueError, match='host:port'):
        server.read_address(address)


def test_what_comes_on_demand_goes_to_who_asked_and_nobody_else(served):
    here = served()

    async def look_on():
        async with aiohttp.ClientSession() as session:
            async with (
                session.ws_connect(here.base + '/live') as asks,
                session.ws_connect(here.base + '/live') as other,
            ):
                await asks.send_json({'command': 'watch', 'id': 4, 'areas': 1})
                said = await answers(asks)  # without a token: it is no command
                assert said['ok'] and said['id'] == 4 and here.server.wanted('areas') == 1
                here.server.publish('areas', {'safe': [[1, 2]]})
                here.server.publish('own', {'x': 3})
                assert (await answers(asks, 'areas'))['safe'] == [[1, 2]]
                kinds = []
                while 'own' not in kinds:
                    kinds.append(json.loads((await other.receive(20)).data)['kind'])
                assert 'areas' not in kinds
                await other.send_json({'command': 'watch', 'areas': 1})
                assert (await answers(other, 'areas'))['safe'] == [[1, 2]]  # the newest at once
                await asks.send_json({'command': 'watch', 'areas': 0})
                assert (await answers(asks))['ok'] and here.server.wanted('areas') == 1
                await asks.send_json({'command': 'watch', 'areas': 3})
                assert 'areas must be between 0 and 1' in (await answers(asks))['text']
        for _ in range(100):
            if not here.server.wanted('areas'):
                return
            await asyncio.sleep(0.05)
        raise AssertionError('who has gone still wants')

    asyncio.run(look_on())
    assert here.commands == []
