"""Why there is no target at a place: all that the tracker knows of it, in words.

A pure function of the memories and of what the last scans came to. It runs only when somebody asks.
A reason *decides* if it alone keeps a target away; the others tell what is known there.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from ..extent.land_map import LandMap, on_land
from ..geometry import NAUTICAL_MILE
from ..tracking import land_mask
from ..tracking.history import hits
from ..tracking.lifecycle import LOST, REASONS, STATIONARY, TENTATIVE
from ..tracking.tracker import Tracker, TrackerMemory
from ..types import Array
from . import zones
from .acquisition import NOWHERE, ZONES
from .arpa import Arpa, ArpaMemory
from .cpa import OwnMotion
from .explain_plots import (
    SIGMAS,
    Place,
    Reason,
    Seen,
    antenna,
    clutter,
    newest_of,
    of_radar,
    plots_seen,
    reach_of,
)
from .targets import label


def explain(
    position: Array,
    tracker: Tracker,
    arpa: Arpa,
    memory: TrackerMemory,
    known: ArpaMemory,
    land: LandMap | None,
    recent: Sequence[Seen],
    silent: float = 0.0,
) -> list[Reason]:
    """The reasons why there is no target at a position [2] m in `map`, the deciding ones first.

    land    where land lies, with extents; else None
    recent  the last scans, the newest last; of each radar the last SCANS are used
    silent  s that no scan has come for, once the next of every radar is overdue
    """
    if not recent:
        return [Reason('scans', 'no scan has come yet: nothing is known', True)]
    newest = newest_of(recent)
    there = Place(position, reach_of(position, tracker, newest))
    reasons = [
        *_silence(silent),
        *_ranges(there, tracker, arpa, newest),
        *_zones(there, arpa, newest[-1].own),
        *_land(there, land, tracker),
        *_tracks(there, tracker, arpa, memory, known, newest[-1]),
        *_lost(there, recent),
        *plots_seen(there, tracker, arpa, memory, recent),
        *clutter(there, tracker, arpa, memory, newest),
        *_capacity(tracker, arpa, memory, known),
    ]
    return sorted(reasons, key=lambda reason: not reason.decides)


def _silence(silent: float) -> Iterator[Reason]:
    if silent:
        yield Reason('scans', f'no scan has come for {silent:.0f} s: this is as it was then', True)


# -- where the radar sees ------------------------------------------------------------------------


def _ranges(there: Place, tracker: Tracker, arpa: Arpa, newest: Sequence[Seen]) -> Iterator[Reason]:
    found = []
    for seen in newest:
        radar = seen.scan.radar
        p = tracker.radars[radar]
        away, name = float(np.hypot(*(there.position - antenna(seen.scan)))), of_radar(arpa, radar)
        if away < p.min_range_m:
            found.append(
                f'{away:.0f} m from the antenna{name}: inside the blind range of '
                f'{p.min_range_m:.0f} m (min_range_m)'
            )
        elif away > p.max_range_m:
            found.append(
                f'{away / NAUTICAL_MILE:.2f} NM from the antenna{name}: beyond the range of '
                f'{p.max_range_m / NAUTICAL_MILE:.2f} NM (max_range_m)'
            )
    for text in found:
        yield Reason('range', text, len(found) == len(arpa.radars))


def _zones(there: Place, arpa: Arpa, own: OwnMotion) -> Iterator[Reason]:
    inside = zones.inside(arpa.zones, there.position[None], own.position, own.heading)[0]
    for name, here, guard in zip(arpa.zones.name, inside, arpa.zones.guard):
        if here and not guard:
            yield Reason(
                'exclusion zone', f'in the exclusion zone {name}: nothing is acquired', True
            )
    automatic = arpa.acquisition.automatic
    if automatic == NOWHERE:
        yield Reason('acquisition', 'acquisition is by hand only (acquisition: nowhere)', True)
    elif automatic == ZONES and not (inside & arpa.zones.guard).any():
        yield Reason('acquisition', 'outside of all guard zones (acquisition: zones)', True)


def _land(there: Place, land: LandMap | None, tracker: Tracker) -> Iterator[Reason]:
    if land_mask.on_land(tracker.land, there.position[None])[0]:
        yield Reason('land', 'on land by the file land_mask: no track begins here', True)
    if land is not None and on_land(land, there.position[None])[0]:
        yield Reason(
            'land', 'on the map of land: a piece of echo longer than any ship, and it stays', True
        )


# -- what is tracked there -----------------------------------------------------------------------


def _tracks(
    there: Place,
    tracker: Tracker,
    arpa: Arpa,
    memory: TrackerMemory,
    known: ArpaMemory,
    newest: Seen,
) -> Iterator[Reason]:
    tracks = memory.tracks
    now = tracker.extrapolate(tracks, newest.scan.end)
    spread = np.sqrt(np.trace(now.covariance[:, :2, :2], axis1=1, axis2=2))
    away = np.hypot(*(now.position - there.position).T)
    targets, barred = known.acquisition.targets.id, known.acquisition.barred
    for row in np.argsort(away):
        if away[row] > there.reach + SIGMAS * spread[row]:
            continue
        (name,) = label(tracks.id[row : row + 1], tracks.number[row : row + 1])
        where = f'{name}, {away[row]:.0f} m from here'
        if tracks.id[row] in targets:
            yield Reason('target', f'there is a target: {where}', True)
        elif tracks.status[row] == STATIONARY:
            text = f'plots always come from here: shown as a place, {where} (stationary_places)'
            yield Reason('place', text, True)
        elif tracks.status[row] == TENTATIVE:
            yield _tentative(where, tracker, memory, int(row))
        elif tracks.id[row] in barred.id:
            cancelled = barred.cancelled[barred.id == tracks.id[row]][0]
            why = 'was cancelled by hand' if cancelled else 'was in an exclusion zone'
            yield Reason('barred', f'the track {where}, {why}: acquire it by a click', True)
        elif known.acquisition.waiting:
            limit = arpa.acquisition.capacity
            text = f'the track {where}, waits: {limit} targets are the most (max_targets)'
            yield Reason('capacity', text, True)
        else:
            yield Reason('track', f'a track is here, but no target: {where}')


def _tentative(where: str, tracker: Tracker, memory: TrackerMemory, row: int) -> Reason:
    p, tracks = tracker.parameters, memory.tracks
    window = min(int(tracks.age[row]), p.confirm_scans)
    had = int(hits(tracks.history[row : row + 1], p.confirm_scans)[0])
    text = f'a track is being built: {where}; {had} plots in its last {window} scans'
    missing = []
    if had < p.confirm_hits:
        missing.append(f'{p.confirm_hits} in {p.confirm_scans} are needed')
    if tracks.existence[row] < p.confirm_existence:
        missing.append(
            f'it is a target with probability {tracks.existence[row]:.3g}, '
            f'{p.confirm_existence:g} is needed'
        )
    return Reason('tentative', '; '.join([text, *missing]), True)


def _lost(there: Place, recent: Sequence[Seen]) -> Iterator[Reason]:
    now = recent[-1].scan.end
    for seen in reversed(recent):
        tracks = seen.report.tracks
        near = np.hypot(*(seen.position - there.position).T) <= there.reach
        for row in ((tracks.status == LOST) & (tracks.number > 0) & near).nonzero()[0]:
            (name,) = label(tracks.id[row : row + 1], tracks.number[row : row + 1])
            why = REASONS[seen.report.reason[row]]
            yield Reason(
                'lost', f'{name} was lost here {now - seen.scan.end:.0f} s ago: {why}', True
            )


def _capacity(
    tracker: Tracker, arpa: Arpa, memory: TrackerMemory, known: ArpaMemory
) -> Iterator[Reason]:
    tracks, most = len(memory.tracks.id), tracker.parameters.max_tracks
    if tracks >= most:
        yield Reason('capacity', f'{tracks} tracks are held: no more begin (max_tracks)', True)
    held, limit = len(known.acquisition.targets.id), arpa.acquisition.capacity
    if held >= limit:
        yield Reason('capacity', f'{held} targets are held, the most there may be (max_targets)')
