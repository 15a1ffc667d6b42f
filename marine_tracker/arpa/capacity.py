"""Which targets are displaced when there are too many.

Targets acquired by hand and dangerous ones (`Situation.danger` above SAFE) are never displaced. The
others are sorted by their least distance to own ship within the TCPA limit (`Situation.nearest`). A
new target that is acquired by hand, or is dangerous, displaces the last of them. Any other track
does so only if its least distance is below CLOSER times that of the last one. This prevents that
two of them displace each other again and again. All other tracks wait.
"""

import numpy as np

from ..types import BoolArray, CodeArray, IntArray
from .situation import SAFE, Situation
from .targets import AUTOMATIC

CLOSER = 0.8


def make_room(
    capacity: int, situation: Situation, how: CodeArray, candidate: BoolArray, clicked: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Which tracks become targets and which are displaced, by the rule above: rows of tracks.

    how        [N]  AUTOMATIC or MANUAL, -1 if the track is not a target; includes the clicked ones
    candidate  [N]  tracks to acquire automatically if there is room
    clicked    [C]  new targets by hand

    Returns the candidates taken, the displaced targets, and the clicked tracks that find no room
    because no target may be displaced.
    """
    safe = situation.danger == SAFE
    yielding = ((how == AUTOMATIC) & safe).nonzero()[0]
    yielding = yielding[np.argsort(-situation.nearest[yielding], kind='stable')]
    over = int((how >= 0).sum()) - capacity
    dropped, yielding = yielding[: max(over, 0)], yielding[max(over, 0) :]
    refused = clicked[max(len(clicked) - max(over - len(dropped), 0), 0) :]
    rows = candidate.nonzero()[0]
    rows = rows[np.lexsort((situation.nearest[rows], safe[rows]))]
    taken, rows = rows[: max(-over, 0)], rows[max(-over, 0) :]
    pairs = min(len(rows), len(yielding))
    rows, yielding = rows[:pairs], yielding[:pairs]
    better = ~safe[rows] | (situation.nearest[rows] < CLOSER * situation.nearest[yielding])
    return (
        np.concatenate([taken, rows[better]]),
        np.concatenate([dropped, yielding[better]]),
        refused,
    )
