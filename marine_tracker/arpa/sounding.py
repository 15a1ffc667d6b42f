"""When alerts sound, the same for every listener: at once, again, and not while silenced.

An alert sounds when it becomes active unacknowledged. The operator may silence all that sound:
they are active silenced for SILENT, then they sound again. A new alert sounds at once, whatever is
silenced. A warning sounds once, and again after REPEAT as long as nobody has acknowledged it. How
an alarm and a warning sound, and that an alarm goes on, is for the display. Cautions are silent.
"""

import numpy as np

from ..types import BoolArray, take
from .alerts import ACTIVE_SILENCED, ACTIVE_UNACKNOWLEDGED, Alerts, in_state

SILENT = 30.0  # s
REPEAT = 300.0  # s


def silence(alerts: Alerts, now: float) -> tuple[Alerts, Alerts]:
    """All that sound are silenced at `now` s; and those that changed."""
    loud = alerts.state == ACTIVE_UNACKNOWLEDGED
    alerts = in_state(alerts, np.where(loud, ACTIVE_SILENCED, alerts.state), now)
    return alerts, take(alerts, loud)


def pass_time(alerts: Alerts, warning: BoolArray, now: float) -> tuple[Alerts, Alerts]:
    """The alerts at `now` s; and those that begin to sound again. warning [kinds]: their kinds."""
    loud = (alerts.state == ACTIVE_SILENCED) & (now - alerts.since >= SILENT)
    again = (alerts.state == ACTIVE_UNACKNOWLEDGED) & warning[alerts.kind]
    again &= now - alerts.sounded >= REPEAT
    alerts = in_state(alerts, np.where(loud, ACTIVE_UNACKNOWLEDGED, alerts.state), now)
    alerts = alerts._replace(
        sounded=np.where(again, now, alerts.sounded), sounds=alerts.sounds + again
    )
    return alerts, take(alerts, loud | again)
