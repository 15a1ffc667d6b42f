"""Plots from the cells of components whose echoes have ended."""

import math

import numpy as np

from ..geometry import unit_vector, wrap_bearing
from ..parameters import VideoParameters
from ..types import Array, BoolArray, IntArray, PolarPlots
from . import detection, level, measure, pieces, tail
from .found import LAND, LOBE, Details, Found, nothing
from .stack import Stack

CORE = 2 * math.log(2)  # nepers: an echo is measured across where it is 6 dB below its peak
POINT = np.array([1.0, math.sqrt(2.0)])  # beams and pulses that a point is wide there
ROUND = 1.4  # times that: still a point
SKIRTS = 2.0  # beams that the flanks of a strong echo may add to its width
STANDS_OUT = 3.5  # nepers, 15 dB: what is so far above most of the land it hangs on is no land
FEW = 3  # maxima: so few are ships near each other with their side lobes; land has more
LOBES = math.radians(8.0)  # side lobes show so far beside a strong echo ...
LOBE_DOWN = 0.35  # of full scale, some 28 dB: ... and are at least so much weaker
LEAST_CELLS = 3  # of an echo, where beam and pulse spread it over more
DECIBEL = 10 / math.log(10)  # of a neper


def measured(
    held: Stack,
    row: IntArray,
    sample: IntArray,
    component: IntArray,
    limits: tail.Thresholds,
    full: int,
    parameters: VideoParameters,
) -> Found:
    """The plots of the components [n] of cells at rows and samples [n]."""
    lobe, count = held.lobe, int(component.max()) + 1
    order = np.argsort(component, kind='stable')
    row, sample, component = row[order], sample[order], component[order]
    # The slope of the tail is the display's scale in noise only: clutter has a longer tail.
    usual = level.scale(full)
    slope = np.full(count, usual)
    power, value, its = detection.power_at(held, row, sample, limits)
    np.minimum.at(slope, component, its)
    height = held.strength[row, sample] / usual  # nepers
    land_height, deep = _land(held, row, sample, component, height, parameters.max_size_m)
    top = np.full(count, -np.inf)
    np.maximum.at(top, component, height)
    whole = (top < land_height) & deep
    found = pieces.split(row, sample, component, whole, held.strength, lobe, slope)
    few = ~deep & (np.bincount(found.origin, minlength=count) <= FEW)
    piece, count = found.piece, found.number
    top = np.full(count, -np.inf)
    np.maximum.at(top, piece, power)
    core = power >= top[piece] - CORE
    centre, covariance, extent = measure.lengths(
        row[core],
        sample[core],
        piece[core],
        np.maximum(power[core], 0.1),
        count,
        POINT * lobe.shape,
    )
    centre[:, 1] += 0.5
    cells = np.bincount(piece, minlength=count)
    spokes = _spokes(row, piece, count)
    across = centre[:, 1] * held.range_step * held.spacing  # m, of a spoke
    size = np.stack([extent[:, 1] * held.range_step, extent[:, 0] * across], 1)
    flanks = SKIRTS * lobe.shape[0] * across
    land = (size - np.stack([0 * flanks, flanks], 1) > parameters.max_size_m).any(1)
    highest = np.full(count, -np.inf)
    np.maximum.at(highest, piece, height)
    land |= (highest < land_height[found.origin]) & ~few[found.origin]
    spread = lobe.shape[0] >= detection.LEAST_SPOKES
    enough = (cells >= LEAST_CELLS) & (spokes >= 2) if spread else cells >= 1
    keep = ~land & enough
    lobes = keep & _side_lobe(held, found.peak, full)
    keep &= ~lobes
    left_out = {
        reason: int(mask.sum()) for reason, mask in ((LAND, land), (LOBE, lobes)) if mask.any()
    }
    if not keep.any():
        return nothing()._replace(counts=left_out)

    point = keep & (extent <= (ROUND - 1) * POINT * lobe.shape + 1).all(1)
    snr = top.copy()
    chosen = np.flatnonzero(point)
    if len(chosen):
        place, known, height, held_ = _fitted(held, found, chosen, limits, full)
        chosen = chosen[held_]
        centre[chosen] = place[held_] + [0.0, 0.5]
        covariance[chosen], snr[chosen] = known[held_], height[held_]
    doppler = np.zeros(count)
    if parameters.doppler_codes:
        sign = np.where(value == full - 1, 1.0, np.where(value == full, -1.0, 0.0))
        doppler = np.bincount(piece, sign, count) / cells
    # In coarse steps neighbouring samples err alike, and real beams have no Gaussian flanks: plots
    # of moored craft in recordings of 4 bits scatter by a tenth of beam and pulse.
    coarse = measure.COARSE * level.scale(full) ** -2
    floor = ((measure.FLOOR + coarse) * lobe.shape) ** 2
    covariance[:, [0, 1], [0, 1]] += floor
    order = np.flatnonzero(keep)
    order = order[np.argsort(centre[order, 0], kind='stable')]  # in order of time
    return Found(
        _polar(held, centre[order], covariance[order], snr[order], parameters.range_offset_m),
        Details(size[order], cells[order], doppler[order]),
        left_out,
        (np.nan, np.nan),
    )


def _land(
    held: Stack, row: IntArray, sample: IntArray, component: IntArray, height: Array, longest: float
) -> tuple[Array, BoolArray]:
    """[C] nepers: what is lower in a component that is longer than any ship is land; -inf for the
    others. [C] whether it is deeper in range than a few ships. Cells [n] in the order of their
    components.

    height  [n]  strength of the cells, in nepers
    """
    edge = np.searchsorted(component, np.arange(int(component[-1]) + 2))
    first, cells = edge[:-1], np.diff(edge)
    span = [np.maximum.reduceat(a, first) - np.minimum.reduceat(a, first) for a in (row, sample)]
    across = np.add.reduceat(sample, first) / cells * held.range_step * held.spacing
    flanks = (SKIRTS + 1.0) * held.lobe.shape[0]
    long_ = (span[0] - flanks) * across > longest
    long_ |= span[1] * held.range_step > longest
    land = np.full(len(cells), -np.inf)
    for one in np.flatnonzero(long_).tolist():
        land[one] = np.median(height[edge[one] : edge[one + 1]]) + STANDS_OUT
    return land, span[1] * held.range_step > FEW * longest


def _side_lobe(held: Stack, peak: IntArray, full: int) -> BoolArray:
    """[K] pieces at the range of a far stronger echo not far away in bearing."""
    half = max(round(LOBES / held.spacing), 1)
    rows = peak[:, :1] + np.arange(-half, half + 1)
    inside = (rows >= 0) & (rows < len(held.strength))
    rows = np.clip(rows, 0, len(held.strength) - 1)
    strongest = np.zeros(len(peak))
    for beside in (-1, 0, 1):
        sample = np.clip(peak[:, 1] + beside, 0, held.strength.shape[1] - 1)
        strength = np.where(inside, held.strength[rows, sample[:, None]], 0)
        strongest = np.maximum(strongest, strength.max(1))
    value = held.strength[peak[:, 0], peak[:, 1]]
    return strongest - value > LOBE_DOWN * full


def _spokes(row: IntArray, piece: IntArray, count: int) -> IntArray:
    """[count] spokes in which each piece has cells."""
    pairs = np.unique(piece * (int(row.max()) + 1) + row)
    return np.bincount(pairs // (int(row.max()) + 1), minlength=count)


def _fitted(
    held: Stack, found: pieces.Pieces, chosen: IntArray, limits: tail.Thresholds, full: int
) -> tuple[Array, Array, Array, BoolArray]:
    """The chosen pieces as points (measure.points)."""
    peak = found.peak[chosen]
    rows, samples, usable = measure.patches(peak, held.strength, held.lobe)
    power, value, slope = detection.power_at(held, rows, samples, limits)
    usable &= value < full
    # Cells of another piece are not this one's echo.
    width = held.strength.shape[1]
    owner = np.full(held.strength.size, -1, np.int32)
    owner[found.row * width + found.sample] = found.piece
    owners = owner[rows * width + samples]
    usable &= (owners < 0) | (owners == chosen[:, None, None])
    middle = slope[:, slope.shape[1] // 2, slope.shape[2] // 2]
    return measure.points(peak, power, usable, held.lobe, 1.0 / middle)


def _polar(held: Stack, place: Array, covariance: Array, snr: Array, offset: float) -> PolarPlots:
    """Plots at places [M, 2], rows and samples, with covariance [M, 2, 2] of these."""
    rows = np.arange(len(held.time))
    time = np.interp(place[:, 0], rows, held.time)
    bearing = np.interp(place[:, 0], rows, held.bearing)
    range_ = np.maximum(place[:, 1] * held.range_step + offset, 1.0)
    along = unit_vector(bearing)
    across = np.stack([along[:, 1], -along[:, 0]], -1)
    to_metres = np.stack([across * (held.spacing * range_)[:, None], along * held.range_step], 2)
    return PolarPlots(
        time,
        range_,
        wrap_bearing(bearing),
        DECIBEL * snr,
        covariance=to_metres @ covariance @ to_metres.transpose(0, 2, 1),
    )
