"""What comes in from one radar: each revolution's plots screened, timed, and made a scan."""

import statistics
import time
from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple

from sensor_msgs.msg import PointCloud2

from ..estimators import WANT_DOPPLER
from ..tracking import intake, own_ship, rotation
from ..tracking.radars import Radar
from ..types import Array, PolarPlots, Scan
from . import convert
from .diagnostics import OK, WARN, Tally
from .faults import HEADER_REASONS, NO_STAMP, ConversionError, check_frame
from .topics import FRAME, OWN_SHIP_FRAME

MISSED = 'revolutions missed'
NO_DOPPLER = 'scans without the radial speeds that the estimator wants'
LEADS = 15  # scans; more than ever wait in a queue
UNKNOWN = 4.0  # revolutions; so long messages wait for the antenna's rotation to be known
SILENT_S = 5.0  # s of the wall, and three scans, without plots: the radar is silent


class Arrival(NamedTuple):
    """How a message came.

    arrival    s, by a clock of ours (intake.admit_scan); now_ns: by that of stamps
    seconds    of a stamp in ns
    own_frame  own ship's, beside which plots may be in `map`
    """

    arrival: float
    now_ns: int
    seconds: Callable[[int], float]
    own_frame: str


class RadarInput:
    """Of one radar of a tracker node; tell(reason, detail) is called for the first of each fault.

    order   what the next scan's time is judged by
    taken   scans so far
    """

    def __init__(self, radar: Radar, place: int, tell: Callable[[str, str], None]) -> None:
        self.radar, self._place = radar, place
        self.order = intake.TimeOrder()
        self.bad = Tally(
            (
                *convert.CLOUD_REASONS,
                *HEADER_REASONS,
                *intake.PLOT_REASONS,
                *intake.SCAN_REASONS,
                MISSED,
                NO_DOPPLER,
                own_ship.OWN_BY_ARRIVAL,
            ),
            tell,
        )
        self.taken = 0
        self._plots_in_scan = 0
        self._starts: deque[float] = deque(maxlen=10)
        self._rotation = rotation.begin()
        self._stamped_alike = False
        self._samples = 0  # of own ship, taken before the last scan
        self._leads: deque[float] = deque(maxlen=LEADS)
        self._began = time.monotonic()
        self._heard: float | None = None  # wall time of the last plots

    @property
    def revolution(self) -> float:
        """s of one revolution, also where each message is a sector of it."""
        return self._rotation.period if self._in_sectors else self.period

    @property
    def _in_sectors(self) -> bool:
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
        message: PointCloud2,
        came: Arrival,
        own_log: own_ship.OwnShipLog,
        others: Sequence[intake.TimeOrder],
        way: Array,
        heading: float,
    ) -> tuple[Scan, str, own_ship.OwnShipLog] | None:
        """The scan in the tracker's time, the fallback for own ship, and her log, in which what
        waited may be confirmed by the scan; None where the scan is rejected.

        others   the orders of the other radars
        way      [2] m/s, own ship's way through the water, should her positions be lost; nan: none
        heading  rad, hers now; nan: not known
        """
        self._heard = wall = time.monotonic()
        try:
            check_frame(message.header.frame_id, (FRAME, OWN_SHIP_FRAME, came.own_frame))
            start_ns = convert.nanoseconds(message.header.stamp)
            plots = convert.cloud_to_plots(message)
        except ConversionError as error:
            self.bad.add(error.reason, wall, detail=str(error))
            return None
        parameters, period = self.radar.parameters, self.period
        plots, rejected = intake.screen_plots(plots, period, parameters.max_plots)
        for reason, count in rejected.items():
            self.bad.add(reason, wall, count)
        if parameters.estimator in WANT_DOPPLER and plots.radial_speed is None and len(plots.time):
            self.bad.add(NO_DOPPLER, wall, detail=parameters.estimator)
        if not start_ns:
            start_ns = came.now_ns - round(1e9 * max(period, plots.time.max(initial=0.0)))
            self.bad.add(NO_STAMP, wall)
        start, before = came.seconds(start_ns), self.order.last
        self.order, taken, reason = intake.admit_scan(
            self.order, start, period, others, came.arrival, own_log.newest
        )
        if reason:
            self.bad.add(reason, wall, detail=f'stamp {start_ns * 1e-9:.3f} s')
        if not taken:
            return None
        if reason == intake.REBASED:
            self._starts.clear()
            self._rotation = rotation.begin()
        elif start - before > 1.5 * period:
            self.bad.add(MISSED, wall, round((start - before) / period) - 1)
        self._starts.append(start)
        if not self._turns(start, plots):
            return None

        # Recordings may stamp all plots of a scan alike; an antenna never does.
        if len(plots.time):
            self._stamped_alike = not plots.time.any()
        alike = self._stamped_alike and not self._in_sectors
        length = 0.0 if alike else max(period, plots.time.max(initial=0.0))
        end, shift = start + length, self.order.shift
        own_log, timeout = own_ship.confirmed(own_log, end), parameters.own_ship_timeout_s
        own_log = own_ship.reckoned(own_log, end, came.arrival, timeout, way, heading)
        own, fallback = own_ship.own_ship_for(
            own_log, start, end, timeout, parameters.own_ship_velocity, self._lead(own_log, end)
        )
        if fallback == own_ship.OWN_BY_ARRIVAL:
            self.bad.add(fallback, wall)
        if own_log.reckoned:
            fallback = own_ship.OWN_RECKONED
        self.taken += 1
        self._plots_in_scan = len(plots.time)
        scan = Scan(
            start + shift,
            end + shift,
            plots._replace(time=plots.time + start + shift),
            own._replace(time=own.time + shift),
            self._place,
            sector=self._rotation.sector(start, end) if self._in_sectors else None,
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

    def state(self, wall: float) -> tuple[bytes, str, dict[str, object]]:
        """Level, message and values for /diagnostics."""
        level, message = OK, 'plots come in'
        fresh = self.bad.fresh(wall)
        silent = wall - (self._heard or self._began)
        if self._heard is None:
            level, message = WARN, f'no plots yet on {self.radar.topic}'
        elif silent > SILENT_S + 3 * self.period:
            level, message = WARN, f'no plots for {silent:.0f} s'
        elif fresh:
            level, message = WARN, 'lately: ' + ', '.join(fresh)
        return (
            level,
            message,
            {
                'scans taken': self.taken,
                'plots in last scan': self._plots_in_scan,
                'period_s': f'{self.revolution:.3f}',
                **({'sectors': round(self.revolution / self.period)} if self._in_sectors else {}),
                **self.bad.counts,
            },
        )
