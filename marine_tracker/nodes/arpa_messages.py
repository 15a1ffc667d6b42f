"""`alarms` and `trial` as messages: one readable entry for each alert, and for each target of a
trial.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from ..ais.ais import ACTIVATED, AisPicture
from ..ais.join import BOTH
from ..ais.passing import motion_of
from ..arpa import alarm_text, alarms, alerts
from ..arpa.alarms import PLOTS_MISSING
from ..arpa.alerts import NORMAL, Alerts
from ..arpa.arpa import Arpa, Picture
from ..arpa.motion import Motion
from ..arpa.own_path import TrialManoeuvre, countdown
from ..arpa.situation import LIKELY
from ..arpa.stabilisation import NONE
from ..arpa.targets import label
from ..arpa.trial_manoeuvre import safe_courses, trial_approach
from ..arpa.zones import Zones
from ..geometry import KNOT, NAUTICAL_MILE
from ..types import IntArray, append, take
from . import diagnostics
from .diagnostics import ERROR, OK, WARN
from .targets_message import degrees, figure

LEVEL = {'alarm': ERROR, 'warning': WARN, 'caution': WARN}
TRIAL = 'T'  # stands for a trial, as on every radar screen


def alarms_message(
    shown: Alerts, zones: Zones, radars: Sequence[str], now: float, time_ns: int, hardware_id: str
) -> DiagnosticArray:
    """The alerts, in the order of their rows; now s, in the same time as theirs."""
    return diagnostics.array(time_ns, _entries(shown, zones, radars, now, hardware_id, _present))


def alarms_past_message(
    settled: Alerts, zones: Zones, radars: Sequence[str], now: float, time_ns: int, hardware_id: str
) -> DiagnosticArray:
    """Those that are settled, the newest first: each with its times, s ago."""
    newest_first = take(settled, slice(None, None, -1))
    entries = _entries(newest_first, zones, radars, now, hardware_id, _past)
    return diagnostics.array(time_ns, entries)


Row = dict[str, Any]


def _entries(
    shown: Alerts,
    zones: Zones,
    radars: Sequence[str],
    now: float,
    hardware_id: str,
    values: Callable[[Row, float], dict[str, str]],
) -> list[DiagnosticStatus]:
    columns = {name: getattr(shown, name).tolist() for name in shown._fields}
    names = label(shown.id, shown.number)
    columns['target'] = [name if id else '' for id, name in zip(columns['id'], names)]
    columns['part'] = alarm_text.parts(shown, zones, radars)
    columns['text'] = alarm_text.text(shown, zones, radars)
    rows = (dict(zip(columns, row)) for row in zip(*columns.values()))
    return [_alert(row, hardware_id, values(row, now)) for row in rows]


def _alert(row: Row, hardware_id: str, values: dict[str, str]) -> DiagnosticStatus:
    kind = row['kind']
    what, priority, of_radar = alarms.NAMES[kind], alarms.PRIORITY[kind], kind == PLOTS_MISSING
    where = f' {"of" if of_radar else "in"} {row["part"]}' if row['part'] else ''
    return diagnostics.status(
        (f'{row["target"]}: ' if row['target'] else '') + what + where,
        hardware_id,
        OK if row['state'] == NORMAL else LEVEL[priority],
        row['text'],
        {
            'kind': what,
            'priority': priority,
            'category': alarms.CATEGORY[kind],
            'identifier': alarms.IDENTIFIER[kind],
            'instance': row['instance'],
            'state': alerts.STATES[row['state']],
            'target': row['target'],
            'zone': '' if of_radar else row['part'],
            **values,
        },
    )


def _present(row: Row, now: float) -> dict[str, str]:
    return {
        'in_state_s': figure(now - row['since'], 0),
        'raised_s': figure(now - row['raised'], 0),
        'sounds': str(row['sounds']),
        'acknowledged_for_min': figure((row['until'] - now) / 60, 1),
        'east_m': figure(row['position'][0], 0),
        'north_m': figure(row['position'][1], 0),
    }


def _past(row: Row, now: float) -> dict[str, str]:
    return {
        'raised_s': figure(now - row['raised'], 0),
        'acknowledged_s': figure(now - row['seen'], 0),
        'ended_s': figure(now - row['since'], 0),
    }


def lacking(picture: Picture) -> str:
    """What own ship lacks for a trial or for areas of danger; '' where nothing."""
    own = picture.own
    if not own.velocity.any() and np.isnan(own.heading):
        return 'own ship lies still, heading unknown'
    if not own.north or picture.stabilised.reference == NONE:
        return "own ship's course and speed are not known"
    return ''


def all_targets(picture: Picture, ships: AisPicture | None) -> tuple[Motion, IntArray, IntArray]:
    """Radar targets, then the activated ships that are none: motion (nan where it is not told), ids
    (of ships below 0), numbers (of ships MMSI)."""
    targets = picture.targets
    if ships is None:
        return picture.motion, targets.id, targets.number
    rows = ((ships.shown == ACTIVATED) & (ships.joined.state != BOTH) & ~ships.ships.lost).nonzero()
    known, moving = take(ships.ships, rows[0]), take(ships.moving, rows[0])
    motion = motion_of(moving, picture.stabilised.drift)
    place = np.where(moving.told[:, None], moving.position, np.nan)
    return (
        append(picture.motion, motion._replace(position=place)),
        np.concatenate([targets.id, -known.id]),
        np.concatenate([targets.number, known.mmsi]),
    )


def trial_message(
    arpa: Arpa,
    picture: Picture,
    ships: AisPicture | None,
    elapsed: float,
    time_ns: int,
    hardware_id: str,
) -> DiagnosticArray:
    """The effect of the trial manoeuvre that was begun `elapsed` s ago.

    The first entry, T, has the trial itself, its countdown and the safe courses. One entry for each
    target follows, and for each activated ship of AIS that is no radar target. If own ship's course
    at the start of the turn is unknown, T says so.
    """
    p, limits, own = arpa.parameters, arpa.limits, picture.own
    why_not = lacking(picture)
    if why_not:
        return diagnostics.array(
            time_ns, [diagnostics.status(TRIAL, hardware_id, WARN, f'no TRIAL: {why_not}', {})]
        )
    trial = countdown(
        TrialManoeuvre(
            np.radians(p.trial_course_deg),
            p.trial_speed_kn * KNOT,
            60 * p.trial_delay_min,
            np.radians(p.trial_turn_rate_deg_min) / 60,
            p.trial_acceleration_mps2,
        ),
        elapsed,
    )
    motion, ids, numbers = all_targets(picture, ships)
    found = trial_approach(motion, own, trial, limits.cpa, limits.tcpa)
    safe = safe_courses(motion, own, trial, limits.cpa, limits.tcpa)
    sectors = ', '.join(
        f'{np.degrees(first):03.0f}-{np.degrees(last):03.0f}' for first, last in safe.sectors
    )
    entries = [
        diagnostics.status(
            TRIAL,
            hardware_id,
            OK,
            'TRIAL',
            {
                'course_deg': degrees(p.trial_course_deg),
                'speed_kn': figure(p.trial_speed_kn, 1),
                'stabilised': picture.stabilised.reference,
                'countdown_min': figure(trial.delay / 60, 1),
                'safe_courses_deg': sectors or 'none',
            },
        )
    ]
    dangerous = (found.cpa < limits.cpa) & (found.tcpa >= 0) & (found.tcpa < limits.tcpa)
    dangerous |= found.danger_probability >= LIKELY
    for name, cpa, tcpa, probability, danger in zip(
        label(ids, numbers),
        (found.cpa / NAUTICAL_MILE).tolist(),
        (found.tcpa / 60).tolist(),
        found.danger_probability.tolist(),
        dangerous.tolist(),
    ):
        entries.append(
            diagnostics.status(
                name,
                hardware_id,
                ERROR if danger else OK,
                'TRIAL',
                {
                    'cpa_nm': figure(cpa, 3),
                    'tcpa_min': figure(tcpa, 1),
                    'danger_probability': figure(probability, 2),
                },
            )
        )
    return diagnostics.array(time_ns, entries)
