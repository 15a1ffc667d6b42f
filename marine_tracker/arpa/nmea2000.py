"""NMEA 2000: each target as PGN 128520, Tracked Target Data, in lines of text for gateways.

A line is one frame of the bus, as `17:33:21.107 R 09F60823 20 1C 00 07 ...`: time, direction, CAN
identifier, data. Gateways of Yacht Devices give and take it, programs read it from UDP. The package
`nmea2000` encodes, by the database of CANboat (canboat.github.io).
"""

import importlib
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Any

import numpy as np

from .nmea import ACQUIRING, AUTOMATIC, LOST, REPORTED, TRACKING, Targets

PGN, NAME = 128520, 'trackedTargetData'
PRIORITY, EVERYBODY = 2, 255
SOURCE = 35  # address on the bus; a gateway puts its own in its place
STATUS = {ACQUIRING: 1, TRACKING: 2, LOST: 3}
TRUE = 0  # bearings
SETS = 253  # sequence numbers of data that belong together
FORMAT = 'can_frame_ascii_raw'

Lines = Callable[[Targets, float, int], list[str]]


def encoder() -> Lines:
    """lines(targets, time, reference): several lines a target, without line ends.

    time       s of UTC since 1970, of the targets
    reference  number of the target that tells the motion of the ground; 0: none

    What is not known is sent as not available. ImportError where `nmea2000` is not installed.
    """
    message, format_ = (
        importlib.import_module(f'nmea2000.{name}') for name in ('message', 'encoder')
    )
    encode = format_.create_encoder(FORMAT).encode
    sets = 0

    def field(name: str, value: float | str | None = None, code: float | None = None) -> Any:
        return message.NMEA2000Field(name, value=value, raw_value=code)

    def lines(targets: Targets, time: float, reference: int) -> list[str]:
        nonlocal sets
        sets = (sets + 1) % SETS
        said: list[str] = []
        moment = datetime.fromtimestamp(time, UTC)
        for number, status, acquired, name, *figures in zip(*(c.tolist() for c in targets)):
            known = [value if np.isfinite(value) else None for value in figures]
            distance, bearing, speed, course, cpa, tcpa = known
            fields = [
                field('sid', sets),
                field('targetId', number),
                field('trackStatus', code=STATUS[status]),
                field('reportedTarget', code=int(acquired == REPORTED)),
                field('targetAcquisition', code=int(acquired == AUTOMATIC)),
                field('bearingReference', code=TRUE),
                field('bearing', bearing),
                field('distance', distance),
                field('course', course),
                field('speed', speed),
                field('cpa', cpa),
                field('tcpa', tcpa),
                field('utcOfFix', code=time % 86400.0),
                field('name', name),
                field('referenceTarget', code=int(number == reference)),
            ]
            told = message.NMEA2000Message(
                PGN,
                NAME,
                fields=fields,
                source=SOURCE,
                destination=EVERYBODY,
                priority=PRIORITY,
                timestamp=moment,
            )
            said += encode(told)
        return said

    return lines
