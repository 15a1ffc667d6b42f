"""The main path of the data: a scan in; tracks, sizes, targets and alarms out.

    service = Service(TrackerParameters(estimator='imm'), ArpaParameters())
    memory = service.start()
    for scan in scans:
        memory, output = service.step(memory, scan)

Node, replay, scores, the IMO report and the examples all call `step`, so the tests and reports run
the same code as the product. Memory goes in and comes out. After a change of parameters, make a new
Service and let it take over the memory: `memory = new.adopt(memory, old)`. No track is lost.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from .arpa.arpa import Arpa, ArpaMemory, Picture
from .arpa.stabilisation import ALL_WELL, OwnSensors
from .arpa.view import Standing, standing
from .estimators import Estimator
from .extent.extents import Extents, ExtentsMemory
from .extent.hulls import Shapes
from .geometry import heading_from
from .parameters import ArpaParameters, TrackerParameters, from_mapping
from .tracking.mounting import mounted
from .tracking.tracker import Report, Tracker, TrackerMemory
from .types import Extrapolation, OwnShip, Scan, take


class ServiceMemory(NamedTuple):
    """All that the service knows between two scans."""

    tracker: TrackerMemory
    extents: ExtentsMemory
    arpa: ArpaMemory


class Tracking(NamedTuple):
    """What a scan did to the N tracks; lost ones and those just initiated are among them.

    scan      as the tracker took it: from own ship's reference point; with extents one plot a
              cluster
    report    of the tracker
    estimate  N rows, at the report's times
    shapes    N rows: sizes and headings; None with extent none
    """

    scan: Scan
    report: Report
    estimate: Extrapolation
    shapes: Shapes | None


class Output(NamedTuple):
    """What a scan came to: the fields of Tracking, and

    standing  how the estimator fares with the confirmed tracks
    picture   targets and alarms
    """

    scan: Scan
    report: Report
    estimate: Extrapolation
    shapes: Shapes | None
    standing: Standing
    picture: Picture


class Service:
    """Extents, tracker and ARPA as one, without a state of its own: parameters in.

    An `estimator` of your own takes the place of the one that the parameters name.
    ValueError where parameters are wrong.
    """

    def __init__(
        self,
        tracker: TrackerParameters,
        arpa: ArpaParameters | None = None,
        estimator: Estimator | None = None,
    ) -> None:
        self.tracker = Tracker(tracker, estimator)
        self.extents = Extents(tracker)
        self.arpa = Arpa(arpa or ArpaParameters(), self.tracker.parameters)

    def start(self) -> ServiceMemory:
        """No tracks yet."""
        return ServiceMemory(self.tracker.start(), self.extents.start(), self.arpa.start())

    def step(
        self,
        memory: ServiceMemory,
        scan: Scan,
        heading: float | None = None,
        sensors: OwnSensors = ALL_WELL,
    ) -> tuple[ServiceMemory, Output]:
        """One antenna revolution.

        heading  rad, own ship's, true; nan where it is not known; None: see `heading_of`
        sensors  what is known of own ship beside her positions
        """
        if heading is None:
            heading = heading_of(scan.own_ship)
        memory, done = self.track(memory, scan, heading)
        fares = standing(done.report, self.tracker.estimator)
        known, picture = self.arpa.step(
            memory.arpa, done.scan, done.report, heading, fares.fallen_at, sensors
        )
        return memory._replace(arpa=known), Output(*done, fares, picture)

    def track(
        self, memory: ServiceMemory, scan: Scan, heading: float | None = None
    ) -> tuple[ServiceMemory, Tracking]:
        """The first half of `step`: tracks and their sizes, without targets and alarms."""
        tracker, extents = self.tracker, self.extents
        if heading is None:
            heading = heading_of(scan.own_ship)
        scan = mounted(scan, tracker.radars[scan.radar], heading)
        seen = None
        if extents.on:
            sure = take(memory.tracker.tracks, memory.tracker.tracks.number > 0)
            ahead = tracker.extrapolate(sure, 0.5 * (scan.start + scan.end))
            scan, seen = extents.reduce(memory.extents, scan, sure.id, ahead)
        tracks, report = tracker.step(memory.tracker, scan)
        estimate = tracker.extrapolate(report.tracks, report.time)
        known, shapes = memory.extents, None
        if seen is not None:
            known = extents.step(known, seen, report.tracks.id, report.time, report.plot, estimate)
            shapes = extents.shapes(known, seen, estimate)
            report = report._replace(left_out=report.left_out + seen.left_out)
        return (
            memory._replace(tracker=tracks, extents=known),
            Tracking(scan, report, estimate, shapes),
        )

    def adopt(self, memory: ServiceMemory, previous: 'Service') -> ServiceMemory:
        """The memory of another service, made fit for this one; no track is lost."""
        return ServiceMemory(
            self.tracker.adopt(memory.tracker, previous.tracker),
            self.extents.adopt(memory.extents, previous.extents),
            memory.arpa,
        )


def service_for(values: Mapping[str, Any], **changes: Any) -> Service:
    """A service with the tracker parameters that a scenario or a recording gives, and `changes`;
    else with shipped defaults. ValueError where one is unknown or wrong."""
    return Service(from_mapping(TrackerParameters, {**values, **changes}))


def heading_of(own_ship: OwnShip) -> float:
    """rad: own ship's heading in her last sample; where none is told her course over ground stands
    for it, and nan where she makes no way."""
    if own_ship.heading is not None and np.isfinite(own_ship.heading[-1]):
        return float(own_ship.heading[-1])
    return float(heading_from(own_ship.velocity[-1], np.array(np.nan)))
