"""AIS in the tracker node: reports in, placed in `map` by own ship's fixes; ships out."""

import time
from collections.abc import Callable

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import NavSatFix, NavSatStatus, PointCloud2
from std_msgs.msg import UInt32

from ..ais.ais import ACTIVATED, SLEEPING, AisPicture
from ..ais.join import APART_STATE, BOTH
from ..geodesy import LocalFrame
from ..recording.message_faults import ConversionError
from ..types import Array, take
from . import ais_cloud, ais_targets_cloud, topics
from .base_node import RunnableNode
from .convert import CLOUD_REASONS, nanoseconds
from .diagnostics import OK, WARN, Tally, status
from .faults import HEADER_REASONS, NO_STAMP
from .operator import Operator

BAD_FIX, NOT_PLACED = 'fixes without a position', 'AIS reports before the first fix'
NOT_SANE, FAR = 'AIS reports that cannot be', 'AIS messages with stamps far from now'
REFUSED = 'commands on AIS refused'
SILENT_S = 60.0  # s of the wall
FAR_S = 60.0  # s

OwnPlace = Callable[[float], Array]  # own ship's position [2] m in `map` at a time, s; nan: unknown


class AisInTracker:
    """Of one tracker node.

    operator  hears the reports, activates ships
    place     own ship's position at the node's seconds
    seconds   the node's seconds of a stamp in ns
    """

    def __init__(
        self,
        node: RunnableNode,
        operator: Operator,
        place: OwnPlace,
        seconds: Callable[[int], float],
    ) -> None:
        self._node, self._operator, self._place, self._seconds = node, operator, place, seconds
        self._ships: AisPicture | None = None
        self._anchor: tuple[Array, LocalFrame] | None = None
        self._heard, self._count = -np.inf, 0
        self.bad = Tally(
            (*HEADER_REASONS, *CLOUD_REASONS, BAD_FIX, NOT_PLACED, NOT_SANE, FAR, REFUSED),
            node.tell,
        )
        node.subscription(NavSatFix, topics.FIX, self._on_fix, topics.best_effort())
        node.subscription(
            PointCloud2, topics.AIS_REPORTS, self._on_reports, topics.best_effort(topics.BURST)
        )
        for topic, awake in ((topics.AIS_ACTIVATE, True), (topics.AIS_SLEEP, False)):
            node.subscription(
                UInt32,
                topic,
                lambda message, awake=awake: self._on_command(message, awake),
                topics.reliable(),
            )
        self._to_targets = node.publisher(PointCloud2, topics.AIS_TARGETS, topics.latched())

    # -- in --------------------------------------------------------------------------------------

    def _on_fix(self, message: NavSatFix) -> None:
        if message.status.status < NavSatStatus.STATUS_FIX or not (
            abs(message.latitude) <= 90 and abs(message.longitude) <= 180
        ):
            self.bad.add(BAD_FIX, time.monotonic())
            return
        at = self._place(self._seconds(nanoseconds(message.header.stamp)))
        if np.isfinite(at).all():
            self._anchor = at, LocalFrame(message.latitude, message.longitude)

    def _on_reports(self, message: PointCloud2) -> None:
        wall = time.monotonic()
        try:
            stamp = nanoseconds(message.header.stamp)
            if not stamp:
                raise ConversionError(NO_STAMP, '')
            now = self._node.get_clock().now().nanoseconds
            if now and abs(now - stamp) > FAR_S * 1e9:
                raise ConversionError(FAR, f'{(stamp - now) * 1e-9:.0f} s')
            reports = ais_cloud.read(message, self._seconds(stamp))
        except ConversionError as error:
            self.bad.add(error.reason, wall, detail=str(error))
            return
        sane = ais_cloud.sane(reports)
        if not sane.all():
            self.bad.add(NOT_SANE, wall, int((~sane).sum()))
            reports = take(reports, sane)
        self._heard, self._count = wall, self._count + len(reports.mmsi)
        position = np.full((len(reports.mmsi), 2), np.nan)
        if self._anchor is None:
            self.bad.add(NOT_PLACED, wall, len(position))
        else:
            at, frame = self._anchor
            position = at + frame.to_local_or_nan(reports.latitude, reports.longitude)
        self._operator.hear_ais(reports, position)

    def _on_command(self, message: UInt32, awake: bool) -> None:
        try:
            self._operator.activate_ais(message.data, awake)
        except ValueError as error:
            self.bad.add(REFUSED, time.monotonic(), detail=str(error))

    # -- out -------------------------------------------------------------------------------------

    def publish(self, ships: AisPicture | None, time_ns: int) -> None:
        """The ships after a scan, or without one."""
        if ships is not None:
            self._ships = ships
            self._to_targets.publish(ais_targets_cloud.message(ships, time_ns))

    def state(self) -> list[DiagnosticStatus]:
        """For /diagnostics; nothing where AIS was never heard of."""
        wall, ships = time.monotonic(), self._ships
        if not self._count and not self.bad.counts.total():
            return []
        worries = [f'lately: {reason}' for reason in self.bad.fresh(wall)]
        if wall - self._heard > SILENT_S:
            worries.insert(0, f'no AIS for {wall - self._heard:.0f} s: radar stands alone')
        values: dict[str, object] = {'reports': self._count, **self.bad.counts}
        message = 'reports come in'
        if ships is not None:
            joined, errors = ships.joined.state, ships.registration
            message = f'{len(joined)} ships, {(joined == BOTH).sum()} joined'
            values |= {
                'ships': len(joined),
                'joined': int((joined == BOTH).sum()),
                'mismatch': int((joined == APART_STATE).sum()),
                'activated': int((ships.shown == ACTIVATED).sum()),
                'sleeping': int((ships.shown == SLEEPING).sum()),
                'lost': int(ships.ships.lost.sum()),
                'range error of the radar, m': f'{errors.value[0]:.1f}',
                'its deviation, m': f'{errors.covariance[0, 0] ** 0.5:.1f}',
                'bearing error of the radar, deg': f'{np.degrees(errors.value[1]):.2f}',
                'its deviation, deg': f'{np.degrees(errors.covariance[1, 1] ** 0.5):.2f}',
                'GPS east, north, m': f'{errors.value[2]:.1f}, {errors.value[3]:.1f}',
                'ships it rests on': errors.pairs,
            }
        level, text = WARN if worries else OK, '; '.join(worries) or message
        name = f'{self._node.label}: AIS'
        return [status(name, self._node.hardware_id, level, text, values)]
