"""`targets`: one entry for each target that reads like the row of a table."""

import math

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from ..geometry import KNOT, NAUTICAL_MILE
from ..tracking.lifecycle import COASTING, CONFIRMED, LOST, REASONS
from .convert import time_message
from .diagnostics import OK, STALE, WARN
from .view import View, names

COLUMNS = ('range_nm', 'bearing_deg', 'course_deg', 'speed_kn', 'position_sd_m', 'course_sd_deg',
           'speed_sd_kn', 'estimator', 'estimator_state', 'rho', 'j', 'j_fallback',
           'fallback_reason', 'hits_in_10', 'age_min', 'reason')
LEVEL = {CONFIRMED: OK, COASTING: WARN, LOST: STALE}
MESSAGE = {CONFIRMED: 'TRACKING', COASTING: 'COASTING', LOST: 'LOST'}


class TargetsWriter:
    """Fills one DiagnosticArray again and again; new messages would cost ten times as much."""

    def __init__(self, hardware_id: str):
        self._hardware_id = hardware_id
        self._entries: list[DiagnosticStatus] = []

    def message(self, seen: View, estimator: str, time_ns: int) -> DiagnosticArray:
        """The targets of a view; valid until the next call."""
        rows = table(seen, estimator)
        while len(self._entries) < len(rows):
            self._entries.append(DiagnosticStatus(
                hardware_id=self._hardware_id, values=[KeyValue(key=key) for key in COLUMNS]))
        for entry, name, status, fallen, row in zip(
                self._entries, names(seen.number), seen.status.tolist(),
                seen.account.reason.tolist(), rows):
            entry.name, entry.message = name, MESSAGE[status]
            entry.level = WARN if fallen and status == CONFIRMED else LEVEL[status]
            for pair, text in zip(entry.values, row):
                pair.value = text
        message = DiagnosticArray(status=self._entries[:len(rows)])
        message.header.stamp = time_message(time_ns)
        return message


def table(seen: View, estimator: str) -> list[tuple[str, ...]]:
    """One row of texts for each target, in the order of COLUMNS."""
    covariance = seen.estimate.covariance
    position_sd = np.sqrt(np.trace(covariance[:, :2, :2], axis1=1, axis2=2))
    sin, cos = np.sin(seen.course), np.cos(seen.course)
    xx, xy, yy = covariance[:, 2, 2], covariance[:, 2, 3], covariance[:, 3, 3]
    along = xx * sin ** 2 + yy * cos ** 2 + 2 * xy * sin * cos
    across = xx * cos ** 2 + yy * sin ** 2 - 2 * xy * sin * cos
    course_sd = np.minimum(np.degrees(np.sqrt(across) / np.maximum(seen.speed, 1e-3)), 180.0)
    numbers = np.column_stack([
        seen.range / NAUTICAL_MILE, np.degrees(seen.bearing), np.degrees(seen.course),
        seen.speed / KNOT, position_sd, course_sd, np.sqrt(along) / KNOT, seen.hits,
        seen.age / 60, seen.misses, seen.status, seen.reason]).tolist()
    account = seen.account
    states, reasons = account.states, account.reasons
    told = [(estimator, states[state], *map(_figure, judged), reasons[reason])
            for state, reason, *judged in zip(
                account.state.tolist(), account.reason.tolist(), account.rho.tolist(),
                account.j.tolist(), account.j_fallback.tolist())]
    return [(f'{range_nm:.2f}', degrees(bearing), degrees(course), f'{speed:.1f}', f'{sd:.0f}',
             f'{course_sd:.0f}', f'{speed_sd:.1f}', *words, f'{hits:.0f}', f'{age:.1f}',
             _reason(int(status), int(reason), int(misses)))
            for words, (range_nm, bearing, course, speed, sd, course_sd, speed_sd, hits, age,
                        misses, status, reason) in zip(told, numbers)]


def degrees(angle: float) -> str:
    """000.0 to 359.9, as seamen write it."""
    return f'{round(angle, 1) % 360:05.1f}'


def _figure(value: float) -> str:
    """Two decimals; nothing where there is no figure."""
    return f'{value:.2f}' if math.isfinite(value) else ''


def _reason(status: int, reason: int, misses: int) -> str:
    if status == LOST:
        return REASONS[reason]
    if status == COASTING:
        return f'no plot in {misses} scan{"s" if misses > 1 else ""}'
    return ''
