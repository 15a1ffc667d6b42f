"""Messages of ROS topics from MCAP files, whole or cut.

A file that was cut (a machine without power, a process killed) is read up to its last whole chunk;
what is lost is told. Messages come in the order of their log times, those of one time in the order
of the file, with little memory however far out of order the file is: a chunk is read again if it
has to be. Two reads give the same.
"""

import heapq
import io
import re
import struct
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Header, Metadata, Schema
from mcap.stream_reader import StreamReader, get_chunk_data_stream
from mcap_ros2.decoder import DecoderFactory

from ..files import Place, regular
from .mcap_write import REPEATED, SETTINGS, Topic

RECORD = 256 << 20  # bytes: the greatest record, and chunk, that is read
HELD_CHUNKS = 32  # chunks kept unpacked
MESSAGE = struct.Struct('<BQHIQQ')  # opcode, length, channel, sequence, log and publish time
HEAD = struct.Struct('<BQ')


class Message(NamedTuple):
    """One message of a file; times in ns, data in CDR."""

    topic: str
    log_ns: int
    publish_ns: int
    data: bytes


class TopicInfo(NamedTuple):
    """What a file holds of a topic: type, number of messages, and times of the first and last."""

    kind: str
    messages: int
    first_ns: int
    last_ns: int


class _Part(NamedTuple):
    """A chunk: file and offset, the times of its messages, and its place among all."""

    start: int
    place: int
    end: int
    file: int
    offset: int
    length: int


class McapFiles:
    """One or several files of one recording, read as one.

    path      a file, or a folder of them, in the order of the numbers in their names
    topics    by name
    remarks   what people should know: files cut, chunks damaged
    settings  what the recorder kept beside the messages, as it was first

    ValueError if there is no such file, or nothing in it can be read.
    """

    def __init__(self, path: Place) -> None:
        path = Path(path)
        self.paths = sorted(path.glob('*.mcap'), key=_number) if path.is_dir() else [path]
        if not self.paths:
            raise ValueError(f'{path} has no files *.mcap')
        self.topics: dict[str, TopicInfo] = {}
        self.settings: dict[str, str] = {}
        self._remarks: list[str] = []
        self._left_out: Counter[tuple[str, str]] = Counter()
        self._schemas: list[dict[int, Schema]] = []
        self._channels: list[dict[int, Channel]] = []
        self._parts: list[_Part] = []
        self._data = lru_cache(maxsize=HELD_CHUNKS)(self._unpack)
        self._decoders: dict[str, Callable[[bytes], Any]] = {}
        for number in range(len(self.paths)):
            self._look(number)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Of the files in their order, then of topics that were read so far."""
        left_out = [
            f'{topic}: {count} messages left out: {reason}'
            for (topic, reason), count in self._left_out.items()
        ]
        return (*self._remarks, *left_out)

    def messages(self, topics: Sequence[str] | None = None) -> Iterator[Message]:
        """Those of the topics, or all, by log time."""
        parts = sorted(self._parts)
        heap: list[tuple[int, int, int]] = []  # log time, place of the chunk, offset in it
        offsets: dict[int, list[tuple[int, int]]] = {}  # of a chunk, sorted, the next at the end
        of_place = {part.place: part for part in parts}
        wanted = None if topics is None else set(topics)
        ahead = 0
        while heap or ahead < len(parts):
            while ahead < len(parts) and (not heap or parts[ahead].start <= heap[0][0]):
                part = parts[ahead]
                rows = sorted(self._rows(part, wanted), reverse=True)
                if rows:
                    heapq.heappush(heap, (rows[-1][0], part.place, rows[-1][1]))
                    offsets[part.place] = rows
                ahead += 1
            if not heap:
                continue
            _, place, offset = heapq.heappop(heap)
            part, rows = of_place[place], offsets[place]
            yield self._message(part, offset)
            rows.pop()
            if rows:
                heapq.heappush(heap, (rows[-1][0], place, rows[-1][1]))
            else:
                del offsets[place]

    def topic(self, name: str) -> Topic:
        """What a new file has to know of a topic of these."""
        kind = self.topics[name].kind
        for schemas, channels in zip(self._schemas, self._channels):
            for channel in channels.values():
                if channel.topic == name:
                    qos = channel.metadata.get('offered_qos_profiles', '')
                    schema = schemas.get(channel.schema_id)
                    text = schema.data.decode() if schema else ''
                    return Topic(name, kind, text, qos, False)
        return Topic(name, kind, '', '', False)

    def decode(self, message: Message) -> Any:
        """The message as an object with its fields. ValueError names a topic without a type."""
        decoder = self._decoders.get(message.topic)
        if decoder is None:
            decoder = self._decoders[message.topic] = self._decoder(message.topic)
        try:
            return decoder(message.data)
        except (ValueError, IndexError, struct.error, UnicodeDecodeError, MemoryError) as error:
            raise ValueError(f'{message.topic}: {error}') from error

    def decoded(self, topics: Sequence[str]) -> Iterator[tuple[Message, Any]]:
        """The messages of topics as objects; those that cannot be decoded are left out, and told
        in the remarks."""
        for message in self.messages(topics):
            try:
                yield message, self.decode(message)
            except ValueError as error:
                self._left_out[message.topic, str(error).partition(': ')[2][:200]] += 1

    def _decoder(self, topic: str) -> Callable[[bytes], Any]:
        for schemas, channels in zip(self._schemas, self._channels):
            for channel in channels.values():
                schema = schemas.get(channel.schema_id)
                if channel.topic != topic or schema is None:
                    continue
                try:
                    found = DecoderFactory().decoder_for(channel.message_encoding, schema)
                except Exception as error:  # a definition of somebody else, of any form
                    raise ValueError(f'{topic}: the definition of its type: {error}') from error
                if found is not None:
                    return found
        raise ValueError(f'{topic}: no definition of its type in the file')

    # -- one look at each file ------------------------------------------------------------------

    def _look(self, number: int) -> None:
        path = self.paths[number]
        self._schemas.append({})
        self._channels.append({})
        before, whole, last = len(self._parts), False, 0
        with open(regular(path), 'rb') as file:
            reader = StreamReader(file, emit_chunks=True, record_size_limit=RECORD)
            begun = 0
            try:
                for record in reader.records:
                    if isinstance(record, Header):
                        begun = file.tell()
                    elif isinstance(record, Chunk):
                        last = max(last, self._take(number, record, file.tell()))
                    elif isinstance(record, Schema):
                        self._schemas[number][record.id] = record
                    elif isinstance(record, Channel):
                        self._channels[number][record.id] = record
                    elif isinstance(record, Metadata) and record.name == SETTINGS:
                        self.settings = {**record.metadata, **self.settings}  # the first count
                whole = True
            except (McapError, ValueError, struct.error, EOFError, MemoryError) as error:
                if not begun:
                    raise ValueError(f'{path} is not an MCAP file: {error}') from None
            if not whole:
                self._remarks.append(f'{path}: {self._what_is_lost(file, last)}')
        if len(self._parts) == before and not whole and len(self.paths) == 1:
            raise ValueError(f'{path} was cut before its first whole chunk: nothing can be read')

    def _take(self, number: int, chunk: Chunk, end: int) -> int:
        """A whole chunk, which ends at the byte `end`; the log time of its last message."""
        length = 9 + 40 + len(chunk.compression) + len(chunk.data)
        try:
            data = _unpacked(chunk)
        except ValueError as error:
            seconds = (chunk.message_end_time - chunk.message_start_time) * 1e-9
            self._remarks.append(
                f'{self.paths[number]}: a damaged chunk of {seconds:.1f} s is left out: {error}'
            )
            return 0
        times: list[int] = []
        for opcode, offset, size in _records(data):
            if opcode == Opcode.SCHEMA:
                schema = Schema.read(_stream(data, offset, size))
                self._schemas[number][schema.id] = schema
            elif opcode == Opcode.CHANNEL:
                channel = Channel.read(_stream(data, offset, size))
                self._channels[number][channel.id] = channel
            elif opcode == Opcode.MESSAGE and size >= 22:
                _, _, channel_id, _, log_ns, _ = MESSAGE.unpack_from(data, offset - 9)
                if self._name(number, channel_id) is not None:
                    times.append(log_ns)
                    self._count(number, channel_id, log_ns)
        if times:
            self._parts.append(
                _Part(min(times), len(self._parts), max(times), number, end - length, length)
            )
        return max(times, default=0)

    def _name(self, number: int, channel_id: int) -> str | None:
        """The topic; None for an unknown channel, and for what the file before has had."""
        channel = self._channels[number].get(channel_id)
        if channel is None or (number and REPEATED in channel.metadata):
            return None
        return channel.topic

    def _count(self, number: int, channel_id: int, log_ns: int) -> None:
        channel = self._channels[number][channel_id]
        schema = self._schemas[number].get(channel.schema_id)
        before = self.topics.get(channel.topic)
        if before is None:
            before = TopicInfo(schema.name if schema else '', 0, log_ns, log_ns)
        self.topics[channel.topic] = TopicInfo(
            before.kind,
            before.messages + 1,
            min(before.first_ns, log_ns),
            max(before.last_ns, log_ns),
        )

    def _what_is_lost(self, file: Any, last: int) -> str:
        """In words, of a file that ends too early; its last chunk may tell how long it was."""
        until = f'read up to {last * 1e-9:.3f} s' if last else 'nothing can be read'
        end = self._parts[-1] if self._parts else None
        file.seek(end.offset + end.length if end and end.file == len(self._channels) - 1 else 0)
        tail = file.read(1 << 20)
        at = 0
        while at + HEAD.size <= len(tail):
            opcode, length = HEAD.unpack_from(tail, at)
            if opcode == Opcode.CHUNK and at + HEAD.size + 16 <= len(tail):
                start, stop = struct.unpack_from('<QQ', tail, at + HEAD.size)
                seconds = (stop - (last or start)) * 1e-9
                return f'was cut; {until}, {seconds:.1f} s after it are lost'
            at += HEAD.size + length
        return f'was not closed; {until}, up to a second after it may be lost'

    # -- messages -------------------------------------------------------------------------------

    def _unpack(self, part: _Part) -> bytes:
        with open(self.paths[part.file], 'rb') as file:
            file.seek(part.offset)
            reader = StreamReader(file, skip_magic=True, emit_chunks=True, record_size_limit=RECORD)
            chunk = next(iter(reader.records))
        if not isinstance(chunk, Chunk):
            raise ValueError(f'{self.paths[part.file]} was changed while it was read')
        return _unpacked(chunk)

    def _rows(self, part: _Part, wanted: set[str] | None) -> Iterator[tuple[int, int]]:
        """Log time and offset of the chunk's messages of the topics wanted."""
        names = {number: self._name(part.file, number) for number in self._channels[part.file]}
        data = self._data(part)
        for opcode, offset, size in _records(data):
            if opcode == Opcode.MESSAGE and size >= 22:
                _, _, channel_id, _, log_ns, _ = MESSAGE.unpack_from(data, offset - 9)
                name = names.get(channel_id)
                if name is not None and (wanted is None or name in wanted):
                    yield log_ns, offset

    def _message(self, part: _Part, offset: int) -> Message:
        data = self._data(part)
        _, size, channel_id, _, log_ns, publish_ns = MESSAGE.unpack_from(data, offset - 9)
        topic = self._channels[part.file][channel_id].topic
        return Message(topic, log_ns, publish_ns, data[offset + 22 : offset + size])


def _number(path: Path) -> tuple[int, str]:
    found = re.search(r'_(\d+)\.mcap$', path.name)
    return (int(found[1]) if found else -1), path.name


def _unpacked(chunk: Chunk) -> bytes:
    if chunk.uncompressed_size > RECORD:
        raise ValueError(f'{chunk.uncompressed_size} bytes; it may have {RECORD}')
    try:
        stream, length = get_chunk_data_stream(chunk, validate_crc=True)
        return stream.read(length)
    except Exception as error:  # each packer has errors of its own
        raise ValueError(str(error)) from error


def _records(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Opcode, offset of the content and its length, of each record in a chunk."""
    at = 0
    while at + HEAD.size <= len(data):
        opcode, length = HEAD.unpack_from(data, at)
        at += HEAD.size
        if at + length > len(data):
            return
        yield opcode, at, length
        at += length


def _stream(data: bytes, offset: int, size: int) -> Any:
    return ReadDataStream(io.BytesIO(data[offset : offset + size]))
