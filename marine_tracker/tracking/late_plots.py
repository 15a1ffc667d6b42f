"""Plots of several radars taken in the order of their times.

A scan is known when its revolution ends; by then another radar's later plots may have been taken
already. So each track remembers its last few updates. A plot that is late is put in its place:
later updates are undone, it is taken, and they are taken again. Estimators see time go forward
only, nothing waits, and the outcome is that of all plots sorted by time (for association it is
not: what was decided stands). A plot older than all that is remembered meets an estimator that
must step back in time, as its contract allows.
"""

from typing import Any, NamedTuple

import numpy as np

from ..estimators import Estimator
from ..estimators.contract import State
from ..types import Array, IntArray, Plots, Tracks, put, take, where


class Update(NamedTuple):
    """One update of each track, N rows: the state before it and the plot; its time is -inf where
    there was none yet."""

    state: Any
    plots: Plots


def nothing_yet(state: State, plots: Plots, updates: int) -> tuple[Update, ...]:
    """What N tracks remember: so many updates, none of which has been; any N plots."""
    none = plots._replace(time=np.full(len(plots.time), -np.inf), radial_speed=None)
    return (Update(state, none),) * updates


def as_of(tracks: Tracks, time: Array) -> State:
    """The state as it was at the times [N] s: later updates are undone."""
    state = tracks.state
    for update in tracks.past:  # the last comes first
        state = where(update.plots.time > time, update.state, state)
    return state


def update(
    estimator: Estimator, tracks: Tracks, plots: Plots, rows: IntArray, radar: int
) -> Tracks:
    """The tracks after one plot of the radar for each of the rows [K], wherever it belongs.

    A radial speed counts when the plot comes in, not when it is taken again: not all radars
    tell one.
    """
    last_time = tracks.last_time.copy()
    last_time[rows] = np.maximum(last_time[rows], plots.time)
    tracks = tracks._replace(last_time=last_time)
    if not tracks.past:
        return tracks._replace(state=estimator.update(tracks.state, plots, rows))
    here = take(tracks, rows)
    every = np.arange(len(rows))
    before = as_of(here, plots.time)
    after, past = estimator.update(before, plots, every), list(here.past)
    for k in reversed(range(len(past))):  # again what was undone, oldest first
        later = (past[k].plots.time > plots.time).nonzero()[0]
        past[k] = past[k]._replace(state=put(past[k].state, later, take(after, later)))
        after = estimator.update(after, take(past[k].plots, later), later)
    place = sum(((u.plots.time > plots.time).astype(int) for u in past), np.zeros(len(rows), int))
    new, shifted = Update(before, plots._replace(radial_speed=None)), []
    for k, held in enumerate(past):
        moved = where(place == k, new, past[k - 1]) if k else new
        shifted.append(where(place > k, held, moved))
    return put(
        tracks,
        rows,
        here._replace(state=after, past=tuple(shifted), radar=np.full(len(rows), radar, np.int8)),
    )
