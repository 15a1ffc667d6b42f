"""The input of acquisition and alarms: each track, its approach, its danger, its zones."""

from typing import NamedTuple

import numpy as np

from ..geometry import NAUTICAL_MILE
from ..types import Array, BoolArray, CodeArray, IntArray, Tracks
from .cpa import Approach, OwnMotion
from .zones import Zones, inside

SAFE, NEARLY, DANGEROUS = range(3)
DANGERS = ('safe', 'nearly', 'dangerous')
WIDER = 1.1  # factor of the limits that a danger must leave to end
LIKELY, UNLIKELY = 0.5, 0.25  # probabilities of danger: raises one, lets one end


class Limits(NamedTuple):
    """The limits of danger, the same for every target: CPA below m and TCPA below s."""

    cpa: float = 0.5 * NAUTICAL_MILE
    tcpa: float = 720.0


class Situation(NamedTuple):
    """The tracks of a scan at one moment, including lost ones; one row a track.

    id, number, status  [N]     as in the report's tracks
    reason              [N]     why a lost one was lost (lifecycle.MISSED ...)
    position            [N, 2]  m; of a lost one the last
    range, bearing      [N]     m, rad true, from own ship; nan where north is not known
    cpa, tcpa           [N]     m, s
    probability         [N]     of danger
    nearest             [N]     m, least distance to own ship from now until the TCPA limit
    danger              [N]     SAFE, NEARLY or DANGEROUS
    inside              [N, Z]  zones in which it lies
    guarded, excluded   [N]     in a guard zone, in an exclusion zone; if in both, it is excluded
    harmless            [N]     as given to `look`
    cpa_sigma, tcpa_sigma  [N]  m, s, deviations of CPA and TCPA
    """

    id: IntArray
    number: IntArray
    status: CodeArray
    reason: CodeArray
    position: Array
    range: Array
    bearing: Array
    cpa: Array
    tcpa: Array
    probability: Array
    nearest: Array
    danger: CodeArray
    inside: BoolArray
    guarded: BoolArray
    excluded: BoolArray
    harmless: BoolArray
    cpa_sigma: Array
    tcpa_sigma: Array


def look(
    tracks: Tracks,
    reason: CodeArray,
    position: Array,
    approach: Approach,
    harmless: BoolArray,
    zones: Zones,
    own: OwnMotion,
    limits: Limits,
) -> Situation:
    """The situation of the N tracks of a tracker's report, with their `reason` [N].

    position [N, 2] m and approach (N rows) are theirs, now; harmless [N]: own ship is at anchor and
    the target does not certainly come nearer (see `danger`).
    """
    mask = inside(zones, position, own.position, own.heading)
    excluded = np.any(mask & ~zones.guard, axis=1)
    return Situation(
        tracks.id,
        tracks.number,
        tracks.status,
        reason,
        position,
        approach.range,
        approach.bearing if own.north else np.full_like(approach.bearing, np.nan),
        approach.cpa,
        approach.tcpa,
        approach.danger_probability,
        nearest(approach, limits.tcpa),
        danger(approach, harmless, limits),
        mask,
        np.any(mask & zones.guard, axis=1) & ~excluded,
        excluded,
        harmless,
        approach.cpa_sigma,
        approach.tcpa_sigma,
    )


def nearest(approach: Approach, within: float) -> Array:
    """Least distance [N] m to own ship in the next `within` s; the range if TCPA is unknown.

    It is the CPA if the TCPA comes within that time, and the present range if the TCPA is past.
    Sorting by it gives dangerous targets first, then those that approach, then those that move
    away.
    """
    left = approach.tcpa - np.clip(approach.tcpa, 0.0, within)
    distance = np.hypot(approach.cpa, approach.relative_speed * left)
    return np.where(np.isfinite(distance), distance, approach.range)


def danger(approach: Approach, harmless: BoolArray, limits: Limits) -> CodeArray:
    """How dangerous [N] each target is; harmless [N] bool.

    DANGEROUS: CPA < limit and 0 <= TCPA < limit, as in the standards; or the probability of that is
    at least LIKELY. NEARLY: the same with limits WIDER times as large, or a probability of at least
    UNLIKELY. It does not raise an alarm, but it keeps one. SAFE: all others, and the harmless ones,
    which only noise brings near an anchored own ship. If the TCPA is unknown (nan), only the
    probability counts.
    """

    def within(share: float) -> BoolArray:
        return (
            (approach.cpa < share * limits.cpa)
            & (approach.tcpa >= 0)
            & (approach.tcpa < share * limits.tcpa)
        )

    probability = approach.danger_probability
    level = np.where(
        within(1.0) | (probability >= LIKELY),
        DANGEROUS,
        np.where(within(WIDER) | (probability >= UNLIKELY), NEARLY, SAFE),
    )
    return np.where(harmless, SAFE, level).astype(np.int8)
