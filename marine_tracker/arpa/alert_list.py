"""The list of alerts as a bridge shows it: in order, and the history of those that are settled."""

import numpy as np

from ..types import IntArray, append, take
from .alerts import (
    ACTIVE_ACKNOWLEDGED,
    ACTIVE_SILENCED,
    ACTIVE_UNACKNOWLEDGED,
    NORMAL,
    RECTIFIED_UNACKNOWLEDGED,
    Alerts,
)

REMEMBERED = 100  # settled alerts
# States in the order of the list.
ORDER = np.argsort(
    [ACTIVE_UNACKNOWLEDGED, ACTIVE_SILENCED, RECTIFIED_UNACKNOWLEDGED, ACTIVE_ACKNOWLEDGED, NORMAL]
)


def in_order(alerts: Alerts, rank: IntArray) -> Alerts:
    """Sorted by priority, then by state, then the newest first.

    rank  [kinds]  of each kind's priority, 0 for the highest
    """
    by = -alerts.instance, -alerts.raised, ORDER[alerts.state], rank[alerts.kind]
    return take(alerts, np.lexsort(by))


def settled(history: Alerts, changed: Alerts) -> Alerts:
    """The history with those of the changed alerts that are settled; the newest are last."""
    over = take(changed, (changed.state == NORMAL) & ~np.isnan(changed.raised))
    history = append(history, over)
    return take(history, slice(max(len(history.kind) - REMEMBERED, 0), None))
