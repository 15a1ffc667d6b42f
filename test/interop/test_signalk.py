"""A Signal K server of others takes our targets and alarms, over UDP on loopback.

The server is the one in the PATH, else it is installed by npm for this run; skipped without both.
"""

import contextlib
import json
import os
import shutil
import signal
import socket
import subprocess
import time
import urllib.request
import uuid

import numpy as np
import pytest

from marine_tracker.arpa import nmea, signalk
from marine_tracker.arpa.signalk import Alert
from marine_tracker.geometry import KNOT

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]
NAMESPACE = uuid.uuid5(uuid.NAMESPACE_OID, 'test')
PATIENCE = 60.0
VERSION = 'signalk-server@2.23'


@pytest.fixture(scope='module')
def program(tmp_path_factory):
    """The words that start the server."""
    found = os.environ.get('SIGNALK_SERVER') or shutil.which('signalk-server')
    if found:
        return [found]
    if shutil.which('npm') is None:
        pytest.skip('no signalk-server and no npm')
    home = tmp_path_factory.mktemp('npm')
    words = ['npm', 'install', '--prefix', home, '--no-audit', '--no-fund', VERSION]
    if subprocess.run(words, capture_output=True, timeout=500).returncode:
        pytest.skip('npm cannot install signalk-server')
    return [home / 'node_modules' / '.bin' / 'signalk-server']


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as one:
        one.bind(('127.0.0.1', 0))
        return one.getsockname()[1]


class Server:
    """A running server with one UDP input of Signal K data."""

    def __init__(self, program, folder):
        self.http, self.udp = free_port(socket.SOCK_STREAM), free_port(socket.SOCK_DGRAM)
        element = {
            'type': 'providers/simple',
            'options': {'type': 'SignalK', 'subOptions': {'type': 'udp', 'port': str(self.udp)}},
        }
        settings = {
            'port': self.http,
            'mdns': False,
            'interfaces': {'tcp': False, 'nmea-tcp': False},
            'pipedProviders': [{'id': 'radar', 'enabled': True, 'pipeElements': [element]}],
        }
        (folder / 'settings.json').write_text(json.dumps(settings))
        (folder / 'package.json').write_text('{}')
        environment = {**os.environ, 'PORT': str(self.http), 'NODE_ENV': 'production'}
        self.log = folder / 'server.log'
        with open(self.log, 'wb') as log:
            self.process = subprocess.Popen(
                [*map(str, program), '-c', str(folder)],
                cwd=folder,
                stdout=log,
                stderr=log,
                env=environment,
                start_new_session=True,
            )
        self.until(lambda: self.get('vessels/self') is not None)

    def get(self, path):
        """What the REST interface says; None where it has nothing."""
        address = f'http://127.0.0.1:{self.http}/signalk/v1/api/{path}'
        with contextlib.suppress(OSError):
            with urllib.request.urlopen(address, timeout=5) as answer:
                return json.load(answer)
        return None

    def send(self, deltas):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
            for delta in deltas:
                mouth.sendto(delta.encode(), ('127.0.0.1', self.udp))

    def until(self, condition):
        until = time.monotonic() + PATIENCE
        while not (value := condition()):
            assert self.process.poll() is None, self.log.read_text()
            assert time.monotonic() < until, self.log.read_text()[-2000:]
            time.sleep(0.3)
        return value

    def close(self):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(10)
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)


@pytest.fixture
def server(program, tmp_path):
    here = Server(program, tmp_path)
    yield here
    here.close()


def targets(status):
    return nmea.Targets(
        np.array([7, 23]),
        np.array([status, 'T']),
        np.array(['A', 'A']),
        np.array(['TT07', 'TT23']),
        np.array([4200.0, 9100.0]),
        np.array([1.1, 4.0]),
        np.array([11.5, 6.25]) * KNOT,
        np.array([2.6, np.nan]),
        np.array([310.0, 2500.0]),
        np.array([415.0, -60.0]),
    )


def told(server, status, stamp):
    server.send(
        signalk.deltas(
            targets(status),
            [signalk.context(NAMESPACE, number) for number in (7, 23)],
            [54.4, 54.6],
            [10.2, 10.1],
            stamp,
        )
    )


def test_targets_are_vessels_of_the_server_and_lost_ones_lose_their_motion(server):
    now = time.time()
    vessel = f'vessels/{signalk.context(NAMESPACE, 7).removeprefix("vessels.")}'
    server.until(lambda: told(server, 'T', now) or server.get(f'{vessel}/navigation'))
    shown = server.get(vessel)
    navigation = shown['navigation']
    assert shown['name'] == 'TT07'
    assert navigation['position']['value'] == {'latitude': 54.4, 'longitude': 10.2}
    assert navigation['speedOverGround']['value'] == pytest.approx(11.5 * KNOT)
    assert navigation['courseOverGroundTrue']['value'] == pytest.approx(2.6)
    assert navigation['closestApproach']['value'] == {'distance': 310.0, 'timeTo': 415.0}
    assert navigation['position']['$source'].startswith('radar') or 'marine' in str(navigation)
    other = server.get(f'vessels/{signalk.context(NAMESPACE, 23).removeprefix("vessels.")}')
    assert 'courseOverGroundTrue' not in other['navigation']
    told(server, 'L', now + 3)
    server.until(lambda: server.get(f'{vessel}/navigation/speedOverGround')['value'] is None)
    assert server.get(f'{vessel}/navigation/position')['value'] is None


def test_alarms_are_notifications_of_own_ship_until_they_are_over(server):
    now = time.time()

    def tell(state, at):
        server.send(
            signalk.notifications(
                [
                    Alert('TT07: danger', 'TT07 dangerous: CPA 0.17 NM', 'alarm', state),
                    Alert('TT23: lost target', 'TT23 lost', 'warning', 'active unacknowledged'),
                ],
                'tracker',
                now + at,
            )
        )

    path = 'vessels/self/notifications/radar/tracker'
    server.until(lambda: tell('active unacknowledged', 0) or server.get(f'{path}/TT07_danger'))
    value = server.get(f'{path}/TT07_danger')['value']
    assert value['state'] == 'alarm' and value['method'] == ['visual', 'sound']
    assert value['message'] == 'TT07 dangerous: CPA 0.17 NM'
    assert server.get(f'{path}/TT23_lost_target')['value']['state'] == 'warn'
    tell('active acknowledged', 2)
    server.until(lambda: server.get(f'{path}/TT07_danger')['value']['method'] == ['visual'])
    tell('normal', 4)
    server.until(lambda: server.get(f'{path}/TT07_danger')['value']['state'] == 'normal')
