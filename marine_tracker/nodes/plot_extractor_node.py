"""Radar video in, plots out. The core does the work (video/).

Takes `radar/spokes`, and `radar/sector` where marine_sensor_msgs is installed. Publishes
`radar/plots` once a revolution, or in so many sectors as the parameter says; `radar/image` once a
revolution, only while somebody listens. A spoke's heading is its own, else that of
`own_ship/odometry` at its time. Bad spokes are left out and counted on /diagnostics by name.
"""

import array
import importlib
import math
import time
from collections import deque
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import Image, PointCloud2

from ..geometry import on_deck, to_range_bearing
from ..parameters import PlotExtractorParameters, VideoParameters
from ..types import Array, OwnShip, Scan, Sweep
from ..video import found, headings, picture, placing
from ..video.chain import Chain
from ..video.explain import Why, explain
from . import convert, diagnostics, topics
from .base_node import RunnableNode
from .declare import declare, follow
from .diagnostics import ERROR, FAILED, OK, WARN, Durations, Tally
from .faults import HEADER_REASONS, NO_STAMP, ConversionError, check_frame
from .spokes import FRAMES, cloud_to_sweep, sector_to_sweep
from .video_explanations import VideoExplanations

OWN_SAMPLES = 600  # of own ship that are kept
SILENT_S = 5.0
NO_PLACE = 'own ship messages that cannot be read'


class PlotExtractorNode(RunnableNode):
    """See the module. ValueError where the parameters are wrong."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('plot_extractor', **node_arguments)
        video, own = declare(self, VideoParameters, PlotExtractorParameters)
        self._width = 2 * math.pi / own.sectors
        self._size = own.image_size
        self._chain = Chain(video, self._width)
        self._memory = self._chain.start()
        self._base_ns: int | None = None  # stamps are seconds after this
        self._own: deque[tuple[float, float, float, float, float, float]] = deque(
            maxlen=OWN_SAMPLES
        )
        self._polar = picture.start()
        self._drawn = math.inf  # s, when the last picture was made
        self._spokes, self._usable, self._plots, self._scans = 0, 0, 0, 0
        self._lately = [0, 0]  # spokes and usable ones since the last second
        self._heard: float | None = None
        self._began = time.monotonic()
        self._took = Durations()
        self.bad = Tally(
            (
                *convert.CLOUD_REASONS,
                *HEADER_REASONS,
                *placing.REASONS,
                found.LAND,
                found.LONE,
                found.LOBE,
                NO_PLACE,
            ),
            self.tell,
        )
        follow(self, (VideoParameters,), self._made, self._change)
        self._to_plots = self.publisher(PointCloud2, topics.PLOTS, topics.reliable())
        self._to_image = self.publisher(Image, topics.IMAGE, topics.reliable(1))
        self._to_diagnostics = self.publisher(
            DiagnosticArray, topics.DIAGNOSTICS, topics.reliable()
        )
        self.subscription(Odometry, topics.ODOMETRY, self._on_odometry, topics.best_available())
        quality = topics.best_effort(topics.SPOKES_DEPTH)
        self.subscription(PointCloud2, topics.SPOKES, self._on_spokes, quality)
        sector = _radar_sector()
        if sector is not None:
            self.subscription(sector, topics.SECTOR, self._on_sector, quality)
        VideoExplanations(self, self._why)
        self.create_timer(1.0, self._on_second, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self.get_logger().info(
            f'waiting for {topics.SPOKES}' + (f' or {topics.SECTOR}' if sector is not None else '')
        )

    def close(self) -> None:
        """The plots that are still to come, and a last word on /diagnostics."""
        if self._base_ns is not None:
            self._memory, done = self._chain.end(self._memory, self._own_ship())
            self._publish(done.scans)
        self._on_second()

    def _made(self, video: VideoParameters) -> Chain:
        return Chain(video, self._width)

    def _change(self, chain: Chain) -> None:
        self._chain = chain

    # -- in ------------------------------------------------------------------------------------

    def _seconds(self, time_ns: int) -> float:
        if self._base_ns is None:
            self._base_ns = time_ns
        return (time_ns - self._base_ns) * 1e-9

    def _on_odometry(self, message: Odometry) -> None:
        try:
            check_frame(message.header.frame_id, (topics.FRAME,))
            now = self._seconds(convert.nanoseconds(message.header.stamp))
        except ConversionError as error:
            self.bad.add(error.reason, time.monotonic(), detail=str(error))
            return
        position, velocity = convert.odometry_to_own_ship(message)
        heading = convert.heading_of_odometry(message)
        if not np.isfinite(position).all():
            self.bad.add(NO_PLACE, time.monotonic(), detail='its position is not finite')
            return
        if self._own and now <= self._own[-1][0]:
            if now > self._own[-1][0] - 10.0:
                return
            self._own.clear()  # a clock set back
        self._own.append((now, *position, *np.nan_to_num(velocity), heading))

    def _own_ship(self) -> OwnShip:
        rows = np.array(self._own or [(0.0, 0.0, 0.0, 0.0, 0.0, math.nan)])
        heading = rows[:, 5] if np.isfinite(rows[:, 5]).any() else None
        return OwnShip(rows[:, 0], rows[:, 1:3], rows[:, 3:5], heading)

    def _on_spokes(self, message: PointCloud2) -> None:
        self._take(message, cloud_to_sweep)

    def _on_sector(self, message: Any) -> None:
        self._take(message, sector_to_sweep)

    def _take(self, message, read) -> None:
        wall = self._heard = time.monotonic()
        began = time.process_time()
        try:
            check_frame(message.header.frame_id, FRAMES)
            stamp = convert.nanoseconds(message.header.stamp)
            if not stamp:
                stamp = self.get_clock().now().nanoseconds
                self.bad.add(NO_STAMP, wall)
            sweep: Sweep = read(message, self._seconds(stamp))
        except ConversionError as error:
            self.bad.add(error.reason, wall, detail=str(error))
            return
        self._memory, done = self._chain.step(self._memory, sweep, self._own_ship())
        for reason, count in done.counts.items():
            self.bad.add(reason, wall, count)
        usable = sum(int(np.isfinite(part.bearing).sum()) for part in done.placed)
        self._spokes += len(sweep.time)
        self._usable += usable
        self._lately[0] += len(sweep.time)
        self._lately[1] += usable
        self._publish(done.scans)
        self._draw(done.placed)
        self._took.add(time.process_time() - began)

    # -- out -----------------------------------------------------------------------------------

    def _publish(self, scans: list[Scan]) -> None:
        for scan in scans:
            assert self._base_ns is not None
            start_ns = self._base_ns + round(scan.start * 1e9)
            self._to_plots.publish(convert.plots_to_cloud(scan, start_ns))
            self._scans += 1
            self._plots = len(scan.plots.time)

    def _why(self, point: Array | None, frame: Array | None) -> list[Why]:
        """Reasons for a point [2] m in the map, or [2] m ahead and to port of own ship."""
        own = self._own_ship()
        heading = headings.of_own_ship(own, own.time[-1:])[0]
        told = self._memory.placing.headings.heading
        if not math.isfinite(heading) and len(told):
            heading = float(told[-1])
        if point is None and frame is not None:
            point = own.position[-1] + on_deck(float(frame[0]), -float(frame[1]), heading)
        assert point is not None
        range_, bearing = to_range_bearing(np.asarray(point) - own.position[-1])
        return explain(
            self._polar,
            self._memory.extraction,
            self._chain.extraction,
            float(range_),
            float(bearing),
            float(heading),
            float(self._polar.time.max()),
        )

    def _draw(self, placed) -> None:
        """Keeps the picture, and publishes it once a revolution while somebody listens."""
        for spokes in placed:
            self._polar = picture.painted(self._polar, spokes)
        if not self._to_image.get_subscription_count():
            return
        now, first = float(self._polar.time.max()), float(self._polar.time.min())
        if not math.isfinite(now):
            return
        if not self._drawn <= now:  # the first spokes, or a clock set back
            self._drawn = now
        if first <= self._drawn and now - self._drawn < picture.OLD_S:
            return
        self._drawn = now
        shown = picture.north_up(self._polar, self._size, now)
        assert self._base_ns is not None
        self._to_image.publish(
            Image(
                header=convert.header(self._base_ns + round(now * 1e9)),
                height=self._size,
                width=self._size,
                encoding='mono8',
                step=self._size,
                data=array.array('B', shown.tobytes()),
            )
        )

    def _on_second(self) -> None:
        wall = time.monotonic()
        fresh = self.bad.fresh(wall)
        silent = wall - (self._heard or self._began)
        came, usable = self._lately
        self._lately = [0, 0]
        level, message = OK, 'spokes come in'
        if self._heard is None:
            level, message = WARN, f'no spokes yet on {topics.SPOKES}'
        elif silent > SILENT_S:
            level, message = WARN, f'no spokes for {silent:.0f} s'
        elif came and not usable:
            level, message = ERROR, 'spokes come, none is usable: ' + ', '.join(fresh)
        elif any(reason not in (found.LAND, found.LONE, found.LOBE) for reason in fresh):
            level, message = WARN, 'lately: ' + ', '.join(fresh)
        if self.failures.fresh(wall):
            level, message = ERROR, 'callbacks fail'
        values = {
            'spokes': self._spokes,
            'spokes usable': self._usable,
            'scans': self._scans,
            'plots in last scan': self._plots,
            'cpu_ms_99': f'{1e3 * self._took.percentile(99):.1f}',
            **self.bad.counts,
            FAILED: sum(self.failures.counts.values()),
        }
        status = diagnostics.status(
            f'{self.label}: video', self.hardware_id, level, message, values
        )
        self._to_diagnostics.publish(
            diagnostics.array(self.get_clock().now().nanoseconds, [status])
        )


def _radar_sector() -> Any:
    """The message type, where its package is installed; else None."""
    try:
        return importlib.import_module('marine_sensor_msgs.msg').RadarSector
    except (ImportError, AttributeError):
        return None
