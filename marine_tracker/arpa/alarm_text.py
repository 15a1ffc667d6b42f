"""What an alert says, in words, nautical miles, minutes and degrees."""

import math
from collections.abc import Sequence

from ..geometry import KNOT, NAUTICAL_MILE
from . import alarms
from .alerts import Alerts
from .targets import label
from .zones import Zones

NO_LONGER = 'no longer set'  # a zone


def text(alerts: Alerts, zones: Zones, radars: Sequence[str] = ('',)) -> list[str]:
    """One sentence for each alert: what is the matter, with the values at its last change.

    radars  their names; '' where there is only one
    """
    return [
        _sentence(kind, name, part or NO_LONGER, values)
        for kind, name, part, values in zip(
            alerts.kind.tolist(),
            label(alerts.id, alerts.number),
            parts(alerts, zones, radars),
            alerts.values.tolist(),
        )
    ]


def parts(alerts: Alerts, zones: Zones, radars: Sequence[str] = ('',)) -> list[str]:
    """The zone or the radar that each alert names; '' for none."""
    named = dict(zip(zones.key.tolist(), zones.name))
    return [
        radars[zone] if kind == alarms.PLOTS_MISSING else named.get(zone, '')
        for kind, zone in zip(alerts.kind.tolist(), alerts.zone.tolist())
    ]


def _sentence(kind: int, name: str, part: str, values: list[float]) -> str:
    first, second, third, fourth, fifth = values
    where = f'{first / NAUTICAL_MILE:.2f} NM'
    if math.isfinite(second):  # nan without a heading
        where += f', {round(math.degrees(second), 1) % 360:05.1f} deg'
    if kind in (alarms.DANGER, alarms.AIS_DANGER):
        when = f'in {fourth / 60:.1f} min' if math.isfinite(fourth) else 'at an unknown time'
        return (
            f'{name} dangerous: CPA {third / NAUTICAL_MILE:.2f} NM {when}, probability '
            f'{100 * fifth:.0f} %, then at {where}'
        )
    if kind in (alarms.LOST_TARGET, alarms.AIS_LOST):
        return f'{name} lost, last at {where}'
    if kind == alarms.NEW_TARGET:
        return f'{name} in guard zone {part}, at {where}'
    if kind == alarms.NEAR_CAPACITY:
        return f'{first:.0f} targets, {second:.0f} may be'
    if kind == alarms.CAPACITY:
        return f'{first:.0f} targets, as many as may be; {third:.0f} more are not acquired'
    if kind == alarms.FALLBACK:
        return f'{first:.0f} of {second:.0f} targets have fallen back from their filter'
    if kind == alarms.SWAP_RISK:
        other = f'TT{third:02.0f}' if third else 'a track that is not confirmed'
        return f'{name} may be swapped with {other}, at {where}'
    if kind == alarms.STATIONARY_DANGER:
        if not first:  # over: of what is gone nothing is known
            return 'nothing stationary in the way'
        when = f'in {fifth / 60:.1f} min' if math.isfinite(fifth) else 'at an unknown time'
        at = f'{second / NAUTICAL_MILE:.2f} NM'
        if math.isfinite(third):
            at += f', {round(math.degrees(third), 1) % 360:05.1f} deg'
        return (
            f'{first:.0f} stationary in the way: the first {when}, '
            f'CPA {fourth / NAUTICAL_MILE:.2f} NM, now at {at}'
        )
    if kind in alarms.OF_AIS:
        return _of_ais(kind, name, where if math.isfinite(first) else 'a place not told', third)
    if kind == alarms.AIS_CAPACITY:
        return f'{first:.0f} ships of AIS, {second:.0f} may be'
    if kind == alarms.OWN_SPEED:
        return f"own ship's speed as told is {first / KNOT:.1f} kn off the way of her positions"
    silent = f'for {first:.0f} s' if math.isfinite(first) else 'so far'
    of = f' of radar {part}' if kind == alarms.PLOTS_MISSING and part != NO_LONGER else ''
    then = ': relative bearings only' if kind == alarms.HEADING_MISSING and second == 1 else ''
    return f'no {alarms.NAMES[kind].removesuffix(" missing")}{of} {silent}{then}'


def _of_ais(kind: int, name: str, where: str, value: float) -> str:
    if kind == alarms.AIS_MISMATCH:
        return f'{name} says {where}: {value:.0f} m off her echo, or not the same ship'
    if kind == alarms.AIS_TWICE:
        return f'{name} is used by two ships, one at {where}'
    what = 'distress beacon' if kind == alarms.AIS_SART else 'test of a distress beacon'
    return f'{name}: {what} at {where}'
