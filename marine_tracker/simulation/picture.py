"""The cells of a radar picture: noise and clutter, and what point scatterers add to them.

A point's echo is spread by the beam, which it passes twice, and by the pulse, as in video that real
radars give: power down to a quarter at half a beam width, to a half at half a pulse. Beyond the
main lobe the antenna has side lobes of -26 dB, -32 dB from 10 degrees on (one way; IEC 62388 allows
-20 and -23): a strong echo shows a ring of them.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import wrap_angle
from ..types import Array, FloatArray, IntArray, StrengthArray, take
from . import radar_equation as equation

SPAN_DB = 80.0  # of all bits
NOISE_DB = 8.0  # above 0 of the scale
NEAR_LOBES, FAR_LOBES = 10 ** (-26 / 20), 10 ** (-32 / 20)
FAR = np.radians(10.0)
TEXTURE = (4, 3)  # spokes and samples over which the sea is equally rough
STRONG = 10 ** (5.2 - 0.6)  # power over noise, beyond which side lobes show
PULSES = 2.2  # a pulse's echo reaches that far to both sides
BEAMS = 1.8


class Form(NamedTuple):
    """A picture: S spokes evenly from north on, B samples.

    bearing  [S]  rad; range [B] m, middles of the samples
    beam rad, pulse m
    """

    bearing: Array
    range: Array
    beam: float
    pulse: float

    @property
    def step(self) -> float:
        """Depth of a sample, m."""
        return float(2 * self.range[0])


class Points(NamedTuple):
    """Scatterers, P of them.

    range    [P]  m; bearing [P] rad, when the beam passes them
    echo     [P]  complex amplitude over that of noise, in the middle of the beam
    turning  [P]  rad by which the phase turns from spoke to spoke
    """

    range: Array
    bearing: Array
    echo: NDArray[np.complex128]
    turning: Array


def form(spokes: int, samples: int, longest: float, beam: float, pulse: float) -> Form:
    """The form of a picture that reaches to `longest` m."""
    step = longest / samples
    return Form(
        np.arange(spokes, dtype=np.float64) * (2 * np.pi / spokes),
        (np.arange(samples, dtype=np.float64) + 0.5) * step,
        beam,
        max(pulse, step),
    )


def pattern(off: Array, beam: float) -> Array:
    """Two-way amplitude of the antenna at angles [...] rad off its axis."""
    main = np.exp2(-2 * (off / beam) ** 2)
    lobes = np.where(np.abs(off) < FAR, NEAR_LOBES, FAR_LOBES)
    side = lobes * np.abs(np.sin(np.pi * off / beam))
    one_way: Array = np.maximum(main, np.where(np.abs(off) > beam, side, 0.0))
    return one_way**2


def background(
    of: Form, power_factor: float, state: float, random: np.random.Generator
) -> FloatArray:
    """Mean power [S, B] of receiver noise, 1, and of the sea, where it is rough now."""
    spokes, samples = len(of.bearing), len(of.range)
    if state <= 0:
        return np.ones((spokes, samples), np.float32)
    section, shape = equation.sea(of.range, of.beam, of.pulse, state)
    mean = (section * power_factor / of.range**4).astype(np.float32)
    rows, columns = TEXTURE
    at = np.arange(0, samples, columns)
    count = -(-spokes // rows)
    rough = random.standard_gamma(shape[at].astype(np.float32), (count, len(at)), np.float32)
    rough /= shape[at].astype(np.float32)
    whole = rough.repeat(rows, 0)[:spokes].repeat(columns, 1)[:, :samples]
    whole *= mean
    whole += 1.0
    return whole


def add_rain(
    power: FloatArray, of: Form, power_factor: float, offset: Array, radius: float, rate: float
) -> None:
    """Adds a shower to the mean power [S, B]: its middle lies at `offset` [2] m."""
    section = equation.rain(of.range, of.beam, of.pulse, rate)
    mean = (section * power_factor / of.range**4).astype(np.float32)
    # Distance from the middle, for spokes and samples: law of cosines.
    away = float(np.hypot(*offset))
    along = np.cos(of.bearing - np.arctan2(offset[0], offset[1]))
    square = away**2 + of.range**2 - 2 * away * along[:, None] * of.range
    inside = np.maximum(1 - square / radius**2, 0.0).astype(np.float32)
    power += inside * mean


def add_points(
    power: FloatArray, of: Form, points: Points, random: np.random.Generator
) -> FloatArray:
    """The picture's power [S, B]: noise and clutter of mean power [S, B], and the scatterers."""
    spokes, samples = power.shape
    found = power * random.standard_exponential(power.shape, np.float32)
    if not len(points.range):
        return found
    rows, columns, value = _spread(of, points)
    cell, which = np.unique(rows * samples + columns, return_inverse=True)
    real, imaginary = (np.bincount(which, part, len(cell)) for part in (value.real, value.imag))
    flat, mean = found.reshape(-1), power.reshape(-1)
    # Noise and clutter are complex Gaussian: in these cells with a phase of their own.
    noise = np.sqrt(0.5 * mean[cell]) * random.standard_normal((2, len(cell)))
    flat[cell] = (real + noise[0]) ** 2 + (imaginary + noise[1]) ** 2
    return found


def _spread(of: Form, points: Points) -> tuple[IntArray, IntArray, NDArray[np.complex128]]:
    """Cells that the scatterers' echoes reach, and what each adds there; cells come repeatedly."""
    spokes, samples = len(of.bearing), len(of.range)
    spacing = 2 * np.pi / spokes
    half = (
        max(int(BEAMS * of.beam / spacing), 1),
        max(int(np.ceil(PULSES * of.pulse / of.step)), 1),
    )
    strong = np.abs(points.echo) ** 2 > STRONG
    parts = []
    for which, reach in ((~strong, half[0]), (strong, spokes // 2)):
        if not which.any():
            continue
        part = take(points, which)
        middle = np.rint(part.bearing / spacing).astype(np.int64)
        beside = np.arange(-reach, reach + 1)
        row = middle[:, None] + beside
        off = wrap_angle(row * spacing - part.bearing[:, None])
        lobe = pattern(off, of.beam) * np.exp(1j * part.turning[:, None] * beside)
        lobe = lobe * part.echo[:, None]
        # Only what shows above the noise is worth adding.
        shows = np.abs(lobe) > 0.05
        at, spoke = np.nonzero(shows)
        gate = np.rint(part.range / of.step - 0.5).astype(np.int64)
        column = gate[at, None] + np.arange(-half[1], half[1] + 1)
        pulse = np.exp2(-2 * (((column + 0.5) * of.step - part.range[at, None]) / of.pulse) ** 2)
        value = lobe[at, spoke][:, None] * pulse
        inside = (column >= 0) & (column < samples) & (np.abs(value) > 0.02)
        rows = np.broadcast_to((row[at, spoke] % spokes)[:, None], column.shape)
        parts.append((rows[inside], column[inside], value[inside]))
    rows, columns, values = (np.concatenate(column) for column in zip(*parts))
    return rows, columns, values


def displayed(power: FloatArray, bits: int) -> StrengthArray:
    """Strengths [S, B] of powers over noise: their logarithm, in 2^bits steps over 80 dB."""
    full = 2**bits - 1
    value = np.log10(np.maximum(power, np.float32(1e-6)))
    value *= np.float32(10 * full / SPAN_DB)
    value += np.float32(NOISE_DB * full / SPAN_DB)
    np.clip(value, 0, full, out=value)
    return value.astype(np.uint8 if bits <= 8 else np.uint16)
