"""The radar simulator as a node: a scenario's plots, own ship and truth, in their own time.

Publishes `radar/plots` and `radar/plots_readable` at the end of each antenna revolution, or of each
sector where the scenario or the parameter `sectors` asks for several messages a revolution,
`own_ship/odometry` (and `own_ship/fix` where the scenario has a place on earth) at 10 Hz, `truth`
once a revolution. Rate and `/clock`: see playback.py. The node ends when the scenario has ended,
unless it loops.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..geometry import heading_at, own_ship_at
from ..parameters import RadarSimulatorParameters
from ..simulation import radar, scenario, sectors
from ..types import OwnShip
from .base_node import RunnableNode
from .declare import declare
from .diagnostics import one_line
from .playback import Playback, Revolution, own_ship_period


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
