"""How soon after the beam a track comes, where a radar sends sectors: over DDS, in real time.

A simulator and a tracker as processes. Needs ROS 2 and an idle machine.
"""

import contextlib
import os
from collections.abc import Sequence

import numpy as np

from ..evaluation import report
from ..simulation import scenario
from .node_processes import child_of

SCENES = ('busy_harbour', 'busy_strait', 'coast')
SECTORS = 16
WARM_UP = 12  # revolutions
MOST = 1 / 8  # of a revolution, 99th percentile
START_S = 5.0  # of the nodes


def figures(scans: int, seed: int, scenes: Sequence[str] = SCENES) -> list[report.Figure]:
    """The figures, from so many revolutions of each scene. ModuleNotFoundError without ROS 2."""
    found: list[report.Figure] = []
    for name in scenes:
        period = scenario.load(name).radar.scan_period
        late = np.array(_measured(name, scans, seed)) / period
        if not len(late):
            raise ValueError(f'no track came in {scans} revolutions of {name}')
        middle, most = np.percentile(late, [50, 99]).tolist()
        unit = 'revolutions'
        found += [
            report.Figure(f'{name}: from beam to track, 50 %', middle, unit),
            report.at_most(f'{name}: from beam to track, 99 %', most, MOST, unit),
            report.Figure(f'{name}: tracks heard', len(late)),
        ]
    return found


def _measured(name: str, scans: int, seed: int) -> list[float]:
    """s from beam to track, of each."""
    from ..nodes import domain
    from ..nodes.latency import LatencyListener

    loaded = scenario.load(name)
    tracker = {
        key: float(value) if type(value) is int else value
        for key, value in loaded.tracker_parameters().items()
    }
    simulator = {'scenario': name, 'sectors': SECTORS, 'seed': seed}
    with contextlib.ExitStack() as context:
        domain.set_local(os.environ, context.enter_context(domain.free_domain()))
        context.enter_context(child_of('tracker', tracker))
        listener = LatencyListener()
        context.callback(listener.close)
        listener.spin(START_S)
        context.enter_context(child_of('radar_simulator', simulator))
        listener.spin(START_S + WARM_UP * loaded.radar.scan_period)
        listener.late.clear()
        listener.spin(scans * loaded.radar.scan_period)
        return listener.late
