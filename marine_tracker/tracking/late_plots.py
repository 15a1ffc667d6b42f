"""Takes plots of several radars in the order of their times.

A scan arrives when its revolution ends. Later plots of another radar may have been taken before. So
each track keeps its last few updates. A late plot is put in its place: later updates are undone,
the plot is taken, and they are repeated. Estimators only step forward in time, nothing waits, and
the state is that of all plots sorted by time. The association is not repeated. For a plot older
than all kept updates, the estimator must step back in time, as its contract allows.
"""

from typing import Any, NamedTuple

import numpy as np

from ..estimators import Estimator
from ..estimators.contract import State
from ..types import Array, IntArray, Plots, Tracks, put, take, where


class Update(NamedTuple):
    """One update of each track, N rows: the state before it, and the plot. The plot's time is -inf
    if there was no update yet.
    """

    state: Any
    plots: Plots


def nothing_yet(state: State, plots: Plots, updates: int) -> tuple[Update, ...]:
    """The memory of N new tracks: `updates` empty updates; any N plots."""
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
    """The tracks after one plot of the radar for each of the rows [K], in the order of their times.

    A radial speed counts when the plot comes in, not when it is repeated, because not all radars
    measure one.
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
    for k in reversed(range(len(past))):  # repeat what was undone, oldest first
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
