"""Messages of ROS topics into MCAP files: split by size, on disk at each `flush`, always whole.

The format is that of `ros2 bag record`: profile ros2, CDR messages, definitions of the types in the
file. A folder holds NAME_0.mcap, NAME_1.mcap, ... and metadata.yaml, so it is a bag for rosbag2.

Each file plays alone: it begins with the last message of every latched topic. That channel is
marked `repeated`, for a reader that comes from the file before has had the message.

Room on the disk is taken before each write, and some is held for the end of the file. So a full
disk ends the recording, and never leaves a broken file.
"""

import contextlib
import json
import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, cast

from mcap.writer import CompressionType, Writer

from ..files import Place, write_text

COMPRESSION = {
    'zstd': CompressionType.ZSTD,
    'lz4': CompressionType.LZ4,
    'none': CompressionType.NONE,
}
SETTINGS = 'marine_tracker'  # name of the metadata that hold parameters
REPEATED = 'repeated'  # key in the metadata of a channel
HELD = 4 << 20  # bytes held back for the index at a file's end ...
MOST_CHUNKS = 6000  # ... of so many chunks
CHUNK = 4 << 20  # bytes of messages, at most
SPARE = 1 << 16  # bytes that a chunk takes beside its messages, and more


class Topic(NamedTuple):
    """What a file has to know of a topic.

    kind        as sensor_msgs/msg/PointCloud2
    definition  the type's text, with those that it is made of; '' if it is not known
    qos         as rosbag2 writes it, YAML
    """

    name: str
    kind: str
    definition: str
    qos: str
    latched: bool


class Message(NamedTuple):
    """One message: times in ns, when it came and when it was sent; data in CDR."""

    topic: Topic
    log_ns: int
    publish_ns: int
    data: bytes


class NoRoomError(OSError):
    """The recording has ended since there is no room, or no way to write."""


class _Disk:
    """The stream that a Writer wants; every byte is written, or OSError is raised."""

    def __init__(self, path: Path) -> None:
        self.fd = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o644)
        self.place = 0

    def write(self, data: bytes) -> int:
        view = memoryview(data)
        while view:
            count = os.write(self.fd, view)
            view, self.place = view[count:], self.place + count
        return len(data)

    def tell(self) -> int:
        return self.place

    def flush(self) -> None:
        """Nothing waits here."""


class _File:
    """One file that is being written."""

    def __init__(self, path: Path, compression: str) -> None:
        self.path = path
        self._disk = _Disk(path)
        self._held = path.with_name(f'.{path.name}.held')
        try:
            self._hold()
            self._writer = Writer(
                cast(Any, self._disk), chunk_size=1 << 40, compression=COMPRESSION[compression]
            )
            self._writer.start(profile='ros2', library='marine_tracker')
        except OSError:
            self._release()
            os.close(self._disk.fd)
            path.unlink(missing_ok=True)
            raise
        self._schemas: dict[str, int] = {}
        self._channels: dict[tuple[str, bool], int] = {}
        self.counts: dict[Topic, int] = {}
        self.chunks = self._waiting = 0
        self.first_ns, self.last_ns = 0, 0

    @property
    def size(self) -> int:
        return self._disk.place + self._waiting

    def _hold(self) -> None:
        with open(self._held, 'wb') as file:
            os.posix_fallocate(file.fileno(), 0, HELD)

    def _release(self) -> None:
        with contextlib.suppress(OSError):
            self._held.unlink()

    def metadata(self, values: Mapping[str, str]) -> None:
        self._writer.add_metadata(SETTINGS, dict(values))

    def add(self, message: Message, repeated: bool = False) -> None:
        topic = message.topic
        channel = self._channels.get((topic.name, repeated))
        if channel is None:
            channel = self._channel(topic, repeated)
        count = self.counts.get(topic, 0)
        self.counts[topic] = count + 1
        self.first_ns = min(self.first_ns or message.log_ns, message.log_ns)
        self.last_ns = max(self.last_ns, message.log_ns)
        self._waiting += len(message.data) + 64
        self._writer.add_message(channel, message.log_ns, message.data, message.publish_ns, count)
        if self._waiting > CHUNK:
            self.flush()

    def _channel(self, topic: Topic, repeated: bool) -> int:
        schema = 0
        if topic.definition:
            if topic.kind not in self._schemas:
                text = topic.definition.encode()
                self._schemas[topic.kind] = self._writer.register_schema(
                    topic.kind, 'ros2msg', text
                )
                self._waiting += len(text)
            schema = self._schemas[topic.kind]
        about = {'offered_qos_profiles': topic.qos} | ({REPEATED: 'yes'} if repeated else {})
        number = self._writer.register_channel(topic.name, 'cdr', schema, about)
        self._channels[topic.name, repeated] = number
        return number

    def flush(self) -> None:
        """All on disk. OSError where there is no room for it; nothing is written then."""
        if not self._waiting:
            return
        fd, place = self._disk.fd, self._disk.place
        os.posix_fallocate(fd, place, self._waiting + SPARE)
        self._writer.flush()
        os.ftruncate(fd, self._disk.place)
        os.fdatasync(fd)
        self._waiting, self.chunks = 0, self.chunks + 1

    def close(self) -> None:
        """The index at the end, in the room that was held for it."""
        self._release()
        try:
            self._writer.finish()
            os.ftruncate(self._disk.fd, self._disk.place)
            os.fsync(self._disk.fd)
        finally:
            os.close(self._disk.fd)


class McapLog:
    """Writes a folder of files. Not for several threads at once.

    folder       is made; ValueError if it has a recording already
    split_bytes  a new file begins after so many
    keep_free    bytes of the disk that are left to others
    """

    def __init__(
        self, folder: Place, split_bytes: int, keep_free: int, compression: str = 'zstd'
    ) -> None:
        self.folder = Path(folder)
        if self.folder.is_dir() and any(self.folder.glob('*.mcap')):
            raise ValueError(f'{self.folder} has a recording already; name another folder')
        self.folder.mkdir(parents=True, exist_ok=True)
        self._split, self._keep_free, self._compression = split_bytes, keep_free, compression
        self._name = self.folder.resolve().name
        self._latched: dict[str, Message] = {}
        self._settings: dict[str, str] = {}
        self._done: list[_File] = []
        self._file = self._open()

    @property
    def files(self) -> list[Path]:
        """Those written so far, the one that is open as the last."""
        return [file.path for file in (*self._done, self._file)]

    @property
    def size(self) -> int:
        """Bytes on the disk."""
        return sum(file.size for file in (*self._done, self._file))

    def settings(self, values: Mapping[str, str]) -> None:
        """Texts that each file keeps beside its messages."""
        self._settings.update(values)
        self._file.metadata(values)

    def write(self, messages: Iterable[Message]) -> None:
        """Messages in the order of their log_ns; on disk after the next `flush`.

        NoRoomError: there is no room; the file ends whole with what was written before.
        """
        for message in messages:
            if self._file.size > self._split or self._file.chunks > MOST_CHUNKS:
                self._next(message.log_ns)
            if message.topic.latched:
                self._latched[message.topic.name] = message
            with self._ending():
                self._file.add(message)

    def flush(self) -> None:
        """All of it on disk. NoRoomError as above, and where less than keep_free would be left."""
        free = shutil.disk_usage(self.folder).free
        if free < self._keep_free:
            self._stop(f'{free >> 20} MB are free, {self._keep_free >> 20} MB must stay so')
        with self._ending():
            self._file.flush()

    def close(self) -> None:
        """The end of the last file."""
        with contextlib.suppress(OSError):
            self._file.flush()
        self._file.close()
        self._write_index()

    def _open(self) -> _File:
        path = self.folder / f'{self._name}_{len(self._done)}.mcap'
        file = _File(path, self._compression)
        if self._settings:
            file.metadata(self._settings)
        return file

    def _next(self, now_ns: int) -> None:
        with self._ending():
            self._file.flush()
        self._file.close()
        self._done.append(self._file)
        self._write_index()
        try:
            self._file = self._open()
        except OSError as error:
            self._file = self._done.pop()
            raise NoRoomError(f'no further file: {error.strerror}') from error
        for message in self._latched.values():
            self._file.add(message._replace(log_ns=now_ns), repeated=True)

    @contextlib.contextmanager
    def _ending(self):
        try:
            yield
        except OSError as error:
            self._stop(error.strerror or str(error))

    def _stop(self, reason: str) -> None:
        self._file.close()
        with contextlib.suppress(OSError):
            self._write_index()
        raise NoRoomError(f'{self._file.path}: {reason}')

    def _write_index(self) -> None:
        """metadata.yaml, by which rosbag2 knows the folder. JSON is YAML as well."""
        files = [file for file in (*self._done, self._file) if file.last_ns]
        counts: dict[Topic, int] = {}
        for file in files:
            for topic, count in file.counts.items():
                counts[topic] = counts.get(topic, 0) + count

        def about(parts: list[_File]) -> dict[str, object]:
            first = min((file.first_ns for file in parts), default=0)
            last = max((file.last_ns for file in parts), default=0)
            return {
                'starting_time': {'nanoseconds_since_epoch': first},
                'duration': {'nanoseconds': last - first},
                'message_count': sum(sum(file.counts.values()) for file in parts),
            }

        bag = {
            'version': 8,
            'storage_identifier': 'mcap',
            'relative_file_paths': [file.path.name for file in files],
            **about(files),
            'topics_with_message_count': [
                {
                    'topic_metadata': {
                        'name': topic.name,
                        'type': topic.kind,
                        'serialization_format': 'cdr',
                        'offered_qos_profiles': topic.qos,
                        'type_description_hash': '',
                    },
                    'message_count': count,
                }
                for topic, count in counts.items()
            ],
            'compression_format': '',
            'compression_mode': '',
            'files': [{'path': file.path.name, **about([file])} for file in files],
            'custom_data': {},
            'ros_distro': 'jazzy',
        }
        text = json.dumps({'rosbag2_bagfile_information': bag}, indent=1)
        write_text(self.folder / 'metadata.yaml', text + '\n')
