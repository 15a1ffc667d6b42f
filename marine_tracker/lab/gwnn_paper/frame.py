"""The affine frame of the wavelets psi_mk (paper 000, eq 14 and 23): spectrum and frame bounds.

The paper takes from Pati and Krishnaprasad (1993) that psi_mk = a^(-m/2) psi(a^-m t - k b) is a
frame of L2 for a = 2, 0 < b <= 3.5. Their sigmoid is the one with q = 0.5 here.
"""

import numpy as np

from ...networks.wavelets import DILATION, D, P
from ...types import Array


def spectrum(frequency: float | Array, q: float, d: float = D, p: float = P) -> Array:
    """PSI(w) = 8 pi q sin(w d) sin(w p) / sinh(pi q w) for w [...] rad, odd.

    The Fourier transform of psi, without the factor i.
    """
    w = np.asarray(frequency, float)
    decay = np.pi * q * np.abs(w)
    # sinh written so that it cannot overflow.
    with np.errstate(divide='ignore', invalid='ignore'):
        size = 16 * np.pi * q * np.exp(-decay) / -np.expm1(-2 * decay)
        return np.where(w == 0, 0.0, np.sign(w) * np.sin(w * d) * np.sin(w * p) * size)


def estimated_bounds(
    q: float, b: float, a: float = DILATION, both_signs: bool = False
) -> tuple[float, float]:
    """Frame bounds (A, B) of the psi_mk, d = p = 1, as estimated by Daubechies' theorem.

        A, B = (1/b) (inf, sup_w sum_m |PSI(a^m w)|^2  -, +  2 sum_k [beta(s_k) beta(-s_k)]^(1/2))
        beta(s) = sup_w sum_m |PSI(a^m w) PSI(a^m w + s)|,  s_k = 2 pi k / b,  k = 1, 2, ...

    The theorem takes the supremum over w of both signs. That gives a true bound, but a loose one
    (see `measured_bounds`). The default takes positive w only. It reproduces the published limit: A
    turns negative between b = 3.5 and 4 at q = 0.5. That is an estimate, not a bound.
    """
    # One octave is enough: the sums do not change by w -> a w. Up to 60 / q, where PSI is
    # negligible.
    highest = int(np.ceil(np.log(60 / q) / np.log(a)))
    scales = a ** np.linspace(0, 1, 801) * a ** np.arange(-30.0, highest)[:, None]
    own = np.abs(spectrum(scales, q))
    power = (own * own).sum(0)

    def leak(s):
        return (own * np.abs(spectrum(scales + s, q))).sum(0).max()

    cross = 0.0
    for k in range(1, 1000):
        right, left = leak(2 * np.pi * k / b), leak(-2 * np.pi * k / b)
        term = 2 * (max(right, left) if both_signs else np.sqrt(right * left))
        cross += term
        if term < 1e-9 * cross:
            break
    return float((power.min() - cross) / b), float((power.max() + cross) / b)


def measured_bounds(q: float, b: float, octaves: int = 5) -> tuple[float, float]:
    """Lowest and highest eigenvalue of the frame operator of the psi_mk, a = 2, d = p = 1.

    The operator acts on a circle of length 2^octaves b. It is restricted to the trigonometric
    polynomials between the circle's eighth harmonic and frequency 32 pi / b. So the true A of the
    frame is at most the first value, and its B is at least the second.
    """
    length, half = 2**octaves * b, 2**octaves * 16
    harmonic = np.concatenate([np.arange(-half, -7), np.arange(8, half)])
    apart = harmonic[:, None] - harmonic
    operator = np.zeros(apart.shape)
    for level in range(-12, octaves + 1):
        translations = 2.0 ** (octaves - level)  # of this level around the circle
        psi = spectrum(2.0**level * 2 * np.pi * harmonic / length, q)
        # The sum over the translations leaves only harmonics that differ by a multiple of their
        # number.
        operator += np.where(
            apart % translations == 0, 2.0**level * translations / length * np.outer(psi, psi), 0.0
        )
    values = np.linalg.eigvalsh(operator)
    return float(values[0]), float(values[-1])


def width_exponent(
    signal_band: tuple[float, float], wavelet_band: tuple[float, float], a: float = DILATION
) -> int:
    """q0 of eq 23. By the paper, with q > a^q0 the wavelets' spectra cover the signal's.

    signal_band   (w0, w1)        rad, lowest and highest frequency of the signal
    wavelet_band  (w_min, w_max)  rad, those of psi
    int[] is read as truncation. ValueError if a frequency is not positive.
    """
    (w0, w1), (low, high) = signal_band, wavelet_band
    for value in (w0, w1, low, high):
        if not value > 0:
            raise ValueError(f'frequency {value:g} in eq 23; it must be above 0')
    return max(int(np.log(w1 / high) / np.log(a)), int(np.log(w0 / low) / np.log(a)))
