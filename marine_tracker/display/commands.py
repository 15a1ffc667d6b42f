"""What a viewer may ask for, read from its messages; whatever is wrong is named in one line."""

import json
from collections.abc import Callable
from typing import Any, NamedTuple

from . import zone_fields

LONGEST = 8000  # characters of a message from a viewer: a zone of 200 corners
LONGEST_WORD = 300
FAR_M = 1e6  # m from the origin of `map`: nobody clicks further away


def _word(command: str, field: str, value: Any) -> str:
    if not isinstance(value, str) or len(value) > LONGEST_WORD:
        raise ValueError(f'{command} needs {field}, a text of at most {LONGEST_WORD} characters')
    return value


# Of each command its fields: lowest and highest value, where whole numbers are ints; or a function
# of command, field and value, that gives the value or raises ValueError.
Field = tuple[float, float] | Callable[[str, str, Any], Any]
FIELDS: dict[str, dict[str, Field]] = {
    'acquire': {'x': (-FAR_M, FAR_M), 'y': (-FAR_M, FAR_M)},
    'cancel': {'number': (1, 2**32 - 1)},
    'cancel_all': {},
    'acknowledge': {'number': (1, 2**32 - 1)},
    'acknowledge_all': {},
    'trial': {'course_deg': (0.0, 360.0), 'speed_kn': (0.0, 100.0), 'delay_min': (0.0, 60.0)},
    'trial_off': {},
    'acknowledge_alert': {'instance': (1, 2**32 - 1)},
    'silence': {},
    'limits': {'cpa_nm': (0.01, 20.0), 'tcpa_min': (0.1, 120.0)},
    'watch': {'areas': (0, 1)},
    'explain': {'x': (-FAR_M, FAR_M), 'y': (-FAR_M, FAR_M)},
    'ais_awake': {'mmsi': (1, 999_999_999), 'awake': (0, 1)},
    'ais': {
        **{name: _word for name in ('symbol', 'kinds', 'activation')},
        'range_nm': (0.1, 1000.0),
        'cpa_nm': (0.1, 200.0),
        'activation_range_nm': (0.1, 100.0),
        'lost_range_nm': (0.1, 100.0),
        **{name: (0, 1) for name in ('lost_alarm', 'sleeping_danger', 'join')},
    },
    'zone_put': {'zone': zone_fields.zone, 'was': zone_fields.name},
    'zone_delete': {'name': zone_fields.name},
    'show': {'scenario': _word, 'recording': _word, 'rate': (0.01, 1000.0)},
}
LOGIN, WATCH = 'login', 'watch'


class Command(NamedTuple):
    """name: one of FIELDS, or LOGIN; id: the viewer's own number of it; values: its fields."""

    name: str
    id: int
    values: dict[str, Any]


def parse(text: str) -> Command:
    """A command from the text of a message. ValueError says what is wrong with it."""
    if len(text) > LONGEST:
        raise ValueError(f'a message of {len(text)} characters; at most {LONGEST} are read')
    try:
        given = json.loads(text)
    except (ValueError, RecursionError):
        raise ValueError('not JSON') from None
    if not isinstance(given, dict):
        raise ValueError('not a JSON object')
    name, number = given.pop('command', None), given.pop('id', 0)
    if type(number) is not int or not 0 <= number < 2**53:
        raise ValueError('id must be a whole number from 0 on')
    if name == LOGIN:
        token = given.get('token')
        if not isinstance(token, str):
            raise ValueError('login needs a token')
        return Command(LOGIN, number, {'token': token})
    if not isinstance(name, str) or name not in FIELDS:
        raise ValueError(f'command must be one of {", ".join(FIELDS)}')
    wanted = FIELDS[name]
    for field in given:
        if field not in wanted:
            raise ValueError(f'{name} has no field {field[:40]!r}')
    return Command(
        name, number, {field: _value(name, field, given, wanted[field]) for field in wanted}
    )


def _value(name: str, field: str, given: dict[str, Any], about: Field) -> Any:
    if callable(about):
        return about(name, field, given.get(field))
    return _number(name, field, given, *about)


def _number(name: str, field: str, given: dict[str, Any], low: float, high: float) -> float:
    whole = type(low) is int
    value = given.get(field)
    if not isinstance(value, int if whole else (int, float)) or isinstance(value, bool):
        raise ValueError(f'{name} needs {field}, a{" whole" if whole else ""} number')
    if not low <= value <= high:  # not a number is not between them either
        raise ValueError(f'{field} must be between {low:g} and {high:g}')
    return value if whole else float(value)
