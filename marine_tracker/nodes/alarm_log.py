"""Alerts in the log, each once: when it is raised."""

from collections.abc import Sequence
from typing import Any

from ..arpa import alarm_text, alarms
from ..arpa.alerts import NORMAL, Alerts
from ..arpa.zones import Zones
from .diagnostics import one_line

TOLD_AS_WARNING = ('alarm', 'warning')  # priorities; what is less, and losses, are information


class AlarmLog:
    """Of one tracker node; logger: that of the node."""

    def __init__(self, logger: Any) -> None:
        self._logger = logger
        self._raised: set[tuple[int, ...]] = set()  # those that are not normal

    def tell(self, changed: Alerts, zones: Zones, radars: Sequence[str]) -> None:
        """Logs those of the changed alerts that were not raised already."""
        keys = zip(changed.kind.tolist(), changed.zone.tolist(), changed.id.tolist())
        texts = alarm_text.text(changed, zones, radars)
        for key, state, text in zip(keys, changed.state.tolist(), texts):
            if state == NORMAL:
                self._raised.discard(key)
            elif key not in self._raised:
                self._raised.add(key)
                kind = key[0]
                grave = alarms.PRIORITY[kind] in TOLD_AS_WARNING and kind != alarms.LOST_TARGET
                if grave:
                    self._logger.warning(one_line(text))
                else:
                    self._logger.info(one_line(text))
