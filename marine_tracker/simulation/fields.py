"""Checked reading of a YAML mapping whose keys end in their unit: `speed_kn`, `radius_m`.

Every error is a ValueError that names the place (`targets[2].legs[0].turn`), the key, its value and
the allowed values.
"""

import difflib
import math
from collections.abc import Mapping
from typing import Any

from ..files import shortened, shown
from ..geometry import KNOT, NAUTICAL_MILE

LENGTH_UNITS = {'m': 1.0, 'nm': NAUTICAL_MILE}
SPEED_UNITS = {'mps': 1.0, 'kn': KNOT}
ENDINGS = ('deg_per_s', 'mps2', 'mps', 'kn', 'nm', 'm', 'deg', 's', 'rpm')


class Section:
    """One mapping of the file. Only the stated keys are allowed.

    values  the mapping; where  its place in the file, '' at the top
    keys    the allowed keys, in one string; `range_m|range_nm` are two spellings of one value
    """

    def __init__(self, values: Any, where: str, keys: str) -> None:
        values = {} if values is None else values  # `straight:` without a value
        if not isinstance(values, Mapping):
            raise ValueError(
                f'{where or "the scenario"} is {shown(values)}; it must be a mapping with '
                f'keys like {", ".join(keys.split()[:3])}'
            )
        self.values, self.where, self.keys = values, where, keys.split()
        known = keys.replace('|', ' ').split()
        for key in values:
            if key not in known:
                raise ValueError(f'{self.place(key)} is not known{_hint(str(key), known)}')

    @property
    def owner(self) -> str:
        """The name of what the mapping describes."""
        return self.where or 'the scenario'

    def place(self, key: Any) -> str:
        """The place of the key in the file."""
        name = shortened(key)
        return f'{self.where}.{name}' if self.where else name

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def has(self, stem: str) -> bool:
        """Whether the length or speed is given, in any unit."""
        return any(f'{stem}_{unit}' in self.values for unit in {**LENGTH_UNITS, **SPEED_UNITS})

    def number(self, key: str, low: float, high: float, default: float | None = None) -> float:
        """A finite number within [low, high]. It is required if there is no default."""
        if key not in self.values:
            if default is None:
                raise ValueError(f'{self.owner} has no {key}')
            return default
        value = self.values[key]
        if type(value) not in (int, float):
            raise ValueError(
                f'{self.place(key)} is {shown(value)}; it must be a number '
                '(the unit stands in the key)'
            )
        if not math.isfinite(value):
            raise ValueError(f'{self.place(key)} is {value}; it must be finite')
        if not low <= value <= high:
            raise ValueError(
                f'{self.place(key)} is {value:g}; it must be between {low:g} and {high:g}'
            )
        return float(value)

    def whole(self, key: str, low: int, high: int, default: int) -> int:
        """A whole number within [low, high]."""
        value = self.number(key, low, high, default)
        if value != int(value):
            raise ValueError(f'{self.place(key)} is {value:g}; it must be a whole number')
        return int(value)

    def length(self, stem: str, low: float, high: float, default: float | None = None) -> float:
        """Metres, from `stem_m` or `stem_nm`; the limits are metres."""
        return self._in_units(stem, LENGTH_UNITS, low, high, default)

    def speed(self, stem: str, low: float, high: float, default: float | None = None) -> float:
        """Metres per second, from `stem_mps` or `stem_kn`; the limits are metres per second."""
        return self._in_units(stem, SPEED_UNITS, low, high, default)

    def _in_units(self, stem, units, low, high, default):
        spellings = [f'{stem}_{unit}' for unit in units]
        given = [key for key in spellings if key in self.values]
        if len(given) == 2:
            raise ValueError(f'{self.owner} has both {given[0]} and {given[1]}; give one')
        if not given:
            if default is None:
                raise ValueError(f'{self.owner} has no {" or ".join(spellings)}')
            return default
        factor = units[given[0].removeprefix(f'{stem}_')]
        return factor * self.number(given[0], low / factor, high / factor)

    def text(self, key: str, default: str | None = None) -> str:
        """A text. It is required if there is no default."""
        if key not in self.values:
            if default is None:
                raise ValueError(f'{self.owner} has no {key}')
            return default
        value = self.values[key]
        if not isinstance(value, str) or not value.strip():
            raise ValueError(f'{self.place(key)} is {shown(value)}; it must be a text')
        return value.strip()

    def choice(self, key: str, choices: tuple[str, ...], default: str) -> str:
        """One of the stated words."""
        value = self.values.get(key, default)
        if value not in choices:
            raise ValueError(
                f'{self.place(key)} is {shown(value)}; it must be one of {", ".join(choices)}'
            )
        return value

    def items(self, key: str) -> list[Any]:
        """A list; empty if not given."""
        value = self.values.get(key, [])
        if not isinstance(value, list):
            raise ValueError(f'{self.place(key)} is {shown(value)}; it must be a list')
        return value

    def section(self, key: str, keys: str) -> 'Section':
        """A mapping within this one; empty if not given."""
        return Section(self.values.get(key, {}), self.place(key), keys)

    def one_of(self, *alternatives: str) -> str:
        """The one alternative that is given, each named by its key or stem."""
        given = [a for a in alternatives if a in self.values or self.has(a)]
        if len(given) != 1:
            spelled = {
                a: next(k for k in self.keys if k == a or k.startswith(f'{a}_')).replace(
                    '|', ' or '
                )
                for a in alternatives
            }
            what = ' and '.join(given) if given else f'none of {"; ".join(spelled.values())}'
            raise ValueError(
                f'{self.where} has {what}; it must have one of {", ".join(alternatives)}'
            )
        return given[0]


def _hint(key, known):
    stems: dict[str, list[str]] = {}
    for name in known:
        ending = next((e for e in ENDINGS if name.endswith('_' + e)), None)
        if ending:
            stems.setdefault(name.removesuffix('_' + ending), []).append(name)
    if key in stems:
        return f': the key must end in its unit; write {" or ".join(stems[key])}'
    for stem, names in stems.items():
        if key.startswith(stem + '_'):
            return f': no such unit here; write {" or ".join(names)}'
    near = difflib.get_close_matches(key, known, 1)
    return f'; did you mean {near[0]}?' if near else f'; it may be one of {", ".join(known)}'
