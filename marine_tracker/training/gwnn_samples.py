"""Training samples of `gwnn`: the inputs of the network on simulated tracks, and the truth.

Samples come from the same functions that the estimator runs (`gwnn.advance`, `inputs.inputs`,
`gwnn.look`), so training and use always agree. A sample holds the inputs after a plot, and the
target's place at that moment or at a later scan.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..estimators.gwnn import bank as filters
from ..estimators.gwnn import gwnn, inputs, monitor
from ..gaussian import linear_modes
from ..types import Array, BoolArray, IntArray, put, take
from . import ship_tracks, training_tracks

SCANS = 110
CHUNK = 660  # tracks made at once, the same number of each kind
EXPECTED, KNOWN = 0.22, 0.10  # share of the rows sampled in a scan: before the plot, after it
CLIP = 30.0  # sigma: largest distance of the truth from the base


class Samples(NamedTuple):
    """n samples, float32.

    seen      [n, I]      the network's inputs
    apart     [n, 13, 4]  experts relative to the base at the sample's time
    base      [n, 4]      log weights of the base's modes at that time
    scans     [n]         from the last plot to that time
    truth     [n, 4]      relative to the base
    spread    [n, 4]      log variances of the base
    area      [n]         m^2, mean stated variance of the plots' coordinates
    cell      [n]         kind, phase, after or before a plot, sort of radar: `Cell` as one number
    truly     [n]         true deviation of the plots over the stated one
    """

    seen: Array
    apart: Array
    base: Array
    scans: Array
    truth: Array
    spread: Array
    area: Array
    cell: IntArray
    truly: Array


class Cell(NamedTuple):
    """The class of a sample, [n] each. Its number in `Samples.cell` counts all combinations.

    kind of motion; phase 1 in a manoeuvre; after 1 if the plot was known; sort of radar.
    """

    kind: NDArray[np.int64]
    phase: NDArray[np.int64]
    after: NDArray[np.int64]
    sort: NDArray[np.int64]


def cell_number(
    kind: IntArray, phase: IntArray | BoolArray, after: int | IntArray, sort: IntArray
) -> IntArray:
    """Numbers [n] of cells."""
    return ((kind * 2 + phase) * 2 + after) * 2 + sort


def cell_of(number: IntArray) -> Cell:
    """The cells with these numbers [n]."""
    return Cell(number // 8, number // 4 % 2, number // 2 % 2, number % 2)


def cell_count(kinds: int) -> int:
    """Number of cells for `kinds` kinds of motion."""
    return 8 * kinds


def make(bank: filters.Filters, waters: training_tracks.Waters, seed: int, chunk: int) -> Samples:
    """The samples of one chunk of tracks. The same seed and number give the same samples."""
    rng = np.random.default_rng([seed, chunk])
    traffic = training_tracks.draw(waters, np.arange(CHUNK) % len(waters.names), SCANS, rng)
    ships, radar = traffic.ships, traffic.radar
    plots, seen = ship_tracks.observe(ships, radar, rng, traffic.hull)
    phase = ship_tracks.phase(ships.manoeuvre)

    state = filters.begin(bank, plots[0], training_tracks.SPEED)
    memory = inputs.begin(plots[0])
    parts = []
    for k in range(1, SCANS):
        warm = np.flatnonzero(memory.plots >= monitor.WARM)
        for after, share in ((0, EXPECTED), (1, KNOWN)):
            rows = warm[rng.random(len(warm)) < share]
            if after:
                rows = rows[state.time[rows] == ships.time[rows, k - 1]]
            if len(rows):
                cell = cell_number(
                    traffic.kind[rows], phase[rows, k - after], after, traffic.sort[rows]
                )
                parts.append(
                    _sample(
                        bank,
                        take(state, rows),
                        take(memory, rows),
                        take(ships, rows),
                        k - after,
                        take(radar, rows),
                        cell,
                    )
                )
        rows = np.flatnonzero(seen[:, k])
        new_state, new_memory, _ = gwnn.advance(
            bank, take(state, rows), take(memory, rows), take(plots[k], rows)
        )
        state, memory = put(state, rows, new_state), put(memory, rows, new_memory)
    return join(parts)


def _sample(bank, state, memory, ships, k, radar, cell) -> Samples:
    """Samples with the truth at scan k."""
    time, frame = ships.time[:, k], memory.frame
    ahead = filters.look(bank, state, time - state.time)
    at = gwnn.look(state, frame, ahead, time)
    truth = np.concatenate([ships.position[:, k], ships.velocity[:, k]], 1).T
    off = inputs.to_sigma(frame, truth - ahead.mean)
    columns = filters.base(bank, state, time)
    _, covariance = linear_modes.unpack(columns.T)
    spread = inputs.variances(frame, covariance)
    return Samples._make(
        [
            *(
                np.ascontiguousarray(array, np.float32)
                for array in (
                    inputs.inputs(bank, state, memory, radar.period),
                    at.apart.transpose(2, 1, 0),
                    at.log_weight[:4].T,
                    at.scans,
                    np.clip(off, -CLIP, CLIP).T,
                    np.log(spread).T,
                    np.square(frame[:, 2:]).mean(1),
                )
            ),
            cell.astype(np.int16),
            radar.truly.astype(np.float32),
        ]
    )


def join(parts: Iterable[Samples]) -> Samples:
    """All samples of several parts."""
    return Samples(*(np.concatenate(columns) for columns in zip(*parts)))
