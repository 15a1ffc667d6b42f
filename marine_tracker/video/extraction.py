"""From spokes to plots.

    extraction = Extraction(VideoParameters(beam_width_deg=1.2))
    memory = extraction.start()
    for spokes in sectors:
        memory, found = extraction.step(memory, spokes)
        ... found.plots ...

A sector is any number of spokes. A plot comes out as soon as its echo has ended and the level
behind it is known, some three beam widths after the beam has passed. Memory goes in and comes out.
"""

import math
from typing import NamedTuple

import numpy as np

from ..geometry import heading_at, wrap_bearing
from ..parameters import VideoParameters
from ..parameters.video import blanks
from ..types import Spokes
from . import detection, level, measure, pieces, plots, stack, tail
from .found import LONE, NO_BEARING, Found, nothing, together
from .stack import Stack

LONGEST_OPEN = math.radians(12.0)  # what is wider comes out in parts


class Memory(NamedTuple):
    """stack of the newest spokes, None before the first; tail of the noise; full scale."""

    stack: Stack | None
    tail: tail.Tail
    full: int


class Extraction:
    """Extraction by parameters; without a state of its own."""

    def __init__(self, parameters: VideoParameters) -> None:
        self.parameters = parameters
        self.beam = math.radians(parameters.beam_width_deg)
        self.blanks = blanks(parameters.blank_sectors)

    def start(self) -> Memory:
        """No spokes yet."""
        return Memory(None, tail.start(1), stack.FULL[0])

    def step(self, memory: Memory, spokes: Spokes) -> tuple[Memory, Found]:
        """One sector."""
        parts = [nothing()]
        missing = int(np.isnan(spokes.bearing).sum())
        full = stack.full_scale(spokes.strength, memory.full)
        if full != memory.full:
            memory = memory._replace(full=full, tail=tail.start(len(memory.tail.texture)))
        for run in stack.runs(self.seen(spokes)):
            if memory.stack is not None and not stack.follows(memory.stack, run):
                memory, found = self.end(memory)
                parts.append(found)
            held = memory.stack
            held = stack.begun(run) if held is None else stack.longer(held, run)
            memory, found = self._decide(memory._replace(stack=held), False)
            parts.append(found)
        found = together(parts)
        if missing:
            found.counts[NO_BEARING] = missing
        return memory, found

    def end(self, memory: Memory) -> tuple[Memory, Found]:
        """No spoke follows for now: all plots that are still to come."""
        if memory.stack is None:
            return memory, nothing()
        memory, found = self._decide(memory, True)
        return memory._replace(stack=None), found

    def seen(self, spokes: Spokes) -> Spokes:
        """The spokes without bearings in blank sectors."""
        if not self.blanks:
            return spokes
        angle = wrap_bearing(spokes.bearing - heading_at(spokes.own_ship, spokes.time))
        hidden = np.zeros(len(angle), bool)
        for first, last in self.blanks:
            hidden |= wrap_bearing(angle - first) <= wrap_bearing(last - first)
        return spokes._replace(bearing=np.where(hidden, np.nan, spokes.bearing))

    def _decide(self, memory: Memory, final: bool) -> tuple[Memory, Found]:
        """Decides on all blocks whose surroundings are known, and measures what has ended."""
        assert memory.stack is not None
        parameters = self.parameters
        held = stack.measured(memory.stack, self.beam, parameters.pulse_length_m, final)
        memory = memory._replace(stack=held)
        ring = level.GUARD_BLOCKS + level.RING_BLOCKS
        begin, end = len(held.noise), len(held.mean) - (0 if final else ring)
        if end <= begin and not final:
            return memory, nothing()
        blind = int(parameters.blind_range_m / held.range_step)
        held, known, limits, lone = detection.decide(
            held, max(end, begin), memory.tail, memory.full, parameters.false_alarm_rate, blind
        )
        memory = memory._replace(tail=known)
        held, found = self._close(held, limits, memory.full, final)
        if lone:
            found.counts[LONE] = lone
        return memory._replace(stack=held), found

    def _close(
        self, held: Stack, limits: tail.Thresholds, full: int, final: bool
    ) -> tuple[Stack, Found]:
        """The plots of all components that have ended, and the stack without them."""
        rows = held.grid.rows
        decided = min(len(held.noise) * rows, len(held.time))
        labels = pieces.label(held.hits[:decided], held.lobe)
        row, sample = np.divmod(np.flatnonzero(held.hits[:decided]), held.hits.shape[1])
        component = labels[row, sample] - 1
        count = int(labels.max(initial=0))
        first, last = np.full(count, decided), np.full(count, -1)
        np.minimum.at(first, component, row)
        np.maximum.at(last, component, row)
        limit = max(round(LONGEST_OPEN / held.spacing), 4 * rows)
        # Side lobes are looked for in spokes that have come, decided or not.
        beside = round(plots.LOBES / held.spacing)
        over = (last < decided - held.lobe.gap - 1) & (last < len(held.time) - beside)
        # A ship near by may fill a wide angle, but not more than its size allows.
        over |= first < decided - limit
        over |= final
        going = ~over
        until = int(first[going].min(initial=decided))
        out = over[component]
        found = nothing()
        if out.any():
            number = np.cumsum(over) - 1
            found = plots.measured(
                held, row[out], sample[out], number[component[out]], limits, full, self.parameters
            )
            held.hits[row[out], sample[out]] = False
        passed = min(until, decided - 1)
        if passed >= 0 and len(held.time):
            found = found._replace(
                until=(float(held.time[passed]), float(wrap_bearing(held.bearing[passed])))
            )
        margin = math.ceil(measure.AROUND[0] * held.lobe.shape[0]) + 1
        return stack.trimmed(held, until - max(margin, beside)), found
