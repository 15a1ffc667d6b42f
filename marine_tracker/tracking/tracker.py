"""One scan in, tracks out: all steps of the tracker on one page."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..estimators import ESTIMATORS, Estimator, Velocity
from ..geometry import to_range_bearing
from ..parameters import TrackerParameters
from ..types import Array, CodeArray, Extrapolation, IntArray, Plots, Scan, Tracks, append, take
from . import doppler, late_plots, lifecycle
from .associate import associate, gain
from .existence import EVEN
from .expected import expect
from .gate import gate, gate_size, split
from .initiate import pair_up, unexplained
from .joint import take_plots
from .lifecycle import LOST, TENTATIVE
from .look import look
from .merge import duplicates
from .noise import noise_of
from .radars import HELD_REVOLUTIONS, held_updates, radars_of
from .silence import unmistakable
from .surroundings import Surroundings, learn, ratio, unknown, weigh
from .sweep import sweep_of


class OfRadar(NamedTuple):
    """The memory of one radar.

    leftover  plots of its last scan that belong to no track: one may be a new target's first plot
    known     of its false plots, and of how targets show
    """

    leftover: Plots
    known: Surroundings


class TrackerMemory(NamedTuple):
    """The memory of the tracker between two scans.

    tracks       N tracks, without lost ones
    radars       memory of each radar
    origin       [2] m, own ship's last known position
    next_id      the next track's id
    next_number  the next confirmed track's target number
    """

    tracks: Tracks
    radars: tuple[OfRadar, ...]
    origin: Array
    next_id: int
    next_number: int


class Report(NamedTuple):
    """The results of one scan; one row a track, including lost ones and new ones.

    time       [N]     s, when the beam passed the track (the time of its plot if it had one); or
    the
                       time of its last plot, if another radar's was later
    tracks     N rows, after the scan
    predicted  [N, 2]  m, where the track was expected at `time`; nan for a new track
    plot       [N]     row of the scan's plots that the track took, -1 for none
    reason     [N]     why a LOST track was lost: index into lifecycle.REASONS, 0 = not lost
    begun      [B]     the first plots, of the last scan, of the new tracks: the last B
    """

    time: Array
    tracks: Tracks
    predicted: Array
    plot: IntArray
    reason: CodeArray
    begun: Plots
    left_out: int


class Tracker:
    """The pure tracking core: it takes parameters and has no state.

    tracker = Tracker(TrackerParameters(estimator='imm'))
    memory = tracker.start()
    for scan in scans:
        memory, report = tracker.step(memory, scan)
        estimate = tracker.extrapolate(report.tracks, report.time)      # Extrapolation, N rows

    After a change of parameters, make a new Tracker: `memory = new.adopt(memory, old)` keeps every
    track. An estimator of your own replaces the one that the parameters name. With several radars
    (parameter `radars`) each scan says which radar it is from; scans come in the order of their
    ends.
    """

    def __init__(self, parameters: TrackerParameters, estimator: Estimator | None = None) -> None:
        # Clusters already state the deviation of their middle.
        self.parameters = (
            parameters if parameters.extent == 'none' else replace(parameters, glint_sigma_m=0.0)
        )
        self.estimator = estimator or ESTIMATORS[parameters.estimator](parameters)
        radars = radars_of(self.parameters)
        self.radars = [radar.parameters for radar in radars]
        self.farthest = max(p.max_range_m for p in self.radars)
        self.held = HELD_REVOLUTIONS * np.array([p.scan_period_s for p in self.radars])
        self.updates = held_updates(radars)
        self.gate_size = gate_size(parameters.gate_probability)
        self.doppler = [doppler.limits(p) for p in self.radars]

    def start(self) -> TrackerMemory:
        """No tracks yet."""
        none, pairs = np.zeros(0), np.zeros((0, 2))
        plots = Plots(none, none, none, none, pairs, pairs, np.zeros((0, 2, 2)))
        of_radar = OfRadar(plots, unknown())
        return TrackerMemory(
            self._begin(plots, 1, 0), (of_radar,) * len(self.radars), np.zeros(2), 1, 1
        )

    def extrapolate(self, tracks: Tracks, time: float | Array) -> Extrapolation:
        """The tracks at the times [N] s (or one time for all)."""
        return self.estimator.extrapolate(
            tracks.state, np.broadcast_to(time, tracks.id.shape).astype(float)
        )

    def step(self, memory: TrackerMemory, scan: Scan) -> tuple[TrackerMemory, Report]:
        """One antenna revolution."""
        p, of_radar = self.radars[scan.radar], memory.radars[scan.radar]
        tracks, count = memory.tracks, len(memory.tracks.id)
        noise, speed = noise_of(p, scan), p.max_target_speed_mps
        measured = noise.locate(scan)
        plots, lone = noise.with_glint(measured), noise.with_glint(of_radar.leftover)

        # extrapolate: every track to the time the beam passes it
        sweep = sweep_of(scan)
        beam = sweep.time_at(tracks.bearing)
        ahead = self.estimator.extrapolate(late_plots.as_of(tracks, beam), beam)

        # gate: tracks, and the lone plots of the last scan, whose targets may be anywhere near
        expected = expect(ahead, lone, scan, speed)
        pairs, left_out = gate(noise.with_glint(expected), measured, sweep, noise, self.gate_size)
        pairs, share = doppler.agreeing(pairs, ahead, lone, plots, self.doppler[scan.radar])
        pairs = unmistakable(pairs, ahead, plots, tracks.last_time, scan.start, p.scan_period_s)
        pairs, starts = split(pairs, count)

        # associate
        evidence = weigh(of_radar.known, pairs, share, tracks, expected, plots, p)
        worth = gain(pairs, self.gate_size)
        plot_of = associate(pairs.track, pairs.plot, worth, count, len(plots.time))

        # initiate: from plots of this scan and the last one that belong to no track
        free = unexplained(plots, pairs, plot_of, tracks)
        room = max(0, p.max_tracks - count)
        first, second = pair_up(lone, plots, starts.track, starts.plot, free, speed, room)
        free[second] = False
        begun = take(lone, first)
        if len(first):
            tracks = append(tracks, self._begin(begun, memory.next_id, scan.radar))
        plot_of = np.append(plot_of, second)

        # update
        taken = take_plots(pairs, evidence, plot_of, tracks, ahead, expected, plots, p)
        tracks = late_plots.update(self.estimator, tracks, taken.plots, taken.rows, scan.radar)

        # judge: record the scan for each track, and decide its status
        seen = look(tracks, plot_of, plots, ahead, expected, noise)
        shown = ratio(evidence, pairs, plot_of, begun, plots, p)
        other = lifecycle.held_by_another(tracks, scan.radar, seen.time, pairs.track, self.held)
        rest = other, taken.sharing, p, self.farthest, scan.end
        tracks, reason = lifecycle.step(tracks, seen, shown, *rest)
        tracks, reason = lifecycle.merge(tracks, reason, duplicates(pairs, plot_of, ahead, tracks))
        tracks, next_number = lifecycle.number(tracks, memory.next_number)

        # remember
        nowhere = take(lone, np.delete(np.arange(len(lone.time)), first))
        known = learn(of_radar.known, lifecycle.sure(tracks), seen, plot_of, plots, nowhere)
        of_radar, begun = OfRadar(take(measured, free), known), take(of_radar.leftover, first)
        alive = tracks.status != LOST
        return TrackerMemory(
            tracks if alive.all() else take(tracks, alive),
            memory.radars[: scan.radar] + (of_radar,) + memory.radars[scan.radar + 1 :],
            scan.own_ship.position[-1],
            memory.next_id + len(first),
            next_number,
        ), Report(seen.time, tracks, seen.predicted, plot_of, reason, begun, left_out)

    def adopt(self, memory: TrackerMemory, previous: 'Tracker') -> TrackerMemory:
        """Takes over the memory of another tracker for this one's estimator. No track is lost.

        If the estimator differs, each track starts again from the position and velocity of its last
        estimate.
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
            existence=np.full(count, EVEN),
            age=none + 1,
            first_time=plots.time,
            last_time=plots.time,
            bearing=plots.bearing,
            state=state,
            radar=(np.full(count, radar, np.int8) if len(self.radars) > 1 else None),
            past=late_plots.nothing_yet(state, plots, self.updates),
        )
