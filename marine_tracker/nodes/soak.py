"""Hours of `busy_strait` through the tracker node, with faults thrown in.

Messages go straight to the callbacks of the node's subscriptions, in this process and in simulated
time. So everything is tried but the transport. One fault comes every few minutes, in turn:

    silence        no plots and no own ship for 20 to 100 s
    clock step     all stamps are half an hour ahead or behind from then on
    bad stamp      one scan is stamped 5 to 30 s ahead
    flood          10,000 plots in a ball of 200 m, twice in a row
    no plots       three scans without plots
    not a number   ten scans in which every tenth plot is nan
    lost heading   own ship's orientation is no rotation for a minute
    teleport       three of own ship's positions are 8 km off
    tracker        the node ends and another one begins

Twice an hour the scenario begins again, with other noise: to the tracker all ships jump.
"""

import gc
import os
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import rclpy
from numpy.typing import NDArray
from rclpy.clock import ROSClock
from rclpy.context import Context
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rclpy.time import Time

from ..geometry import own_ship_at, unit_vector
from ..processes import return_freed_memory
from ..simulation import radar, scenario
from ..types import Array, PolarPlots, Scan, Truth, append, take
from . import convert, topics
from .tracker_node import TrackerNode

SCENARIO = 'busy_strait'
EPOCH_S = 1e6  # of the first stamp
OWN_SHIP_S = 0.5  # between two samples of own ship
BETWEEN_SCANS = 80  # between two faults
BEFORE = 10  # scans whose mean tells how many ships are held before a fault
WITHIN = 300.0  # m: a target no farther from a ship is hers
RECOVERED = 0.95  # of the ships held before
SIMULATOR = 'simulator'
FAULTS = (
    'silence',
    'clock step',
    'bad stamp',
    'flood',
    'no plots',
    'not a number',
    'lost heading',
    'teleport',
    'tracker',
)


class Incident(NamedTuple):
    """A fault, how many ships were held before it, and how many scans after its end until
    RECOVERED of them were held again; inf for never."""

    fault: str
    hours: float
    held: float
    scans: float


class SoakResult(NamedTuple):
    """What some hours came to.

    incidents   the faults, in time order
    memory      [K, 2]  hours, and MB of this process then
    held        mean number of ships held
    exceptions  those that the nodes caught in their callbacks, and counted
    """

    incidents: list[Incident]
    memory: Array
    held: float
    exceptions: list[str]


class _Bridge:
    """One tracker node after another; callbacks are called, nothing is spun."""

    def __init__(self, parameters: dict):
        self._context = Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        given = {**parameters, 'use_sim_time': True}
        self._parameters = [Parameter(name, value=value) for name, value in given.items()]
        self.step = 0.0  # s that all stamps are ahead
        self.exceptions: list[str] = []
        self.node = self._begin()

    def _begin(self) -> TrackerNode:
        node = TrackerNode(context=self._context, parameter_overrides=self._parameters)
        heard = {one.topic_name.lstrip('/'): one.callback for one in node.subscriptions}
        self.hear_own_ship = heard[topics.ODOMETRY]
        self.hear_plots = heard[topics.PLOTS]
        return node

    def _end(self) -> None:
        self.exceptions += self.node.failures.counts
        self.node.close()
        self.node.destroy_node()

    def again(self) -> None:
        """The tracker ends, and another one begins."""
        self._end()
        self.node = self._begin()
        gc.collect()

    def close(self) -> None:
        """The last one ends."""
        self._end()
        self._context.try_shutdown()

    def now(self, time: float) -> None:
        """Simulated time is `time`, s."""
        clock = self.node.get_clock()
        assert isinstance(clock, ROSClock)
        clock.set_ros_time_override(Time(seconds=EPOCH_S + time, clock_type=clock.clock_type))

    def stamp(self, time: float) -> int:
        """ns, of a time in s."""
        return round((EPOCH_S + time + self.step) * 1e9)

    def held(self, truth: Truth) -> int:
        """How many ships have a target within reach."""
        picture = self.node.picture
        if picture is None or not len(picture.motion.position):
            return 0
        apart = np.hypot(*np.moveaxis(picture.motion.position - truth.position[:, None], -1, 0))
        return int((np.nan_to_num(apart, nan=np.inf).min(1) < WITHIN).sum())


def run(hours: float, seed: int, faults: bool, progress: Callable[[int, int], None]) -> SoakResult:
    """Soak the tracker node for so many simulated hours."""
    chosen = scenario.load(SCENARIO)
    bridge = _Bridge(chosen.tracker_parameters())
    rng = np.random.default_rng(seed)
    memory: list[tuple[float, float]] = []
    incidents: list[Incident] = []
    counts: list[int] = []
    fault, since, left, before = '', 0, 0, 0.0  # under way or being recovered from
    begun = 0
    try:
        for count, (time, scan, truth) in enumerate(_scans(chosen, seed, 3600 * hours)):
            if scan.start == 0 and count:
                fault, before, left, since = SIMULATOR, float(np.mean(counts[-BEFORE:])), 0, count
            elif faults and not fault and count and count % BETWEEN_SCANS == 0:
                fault = FAULTS[begun % len(FAULTS)]
                begun += 1
                before, since = float(np.mean(counts[-BEFORE:])), count
                left = _length(fault, rng)
                _at_once(fault, bridge, rng)
            active = fault if left > 0 else ''
            left -= 1
            if left == 0:
                since = count
            _send(bridge, time, scan, active, rng)
            counts.append(bridge.held(truth))
            if fault and left <= 0 and counts[-1] >= RECOVERED * before:
                incidents.append(Incident(fault, time / 3600, before, count - since))
                fault = ''
            if count % 1000 == 0:
                gc.collect()
                return_freed_memory()
                memory.append((time / 3600, megabytes()))
                progress(round(time), round(3600 * hours))
        if fault and count - since > BETWEEN_SCANS:  # else it had no time
            incidents.append(Incident(fault, time / 3600, before, np.inf))
    finally:
        bridge.close()
    return SoakResult(incidents, np.array(memory), float(np.mean(counts)), bridge.exceptions)


def megabytes(process: int | str = 'self') -> float:
    """MB of memory that a process holds."""
    with open(f'/proc/{process}/statm') as file:
        return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE') / 1e6


def _scans(
    chosen: scenario.Scenario, seed: int, whole: float
) -> Iterator[tuple[float, Scan, Truth]]:
    """Time since the beginning, s, of each scan's start; the scenario again and again."""
    begin = 0.0
    while begin < whole:
        for scan, truth in radar.simulate(chosen, seed):
            if begin + scan.start >= whole:
                return
            yield begin + scan.start, scan, truth
        begin += scan.end
        seed += 1


def _length(fault: str, rng: np.random.Generator) -> int:
    """Scans that a fault lasts; 0: it is there at once and stays."""
    return {
        'silence': int(rng.integers(8, 38)),
        'bad stamp': 1,
        'flood': 2,
        'no plots': 3,
        'not a number': 10,
        'lost heading': 22,
        'teleport': 1,
    }.get(fault, 0)


def _at_once(fault: str, bridge: _Bridge, rng: np.random.Generator) -> None:
    if fault == 'clock step':
        bridge.step += float(rng.choice([-1800.0, 1800.0]))
    elif fault == 'tracker':
        bridge.again()


def _send(bridge: _Bridge, time: float, scan: Scan, fault: str, rng: np.random.Generator) -> None:
    """What the node hears of one revolution."""
    bridge.now(time)
    if fault != 'silence':
        moments = np.arange(scan.start, scan.end, OWN_SHIP_S)
        position, velocity = own_ship_at(scan.own_ship, moments)
        for k, moment in enumerate(moments):
            at = time + moment - scan.start
            off = 8000.0 if fault == 'teleport' and k < 3 else 0.0
            message = convert.own_ship_to_odometry(bridge.stamp(at), position[k] + off, velocity[k])
            if fault == 'lost heading':
                message.pose.pose.orientation.w = message.pose.pose.orientation.z = 0.0
            bridge.now(at)
            bridge.hear_own_ship(message)
    bridge.now(time + scan.end - scan.start)
    if fault == 'silence':
        return
    plots = _plots(scan, fault, rng)
    ahead = float(rng.uniform(5, 30)) if fault == 'bad stamp' else 0.0
    cloud = convert.plots_to_cloud(scan._replace(plots=plots), bridge.stamp(time + ahead))
    bridge.hear_plots(cloud)


def _plots(scan: Scan, fault: str, rng: np.random.Generator) -> PolarPlots:
    plots = scan.plots
    if fault == 'no plots':
        return take(plots, slice(0, 0))
    if fault == 'not a number':
        wrong: NDArray[np.bool_] = rng.random(len(plots.time)) < 0.1
        return plots._replace(range=np.where(wrong, np.nan, plots.range))
    if fault == 'flood':
        place = 4000.0 * unit_vector(np.array(1.0)) + rng.normal(0, 100.0, (10000, 2))
        range_ = np.hypot(*place.T)
        ball = PolarPlots(
            rng.uniform(scan.start, scan.end, 10000),
            range_,
            np.arctan2(*place.T),
            np.full(10000, 15.0),
        )
        return append(plots, ball)
    return plots
