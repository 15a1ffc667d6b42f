"""One scan in, tracks out: all steps of the tracker on one page."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..estimators import ESTIMATORS, Estimator, Velocity
from ..geometry import to_range_bearing
from ..parameters import TrackerParameters
from ..types import (
    Array,
    BoolArray,
    CodeArray,
    Extrapolation,
    IntArray,
    Plots,
    Scan,
    Tracks,
    append,
    some,
    take,
)
from . import (
    at_rest,
    doppler,
    land_mask,
    late_plots,
    lifecycle,
    meetings,
    offsets,
    parts,
    places,
    sectors,
    split_plots,
    surroundings,
)
from .associate import associate, gain
from .existence import EVEN
from .expected import Expected, expect
from .gate import Pairs, gate, gate_size, split
from .initiate import pair_up, unexplained
from .joint import take_plots
from .land_mask import on_land
from .lifecycle import LOST, STATIONARY, TENTATIVE
from .look import Look, look
from .memory import Left, OfRadar, changed
from .memory import Report as Report
from .memory import TrackerMemory as TrackerMemory
from .merge import duplicates
from .noise import Noise, noise_of
from .radars import HELD_REVOLUTIONS, held_updates, radars_of
from .silence import unmistakable
from .sweep import sweep_of


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
        self.marks = offsets.marks_of(parameters.known_marks)
        self.land = land_mask.read(parameters.land_mask, parameters.land_mask_origin)

    def start(self) -> TrackerMemory:
        """No tracks yet."""
        none, pairs = np.zeros(0), np.zeros((0, 2))
        plots = Plots(none, none, none, none, pairs, pairs, np.zeros((0, 2, 2)))
        of_radar = OfRadar(plots, surroundings.unknown(), offsets.begin())
        return TrackerMemory(
            self._begin(plots, 1, 0),
            (of_radar,) * len(self.radars),
            np.zeros(2),
            1,
            1,
            at_rest.begin(),
            meetings.begin(),
        )

    def extrapolate(self, tracks: Tracks, time: float | Array) -> Extrapolation:
        """The tracks at the times [N] s (or one time for all)."""
        return self.estimator.extrapolate(
            tracks.state, np.broadcast_to(time, tracks.id.shape).astype(float)
        )

    def step(self, memory: TrackerMemory, scan: Scan) -> tuple[TrackerMemory, Report]:
        """One antenna revolution, or a part of one (see sectors.py)."""
        if scan.sector is not None:
            return parts.step(self, memory, scan)
        memory, report, left = self.judge(memory, scan)
        return self.learnt(memory, scan.radar, scan.end, left.found), report

    def learnt(
        self, memory: TrackerMemory, radar: int, end: float, found: sectors.Found
    ) -> TrackerMemory:
        """The memory after a whole revolution: false plots, and places where plots always are."""
        p, of_radar = self.radars[radar], memory.radars[radar]
        around, (position, variance, time), told = found[:5], found[5:8], found[8:]
        learnt = surroundings.learn(of_radar.known, end, of_radar.leftover, *around)
        known, number = at_rest.name(memory.ground.places, memory.next_number)
        if p.stationary_places:
            view = places.View(memory.origin, p.min_range_m, p.max_range_m)
            known = places.learn(known, position, variance, time, view)
        off = offsets.learn(of_radar.offsets, known, position, variance, told, p, self.marks)
        ground = memory.ground._replace(places=known, revolutions=memory.ground.revolutions + 1)
        memory = memory._replace(next_number=number, ground=ground)
        return changed(memory, radar, known=learnt, offsets=off)

    def judge(
        self, memory: TrackerMemory, scan: Scan, others: int = 0
    ) -> tuple[TrackerMemory, Report, Left]:
        """The tracks of the memory with the plots of the scan; `others` tracks are not judged."""
        p, tracks, count = self.radars[scan.radar], memory.tracks, len(memory.tracks.id)
        view = self._view(memory, scan)
        ahead, expected, plots, lone = view.ahead, view.expected, view.plots, view.lone
        pairs, starts = split(view.pairs, count)

        # associate
        evidence = surroundings.weigh(
            memory.radars[scan.radar].known, pairs, view.share, tracks, expected, plots, p
        )
        worth = gain(pairs, self.gate_size)
        plot_of = associate(pairs.track, pairs.plot, worth, count, len(plots.time))

        plots = split_plots.fused(pairs, plot_of, plots, evidence.density, p)

        # initiate: from plots of this scan and the last one that belong to no track
        free = unexplained(plots, pairs, plot_of, tracks)
        afloat = ~on_land(self.land, plots.position)
        free &= afloat
        room, speed = max(0, p.max_tracks - count - others), p.max_target_speed_mps
        first, second = pair_up(lone, plots, starts.track, starts.plot, free, speed, room)
        single = split_plots.alone(second, plot_of, plots, p)
        first, second = first[single], second[single]
        free[second] = False
        new = take(lone, first)
        if len(first):
            tracks = append(tracks, self._begin(new, memory.next_id, scan.radar))
        plot_of = np.append(plot_of, second)

        # update
        taken = take_plots(pairs, evidence, plot_of, tracks, ahead, expected, plots, p)
        plot_of = taken.plot_of
        met = memory.meetings, taken.contested, plot_of, tracks, ahead, scan.end
        memory = memory._replace(meetings=meetings.step(*met))
        tracks = late_plots.update(self.estimator, tracks, taken.plots, taken.rows, scan.radar)

        # judge: record the scan for each track, and decide its status
        seen = look(tracks, plot_of, plots, ahead, expected, view.noise, scan)
        ratio = surroundings.ratio(evidence, pairs, plot_of, new, plots, p)
        other = lifecycle.held_by_another(tracks, scan.radar, seen.time, pairs.track, self.held)
        rest = other, taken.sharing, p, self.farthest, scan.end
        tracks, reason = lifecycle.step(tracks, seen, ratio, *rest)
        tracks, reason = lifecycle.merge(tracks, reason, duplicates(pairs, plot_of, ahead, tracks))
        judged = self._at_rest(memory, tracks, plot_of, seen, view, afloat)
        return _remember(memory, scan, view, judged, seen, plot_of, reason, first, free)

    def _view(self, memory: TrackerMemory, scan: Scan) -> '_View':
        """The scan's plots, where tracks and lone plots are expected, and the pairs of the gate."""
        p, tracks = self.radars[scan.radar], memory.tracks
        noise = noise_of(p, scan)
        measured = noise.locate(scan)
        plots = noise.with_glint(measured)
        lone = noise.with_glint(memory.radars[scan.radar].leftover)

        # extrapolate: every track to the time the beam passes it
        sweep = sweep_of(scan)
        beam = sweep.time_at(tracks.bearing)
        ahead = self.estimator.extrapolate(late_plots.as_of(tracks, beam), beam)

        # gate: tracks, and the lone plots of the last scan, whose targets may be anywhere near
        expected = expect(ahead, lone, scan, p.max_target_speed_mps)
        echoing = noise.with_glint(expected)
        pairs, left_out = gate(echoing, measured, sweep, noise, self.gate_size)
        pairs, share = doppler.agreeing(pairs, ahead, lone, plots, self.doppler[scan.radar])
        pairs = unmistakable(pairs, ahead, plots, tracks.last_time, scan.start, p.scan_period_s)
        spread = echoing.covariance[: len(tracks.id)]
        return _View(
            p, noise, measured, plots, lone, ahead, expected, spread, pairs, share, left_out
        )

    def _at_rest(
        self,
        memory: TrackerMemory,
        tracks: Tracks,
        plot_of: IntArray,
        seen: Look,
        view: '_View',
        afloat: BoolArray,
    ) -> '_Judged':
        """The tracks with those at rest as such, and numbered; which plots tell places."""
        was = np.zeros(len(plot_of), bool)
        was[: len(memory.tracks.id)] = memory.tracks.status == STATIONARY
        plots, variance = view.plots, at_rest.larger(view.plots.covariance)
        still = at_rest.standing(
            plot_of, plots.position, variance, view.ahead, view.spread, seen.time
        )
        ground, tracks, learnable = at_rest.step(memory.ground, tracks, was, still)
        tracks, next_number = lifecycle.number(tracks, memory.next_number)
        fixed = afloat.copy()
        fixed[plot_of[seen.hit & ~learnable]] = False
        return _Judged(tracks, ground, next_number, fixed, variance)

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


class _View(NamedTuple):
    """What a scan shows, before any plot is a track's: M plots, N tracks, L lone plots.

    radar     parameters of the one that scanned; noise: of its plots
    measured  the plots as they are; plots, lone: with the covariance of glint
    ahead     the tracks when the beam passes them; expected: tracks, then lone plots
    spread    [N, 2, 2] m^2, of the places where the tracks may echo
    pairs     of the gate; share: what part of them radial speeds left
    left_out  number of pairs beyond the budget
    """

    radar: TrackerParameters
    noise: Noise
    measured: Plots
    plots: Plots
    lone: Plots
    ahead: Extrapolation
    expected: Expected
    spread: Array
    pairs: Pairs
    share: doppler.Shares
    left_out: int


class _Judged(NamedTuple):
    """Tracks as the scan has judged them; the places; mask [M] of the plots that tell places, and
    the variances [M] m^2 of all plots, along their larger axes."""

    tracks: Tracks
    ground: at_rest.Ground
    next_number: int
    fixed: BoolArray
    variance: Array


def _remember(
    memory: TrackerMemory,
    scan: Scan,
    view: _View,
    judged: _Judged,
    seen: Look,
    plot_of: IntArray,
    reason: CodeArray,
    first: IntArray,
    free: BoolArray,
) -> tuple[TrackerMemory, Report, Left]:
    """The memory after a scan, the report of it, and what it left.

    plot_of, reason [N] of the tracks; first [B]: the lone plots that began the last B of them;
    free [M]: the plots that are lone now
    """
    tracks, lone, leftover = judged.tracks, view.lone, memory.radars[scan.radar].leftover
    nowhere = lone if not len(first) else take(lone, np.delete(np.arange(len(lone.time)), first))
    at = some(view.plots, judged.fixed)
    sure = lifecycle.sure(tracks) & (tracks.status != STATIONARY)
    found = surroundings.found(sure, lifecycle.given_up(tracks, reason), seen, nowhere)
    found = (*found, at.position, judged.variance[judged.fixed], at.time)
    found = (*found, at.range, at.bearing, at.origin, offsets.rates(scan, at.time, view.radar))
    alive = tracks.status != LOST
    after = TrackerMemory(
        some(tracks, alive),
        memory.radars,
        scan.own_ship.position[-1],
        memory.next_id + len(first),
        judged.next_number,
        judged.ground,
        memory.meetings,
    )
    told = seen.time, tracks, seen.predicted, plot_of, reason, take(leftover, first)
    report = Report(*told, view.left_out, scan, at_rest.shown(judged.ground), memory.meetings)
    after = changed(after, scan.radar, leftover=take(view.measured, free))
    return after, report, Left(free, found)
