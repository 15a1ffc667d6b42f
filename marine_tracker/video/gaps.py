"""Where no spoke came: those directions were not swept, so that no track counts a miss there."""

import math
from typing import NamedTuple

import numpy as np

from ..geometry import wrap_bearing
from ..types import Array, Spokes

SPOKES = 4.5  # usual steps from spoke to spoke; more is a gap, where a beam is narrower than that


class Gaps(NamedTuple):
    """Gaps that are in no scan yet.

    time, bearing  s, rad, of the last spoke; nan: none yet
    spacing        rad, usual step; nan: not known
    found          [G, 4]  s when a gap began and ended; rad where, and how far clockwise
    """

    time: float
    bearing: float
    spacing: float
    found: Array


def start() -> Gaps:
    """No spoke yet."""
    return Gaps(math.nan, math.nan, math.nan, np.zeros((0, 4)))


def follow(known: Gaps, spokes: Spokes, beam: float) -> Gaps:
    """The gaps before and between the spokes that have a bearing; beam rad."""
    there = np.isfinite(spokes.bearing)
    if not there.any():
        return known
    time = np.append(known.time, spokes.time[there])
    bearing = np.append(known.bearing, spokes.bearing[there])
    with np.errstate(invalid='ignore'):
        turn = wrap_bearing(np.diff(bearing))
    forward = turn[turn < math.pi]
    spacing = float(np.median(forward)) if len(forward) >= 8 else known.spacing
    least = max(beam, SPOKES * spacing) if spacing == spacing else beam
    # More than the rest of a turn is a spoke that goes back a little: a heading that was corrected.
    wide = np.flatnonzero((turn > least) & (turn < 2 * math.pi - beam))
    # At its edges an echo is cut off.
    edge = wrap_bearing(bearing[wide] - 0.5 * beam)
    new = np.stack([time[wide], time[wide + 1], edge, turn[wide] + beam], 1)
    return Gaps(float(time[-1]), float(bearing[-1]), spacing, np.concatenate([known.found, new]))


def taken(known: Gaps, end: float) -> tuple[Gaps, Array | None]:
    """The gaps [G, 2] of a scan that ends at `end` s: where they begin, rad, and how wide they are;
    None: none. What goes on after it stays for the next scan."""
    found = known.found
    began = found[:, 0] < end
    if not began.any():
        return known, None
    first, last, bearing, angle = found[began].T
    share = np.clip((end - first) / np.maximum(last - first, 1e-9), 0.0, 1.0)
    inside = np.stack([bearing, share * angle], 1)
    over = share < 1.0
    rest = np.stack([0 * first + end, last, wrap_bearing(bearing + share * angle)], 1)
    rest = np.concatenate([rest, ((1 - share) * angle)[:, None]], 1)[over]
    return known._replace(found=np.concatenate([rest, found[~began]])), inside
