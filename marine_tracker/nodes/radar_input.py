"""What comes in from one radar: each revolution's plots screened, timed, and made a scan."""

import statistics
import time
from collections import deque
from collections.abc import Callable, Sequence

from sensor_msgs.msg import PointCloud2

from ..estimators import WANT_DOPPLER
from ..tracking import intake
from ..tracking.radars import Radar
from ..types import Scan
from . import convert
from .convert import ConversionError
from .diagnostics import OK, WARN, Tally

MISSED = 'revolutions missed'
NO_DOPPLER = 'scans without the radial speeds that the estimator wants'
SILENT_S = 5.0  # s of the wall, and three scans, without plots: the radar is silent


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
                *intake.PLOT_REASONS,
                *intake.SCAN_REASONS,
                MISSED,
                NO_DOPPLER,
            ),
            tell,
        )
        self.taken = 0
        self._plots_in_scan = 0
        self._starts: deque[float] = deque(maxlen=10)
        self._stamped_alike = False
        self._began = time.monotonic()
        self._heard: float | None = None  # wall time of the last plots

    @property
    def period(self) -> float:
        """s of one revolution: as measured, or by parameter until there is enough to measure."""
        if len(self._starts) < 4:
            return self.radar.parameters.scan_period_s
        starts = list(self._starts)
        return statistics.median(b - a for a, b in zip(starts, starts[1:]))

    def scan_of(
        self,
        message: PointCloud2,
        seconds: Callable[[int], float],
        own_log: intake.OwnShipLog,
        others: Sequence[intake.TimeOrder],
    ) -> tuple[Scan, str] | None:
        """The scan in the tracker's time and the fallback for own ship; None where it is rejected.

        seconds  of a stamp in ns; others: the orders of the other radars
        """
        self._heard = wall = time.monotonic()
        try:
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
        start_ns = convert.nanoseconds(message.header.stamp)
        start, before = seconds(start_ns), self.order.last
        self.order, taken, reason = intake.admit_scan(self.order, start, period, others)
        if reason:
            self.bad.add(reason, wall, detail=f'stamp {start_ns * 1e-9:.3f} s')
        if not taken:
            return None
        if reason == intake.REBASED:
            self._starts.clear()
        elif start - before > 1.5 * period:
            self.bad.add(MISSED, wall, round((start - before) / period) - 1)
        self._starts.append(start)

        # Recordings may stamp all plots of a scan alike; an antenna never does.
        if len(plots.time):
            self._stamped_alike = not plots.time.any()
        length = 0.0 if self._stamped_alike else max(period, plots.time.max(initial=0.0))
        end, shift = start + length, self.order.shift
        own_ship, fallback = intake.own_ship_for(own_log, start, end, parameters.own_ship_timeout_s)
        self.taken += 1
        self._plots_in_scan = len(plots.time)
        return Scan(
            start + shift,
            end + shift,
            plots._replace(time=plots.time + start + shift),
            own_ship._replace(time=own_ship.time + shift),
            self._place,
        ), fallback

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
                'period_s': f'{self.period:.3f}',
                **self.bad.counts,
            },
        )
