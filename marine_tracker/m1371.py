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

TURNING = np.radians(5.0) / 30.0  # rad/s; a class A ship that turns faster reports more often
LONG_RANGE = 180.0  # s between two messages 27
MOST = 999_999_999  # MMSI


def at_rest(status: CodeArray, speed: Array) -> BoolArray:
    """Mask [N] of those at anchor, moored or aground that make less than 3 kn."""
    held = (status == AT_ANCHOR) | (status == MOORED) | (status == AGROUND)
    found: BoolArray = held & ~(speed > 3 * KNOT)
    return found


def interval(kind: CodeArray, status: CodeArray, speed: Array, turn: Array) -> Array:
    """s [N] between two position reports (tables 1 and 2; class B by carrier sense).

    kind, status  [N]  of KINDS and STATUSES; speed [N] m/s, turn [N] rad/s: nan where not known
    A SART sends eight in a burst, once a minute.
    """
    fast, faster, turning = speed > 14 * KNOT, speed > 23 * KNOT, np.abs(turn) > TURNING  # nan: no
    found = np.array([10.0, 180.0, 10.0, 180.0, 60.0])[kind]
    ship = kind == CLASS_A
    found[ship & turning] = 10.0 / 3
    found[ship & fast] = 6.0
    found[ship & (faster | (fast & turning))] = 2.0
    found[ship & at_rest(status, speed)] = 180.0
    found[(kind == CLASS_B) & (speed > 2 * KNOT)] = 30.0
    return found


def kind_of_number(mmsi: IntArray) -> CodeArray:
    """Kind [N] that the number itself tells: SART, man overboard and EPIRB (970, 972, 974),
    aircraft (111), aids to navigation (99); -1 for ships."""
    head = mmsi // 1_000_000
    return np.select(
        [np.isin(head, (970, 972, 974)), head == 111, mmsi // 10_000_000 == 99],
        [SART, AIRCRAFT, AID],
        -1,
    ).astype(np.int8)
