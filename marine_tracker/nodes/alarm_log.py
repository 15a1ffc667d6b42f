"""Alerts in the log, each once: when it is raised."""

from collections.abc import Sequence
from typing import Any

from ..arpa import alarm_text, alarms
from ..arpa.alerts import Alerts, Raised
from ..arpa.zones import Zones
from .diagnostics import one_line

TOLD_AS_WARNING = ('alarm', 'warning')  # priorities; what is less, and losses, are information


class AlarmLog:
    """Of one tracker node; logger: that of the node."""

    def __init__(self, logger: Any) -> None:
        self._logger = logger
        self._raised = Raised()

    def tell(self, changed: Alerts, zones: Zones, radars: Sequence[str]) -> None:
        """Logs those of the changed alerts that were not raised already."""
        texts = alarm_text.text(changed, zones, radars)
        for row in self._raised.rows(changed):
            kind = int(changed.kind[row])
            if alarms.PRIORITY[kind] in TOLD_AS_WARNING and kind != alarms.LOST_TARGET:
                self._logger.warning(one_line(texts[row]))
            else:
                self._logger.info(one_line(texts[row]))
