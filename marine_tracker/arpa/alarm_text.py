"""What an alert says, in words, nautical miles, minutes and degrees."""

import math

from ..geometry import NAUTICAL_MILE
from . import alarms
from .alerts import Alerts
from .targets import label
from .zones import Zones


def text(alerts: Alerts, zones: Zones) -> list[str]:
    """One sentence for each alert: what is the matter, with the values at its last change."""
    named = dict(zip(zones.key.tolist(), zones.name))
    return [_sentence(kind, name, named.get(zone, 'no longer set'), values)
            for kind, name, zone, values in zip(
                alerts.kind.tolist(), label(alerts.id, alerts.number), alerts.zone.tolist(),
                alerts.values.tolist())]


def _sentence(kind: int, name: str, zone: str, values: list[float]) -> str:
    first, second, third, fourth, fifth = values
    where = f'{first / NAUTICAL_MILE:.2f} NM, {round(math.degrees(second), 1) % 360:05.1f} deg'
    if kind == alarms.DANGER:
        when = f'in {fourth / 60:.1f} min' if math.isfinite(fourth) else 'at an unknown time'
        return (f'{name} dangerous: CPA {third / NAUTICAL_MILE:.2f} NM {when}, probability '
                f'{100 * fifth:.0f} %, then at {where}')
    if kind == alarms.LOST_TARGET:
        return f'{name} lost, last at {where}'
    if kind == alarms.NEW_TARGET:
        return f'{name} in guard zone {zone}, at {where}'
    if kind == alarms.NEAR_CAPACITY:
        return f'{first:.0f} targets, {second:.0f} may be'
    if kind == alarms.CAPACITY:
        return f'{first:.0f} targets, as many as may be; {third:.0f} more are not acquired'
    if kind == alarms.FALLBACK:
        return f'{first:.0f} of {second:.0f} targets have fallen back from their filter'
    if kind == alarms.SWAP_RISK:
        other = f'TT{third:02.0f}' if third else 'a track that is not confirmed'
        return f'{name} may be swapped with {other}, at {where}'
    silent = f'for {first:.0f} s' if math.isfinite(first) else 'so far'
    return f'no {alarms.NAMES[kind].removesuffix(" missing")} {silent}'
