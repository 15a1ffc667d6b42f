"""Reads YAML 1.2 and JSON written by people, with limits. The only such reader in the package.

Numbers are decimal numbers, as in JSON: `045` is 45; `1:30`, `0x1f`, `yes` and `off` are texts. A
key may occur only once. Size, depth, number of values (aliases count as often as they are used) and
size of integers have limits, which no file written by a person exceeds. Every error is a ValueError
of one line that names the file, the line in it, the key, the value and the limit.
"""

import json
import math
import re
from collections.abc import Iterator
from typing import Any, NamedTuple

from ruamel.yaml import YAML, events
from ruamel.yaml.error import MarkedYAMLError

from .files import Place, read_text, shortened, shown

MAX_BYTES = 300_000
MAX_VALUES = 30_000
MAX_DEPTH = 32
MAX_KEY = 200  # characters
MAX_INTEGER = 2**63 - 1

# The core schema of YAML 1.2, less hexadecimal and octal numbers.
CONSTANTS = {
    **dict.fromkeys(('', '~', 'null', 'Null', 'NULL')),
    **dict.fromkeys(('true', 'True', 'TRUE'), True),
    **dict.fromkeys(('false', 'False', 'FALSE'), False),
    **{sign + word: float(sign + 'inf') for sign in ('', '+', '-') for word in ('.inf', '.Inf')},
    **dict.fromkeys(('.nan', '.NaN', '.NAN'), math.nan),
}
INTEGER = re.compile(r'[-+]?[0-9]+')
NUMBER = re.compile(r'[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?')
TEXT_TAGS = ('!', '!!str', 'tag:yaml.org,2002:str')


class _Found(NamedTuple):
    """A value, and the number of values in it, including itself and those of aliases."""

    value: Any
    size: int


def read(path: Place) -> Any:
    """The content of a YAML file. ValueError if it is wrong, OSError if it cannot be read."""
    return parse(read_text(path, MAX_BYTES), shortened(path))


def read_mapping(path: Place) -> dict[str, Any]:
    """A YAML file that holds one mapping (empty: an empty mapping). Errors name the file."""
    values = read(path)
    if values is None:
        return {}
    if not isinstance(values, dict):
        raise ValueError(f'{shortened(path)} holds {_kind(values)}; it must hold a mapping')
    return values


def read_json(path: Place) -> dict[str, Any]:
    """A JSON file that holds one object, under the same limits."""
    return parse_json(read_text(path, MAX_BYTES), shortened(path))


def parse_json(text: str, name: str) -> dict[str, Any]:
    """The one object of a JSON text, under the same limits; `name` describes the text."""

    def pairs(items: list[tuple[str, Any]]) -> dict[str, Any]:
        made: dict[str, Any] = {}
        for key, value in items:
            _check_key(key, made, name)
            made[key] = value
        return made

    try:
        found = json.loads(
            text, object_pairs_hook=pairs, parse_int=lambda digits: _integer(digits, name)
        )
    except json.JSONDecodeError as error:
        raise ValueError(f'{name}, line {error.lineno} is not JSON: {error.msg}') from None
    except RecursionError:
        raise ValueError(f'{name} is nested too deep; {MAX_DEPTH} levels are allowed') from None
    if not isinstance(found, dict):
        raise ValueError(f'{name} holds {_kind(found)}; it must hold an object')
    level: list[Any] = [found]
    for _ in range(MAX_DEPTH):
        inner = (item.values() if isinstance(item, dict) else item for item in level)
        level = [value for items in inner for value in items if isinstance(value, (dict, list))]
    if level:
        raise ValueError(f'{name} is nested too deep; {MAX_DEPTH} levels are allowed')
    return found


def parse(text: str, name: str, *, as_text: bool = False) -> Any:
    """The content of a YAML text: dict, list, str, int, float, bool or None.

    name     describes the text, for errors
    as_text  every scalar stays a text, as written
    """
    if len(text) > MAX_BYTES:
        raise ValueError(f'{name}: {len(text)} characters; it must be {MAX_BYTES} at most')
    return _Composer(name, as_text).compose(_events(text, name))


def _events(text: str, name: str) -> Iterator[Any]:
    """The parser's events."""
    try:
        yield from YAML(typ='safe', pure=True).parse(text)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f'{name}, line {mark.line + 1}' if mark else name
        why = error.problem or error.context or 'it cannot be read'
        raise ValueError(f'{place} is not YAML: {shortened(why)}') from None
    except Exception as error:  # for broken texts the library also raises other errors than its own
        raise ValueError(f'{name} is not YAML: {shortened(error)}') from None


class _Composer:
    """Builds values from the events of the parser, with a stack of open collections, without
    recursion.
    """

    def __init__(self, name: str, as_text: bool):
        self.name = name
        self.as_text = as_text
        self.anchors: dict[str, _Found] = {}
        self.open: list[_Collection] = []
        self.path: list[str] = []
        self.values = 0

    def compose(self, parsed: Iterator[Any]) -> Any:
        found: list[Any] = []
        for event in parsed:
            if isinstance(event, events.DocumentStartEvent):
                if found:
                    raise self._wrong(event, 'there is a second document; there may be one')
                if event.version not in (None, (1, 2)):
                    version = '.'.join(map(str, event.version))
                    raise self._wrong(event, f'it is YAML {version}; it must be YAML 1.2')
            elif isinstance(event, (events.MappingStartEvent, events.SequenceStartEvent)):
                self._begin(event)
            elif isinstance(event, (events.MappingEndEvent, events.SequenceEndEvent)):
                collection = self.open.pop()
                made = _Found(collection.value, self.values - collection.before)
                if collection.anchor:
                    self.anchors[collection.anchor] = made
                self._add(event, made, found)
            elif isinstance(event, events.ScalarEvent):
                self._count(event, 1)
                made = _Found(self._scalar(event), 1)
                if event.anchor:
                    self.anchors[event.anchor] = made
                self._add(event, made, found)
            elif isinstance(event, events.AliasEvent):
                if event.anchor not in self.anchors:
                    raise self._wrong(event, f'*{event.anchor[:60]} stands for nothing before it')
                made = self.anchors[event.anchor]
                self._count(event, made.size)
                self._add(event, made, found)
        return found[0] if found else None

    def _begin(self, event: Any) -> None:
        if event.tag is not None:
            raise self._wrong(event, f'the tag {shortened(event.tag)} is not read; leave it out')
        if self.open and self.open[-1].wants_key:
            raise self._wrong(event, 'a key is a list or mapping; it must be a word')
        if len(self.open) == MAX_DEPTH:
            raise self._wrong(event, f'it is nested too deep; {MAX_DEPTH} levels are allowed')
        before = self.values
        self._count(event, 1)
        mapping = isinstance(event, events.MappingStartEvent)
        self.open.append(_Collection({} if mapping else [], event.anchor, before))

    def _count(self, event: Any, size: int) -> None:
        self.values += size
        if self.values > MAX_VALUES:
            raise self._wrong(event, f'there are too many values; {MAX_VALUES} are allowed')

    def _scalar(self, event: Any) -> Any:
        text = event.value
        if event.tag is not None and str(event.tag) not in TEXT_TAGS:
            raise self._wrong(event, f'the tag {shortened(event.tag)} is not read; leave it out')
        is_key = bool(self.open) and self.open[-1].wants_key
        if self.as_text or is_key or event.style is not None or event.tag is not None:
            return text
        if text in CONSTANTS:
            return CONSTANTS[text]
        if INTEGER.fullmatch(text):
            return _integer(text, self._place(event))
        return float(text) if NUMBER.fullmatch(text) else text

    def _add(self, event: Any, made: _Found, found: list[Any]) -> None:
        if not self.open:
            found.append(made.value)
            return
        collection = self.open[-1]
        if not isinstance(collection.value, dict):
            collection.value.append(made.value)
        elif collection.wants_key:
            if not isinstance(made.value, str):
                raise self._wrong(event, f'the key is {shown(made.value)}; it must be a word')
            _check_key(made.value, collection.value, self._place(event))
            collection.key, collection.wants_key = made.value, False
        else:
            collection.value[collection.key] = made.value
            collection.wants_key = True

    def _place(self, event: Any) -> str:
        """File, line and key of the event's value."""
        keys = ''
        for collection in self.open:
            if not isinstance(collection.value, dict):
                keys += f'[{len(collection.value)}]'
            elif not collection.wants_key:
                keys += f'{"." if keys else ""}{shortened(collection.key)}'
        where = f'{self.name}, line {event.start_mark.line + 1}'
        return f'{where}, {keys}' if keys else where

    def _wrong(self, event: Any, why: str) -> ValueError:
        return ValueError(f'{self._place(event)}: {why}')


class _Collection:
    """A mapping or list that is being read."""

    def __init__(self, value: Any, anchor: str | None, before: int):
        self.value = value
        self.anchor = anchor
        self.before = before
        self.wants_key = isinstance(value, dict)
        self.key = ''


def _integer(digits: str, place: str) -> int:
    if len(digits.lstrip('+-0')) > 19 or abs(int(digits)) > MAX_INTEGER:
        raise ValueError(
            f'{place}: {shown(digits)} is too large; an integer must be at most {MAX_INTEGER}'
        )
    return int(digits)


def _check_key(key: str, before: dict[str, Any], place: str) -> None:
    if len(key) > MAX_KEY:
        raise ValueError(
            f'{place}: the key {shown(key)} has {len(key)} characters; {MAX_KEY} are allowed'
        )
    if key in before:
        raise ValueError(f'{place}: {shown(key)} is there twice; give it once')


def _kind(value: Any) -> str:
    kinds = {list: 'a list', str: 'a text', dict: 'a mapping', type(None): 'nothing'}
    return kinds.get(type(value), shown(value))
