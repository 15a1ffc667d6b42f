"""The whole service on simulated plots: scans in, what an operator is told of each target out."""

from typing import Any, NamedTuple

import numpy as np

from ..arpa import arpa, cpa, motion
from ..arpa.own_motion import lately, own_motion
from ..geometry import locate
from ..parameters import ArpaParameters, TrackerParameters, from_mapping
from ..simulation.scenario import Scenario
from ..tracking import tracker
from ..tracking.lifecycle import LOST
from ..types import OwnShip, Scan, Tracks, take


class Memory(NamedTuple):
    """What the service knows between two scans.

    own     own ship's samples as long as they count
    report  that of the last scan
    """

    tracker: tracker.TrackerMemory
    motion: motion.MotionMemory
    own: OwnShip
    report: tracker.Report


class TargetData(NamedTuple):
    """What is told of N targets at one time: their rows of the tracks, motion and approach."""

    time: float
    tracks: Tracks
    motion: motion.Motion
    approach: cpa.Approach
    own: cpa.OwnMotion


class Service:
    """Tracker and ARPA with shipped defaults, but for what a scenario's radar and waters are.

    service = Service(scenario, 'imm')
    memory = None
    for scan, truth in radar.simulate(scenario, seed):
        memory = service.step(memory, scan)
    data = service.targets(memory, scan.end)

    Every step does what the targets' data depend on; acquisition and alarms are left out.
    `changes` overrule the scenario's tracker parameters.
    """

    def __init__(self, scenario: Scenario, estimator: str, **changes: Any):
        self.parameters = from_mapping(
            TrackerParameters, {**scenario.tracker_parameters(), 'estimator': estimator, **changes}
        )
        self.tracker = tracker.Tracker(self.parameters)
        self.arpa = arpa.Arpa(ArpaParameters(), self.parameters)

    def step(self, memory: Memory | None, scan: Scan) -> Memory:
        """One revolution; `memory` is None before the first."""
        if memory is None:
            tracked, own = self.tracker.start(), scan.own_ship
            moving = motion.begin(len(self.arpa.radars))
        else:
            tracked, moving = memory.tracker, memory.motion
            own = lately(memory.own, scan.own_ship, scan.end)
        tracked, report = self.tracker.step(tracked, scan)
        radar = self.arpa.radars[scan.radar].parameters
        plots = locate(
            scan.plots, scan.own_ship, radar.range_sigma_m, np.radians(radar.bearing_sigma_deg)
        )
        moving = motion.step(moving, report, plots, self.arpa.motion, scan.radar)
        return Memory(tracked, moving, own, report)

    def targets(self, memory: Memory, time: float) -> TargetData:
        """All confirmed targets, the coasting ones too, at `time`, s."""
        tracks = memory.report.tracks
        rows = np.flatnonzero((tracks.number > 0) & (tracks.status != LOST))
        moving = motion.at(take(memory.motion, rows), time)
        own = own_motion(memory.own, time, heading(memory.own))
        limits = self.arpa.limits
        return TargetData(
            time,
            take(tracks, rows),
            moving,
            cpa.approach(moving, own, limits.cpa, limits.tcpa),
            own,
        )


def heading(own_ship: OwnShip) -> float:
    """The last heading, rad: she goes as she heads."""
    return float(np.arctan2(*own_ship.velocity[-1]))
