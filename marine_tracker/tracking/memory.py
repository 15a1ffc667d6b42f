"""What the tracker remembers between two scans, and what it reports of one."""

from typing import Any, NamedTuple

from ..types import Array, BoolArray, CodeArray, IntArray, Plots, Scan, Tracks
from . import at_rest, meetings, offsets, sectors, surroundings


class OfRadar(NamedTuple):
    """The memory of one radar.

    leftover  plots of its last scan that belong to no track: one may be a new target's first plot
    known     of its false plots, and of how targets show
    offsets   of its ranges and bearings, and the lag of its plots
    waiting   what its sectors left undecided; None: whole revolutions
    """

    leftover: Plots
    known: surroundings.Surroundings
    offsets: offsets.Offsets
    waiting: sectors.Waiting | None = None


class TrackerMemory(NamedTuple):
    """The memory of the tracker between two scans.

    tracks       N tracks, without lost ones
    radars       memory of each radar
    origin       [2] m, own ship's last known position
    next_id      the next track's id
    next_number  the next confirmed track's target number
    ground       places where plots always are
    meetings   tracks that have met
    """

    tracks: Tracks
    radars: tuple[OfRadar, ...]
    origin: Array
    next_id: int
    next_number: int
    ground: at_rest.Ground
    meetings: meetings.Meetings


class Report(NamedTuple):
    """The results of one scan; one row a track that was swept, including lost ones and new ones.

    time       [N]     s, when the beam passed the track (the time of its plot if it had one); or
    the
                       time of its last plot, if another radar's was later
    tracks     N rows, after the scan
    predicted  [N, 2]  m, where the track was expected at `time`; nan for a new track
    plot       [N]     row of the scan's plots that the track took, -1 for none
    reason     [N]     why a LOST track was lost: index into lifecycle.REASONS, 0 = not lost
    begun      [B]     the first plots, of the last scan, of the new tracks: the last B
    scan       whose plots `plot` refers to: of a sector those that were decided in it
    places     where plots always are, as they are to be shown
    meetings tracks that have met, by id
    """

    time: Array
    tracks: Tracks
    predicted: Array
    plot: IntArray
    reason: CodeArray
    begun: Plots
    left_out: int
    scan: Scan
    places: at_rest.Shown
    meetings: meetings.Meetings


class Left(NamedTuple):
    """What a scan left: mask [M] of the plots that are lone; and what is learnt from it."""

    free: BoolArray
    found: sectors.Found


def changed(memory: TrackerMemory, radar: int, **changes: Any) -> TrackerMemory:
    """The memory with changes in that of one radar."""
    radars = list(memory.radars)
    radars[radar] = radars[radar]._replace(**changes)
    return memory._replace(radars=tuple(radars))
