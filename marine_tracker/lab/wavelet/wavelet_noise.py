"""Estimates the noise of a running series from its finest wavelet details."""

import numpy as np
import pywt
from numpy.lib.stride_tricks import sliding_window_view

from ...types import Array

NORMAL = 0.6745  # median of |z| of a normal z of deviation 1


def noise_deviation(series: Array, wavelet: str = 'db2') -> Array:
    """Deviation [...] of the white noise in evenly spaced series [..., K], e.g. ranges in m.

    The finest details of a smooth motion are noise. Their median size is robust: a few wild plots
    do not change it, unlike a mean of squares (Donoho and Johnstone 1994). ValueError if K is
    shorter than the wavelet's filter.
    """
    high = np.array(pywt.Wavelet(wavelet).dec_hi)
    if np.shape(series)[-1] < len(high):
        raise ValueError(f'a series of {np.shape(series)[-1]}; {wavelet} needs {len(high)}')
    details = sliding_window_view(series, len(high), -1) @ high[::-1]
    return np.median(np.abs(details), -1) / NORMAL
