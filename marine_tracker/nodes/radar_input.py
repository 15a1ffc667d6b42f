"""What comes in from one radar: messages read, and each revolution made a scan."""

import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from sensor_msgs.msg import PointCloud2

from ..estimators import WANT_DOPPLER
from ..tracking import intake, own_ship
from ..tracking.radars import Radar
from ..tracking.scan_input import MISSED, PART_UNKNOWN, Came, ScanInput
from ..types import Array, Scan
from . import convert
from .diagnostics import OK, WARN, Tally
from .faults import HEADER_REASONS, ConversionError, check_frame
from .messages_of_others import scan_to_plots
from .topics import FRAME, OWN_SHIP_FRAME

NO_DOPPLER = 'scans without the radial speeds that the estimator wants'
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


class RadarInput(ScanInput):
    """Of one radar of a node; tell(reason, detail) is called for the first of each fault."""

    def __init__(self, radar: Radar, place: int, tell: Callable[[str, str], None]) -> None:
        self.bad = Tally(
            (
                *convert.CLOUD_REASONS,
                *HEADER_REASONS,
                *intake.PLOT_REASONS,
                *intake.SCAN_REASONS,
                MISSED,
                PART_UNKNOWN,
                NO_DOPPLER,
                own_ship.OWN_BY_ARRIVAL,
            ),
            tell,
        )
        super().__init__(
            radar,
            place,
            lambda reason, count, detail: self.bad.add(reason, time.monotonic(), count, detail),
        )
        self._began = time.monotonic()
        self._heard: float | None = None  # wall time of the last plots

    def read(
        self,
        message: Any,
        came: Arrival,
        own_log: own_ship.OwnShipLog,
        others: Sequence[intake.TimeOrder],
        way: Array,
        heading: float,
    ) -> tuple[Scan, str, own_ship.OwnShipLog] | None:
        """The scan of a PointCloud2 or RadarScan, as by `scan_of`; None where it is rejected."""
        self._heard = wall = time.monotonic()
        try:
            check_frame(message.header.frame_id, (FRAME, OWN_SHIP_FRAME, came.own_frame))
            start_ns = convert.nanoseconds(message.header.stamp)
            gaps = None
            if isinstance(message, PointCloud2):
                plots, gaps = convert.cloud_to_plots(message), convert.cloud_to_gaps(message)
            else:
                plots = scan_to_plots(message, self.radar.parameters.bearings)
        except ConversionError as error:
            self.bad.add(error.reason, wall, detail=str(error))
            return None
        estimator = self.radar.parameters.estimator
        if estimator in WANT_DOPPLER and plots.radial_speed is None and len(plots.time):
            self.bad.add(NO_DOPPLER, wall, detail=estimator)
        how = Came(came.arrival, came.now_ns, start_ns, came.seconds)
        return self.scan_of(plots, how, own_log, others, way, heading, gaps)

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
                'plots in last scan': self.plots_in_scan,
                'period_s': f'{self.revolution:.3f}',
                **({'sectors': round(self.revolution / self.period)} if self.in_sectors else {}),
                **self.bad.counts,
            },
        )
