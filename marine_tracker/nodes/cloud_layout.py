"""PointCloud2 to structured arrays and back: any order of fields, either byte order, padding."""

import array
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

from ..recording.cloud_rows import FLOATS, INTEGERS, KINDS, Wanted, rows  # noqa: F401


def message(points: NDArray[np.void], header: Header) -> PointCloud2:
    """A PointCloud2 of a structured array [M] of little-endian fields."""
    kinds = {kind: datatype for datatype, kind in KINDS.items()}
    layout: Any = points.dtype
    fields = []
    for name in layout.names:
        kind, offset = layout.fields[name]
        fields.append(
            PointField(
                name=name,
                offset=offset,
                datatype=kinds[kind.base.str[1:]],
                count=kind.shape[0] if kind.shape else 1,
            )
        )
    return PointCloud2(
        header=header,
        height=1,
        width=len(points),
        fields=fields,
        is_bigendian=False,
        point_step=points.dtype.itemsize,
        row_step=points.nbytes,
        is_dense=True,
        data=array.array('B', points.tobytes()),
    )
