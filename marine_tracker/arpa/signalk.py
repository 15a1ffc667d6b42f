"""Signal K deltas of targets, one vessel each, for Signal K servers ignore TTM and TLL; and of
alerts, as notifications of own ship.

A server takes one delta in each UDP datagram. Units are SI; bearings and courses are true (Signal K
specification 1.7, "Delta format", vessels/*/navigation and notifications).
"""

import json
import re
import uuid
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Any, NamedTuple

import numpy as np

from ..geodesy import wrap_longitude
from ..types import Array
from .alerts import ACTIVE_ACKNOWLEDGED, NORMAL, STATES
from .nmea import LOST, Targets

SOURCE = {'label': 'marine_tracker', 'type': 'radar'}
STATE = {'alarm': 'alarm', 'warning': 'warn', 'caution': 'alert'}  # of a notification, by priority


def context(namespace: uuid.UUID, number: int) -> str:
    """A target's vessel context; the same namespace and number always give the same.

    namespace  distinguishes this radar's targets from those of others
    number     the target's own, not shortened to two digits
    """
    return f'vessels.urn:mrn:signalk:uuid:{uuid.uuid5(namespace, str(number))}'


def deltas(
    targets: Targets, contexts: Sequence[str], latitude: Array, longitude: Array, time: float
) -> list[str]:
    """One delta a target, JSON without line ends.

    targets              N of them
    contexts             the vessel of each, as `context` makes it
    latitude, longitude  [N] deg; nan if unknown
    time                 s of UTC since 1970

    Unknown values are left out. For a lost target all values of its motion are null, which tells
    the server that they are no longer known.
    """
    said = []
    for vessel, status, name, north, east, *figures in zip(
        contexts,
        targets.status.tolist(),
        targets.name.tolist(),
        np.asarray(latitude).tolist(),
        wrap_longitude(np.asarray(longitude)).tolist(),
        *(column.tolist() for column in targets[-4:]),
    ):
        speed, course, cpa, tcpa = figures
        values = {
            'navigation.position': _known(latitude=north, longitude=east)
            if abs(north) <= 90
            else None,
            'navigation.courseOverGroundTrue': _number(course % (2 * np.pi)),
            'navigation.speedOverGround': _number(speed),
            'navigation.closestApproach': _known(distance=cpa, timeTo=tcpa),
        }
        lost = status == LOST
        told = [{'path': '', 'value': {'name': name}}] + [
            {'path': path, 'value': None if lost else value}
            for path, value in values.items()
            if lost or value is not None
        ]
        said.append(_delta(vessel, time, told))
    return said


class Alert(NamedTuple):
    """An alert as told: name, as `TT07: danger`; text; its priority and its state, in the words
    of alarms.PRIORITY and alerts.STATES."""

    name: str
    text: str
    priority: str
    state: str


def notifications(alerts: Sequence[Alert], radar: str, time: float) -> list[str]:
    """One delta of own ship for each alert.

    radar  a word for the path, as the node has it; time  s of UTC since 1970

    One that is acknowledged is shown and makes no sound; one that has become normal is told so.
    """
    said = []
    for one in alerts:
        words = re.sub(r'[^A-Za-z0-9]+', '_', one.name).strip('_')
        normal = one.state == STATES[NORMAL]
        silent = normal or one.state == STATES[ACTIVE_ACKNOWLEDGED]
        value = {
            'state': 'normal' if normal else STATE.get(one.priority, 'alert'),
            'method': [] if normal else ['visual'] if silent else ['visual', 'sound'],
            'message': one.text,
        }
        path = f'notifications.radar.{radar}.{words}'
        said.append(_delta('vessels.self', time, [{'path': path, 'value': value}]))
    return said


def _delta(context: str, time: float, values: list[dict[str, Any]]) -> str:
    stamp = datetime.fromtimestamp(time, UTC).isoformat(timespec='milliseconds')
    stamp = stamp.replace('+00:00', 'Z')
    update = {'source': SOURCE, 'timestamp': stamp, 'values': values}
    return json.dumps({'context': context, 'updates': [update]})


def _number(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _known(**values: float) -> dict[str, float] | None:
    """The values, or None if one is unknown."""
    return values if all(np.isfinite(value) for value in values.values()) else None
