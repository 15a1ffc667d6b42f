"""AIS sentences as they come, by whatever way, to reports. Nothing is dropped without a count.

A line is `!AIVDM,...` or `!AIVDO,...` (any talker), alone or

    \\s:station,c:1700000000*hh\\!AIVDM,...      after an NMEA tag block: source and time
    12.345 !AIVDM,...                          after the seconds at which it was heard: recordings
    {"class":"AIS","type":1,"mmsi":...}        as gpsd tells it

pyais decodes the payload. A message of several sentences is put together from parts of one source,
channel, number and count that come within seconds, in any order. What comes twice, by two
receivers, counts once.

The moment a place is of: a message tells the second of UTC in which it was measured. It comes a
moment later, by a network ten seconds. Where the time of arrival is UTC, that second tells how late
it is. A time of the sender's (tag block, recording) that is far from the arrival is not believed.
"""

import functools
import json
import math
import operator
import re
from collections import Counter
from collections.abc import Mapping
from typing import Any, NamedTuple

import pyais
from pyais.exceptions import AISBaseException

from . import reports
from .reports import Reports, Row

LONGEST = 1000  # characters of a line; a sentence may have 82, gpsd's lines have more
PARTS_WITHIN = 5.0  # s
MOST_PARTS, MOST_PAYLOADS = 200, 5000  # that are remembered
TWICE_WITHIN = 8.0  # s; a payload tells its second, so the same is the same report
CLOCK_OFF = 60.0  # s, of a sender's clock
EPOCH = 1e8  # s; an arrival after it is Unix time, so UTC
LATEST, EARLY = 20.0, 2.0  # s; a place is at most so late, and a clock at most so slow

SENTENCE = re.compile(
    r'!([A-Z]{2})(VD[MO]),([1-9]),([1-9]),([0-9]?),([AB12]?),([0-W`-w]*),([0-5])\*([0-9A-Fa-f]{2})'
)
TAG_BLOCK = re.compile(r'\\([^\\*]*)\*([0-9A-Fa-f]{2})\\')
SECONDS = re.compile(r'([-+]?\d{1,12}(?:\.\d{1,9})?)[ \t]+(?=[!${\\])')
# Bits that a message must have at least; 24 has two parts, of which the first is the shorter.
LEAST_BITS = {**dict.fromkeys((1, 2, 3, 9, 18), 168), **{5: 420, 19: 312, 21: 272, 24: 160, 27: 96}}

TAKEN, OTHER = 'taken', 'of other things than AIS'
WAITING = 'parts that wait for the others'
NOT_TEXT, TOO_LONG, UNKNOWN = 'that are no text', 'too long', 'of no known form'
CHECKSUM, TAG = 'with a wrong checksum', 'with a wrong tag block'
ALONE, TWICE = 'parts without the others', 'that came twice'
LENGTH, PAYLOAD = 'with too short a payload', 'with a payload that cannot be decoded'
TYPE, BAD_JSON = 'of a type that is not used', 'of gpsd that cannot be read'
OWN, OWN_AS_OTHER, NOT_OWN = (
    'of own ship',
    'of own ship, as of another',
    'of own ship with the number of another',
)
OUTCOMES = (
    *(TAKEN, OTHER, WAITING, NOT_TEXT, TOO_LONG, UNKNOWN, CHECKSUM, TAG, ALONE, TWICE, LENGTH),
    *(PAYLOAD, TYPE, BAD_JSON, OWN, OWN_AS_OTHER, NOT_OWN),
    *(reports.NO_IDENTITY, reports.NO_PLACE),
)
REFUSED = tuple(one for one in OUTCOMES if one not in (TAKEN, OTHER, WAITING, OWN))
CLOCK = 'clocks of senders far off: taken as they came'


class Part(NamedTuple):
    """A sentence of a message of several; heard s."""

    line: str
    heard: float


class Sentences:
    """Takes lines, gives reports; what waits between two lines is kept here.

    own      MMSI of own ship; 0: not known, until her own receiver tells it (VDO)
    outcome  number of lines that came to each of OUTCOMES: together as many as came
    left_out number of values of reports taken that cannot be, and of clocks not believed
    """

    def __init__(self, own: int = 0) -> None:
        self.own = own
        self.outcome: Counter[str] = Counter()
        self.left_out: Counter[str] = Counter()
        self._parts: dict[tuple[str, ...], dict[int, Part]] = {}
        self._payloads: dict[tuple[str, ...], float] = {}
        self._rows: list[Row] = []
        self._own_row: Row | None = None

    @property
    def lines(self) -> int:
        """Number of lines that came."""
        return self.outcome.total()

    def take(self, line: str | bytes, heard: float = math.nan, source: str = '') -> str:
        """A line that was heard at a time, s; nan: as the line itself says. Its outcome."""
        found = self._take(line, heard, source)
        self.outcome[found] += 1
        return found

    def reports(self) -> Reports:
        """Those since the last call."""
        rows, self._rows = self._rows, []
        return reports.table([one for one in rows if one[3] != self.own])

    def own_report(self) -> Reports:
        """What own ship's receiver last sent of her: one row, or none."""
        return reports.table([] if self._own_row is None else [self._own_row])

    # -- lines -----------------------------------------------------------------------------------

    def _take(self, line: str | bytes, heard: float, source: str) -> str:
        if isinstance(line, bytes):
            try:
                line = line.decode('ascii')
            except UnicodeDecodeError:
                return NOT_TEXT
        line = line.strip()
        if len(line) > LONGEST:
            return TOO_LONG
        sent = math.nan
        stamp = SECONDS.match(line)
        if stamp:
            sent, line = float(stamp[1]), line[stamp.end() :]
        if line.startswith('{'):
            return self._take_json(line, self._moment(heard, sent))
        if line.startswith('\\'):
            block = TAG_BLOCK.match(line)
            if not block or _checksum(block[1]) != int(block[2], 16):
                return TAG
            told = dict(one.split(':', 1) for one in block[1].split(',') if ':' in one)
            source += '/' + told.get('s', '')
            sent, line = unix_time(told.get('c', ''), sent), line[block.end() :]
        if line.startswith('$') or (line.startswith('!') and line[3:6] not in ('VDM', 'VDO')):
            return OTHER
        found = SENTENCE.fullmatch(line)
        if not found:
            return UNKNOWN
        if _checksum(line[1:-3]) != int(found[9], 16):
            return CHECKSUM
        return self._take_sentence(found, line, self._moment(heard, sent), source)

    def _moment(self, heard: float, sent: float) -> float:
        """When the line was heard, s."""
        if math.isnan(heard) or math.isnan(sent):
            return sent if math.isnan(heard) else heard
        if abs(sent - heard) <= CLOCK_OFF:
            return sent
        self.left_out[CLOCK] += 1
        return heard

    def _take_sentence(self, found: re.Match[str], line: str, heard: float, source: str) -> str:
        _, kind, count, number, message, channel, payload, _, _ = found.groups()
        if int(number) > int(count):
            return UNKNOWN
        if count == '1':
            return self._decode(kind, [line], payload, heard)
        self._lapse(heard)
        key = (source, kind, channel, message, count)
        parts = self._parts.setdefault(key, {})
        if int(number) in parts and parts[int(number)].line == line:
            return TWICE
        if int(number) in parts:  # of another message: what waits will not be whole any more
            self._give_up(key)
            parts = self._parts.setdefault(key, {})
        parts[int(number)] = Part(line, heard)
        if len(parts) < int(count):
            return WAITING
        del self._parts[key]
        lines = [parts[k].line for k in sorted(parts)]
        whole = ''.join(one.split(',')[5] for one in lines)
        outcome = self._decode(kind, lines, whole, heard)
        self.outcome[WAITING] -= len(parts) - 1
        self.outcome[outcome] += len(parts) - 1
        return outcome

    def _remember(self, payload: tuple[str, ...], heard: float) -> None:
        self._payloads.pop(payload, None)  # the last heard stands last
        self._payloads[payload] = heard
        while len(self._payloads) > MOST_PAYLOADS:
            del self._payloads[next(iter(self._payloads))]

    def _lapse(self, now: float) -> None:
        for key in [
            key
            for key, parts in self._parts.items()
            if abs(now - max(part.heard for part in parts.values())) > PARTS_WITHIN
        ]:
            self._give_up(key)
        while len(self._parts) > MOST_PARTS:
            self._give_up(next(iter(self._parts)))

    def _give_up(self, key: tuple[str, ...]) -> None:
        count = len(self._parts.pop(key))
        self.outcome[WAITING] -= count
        self.outcome[ALONE] += count

    # -- messages --------------------------------------------------------------------------------

    def _decode(self, kind: str, lines: list[str], payload: str, heard: float) -> str:
        if not payload:
            return LENGTH
        same = kind, payload
        if heard - self._payloads.get(same, -math.inf) < TWICE_WITHIN:
            return TWICE
        self._remember(same, heard)
        code = ord(payload[0]) - 48
        code -= 8 * (code > 40)
        if code not in reports.TYPES:
            return TYPE
        fill = int(lines[-1].rpartition('*')[0][-1])
        if 6 * len(payload) - fill < LEAST_BITS[code]:
            return LENGTH
        try:
            message = pyais.decode(*lines).asdict()
        except (AISBaseException, ValueError, IndexError, TypeError, KeyError):
            return PAYLOAD
        return self._report(message, kind == 'VDO', heard)

    def _take_json(self, line: str, heard: float) -> str:
        try:
            message = json.loads(line)
        except (ValueError, RecursionError):
            return BAD_JSON
        if not isinstance(message, dict) or 'class' not in message:
            return BAD_JSON
        if message['class'] != 'AIS':
            return OTHER
        if message.get('type') not in reports.TYPES:
            return TYPE
        try:
            return self._report(_of_gpsd(message), False, heard)
        except (TypeError, ValueError, OverflowError):
            return BAD_JSON

    def _report(self, message: Mapping[str, Any], own: bool, heard: float) -> str:
        time, timed = self._time(message.get('second'), heard)
        try:
            row = reports.row(message, heard, time, timed, self._leave_out)
        except ValueError as error:
            return str(error)
        mmsi = row[3]
        if own:
            if self.own not in (0, mmsi):
                return NOT_OWN
            self.own, self._own_row = mmsi, row
            return OWN
        if mmsi == self.own:
            return OWN_AS_OTHER
        self._rows.append(row)
        return TAKEN

    def _leave_out(self, what: str) -> None:
        self.left_out[what] += 1

    def _time(self, second: Any, heard: float) -> tuple[float, bool]:
        """When the place was measured, s, and whether that is known by the second."""
        if not isinstance(second, int) or second >= reports.NO_TIME or not heard > EPOCH:
            return heard, False
        late = (heard - second) % 60
        if late <= LATEST:
            return heard - max(late - 0.5, 0.0), True
        if late >= 60 - EARLY:
            return heard, True
        self.left_out[CLOCK] += 1
        return heard, False


def _checksum(text: str) -> int:
    return functools.reduce(operator.xor, text.encode(), 0)


def unix_time(text: str, otherwise: float) -> float:
    """s of a tag block's time, which may be in ms; `otherwise` where it tells none."""
    if not text.isdecimal() or len(text) > 13:
        return otherwise
    return float(text) / (1000.0 if len(text) > 11 else 1.0)


def _of_gpsd(message: Mapping[str, Any]) -> dict[str, Any]:
    """gpsd's object with the names and units of pyais."""
    found = {'shiptype': 'ship_type', 'type': 'msg_type'}
    named = {found.get(name, name): value for name, value in message.items()}
    if not message.get('scaled', True):
        kind = message['type']
        tenths = {'speed': 1 if kind in (9, 27) else 10, 'course': 1 if kind == 27 else 10}
        for name, parts in {**tenths, 'lat': 600_000, 'lon': 600_000}.items():
            if isinstance(named.get(name), (int, float)):
                named[name] = named[name] / (600 if kind == 27 and parts > 10 else parts)
        named['turn'] = _turn(named.get('turn'))
    for name in ('status', 'ship_type', 'aid_type', 'accuracy', 'second', 'mmsi'):
        if not isinstance(named.get(name, 0), int):
            del named[name]
    return named


def _turn(value: Any) -> float:
    """deg/min of the raw field; nan for none."""
    if not isinstance(value, int) or abs(value) > 126:
        return math.nan
    return math.copysign((value / 4.733) ** 2, value)
