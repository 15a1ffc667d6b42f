"""How the node fares, for /diagnostics: counters with names, and statuses from them."""

import functools
import time
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
FRESH_S = 10.0  # a fault counts as present for so long after it was last seen


class Tally:
    """Counts by reason, and which reasons are fresh.

    on_first(reason, detail) is called the first time a reason comes up.
    """

    def __init__(self, reasons: Iterable[str], on_first: Callable[[str, str], None]):
        self.counts: Counter[str] = Counter({reason: 0 for reason in reasons})
        self._last: dict[str, float] = {}
        self._on_first = on_first

    def add(self, reason: str, wall: float, count: int = 1, detail: str = '') -> None:
        """`count` more, at the time `wall` s of a steady clock."""
        if reason not in self._last:
            self._on_first(reason, detail)
        self.counts[reason] += count
        self._last[reason] = wall

    def fresh(self, wall: float) -> list[str]:
        """The reasons seen lately."""
        return [reason for reason, last in self._last.items() if wall - last < FRESH_S]


def guarded(callback):
    """A method as callback: no exception leaves it; it is counted in `self.failures`, and told
    once for each kind."""

    @functools.wraps(callback)
    def run_guarded(self, *arguments):
        try:
            callback(self, *arguments)
        except Exception as error:
            self.failures.add(
                f'{FAILED}: {type(error).__name__} in {callback.__name__}',
                time.monotonic(),
                detail=str(error),
            )

    return run_guarded


def answered(callback):
    """A method that returns what to answer, as callback of a service: `guarded` likewise."""

    @functools.wraps(callback)
    def run_answered(self, request, response):
        try:
            response.message = callback(self, request)
            response.success = True
        except Exception as error:
            self.failures.add(
                f'{FAILED}: {type(error).__name__} in {callback.__name__}',
                time.monotonic(),
                detail=str(error),
            )
            response.success, response.message = False, str(error)
        return response

    return run_answered


class Durations:
    """The last durations of something, s."""

    def __init__(self, count: int = 200):
        self._last: deque[float] = deque(maxlen=count)

    def add(self, seconds: float) -> None:
        """One more; the oldest goes."""
        self._last.append(seconds)

    def percentile(self, percent: float) -> float:
        """s, of the last ones the nearest in rank; 0 when there are none yet."""
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
