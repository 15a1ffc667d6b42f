"""Powers in a radar's picture, all over the receiver's noise.

Radar: X band, 9.4 GHz, gain 30 dB, noise figure 4 dB, losses 5 dB (typical of ITU-R M.1313-1,
table 1); the receiver's bandwidth fits the pulse. Point targets: the radar equation, R^-4 (Skolnik,
Radar Handbook, 3rd ed., 1.2). Left out: multipath, the horizon, attenuation by rain.

Ships: median cross section 52 f^(1/2) D^(3/2) m^2, f in MHz, D in kilotons (Skolnik, Introduction
to Radar Systems, 3rd ed., 2.8), D = 8 (length / 100 m)^3; stronger abeam, ahead and astern.

Sea: sigma0 = gamma sin(grazing), gamma = 6 K_B - 10 log10(wavelength) - 64 dB with the Beaufort
number K_B (Barton, Modern Radar System Analysis, 3.6), falling with the fourth power of the grazing
angle below the critical angle, wavelength / (4 pi rms wave height). Shape of the K distribution:
log10 nu = 2/3 log10(grazing in deg) + 5/8 log10(area) - 2.09 (Ward, Tough, Watts, Sea Clutter, 2nd
ed., 2.9, horizontal polarisation).

Rain: Z = 200 rate^1.6, eta = pi^5 |K|^2 Z / wavelength^4 (Skolnik, Radar Handbook, 19.3).
"""

import math

import numpy as np

from ..types import Array

LIGHT = 299_792_458.0  # m/s
FREQUENCY = 9.41e9  # Hz
WAVELENGTH = LIGHT / FREQUENCY
GAIN, NOISE_FIGURE, LOSSES = 1e3, 10**0.4, 10**0.5
THERMAL = 1.380649e-23 * 290.0  # W/Hz
HEIGHT = 15.0  # m, of the antenna
VERTICAL_BEAM = math.radians(22.0)
RAIN_TOP = 3000.0  # m
# Significant wave height, m, by sea state 0 to 8 (WMO code 3700, upper thirds).
WAVE_HEIGHT = (0.0, 0.1, 0.4, 0.9, 1.9, 3.2, 5.0, 7.5, 11.5)


def point_factor(power: float, pulse: float) -> float:
    """m^2: what a cross section of 1 m^2 at 1 m gives, over noise; divide by R^4.

    power W of the transmitter; pulse m, depth of a range cell
    """
    bandwidth = LIGHT / (2 * pulse)
    noise = THERMAL * NOISE_FIGURE * bandwidth
    return power * GAIN**2 * WAVELENGTH**2 / ((4 * math.pi) ** 3 * noise * LOSSES)


def ship_section(length: Array, aspect: Array) -> Array:
    """Cross section m^2 of ships of a length m, seen at an aspect rad from the bow."""
    kilotons = 8.0 * (length / 100.0) ** 3
    median = 52.0 * math.sqrt(FREQUENCY * 1e-6) * kilotons**1.5
    abeam = 6.0 * np.exp(-((np.cos(aspect) / 0.2) ** 2))
    ends = 1.5 * np.exp(-((np.sin(aspect) / 0.15) ** 2))
    section: Array = median * (0.6 + abeam + ends)
    return section


def cell_area(range_: Array, beam: float, pulse: float) -> Array:
    """m^2 of the sea within beam and pulse, two ways."""
    area: Array = range_ * beam / math.sqrt(2) * pulse
    return area


def sea(range_: Array, beam: float, pulse: float, state: float) -> tuple[Array, Array]:
    """Mean cross section m^2 of the sea in a cell at ranges [B] m, and the shape nu [B]."""
    grazing = np.minimum(HEIGHT / np.maximum(range_, HEIGHT), 1.0)
    beaufort = state + 1.0
    gamma = 10 ** (0.1 * (6 * beaufort - 10 * math.log10(WAVELENGTH) - 64))
    rms = float(np.interp(state, np.arange(9), WAVE_HEIGHT)) / 4
    critical = WAVELENGTH / (4 * math.pi * max(rms, 1e-3))
    area = cell_area(range_, beam, pulse)
    reflectivity = gamma * grazing / (1 + (critical / grazing) ** 4)
    degrees = np.degrees(grazing)
    shape = 10 ** (2 / 3 * np.log10(degrees) + 5 / 8 * np.log10(area) - 2.09)
    return reflectivity * area, np.clip(shape, 0.1, 100.0)


def rain(range_: Array, beam: float, pulse: float, rate: float) -> Array:
    """Mean cross section m^2 of rain of `rate` mm/h in a cell at ranges [B] m."""
    reflectivity = math.pi**5 * 0.93 * 200.0 * rate**1.6 * 1e-18 / WAVELENGTH**4
    height = np.minimum(range_ * VERTICAL_BEAM / math.sqrt(2), RAIN_TOP)
    volume: Array = cell_area(range_, beam, pulse) * height
    return reflectivity * volume
