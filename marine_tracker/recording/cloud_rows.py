"""Point clouds as structured arrays, without ROS: any order of fields, either byte order."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .message_faults import BAD_LAYOUT, MISSING_FIELD, MISTYPED_FIELD, TRUNCATED, ConversionError

UINT8, UINT16, UINT32, FLOAT32, FLOAT64 = 2, 4, 6, 7, 8  # PointField.datatype
FLOATS = {FLOAT32: 'f4', FLOAT64: 'f8'}
INTEGERS = {UINT8: 'u1', UINT16: 'u2'}
KINDS = {**FLOATS, **INTEGERS, UINT32: 'u4'}
NAMES = {FLOAT32: 'FLOAT32', FLOAT64: 'FLOAT64', UINT8: 'UINT8', UINT16: 'UINT16'}


class Wanted(NamedTuple):
    """A field to be read.

    kinds   datatypes that it may have
    needed  else it may be missing
    most    greatest count of values in a point; 1: a plain number
    """

    name: str
    kinds: dict[int, str]
    needed: bool = True
    most: int = 1


def rows(message: Any, wanted: Sequence[Wanted]) -> NDArray[np.void]:
    """The wanted fields of all points [M], those that are there. ConversionError names what is
    wrong with the layout."""
    fields = {field.name: field for field in message.fields}
    if len(fields) < len(message.fields):
        raise ConversionError(BAD_LAYOUT, 'a field name stands twice')
    order = '>' if message.is_bigendian else '<'
    names, kinds, offsets = [], [], []
    for one in wanted:
        if one.name not in fields:
            if one.needed:
                raise ConversionError(MISSING_FIELD, one.name)
            continue
        field = fields[one.name]
        if field.datatype not in one.kinds or not field.count <= one.most:
            words = ' or '.join(NAMES[kind] for kind in one.kinds)
            number = 'one' if one.most == 1 else f'at most {one.most}'
            raise ConversionError(
                MISTYPED_FIELD,
                f'{one.name} has datatype {field.datatype}, count {field.count}; it must be '
                f'{number} {words}',
            )
        kind = np.dtype(order + one.kinds[field.datatype])
        if one.most > 1:
            kind = np.dtype((kind, (max(field.count, 1),)))
        if field.offset + kind.itemsize > message.point_step:
            raise ConversionError(
                BAD_LAYOUT,
                f'{one.name} ends at byte {field.offset + kind.itemsize}'
                f' of a point of {message.point_step}',
            )
        names.append(one.name)
        kinds.append(kind)
        offsets.append(field.offset)
    used = message.width * message.point_step
    if message.row_step < used:
        raise ConversionError(
            BAD_LAYOUT,
            f'row_step is {message.row_step}; {message.width} points '
            f'of {message.point_step} bytes need {used}',
        )
    whole = message.row_step * message.height
    if len(message.data) < whole:
        raise ConversionError(TRUNCATED, f'{len(message.data)} bytes of {whole}')
    if len(message.data) > whole:
        raise ConversionError(BAD_LAYOUT, f'{len(message.data)} bytes; {whole} announced')
    raw = np.frombuffer(message.data, np.uint8).reshape(message.height, message.row_step)[:, :used]
    point = np.dtype(
        {'names': names, 'formats': kinds, 'offsets': offsets, 'itemsize': message.point_step}
    )
    found: NDArray[np.void] = np.ascontiguousarray(raw).reshape(-1).view(point)
    return found
