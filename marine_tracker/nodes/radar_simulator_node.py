"""The radar simulator as a node: a scenario's plots, own ship and truth, in their own time.

Publishes `radar/plots` and `radar/plots_readable` at the end of each antenna revolution, or of each
sector where the scenario or the parameter `sectors` asks for several messages a revolution,
`own_ship/odometry` (and `own_ship/fix` where the scenario has a place on earth) at 10 Hz, `truth`
once a revolution; `radar/spokes` instead of plots where the radar gives video. Rate and `/clock`:
see playback.py. The node ends when the scenario has ended, unless it loops.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
from rclpy.clock import Clock, ClockType

from ..geometry import heading_at, own_ship_at
from ..parameters import RadarSimulatorParameters
from ..simulation import radar, scenario, sectors, video
from ..simulation.scenario import Scenario
from ..types import OwnShip, Scan, take
from .base_node import RunnableNode
from .declare import declare
from .diagnostics import one_line
from .playback import NO_PLOTS, Playback, Revolution, own_ship_period
from .simulated_ais import SimulatedAis

SECTOR = 128  # spokes in a message
AIS_S = 0.1  # s between two looks for sentences


def _with_video(chosen: Scenario, seed: int, step: float) -> Iterator[Revolution]:
    """The spokes of a radar that gives video, in sectors; truth comes with the last one."""
    for turn in video.simulate(chosen, seed):
        spokes = len(turn.sweep.time)
        period = chosen.radar.scan_period
        for first in range(0, spokes, SECTOR):
            part = take(turn.sweep, slice(first, first + SECTOR))
            last = first + SECTOR >= spokes
            start, end = float(part.time[0]), float(part.time[-1]) + period / spokes
            count = max(round((end - start) / step), 1)
            own = chosen.own_ship_at(np.linspace(start, end, count + 1)[1:])
            truth = turn.truth if last else take(turn.truth, slice(0, 0))
            yield Revolution(Scan(start, end, NO_PLOTS, own), truth, own, part)


class RadarSimulatorNode(RunnableNode):
    """Plays a scenario. ValueError where the parameters or the scenario are wrong."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('radar_simulator', **node_arguments)
        (parameters,) = declare(self, RadarSimulatorParameters)
        chosen = scenario.load(parameters.scenario)
        for remark in chosen.fleet.remarks:
            self.get_logger().warning(remark)
        step, count = own_ship_period(parameters.rate), parameters.sectors or chosen.radar.sectors

        def revolutions() -> Iterator[Revolution]:
            if chosen.radar.video is not None:
                yield from _with_video(chosen, parameters.seed, step)
                return
            scans = radar.simulate(chosen, parameters.seed)
            for scan, truth in sectors.parts(scans, count):
                # Evenly up to the end, which is always one of them.
                samples = max(round((scan.end - scan.start) / step), 1)
                time = np.linspace(scan.start, scan.end, samples + 1)[1:]
                own = OwnShip(time, *own_ship_at(scan.own_ship, time))
                own = own._replace(heading=heading_at(scan.own_ship, time))
                yield Revolution(scan, truth, own)

        self._playback = Playback(
            self,
            revolutions,
            parameters.rate,
            parameters.loop,
            chosen.fleet.origin,
            parameters.begin_at_s,
        )
        self._ais: SimulatedAis | None = None
        if chosen.fleet.ais is not None:
            self._ais = SimulatedAis(self, chosen, parameters.seed, parameters.ais_udp)
            self._duration = chosen.duration
            self.create_timer(AIS_S, self._send_ais, clock=Clock(clock_type=ClockType.STEADY_TIME))
        elif parameters.ais_udp:
            raise ValueError('parameter ais_udp is set, but the scenario has no ais.send')
        self.get_logger().info(
            f'scenario {one_line(parameters.scenario)}, seed {parameters.seed}, '
            f'rate {parameters.rate:g}'
        )

    @property
    def done(self) -> bool:
        """Whether the scenario has ended."""
        return self._playback.done

    def close(self) -> None:
        """Let the last messages arrive."""
        self._playback.close()
        if self._ais is not None:
            self._ais.close()

    def _send_ais(self) -> None:
        """Sentences that are due; in a loop the scenario's time begins again."""
        moment = self._playback.moment
        if moment is not None and self._ais is not None:
            now, stamp = moment
            self._ais.send(now % self._duration, stamp - now)
