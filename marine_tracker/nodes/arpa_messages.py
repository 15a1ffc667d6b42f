"""`alarms` and `trial` as messages: one readable entry for each alert, and for each target of a
trial.
"""

from collections.abc import Sequence

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from ..arpa import alarm_text, alarms, alerts
from ..arpa.alerts import NORMAL, Alerts
from ..arpa.arpa import Arpa, Picture
from ..arpa.own_path import TrialManoeuvre, countdown
from ..arpa.situation import LIKELY
from ..arpa.stabilisation import NONE
from ..arpa.targets import label
from ..arpa.trial_manoeuvre import safe_courses, trial_approach
from ..arpa.zones import Zones
from ..geometry import KNOT, NAUTICAL_MILE
from . import diagnostics
from .diagnostics import ERROR, OK, WARN
from .targets_message import degrees, figure

LEVEL = {'alarm': ERROR, 'warning': WARN, 'caution': WARN}
TRIAL = 'T'  # stands for a trial, as on every radar screen


def alarms_message(
    shown: Alerts, zones: Zones, radars: Sequence[str], now: float, time_ns: int, hardware_id: str
) -> DiagnosticArray:
    """The alerts, in the order of their rows; now s, in the same time as theirs."""
    targets = [
        name if id else '' for id, name in zip(shown.id.tolist(), label(shown.id, shown.number))
    ]
    return diagnostics.array(
        time_ns,
        [
            _alert(kind, target, part, state, age, left, position, text, hardware_id)
            for kind, target, part, state, age, left, position, text in zip(
                shown.kind.tolist(),
                targets,
                alarm_text.parts(shown, zones, radars),
                shown.state.tolist(),
                (now - shown.since).tolist(),
                ((shown.until - now) / 60).tolist(),
                shown.position.tolist(),
                alarm_text.text(shown, zones, radars),
            )
        ],
    )


def _alert(
    kind: int,
    target: str,
    part: str,
    state: int,
    age: float,
    left: float,
    position: Sequence[float],
    text: str,
    hardware_id: str,
) -> DiagnosticStatus:
    what, priority = alarms.NAMES[kind], alarms.PRIORITY[kind]
    of_radar = kind == alarms.PLOTS_MISSING
    where = f' {"of" if of_radar else "in"} {part}' if part else ''
    name = (f'{target}: ' if target else '') + what + where
    return diagnostics.status(
        name,
        hardware_id,
        OK if state == NORMAL else LEVEL[priority],
        text,
        {
            'kind': what,
            'priority': priority,
            'state': alerts.STATES[state],
            'target': target,
            'zone': '' if of_radar else part,
            'in_state_s': figure(age, 0),
            'acknowledged_for_min': figure(left, 1),
            'east_m': figure(position[0], 0),
            'north_m': figure(position[1], 0),
        },
    )


def trial_message(
    arpa: Arpa, picture: Picture, elapsed: float, time_ns: int, hardware_id: str
) -> DiagnosticArray:
    """The effect of the trial manoeuvre that was begun `elapsed` s ago.

    The first entry, T, has the trial itself, its countdown and the safe courses. One entry for each
    target follows. If own ship's course at the start of the turn is unknown, T says so.
    """
    p, limits, own = arpa.parameters, arpa.limits, picture.own
    lacking = ''
    if not own.velocity.any() and np.isnan(own.heading):
        lacking = 'own ship lies still, heading unknown'
    elif not own.north or picture.stabilised.reference == NONE:
        lacking = "own ship's course and speed are not known"
    if lacking:
        return diagnostics.array(
            time_ns, [diagnostics.status(TRIAL, hardware_id, WARN, f'no TRIAL: {lacking}', {})]
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
    found = trial_approach(picture.motion, own, trial, limits.cpa, limits.tcpa)
    safe = safe_courses(picture.motion, own, trial, limits.cpa, limits.tcpa)
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
        label(picture.targets.id, picture.targets.number),
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
