"""One scan in, tracks out: the whole way of the data on one page."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..estimators import ESTIMATORS
from ..geometry import locate, own_ship_at, to_range_bearing, wrap_bearing
from ..parameters import TrackerParameters
from ..types import Array, Extrapolation, Plots, Scan, Tracks, append, take
from . import clutter_map, lifecycle
from .associate import associate
from .gate import gate, gate_size
from .initiate import first_score, pair_up, reach
from .lifecycle import CONFIRMED, LOST, MERGED, TENTATIVE
from .merge import duplicates
from .sweep import sweep_of


class Memory(NamedTuple):
    """All that the tracker knows between two scans.

    tracks       N tracks, lost ones left out
    leftover     plots of the last scan that belong to no track: one may be a new target's first
    clutter      the density of false plots
    next_id      the next track's id
    next_number  the next confirmed track's target number
    """

    tracks: Tracks
    leftover: Plots
    clutter: clutter_map.ClutterMap
    next_id: int
    next_number: int


class Report(NamedTuple):
    """What one scan did; one row a track, the lost ones and those just initiated included.

    time       [N]     s, when the beam passed the track (its plot's time where it had one)
    tracks     N rows, after the scan
    predicted  [N, 2]  m, where the track was expected at `time`; nan for a new track
    plot       [N]     row of the scan's plots that the track took, -1 for none
    reason     [N]     why a LOST track was lost: one of lifecycle.REASONS' numbers, 0 = not lost
    """

    time: Array
    tracks: Tracks
    predicted: Array
    plot: NDArray[np.int64]
    reason: NDArray[np.int8]


class Tracker:
    """The pure tracking core: parameters in, no state of its own.

    tracker = Tracker(TrackerParameters(estimator='imm'))
    memory = tracker.start()
    for scan in scans:
        memory, report = tracker.step(memory, scan)
        estimate = tracker.extrapolate(report.tracks, report.time)      # Extrapolation, N rows

    A change of parameters is a new Tracker: `memory = new.adopt(memory, old)` keeps every track.
    """

    def __init__(self, parameters: TrackerParameters):
        self.parameters = parameters
        self.estimator = ESTIMATORS[parameters.estimator](parameters)
        self.bearing_sigma = float(np.radians(parameters.bearing_sigma_deg))
        self.gate_size = gate_size(parameters.gate_probability)

    def start(self) -> Memory:
        """No tracks yet."""
        none, pairs = np.zeros(0), np.zeros((0, 2))
        plots = Plots(none, none, none, none, pairs, pairs, np.zeros((0, 2, 2)))
        clutter = clutter_map.empty()
        return Memory(self._initiate(plots, plots, clutter, 1), plots, clutter, 1, 1)

    def extrapolate(self, tracks: Tracks, time) -> Extrapolation:
        """The tracks at the times [N] s (or one time for all)."""
        return self.estimator.extrapolate(tracks.state,
                                          np.broadcast_to(time, tracks.id.shape).astype(float))

    def step(self, memory: Memory, scan: Scan) -> tuple[Memory, Report]:
        """One antenna revolution."""
        p, tracks, lone = self.parameters, memory.tracks, memory.leftover
        count = len(tracks.id)
        sweep = sweep_of(scan)
        plots = locate(scan.plots, scan.own_ship, p.range_sigma_m, self.bearing_sigma)

        # extrapolate: every track to the time the beam passes it
        ahead = self.estimator.extrapolate(tracks.state, sweep.time_at(tracks.bearing))

        # gate: tracks, and the lone plots of the last scan, whose targets may be anywhere near
        time, position, velocity, covariance = (np.concatenate(pair) for pair in (
            (ahead.time, lone.time), (ahead.position, lone.position),
            (ahead.velocity, np.zeros_like(lone.position)),
            (ahead.covariance[:, :2, :2], reach(lone, scan.end, p.max_target_speed_mps))))
        origin, _ = own_ship_at(scan.own_ship, time)
        track, plot, nis, log_det = gate(time, position, velocity, covariance, sweep, plots, origin,
                                         p.range_sigma_m, self.bearing_sigma, self.gate_size)
        held = np.searchsorted(track, count)
        first, second = track[held:] - count, plot[held:]
        track, plot, nis, log_det = track[:held], plot[:held], nis[:held], log_det[:held]

        # associate
        gain = self.gate_size - nis + (log_det.max(initial=0.0) - log_det) + 1e-9
        plot_of = associate(track, plot, gain, count, len(plots.time))
        hit = plot_of >= 0
        rows, taken = np.flatnonzero(hit), plot_of[hit]
        chosen = take(plots, taken)

        # update
        state = self.estimator.update(tracks.state, chosen, rows)
        time, last_time = ahead.time.copy(), tracks.last_time.copy()
        time[rows] = last_time[rows] = chosen.time
        predicted = ahead.position + (time - ahead.time)[:, None] * ahead.velocity
        distance, bearing = to_range_bearing(predicted - origin[:count])
        density = clutter_map.density(memory.clutter, distance, bearing)
        bearing[rows] = wrap_bearing(chosen.bearing)
        tracks = tracks._replace(state=state, last_time=last_time, bearing=bearing)

        # lifecycle
        own = np.flatnonzero(plot_of[track] == plot)                # pairs, as rows ascends
        gained = lifecycle.evidence(nis[own], log_det[own], density[rows], p.detection_probability)
        visible = (distance >= p.min_range_m) & (distance <= p.max_range_m)
        tracks = lifecycle.record(tracks, hit, visible, gained, p)
        drift = np.sqrt((ahead.covariance[:, 0, 0] + ahead.covariance[:, 1, 1])
                        / (p.range_sigma_m ** 2 + (distance * self.bearing_sigma) ** 2))
        status, reason = lifecycle.judge(tracks, p, hit, distance > p.max_range_m, drift, scan.end)
        double = duplicates(track, plot, plot_of, ahead, tracks, status)
        status[double], reason[double] = LOST, MERGED
        newly = np.flatnonzero((tracks.number == 0) & (status == CONFIRMED))
        number = tracks.number.copy()
        number[newly] = memory.next_number + np.arange(len(newly))
        tracks = tracks._replace(status=status, number=number)

        # initiate: from plots of this scan and the last that nobody else explains
        free = np.ones(len(plots.time), bool)
        free[taken] = False
        free[plot[status[track] != TENTATIVE]] = False              # echoes of held targets
        room = max(0, p.max_tracks - int(np.count_nonzero(status != LOST)))
        first, second = pair_up(lone, plots, first, second, free, p.max_target_speed_mps, room)
        new = self._initiate(take(lone, first), take(plots, second), memory.clutter, memory.next_id)
        free[second] = False
        single = np.ones(len(lone.time), bool)
        single[first] = False
        clutter = clutter_map.learn(memory.clutter, lone.range[single], lone.bearing[single])

        everyone = append(tracks, new)
        report = Report(np.concatenate([time, new.last_time]), everyone,
                        np.concatenate([predicted, np.full((len(second), 2), np.nan)]),
                        np.concatenate([plot_of, second]),
                        np.concatenate([reason, np.zeros(len(second), np.int8)]))
        return Memory(take(everyone, everyone.status != LOST), take(plots, free), clutter,
                      memory.next_id + len(second), memory.next_number + len(newly)), report

    def adopt(self, memory: Memory, previous: 'Tracker') -> Memory:
        """The memory of another tracker, made fit for this one's estimator; no track is lost.

        Where the estimator differs, each track starts anew from its last estimate: one plot
        with the old estimator's position and another a scan before carry its velocity over.
        """
        p, old = self.parameters, previous.parameters
        same = (p.estimator, p.vessel_class) == (old.estimator, old.vessel_class)
        if same or not len(memory.tracks.id):
            state = memory.tracks.state if len(memory.tracks.id) else self.start().tracks.state
            return memory._replace(tracks=memory.tracks._replace(state=state))
        now = previous.extrapolate(memory.tracks, memory.tracks.last_time)
        return memory._replace(tracks=memory.tracks._replace(state=self._restart(now)))

    def _restart(self, now: Extrapolation):
        """Estimator state whose position and velocity are those of `now`."""
        step = self.parameters.scan_period_s
        cov = now.covariance
        before = now.position - step * now.velocity
        spread = cov[:, :2, :2] + step ** 2 * cov[:, 2:, 2:]
        plots = [Plots(time, time, time, time, position, position, covariance)
                 for time, position, covariance in (
                     (now.time - step, before, spread), (now.time, now.position, cov[:, :2, :2]))]
        return self.estimator.update(self.estimator.init(plots[0]), plots[1],
                                     np.arange(len(now.time)))

    def _initiate(self, first: Plots, second: Plots, clutter, next_id: int) -> Tracks:
        """Tentative tracks of two plots each."""
        p, count = self.parameters, len(first.time)
        density = clutter_map.density(clutter, second.range, second.bearing)
        return Tracks(
            id=np.arange(next_id, next_id + count), number=np.zeros(count, np.int64),
            status=np.full(count, TENTATIVE, np.int8), history=np.full(count, 0b11),
            score=first_score(first, second, density, p.max_target_speed_mps,
                              p.detection_probability),
            age=np.full(count, 2), first_time=first.time, last_time=second.time,
            bearing=second.bearing,
            state=self.estimator.update(self.estimator.init(first), second, np.arange(count)))
