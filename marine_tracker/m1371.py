"""What ITU-R M.1371-5 says of AIS: kinds of station, navigational statuses, reporting intervals."""

import numpy as np

from .geometry import KNOT
from .types import Array, BoolArray, CodeArray, IntArray

KINDS = ('class A', 'class B', 'SAR aircraft', 'aid to navigation', 'AIS-SART')
CLASS_A, CLASS_B, AIRCRAFT, AID, SART = range(len(KINDS))
WORDS = ('a', 'b', 'aircraft', 'aid', 'sart')  # of parameters, one for each kind

STATUSES = (
    'under way using engine',
    'at anchor',
    'not under command',
    'restricted manoeuvrability',
    'constrained by draught',
    'moored',
    'aground',
    'fishing',
    'under way sailing',
    'reserved',
    'reserved',
    'towing astern',
    'pushing or towing alongside',
    'reserved',
    'AIS-SART active',
    'AIS-SART test',
)
NO_STATUS = -1
AT_ANCHOR, MOORED, AGROUND, ACTIVE, TEST = 1, 5, 6, 14, 15
HELD = (AT_ANCHOR, MOORED, AGROUND)

TURNING = np.radians(5.0) / 30.0  # rad/s; a class A ship that turns faster reports more often
LONG_RANGE = 180.0  # s between two messages 27
MOST = 999_999_999  # MMSI


def at_rest(status: CodeArray, speed: Array) -> BoolArray:
    """Mask [N] of those at anchor, moored or aground that make less than 3 kn."""
    found: BoolArray = np.isin(status, HELD) & ~(speed > 3 * KNOT)
    return found


def interval(kind: CodeArray, status: CodeArray, speed: Array, turn: Array) -> Array:
    """s [N] between two position reports (tables 1 and 2; class B by carrier sense).

    kind, status  [N]  of KINDS and STATUSES; speed [N] m/s, turn [N] rad/s: nan where not known
    A SART sends eight in a burst, once a minute.
    """
    knots, turning = np.nan_to_num(speed) / KNOT, np.abs(np.nan_to_num(turn)) > TURNING
    moving = np.select(
        [knots > 23, knots > 14, turning], [2.0, np.where(turning, 2.0, 6.0), 10.0 / 3], 10.0
    )
    return np.select(
        [kind == CLASS_A, kind == CLASS_B, kind == AIRCRAFT, kind == AID],
        [
            np.where(at_rest(status, speed), 180.0, moving),
            np.where(knots > 2, 30.0, 180.0),
            10.0,
            180.0,
        ],
        60.0,
    )


def kind_of_number(mmsi: IntArray) -> CodeArray:
    """Kind [N] that the number itself tells: SART, man overboard and EPIRB (970, 972, 974),
    aircraft (111), aids to navigation (99); -1 for ships."""
    head = mmsi // 1_000_000
    return np.select(
        [np.isin(head, (970, 972, 974)), head == 111, mmsi // 10_000_000 == 99],
        [SART, AIRCRAFT, AID],
        -1,
    ).astype(np.int8)
