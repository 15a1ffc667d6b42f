"""MCAP files: always whole, read when cut, in order, without knowing ROS."""

import os
import random
import struct
import subprocess
import sys
import textwrap
from pathlib import Path

import psutil
import pytest

pytest.importorskip('mcap_ros2', reason='the extra `record` is not installed')
from mcap.writer import Writer

from marine_tracker import cli
from marine_tracker.recording.mcap_read import McapFiles
from marine_tracker.recording.mcap_write import McapLog, Message, NoRoomError, Topic

SECOND = 1_000_000_000
BEGIN = 1_600_000_000 * SECOND
PAIR = (
    'std_msgs/Header header\nint32 number\n'
    + '=' * 80
    + (
        '\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n'
        + '=' * 80
        + '\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n'
    )
)
NUMBERS = Topic('/numbers', 'own_msgs/msg/Pair', PAIR, '', False)
STATE = Topic('/state', 'std_msgs/msg/UInt32', 'uint32 data', '', True)


def number(k, at, topic=NUMBERS, filling=b'sea'):
    """A message of a header with a frame and a number."""
    text = filling + b'\0'
    data = struct.pack('<IiII', 0x100, k, 7, len(text)) + text
    data += b'\0' * (-len(data) % 4) + struct.pack('<i', k)
    return Message(topic, at, at - 3, data)


def state(k, at):
    return Message(STATE, at, at - 5, struct.pack('<II', 0x100, k))


def values(files, topic='/numbers'):
    return [files.decode(one).number for one in files.messages([topic])]


def recorded(folder, seconds=12, per_second=5, **options):
    """A folder with `seconds` flushes."""
    log = McapLog(folder, **{'split_bytes': 1 << 30, 'keep_free': 0, **options})
    for k in range(seconds):
        log.write(
            number(k * per_second + i, BEGIN + k * SECOND + i * SECOND // per_second)
            for i in range(per_second)
        )
        log.flush()
    return log


def test_what_was_written_is_read_by_us_by_rosbags_and_by_mcap(tmp_path):
    recorded(tmp_path / 'night').close()
    files = McapFiles(tmp_path / 'night')
    assert values(files) == list(range(60)) and not files.remarks
    assert files.topics['/numbers'][:2] == ('own_msgs/msg/Pair', 60)
    first = next(files.messages())
    assert first == ('/numbers', BEGIN, BEGIN - 3, number(0, BEGIN).data)
    assert files.decode(first).header.frame_id == 'sea'

    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    with open(tmp_path / 'night' / 'night_0.mcap', 'rb') as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        assert [one.decoded_message.number for one in reader.iter_decoded_messages()] == (
            list(range(60))
        )
        assert reader.get_header().profile == 'ros2'
    from rosbags.rosbag2 import Reader

    with Reader(tmp_path / 'night') as bag:
        assert bag.message_count == 60 and bag.duration > 11 * SECOND
        assert [raw for _, _, raw in bag.messages()] == [one.data for one in files.messages()]


@pytest.mark.parametrize('compression', ['zstd', 'lz4', 'none'])
def test_a_file_cut_anywhere_is_read_up_to_its_last_whole_chunk(tmp_path, compression):
    log = recorded(tmp_path / 'cut', compression=compression)
    whole = Path(log.files[0]).read_bytes()  # not closed: as a killed process leaves it
    log.close()
    rng = random.Random(8)
    cut = tmp_path / 'cut.mcap'
    lost = set()
    for size in sorted(rng.sample(range(60, len(whole)), 40)):
        cut.write_bytes(whole[:size])
        try:
            files = McapFiles(cut)
        except ValueError as error:
            assert 'cut before its first whole chunk' in str(error)
            continue
        found = values(files)
        assert found == list(range(len(found))) and len(found) % 5 == 0
        (remark,) = files.remarks
        assert 'was cut' in remark or 'was not closed' in remark
        assert f'read up to {(BEGIN // SECOND) + len(found) / 5 - 0.2:.3f} s' in remark
        lost.add('1.0 s after it are lost' in remark)
    assert lost == {True, False}
    cut.write_bytes(whole + bytes(70_000))  # room that was taken and not used
    assert values(McapFiles(cut)) == list(range(60))


def test_a_damaged_chunk_is_left_out_and_told(tmp_path):
    recorded(tmp_path / 'one').close()
    path = tmp_path / 'one' / 'one_0.mcap'
    data = bytearray(path.read_bytes())
    at = data.index(b'\x06', len(data) // 3)
    data[len(data) // 3 : len(data) // 3 + 6] = b'\xff' * 6
    path.write_bytes(data)
    files = McapFiles(path)
    found = values(files)
    assert at and 40 <= len(found) < 60 and sorted(set(found)) == found
    assert any('damaged chunk of 0.8 s' in remark for remark in files.remarks)


def test_each_file_of_a_split_plays_alone_and_nothing_comes_twice_in_all_of_them(tmp_path):
    log = McapLog(tmp_path / 'split', split_bytes=6_000, keep_free=0, compression='none')
    log.settings({'tracker': '{"estimator": "imm"}'})
    log.write([state(41, BEGIN)])
    for k in range(60):
        log.write([number(k, BEGIN + k * SECOND, filling=b'x' * 700)])
        log.flush()
        if k == 30:
            log.write([state(42, BEGIN + k * SECOND + 7)])
    log.close()
    assert len(log.files) > 5
    together = McapFiles(tmp_path / 'split')
    assert values(together) == list(range(60))
    assert [together.decode(one).data for one in together.messages(['/state'])] == [41, 42]
    for path in log.files:
        alone = McapFiles(path)
        first, *others = [alone.decode(one).data for one in alone.messages(['/state'])]
        assert first in (41, 42) and len(others) <= 1
        begin = next(alone.messages()).log_ns
        assert next(alone.messages(['/state'])).log_ns == begin
        assert alone.settings == {'tracker': '{"estimator": "imm"}'}
    from rosbags.rosbag2 import Reader

    with Reader(tmp_path / 'split') as bag:
        assert sum(c.topic == '/numbers' for c, _, _ in bag.messages()) == 60


def test_messages_out_of_order_come_in_order_with_little_memory_and_twice_the_same(tmp_path):
    """Each chunk reaches over the whole time: a merge of them all would hold the file."""
    rng = random.Random(3)
    log = McapLog(tmp_path / 'wild', 1 << 40, 0)
    filling = random.Random(4).randbytes(40_000)
    count = 0
    for _ in range(120):
        times = [BEGIN + rng.randrange(500) * SECOND for _ in range(20)]
        log.write([number(count + i, at, filling=filling) for i, at in enumerate(times)])
        log.flush()
        count += 20
    log.close()
    process = psutil.Process()

    def read():
        files = McapFiles(tmp_path / 'wild')
        most, order = 0, []
        for one in files.messages():
            order.append((one.log_ns, struct.unpack('<i', one.data[-4:])[0]))
            if len(order) % 400 == 0:
                most = max(most, process.memory_info().rss)
        return order, most

    before = process.memory_info().rss
    first, most = read()
    assert first == read()[0] and len(first) == count
    assert first == sorted(first)  # of one time in the order of the file
    assert most - before < 70 << 20 < 120 * 20 * 40_000


def test_a_channel_without_a_type_is_left_out_by_name_and_the_rest_is_read(tmp_path):
    path = tmp_path / 'mixed.mcap'
    with open(path, 'wb') as file:
        writer = Writer(file)
        writer.start('ros2')
        schema = writer.register_schema('own_msgs/msg/Pair', 'ros2msg', PAIR.encode())
        good = writer.register_channel('/numbers', 'cdr', schema)
        bare = writer.register_channel('/secret', 'cdr', 0)
        odd = writer.register_channel(
            '/odd', 'cdr', writer.register_schema('x/msg/Y', 'ros2msg', b'\xff[[ not a type')
        )
        for k in range(4):
            at = BEGIN + k * SECOND
            writer.add_message(good, at, number(k, at).data, at)
            writer.add_message(bare, at, b'\0\1\2', at)
            writer.add_message(odd, at, b'\0\1\2', at)
        writer.add_message(good, BEGIN + 9 * SECOND, b'\0\1\0\0\1', 0)  # too short
        writer.finish()
    files = McapFiles(path)
    found = [content.number for _, content in files.decoded(['/numbers', '/secret', '/odd'])]
    assert found == [0, 1, 2, 3]
    told = '\n'.join(files.remarks)
    assert '/secret: 4 messages left out: no definition of its type' in told
    assert '/odd: 4 messages left out' in told and '/numbers: 1 messages left out' in told


def test_a_repaired_file_is_whole_and_like_what_can_be_read(tmp_path, capsys):
    log = recorded(tmp_path / 'night')
    cut = tmp_path / 'cut.mcap'
    cut.write_bytes(Path(log.files[0]).read_bytes()[:-40])
    log.close()
    assert cli.main(['recording', 'repair', str(cut), '--out', str(tmp_path / 'new')]) == 0
    assert 'lost' in capsys.readouterr().out
    copy, before = McapFiles(tmp_path / 'new'), McapFiles(cut)
    assert copy.topics == before.topics and not copy.remarks
    assert list(copy.messages()) == list(before.messages())
    assert cli.main(['recording', 'show', str(tmp_path / 'new')]) == 0
    assert 'own_msgs/msg/Pair' in capsys.readouterr().out
    assert cli.main(['recording', 'repair', str(cut), '--out', str(tmp_path / 'new')]) == 2
    assert 'has a recording already' in capsys.readouterr().err


def test_a_repair_that_loses_messages_fails(tmp_path, monkeypatch, capsys):
    recorded(tmp_path / 'night').close()
    write = McapLog.write
    monkeypatch.setattr(McapLog, 'write', lambda self, some: write(self, list(some)[:-1]))
    assert (
        cli.main(['recording', 'repair', str(tmp_path / 'night'), '--out', str(tmp_path / 'b')])
        == 2
    )
    assert 'is not like' in capsys.readouterr().err


@pytest.mark.parametrize('content', [b'', b'\x89MCAP0\r\n', b'scan,time_s\n1,2\n', bytes(4000)])
def test_what_is_no_mcap_file_is_refused_in_one_line(tmp_path, capsys, content):
    path = tmp_path / 'x.mcap'
    path.write_bytes(content)
    assert cli.main(['recording', 'show', str(path)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert 'x.mcap' in line


def test_a_limit_of_free_space_ends_the_recording_whole(tmp_path):
    log = recorded(tmp_path / 'full', seconds=3)
    log._keep_free = 1 << 60
    log.write([number(15, BEGIN + 3 * SECOND)])
    with pytest.raises(NoRoomError, match='MB must stay so'):
        log.flush()
    files = McapFiles(tmp_path / 'full')
    assert values(files) == list(range(16)) and not files.remarks


FILLS = """
    import sys
    sys.path.insert(0, {here!r})
    from test_mcap import BEGIN, SECOND, number
    from marine_tracker.recording.mcap_write import McapLog, NoRoomError
    import random
    log = McapLog({folder!r}, {split}, 0)
    for k in range(3000):
        try:
            log.write([number(k, BEGIN + k * SECOND, filling=random.randbytes(30_000))])
            log.flush()
        except NoRoomError as error:
            print(k, error)
            break
"""


@pytest.mark.parametrize('split', [1 << 40, 1 << 20])
def test_a_full_disk_ends_the_recording_with_whole_files(tmp_path, split):
    """On a disk of 12 MB of its own."""
    if subprocess.run(['unshare', '-m', 'true'], capture_output=True).returncode:
        pytest.skip('no mount namespace of our own: unshare -m fails here')
    disk, copy = tmp_path / 'disk', tmp_path / 'copy'
    disk.mkdir()
    program = tmp_path / 'fills.py'
    here = Path(__file__).parent
    program.write_text(
        textwrap.dedent(FILLS.format(here=str(here), folder=str(disk / 'r'), split=split))
    )
    script = 'mount -t tmpfs -o size=12m none "$1" && "$2" "$3" && cp -r "$1/r" "$4"'
    root = here.parents[1]
    run = subprocess.run(
        ['unshare', '-m', 'sh', '-c', script, 'sh', disk, sys.executable, program, copy],
        capture_output=True,
        text=True,
        env={**os.environ, 'PYTHONPATH': str(root)},
    )
    assert run.returncode == 0, run.stderr
    assert 'No space left on device' in run.stdout
    written = int(run.stdout.split()[0])
    assert written > 200
    files = McapFiles(copy)
    found = [struct.unpack('<i', one.data[-4:])[0] for one in files.messages()]
    assert not files.remarks
    assert found == list(range(len(found))) and len(found) >= written
    assert (len(files.paths) > 3) == (split < 1 << 30)
