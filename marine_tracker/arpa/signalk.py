"""Signal K deltas of targets, one vessel each, because Signal K servers ignore TTM and TLL.

A server takes one delta in each UDP datagram. Units are SI; bearings and courses are true (Signal K
specification 1.7, "Delta format" and vessels/*/navigation).
"""

import json
import uuid
from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from ..geodesy import wrap_longitude
from ..types import Array
from .nmea import LOST, Targets

SOURCE = {'label': 'marine_tracker', 'type': 'radar'}


def context(namespace: uuid.UUID, number: int) -> str:
    """A target's vessel context; the same namespace and number always give the same."""
    return f'vessels.urn:mrn:signalk:uuid:{uuid.uuid5(namespace, str(number))}'


def deltas(
    targets: Targets,
    numbers: Sequence[int],
    latitude: Array,
    longitude: Array,
    time: float,
    namespace: uuid.UUID,
) -> list[str]:
    """One delta a target, JSON without line ends.

    targets              N of them
    numbers              their own numbers, not shortened to two digits
    latitude, longitude  [N] deg; nan if unknown
    time                 s of UTC since 1970
    namespace            distinguishes this radar's targets from those of others

    Unknown values are left out. For a lost target all values of its motion are null, which tells
    the server that they are no longer known.
    """
    stamp = datetime.fromtimestamp(time, UTC).isoformat(timespec='milliseconds')
    stamp = stamp.replace('+00:00', 'Z')
    said = []
    for number, status, name, north, east, *figures in zip(
        numbers,
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
        said.append(
            json.dumps(
                {
                    'context': context(namespace, number),
                    'updates': [{'source': SOURCE, 'timestamp': stamp, 'values': told}],
                }
            )
        )
    return said


def _number(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _known(**values: float) -> dict[str, float] | None:
    """The values, or None if one is unknown."""
    return values if all(np.isfinite(value) for value in values.values()) else None
