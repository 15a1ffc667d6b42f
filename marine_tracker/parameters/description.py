"""Describes and checks parameters, and reads them from mappings."""

import dataclasses
import difflib
import functools
import logging
import math
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

from ..files import shown


def parameter(
    default: bool | int | float | str,
    text: str,
    *,
    unit: str = '',
    low: float | None = None,
    high: float | None = None,
    choices: tuple[str, ...] = (),
    live: bool = False,
    old: Mapping[Any, str] | None = None,
) -> Any:
    """A dataclass field with its description.

    low, high  inclusive limits of a number; choices  the values a string may take;
    live       may be changed while the node runs
    old        words of earlier versions, and their present values (YAML 1.1 turns some into bools)
    """
    return dataclasses.field(
        default=default,
        metadata={
            'text': text,
            'unit': unit,
            'low': low,
            'high': high,
            'choices': choices,
            'live': live,
            'old': old or {},
        },
    )


def check(parameters: Any) -> None:
    """Raises ValueError for the first field with a wrong type, or outside its limits or choices."""
    for field in dataclasses.fields(parameters):
        kind: Any = field.type
        value, about = getattr(parameters, field.name), field.metadata
        if kind is float and type(value) is int:
            value = float(value)
            object.__setattr__(parameters, field.name, value)
        if isinstance(value, (str, bool)) and value in about['old']:
            value = about['old'][value]
            _tell_once(
                f'parameter {field.name}: {getattr(parameters, field.name)} is a word of earlier '
                f'versions; write {value}'
            )
            object.__setattr__(parameters, field.name, value)
        if type(value) is not kind:
            raise ValueError(
                f'parameter {field.name} is {shown(value)}, a {type(value).__name__}; '
                f'it must be a {kind.__name__}'
            )
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f'parameter {field.name} is {value}; it must be finite')
        low, high = about['low'], about['high']
        if (low is not None and value < low) or (high is not None and value > high):
            raise ValueError(
                f'parameter {field.name} is {value:g} {about["unit"]}'.rstrip()
                + f'; it must be between {low:g} and {high:g}'
            )
        if about['choices'] and value not in about['choices']:
            raise ValueError(
                f'parameter {field.name} is {shown(value)}; '
                f'it must be one of {", ".join(about["choices"])}'
            )


P = TypeVar('P')


def from_mapping(kind: type[P], values: Mapping[str, Any]) -> P:
    """A parameter object from a mapping. An unknown key is an error that names similar ones."""
    made: P = from_mappings((kind,), values)[0]
    return made


def from_mappings(kinds: Sequence[type], values: Mapping[str, Any]) -> tuple[Any, ...]:
    """Parameter objects of several kinds from one mapping. All their names differ."""
    known = {field.name: kind for kind in kinds for field in dataclasses.fields(kind)}
    for name in values:
        if name not in known:
            near = difflib.get_close_matches(_cut(name), known, 1)
            hint = f'; did you mean {near[0]}?' if near else ''
            raise ValueError(f'unknown parameter {_cut(name)}{hint}')
    return tuple(
        kind(**{name: value for name, value in values.items() if known[name] is kind})
        for kind in kinds
    )


def _cut(name: Any) -> str:
    return str(name)[:60]


@functools.cache
def _tell_once(message: str) -> None:
    logging.getLogger(__name__).warning(message)
