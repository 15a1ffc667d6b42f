"""Where own ship and the targets were, for trails: true ones, and relative ones from both."""

from collections import deque
from typing import Any

import numpy as np

INTERVAL_S = 15.0
MOST = 120  # positions: half an hour


class Trails:
    """Positions at equal intervals of the picture's time, of those that are targets now."""

    def __init__(self) -> None:
        self._own: deque[list[float]] = deque(maxlen=MOST)
        self._targets: dict[int, dict[int, list[float]]] = {}
        self._moment = 0  # counts the intervals
        self._last: float | None = None

    def add(self, time: float, own: Any, ids: Any, position: Any) -> bool:
        """A scan at `time` s: own ship's position [2] m, targets' ids [T] and positions [T, 2] m.

        Returns whether the trails have grown. Where time goes back they begin anew.
        """
        if self._last is not None and time < self._last:
            self.__init__()  # type: ignore[misc]
        if self._last is not None and time - self._last < INTERVAL_S:
            return False
        self._last = time
        self._moment += 1
        self._own.append([round(float(value)) for value in own])
        known = np.isfinite(position).all(1)
        kept = {}
        for id, place, there in zip(ids.tolist(), np.round(position).tolist(), known.tolist()):
            trail = self._targets.get(id, {})
            if there:
                trail[self._moment] = place
            trail.pop(self._moment - MOST, None)
            kept[id] = trail
        self._targets = kept
        return True

    def plain(self) -> dict[str, Any]:
        """own: positions, newest last; targets: by id, as long, None where there was no target;
        count: how many positions there have been, those forgotten among them."""
        moments = range(self._moment - len(self._own) + 1, self._moment + 1)
        return {
            'interval': INTERVAL_S,
            'count': self._moment,
            'own': list(self._own),
            'targets': {
                str(id): [trail.get(moment) for moment in moments]
                for id, trail in self._targets.items()
            },
        }
