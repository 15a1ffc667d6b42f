"""ROS parameters from the dataclasses of parameters/, and back."""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

from ..files import shown
from ..parameter_files import limits
from ..parameters import from_mappings
from .diagnostics import one_line

P = TypeVar('P')
M = TypeVar('M')

WORDS = {bool: 'a bool', int: 'an integer', float: 'a double', str: 'a string'}


def declare(node: Node, *kinds: type) -> tuple[Any, ...]:
    """Declares every field of the dataclasses on the node; returns the values it was started with.

    ValueError names the parameter if a given one (YAML file, command line, launch) is unknown, has
    no value, has the wrong type or is outside its limits. rclpy alone ignores unknown ones
    silently.
    """
    fields = {field.name: field for kind in kinds for field in dataclasses.fields(kind)}
    # Parameters that rclpy itself declared (use_sim_time, ...) and QoS overrides are not ours.
    given = {
        name: override.value
        for name, override in node._parameter_overrides.items()
        if not node.has_parameter(name) and not name.startswith('qos_overrides.')
    }
    for name, value in given.items():
        if name in fields:
            _check_type(name, value, fields[name])
    parameters = from_mappings(kinds, given)
    for kind, values in zip(kinds, parameters):
        for field in dataclasses.fields(kind):
            node.declare_parameter(
                field.name, getattr(values, field.name), descriptor(field), ignore_override=True
            )
    return parameters


def descriptor(field: dataclasses.Field[Any]) -> ParameterDescriptor:
    """The descriptor of a dataclass field in ROS terms."""
    about = field.metadata
    described = ParameterDescriptor(
        name=field.name,
        description=about['text'] + (f' [{about["unit"]}]' if about['unit'] else ''),
        additional_constraints=limits(field),
        read_only=not about['live'],
    )
    if about['low'] is not None and about['high'] is not None:
        if field.type is float:
            described.floating_point_range = [
                FloatingPointRange(
                    from_value=float(about['low']), to_value=float(about['high']), step=0.0
                )
            ]
        else:
            described.integer_range = [
                IntegerRange(from_value=int(about['low']), to_value=int(about['high']), step=1)
            ]
    return described


def follow(
    node: Node, kinds: Sequence[type], make: Callable[..., M], apply: Callable[[M], None]
) -> None:
    """After each change of live parameters, calls `apply` with the result of `make`, one object a
    kind, and logs what was changed.

    A change that a dataclass or `make` refuses with a ValueError is refused with that reason.
    `make` must have no side effect, because another callback may still refuse the same change.
    """
    made: list[M] = []  # of the last change that was accepted here
    changes: list[str] = []  # and what it changes
    names = [field.name for kind in kinds for field in dataclasses.fields(kind)]

    def values(changed: list[Parameter]) -> dict[str, Any]:
        now = {name: node.get_parameter(name).value for name in names}
        return now | {p.name: p.value for p in changed if p.name in now}

    def validate(changed: list[Parameter]) -> SetParametersResult:
        mine = [parameter for parameter in changed if parameter.name in names]
        if mine:
            changes[:] = [
                one_line(f'{new.name} {node.get_parameter(new.name).value} -> {new.value}')
                for new in mine
            ]
            try:
                made[:] = [make(*from_mappings(kinds, values(changed)))]
            except ValueError as error:
                return SetParametersResult(successful=False, reason=_named(error, changed))
        return SetParametersResult(successful=True)

    def changed(changed: list[Parameter]) -> None:
        if any(parameter.name in names for parameter in changed):
            apply(made.pop())
            node.get_logger().info('parameters changed: ' + ', '.join(changes))

    node.add_on_set_parameters_callback(validate)
    node.add_post_set_parameters_callback(changed)


def _named(error: ValueError, changed: list[Parameter]) -> str:
    """Why a change is refused, in one line that names a parameter of it."""
    names = [parameter.name for parameter in changed]
    if any(name in str(error) for name in names):
        return one_line(error)
    return one_line(f'parameter {", ".join(names)}: {error}')


def _check_type(name: str, value: Any, field: dataclasses.Field) -> None:
    wanted: Any = field.type
    if isinstance(value, (str, bool)) and value in field.metadata['old']:
        return
    if value is None:
        raise ValueError(
            f'parameter {name} has no value (an empty entry or list); it must be {WORDS[wanted]}'
        )
    if type(value) is not wanted:
        hint = f' (write {value}.0)' if wanted is float and type(value) is int else ''
        found = WORDS.get(type(value), 'a list')
        raise ValueError(
            f'parameter {name} is {shown(value)}, {found}; it must be {WORDS[wanted]}{hint}'
        )
