"""Scans to track, wherever they come from."""

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from ..types import Scan


def _nothing() -> tuple[str, ...]:
    return ()


class Source(NamedTuple):
    """Scans to track.

    scans               (number, scan) in time order
    total               how many; None where it is not known
    tracker_parameters  those that belong to the radar and its waters
    remarks             what people should know of the files that were read
    told                the same of what was found on the way, once the scans are through
    """

    scans: Iterable[tuple[int, Scan]]
    total: int | None
    tracker_parameters: dict[str, Any]
    remarks: tuple[str, ...] = ()
    told: Callable[[], tuple[str, ...]] = _nothing
