"""Simulated AIS reports as sentences, with the resolution that messages have."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from pyais import encode_dict

from .. import m1371
from ..geodesy import LocalFrame
from ..geometry import KNOT
from .transponders import Sent

CHANNELS = 'AB'


def encode(
    sent: Sent, frame: LocalFrame, names: Sequence[str], epoch: float
) -> Iterator[tuple[float, list[str]]]:
    """When each report is heard, s, and its sentences.

    frame  of positions
    names  of the targets
    epoch  s of UTC since 1970 at time 0: messages tell the second
    """
    latitude, longitude = frame.to_geodetic(sent.position)
    for k in range(len(sent.time)):
        own = sent.ship[k] == 0
        fields: dict[str, Any] = {'mmsi': int(sent.mmsi[k])}
        name = 'OWN SHIP' if own else names[int(sent.ship[k]) - 1].upper()
        if sent.static[k]:
            fields.update(_static(sent, k, name))
        else:
            fields.update(_dynamic(sent, k))
            fields['lat'], fields['lon'] = float(latitude[k]), float(longitude[k])
            fields['second'] = int(sent.time[k] + epoch) % 60
        messages = [fields]
        if fields['type'] == 24:
            messages = [{**fields, 'partno': 0}, {**fields, 'partno': 1}]
        lines = []
        for message in messages:
            lines += encode_dict(
                message,
                talker_id='AI',
                sentence_type='VDO' if own else 'VDM',
                radio_channel=CHANNELS[k % 2],
                seq_id=k % 10,
            )
        yield float(sent.heard[k]), lines


def _dynamic(sent: Sent, k: int) -> dict[str, Any]:
    """Message 1 or 18."""
    heading = sent.heading[k]
    fields = {
        'type': 18 if sent.kind[k] == m1371.CLASS_B else 1,
        'speed': min(round(float(sent.speed[k]) / KNOT, 1), 102.2),
        'course': round(float(np.degrees(sent.course[k])), 1) % 360,
        'heading': 511 if np.isnan(heading) else round(float(np.degrees(heading))) % 360,
    }
    if fields['type'] == 1:
        turn = sent.turn[k]
        per_minute = float(np.degrees(turn)) * 60
        fields['turn'] = -128 if np.isnan(turn) else float(np.clip(per_minute, -700.0, 700.0))
        fields['status'] = int(sent.status[k]) if sent.status[k] >= 0 else 15
    return fields


def _static(sent: Sent, k: int, name: str) -> dict[str, Any]:
    """Message 5 or 24."""
    bow, stern, port, starboard = (int(one) for one in sent.size[k])
    return {
        'type': 24 if sent.kind[k] == m1371.CLASS_B else 5,
        'shipname': name[:20],
        'callsign': f'T{int(sent.mmsi[k]) % 1_000_000:06d}',
        'ship_type': 37 if sent.kind[k] == m1371.CLASS_B else 70,
        'to_bow': bow,
        'to_stern': stern,
        'to_port': port,
        'to_starboard': starboard,
    }
