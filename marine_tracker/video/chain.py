"""Sweeps as a radar sends them to scans of plots: placing, extraction, gathering in one step."""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import numpy as np

from ..geometry import wrap_bearing
from ..parameters import VideoParameters
from ..types import OwnShip, Scan, Spokes, Sweep, take
from . import gaps, headings, placing, scans
from .extraction import Extraction, Memory
from .found import Found

AT_ONCE = 256  # spokes; longer sweeps are taken in parts, so that memory has a bound


class ChainMemory(NamedTuple):
    """All that is known between two sweeps."""

    placing: placing.Placing
    extraction: Memory
    gathering: scans.Gathering
    gaps: gaps.Gaps


class Step(NamedTuple):
    """What a sweep came to: its spokes in place; what was found, in order; the scans that became
    whole; counts of what was wrong or left out, by reason."""

    placed: list[Spokes]
    found: list[Found]
    scans: list[Scan]
    counts: Counter[str]


class Chain:
    """The way from sweeps to scans, by parameters; without a state of its own.

    width  rad of a scan
    """

    def __init__(self, parameters: VideoParameters, width: float = 2 * math.pi) -> None:
        self.extraction, self.width = Extraction(parameters), width

    def start(self) -> ChainMemory:
        """No spokes yet."""
        return ChainMemory(placing.start(), self.extraction.start(), scans.start(), gaps.start())

    def step(
        self, memory: ChainMemory, sweep: Sweep, own_ship: OwnShip
    ) -> tuple[ChainMemory, Step]:
        """One sweep of any number of spokes. own_ship covers it, and the scan that it ends."""
        done = Step([], [], [], Counter())
        own_ship = _with_heading(own_ship, memory.placing.headings)
        for first in range(0, max(len(sweep.time), 1), AT_ONCE):
            part = take(sweep, slice(first, first + AT_ONCE))
            placed, spokes, counts = placing.place(memory.placing, part, own_ship)
            memory = memory._replace(placing=placed)
            done.counts.update(counts)
            if len(spokes.time):
                done.placed.append(spokes)
                seen = gaps.follow(memory.gaps, self.extraction.seen(spokes), self.extraction.beam)
                memory = memory._replace(gaps=seen)
                extraction, found = self.extraction.step(memory.extraction, spokes)
                memory = memory._replace(extraction=extraction)
                memory = self._gather(memory, found, own_ship, done)
        return memory, done

    def end(self, memory: ChainMemory, own_ship: OwnShip) -> tuple[ChainMemory, Step]:
        """No sweep follows: what is left comes out."""
        done = Step([], [], [], Counter())
        extraction, found = self.extraction.end(memory.extraction)
        memory = self._gather(memory._replace(extraction=extraction), found, own_ship, done)
        memory = self._whole(memory, scans.rest(memory.gathering, own_ship), done)
        return memory._replace(gathering=scans.start()), done

    def _gather(self, memory, found: Found, own_ship: OwnShip, done: Step) -> ChainMemory:
        done.found.append(found)
        done.counts.update(found.counts)
        gathering, whole = scans.gather(memory.gathering, found, own_ship, self.width)
        return self._whole(memory._replace(gathering=gathering), whole, done)

    def _whole(self, memory: ChainMemory, whole: list[Scan], done: Step) -> ChainMemory:
        """The scans come out, with the gaps in each."""
        for scan in whole:
            left, inside = gaps.taken(memory.gaps, scan.end)
            memory = memory._replace(gaps=left)
            done.scans.append(scan._replace(unswept=inside))
        return memory


def _with_heading(own_ship: OwnShip, told: headings.Log) -> OwnShip:
    """Own ship with the heading that the radar told, where she has no other."""
    if own_ship.heading is not None or not len(told.heading):
        return own_ship
    heading = wrap_bearing(np.full(len(own_ship.time), told.heading[-1]))
    return own_ship._replace(heading=heading)


def run(
    chain: Chain,
    sweeps: Iterable[Sweep],
    own_ship_between: Callable[[float, float], OwnShip],
    tell: Callable[[Counter[str]], None] = lambda counts: None,
) -> Iterator[Scan]:
    """The scans of sweeps; tell(counts) is called with what was wrong or left out, at the end.

    own_ship_between(start, end)  own ship's samples for that time, s
    """
    memory = chain.start()
    counts: Counter[str] = Counter()
    last = own_ship_between(-np.inf, -np.inf)
    for sweep in sweeps:
        since = memory.gathering.start
        times = sweep.time[np.isfinite(sweep.time)]
        if len(times):
            begin = min(since, times.min()) if np.isfinite(since) else times.min()
            last = own_ship_between(float(begin), float(times.max()))
        memory, done = chain.step(memory, sweep, last)
        counts.update(done.counts)
        yield from done.scans
    memory, done = chain.end(memory, last)
    counts.update(done.counts)
    yield from done.scans
    tell(counts)
