"""From one scan's tracks to targets and alarms: all steps of the ARPA on one page."""

from typing import NamedTuple

import numpy as np

from ..geometry import NAUTICAL_MILE, polar_to_position
from ..parameters import ArpaParameters, TrackerParameters
from ..tracking import meetings
from ..tracking.gate import gate_size
from ..tracking.lifecycle import CONFIRMED, LOST
from ..tracking.noise import noise_of
from ..tracking.radars import radars_of
from ..tracking.tracker import Report
from ..types import (
    Array,
    BoolArray,
    CodeArray,
    IntArray,
    OwnShip,
    Scan,
    Tracks,
    append,
    row_of,
    take,
)
from . import acquisition, alarms, alerts, motion, past_positions, situation, stationary, zones
from .acquisition import Acquisition
from .alerts import Alerts
from .anchor import at_anchor, harmless
from .cpa import Approach, OwnMotion, approach
from .motion import Motion
from .own_motion import lately, own_motion, sea_stabilised
from .past_positions import PastPositions
from .stabilisation import ALL_WELL, NONE, OwnSensors, Stabilisation, stabilisation
from .stationary import Stationary
from .swap_risk import swap_risk
from .targets import Events, Targets

Mask = bool | BoolArray  # for all rows, or [N]


class ArpaMemory(NamedTuple):
    """The memory of the ARPA between two scans; see the modules with the same names.

    own  own ship's recent samples
    """

    own: OwnShip
    motion: motion.MotionMemory
    acquisition: Acquisition
    alerts: Alerts
    past: PastPositions


class Picture(NamedTuple):
    """The targets after a scan, in the order of their numbers. All fields have T rows except own
    and events.

    time      s, end of the scan
    own       own ship then
    row       [T]  of each target in the tracker's report
    targets   T rows, including those that were lost in this scan
    motion    T rows, as stabilised: course and speed over ground or through the water
    approach  T rows
    past      past positions of all tracks
    harmless  [T]  own ship is at anchor and the target does not certainly come nearer
    danger    [T]  one of situation.SAFE, NEARLY, DANGEROUS
    swapped   [T]  probability that the track has exchanged its target with another one since they
                   met (tracking.meetings)
    events    what happened to targets in this scan
    alerts    those that are not normal
    changed   the alerts that changed in this scan, also those that became normal
    stabilised   the reference of courses and speeds
    fixed        stationary objects, which are no targets
    """

    time: float
    own: OwnMotion
    row: IntArray
    targets: Targets
    motion: Motion
    approach: Approach
    past: PastPositions
    harmless: BoolArray
    danger: CodeArray
    swapped: Array
    events: Events
    alerts: Alerts
    changed: Alerts
    stabilised: Stabilisation
    fixed: Stationary


class Arpa:
    """The pure core: it takes parameters and has no state.

    arpa = Arpa(ArpaParameters(), tracker.parameters)
    memory = arpa.start()
    memory, picture = arpa.step(memory, scan, report, heading)      # of each step of the tracker

    After a change of parameters, make a new Arpa and continue with the same memory. ValueError if
    the zones are wrong.
    """

    def __init__(self, parameters: ArpaParameters, tracker: TrackerParameters) -> None:
        p = self.parameters = parameters
        self.radars = radars_of(tracker)
        self.limits = situation.Limits(p.cpa_limit_nm * NAUTICAL_MILE, 60 * p.tcpa_limit_min)
        self.zones = zones.parse(p.zones)
        self.acquisition = acquisition.AcquisitionSettings(
            p.acquisition, p.max_targets, p.click_radius_m, p.click_wait_s
        )
        self.alarms = alarms.AlarmSettings(sensor_timeout=p.sensor_timeout_s, limits=self.limits)
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
        fallen: Mask = False,
        sensors: OwnSensors = ALL_WELL,
    ) -> tuple[ArpaMemory, Picture]:
        """Processes one antenna revolution. All results are for its end.

        heading  rad, own ship's, true; nan if unknown
        fallen   [N] of the report's tracks, or one for all: their estimator has fallen back
        sensors  what is known of own ship beside her positions
        """
        now, tracks, radar = scan.end, report.tracks, self.radars[scan.radar].parameters
        samples, p = lately(memory.own, scan.own_ship, now), self.parameters
        own = own_motion(samples, now, heading)._replace(north=sensors.north)

        # motion: course and speed from a memory of their own
        plots = noise_of(radar, scan).locate(scan)
        remembered = motion.step(memory.motion, report, plots, self.motion, scan.radar)
        moving = motion.at(remembered, now)
        past = past_positions.step(memory.past, tracks.id, tracks.first_time, moving, own, now)

        # cpa: how the tracks pass own ship
        own, no_danger = self.anchored(samples, moving, own, now, sensors)
        rest = stationary.look(report.places, own, self.limits, now)
        moving, own, against = self._stabilised(moving, own, sensors, tracks)
        passing = self._approach(moving, own, memory.acquisition, tracks)
        seen = situation.look(
            tracks, report.reason, moving.position, passing, no_danger, self.zones, own, self.limits
        )

        # acquisition: which of them are targets
        acquired, events = acquisition.step(memory.acquisition, self.acquisition, seen, now)
        targets, row = _shown(acquired, memory.acquisition, tracks)

        # alarms: those after the scan, and those that changed
        swap = self._swap_risk(report, remembered, passing, own, now, radar)
        tracking = alarms.Tracking(p.max_targets, _fell(fallen, acquired, tracks), *swap, *rest.way)
        alarm = alarms.step(
            memory.alerts, self.alarms, seen, acquired, events, self.zones, tracking, now
        )

        # the picture: the rows of the targets
        moving, passing = take(moving, row), take(passing, row)
        told = no_danger[row], seen.danger[row], swap[2][row], events, *alarm, against
        known = ArpaMemory(samples, remembered, acquired, alarm[0], past)
        return known, Picture(now, own, row, targets, moving, passing, past, *told, rest)

    def _stabilised(
        self, moving: Motion, own: OwnMotion, sensors: OwnSensors, tracks: Tracks
    ) -> tuple[Motion, OwnMotion, Stabilisation]:
        """Motion of the tracks and of own ship relative to ground or water, and to which."""
        number, stationary = self.parameters.reference_target, np.full(2, np.nan)
        row = ((tracks.number == number) & (tracks.status != LOST) & (number > 0)).nonzero()[0]
        if len(row):
            stationary = moving.velocity[row[0]]
        against = stabilisation(self.parameters, own, sensors, stationary)
        return *sea_stabilised(moving, own, against.drift), against

    def anchored(
        self, samples: OwnShip, moving: Motion, own: OwnMotion, now: float, sensors: OwnSensors
    ) -> tuple[OwnMotion, BoolArray]:
        """Own ship, at rest if she is at anchor; and the tracks [N] that are no danger then."""
        status = self.parameters.own_ship_status
        known = sensors.way != NONE and len(samples.time)
        if not known or not at_anchor(samples, own, now, status):
            return own, np.zeros(len(moving.position), bool)
        return own._replace(velocity=np.zeros(2)), harmless(moving, own)

    def _approach(
        self, moving: Motion, own: OwnMotion, acquired: Acquisition, tracks: Tracks
    ) -> Approach:
        """Approach of tracks that are or may become targets in this scan; nan for the others."""
        asked = (tracks.number > 0) | np.isin(tracks.id, acquired.targets.id)
        if len(acquired.clicks.since):
            asked[:] = True
        position = np.where(asked[:, None], moving.position, np.nan)
        return approach(moving._replace(position=position), own, self.limits.cpa, self.limits.tcpa)

    def _swap_risk(
        self,
        report: Report,
        remembered: motion.MotionMemory,
        passing: Approach,
        own: OwnMotion,
        now: float,
        radar: TrackerParameters,
    ) -> tuple[Array, IntArray, Array, IntArray]:
        """Overlap [N] of the gates in the radar's next scan, and rows [N] of the other tracks; the
        probability [N] of a swap, and with which row [N]."""
        tracks = report.tracks
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
        return overlap, other, *meetings.told(report.meetings, tracks.id)


def _shown(acquired: Acquisition, before: Acquisition, tracks: Tracks) -> tuple[Targets, IntArray]:
    """The targets in the order of their numbers, including those that were lost in this scan; and
    their rows [T] in the tracks."""
    lost = np.isin(before.targets.id, tracks.id[tracks.status == LOST])
    targets = append(acquired.targets, take(before.targets, lost))
    targets = take(targets, np.lexsort((targets.id, targets.number, targets.number == 0)))
    return targets, row_of(tracks.id, targets.id)


def _fell(fallen: Mask, acquired: Acquisition, tracks: Tracks) -> int:
    """Number of confirmed targets that have fallen back; `fallen` [N] for the tracks, or one for
    all.
    """
    target = acquisition.how_acquired(acquired, tracks.id) >= 0
    return int(np.sum(fallen & target & (tracks.status == CONFIRMED)))
