"""One scan in, tracks out: the whole way of the data on one page."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from ..estimators import ESTIMATORS, Estimator, Velocity
from ..geometry import locate, own_ship_at, to_range_bearing
from ..parameters import TrackerParameters
from ..types import Array, Extrapolation, Plots, Scan, Tracks, append, take
from . import clutter_map, doppler, late_plots, lifecycle
from .associate import associate
from .gate import gate, gate_size
from .initiate import first_score, pair_up, reach
from .lifecycle import CONFIRMED, LOST, MERGED, TENTATIVE
from .merge import duplicates
from .radars import HELD_REVOLUTIONS, held_updates, radars_of
from .sweep import sweep_of


class OfRadar(NamedTuple):
    """What is known of one radar.

    leftover  plots of its last scan that belong to no track: one may be a new target's first
    clutter   the density of its false plots
    """

    leftover: Plots
    clutter: clutter_map.ClutterMap


class TrackerMemory(NamedTuple):
    """All that the tracker knows between two scans.

    tracks       N tracks, lost ones left out
    radars       of each radar
    origin       [2] m, own ship when last heard of
    next_id      the next track's id
    next_number  the next confirmed track's target number
    """

    tracks: Tracks
    radars: tuple[OfRadar, ...]
    origin: Array
    next_id: int
    next_number: int


class Report(NamedTuple):
    """What one scan did; one row a track, the lost ones and those just initiated included.

    time       [N]     s, when the beam passed the track (its plot's time where it had one); or
                       its last plot's, where another radar's was later
    tracks     N rows, after the scan
    predicted  [N, 2]  m, where the track was expected at `time`; nan for a new track
    plot       [N]     row of the scan's plots that the track took, -1 for none
    reason     [N]     why a LOST track was lost: one of lifecycle.REASONS' numbers, 0 = not lost
    begun      [B]     the first plots, of the last scan, of the tracks just initiated: the last B
    """

    time: Array
    tracks: Tracks
    predicted: Array
    plot: NDArray[np.int64]
    reason: NDArray[np.int8]
    begun: Plots


class Tracker:
    """The pure tracking core: parameters in, no state of its own.

    tracker = Tracker(TrackerParameters(estimator='imm'))
    memory = tracker.start()
    for scan in scans:
        memory, report = tracker.step(memory, scan)
        estimate = tracker.extrapolate(report.tracks, report.time)      # Extrapolation, N rows

    A change of parameters is a new Tracker: `memory = new.adopt(memory, old)` keeps every track.
    An estimator of your own takes the place of the one that the parameters name. Of several
    radars (parameter `radars`) each scan says which it is from; scans come as they end.
    """

    def __init__(self, parameters: TrackerParameters, estimator: Estimator | None = None):
        # Clusters tell what their middle strays.
        self.parameters = (
            parameters if parameters.extent == 'none' else replace(parameters, glint_sigma_m=0.0)
        )
        self.estimator = estimator or ESTIMATORS[parameters.estimator](parameters)
        radars = radars_of(self.parameters)
        self.radars = [radar.parameters for radar in radars]
        self.farthest = max(p.max_range_m for p in self.radars)
        self.held = HELD_REVOLUTIONS * np.array([p.scan_period_s for p in self.radars])
        self.updates = held_updates(radars)
        self.glint = self.parameters.glint_sigma**2 * np.eye(2)
        self.gate_size = gate_size(parameters.gate_probability)
        self.speed_gate = (
            float(ndtri(0.5 + 0.5 * parameters.gate_probability))
            if parameters.doppler_gate
            else np.inf
        )

    def start(self) -> TrackerMemory:
        """No tracks yet."""
        none, pairs = np.zeros(0), np.zeros((0, 2))
        plots = Plots(none, none, none, none, pairs, pairs, np.zeros((0, 2, 2)))
        of_radar = OfRadar(plots, clutter_map.empty())
        return TrackerMemory(
            self._begin(plots, 1, 0), (of_radar,) * len(self.radars), np.zeros(2), 1, 1
        )

    def extrapolate(self, tracks: Tracks, time) -> Extrapolation:
        """The tracks at the times [N] s (or one time for all)."""
        return self.estimator.extrapolate(
            tracks.state, np.broadcast_to(time, tracks.id.shape).astype(float)
        )

    def step(self, memory: TrackerMemory, scan: Scan) -> tuple[TrackerMemory, Report]:
        """One antenna revolution."""
        p, tracks, radar = self.radars[scan.radar], memory.tracks, memory.radars[scan.radar]
        count, lone, bearing_sigma = len(tracks.id), radar.leftover, np.radians(p.bearing_sigma_deg)
        sweep = sweep_of(scan)
        plots = locate(scan.plots, scan.own_ship, p.range_sigma_m, bearing_sigma)

        # extrapolate: every track to the time the beam passes it
        beam = sweep.time_at(tracks.bearing)
        ahead = self.estimator.extrapolate(late_plots.as_of(tracks, beam), beam)

        # gate: tracks, and the lone plots of the last scan, whose targets may be anywhere near
        time, position, velocity, covariance = (
            np.concatenate(pair)
            for pair in (
                (ahead.time, lone.time),
                (ahead.position, lone.position),
                (ahead.velocity, np.zeros_like(lone.position)),
                (ahead.covariance[:, :2, :2], reach(lone, scan.end, p.max_target_speed_mps)),
            )
        )
        if p.glint_sigma:
            covariance = covariance + self.glint
        origin, _ = own_ship_at(scan.own_ship, time)
        track, plot, nis, log_det = gate(
            time,
            position,
            velocity,
            covariance,
            sweep,
            plots,
            origin,
            p.range_sigma_m,
            bearing_sigma,
            self.gate_size,
            _widest(scan.plots.covariance),
        )
        if plots.radial_speed is not None:
            fit = doppler.agree(
                track,
                plot,
                ahead,
                lone,
                plots,
                p.radial_speed_sigma_mps,
                p.max_target_speed_mps,
                self.speed_gate,
            )
            track, plot, nis, log_det = track[fit], plot[fit], nis[fit], log_det[fit]
        if p.glint_sigma:
            plots = plots._replace(covariance=plots.covariance + self.glint)
        seam = track.searchsorted(count)
        first, second = track[seam:] - count, plot[seam:]
        track, plot, nis, log_det = track[:seam], plot[:seam], nis[:seam], log_det[:seam]

        # associate
        gain = self.gate_size - nis + (log_det.max(initial=0.0) - log_det) + 1e-9
        plot_of = associate(track, plot, gain, count, len(plots.time))
        held_rows = (plot_of >= 0).nonzero()[0]
        taken = plot_of[held_rows]

        # initiate: from plots of this scan and the last that nobody else explains
        free = np.ones(len(plots.time), bool)
        free[taken] = False
        free[plot[tracks.status[track] != TENTATIVE]] = False  # echoes of held targets
        first, second = pair_up(
            lone, plots, first, second, free, p.max_target_speed_mps, max(0, p.max_tracks - count)
        )
        free[second] = False
        begun = take(lone, first)
        if len(first):
            tracks = append(tracks, self._begin(begun, memory.next_id, scan.radar))
        plot_of = np.concatenate([plot_of, second])
        rows = np.concatenate([held_rows, np.arange(count, len(plot_of))])
        chosen = take(plots, plot_of[rows])

        # update
        tracks = late_plots.update(self.estimator, tracks, chosen, rows, scan.radar)
        last_time = tracks.last_time.copy()
        last_time[rows] = np.maximum(last_time[rows], chosen.time)
        time = np.concatenate([np.maximum(ahead.time, last_time[:count]), last_time[count:]])
        time[rows] = last_time[rows]
        later = time[:count] - ahead.time
        predicted = np.full((len(time), 2), np.nan)
        predicted[:count] = ahead.position + later[:, None] * ahead.velocity

        # lifecycle
        missed = (plot_of < 0).nonzero()[0]
        distance, bearing, drift = np.zeros((3, len(time)))
        distance[rows], bearing[rows] = chosen.range, chosen.bearing
        distance[missed], bearing[missed] = to_range_bearing(
            ahead.position.take(missed, 0) - origin.take(missed, 0)
        )
        drift[missed] = np.sqrt(
            (ahead.covariance[:, 0, 0] + ahead.covariance[:, 1, 1])[missed]
            / (p.range_sigma_m**2 + (distance[missed] * bearing_sigma) ** 2 + 2 * p.glint_sigma**2)
        )
        density = clutter_map.density(radar.clutter, chosen.range, chosen.bearing)
        own = (plot_of[track] == plot).nonzero()[0]  # pairs, as held_rows ascends
        held = len(held_rows)
        gained = lifecycle.evidence(nis[own], log_det[own], density[:held], p.detection_probability)
        if len(first):
            gained = np.concatenate(
                [
                    gained,
                    first_score(
                        begun,
                        take(chosen, slice(held, None)),
                        density[held:],
                        p.max_target_speed_mps,
                        p.detection_probability,
                    ),
                ]
            )
        tracks = tracks._replace(last_time=last_time, bearing=bearing)
        elsewhere = lifecycle.held_by_another(tracks, scan.radar, time, track, self.held)
        visible = (distance >= p.min_range_m) & (distance <= p.max_range_m) & ~elsewhere
        tracks = lifecycle.record(tracks, rows, gained, visible, p)
        status, reason = lifecycle.judge(
            tracks, p, (plot_of >= 0) | elsewhere, distance > self.farthest, drift, scan.end
        )
        double = duplicates(track, plot, plot_of, ahead, tracks, status)
        status[double], reason[double] = LOST, MERGED
        newly = ((tracks.number == 0) & (status == CONFIRMED)).nonzero()[0]
        number = tracks.number.copy()
        number[newly] = memory.next_number + np.arange(len(newly))
        tracks = tracks._replace(status=status, number=number)

        single = np.ones(len(lone.time), bool)
        single[first] = False
        clutter = clutter_map.learn(radar.clutter, lone.range[single], lone.bearing[single])
        radars = list(memory.radars)
        radars[scan.radar] = OfRadar(take(plots, free), clutter)
        alive = status != LOST
        return TrackerMemory(
            tracks if alive.all() else take(tracks, alive),
            tuple(radars),
            scan.own_ship.position[-1],
            memory.next_id + len(second),
            memory.next_number + len(newly),
        ), Report(
            time,
            tracks,
            predicted,
            plot_of,
            reason,
            begun._replace(covariance=begun.covariance - self.glint) if p.glint_sigma else begun,
        )

    def adopt(self, memory: TrackerMemory, previous: 'Tracker') -> TrackerMemory:
        """The memory of another tracker, made fit for this one's estimator; no track is lost.

        Where the estimator differs, each track starts anew from its last estimate's position and
        velocity.
        """
        p, old = self.parameters, previous.parameters
        same = (p.estimator, p.vessel_class) == (old.estimator, old.vessel_class)
        if same or not len(memory.tracks.id):
            tracks = memory.tracks if len(memory.tracks.id) else self.start().tracks
            return memory._replace(tracks=tracks)
        now = previous.extrapolate(memory.tracks, memory.tracks.last_time)
        range_, bearing = to_range_bearing(now.position - memory.origin)
        plots = Plots(
            now.time,
            range_,
            bearing,
            np.zeros_like(range_),
            np.tile(memory.origin, (len(range_), 1)),
            now.position,
            now.covariance[:, :2, :2],
        )
        state = self.estimator.init(plots, Velocity(now.velocity, now.covariance[:, 2:, 2:]))
        return memory._replace(
            tracks=memory.tracks._replace(
                state=state, past=late_plots.nothing_yet(state, plots, self.updates)
            )
        )

    def _begin(self, plots: Plots, next_id: int, radar: int) -> Tracks:
        """Tentative tracks of one plot each."""
        count, state = len(plots.time), self.estimator.init(plots)
        none = np.zeros(count, np.int64)
        return Tracks(
            id=np.arange(next_id, next_id + count),
            number=none,
            status=np.full(count, TENTATIVE, np.int8),
            history=none + 1,
            score=np.zeros(count),
            age=none + 1,
            first_time=plots.time,
            last_time=plots.time,
            bearing=plots.bearing,
            state=state,
            radar=(np.full(count, radar, np.int8) if len(self.radars) > 1 else None),
            past=late_plots.nothing_yet(state, plots, self.updates),
        )


def _widest(covariance) -> float:
    """Deviation m of the least certain of plots with covariances [M, 2, 2] m^2, 0 for None."""
    if covariance is None:
        return 0.0
    return float(np.sqrt(np.trace(covariance, axis1=1, axis2=2).max(initial=0.0)))
