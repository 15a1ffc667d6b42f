"""Own ship's sensors as the tracker node hears them: heading and position, and the speed log.

The log comes as geometry_msgs/TwistStamped on `own_ship/log`: the velocity through the water in own
ship's axes, `linear.x` ahead and `linear.y` to port, m/s (a log with one axis leaves y at 0).
"""

import math
import time
from collections.abc import Callable, Sequence

from geometry_msgs.msg import TwistStamped

from ..arpa.stabilisation import NONE, POSITIONS, OwnSensors, through_water
from ..parameters import ArpaParameters
from ..tracking import own_ship
from ..tracking.own_ship import MAX_OWN_SPEED
from ..tracking.radars import Radar
from ..types import Array
from . import topics
from .base_node import RunnableNode
from .faults import WRONG_FRAME, bare

LOG_NOT_FINITE = 'log messages not finite'
LOG_TOO_FAST = 'log messages with impossible speed'
LOG_REASONS = (LOG_NOT_FINITE, LOG_TOO_FAST)
LOST_WITHIN = 60.0  # s: MSC.192(79) 9.1 gives a minute, whatever sensor_timeout_s says
NOT_MOVING = (own_ship.OWN_SILENT, own_ship.OWN_NO_VELOCITY)


class SensorsInput:
    """What was heard last, and when, s of the wall.

    count  count(reason, detail) of what is wrong with a message
    """

    def __init__(self, node: RunnableNode, count: Callable[[str, str], None]) -> None:
        self._count = count
        self.heading = math.nan  # rad, the last one told
        self._log = (math.nan, math.nan)  # m/s, ahead and to starboard
        self._heard_heading = self._heard_position = self._heard_log = time.monotonic()
        node.subscription(TwistStamped, topics.LOG, self._on_log, topics.best_effort())

    def hear_own_ship(self, placed: bool, heading: float) -> None:
        """An odometry message came: whether with a position; its heading, rad, nan for none."""
        wall = time.monotonic()
        if placed:
            self._heard_position = wall
        if math.isfinite(heading):
            self._heard_heading, self.heading = wall, heading

    def _on_log(self, message: TwistStamped) -> None:
        ahead, port = message.twist.linear.x, message.twist.linear.y
        if bare(message.header.frame_id) == topics.FRAME:
            self._count(WRONG_FRAME, f"the log's is {topics.FRAME}; it must be own ship's")
        elif not (math.isfinite(ahead) and math.isfinite(port)):
            self._count(LOG_NOT_FINITE, f'{ahead}, {port}')
        elif math.hypot(ahead, port) > MAX_OWN_SPEED:
            self._count(LOG_TOO_FAST, f'{ahead}, {port} m/s; it may be {MAX_OWN_SPEED:.0f}')
        else:
            self._heard_log, self._log = time.monotonic(), (ahead, -port)

    def silent(self, wall: float, p: ArpaParameters) -> tuple[float, float, float]:
        """s since heading, position and log were heard; the log's 0 where nobody asks for it."""
        log = wall - self._heard_log if p.stabilisation == 'log' else 0.0
        return wall - self._heard_heading, wall - self._heard_position, log

    def heading_now(self, wall: float, p: ArpaParameters) -> float:
        """rad; nan where it was not heard lately."""
        late = wall - self._heard_heading > min(p.sensor_timeout_s, LOST_WITHIN)
        return math.nan if late else self.heading

    def log_now(self, wall: float, p: ArpaParameters) -> tuple[float, float]:
        """m/s ahead and to starboard; nan where it was not heard lately."""
        late = wall - self._heard_log > p.sensor_timeout_s
        return (math.nan, math.nan) if late else self._log

    def way(self, p: ArpaParameters) -> tuple[Array, str]:
        """Own ship's velocity [2] m/s through the water, and LOG or HAND; nan and '' for none.

        Along the last heading, where there is none now: that is how the picture lies then.
        """
        return through_water(p, self.log_now(time.monotonic(), p), self.heading)

    def told(
        self, p: ArpaParameters, radars: Sequence[Radar], fallback: str
    ) -> tuple[float, OwnSensors]:
        """The heading that the picture lies by, rad, nan for none; and what is known beside it.

        fallback  of own ship's place in the scan (own_ship.own_ship_for)

        Once a heading was lost, the last one goes on: bearings and zones relative to the bow stay
        as they were. A radar that counts from the bow takes it for north before the first heading.
        """
        wall = time.monotonic()
        north, heading = math.isfinite(self.heading_now(wall, p)), self.heading
        if math.isnan(heading):
            relative = any(radar.parameters.bearings == 'bow' for radar in radars)
            north, heading = not relative, 0.0 if relative else heading
        way = NONE if fallback in NOT_MOVING else POSITIONS
        if fallback == own_ship.OWN_RECKONED:
            way = self.way(p)[1] or NONE
        return heading, OwnSensors(north, self.log_now(wall, p), way)
