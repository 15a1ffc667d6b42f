"""Point targets in noise: errors of their plots beside the bound, and pairs resolved."""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import quad
from scipy.special import i0e, i1e

from ...geometry import unit_vector, wrap_angle
from ...parameters import VideoParameters
from ...simulation import picture
from ...types import Array, FloatArray, OwnShip, PolarPlots, Spokes, append
from ...video.extraction import Extraction, Memory

SPOKES, SAMPLES, RANGE = 2048, 512, 6_000.0
BEAM, PULSE = math.radians(1.6), 35.0
FORM = picture.form(SPOKES, SAMPLES, RANGE, BEAM, PULSE)
PARAMETERS = VideoParameters(
    beam_width_deg=math.degrees(BEAM), pulse_length_m=PULSE, false_alarms_per_million=10.0
)
REST = OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)), np.zeros(1))
APART = (40, 60)  # spokes and samples between targets


class Errors(NamedTuple):
    """Of the N targets that gave one plot: range m, bearing rad, normalised square; and of how
    many targets."""

    range: Array
    bearing: Array
    nis: Array
    targets: int


def plots_of(
    power: FloatArray, time: float, extraction: Extraction, memory: Memory, bits: int = 8
) -> tuple[Memory, PolarPlots]:
    """The plots of a revolution; what came before it is known already."""
    number = np.arange(SPOKES, dtype=np.float64)
    spokes = Spokes(
        time + number * (2.5 / SPOKES),
        FORM.bearing,
        np.full(SPOKES, FORM.step),
        picture.displayed(power.astype(np.float32), bits),
        REST,
    )
    memory, first = extraction.step(memory, spokes)
    memory, last = extraction.end(memory)
    return memory, append(first.plots, last.plots)


def places(random: np.random.Generator) -> tuple[Array, Array]:
    """Ranges m and bearings rad of targets far from each other, anywhere in their cells."""
    row, column = np.meshgrid(
        np.arange(APART[0], SPOKES - APART[0], APART[0]), np.arange(60, SAMPLES - 60, APART[1])
    )
    at_row: Array = row.ravel() + random.uniform(-3, 3, row.size)
    at_sample: Array = column.ravel() + random.uniform(-3, 3, column.size)
    return (at_sample + 0.5) * FORM.step, at_row * (2 * np.pi / SPOKES)


def measure(snr_db: float, revolutions: int, seed: int, bits: int = 8) -> Errors:
    """Errors of steady point targets of this SNR."""
    random = np.random.default_rng([seed, round(10 * snr_db), bits])
    extraction = Extraction(PARAMETERS)
    memory = extraction.start()
    quiet = np.ones((SPOKES, SAMPLES), np.float32)
    parts, targets = [], 0
    for turn in range(revolutions + 1):
        range_, bearing = places(random)
        echo = 10 ** (snr_db / 20) * np.exp(2j * np.pi * random.random(len(range_)))
        points = picture.Points(range_, bearing, echo, random.uniform(0, 2 * np.pi, len(range_)))
        power = picture.add_points(quiet, FORM, points, random)
        memory, plots = plots_of(power, 3.0 * turn, extraction, memory, bits)
        if not turn:
            continue
        near = np.abs(range_[:, None] - plots.range) < 3 * PULSE
        near &= np.abs(wrap_angle(bearing[:, None] - plots.bearing)) < 1.5 * BEAM
        one = near.sum(1) == 1
        row = near[one].argmax(1)
        truth = range_[one, None] * unit_vector(bearing[one])
        place = plots.range[row, None] * unit_vector(plots.bearing[row])
        offset = place - truth
        assert plots.covariance is not None
        nis = np.einsum('ki,kij,kj->k', offset, np.linalg.inv(plots.covariance[row]), offset)
        parts.append(
            (plots.range[row] - range_[one], wrap_angle(plots.bearing[row] - bearing[one]), nis)
        )
        targets += len(range_)
    range_error, bearing_error, nis = (np.concatenate(column) for column in zip(*parts))
    return Errors(range_error, bearing_error, nis, targets)


def information(ratio: float) -> float:
    """Fisher information of one power in noise of mean 1 about the steady part `ratio` of it, by
    quadrature of the density exp(-z - r) I0(2 sqrt(z r))."""
    if ratio < 1e-4:
        return 1.0

    def of_root(root: float) -> float:  # z = root^2
        x = 2 * root * math.sqrt(ratio)
        density = math.exp(-((root - math.sqrt(ratio)) ** 2)) * i0e(x)
        score = root / math.sqrt(ratio) * i1e(x) / i0e(x) - 1
        return score**2 * density * 2 * root

    middle = math.sqrt(ratio)
    value, _ = quad(of_root, max(middle - 8, 0.0), middle + 8, limit=200)
    return float(value)


RATIOS = np.logspace(-4, 6, 200)


def bound(snr_db: float) -> tuple[float, float]:
    """Cramer-Rao bound of range m and bearing rad of a steady point of this SNR, whose power is
    unknown too; the mean over its place within a cell."""
    told = np.array([information(ratio) for ratio in RATIOS])
    variance = np.zeros(2)
    spacing = 2 * np.pi / SPOKES
    shifts = np.linspace(-0.5, 0.5, 5)[:-1]
    for shift in shifts:
        row = (np.arange(-60, 61) - shift) * spacing / BEAM
        column = (np.arange(-30, 31) - shift) * FORM.step / PULSE
        fall = 8 * np.log(2) * row[:, None] ** 2 + 4 * np.log(2) * column**2
        ratio = 10 ** (0.1 * snr_db) * np.exp(-fall)
        each = np.interp(np.log(np.maximum(ratio, 1e-12)), np.log(RATIOS), told) * ratio**2
        gradient = np.stack(
            np.broadcast_arrays(
                1.0, 16 * np.log(2) * row[:, None] / BEAM, 8 * np.log(2) * column / PULSE
            )
        )
        matrix = np.einsum('irc,jrc,rc->ij', gradient, gradient, each)
        variance += np.linalg.inv(matrix)[[2, 1], [2, 1]] / len(shifts)
    return float(np.sqrt(variance[0])), float(np.sqrt(variance[1]))


def resolved(beams: float, pulses: float, snr_db: float, revolutions: int, seed: int) -> float:
    """Share of pairs of steady ships so far apart that give two plots, each near its ship."""
    random = np.random.default_rng([seed, round(100 * beams), round(100 * pulses)])
    extraction = Extraction(PARAMETERS)
    memory = extraction.start()
    quiet = np.ones((SPOKES, SAMPLES), np.float32)
    good = pairs = 0
    for turn in range(revolutions + 1):
        range_, bearing = (a[::2] for a in places(random))
        both = np.concatenate([range_, range_ + pulses * PULSE])
        angle = np.concatenate([bearing, bearing + beams * BEAM])
        echo = 10 ** (snr_db / 20) * np.exp(2j * np.pi * random.random(len(both)))
        turning = random.uniform(0, 2 * np.pi, len(both))
        points = picture.Points(both, angle, echo, turning)
        power = picture.add_points(quiet, FORM, points, random)
        memory, plots = plots_of(power, 3.0 * turn, extraction, memory)
        if not turn:
            continue
        near = np.abs(both[:, None] - plots.range) < 0.6 * max(pulses, 0.8) * PULSE
        near &= np.abs(wrap_angle(angle[:, None] - plots.bearing)) < 0.6 * max(beams, 0.8) * BEAM
        first, second = near[: len(range_)], near[len(range_) :]
        good += (((first | second).sum(1) >= 2) & first.any(1) & second.any(1)).sum()
        pairs += len(range_)
    return float(good) / pairs
