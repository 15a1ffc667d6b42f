"""AIS in `targets`: columns of targets that are joined, an entry for each ship that is not."""

from collections.abc import Callable

import numpy as np

from .. import m1371
from ..ais.ais import ACTIVATED, AisPicture
from ..ais.join import APART_STATE, BOTH, STATES, joined_to
from ..arpa.situation import DANGEROUS
from ..arpa.view import View
from ..geometry import KNOT, NAUTICAL_MILE
from .diagnostics import ERROR, OK, STALE, WARN

COLUMNS = (
    'mmsi',
    'ship_name',
    'call_sign',
    'source',
    'ais_state',
    'ais_probability',
    'ais_speed_kn',
    'ais_course_deg',
    'heading_deg',
    'turn_deg_per_min',
    'navigational_status',
    'ais_position',
    'ais_age_s',
)
MISSING = 'missing'  # of AIS data that is absent (MSC.192(79) 5.28.4)
Texts = Callable[[float, int], str]


def of_targets(
    seen: View, ships: AisPicture, figure: Texts, degrees: Callable[[float], str], symbol: str
) -> list[tuple[str, ...]]:
    """The columns of each target; empty for those that no ship is joined to."""
    row = joined_to(ships.joined, ships.ships, seen.id)
    nothing = ('',) * len(COLUMNS)
    cells = _cells(ships, np.unique(row[row >= 0]).tolist(), figure, degrees, symbol)
    return [cells.get(one, nothing) for one in row.tolist()]


def alone(
    ships: AisPicture, figure: Texts, degrees: Callable[[float], str]
) -> tuple[list[str], list[bytes], list[str], list[dict[str, str]]]:
    """Names, levels, messages and values of the activated ships that are no radar target."""
    rows = ((ships.shown == ACTIVATED) & (ships.joined.state != BOTH)).nonzero()[0].tolist()
    cells = _cells(ships, rows, figure, degrees, 'ais')
    passing, known, moving = ships.approach, ships.ships, ships.moving
    names, levels, messages, values = [], [], [], []
    for row in rows:
        lost, danger = bool(known.lost[row]), ships.danger[row] == DANGEROUS
        apart = ships.joined.state[row] == APART_STATE
        names.append(f'AIS {int(known.mmsi[row]):09d}')
        levels.append(STALE if lost else ERROR if danger else WARN if apart else OK)
        messages.append('AIS LOST' if lost else 'AIS MISMATCH' if apart else 'AIS')
        spread = float(np.sqrt(np.trace(moving.covariance[row, :2, :2])))
        values.append(
            {
                **dict(zip(COLUMNS, cells[row])),
                'range_nm': figure(float(passing.range[row]) / NAUTICAL_MILE, 3),
                'bearing_deg': degrees(float(np.degrees(passing.bearing[row]))),
                'course_deg': degrees(float(np.degrees(passing.course[row]))),
                'speed_kn': figure(float(passing.speed[row]) / KNOT, 1),
                'cpa_nm': figure(float(passing.cpa[row]) / NAUTICAL_MILE, 3),
                'tcpa_min': figure(float(passing.tcpa[row]) / 60, 1),
                'cpa_sd_nm': figure(float(passing.cpa_sigma[row]) / NAUTICAL_MILE, 3),
                'tcpa_sd_min': figure(float(passing.tcpa_sigma[row]) / 60, 1),
                'danger_probability': figure(float(passing.danger_probability[row]), 2),
                'position_sd_m': figure(spread, 0),
            }
        )
    return names, levels, messages, values


def _cells(
    ships: AisPicture, rows: list[int], figure: Texts, degrees: Callable[[float], str], symbol: str
) -> dict[int, tuple[str, ...]]:
    """The columns of the ships at the rows."""
    known, joined = ships.ships, ships.joined
    found: dict[int, tuple[str, ...]] = {}
    for row in rows:
        status = int(known.status[row])
        both = joined.state[row] == BOTH
        other = 'radar' if symbol == 'ais' else 'AIS'
        found[row] = (
            f'{int(known.mmsi[row]):09d}',
            str(known.name[row]) or MISSING,
            str(known.call_sign[row]) or MISSING,
            (f'AIS and {other}' if symbol == 'ais' else f'radar and {other}') if both else 'AIS',
            STATES[int(joined.state[row])],
            figure(float(joined.probability[row]), 3),
            figure(float(known.speed[row]) / KNOT, 1) or MISSING,
            degrees(float(np.degrees(known.course[row]))) or MISSING,
            degrees(float(np.degrees(known.heading[row]))) or MISSING,
            figure(float(np.degrees(known.turn[row])) * 60, 0) or MISSING,
            m1371.STATUSES[status] if status >= 0 else MISSING,
            'long range' if known.coarse[row] else 'high' if known.accurate[row] else 'low',
            figure(ships.time - float(known.time[row]), 0),
        )
    return found
