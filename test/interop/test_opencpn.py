"""OpenCPN, a chart plotter of others, shows what we tell it, and reckons the same CPA.

It runs on a virtual display; its list of targets is read off the screen by a text recogniser.
Skipped where one of TOOLS is not installed (doc/opencpn.md says how).
"""

import contextlib
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pynmea2
import pytest
from scipy.ndimage import zoom

from marine_tracker.arpa import nmea
from marine_tracker.arpa.cpa import cpa_of
from marine_tracker.geometry import KNOT, NAUTICAL_MILE, unit_vector

TOOLS = {
    'opencpn': 'opencpn',
    'Xvfb': 'xvfb',
    'xdotool': 'xdotool',
    'import': 'imagemagick',
    'tesseract': 'tesseract-ocr',
}
MISSING = [package for tool, package in TOOLS.items() if shutil.which(tool) is None]
pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(400),
    pytest.mark.skipif(bool(MISSING), reason=f'not installed: {", ".join(MISSING)}'),
]

CHECKOUT = Path(__file__).resolve().parents[2]
LATITUDE, LONGITUDE = 54.3, 7.5
SIZE = 1280, 900
LIST = 50, 480, 1180, 360  # x, y, width, height of the target list
FIRST_MMSI = 199200000  # OpenCPN's, of the target with number 0
PATIENCE = 60.0
SCALES = 2, 2.5, 3, 3.5, 4  # the recogniser misreads a digit now and then
CONFIGURATION = f"""
[Settings]
NavMessageShown=1
ShowMenuBar=1
Locale=en_US
[Settings/GlobalState]
FrameWinX={SIZE[0]}
FrameWinY={SIZE[1]}
[Settings/AIS]
bCPAWarn=1
CPAWarnNMi=0.5
bTCPAMax=1
TCPAMaxMinutes=30
bShowAISName=1
ShowAISTargetNameScale=5000000
[Settings/NMEADataSource]
DataConnections=1;1;127.0.0.1;PORT;0;;4800;1;0;0;;0;;1;0;0;0;1;;0;;0;0;
[Canvas]
CanvasConfig=0
[Canvas/CanvasConfig1]
canvasVPLatLon="   {LATITUDE:.4f},    {LONGITUDE:.4f}"
canvasVPScale=0.00875
canvasbFollow=1
canvasShowAIS=1
"""


def until(condition, patience=PATIENCE, every=0.3):
    """Poll until the condition holds, and return what it gave."""
    end = time.monotonic() + patience
    while True:
        value = condition()
        if value:
            return value
        assert time.monotonic() < end, f'not so within {patience:g} s'
        time.sleep(every)


class OpenCpn:
    """One that runs on a display of its own and listens to `port` of UDP."""

    def __init__(self, folder, stack):
        self.folder = folder
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
            one.bind(('127.0.0.1', 0))
            self.port = one.getsockname()[1]
        home = folder / 'home'
        (home / '.opencpn').mkdir(parents=True)
        (home / '.opencpn' / 'opencpn.conf').write_text(
            CONFIGURATION.replace('PORT', str(self.port))
        )
        read, write = os.pipe()
        stack.enter_context(
            running(
                [
                    'Xvfb',
                    '-displayfd',
                    str(write),
                    '-screen',
                    '0',
                    f'{SIZE[0]}x{SIZE[1]}x24',
                    '-nolisten',
                    'tcp',
                ],
                folder,
                pass_fds=[write],
            )
        )
        os.close(write)
        with open(read) as number:
            self.environment = {
                **os.environ,
                'DISPLAY': f':{number.readline().strip()}',
                'HOME': str(home),
                'LC_ALL': 'C.UTF-8',
            }
        # No OpenGL and no plug-ins.
        self.process = stack.enter_context(
            running(['opencpn', '-G', '-s'], folder, env=self.environment)
        )
        window = until(lambda: self.find('^OpenCPN [0-9]'))
        welcome = until(lambda: self.find('Welcome to OpenCPN') or self.listens())
        if welcome is not True:  # to be agreed to, once for each version
            self.do(
                'windowraise', welcome, 'mousemove', '--window', welcome, '415', '359', 'click', '1'
            )
        until(self.listens)
        self.do('windowsize', window, *map(str, SIZE))

    def find(self, title):
        """The window whose title matches; '' for none."""
        found = subprocess.run(
            ['xdotool', 'search', '--name', title],
            text=True,
            capture_output=True,
            env=self.environment,
        )
        return found.stdout.strip().split('\n')[-1]

    def do(self, *words):
        subprocess.run(['xdotool', *words], check=True, env=self.environment)

    def listens(self):
        """Whether it has opened its port."""
        assert self.process.poll() is None, 'OpenCPN has ended'
        with open('/proc/net/udp') as table:
            return f':{self.port:04X} ' in table.read()

    def picture(self, window='root'):
        """What is on the screen, [height, width, 3]."""
        shot = subprocess.run(
            ['import', '-window', window, '-depth', '8', 'ppm:-'],
            check=True,
            capture_output=True,
            env=self.environment,
        ).stdout
        head = re.match(rb'P6\s(\d+)\s(\d+)\s255\s', shot)
        width, height = map(int, head.groups())
        return np.frombuffer(shot, np.uint8, offset=head.end()).reshape(height, width, 3)

    def open_list(self):
        """Show the list of targets."""

        def opened():
            # The menu AIS, its last entry.
            self.do(
                'mousemove',
                '142',
                '12',
                'click',
                '1',
                'sleep',
                '1.5',
                'mousemove',
                '200',
                '214',
                'click',
                '1',
                'sleep',
                '1.5',
            )
            return self.find('AIS target list')

        self.list = until(opened)
        x, y, width, height = map(str, LIST)
        self.do(
            'windowraise',
            self.list,
            'windowmove',
            self.list,
            x,
            y,
            'windowsize',
            self.list,
            width,
            height,
            'sleep',
            '2',
        )

    def rows(self):
        """The list as rows of cells, each a picture; nothing while it is still being drawn."""
        grey = self.picture(self.list).mean(2)
        lines = np.flatnonzero((grey[45:, 150:180] < 200).all(1)) + 45  # in an empty column
        lines = lines[np.diff(lines, append=9999) > 1]  # a selected row is dark all over
        if len(lines) < 2:
            return []
        columns = np.flatnonzero((grey[lines[0] : lines[-1], :900] < 200).all(0))
        columns = columns[np.diff(columns, prepend=-9) > 1]
        if len(columns) < 11:
            return []
        rows = []
        for top, bottom in zip(np.append(44, lines[:-1]), lines):
            cells = [
                grey[top + 3 : bottom - 2, left + 3 : right - 4]
                for left, right in zip(columns[:-1], columns[1:])
            ]
            rows.append([cells[-10], *cells[-6:]])
        return rows

    def targets(self):
        """The list: {target number: {column: figure}}; nan for what it does not show."""
        names = ('bearing', 'range', 'course', 'speed', 'cpa', 'tcpa')
        rows = until(self.rows)
        figures = np.reshape(self.read([cell for row in rows for cell in row]), (-1, 7))
        return {
            int(row[0]) - FIRST_MMSI: dict(zip(names, row[1:]))
            for row in figures.tolist()
            if np.isfinite(row[0])
        }

    def read(self, cells):
        """The figures in cells [h, w] of the list, as most of SCALES read them; nan for none."""
        names = []
        for cell in cells:
            if np.median(cell) < 200:  # white on blue
                cell = (255 - cell) * (255 / (255 - np.median(cell)))
            for scale in SCALES:
                large = zoom(np.pad(cell, 8, constant_values=255), scale, order=3)
                large = large.clip(0, 255).astype(np.uint8)
                names.append(self.folder / f'cell_{len(names)}.pgm')
                names[-1].write_bytes(b'P5 %d %d 255\n' % large.shape[::-1] + large.tobytes())
        (self.folder / 'cells').write_text('\n'.join(map(str, names)))
        pages = subprocess.run(
            [
                'tesseract',
                'cells',
                'stdout',
                '--psm',
                '6',
                '--dpi',
                '300',
                '-c',
                'tessedit_char_whitelist=0123456789.-',
            ],
            capture_output=True,
            text=True,
            check=True,
            cwd=self.folder,
            env={**os.environ, 'OMP_THREAD_LIMIT': '1'},
        ).stdout.split('\f')
        said = [page.strip() for page in pages[: len(names)]]
        figures = []
        for k in range(0, len(said), len(SCALES)):
            votes = [one for one in said[k : k + len(SCALES)] if re.fullmatch(r'\d+(\.\d+)?', one)]
            figures.append(float(max(votes, key=votes.count)) if votes else np.nan)
        return figures

    def colour(self, range_nm, bearing_deg):
        """The colour beside the middle of a symbol there, own ship being in the middle."""
        pixels = range_nm * NAUTICAL_MILE * 0.00875 / np.cos(np.radians(LATITUDE))
        east, north = pixels * unit_vector(np.radians(bearing_deg))
        red, green, blue = self.picture()[round(452 - north) - 6, round(640 + east)].tolist()
        return (
            'red'
            if red > 200 and green < 80
            else 'yellow'
            if red > 200 and green > 180 and blue < 120
            else 'green'
            if green > 200 and blue < 150
            else 'sea'
        )


@contextlib.contextmanager
def running(command, folder, number=signal.SIGTERM, **arguments):
    """A process for as long as the context lasts."""
    with open(folder / f'{Path(command[0]).name}_{time.monotonic_ns()}.log', 'wb') as log:
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, **arguments
        )
    try:
        yield process
    finally:
        process.send_signal(number)
        try:
            process.wait(15)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@pytest.fixture
def stack():
    with contextlib.ExitStack() as stack:
        yield stack


@pytest.fixture
def opencpn(tmp_path, stack):
    return OpenCpn(tmp_path, stack)


def same_angle(one, other, most):
    return abs((one - other + 180) % 360 - 180) <= most


def test_statuses_places_and_its_own_cpa_are_those_sent(opencpn):
    own = nmea.OwnShipData(LATITUDE, LONGITUDE, 10 * KNOT, 0.0, 0.0)
    range_nm, bearing_deg = np.array([4, 5, 6, 3, 4.0]), np.array([90, 60, 0, 300, 200.0])
    speed, course = np.array([5, 9, 8, 4, 12.0]), np.array([270, 200, 178, 60, 10.0])
    nothing, count = np.full(5, np.nan), 5
    shown = nmea.as_acquired(
        nmea.Targets(
            np.arange(41, 46),
            np.array(['T', 'Q', 'T', 'T', 'T']),
            np.full(count, 'A'),
            np.array([f'TT{n}' for n in range(41, 46)]),
            range_nm * NAUTICAL_MILE,
            np.radians(bearing_deg),
            speed * KNOT,
            np.radians(course),
            nothing,
            nothing,
        )
    )
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def tell(targets, seconds=4):
        for _ in range(seconds):
            now = time.time()
            for line in [nmea.rmc(own, now), nmea.hdt(own), *nmea.ttm(targets, now)]:
                sender.sendto(f'{line}\r\n'.encode(), ('127.0.0.1', opencpn.port))
            time.sleep(1)

    tell(shown)
    colours = [opencpn.colour(r, b) for r, b in zip(range_nm, bearing_deg)]
    assert colours == ['green', 'yellow', 'red', 'green', 'green']
    opencpn.open_list()
    tell(shown)
    listed = opencpn.targets()
    assert set(listed) == set(range(41, 46))
    cpa, tcpa = cpa_of(
        range_nm[:, None] * unit_vector(np.radians(bearing_deg)),
        speed[:, None] * unit_vector(np.radians(course)) - 10 * unit_vector(0.0),
    )
    for k, row in enumerate(listed[n] for n in range(41, 46)):
        assert row['range'] == pytest.approx(range_nm[k], abs=0.03)
        assert same_angle(row['bearing'], bearing_deg[k], 1)
        if k != 1:  # being acquired: no motion
            assert row['speed'] == speed[k] and same_angle(row['course'], course[k], 1)
            assert row['cpa'] == pytest.approx(cpa[k], abs=0.05)
            assert row['tcpa'] == pytest.approx(tcpa[k] * 60, abs=1.0)

    lost = shown._replace(status=np.array(['T', 'Q', 'T', 'L', 'T']))
    tell(lost, 1)
    tell(shown._replace(**{name: np.delete(column, 3) for name, column in shown._asdict().items()}))
    assert set(opencpn.targets()) == {41, 42, 43, 45}
    assert opencpn.colour(range_nm[3], bearing_deg[3]) == 'sea'
    assert opencpn.colour(range_nm[0], bearing_deg[0]) == 'green'


def test_simulator_tracker_and_nmea_output_show_their_targets_in_opencpn(opencpn, tmp_path, stack):
    pytest.importorskip('rclpy')
    from marine_tracker.nodes import domain

    environment = {**os.environ, 'PYTHONPATH': str(CHECKOUT)}
    domain.set_local(environment, stack.enter_context(domain.free_domain()))
    ear = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
    ear.bind(('127.0.0.1', 0))
    ear.setblocking(False)
    for node, parameters in (
        (
            'nmea_output',
            {
                'udp': f'127.0.0.1:{opencpn.port} 127.0.0.1:{ear.getsockname()[1]}',
                'origin': f'"{LATITUDE} {LONGITUDE}"',
            },
        ),
        ('tracker', {'bearing_sigma_deg': 0.4, 'max_range_m': 22224.0}),
        ('radar_simulator', {'scenario': 'encounters'}),
    ):
        words = [word for name, value in parameters.items() for word in ('-p', f'{name}:={value}')]
        stack.enter_context(
            running(
                [sys.executable, '-m', 'marine_tracker.nodes.run', node, '--ros-args', *words],
                tmp_path,
                signal.SIGINT,
                env=environment,
                cwd=CHECKOUT,
            )
        )
    told = {}  # {target number: its TTM sentences}

    def hear():
        with contextlib.suppress(BlockingIOError):
            while True:
                line = ear.recv(1000).decode().strip()
                if 'TTM' in line:
                    parsed = pynmea2.parse(line, check=True)
                    told.setdefault(parsed.target_number, []).append(parsed)
        return told

    # Three targets, steady for a minute at least.
    until(lambda: len(hear()) >= 3 and all(len(hear()[n]) >= 25 for n in (1, 2, 3)), 150, 1.0)
    opencpn.open_list()
    compared = 0
    for _ in range(4):
        before = {number: len(said) for number, said in hear().items()}
        listed = opencpn.targets()  # one picture, and then a while to read it
        hear()
        assert set(listed) == {1, 2, 3}
        for number, row in listed.items():
            # Which scan the row is of, it tells itself: by course and speed.
            lately = told[number][max(before[number] - 5, 0) :]
            of_row = [
                ttm
                for ttm in lately
                if same_angle(float(ttm.cog), row['course'], 0.6)
                and abs(float(ttm.speed) - row['speed']) <= 0.06
            ]
            if not of_row and not np.isfinite([row['course'], row['speed']]).all():
                continue  # the recogniser could not read them
            assert any(
                abs(float(ttm.distance) - row['range']) <= 0.05
                and same_angle(float(ttm.bearing), row['bearing'], 1.1)
                for ttm in of_row
            ), (row, list(map(str, lately)))
            if np.isfinite(row['cpa']):
                away = min(abs(float(ttm.dist_cpa) - row['cpa']) for ttm in of_row)
                assert away <= 0.05, (number, row, list(map(str, lately)))
                compared += 1
        time.sleep(8)
    assert compared >= 8
