"""One comparison of clocks: whether stamps that jump ahead tell of silence, or are wrong.

A radar on standby, a stopped process or a cut network ends in a jump of the stamps, and so does a
clock that is set, or one wrong stamp. What tells them apart is another clock: time.monotonic and
its like, or the simulated time of ROS, by which an input arrives.
"""

import math
import time
from typing import NamedTuple

BEATS, ENOUGH = 10, 6  # arrivals that are remembered; so many tell whether two clocks agree
RATE = 0.1  # two clocks agree whose rates differ by less than this share

# Linux counts sleep of the machine by this clock only; radars and other machines go on meanwhile.
_STEADY = getattr(time, 'CLOCK_BOOTTIME', time.CLOCK_MONOTONIC)


def steady() -> float:
    """s of a clock that nobody sets."""
    return time.clock_gettime(_STEADY)


class Beat(NamedTuple):
    """Inputs of one kind that were taken lately, the last at the end.

    stamps    s, as the sender has them
    arrivals  s, when they came, by a clock of ours; nan where there is none
    """

    stamps: tuple[float, ...] = ()
    arrivals: tuple[float, ...] = ()

    def then(self, stamp: float, arrival: float) -> 'Beat':
        """With one more."""
        return Beat((*self.stamps, stamp)[-BEATS:], (*self.arrivals, arrival)[-BEATS:])

    def waited(self, arrival: float) -> float:
        """s of our clock since the last one came; nan where it is not known."""
        return max(arrival - self.arrivals[-1], 0.0) if self.arrivals else math.nan

    @property
    def step(self) -> float:
        """s, the usual step of the stamps; 0 before there is one."""
        steps = sorted(b - a for a, b in zip(self.stamps, self.stamps[1:]))
        return steps[len(steps) // 2] if steps else 0.0

    @property
    def in_time(self) -> bool:
        """Whether the stamps surely go as fast as our clock: not so where a recording is played
        faster, or before enough inputs have come."""
        if len(self.stamps) < ENOUGH:
            return False
        ours = self.arrivals[-1] - self.arrivals[0]
        theirs = self.stamps[-1] - self.stamps[0]
        return abs(theirs - ours) < RATE * theirs  # False with nan


def paired(apart: float, bound: float) -> tuple[float, bool]:
    """s between two inputs, and whether their stamps could tell it.

    apart  s, by the stamps; farther apart than `bound` s they are of different clocks or unset, and
           the two count as simultaneous: each is paired with what had arrived when it came
    """
    return (apart, True) if abs(apart) <= bound else (0.0, False)
