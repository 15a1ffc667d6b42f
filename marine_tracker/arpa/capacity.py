"""Who gives way where there are more targets than may be.

Targets acquired by hand and dangerous ones (`Situation.danger` above SAFE) never give way. The
others stand in the order of their least distance to own ship within the TCPA limit
(`Situation.nearest`). What is acquired by hand, or dangerous, takes the place of the last of them;
any other track only if it comes nearer than CLOSER times that, so that the two do not change places
again and again. The rest waits.
"""

import numpy as np

from ..types import BoolArray, CodeArray, IntArray
from .situation import SAFE, Situation
from .targets import AUTOMATIC

CLOSER = 0.8


def make_room(
    capacity: int, situation: Situation, how: CodeArray, candidate: BoolArray, clicked: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Who becomes a target and who gives way, by the rule that stands above: rows of tracks.

    how        [N]  AUTOMATIC or MANUAL, -1 where the track is no target; the clicked ones are in
    candidate  [N]  tracks to be acquired automatically, as far as there is room
    clicked    [C]  new targets by hand

    Returns the candidates taken, the targets that give way, and those of the clicked that find no
    room because nobody may give way to them.
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
