"""Publishes antenna revolutions when they are due. Used by simulator and recording player.

At rate 1 the stamps are the node's clock. At any other rate simulated time is used: the stamps are
the scenario's or recording's own seconds, `/clock` is published, and other nodes need use_sim_time.
Stamps before 1 s are moved to begin at 1 s, because 0 means "no time yet" in ROS.

Due times are counted from the start, so nothing drifts. If the machine is too slow for the rate,
time runs slower; no revolution is left out. The first revolution waits a moment for a listener, so
a tracker started together with this node misses nothing.

Two radars of one scene stay in step if their nodes are given the stamp at which it begins. Then
time never runs slower, and a node that starts late leaves out what is past.
"""

import itertools
import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rosgraph_msgs.msg import Clock as ClockMessage
from sensor_msgs.msg import NavSatFix, PointCloud, PointCloud2

from ..geodesy import LocalFrame
from ..service import heading_of
from ..types import OwnShip, PolarPlots, Scan, Sweep, Truth, take
from . import convert, topics
from .base_node import RunnableNode, State
from .convert import OdometryPool
from .diagnostics import FRESH_S, OK, WARN
from .readable_plots import plots_to_readable
from .spokes import sweep_to_cloud

FIRST_S = 1.0  # s, where simulated time begins
TICK_S = 0.05  # longest wait between two looks at the time
AT_ONCE_S = 0.05  # longest work before the executor gets its turn
LAG_S = 0.5  # further behind than this, time runs slower
LISTENER_S = 3.0  # longest wait for the first listener ...
SETTLE_S = 0.5  # ... and for it to know us, too, on every topic
CLOSE_S = 0.5  # longest wait for the last messages to arrive
OWN_SHIP_PERIOD_S = 0.1  # of simulated time, and at most
NO_PLOTS = PolarPlots(np.empty(0), np.empty(0), np.empty(0), np.empty(0))
OWN_SHIP_PER_S = 25.0  # samples in a second of the wall


class Revolution(NamedTuple):
    """A revolution or a sector of one: scan, truth, and own-ship samples that become known up to
    its end.

    sweep  of a radar that gives video: spokes instead of the scan's plots, any number of them
    """

    scan: Scan
    truth: Truth
    own_ship: OwnShip
    sweep: Sweep | None = None


def own_ship_period(rate: float) -> float:
    """s of simulated time between two own-ship samples at this rate."""
    return max(OWN_SHIP_PERIOD_S, rate / OWN_SHIP_PER_S)


class Playback:
    """Publishes revolutions from a node's timer.

    make    begins the revolutions, in time order; called again for every loop
    rate    simulated seconds in a second
    loop    begin again at the end, one revolution later
    origin  the frame of own ship's positions, where that is on Earth; None: no fix
    begin_at  s, stamp of the first moment; 0: when this begins. Needs rate 1: ValueError

    `done` becomes true when the last revolution is out (never in a loop).
    """

    def __init__(
        self,
        node: RunnableNode,
        make: Callable[[], Iterator[Revolution]],
        rate: float,
        loop: bool,
        origin: LocalFrame | None = None,
        begin_at: float = 0.0,
    ) -> None:
        if begin_at and rate != 1:
            raise ValueError(
                f'begin_at_s is {begin_at:g} s beside a rate of {rate:g}; it needs '
                'rate 1 (and use_sim_time beside a node that publishes /clock)'
            )
        self.node, self.rate, self.origin, self.begin_at = node, rate, origin, begin_at
        self.done = False
        self._revolutions = _repeat(make) if loop else make()
        self._next = next(self._revolutions, None)
        if self._next is None:
            raise ValueError('there is no revolution to play')
        first = self._next
        self._first = min([*first.own_ship.time[:1].tolist(), first.scan.start])
        self._sample = 0  # of the next revolution's own-ship samples
        reliable = topics.reliable
        video = first.sweep is not None
        self._plots = node.publisher(
            PointCloud2,
            topics.SPOKES if video else topics.PLOTS,
            topics.best_effort(topics.SPOKES_DEPTH) if video else reliable(topics.SECTORS),
        )
        self._readable = node.publisher(PointCloud, topics.PLOTS_READABLE, reliable())
        self._odometry = node.publisher(Odometry, topics.ODOMETRY, reliable())
        self._truth = node.publisher(Odometry, topics.TRUTH, reliable(topics.BURST))
        self._fix = node.publisher(NavSatFix, topics.FIX, reliable()) if origin else None
        self._clock = node.publisher(ClockMessage, topics.CLOCK, reliable(1)) if rate != 1 else None
        self._pool = OdometryPool()
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._created = self._wall()
        self._heard: float | None = None
        self._told_waiting = False
        self._start_ns: int | None = None  # stamp of the time _first
        self._scans, self._slowed = 0, 0  # published; times that it could not keep the rate
        self._slow = -math.inf  # s of the wall, the last time
        self._anchor = (0.0, self._first)  # a moment of the wall and the time it stands for
        self._timer = node.create_timer(TICK_S, self._tick, clock=self._steady)
        node.watch(self._steady, 'playback', self._state)

    def close(self) -> None:
        """Stop, and see that what was published arrives."""
        self._timer.cancel()
        until = self._wall() + CLOSE_S
        for publisher in (self._plots, self._odometry, self._truth):
            publisher.wait_for_all_acked(Duration(seconds=max(until - self._wall(), 0.0)))

    def _tick(self) -> None:
        if self._start_ns is None and not self._begin():
            return
        began = self._wall()
        now = self._now()
        due = self._due()
        while due is not None and due <= now:
            self._publish_clock(due)
            self._publish_next()
            due = self._due()
            if self._wall() - began > AT_ONCE_S:
                break
        if due is None:
            self._timer.cancel()
            self.done = True
            return
        if now - due > LAG_S * self.rate and not self.begin_at:
            self._anchor = (self._elapsed(), due)
            self._slowed, self._slow = self._slowed + 1, self._wall()
        self._publish_clock(min(now, due))
        wait = (due - self._now()) / self.rate
        self._timer.timer_period_ns = int(1e9 * min(max(wait, 1e-3), TICK_S))
        self._timer.reset()

    def _state(self) -> State:
        """For /diagnostics."""
        level, message = OK, f'plays at rate {self.rate:g}'
        if self._start_ns is None:
            message = 'waits for a listener'
            if self._told_waiting:
                level, message = WARN, 'use_sim_time is set and /clock is silent'
        elif self._wall() - self._slow < FRESH_S:
            level, message = WARN, f'slower than the rate of {self.rate:g}: the machine is too slow'
        elif self.done:
            message = 'has ended'
        return level, message, {'scans': self._scans, 'times too slow': self._slowed}

    def _begin(self) -> bool:
        """Whether time runs now; sets the stamp of the first moment."""
        node = self.node
        wall = self._wall()
        if self._clock is not None:
            start_ns = round(1e9 * max(self._first, FIRST_S))
            self._clock.publish(ClockMessage(clock=convert.time_message(start_ns)))
        else:
            start_ns = node.get_clock().now().nanoseconds
            if start_ns == 0:
                if not self._told_waiting:
                    node.get_logger().warning(
                        'use_sim_time is set and /clock is silent: waiting for it'
                    )
                    self._told_waiting = True
                return False
        if self._heard is None and (
            self._plots.get_subscription_count() and self._odometry.get_subscription_count()
        ):
            self._heard = wall
        settled = self._heard is not None and wall - self._heard >= SETTLE_S
        if not settled and wall - self._created < LISTENER_S:
            return False
        self._anchor = (self._elapsed(), self._first)
        if self.begin_at:
            now_ns, start_ns = start_ns, round(self.begin_at * 1e9)
            self._anchor = (self._elapsed(), self._first + (now_ns - start_ns) * 1e-9)
            while self._next is not None and self._next.scan.end < self._now():
                self._next = next(self._revolutions, None)
        self._start_ns = start_ns
        return True

    def _wall(self) -> float:
        return self._steady.now().nanoseconds * 1e-9

    def _elapsed(self) -> float:
        """s of the clock that drives the playback: the steady one, or another node's /clock."""
        if self._clock is None and self.node.get_parameter('use_sim_time').value:
            return self.node.get_clock().now().nanoseconds * 1e-9
        return self._wall()

    def _now(self) -> float:
        """s, scenario's or recording's time."""
        at, time = self._anchor
        return time + (self._elapsed() - at) * self.rate

    @property
    def moment(self) -> tuple[float, float] | None:
        """The scenario's or recording's time now, s, and the stamp of it, s; None: not begun."""
        if self._start_ns is None:
            return None
        now = self._now()
        return now, self._stamp(now) * 1e-9

    def _stamp(self, time) -> int:
        assert self._start_ns is not None
        return self._start_ns + round((float(time) - self._first) * 1e9)

    def _due(self) -> float | None:
        """When the next thing is to be published; None at the end."""
        if self._next is None:
            return None
        samples = self._next.own_ship.time
        if self._sample < len(samples):
            return float(samples[self._sample])
        return self._next.scan.end

    def _publish_clock(self, time: float) -> None:
        if self._clock is not None:
            self._clock.publish(ClockMessage(clock=convert.time_message(self._stamp(time))))

    def _publish_next(self) -> None:
        revolution, k = self._next, self._sample
        assert revolution is not None
        samples = revolution.own_ship
        if k < len(samples.time):
            self._publish_own_ship(take(samples, slice(k, k + 1)))
            self._sample += 1
            return
        scan, truth = revolution.scan, revolution.truth
        start_ns = self._stamp(scan.start)
        if revolution.sweep is not None:
            self._plots.publish(sweep_to_cloud(revolution.sweep, scan.start, start_ns))
        else:
            self._plots.publish(convert.plots_to_cloud(scan, start_ns))
        if revolution.sweep is None and self._readable.get_subscription_count():
            self._readable.publish(plots_to_readable(scan, start_ns))
        if self._truth.get_subscription_count():
            exact = np.zeros((len(truth.time), 4, 4))
            for message in self._pool.fill(
                [self._stamp(time) for time in truth.time],
                [f'target_{number}' for number in truth.target],
                truth.position,
                truth.velocity,
                exact,
            ):
                self._truth.publish(message)
        self._next = next(self._revolutions, None)
        self._sample = 0
        self._scans += 1

    def _publish_own_ship(self, sample: OwnShip) -> None:
        stamp, position = self._stamp(sample.time[0]), sample.position[0]
        self._odometry.publish(
            convert.own_ship_to_odometry(stamp, position, sample.velocity[0], heading_of(sample))
        )
        if self._fix is not None and self.origin is not None:
            place = map(float, self.origin.to_geodetic(position))
            self._fix.publish(convert.fix_message(stamp, *place))


def _repeat(make: Callable[[], Iterator[Revolution]]) -> Iterator[Revolution]:
    """The revolutions over and over; each round follows the one before by one revolution."""
    shift, starts = 0.0, [0.0, 0.0]
    for round_ in itertools.count():
        for k, revolution in enumerate(make()):
            start = revolution.scan.start
            if k == 0 and round_:
                shift = 2 * starts[1] - starts[0] - start
            yield _moved(revolution, shift)
            # A single revolution has no neighbour to take the period from.
            before = start + shift - max(revolution.scan.end - start, 1.0) if k == 0 else starts[1]
            starts = [before, start + shift]


def _moved(revolution: Revolution, shift: float) -> Revolution:
    """The same at another time, s later."""
    scan, truth, own_ship, sweep = revolution
    return Revolution(
        scan._replace(
            start=scan.start + shift,
            end=scan.end + shift,
            plots=scan.plots._replace(time=scan.plots.time + shift),
            own_ship=scan.own_ship._replace(time=scan.own_ship.time + shift),
        ),
        truth._replace(time=truth.time + shift),
        own_ship._replace(time=own_ship.time + shift),
        None if sweep is None else sweep._replace(time=sweep.time + shift),
    )
