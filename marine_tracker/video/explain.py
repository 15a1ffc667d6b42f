"""Why there is, or is not, a plot at a place: what the video holds there, in words."""

import math
from typing import NamedTuple

import numpy as np

from ..geometry import wrap_angle, wrap_bearing
from ..types import OwnShip, Spokes
from .detection import kind_at, noise_at, over_threshold
from .extraction import Extraction, Memory
from .found import LAND
from .level import GUARD_BLOCKS, RING_BLOCKS
from .picture import OLD_S, ROWS, Polar
from .stack import Stack, begun, measured

BEAMS_ABOUT = 8.0  # what is looked at beside the place
SILENT = 0.95  # share of cells at 0, from which the radar itself shows nothing there


class Why(NamedTuple):
    """One thing that is known, in words, and whether it alone keeps a plot away."""

    text: str
    decides: bool = False


def explain(
    polar: Polar,
    memory: Memory,
    extraction: Extraction,
    range_: float,
    bearing: float,
    bow: float,
    now: float,
) -> list[Why]:
    """What the picture holds at a range m and true bearing rad from own ship.

    bow  rad, own ship's heading, nan where it is not known; now: s, of the spokes' time
    """
    parameters = extraction.parameters
    row = int(wrap_bearing(np.float64(bearing)) * ROWS / (2 * math.pi)) % ROWS
    age, step = now - float(polar.time[row]), float(polar.step[row])
    for first, last in extraction.blanks:
        angle = wrap_bearing(np.float64(bearing - bow))
        if wrap_bearing(angle - first) <= wrap_bearing(np.float64(last - first)):
            return [Why('the place lies in a blank sector: nothing is taken from there', True)]
    if not age < OLD_S:
        return [Why('the video has no spoke in that direction', True)]
    reach = polar.strength.shape[1] * step
    if range_ >= reach:
        return [Why(f'the video ends at {reach:.0f} m: the place lies beyond it', True)]
    if range_ < parameters.blind_range_m:
        return [Why(f'the place lies within blind_range_m, {parameters.blind_range_m:g} m', True)]
    return _at_place(polar, memory, extraction, range_, bearing, row)


def _at_place(
    polar: Polar, memory: Memory, extraction: Extraction, range_: float, bearing: float, row: int
) -> list[Why]:
    parameters = extraction.parameters
    half = max(round(BEAMS_ABOUT * extraction.beam * ROWS / (2 * math.pi)), 64)
    rows = np.arange(row - half, row + half + 1) % ROWS
    good = polar.step[rows] == polar.step[row]
    good &= polar.time[rows] > polar.time[row] - OLD_S
    rows = rows[good]
    spokes = Spokes(
        np.arange(len(rows), dtype=np.float64) * 1e-3,
        wrap_bearing((rows + 0.5) * (2 * math.pi / ROWS)),
        np.full(len(rows), polar.step[row]),
        polar.strength[rows],
        OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2))),
    )
    held = measured(begun(spokes), extraction.beam, parameters.pulse_length_m, True)
    held, _, limits = over_threshold(
        held, len(held.mean), memory.tail, memory.full, parameters.false_alarm_rate, 0
    )
    middle = int(np.flatnonzero(rows == row)[0])
    sample = min(int(range_ / held.range_step), held.strength.shape[1] - 1)
    at = _strongest(held, middle, sample)
    value = int(held.strength[at])
    level = float(noise_at(held, np.array([at[0]]), np.array([at[1]]))[0])
    kind = kind_at(held, np.array([at[0]]), np.array([at[1]]))[0]
    needed = math.ceil(level + limits.over[kind, at[1]])
    words = (
        f'the strongest sample there is {value} of {memory.full}; the level around it asks for '
        f'{min(needed, memory.full + 1)}'
    )
    around = held.strength[_about(held, middle, sample)]
    said = []
    if float((around == 0).mean()) > SILENT:
        share = 100 * float((around == 0).mean())
        said.append(
            Why(
                f"{share:.0f} % of the samples around are 0: the radar's own gain, sea or rain "
                'control takes what is weaker'
            )
        )
    if value < needed:
        return [Why(f'{words}: it is below', True), *said]
    begin, first = extraction.step(memory._replace(stack=None), spokes)
    _, last = extraction.end(begin)
    near = 2 * max(extraction.beam * range_, held.lobe.shape[1] * held.range_step)
    for found in (first, last):
        away = np.hypot(
            found.plots.range - range_, wrap_angle(found.plots.bearing - bearing) * range_
        )
        if (away < near).any():
            snr = float(found.plots.amplitude[away.argmin()])
            return [Why(f'{words}: a plot comes from there, {snr:.0f} dB over the noise'), *said]
    if LAND in first.counts or LAND in last.counts:
        return [
            Why(
                f'{words}; but it hangs together with an echo longer than max_size_m, '
                f'{parameters.max_size_m:g} m: it counts as land',
                True,
            ),
            *said,
        ]
    return [Why(f'{words}; but too few samples do for the echo of a beam and a pulse', True), *said]


def _strongest(held: Stack, row: int, sample: int) -> tuple[int, int]:
    """The strongest sample within half a beam and a pulse of a place."""
    rows = max(round(0.5 * held.lobe.shape[0]), 1)
    samples = max(round(held.lobe.shape[1]), 1)
    low = max(row - rows, 0), max(sample - samples, 0)
    patch = held.strength[low[0] : row + rows + 1, low[1] : sample + samples + 1]
    r, s = np.unravel_index(int(patch.argmax()), patch.shape)
    return low[0] + int(r), low[1] + int(s)


def _about(held: Stack, row: int, sample: int) -> tuple[slice, slice]:
    """The rows and samples that tell the level of a place."""
    rows = (GUARD_BLOCKS + RING_BLOCKS) * held.grid.rows
    column = max(int(np.searchsorted(held.grid.edge, sample, 'right')) - 1, 0)
    reach = GUARD_BLOCKS + RING_BLOCKS
    first = int(held.grid.edge[max(column - reach, 0)])
    last = int(held.grid.edge[min(column + reach + 1, len(held.grid.edge) - 1)])
    return slice(max(row - rows, 0), row + rows + 1), slice(first, last)
