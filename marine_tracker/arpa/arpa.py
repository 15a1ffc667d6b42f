"""One scan's tracks in, targets and alarms out: the whole way of the ARPA on one page."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..gaussian.linear import invert_2x2, squared_distance
from ..geometry import AT_REST, NAUTICAL_MILE, locate, polar_to_position
from ..parameters import ArpaParameters, TrackerParameters
from ..tracking.gate import gate_size
from ..tracking.lifecycle import CONFIRMED, LOST
from ..tracking.radars import radars_of
from ..tracking.tracker import Report
from ..types import Array, OwnShip, Scan, Tracks, append, row_of, take
from . import acquisition, alarms, alerts, motion, past_positions, situation, zones
from .acquisition import Acquisition
from .alerts import Alerts
from .cpa import Approach, OwnMotion, approach
from .motion import Motion
from .own_motion import lately, own_motion, sea_stabilised
from .past_positions import PastPositions
from .stabilisation import OwnSensors, Stabilisation, stabilisation
from .swap_risk import swap_risk
from .targets import Events, Targets


class ArpaMemory(NamedTuple):
    """All that the ARPA knows between two scans; see the modules of the same names.

    own  own ship's samples of late
    """

    own: OwnShip
    motion: motion.MotionMemory
    acquisition: Acquisition
    alerts: Alerts
    past: PastPositions


class Picture(NamedTuple):
    """The targets after a scan, in the order of their numbers; T rows but for own and events.

    time      s, end of the scan
    own       own ship then
    row       [T]  of each target in the tracker's report
    targets   T rows; those that were lost in this scan are among them
    motion    T rows, as stabilised: course and speed over ground or through the water
    approach  T rows
    past      past positions of all tracks
    at_rest   [T]  neither the target, as far as is known, nor own ship makes way
    danger    [T]  one of situation.SAFE, NEARLY, DANGEROUS
    overlap   [T]  of the gate with that of another track: below 1 they may be swapped
    events    what happened to targets in this scan
    alerts    those that are not normal
    changed   the alerts that changed in this scan, to normal as well
    stabilised   what courses and speeds are measured against
    """

    time: float
    own: OwnMotion
    row: NDArray[np.int64]
    targets: Targets
    motion: Motion
    approach: Approach
    past: PastPositions
    at_rest: NDArray[np.bool_]
    danger: NDArray[np.int8]
    overlap: Array
    events: Events
    alerts: Alerts
    changed: Alerts
    stabilised: Stabilisation


BY_CHANCE = 11.8  # squared distance of a velocity from 0, of 2 dimensions: 3 sigma


def makes_way(moving: Motion) -> NDArray[np.bool_]:
    """Whether [N] tracks surely move over ground; a new one at anchor shows some speed by noise."""
    inverse, _ = invert_2x2(moving.covariance[:, 2:, 2:])
    return ~moving.stationary & (squared_distance(moving.velocity, inverse) > BY_CHANCE)


class Arpa:
    """The pure core, without a state of its own: parameters in.

    arpa = Arpa(ArpaParameters(), tracker.parameters)
    memory = arpa.start()
    memory, picture = arpa.step(memory, scan, report, heading)      # of each step of the tracker

    A change of parameters is a new Arpa, which goes on from the same memory.
    ValueError where the zones are wrong.
    """

    def __init__(self, parameters: ArpaParameters, tracker: TrackerParameters):
        p = self.parameters = parameters
        self.radars = radars_of(tracker)
        self.limits = situation.Limits(p.cpa_limit_nm * NAUTICAL_MILE, 60 * p.tcpa_limit_min)
        self.zones = zones.parse(p.zones)
        self.acquisition = acquisition.AcquisitionSettings(
            p.acquisition, p.max_targets, p.click_radius_m, p.click_wait_s
        )
        self.alarms = alarms.AlarmSettings(sensor_timeout=p.sensor_timeout_s)
        self.motion = motion.PRESETS[tracker.vessel_class]._replace(
            speed_sigma=0.5 * tracker.max_target_speed_mps
        )
        self.gate_size = gate_size(tracker.gate_probability)

    def start(self) -> ArpaMemory:
        """No targets yet."""
        p = self.parameters
        nothing = OwnShip(np.zeros(0), np.zeros((0, 2)), np.zeros((0, 2)))
        return ArpaMemory(
            nothing,
            motion.begin(len(self.radars)),
            acquisition.begin(),
            alerts.begin(),
            past_positions.begin(p.past_positions, p.past_interval_s),
        )

    def step(
        self,
        memory: ArpaMemory,
        scan: Scan,
        report: Report,
        heading: float,
        fallen=False,
        sensors: OwnSensors = OwnSensors(),
    ) -> tuple[ArpaMemory, Picture]:
        """One antenna revolution; all is reckoned to its end.

        heading  rad, own ship's, true; nan where it is not known
        fallen   [N] of the report's tracks, or one for all: their estimator has fallen back
        sensors  what is known of own ship beside her positions
        """
        now, tracks, radar = scan.end, report.tracks, self.radars[scan.radar].parameters
        bearing_sigma = np.radians(radar.bearing_sigma_deg)
        samples = lately(memory.own, scan.own_ship, now)
        own = own_motion(samples, now, heading)._replace(north=sensors.north)

        # motion: course and speed from a memory of their own
        plots = locate(scan.plots, scan.measured_from, radar.range_sigma_m, bearing_sigma)
        remembered = motion.step(memory.motion, report, plots, self.motion, scan.radar)
        moving = motion.at(remembered, now)
        past = past_positions.step(
            memory.past,
            tracks.id,
            tracks.first_time,
            moving.position,
            moving.velocity,
            own.position,
            own.velocity,
            now,
        )

        # cpa: how the tracks pass own ship
        at_rest = ~makes_way(moving) & (np.hypot(*own.velocity) < AT_REST)
        stabilised = stabilisation(
            self.parameters, own, sensors, self._stationary(tracks, moving)
        )
        moving, own = sea_stabilised(moving, own, stabilised.drift)
        passing = self._approach(moving, own, memory.acquisition, tracks)
        seen = situation.look(
            tracks, report.reason, moving.position, passing, at_rest, self.zones, own, self.limits
        )

        # acquisition: which of them are targets
        before = memory.acquisition.targets
        acquired, events = acquisition.step(memory.acquisition, self.acquisition, seen, now)

        # alarms
        overlap, other = self._swap_risk(tracks, remembered, passing, own, now, radar)
        target = acquisition.how_acquired(acquired, tracks.id) >= 0
        fallen = int(np.sum(fallen & target & (tracks.status == CONFIRMED)))
        alive, changed = alarms.step(
            memory.alerts,
            self.alarms,
            seen,
            acquired,
            events,
            self.zones,
            alarms.Tracking(self.acquisition.capacity, fallen, overlap, other),
            now,
        )

        lost = tracks.id[tracks.status == LOST]
        targets = append(acquired.targets, take(before, np.isin(before.id, lost)))
        targets = take(targets, np.lexsort((targets.id, targets.number, targets.number == 0)))
        row = row_of(tracks.id, targets.id)
        return ArpaMemory(samples, remembered, acquired, alive, past), Picture(
            now,
            own,
            row,
            targets,
            take(moving, row),
            take(passing, row),
            past,
            at_rest[row],
            seen.danger[row],
            overlap[row],
            events,
            alive,
            changed,
            stabilised,
        )

    def _stationary(self, tracks: Tracks, moving: Motion) -> Array:
        """Velocity [2] m/s of the target that the operator says is stationary; nan for none."""
        number = self.parameters.reference_target
        row = ((tracks.number == number) & (tracks.status != LOST) & (number > 0)).nonzero()[0]
        return moving.velocity[row[0]] if len(row) else np.full(2, np.nan)

    def _approach(
        self, moving: Motion, own: OwnMotion, acquired: Acquisition, tracks: Tracks
    ) -> Approach:
        """Of the tracks that are or may become targets in this scan; nan for the others."""
        asked = (tracks.number > 0) | np.isin(tracks.id, acquired.targets.id)
        if len(acquired.clicks.since):
            asked[:] = True
        position = np.where(asked[:, None], moving.position, np.nan)
        return approach(moving._replace(position=position), own, self.limits.cpa, self.limits.tcpa)

    def _swap_risk(
        self,
        tracks,
        remembered: motion.MotionMemory,
        passing: Approach,
        own: OwnMotion,
        now: float,
        radar: TrackerParameters,
    ):
        """Overlap [N] of the gates of the radar's next scan and the rows [N] of the others."""
        overlap, other = np.full(len(tracks.id), np.inf), np.full(len(tracks.id), -1)
        rows = ((tracks.number > 0) & (tracks.status != LOST)).nonzero()[0]
        ahead = motion.at(take(remembered, rows), now + radar.scan_period_s)
        _, noise = polar_to_position(
            passing.range[rows],
            passing.bearing[rows],
            radar.range_sigma_m,
            np.radians(radar.bearing_sigma_deg),
        )
        overlap[rows], found = swap_risk(
            ahead.position, ahead.covariance[:, :2, :2] + noise, own.position, self.gate_size
        )
        other[rows] = np.where(found >= 0, np.append(rows, -1)[found], -1)
        return overlap, other
