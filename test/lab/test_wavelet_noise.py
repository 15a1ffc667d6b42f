import numpy as np
import pytest

from marine_tracker.lab.wavelet.wavelet_noise import noise_deviation


@pytest.mark.parametrize('wavelet', ['haar', 'db2', 'db4'])
def test_white_noise_on_a_slope_is_found(wavelet):
    """2,000 series of 256: the mean is within 2 % (a median of some 250 details is off by 1 %)."""
    rng = np.random.default_rng(1)
    series = 3000 + 2.0 * np.arange(256) + rng.normal(0, 15, (2000, 256))
    assert noise_deviation(series, wavelet).mean() == pytest.approx(15, rel=0.02)


def test_a_slope_without_noise_has_none():
    assert noise_deviation(3000 + 8.0 * np.arange(40)) == pytest.approx(0, abs=1e-9)


def test_wild_plots_hardly_count():
    """5 % wild plots of ten deviations more than double the root mean square."""
    rng = np.random.default_rng(2)
    noise = rng.normal(0, 15, (500, 64))
    noise += rng.normal(0, 150, noise.shape) * (rng.random(noise.shape) < 0.05)
    assert noise.std() > 2 * 15
    assert noise_deviation(noise).mean() < 1.3 * 15


def test_too_short_a_series_is_refused():
    with pytest.raises(ValueError, match='series of 3; db2 needs 4'):
        noise_deviation(np.zeros(3))
