"""Files and messages that nobody wrote: whatever comes in, the answer is values or one clear line.

    python test/fuzz/fuzz.py KIND [COUNT] [SEED]

A case is a good file or message, changed at random; COUNT of them are read. A case fails where the
reader raises anything but a ValueError of one line, or takes more than 2 s of the processor; the
process may have 500 MB more than at its start. What failed is written to fuzz_KIND_N, and the exit
code is 1. The last line on standard output is a JSON object with the figures.
"""

import json
import os
import random
import re
import resource
import shutil
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from marine_tracker.arpa import zones
from marine_tracker.evaluation import screened
from marine_tracker.networks import gwnn_weights, rough_weights, weight_file
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.recording import track_file
from marine_tracker.simulation import ais_file, scenario
from marine_tracker.tracking.radars import radars_of
from marine_tracker.training import custom_traffic
from marine_tracker.yaml_file import parse, read_json, read_mapping

SLOWEST_S = 2.0
MOST_BYTES = 500 * 2**20
LONGEST_LINE = 2000  # characters of a message

SCENARIOS = [
    '{duration_s: 60, targets: [{name: a, start: {range_nm: 3, bearing_deg: 045}, '
    'course_deg: 010, speed_kn: 10, legs: [{straight: {duration_s: 20}}, {turn: {angle_deg: -40, '
    'radius_m: 500}}, {speed: {to_kn: 8, duration_s: 60}}], speed_wave: {amplitude_kn: 1, '
    'period_s: 300}}]}',
    'duration_s: 90\nradar: {max_range_nm: 6, rotation_rpm: 24}\nclutter: {uniform: 2, sea: 3}\n'
    'own_ship: {start: {lat_deg: 54, lon_deg: 179.9}, course_deg: 350, speed_kn: 12}\ntargets:\n'
    '  - {start: {lat_deg: 54.01, lon_deg: -179.9}, course_deg: 1, speed_mps: 4, pd: .9}\n'
    '  - name: tanker\n    start: {north_m: 900, east_m: 40}\n    course_deg: 250\n'
    '    speed_kn: 11\n    length_m: 200\n    hull: {beam_m: 32, snr_db: 20}\n'
    'land:\n  - {name: mole, corners_m: [[900, -400], [1200, 800]], closed: false}\n',
    'duration_s: 50\nais: {file: ais.csv, start_s: 0, vessels: [2], max_gap_s: 60}\n'
    'own_ship: {vessel: 1}\n',
]
OTHER_YAML = [
    '- {name: ahead, kind: guard, range_nm: [2, 3], bearing_deg: [315, 045]}\n'
    '- {name: quay, kind: exclusion, fixed_to: ground, corners_m: [[0, 0], [900, 0], [900, 400]]}',
    '- {topic: x/radar/plots, range_sigma_m: 10.0}\n- {topic: s/plots, name: S, max_range_m: 9e3}',
    'pilot boat:\n  speed_mps: [3, 15]\n  manoeuvres_per_scan: 0.03\n  weave_period_s: [15, 80]\n',
    'range_sigma_m: 12.5\nextent: off\nestimator: imm\nconfirm_hits: 2\n',
    '{"cutoff_m": 60.0, "origin": [55.0, 7.0], "uncooperative": false}',
]
TOKENS = (
    '[ ] { } : , - ? & * ! | > % @ ` # " \' \n \t ~ --- ... << &a *a !!str !!python/none 0777 1:30 '
    '1e999 .nan -.inf 9e307 null true off yes 2001-01-01 \\x00 \ufeff \u2028 \x85 \x00 \ud7ff '
    '0x7f 99999999999999999999999 -1 1e-320'
).split(' ')
NUMBERS = (
    '0 -1 1e308 -1e308 1e-320 nan inf -inf 91 181 -181 360 1e18 9223372036854775808 1_0 0x1f - '
    '1,5 2020-01-01T00:00:00Z 31/12/2015 ٣ 1e999 0.001 5 89.99 1e5 604800'
).split(' ')


def mangled(text: str, rng: random.Random, words=TOKENS) -> str:
    """The text with some of it left out, repeated, moved, or replaced by odd words."""
    if rng.random() < 0.4:  # only numbers
        for _ in range(rng.randrange(1, 4)):
            found = list(re.finditer(r'-?[0-9.]+', text))
            if found:
                one = rng.choice(found)
                text = text[: one.start()] + rng.choice(NUMBERS) + text[one.end() :]
        return text
    for _ in range(rng.choice((1, 1, 2, 3, 8))):
        at = rng.randrange(len(text) + 1)
        to = min(len(text), at + int(rng.expovariate(0.1)))
        part = text[at:to]
        what = rng.randrange(7)
        if what == 0:
            part = ''
        elif what == 1:
            part *= rng.choice((2, 3, 50, 2000))
        elif what == 2:
            part = rng.choice(words) * rng.choice((1, 1, 1, 40, 5000))
        elif what == 3:
            part = ''.join(rng.sample(part, len(part)))
        elif what == 4:
            part += rng.choice(words)
        elif what == 5:
            part = ''.join(
                chr(rng.choice((rng.randrange(128), rng.randrange(0xD7FF)))) for _ in part
            )
        else:
            begin = rng.randrange(len(text) + 1)
            part = text[begin : begin + int(rng.expovariate(0.02))]
        text = (text[:at] + part + text[to:])[:600_000]
    return text


def tree(rng: random.Random, depth: int = 0):
    """A value of lists, mappings and odd scalars, as JSON."""
    if depth > 60 or rng.random() < 0.4:
        return rng.choice((rng.choice(TOKENS), rng.random() * 1e5, rng.randrange(-9, 99), None))
    if rng.random() < 0.5:
        return [tree(rng, depth + 1) for _ in range(rng.randrange(4))]
    keys = 'duration_s targets name start range_nm legs turn kind x'.split()
    return {rng.choice(keys): tree(rng, depth + 1) for _ in range(rng.randrange(4))}


def bomb(rng: random.Random) -> str:
    """Aliases of aliases."""
    lines = ['a0: &a0 [x, x]']
    for k in range(rng.randrange(2, 30)):
        times = rng.randrange(1, 12)
        lines.append(f'a{k + 1}: &a{k + 1} [{", ".join([f"*a{k}"] * times)}]')
    return '\n'.join(lines)


def write(path: Path, text: str) -> None:
    path.write_bytes(text.encode(errors='surrogatepass'))


def yaml_cases(rng: random.Random, folder: Path) -> Iterator[Callable[[], object]]:
    """Scenarios, zones, radars, kinds of vessels, parameters, notes."""
    write(folder / 'ais.csv', ais_rows())
    file = folder / 'case.yaml'
    readers = (
        lambda: zones.parse(text_of(file)),
        lambda: radars_of(TrackerParameters(radars=text_of(file))),
        lambda: custom_traffic.read_kinds(file),
        lambda: from_mapping(TrackerParameters, read_mapping(file)),
        lambda: read_json(file),
    )
    while True:
        what = rng.randrange(10)
        if what == 0:
            text, read = json.dumps(tree(rng)), lambda: scenario.load(file)
        elif what == 1:
            text, read = bomb(rng), lambda: parse(text_of(file), 'it')
        elif what < 6:
            text, read = mangled(rng.choice(SCENARIOS), rng), lambda: scenario.load(file)
        else:
            k = rng.randrange(len(OTHER_YAML))
            text, read = mangled(OTHER_YAML[k], rng), readers[k]
        write(file, text)
        yield read


def text_of(file: Path) -> str:
    """As a parameter of a node would hold it."""
    return file.read_bytes().decode(errors='replace')


def ais_rows() -> str:
    rows = ['time_s,vessel,lat_deg,lon_deg,length_m']
    for time_s in range(0, 90, 5):
        rows.append(f'{time_s},1,54.0,{179.998 + time_s * 1e-5:.6f},90')
        rows.append(f'{time_s},2,54.02,{-179.999 + time_s * 1e-5:.6f},')
    return '\n'.join(rows) + '\n'


def csv_cases(rng: random.Random, folder: Path) -> Iterator[Callable[[], object]]:
    """AIS files, track files, and recordings with one bad table."""
    tables = {
        'plots.csv': 'scan,time_s,range_m,bearing_deg,amplitude_db,radial_speed_mps\n'
        + ''.join(f'{k},{k * 2.5},{900 + k},{k % 360},3,{k % 7}\n' for k in range(40)),
        'own_ship.csv': 'scan,time_s,north_m,east_m,vel_north_mps,vel_east_mps,end_s\n'
        + ''.join(f'{k},{k * 2.5},{k * 5},0,2,0,{k * 2.5 + 2.4}\n' for k in range(40)),
        'truth.csv': 'scan,time_s,target,north_m,east_m,vel_north_mps,vel_east_mps\n'
        + ''.join(f'{k},{k * 2.5},1,{k * 5},900,2,nan\n' for k in range(40)),
    }
    tracks = 'time_s,track,status,north_m,east_m,vel_north_mps,vel_east_mps\n' + ''.join(
        f'{k},7,confirmed,{k},0,1,0\n' for k in range(30)
    )
    for name, text in tables.items():
        write(folder / name, text)
    file = folder / 'case.csv'
    while True:
        kind = rng.randrange(3)
        name = rng.choice(list(tables))
        text = (ais_rows(), tracks, tables[name])[kind]
        if rng.random() < 0.5:
            text = mangled(text, rng, NUMBERS)
        else:  # one cell
            lines = text.split('\n')
            row = rng.randrange(len(lines))
            cells = lines[row].split(',')
            cells[rng.randrange(len(cells))] = rng.choice(NUMBERS)
            lines[row] = ','.join(cells)
            text = '\n'.join(lines)
        target = folder / name if kind == 2 else file
        content = text.encode(rng.choice(('utf-8', 'utf-8-sig', 'utf-16')), errors='replace')
        if rng.random() < 0.2:
            content = bytes(rng.randrange(256) if rng.random() < 0.01 else b for b in content)
        target.write_bytes(content)
        yield (
            lambda: ais_file.read(file, 0.0, 60.0, 30.0),
            lambda: track_file.read(file),
            lambda: screened.read(folder),
        )[kind]
        if kind == 2:
            write(folder / name, tables[name])


def weight_cases(rng: random.Random, folder: Path) -> Iterator[Callable[[], object]]:
    """Files of weights: bytes, headers and manifests changed."""
    file = folder / 'case.npz'
    small, large = rough_weights.shipped('rough').read_bytes(), gwnn_weights.shipped('ship')
    arrays, manifest = weight_file.read(
        rough_weights.shipped('rough'), 'rough', '', rough_weights.FORMAT, rough_weights.NAMES
    )
    with np.load(large) as found:
        deep = dict(found)

    def rough():
        return rough_weights.load(file, 'rough')

    def gwnn():
        return gwnn_weights.load(file, deep['fusion_centre'].size, {'fusion': 8, 'spread': 4})

    while True:
        what = rng.randrange(4)
        if what == 0:
            content = bytearray(rng.choice((small, large.read_bytes())))
            for _ in range(rng.choice((1, 3, 30))):
                content[rng.randrange(len(content))] = rng.randrange(256)
            file.write_bytes(content[: rng.choice((len(content), rng.randrange(len(content))))])
            yield rng.choice((rough, gwnn))
        elif what == 1:  # headers in an archive that is whole
            import zipfile

            header = "{'descr': '<f4', 'fortran_order': False, 'shape': (3,), }"
            with zipfile.ZipFile(file, 'w', zipfile.ZIP_DEFLATED) as archive:
                for name in ('manifest', *rough_weights.NAMES):
                    head = mangled(header, rng, [*TOKENS, '99999999', '<U9', '|O', '(', ')'])
                    head = head[:60_000].encode(errors='replace')[:65_000]
                    begin = b'\x93NUMPY\x01\x00' + len(head).to_bytes(2, 'little')
                    archive.writestr(f'{name}.npy', begin + head + bytes(rng.randrange(64)))
            yield rough
        else:
            told = json.dumps(manifest)
            changed = np.array(mangled(told, rng)[:50_000].replace('\x00', ' '))
            if what == 2:
                np.savez(file, manifest=changed, **arrays)
                yield rough
            else:
                told = mangled(str(deep['manifest']), rng)[:50_000].replace('\x00', ' ')
                np.savez(file, **{**deep, 'manifest': np.array(told)})
                yield gwnn


def cloud_cases(rng: random.Random, folder: Path) -> Iterator[Callable[[], object]]:
    """Clouds of plots as a driver might send them."""
    from sensor_msgs.msg import PointCloud2, PointField

    from marine_tracker.nodes import convert
    from marine_tracker.tracking import intake

    whole = (0, 1, 3, 7, 8, 16, 255, 2**16, 2**31, 2**32 - 1)

    def few(usual, odd):
        return rng.choice(odd) if rng.random() < 0.02 else usual

    while True:
        message = PointCloud2()
        count = rng.randrange(30)
        for k, name in enumerate(convert.PLOT_FIELDS):
            field = PointField()
            field.name = few(name, ('', 'x', 'radial_speed', 'y' * 1000, 'é'))
            field.offset = few(4 * k, whole)
            field.datatype = few(7, tuple(range(0, 20)) + (255,))
            field.count = few(1, whole)
            if rng.random() > 0.03:
                message.fields.append(field)
        message.height = few(1, whole)
        message.width = few(count, whole)
        message.point_step = few(4 * len(convert.PLOT_FIELDS), whole)
        message.row_step = few(message.point_step * count % 2**32, whole)
        message.is_bigendian = few(False, (True,))
        message.header.stamp.sec = few(5, (-(2**31), 2**31 - 1))
        message.header.stamp.nanosec = few(5, (2**32 - 1, 10**9))
        message.data = bytes(few(28 * count, (0, 1, 28, 4096)) and rng.randbytes(28 * count))

        def read(message=message):
            try:
                plots = convert.cloud_to_plots(message)
            except convert.ConversionError as error:
                raise ValueError(str(error)) from error
            return intake.screen_plots(plots, 2.5, 10_000)

        yield read


def odometry_cases(rng: random.Random, folder: Path) -> Iterator[Callable[[], object]]:
    """Own ship as a driver might tell it."""
    from nav_msgs.msg import Odometry

    from marine_tracker.nodes import convert

    odd = (0.0, -0.0, 1e308, -1e308, 5e-324, float('nan'), float('inf'), -float('inf'))

    def number():
        return rng.choice(odd) if rng.random() < 0.3 else rng.gauss(0, 100)

    while True:
        message = Odometry()
        for part, names in (
            (message.pose.pose.position, 'xyz'),
            (message.pose.pose.orientation, 'xyzw'),
            (message.twist.twist.linear, 'xyz'),
            (message.twist.twist.angular, 'xyz'),
        ):
            for name in names:
                setattr(part, name, number())
        message.header.stamp.nanosec = rng.choice((0, 10**9, 2**32 - 1))
        yield lambda message=message: (
            convert.odometry_to_own_ship(message),
            convert.yaw_of(message.pose.pose.orientation),
        )


KINDS = {
    'yaml': (yaml_cases, 20_000),
    'csv': (csv_cases, 5_000),
    'weights': (weight_cases, 1_000),
    'clouds': (cloud_cases, 10_000),
    'odometry': (odometry_cases, 10_000),
}


def verdict(read: Callable[[], object]) -> tuple[str, float]:
    """What is wrong ('' where it gave a value, '-' where one clear line), and s that it took."""
    began = time.process_time()
    try:
        read()
        said = ''
    except ValueError as error:
        text = str(error)
        said = '-'
        if '\n' in text or len(text) > LONGEST_LINE or not text:
            said = f'not one line: {text[:3000]!r}'
    except BaseException:
        said = traceback.format_exc()
    took = time.process_time() - began
    return (f'{took:.2f} s' if took > SLOWEST_S else said), took


def main(kind: str, count: int, seed: int) -> int:
    """Run the cases; 1 where one failed."""
    warnings.simplefilter('ignore')
    rng = random.Random(f'{kind} {seed}')
    make = KINDS[kind][0]
    at_start = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    with open('/proc/self/statm') as file:
        size = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + MOST_BYTES, hard))
    refused, failed, slowest = 0, 0, 0.0
    with tempfile.TemporaryDirectory() as work:
        cases = make(rng, Path(work))
        for number in range(count):
            said, took = verdict(next(cases))
            slowest = max(slowest, took)
            refused += said == '-'
            if said not in ('', '-'):
                failed += 1
                print(f'{kind} case {number}: {said}', file=sys.stderr)
                if failed <= 20:
                    shutil.copytree(work, f'fuzz_{kind}_{number}', dirs_exist_ok=True)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 - at_start
    figures = {
        'kind': kind,
        'cases': count,
        'refused': refused,
        'failed': failed,
        'slowest_s': round(slowest, 3),
        'grown_mb': round(grown / 2**20, 1),
    }
    print(json.dumps(figures))
    return 1 if failed or grown > MOST_BYTES else 0


if __name__ == '__main__':
    os.chdir(os.environ.get('FUZZ_FOLDER', '.'))
    asked = sys.argv[1]
    sys.exit(
        main(asked, int((sys.argv[2:] or [KINDS[asked][1]])[0]), int((sys.argv[3:] or [1])[0]))
    )
