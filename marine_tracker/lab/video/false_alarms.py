"""Cells over the threshold where there is no echo, beside the rate asked for; and detection.

Clutter falls by 30 dB from the nearest to the farthest sample, which no level may follow too
slowly. Weibull and K clutter are independent from cell to cell.
"""

import math
from typing import NamedTuple

import numpy as np

from ...simulation import picture
from ...types import Array, FloatArray, StrengthArray
from ...video import detection, level, stack, tail
from ...video.stack import Stack

SPOKES, SAMPLES, RANGE = 2048, 1024, 12_000.0
BEAM, PULSE = math.radians(1.2), 30.0
RATES = (1e-3, 1e-4, 1e-5, 1e-6)
KINDS = ('noise', 'Weibull, shape 1.2', 'K, shape 0.5', 'K, shape 2', 'K, shape 10')
WARM = 3  # revolutions before the count begins
FALL_DB, MEAN_DB = 30.0, 35.0
BITS, FULL = 8, 255
FORM = picture.form(SPOKES, SAMPLES, RANGE, BEAM, PULSE)


class Counts(NamedTuple):
    """Cells over the threshold, and all cells, by octave of samples [Z]."""

    over: Array
    cells: Array


def clutter(kind: str, random: np.random.Generator) -> FloatArray:
    """Powers [S, B] over noise of one of KINDS; noise has mean 1, clutter falls with range."""
    shape = (SPOKES, SAMPLES)
    power = random.standard_exponential(shape, np.float32)
    if kind == 'noise':
        return power
    name, words = kind.split(', shape ')
    number = float(words)
    if name == 'Weibull':  # in amplitude; 2 is exponential power
        power **= np.float32(2 / number)
        power /= math.gamma(1 + 2 / number)
    else:
        power *= random.standard_gamma(np.float32(number), shape, np.float32) / np.float32(number)
    slope = np.linspace(0.5 * FALL_DB, -0.5 * FALL_DB, SAMPLES, dtype=np.float32)
    return power * 10 ** (0.1 * (MEAN_DB - picture.NOISE_DB + slope))


def begun(strength: StrengthArray) -> Stack:
    """A whole revolution, ready to be decided on."""
    number = np.arange(SPOKES, dtype=np.float64)
    spokes = stack.Stack(
        number * (2.5 / SPOKES),
        FORM.bearing.copy(),
        strength,
        np.zeros(strength.shape, bool),
        np.zeros((0, 0), np.float32),
        np.zeros((0, 0)),
        np.zeros((0, 0), np.float32),
        np.zeros((0, 0), np.int64),
        FORM.step,
        math.nan,
        stack.NO_GRID,
        stack.NO_LOBE,
    )
    return stack.measured(spokes, BEAM, PULSE, True)


def count(kind: str, rate: float, revolutions: int, seed: int) -> Counts:
    """False alarms in so many revolutions, before other radars are looked for."""
    random = np.random.default_rng([seed, KINDS.index(kind), round(-math.log10(rate))])
    zone = tail.zone_of(np.arange(SAMPLES))
    known = tail.start(int(zone[-1]) + 1)
    over = np.zeros(len(known.cells))
    for turn in range(revolutions + WARM):
        held = begun(picture.displayed(clutter(kind, random), BITS))
        held, known, _ = detection.over_threshold(held, len(held.mean), known, FULL, rate, 0)
        if turn >= WARM:
            over += np.bincount(zone, held.hits.sum(0), len(over))
    cells = np.bincount(zone).astype(np.float64) * (SPOKES * revolutions)
    return Counts(over, cells)


def reference_cells() -> float:
    """Cells in the ring of a block half-way out."""
    of = level.grid(SAMPLES, FORM.step, 2 * math.pi / SPOKES, BEAM, PULSE)
    outer, inner = (2 * a + 1 for a in (level.GUARD_BLOCKS + level.RING_BLOCKS, level.GUARD_BLOCKS))
    return float((outer**2 - inner**2) * of.cells[len(of.cells) // 2])


def detected(snr_db: Array, rate: float, revolutions: int, seed: int) -> Array:
    """Share [K] of Swerling 1 targets of mean SNR [K] whose middle cell is over the threshold.

    The targets lie far from each other in receiver noise.
    """
    random = np.random.default_rng([seed, 99])
    known = tail.start(int(tail.zone_of(np.array([SAMPLES - 1]))[0]) + 1)
    row, column = (a.ravel() for a in np.meshgrid(np.arange(48, SPOKES - 48, 96), [400, 600, 800]))
    seen, shown = np.zeros(len(snr_db)), np.zeros(len(snr_db))
    quiet = np.ones((SPOKES, SAMPLES), np.float32)
    for turn in range(revolutions + WARM):
        which = random.integers(len(snr_db), size=len(row))
        echo = np.sqrt(0.5 * 10 ** (0.1 * snr_db[which])) * (
            random.standard_normal(len(row)) + 1j * random.standard_normal(len(row))
        )
        points = picture.Points(
            FORM.range[column], FORM.bearing[row], echo, random.uniform(0, 2 * np.pi, len(row))
        )
        power = picture.add_points(quiet, FORM, points, random)
        held = begun(picture.displayed(power, BITS))
        held, known, _, _ = detection.decide(held, len(held.mean), known, FULL, rate, 0)
        if turn >= WARM:
            seen += np.bincount(which, held.hits[row, column], len(snr_db))
            shown += np.bincount(which, minlength=len(snr_db))
    return seen / np.maximum(shown, 1)


def theory(snr_db: Array, rate: float, cells: float) -> Array:
    """Detection [K] of a Swerling 1 target by cell averaging over so many cells (Finn and Johnson,
    RCA Review 29, 1968)."""
    factor = rate ** (-1 / cells) - 1
    probability: Array = (1 + factor / (1 + 10 ** (0.1 * snr_db))) ** -cells
    return probability


def loss(snr_db: Array, share: Array, rate: float, cells: float) -> float:
    """dB by which the theoretical curve must be moved to fit the shares [K] best."""
    moved = np.arange(-2.0, 4.0, 0.02)
    wrong = [np.sum((share - theory(snr_db - by, rate, cells)) ** 2) for by in moved]
    return float(moved[int(np.argmin(wrong))])
