"""Spreads the tracks of a scan over the revolution, so that listeners of small depth keep up."""

import math
import time
from collections import deque
from collections.abc import Callable, Sequence
from statistics import median

import numpy as np
from rclpy.clock import Clock, ClockType
from rclpy.publisher import Publisher

from ..types import Extrapolation, take
from .base_node import RunnableNode
from .convert import OdometryPool

TICK_S = 0.01
MOST = 5  # at a tick: half of what the usual depth holds
SHARE = 0.8  # of the revolution: all are out before the next ones come


class Paced:
    """Publishes one Odometry a track on `publisher`, a few at a time.

    What is still waiting when the next scan comes goes out at once.
    """

    def __init__(self, node: RunnableNode, publisher: Publisher) -> None:
        self._publisher, self._pool = publisher, OdometryPool()
        self._waiting: Callable[[int], None] = lambda count: None
        self._count = self._sent = 0
        self._began, self._length = -math.inf, 1.0  # s
        self._gaps: deque[float] = deque(maxlen=5)  # s of the wall between scans
        self._timer = node.create_timer(
            TICK_S, self._tick, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )
        self._timer.cancel()

    def publish(
        self,
        stamps: Callable[..., np.ndarray],
        frames: Sequence[str],
        estimate: Extrapolation,
        period: float,
    ) -> None:
        """The tracks of a scan: stamps and frames as for OdometryPool; period s of revolutions."""
        self._waiting(self._count)
        self._count, self._sent = len(frames), 0
        wall = time.monotonic()
        self._gaps.append(min(wall - self._began, period))  # a replay may be faster than stamps
        self._began, self._length = wall, SHARE * median(self._gaps)

        def send(until: int) -> None:
            part = slice(self._sent, until)
            some = take(estimate, part)
            for message in self._pool.fill(
                stamps(some.time), frames[part], some.position, some.velocity, some.covariance
            ):
                self._publisher.publish(message)
            self._sent = until

        self._waiting = send
        self._timer.reset()

    def _tick(self) -> None:
        share = (time.monotonic() - self._began) / self._length
        # A tick that comes late makes no burst.
        most = self._sent + max(MOST, math.ceil(2 * self._count * TICK_S / self._length))
        due = min(math.ceil(share * self._count), most, self._count)
        if due > self._sent:
            self._waiting(due)
        if self._sent == self._count:
            self._timer.cancel()
