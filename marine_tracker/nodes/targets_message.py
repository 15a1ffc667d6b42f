"""`targets`: one entry for each target, which reads like the row of a table."""

import math

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from ..ais.ais import AisPicture
from ..arpa.motion import MEMORY_NAMES
from ..arpa.situation import DANGEROUS
from ..arpa.targets import LETTERS
from ..arpa.view import View
from ..geometry import KNOT, NAUTICAL_MILE
from ..tracking.lifecycle import COASTING, CONFIRMED, LOST, REASONS, STATIONARY, TENTATIVE
from . import ais_columns, hull_columns
from .convert import time_message
from .diagnostics import ERROR, OK, STALE, WARN

# Values with a standard deviation: key, field of arpa.cpa.Approach, unit, digits.
DEGREE = math.radians(1)
MEASURED = (
    ('range', 'nm', 'range', NAUTICAL_MILE, 3),
    ('bearing', 'deg', 'bearing', DEGREE, 1),
    ('course', 'deg', 'course', DEGREE, 1),
    ('speed', 'kn', 'speed', KNOT, 1),
    ('relative_course', 'deg', 'relative_course', DEGREE, 1),
    ('relative_speed', 'kn', 'relative_speed', KNOT, 1),
    ('cpa', 'nm', 'cpa', NAUTICAL_MILE, 3),
    ('tcpa', 'min', 'tcpa', 60.0, 1),
    ('bow_range', 'nm', 'bow_range', NAUTICAL_MILE, 2),
    ('bow_time', 'min', 'bow_time', 60.0, 1),
)
COLUMNS = (
    *(f'{key}_{unit}' for key, unit, *_ in MEASURED),
    'relative_bearing_deg',
    'danger_probability',
    'motion',
    'motion_since_min',
    'acquired',
    'swap_risk',
    'stabilised',
    'reference',
    'position_sd_m',
    *(f'{key}_sd_{unit}' for key, unit, *_ in MEASURED),
    'estimator',
    'estimator_state',
    'rho',
    'j',
    'j_fallback',
    'fallback_reason',
    'hits_in_10',
    'age_min',
    'reason',
)
LEVEL = {TENTATIVE: OK, CONFIRMED: OK, COASTING: WARN, LOST: STALE, STATIONARY: OK}
MESSAGE = {
    TENTATIVE: 'ACQUIRING',
    CONFIRMED: 'TRACKING',
    COASTING: 'COASTING',
    LOST: 'LOST',
    STATIONARY: 'STATIONARY',
}


class TargetsWriter:
    """Fills one DiagnosticArray again and again; new messages would cost ten times as much."""

    def __init__(self, hardware_id: str) -> None:
        self._hardware_id = hardware_id
        self._keys: tuple[str, ...] = COLUMNS
        self._entries: list[DiagnosticStatus] = []

    def message(
        self,
        seen: View,
        estimator: str,
        time: float,
        time_ns: int,
        ships: AisPicture | None = None,
        symbol: str = 'ais',
    ) -> DiagnosticArray:
        """The targets of a view at `time` s, stamped time_ns; valid until the next call.

        ships   of AIS then; symbol: whose data comes first of a target with both, ais or radar
        """
        rows = table(seen, estimator, time)
        names, levels, places = stationary_rows(seen)
        messages = [MESSAGE[STATIONARY]] * len(names)
        keys = COLUMNS if seen.hulls is None else COLUMNS + hull_columns.COLUMNS
        if ships is not None:
            keys += ais_columns.COLUMNS
            of_ais = ais_columns.of_targets(seen, ships, figure, degrees, symbol)
            rows = [row + more for row, more in zip(rows, of_ais)]
            added = ais_columns.alone(ships, figure, degrees)
            names, levels = names + added[0], levels + added[1]
            messages, places = messages + added[2], places + added[3]
        if keys != self._keys:
            self._keys, self._entries = keys, []
        while len(self._entries) < len(rows) + len(places):
            self._entries.append(
                DiagnosticStatus(
                    hardware_id=self._hardware_id, values=[KeyValue(key=key) for key in keys]
                )
            )
        for entry, name, status, dangerous, fallen, row in zip(
            self._entries,
            seen.name,
            seen.status.tolist(),
            seen.dangerous.tolist(),
            seen.account.reason.tolist(),
            rows,
        ):
            entry.name, entry.message = name, MESSAGE[status]
            entry.level = LEVEL[status]
            if status != LOST and dangerous:
                entry.level = ERROR
            elif status == CONFIRMED and fallen:
                entry.level = WARN
            for pair, text in zip(entry.values, row):
                pair.value = text
        for entry, name, text, level, told in zip(
            self._entries[len(rows) :], names, messages, levels, places
        ):
            entry.name, entry.message, entry.level = name, text, level
            for pair in entry.values:
                pair.value = told.get(pair.key, '')
        message = DiagnosticArray(status=self._entries[: len(rows) + len(places)])
        message.header.stamp = time_message(time_ns)
        return message


def table(seen: View, estimator: str, time: float) -> list[tuple[str, ...]]:
    """One row of texts for each target, in the order of COLUMNS; with hulls, their columns too."""
    motion, account = seen.motion, seen.account
    # A target at rest has no course.
    approach = seen.approach._replace(
        **{
            name: np.where(seen.approach.speed == 0, np.nan, getattr(seen.approach, name))
            for name in ('course', 'course_sigma')
        }
    )
    values, deviations = [], []
    for _, unit, field, size, digits in MEASURED:
        numbers = (getattr(approach, field) / size).tolist()
        angle = unit == 'deg'
        values.append([degrees(number) if angle else figure(number, digits) for number in numbers])
        deviations.append(
            [
                figure(number, digits)
                for number in (getattr(approach, field + '_sigma') / size).tolist()
            ]
        )
    rest = np.where(motion.stationary, 2, motion.memory).tolist()
    words = (*MEMORY_NAMES, 'at rest')
    position_sd = np.sqrt(np.trace(motion.covariance[:, :2, :2], axis1=1, axis2=2))
    columns = [
        *values,
        [degrees(number) for number in np.degrees(seen.bow).tolist()],
        [figure(number, 2) for number in approach.danger_probability.tolist()],
        [words[which] for which in rest],
        [figure(number, 1) for number in ((time - motion.since) / 60).tolist()],
        [LETTERS[how] for how in seen.acquired.tolist()],
        [figure(risk, 2) if risk >= 0.005 else '' for risk in seen.swap_risk.tolist()],
        [seen.stabilised] * len(rest),
        ['R' if fixed else '' for fixed in seen.reference.tolist()],
        [figure(number, 0) for number in position_sd.tolist()],
        *deviations,
        [estimator] * len(rest),
        [account.states[state] for state in account.state.tolist()],
        *(
            [figure(number, 2) for number in of.tolist()]
            for of in (account.rho, account.j, account.j_fallback)
        ),
        [account.reasons[reason] for reason in account.reason.tolist()],
        [str(count) for count in seen.hits.tolist()],
        [figure(number, 1) for number in (seen.age / 60).tolist()],
        [
            _reason(*row)
            for row in zip(seen.status.tolist(), seen.reason.tolist(), seen.misses.tolist())
        ],
    ]
    if seen.hulls is not None:
        columns += hull_columns.columns(seen.hulls, degrees, figure)
    return list(zip(*columns))


def stationary_rows(seen: View) -> tuple[list[str], list[bytes], list[dict[str, str]]]:
    """Names, levels and values by key of the stationary objects: ST12, and a warning where own ship
    will pass it within the limits."""
    fixed = seen.fixed
    if fixed is None:
        return [], [], []
    passing = fixed.approach
    north = bool(np.isfinite(seen.approach.bearing).any() or not len(seen.id))
    told = [
        {
            'range_nm': figure(range_ / NAUTICAL_MILE, 3),
            'bearing_deg': degrees(bearing / DEGREE) if north else '',
            'speed_kn': '0.0',
            'cpa_nm': figure(cpa / NAUTICAL_MILE, 3),
            'tcpa_min': figure(tcpa / 60, 1),
            'motion': 'at rest',
            'position_sd_m': figure(sigma, 0),
        }
        for range_, bearing, cpa, tcpa, sigma in zip(
            passing.range.tolist(),
            passing.bearing.tolist(),
            passing.cpa.tolist(),
            passing.tcpa.tolist(),
            np.sqrt(2 * fixed.shown.variance).tolist(),
        )
    ]
    return (
        [f'ST{number:02d}' for number in fixed.shown.number.tolist()],
        [WARN if danger == DANGEROUS else OK for danger in fixed.danger.tolist()],
        told,
    )


def degrees(angle: float) -> str:
    """000.0 to 359.9, as on a ship; empty for nan."""
    return f'{round(angle, 1) % 360:05.1f}' if math.isfinite(angle) else ''


def figure(value: float, digits: int) -> str:
    """The value with `digits` decimals; empty for nan."""
    return f'{value:.{digits}f}' if math.isfinite(value) else ''


def _reason(status: int, reason: int, misses: int) -> str:
    if status == LOST:
        return REASONS[reason]
    if status == COASTING:
        return f'no plot in {misses} scan{"s" if misses > 1 else ""}'
    return ''
