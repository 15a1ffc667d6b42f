"""The state of a node for /diagnostics: named counters, and statuses made from them."""

import functools
from collections import Counter, deque
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from .convert import header

OK, WARN, ERROR, STALE = (
    DiagnosticStatus.OK,
    DiagnosticStatus.WARN,
    DiagnosticStatus.ERROR,
    DiagnosticStatus.STALE,
)
FAILED = 'callbacks failed'
LONGEST = 300  # characters of what somebody else wrote, in a log or a message
FRESH_S = 10.0  # s; a fault counts as present for this long after it was last seen


class Tally:
    """Counts by reason, and which reasons are recent.

    on_first(reason, detail) is called the first time a reason comes up. The detail is one line.
    """

    def __init__(self, reasons: Iterable[str], on_first: Callable[[str, str], None]) -> None:
        self.counts: Counter[str] = Counter({reason: 0 for reason in reasons})
        self._last: dict[str, float] = {}
        self._on_first = on_first

    def add(self, reason: str, wall: float, count: int = 1, detail: str = '') -> None:
        """`count` more, at the time `wall` s of a steady clock."""
        if reason not in self._last:
            self._on_first(reason, one_line(detail))
        self.counts[reason] += count
        self._last[reason] = wall

    def fresh(self, wall: float) -> list[str]:
        """The reasons seen recently."""
        return [reason for reason, last in self._last.items() if wall - last < FRESH_S]


def answered(callback: Callable[[Any, Any], str]) -> Callable[[Any, Any, Any], Any]:
    """Makes a method that returns its answer a callback of a service with success and message."""

    @functools.wraps(callback)
    def run_answered(self, request, response):
        response.message, response.success = callback(self, request), True
        return response

    return run_answered


def one_line(text: object, longest: int = LONGEST) -> str:
    """Text for a log or a message: one line of printable characters, cut in the middle.

    So a name of 100,000 characters fills neither the log nor the disk.
    """
    line = str(text)
    half = longest // 2
    if len(line) > longest:
        line = f'{line[:half]} ... ({len(line)} characters) ... {line[-half:]}'
    return ' '.join(''.join(c if c.isprintable() else ' ' for c in line).split())


class Durations:
    """The last durations of something, s."""

    def __init__(self, count: int = 200) -> None:
        self._last: deque[float] = deque(maxlen=count)

    def add(self, seconds: float) -> None:
        """Adds one; the oldest is removed."""
        self._last.append(seconds)

    def percentile(self, percent: float) -> float:
        """s, the value nearest in rank among the last ones; 0 if there are none yet."""
        if not self._last:
            return 0.0
        return sorted(self._last)[round(percent / 100 * (len(self._last) - 1))]


def status(
    name: str, hardware_id: str, level: bytes, message: str, values: Mapping[str, Any]
) -> DiagnosticStatus:
    """One entry of /diagnostics."""
    return DiagnosticStatus(
        level=level,
        name=name,
        message=message,
        hardware_id=hardware_id,
        values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
    )


def array(time_ns: int, statuses: list[DiagnosticStatus]) -> DiagnosticArray:
    """The message."""
    return DiagnosticArray(header=header(time_ns, ''), status=statuses)
