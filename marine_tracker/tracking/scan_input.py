"""The scans of one radar as they come: screened, timed, and with own ship during each.

The node and the replay of a recording of its topics use the same, so both track the same scans.
"""

import statistics
from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple

from ..types import Array, PolarPlots, Scan
from . import intake, own_ship, rotation
from .radars import Radar

MISSED = 'revolutions missed'
PART_UNKNOWN = 'messages left out: the part of a revolution is not known yet'
NO_STAMP = 'messages without a stamp: timed as they arrived'
UNKNOWN = 4.0  # revolutions; so long messages wait for the antenna's rotation to be known
LEADS = 15  # scans; more than ever wait in a queue


class Came(NamedTuple):
    """How the plots of a revolution came.

    arrival   s, by a clock of ours (intake.admit_scan)
    now_ns    by the clock of stamps
    start_ns  their stamp; 0 for none
    seconds   s of a stamp in ns
    """

    arrival: float
    now_ns: int
    start_ns: int
    seconds: Callable[[int], float]


class ScanInput:
    """Of one radar; count(reason, count, detail) is called for each fault.

    order   what the next scan's time is judged by
    taken   scans so far
    """

    def __init__(self, radar: Radar, place: int, count: Callable[[str, int, str], None]) -> None:
        self.radar, self._place, self._count = radar, place, count
        self.order = intake.TimeOrder()
        self.taken = 0
        self.plots_in_scan = 0
        self._starts: deque[float] = deque(maxlen=10)
        self._rotation = rotation.begin()
        self._stamped_alike = False
        self._samples = 0  # of own ship, taken before the last scan
        self._leads: deque[float] = deque(maxlen=LEADS)

    @property
    def revolution(self) -> float:
        """s of one revolution, also where each message is a sector of it."""
        return self._rotation.period if self.in_sectors else self.period

    @property
    def in_sectors(self) -> bool:
        """Whether a message is a sector."""
        return self._rotation.known and self._rotation.sector(0.0, self.period) is not None

    @property
    def period(self) -> float:
        """s between messages: as measured, or by parameter until there is enough to measure. It is
        a revolution, or a sector of it."""
        if len(self._starts) < 4:
            return self.radar.parameters.scan_period_s
        starts = list(self._starts)
        return statistics.median(b - a for a, b in zip(starts, starts[1:]))

    def scan_of(
        self,
        plots: PolarPlots,
        came: Came,
        own_log: own_ship.OwnShipLog,
        others: Sequence[intake.TimeOrder],
        way: Array,
        heading: float,
        unswept: Array | None = None,
    ) -> tuple[Scan, str, own_ship.OwnShipLog] | None:
        """The scan in the tracker's time, the fallback for own ship, and her log, in which what
        waited may be confirmed by the scan; None where the scan is rejected.

        plots    their time counts from the stamp
        others   the orders of the other radars
        way      [2] m/s, own ship's way through the water, should her positions be lost; nan: none
        heading  rad, hers now; nan: not known
        unswept  gaps, as in Scan
        """
        parameters, period, start_ns = self.radar.parameters, self.period, came.start_ns
        plots, rejected = intake.screen_plots(plots, period, parameters.max_plots)
        for reason, count in rejected.items():
            self._count(reason, count, '')
        if not start_ns:
            start_ns = came.now_ns - round(1e9 * max(period, plots.time.max(initial=0.0)))
            self._count(NO_STAMP, 1, '')
        start, before = came.seconds(start_ns), self.order.last
        self.order, taken, reason = intake.admit_scan(
            self.order, start, period, others, came.arrival, own_log.newest
        )
        if reason:
            self._count(reason, 1, f'stamp {start_ns * 1e-9:.3f} s')
        if not taken:
            return None
        if reason == intake.REBASED:
            self._starts.clear()
            self._rotation = rotation.begin()
        elif start - before > 1.5 * period:
            self._count(MISSED, round((start - before) / period) - 1, '')
        self._starts.append(start)
        if not self._turns(start, plots):
            self._count(PART_UNKNOWN, 1, '')
            return None

        # Recordings may stamp all plots of a scan alike; an antenna never does.
        if len(plots.time):
            self._stamped_alike = not plots.time.any()
        alike = self._stamped_alike and not self.in_sectors
        length = 0.0 if alike else max(period, plots.time.max(initial=0.0))
        end, shift = start + length, self.order.shift
        own_log, timeout = own_ship.confirmed(own_log, end), parameters.own_ship_timeout_s
        own_log = own_ship.reckoned(own_log, end, came.arrival, timeout, way, heading)
        own, fallback = own_ship.own_ship_for(
            own_log, start, end, timeout, parameters.own_ship_velocity, self._lead(own_log, end)
        )
        if fallback == own_ship.OWN_BY_ARRIVAL:
            self._count(fallback, 1, '')
        if own_log.reckoned:
            fallback = own_ship.OWN_RECKONED
        self.taken += 1
        self.plots_in_scan = len(plots.time)
        scan = Scan(
            start + shift,
            end + shift,
            plots._replace(time=plots.time + start + shift),
            own._replace(time=own.time + shift),
            self._place,
            sector=self._rotation.sector(start, end) if self.in_sectors else None,
            unswept=unswept,
        )
        return scan, fallback, own_log

    def _turns(self, start: float, plots: PolarPlots) -> bool:
        """Whether it is known what part of a revolution a message is, which begins at `start` s."""
        stated, starts = self.radar.parameters.scan_period_s, list(self._starts)
        spacing = statistics.median([b - a for a, b in zip(starts, starts[1:])] or [stated])
        if spacing > rotation.PART * stated:
            self._rotation = rotation.begin()
            return True
        self._rotation = rotation.hear(
            self._rotation, start, start + plots.time, plots.bearing, stated, spacing
        )
        waited = start - self._rotation.begun
        return self._rotation.known or waited > UNKNOWN * stated

    def _lead(self, own_log: own_ship.OwnShipLog, end: float) -> float:
        """s that own ship's stamps lie ahead of the plots': behind, where she was heard since the
        last scan; ahead, by the least of many scans, for some may have waited in a queue."""
        samples, self._samples = self._samples, own_log.number
        if not own_log.number:
            return 0.0
        lead = float(own_log.taken.time[-1]) - end
        self._leads.append(lead)
        if lead < 0:
            return lead if own_log.number > samples else 0.0
        return min(self._leads) if len(self._leads) == LEADS else 0.0
