"""`ais/reports`: reports of AIS as numbers, some in one message. Fields: doc/ais.md.

Times are s after the stamp; angles rad clockwise from true north; nan, 255 and 65535 for none.
"""

import numpy as np
from sensor_msgs.msg import PointCloud2

from ..ais.reports import Reports
from ..recording.cloud_rows import KINDS, Wanted, rows
from ..types import BoolArray
from . import convert

NAME, CALL_SIGN = 20, 7  # characters
NONE, NO_TYPE = 255, 65535
REPORT_TYPE = np.dtype(
    [('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('heard', '<f8'), ('time', '<f8')]
    + [('latitude', '<f8'), ('longitude', '<f8'), ('mmsi', '<u4')]
    + [(name, '<f4') for name in ('speed', 'course', 'heading', 'turn')]
    + [('size', '<f4', (4,)), ('ship_type', '<u2')]
    + [(name, 'u1') for name in ('type', 'status', 'timed', 'accurate')]
    + [('name', 'u1', (NAME,)), ('call_sign', 'u1', (CALL_SIGN,))]
)
NUMBERS = (*('heard', 'time', 'latitude', 'longitude'), *('speed', 'course', 'heading', 'turn'))


def wanted(kind: np.dtype) -> tuple[Wanted, ...]:
    """The fields of a cloud of such points, without z."""
    return tuple(
        Wanted(
            name,
            {code: of for code, of in KINDS.items() if of == kind[name].base.str[1:]},
            most=int(np.prod(kind[name].shape or (1,))),
        )
        for name in kind.names or ()
        if name not in ('z',)
    )


WANTED = tuple(one for one in wanted(REPORT_TYPE) if one.name not in ('x', 'y'))


def message(reports: Reports, now: float, time_ns: int) -> PointCloud2:
    """The reports; now: what their times are s of, at the stamp time_ns."""
    points = np.zeros(len(reports.mmsi), REPORT_TYPE)
    points['heard'], points['time'] = reports.heard - now, reports.time - now
    for name in ('latitude', 'longitude', 'mmsi', 'speed', 'course', 'heading', 'turn', 'size'):
        points[name] = getattr(reports, name)
    for name in ('type', 'timed', 'accurate'):
        points[name] = getattr(reports, name)
    points['status'] = np.where(reports.status < 0, NONE, reports.status)
    points['ship_type'] = np.where(reports.ship_type < 0, NO_TYPE, reports.ship_type)
    for name, length in (('name', NAME), ('call_sign', CALL_SIGN)):
        points[name] = codes(getattr(reports, name), length)
    return convert.cloud_message(points, time_ns)


def read(cloud: PointCloud2, at: float) -> Reports:
    """The reports of a message whose stamp is `at` s. ConversionError where it is none."""
    points = rows(cloud, WANTED)
    numbers = {name: points[name].astype(np.float64) for name in NUMBERS}
    status, ship_type = points['status'].astype(np.int64), points['ship_type'].astype(np.int64)
    return Reports(
        numbers['heard'] + at,
        numbers['time'] + at,
        points['timed'] > 0,
        points['mmsi'].astype(np.int64),
        points['type'].astype(np.int8),
        numbers['latitude'],
        numbers['longitude'],
        points['accurate'] > 0,
        numbers['speed'],
        numbers['course'],
        numbers['heading'],
        numbers['turn'],
        np.where(status == NONE, -1, status).astype(np.int8),
        text_of(points['name']),
        text_of(points['call_sign']),
        np.where(ship_type == NO_TYPE, -1, ship_type),
        points['size'].astype(np.float64).reshape(-1, 4),
    )


def sane(reports: Reports) -> BoolArray:
    """Mask [R] of reports whose places are on Earth or none, and whose times are finite."""
    with np.errstate(invalid='ignore'):
        off = (np.abs(reports.latitude) > 90) | (np.abs(reports.longitude) > 180)
    found: BoolArray = ~off & np.isfinite(reports.heard) & np.isfinite(reports.time)
    return found & (reports.mmsi > 0)


def codes(words: np.ndarray, length: int) -> np.ndarray:
    """Characters [N, length] of ASCII words [N], 0 behind their ends."""
    fixed = np.ascontiguousarray(words.astype(f'S{length}'))
    return np.frombuffer(fixed.tobytes(), np.uint8).reshape(len(words), length)


def text_of(codes: np.ndarray) -> np.ndarray:
    """Words [N] of characters [N, length]."""
    return np.array([bytes(row).rstrip(b'\0').decode('ascii', 'replace') for row in codes], 'U20')
