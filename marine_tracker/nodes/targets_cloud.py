"""`targets_cloud`: the targets of a scan as numbers, in one message. Fields: doc/topics.md.

Lengths in m, times in s, angles in rad clockwise from true north; nan where nothing is known.
"""

import numpy as np
from sensor_msgs.msg import PointCloud2

from ..arpa import alarms
from ..arpa.alerts import ACTIVE_ACKNOWLEDGED, WAITING, Alerts
from ..arpa.stationary import Stationary
from ..arpa.view import View
from ..tracking.lifecycle import STATIONARY
from ..types import IntArray
from . import cloud_layout, convert
from .faults import BAD_LAYOUT, MISSING_FIELD, MISTYPED_FIELD, TRUNCATED, ConversionError

COVARIANCE = {  # of [x, y, vx, vy]: row and column of each field
    'xx': (0, 0),
    'xy': (0, 1),
    'yy': (1, 1),
    'vxvx': (2, 2),
    'vxvy': (2, 3),
    'vyvy': (3, 3),
    'xvx': (0, 2),
    'xvy': (0, 3),
    'yvx': (1, 2),
    'yvy': (1, 3),
}
MEASURED = (  # fields of arpa.cpa.Approach, each with a standard deviation
    'range',
    'bearing',
    'course',
    'speed',
    'relative_course',
    'relative_speed',
    'cpa',
    'tcpa',
    'bow_range',
    'bow_time',
)
SIZES = ('length', 'length_sd', 'beam', 'heading', 'heading_sd')  # fields of extent.hulls.Shapes
AT_REST = 2  # of the field motion, beside STEADY and MANOEUVRING of arpa.motion
NO_ALARM, ACKNOWLEDGED, UNACKNOWLEDGED = range(3)  # of the field alarm

# What sentences are made of has all its digits; RViz wants x, y, z as float32.
TARGET_TYPE = np.dtype(
    [('number', '<u4'), ('id', '<u4'), ('mmsi', '<u4')]
    + [(name, '<f4') for name in ('x', 'y', 'z', 'vx', 'vy', *COVARIANCE)]
    + [(name + of, kind) for name in MEASURED for of, kind in (('', '<f8'), ('_sd', '<f4'))]
    + [('relative_bearing', '<f8')]
    + [(name, '<f4') for name in ('danger_probability', *SIZES, 'hull_clearance')]
    + [(name, 'u1') for name in ('status', 'alarm', 'acquired', 'motion', 'reference')]
)


def message(seen: View, alerts: Alerts, time_ns: int, mmsi: IntArray | None = None) -> PointCloud2:
    """The targets of a view, in its order; alerts: those that are not normal.

    mmsi  [T] of the ship of AIS that each is joined to, 0 for none; None: of none
    """
    rows = np.zeros(len(seen.id), TARGET_TYPE)
    motion, approach = seen.motion, seen.approach
    rows['number'], rows['id'] = seen.number, seen.id
    rows['mmsi'] = 0 if mmsi is None else mmsi
    rows['x'], rows['y'] = motion.position.T
    rows['vx'], rows['vy'] = motion.velocity.T
    for name, (row, column) in COVARIANCE.items():
        rows[name] = motion.covariance[:, row, column]
    for name in MEASURED:
        rows[name] = getattr(approach, name)
        rows[name + '_sd'] = getattr(approach, name + '_sigma')
    still = approach.speed == 0  # who lies still has no course
    rows['course'][still] = rows['course_sd'][still] = np.nan
    rows['relative_bearing'] = seen.bow
    rows['danger_probability'] = approach.danger_probability
    for name in (*SIZES, 'hull_clearance'):
        rows[name] = np.nan
    if seen.hulls is not None:
        sized = seen.hulls.shapes.extended
        for name in SIZES:
            rows[name] = np.where(sized, getattr(seen.hulls.shapes, name), np.nan)
        rows['hull_clearance'] = seen.hulls.clearance
    rows['status'], rows['acquired'] = seen.status, seen.acquired
    rows['reference'] = seen.reference
    rows['motion'] = np.where(motion.stationary, AT_REST, motion.memory)
    for states, value in (((ACTIVE_ACKNOWLEDGED,), ACKNOWLEDGED), (WAITING, UNACKNOWLEDGED)):
        of = alerts.id[(alerts.kind == alarms.DANGER) & np.isin(alerts.state, states)]
        rows['alarm'][np.isin(seen.id, of)] = value
    if seen.fixed is not None:
        rows = np.append(rows, _stationary(seen.fixed))
    return convert.cloud_message(rows, time_ns)


def _stationary(fixed: Stationary) -> np.ndarray:
    """Rows of objects that are stationary: status STATIONARY and no id; nan for what targets only
    have."""
    rows = np.zeros(len(fixed.shown.number), TARGET_TYPE)
    for name in TARGET_TYPE.names or ():
        if TARGET_TYPE[name].kind == 'f' and name not in ('z', 'vx', 'vy', 'speed'):
            rows[name] = np.nan
    rows['number'], rows['status'], rows['motion'] = fixed.shown.number, STATIONARY, AT_REST
    rows['x'], rows['y'] = fixed.shown.position.T
    rows['xx'] = rows['yy'] = fixed.shown.variance
    rows['xy'] = 0.0
    for name in ('range', 'bearing', 'cpa', 'tcpa', 'danger_probability'):
        rows[name] = getattr(fixed.approach, name)
    return rows


def read(cloud: PointCloud2, kind: np.dtype = TARGET_TYPE) -> np.ndarray:
    """The points as an array [T] of this kind; ConversionError where it is not such a cloud.

    Fields may stand in any order, and others beside them.
    """
    fields = {field.name: field for field in cloud.fields}
    order = '>' if cloud.is_bigendian else '<'
    formats, offsets = [], []
    for name in kind.names or ():
        wanted = kind[name].str[1:]
        if name not in fields:
            raise ConversionError(MISSING_FIELD, name)
        found = cloud_layout.KINDS.get(fields[name].datatype)
        if found != wanted or fields[name].count > 1:
            raise ConversionError(MISTYPED_FIELD, f'{name} is {found}; it must be one {wanted}')
        if fields[name].offset + kind[name].itemsize > cloud.point_step:
            raise ConversionError(BAD_LAYOUT, f'{name} ends beyond a point')
        formats.append(order + wanted)
        offsets.append(fields[name].offset)
    count = cloud.width * cloud.height
    if len(cloud.data) != count * cloud.point_step:
        raise ConversionError(
            TRUNCATED, f'{len(cloud.data)} bytes; {count * cloud.point_step} announced'
        )
    point = np.dtype(
        {
            'names': list(kind.names or ()),
            'formats': formats,
            'offsets': offsets,
            'itemsize': cloud.point_step,
        }
    )
    return np.frombuffer(cloud.data, point, count).astype(kind)
