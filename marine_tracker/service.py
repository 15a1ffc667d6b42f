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

from .ais import ais_alarms, fusion
from .ais.ais import Ais, AisMemory, AisPicture
from .ais.join import Seen
from .ais.reports import Reports
from .arpa import motion
from .arpa.alerts import Alerts
from .arpa.arpa import Arpa, ArpaMemory, Picture
from .arpa.cpa import OwnMotion
from .arpa.stabilisation import ALL_WELL, OwnSensors
from .arpa.view import Standing, standing
from .estimators import Estimator
from .extent.extents import Extents, ExtentsMemory
from .extent.hulls import Shapes
from .geometry import heading_from
from .parameters import AisParameters, ArpaParameters, TrackerParameters, from_mapping
from .tracking.lifecycle import CONFIRMED, LOST, STATIONARY
from .tracking.mounting import mounted
from .tracking.offsets import corrected
from .tracking.revolution import Turn, report_of, whole
from .tracking.tracker import Report, Tracker, TrackerMemory
from .types import Array, Extrapolation, OwnShip, Scan, Tracks, append, take


class ServiceMemory(NamedTuple):
    """All that the service knows between two scans.

    turns  of each radar what came of its revolution so far, where it sends sectors
    """

    tracker: TrackerMemory
    extents: ExtentsMemory
    arpa: ArpaMemory
    turns: tuple[Turn, ...]
    ais: AisMemory


class Tracking(NamedTuple):
    """What a scan did to the N tracks that it swept; lost ones and those just initiated are among
    them.

    scan      as the tracker took it: from own ship's reference point; with extents one plot a
              cluster; of a sector the plots that were decided
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
    ais       ships of AIS; None where none was ever heard
    """

    scan: Scan
    report: Report
    estimate: Extrapolation
    shapes: Shapes | None
    standing: Standing
    picture: Picture
    ais: AisPicture | None = None


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
        ais: AisParameters | None = None,
    ) -> None:
        self.tracker = Tracker(tracker, estimator)
        self.extents = Extents(tracker)
        self.arpa = Arpa(arpa or ArpaParameters(), self.tracker.parameters)
        self.ais = Ais(ais or AisParameters(), self.arpa)

    def start(self) -> ServiceMemory:
        """No tracks yet."""
        turns = (Turn(),) * len(self.tracker.radars)
        parts = self.tracker.start(), self.extents.start(), self.arpa.start()
        return ServiceMemory(*parts, turns, self.ais.start())

    def take(
        self,
        memory: ServiceMemory,
        scan: Scan,
        heading: float | None = None,
        sensors: OwnSensors = ALL_WELL,
    ) -> tuple[ServiceMemory, Tracking | None, Output | None]:
        """A scan or a sector: what it did to the tracks, and the output once a revolution is whole.

        The parameters are those of `step`. Targets and alarms are made once a revolution. With
        extents a cluster may lie in two sectors, so all waits for the whole revolution.
        """
        if scan.sector is None:
            memory, output = self.step(memory, scan, heading, sensors)
            return memory, Tracking(*output[:4]), output
        if heading is None:
            heading = heading_of(scan.own_ship)
        turn, done = memory.turns[scan.radar], None
        if self.extents.on:
            turn = turn.then(scan)
        else:
            memory, done = self.track(memory, scan, heading)
            turn = turn.then(done.scan, done.report)
        if not turn.complete:
            return _turned(memory, scan.radar, turn), done, None
        if done is None:
            memory, output = self.step(memory, whole(turn.scans), heading, sensors)
            return _turned(memory, scan.radar, turn.next()), Tracking(*output[:4]), output
        report, turn = report_of(turn, memory.tracker.tracks)
        estimate = self._estimate(memory, report)
        memory, output = self._picture(
            _turned(memory, scan.radar, turn),
            Tracking(report.scan, report, estimate, None),
            heading,
            sensors,
        )
        return memory, done, output

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

        ValueError for a sector, which `take` takes.
        """
        if scan.sector is not None:
            raise ValueError('the scan is a sector; Service.take takes sectors, step whole ones')
        if heading is None:
            heading = heading_of(scan.own_ship)
        memory, done = self.track(memory, scan, heading)
        return self._picture(memory, done, heading, sensors)

    def _picture(
        self, memory: ServiceMemory, done: Tracking, heading: float, sensors: OwnSensors
    ) -> tuple[ServiceMemory, Output]:
        """The second half of `step`: targets and alarms."""
        fares = standing(done.report, self.tracker.estimator)
        tracks, heard = done.report.tracks, bool(len(memory.ais.ships.id))
        known = memory.arpa
        if heard:
            alerts = ais_alarms.to_ships(known.alerts, *memory.ais[:2], tracks)
            known = known._replace(alerts=alerts)
        known, picture = self.arpa.step(
            known, done.scan, done.report, heading, fares.fallen_at, sensors
        )
        memory = memory._replace(arpa=known)
        if not heard:
            return memory, Output(*done, fares, picture)
        seen = _seen(known.motion, tracks, done.scan.end)
        against = picture.stabilised.drift
        memory, ships, changed = self.ships(
            memory, seen, picture.own, against, sensors, done.scan.end
        )
        picture = picture._replace(
            alerts=memory.arpa.alerts, changed=append(picture.changed, changed)
        )
        return memory, Output(*done, fares, picture, ships)

    def _estimate(self, memory: ServiceMemory, report: Report) -> Extrapolation:
        """The tracks of a report at its times, with AIS where that is asked for."""
        estimate = self.tracker.extrapolate(report.tracks, report.time)
        ais = memory.ais
        if not self.ais.parameters.ais_fusion or not len(ais.trusted):
            return estimate
        own = report.scan.own_ship.position[-1]
        return fusion.fused(
            estimate, report.tracks.id, ais.trusted, ais.ships, ais.registration, own
        )

    def hear(self, memory: ServiceMemory, reports: Reports, position: Array) -> ServiceMemory:
        """The memory with reports of AIS, whose places are at `position` [R, 2] m in the frame
        `map`; nan for none. They count from the next step on."""
        return memory._replace(ais=self.ais.hear(memory.ais, reports, position))

    def without_radar(
        self, memory: ServiceMemory, own: OwnMotion, now: float, sensors: OwnSensors = ALL_WELL
    ) -> tuple[ServiceMemory, AisPicture, Alerts]:
        """Ships of AIS where no scan comes: to be called by the clock; now s, of scans' time.

        Returns the alerts that changed last. own: own ship over ground
        """
        return self.ships(memory, None, own, np.zeros(2), sensors, now)

    def ships(
        self,
        memory: ServiceMemory,
        seen: Seen | None,
        own: OwnMotion,
        drift: Array,
        sensors: OwnSensors,
        now: float,
    ) -> tuple[ServiceMemory, AisPicture, Alerts]:
        """Ships of AIS beside the tracks that are seen, as Ais.step; the alerts that changed."""
        known = memory.arpa
        ais, alerts, changed, ships = self.ais.step(
            memory.ais, seen, known.alerts, own, known.own, drift, sensors, now
        )
        return memory._replace(ais=ais, arpa=known._replace(alerts=alerts)), ships, changed

    def track(
        self, memory: ServiceMemory, scan: Scan, heading: float | None = None
    ) -> tuple[ServiceMemory, Tracking]:
        """The first half of `step`: tracks and their sizes, without targets and alarms."""
        tracker, extents = self.tracker, self.extents
        if heading is None:
            heading = heading_of(scan.own_ship)
        scan = mounted(scan, tracker.radars[scan.radar], heading)
        scan = corrected(scan, memory.tracker.radars[scan.radar].offsets.applied)
        seen = None
        if extents.on:
            sure = take(memory.tracker.tracks, memory.tracker.tracks.number > 0)
            ahead = tracker.extrapolate(sure, 0.5 * (scan.start + scan.end))
            scan, seen = extents.reduce(memory.extents, scan, sure.id, ahead)
        tracks, report = tracker.step(memory.tracker, scan)
        if scan.sector is not None:
            scan = scan._replace(plots=report.scan.plots)
        estimate = self._estimate(memory, report)
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
        return memory._replace(
            tracker=self.tracker.adopt(memory.tracker, previous.tracker),
            extents=self.extents.adopt(memory.extents, previous.extents),
            turns=self.start().turns,
        )


def _seen(known: motion.MotionMemory, tracks: Tracks, now: float) -> Seen:
    """The radar's tracks at the time now, s, as AIS is compared with them."""
    moving = motion.at(known, now)
    alive = tracks.status != LOST
    return Seen(
        tracks.id,
        tracks.number,
        moving.position,
        moving.velocity,
        moving.covariance,
        alive & (tracks.number > 0),
        np.isin(tracks.status, (CONFIRMED, STATIONARY)),
    )


def _turned(memory: ServiceMemory, radar: int, turn: Turn) -> ServiceMemory:
    """The memory with what came of the radar's revolution so far."""
    turns = list(memory.turns)
    turns[radar] = turn
    return memory._replace(turns=tuple(turns))


def service_for(values: Mapping[str, Any], **changes: Any) -> Service:
    """A service with the tracker parameters that a scenario or a recording gives, and `changes`;
    else with shipped defaults. ValueError where one is unknown or wrong."""
    return Service(from_mapping(TrackerParameters, {**values, **changes}))


def service_of(tracker: TrackerParameters, arpa: ArpaParameters, ais: AisParameters) -> Service:
    """A service with these parameters. ValueError where they are wrong."""
    return Service(tracker, arpa, ais=ais)


def heading_of(own_ship: OwnShip) -> float:
    """rad: own ship's heading in her last sample; where none is told her course over ground stands
    for it, and nan where she makes no way."""
    if own_ship.heading is not None and np.isfinite(own_ship.heading[-1]):
        return float(own_ship.heading[-1])
    return float(heading_from(own_ship.velocity[-1], np.array(np.nan)))
