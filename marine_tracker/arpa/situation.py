"""What acquisition and alarms look at: each track, how near it comes, its danger, its zones."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import NAUTICAL_MILE
from ..types import Array, Tracks
from .cpa import Approach, OwnMotion
from .zones import Zones, inside

SAFE, NEARLY, DANGEROUS = range(3)
DANGERS = ('safe', 'nearly', 'dangerous')
WIDER = 1.1  # the limits that a danger must leave to be over, of the limits
LIKELY, UNLIKELY = 0.5, 0.25  # probabilities of danger that raise it, and that let it end


class Limits(NamedTuple):
    """What is dangerous, the same for every target: CPA m and TCPA s below which it is."""

    cpa: float = 0.5 * NAUTICAL_MILE
    tcpa: float = 720.0


class Situation(NamedTuple):
    """The tracks of a scan at one moment, lost ones included; one row a track.

    id, number, status  [N]     as in the report's tracks
    reason              [N]     why a lost one was lost (lifecycle.MISSED ...)
    position            [N, 2]  m; of a lost one the last
    range, bearing      [N]     m, rad true, from own ship; nan where north is not known
    cpa, tcpa           [N]     m, s
    probability         [N]     of danger
    nearest             [N]     m, least distance to own ship from now until the TCPA limit
    danger              [N]     SAFE, NEARLY or DANGEROUS
    inside              [N, Z]  in which zones it lies
    guarded, excluded   [N]     lies in a guard zone, in an exclusion zone; in both is excluded
    """

    id: NDArray[np.int64]
    number: NDArray[np.int64]
    status: NDArray[np.int8]
    reason: NDArray[np.int8]
    position: Array
    range: Array
    bearing: Array
    cpa: Array
    tcpa: Array
    probability: Array
    nearest: Array
    danger: NDArray[np.int8]
    inside: NDArray[np.bool_]
    guarded: NDArray[np.bool_]
    excluded: NDArray[np.bool_]


def look(
    tracks: Tracks,
    reason,
    position,
    approach: Approach,
    at_rest,
    zones: Zones,
    own: OwnMotion,
    limits: Limits,
) -> Situation:
    """The situation of the N tracks of a tracker's report, which has their `reason` [N] too.

    position [N, 2] m and approach (N rows) are theirs, now; at_rest [N]: neither the target nor
    own ship makes way (see `danger`).
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
        danger(approach, at_rest, limits),
        mask,
        np.any(mask & zones.guard, axis=1) & ~excluded,
        excluded,
    )


def nearest(approach: Approach, within: float) -> Array:
    """Least distance [N] m to own ship in the next `within` s; the range where TCPA is unknown.

    CPA where the TCPA comes within that time, the range now where it is past: one number in which
    dangerous targets come first, then those that close, then those that go.
    """
    left = approach.tcpa - np.clip(approach.tcpa, 0.0, within)
    distance = np.hypot(approach.cpa, approach.relative_speed * left)
    return np.where(np.isfinite(distance), distance, approach.range)


def danger(approach: Approach, at_rest, limits: Limits) -> NDArray[np.int8]:
    """How dangerous [N] each target is; at_rest [N] bool.

    DANGEROUS: CPA < limit and 0 <= TCPA < limit, as the standards have it, or the probability of
    that is at least LIKELY, whatever the values themselves. NEARLY, not enough to raise an alarm
    but to keep one: the same with limits WIDER times, or a probability of at least UNLIKELY.
    SAFE: the rest, and those at rest while own ship is at rest: they meet by noise only. A
    target whose TCPA is unknown (nan) is judged by the probability.
    """

    def within(share):
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
    return np.where(at_rest, SAFE, level).astype(np.int8)
