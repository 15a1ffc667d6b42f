"""ROS messages as plain values for the page: lists, numbers, None where there is no number.

Lengths in m, times in s, angles in rad clockwise from true north, as in the messages.
"""

import math
import re
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from ..tracking.lifecycle import STATIONARY
from .diagnostics import one_line

LEVELS = {
    DiagnosticStatus.OK: 'ok',
    DiagnosticStatus.WARN: 'warning',
    DiagnosticStatus.ERROR: 'error',
    DiagnosticStatus.STALE: 'stale',
}
COLUMNS = {  # of `targets_cloud`, with their decimals
    'x': 1,
    'y': 1,
    'vx': 3,
    'vy': 3,
    'xx': 1,
    'xy': 1,
    'yy': 1,
    'danger_probability': 3,
    'length': 0,
    'length_sd': 0,
    'beam': 0,
    'heading': 4,
    'heading_sd': 4,
    **{
        name + ending: digits
        for name, digits in (
            ('range', 0),
            ('bearing', 4),
            ('course', 4),
            ('speed', 2),
            ('cpa', 0),
            ('tcpa', 0),
            ('bow_range', 0),
            ('bow_time', 0),
        )
        for ending in ('', '_sd')
    },
}
WHOLE = ('number', 'id', 'status', 'alarm', 'acquired', 'motion')
MOST_ALARMS = 200
NUMBER, MMSI = re.compile(r'TT(\d+)'), re.compile(r'AIS (\d{9})')
SECTOR = re.compile(r'(\d+)-(\d+)')


def plain(values: np.ndarray, digits: int) -> list[float | None]:
    """Rounded numbers [N]; None for what is not finite."""
    rounded = np.round(values.astype(float), digits)
    if digits == 0:
        return [int(v) if math.isfinite(v) else None for v in rounded.tolist()]
    return [v if math.isfinite(v) else None for v in rounded.tolist()]


def targets(rows: np.ndarray) -> dict[str, list]:
    """The columns of `targets_cloud` that the page shows, without stationary objects."""
    rows = rows[~_fixed(rows)]
    return {name: rows[name].tolist() for name in WHOLE} | {
        name: plain(rows[name], digits) for name, digits in COLUMNS.items()
    }


def stationary(rows: np.ndarray) -> list[list[float | None]]:
    """[number, x, y] of each stationary object in `targets_cloud`."""
    fixed = rows[_fixed(rows)]
    places = zip(plain(fixed['x'], 1), plain(fixed['y'], 1))
    return [[number, x, y] for number, (x, y) in zip(fixed['number'].tolist(), places)]


def _fixed(rows: np.ndarray) -> np.ndarray:
    """Mask [T] of the rows that are no target, but a stationary object."""
    return (rows['status'] == STATIONARY) & (rows['id'] == 0)


def alarms(message: DiagnosticArray) -> list[dict[str, Any]]:
    """The alerts that are not normal, in the order of the topic `alarms`."""
    found = []
    for entry in message.status[:MOST_ALARMS]:
        values = values_of(entry)
        if values.get('state', 'normal') == 'normal':
            continue
        name = values.get('target', '')
        target, ship = NUMBER.fullmatch(name), MMSI.fullmatch(name)
        found.append(
            {
                'name': one_line(entry.name),
                'text': one_line(entry.message),
                'kind': values.get('kind', ''),
                'priority': values.get('priority', ''),
                'category': values.get('category', ''),
                'identifier': values.get('identifier', ''),
                'instance': int(number(values.get('instance')) or 0),
                'sounds': int(number(values.get('sounds')) or 0),
                'state': values['state'],
                'number': int(target[1]) if target else 0,
                'mmsi': int(ship[1]) if ship else 0,
                'in_state_s': number(values.get('in_state_s')),
                'x': number(values.get('east_m')),
                'y': number(values.get('north_m')),
            }
        )
    return found


def alarms_past(message: DiagnosticArray) -> list[dict[str, Any]]:
    """The alerts that are settled, the newest first; times in s since 1970."""
    stamp = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
    found = []
    for entry in message.status[:MOST_ALARMS]:
        values = values_of(entry)
        times = {}
        for name in ('raised', 'acknowledged', 'ended'):
            ago = number(values.get(f'{name}_s'))
            times[name] = None if ago is None else round(stamp - ago)
        found.append(
            {
                'name': one_line(entry.name),
                'text': one_line(entry.message),
                'priority': values.get('priority', ''),
                'instance': int(number(values.get('instance')) or 0),
                **times,
            }
        )
    return found


def trial(message: DiagnosticArray) -> dict[str, Any]:
    """The trial manoeuvre: its own entry first, then one for each target; off where empty."""
    if not message.status:
        return {'on': False}
    first, *others = message.status
    about = values_of(first)
    return {
        'on': True,
        'text': one_line(first.message),
        'course_deg': number(about.get('course_deg')),
        'speed_kn': number(about.get('speed_kn')),
        'countdown_min': number(about.get('countdown_min')),
        'safe_deg': [
            [int(a), int(b)] for a, b in SECTOR.findall(about.get('safe_courses_deg', ''))
        ],
        'targets': [
            {
                'name': one_line(entry.name),
                'cpa_nm': number(values.get('cpa_nm')),
                'tcpa_min': number(values.get('tcpa_min')),
                'danger_probability': number(values.get('danger_probability')),
                'danger': entry.level == DiagnosticStatus.ERROR,
            }
            for entry, values in ((entry, values_of(entry)) for entry in others)
        ],
    }


def health(message: DiagnosticArray) -> dict[str, dict[str, str]]:
    """How the parts of the service fare, by name."""
    return {
        one_line(entry.name): {
            'level': LEVELS.get(entry.level, 'error'),
            'text': one_line(entry.message),
            'estimator': values_of(entry).get('estimator', ''),
        }
        for entry in message.status
    }


def values_of(entry: DiagnosticStatus) -> dict[str, str]:
    """Its keys and values, each one line."""
    return {pair.key: one_line(pair.value) for pair in entry.values}


def number(text: str | None) -> float | None:
    """The number that a text is; None where it is none, or not finite."""
    try:
        value = float(text or '')
    except ValueError:
        return None
    return value if math.isfinite(value) else None
