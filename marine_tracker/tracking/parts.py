"""A step of the tracker with a sector instead of a whole revolution: see sectors.py."""

from typing import Protocol

import numpy as np

from ..estimators import Estimator
from ..parameters import TrackerParameters
from ..types import Array, Scan, append, take
from . import late_plots, sectors
from .expected import expect
from .gate import gate, windows
from .memory import Left, Report, TrackerMemory, changed
from .noise import noise_of
from .sweep import Sweep, sweep_of


class Core(Protocol):
    """What of the tracker is used here."""

    estimator: Estimator
    radars: list[TrackerParameters]
    gate_size: float

    def judge(
        self, memory: TrackerMemory, scan: Scan, others: int = 0
    ) -> tuple[TrackerMemory, Report, Left]:
        """The tracks of the memory with the plots of the scan."""

    def learnt(
        self, memory: TrackerMemory, radar: int, end: float, found: sectors.Found
    ) -> TrackerMemory:
        """The memory after a whole revolution."""


def step(tracker: Core, memory: TrackerMemory, scan: Scan) -> tuple[TrackerMemory, Report]:
    """Judges the tracks whose windows are swept, with the plots that may be theirs."""
    of_radar, tracks, sweep = memory.radars[scan.radar], memory.tracks, sweep_of(scan)
    waiting, lone = of_radar.waiting or sectors.begin(scan), of_radar.leftover
    pool = sectors.pooled(waiting, scan, sweep.period)
    looked = sectors.last_looks(waiting, tracks.id, tracks.last_time)
    seen = _windows(tracker, memory, pool, sweep, looked)
    decided = sectors.decide(waiting, seen, scan, pool.plots, sweep, len(lone.time))
    now = pool._replace(plots=take(pool.plots, decided.plots))
    part = memory._replace(tracks=take(tracks, decided.tracks))
    part = changed(part, scan.radar, leftover=take(lone, decided.lone))
    after, report, left = tracker.judge(part, now, int((~decided.tracks).sum()))

    # what is not decided waits: tracks, lone plots, plots that may be another track's
    again = decided.contested[decided.plots]
    again[report.plot[report.plot >= 0]] = False
    plots = sectors.together(take(pool.plots, ~decided.plots), take(now.plots, again))
    every = append(take(tracks, ~decided.tracks), after.tracks)
    every = take(every, every.id.argsort())
    gone = sectors.unseen(waiting, seen, scan)[: len(looked)]
    looked = np.where(decided.tracks | gone, seen.middle[: len(looked)], looked)
    waiting = sectors.remember(waiting, pool, plots, tracks.id, looked, every, left.found)
    free = take(after.radars[scan.radar].leftover, ~again[left.free])
    memory = changed(
        after._replace(tracks=every),
        scan.radar,
        leftover=sectors.together(take(lone, ~decided.lone), free),
        waiting=waiting,
    )
    if not sectors.complete(waiting):
        return memory, report
    memory = tracker.learnt(memory, scan.radar, scan.end, sectors.found(waiting))
    return changed(memory, scan.radar, waiting=sectors.next_revolution(waiting)), report


def _windows(
    tracker: Core, memory: TrackerMemory, pool: Scan, sweep: Sweep, looked: Array
) -> sectors.Windows:
    """Where and when the beam passes the tracks, judged at `looked` [N] s, and the lone plots."""
    p, tracks, count = tracker.radars[pool.radar], memory.tracks, len(memory.tracks.id)
    noise = noise_of(p, pool)
    measured = noise.locate(pool)
    lone = noise.with_glint(memory.radars[pool.radar].leftover)
    before = np.append(tracks.bearing, lone.bearing)
    passed = sectors.passage(sweep, before, np.append(looked, lone.time))
    beam = passed[:count]
    ahead = tracker.estimator.extrapolate(late_plots.as_of(tracks, beam), beam)
    expected = noise.with_glint(expect(ahead, lone, pool, p.max_target_speed_mps))
    pairs, _ = gate(expected, measured, sweep, noise, tracker.gate_size)
    _, _, _, bearing, half = windows(expected, measured, sweep, noise, tracker.gate_size**0.5)
    return sectors.windows(pairs, measured.time, sweep, passed, before, bearing, half)
