import numpy as np
import pytest

from marine_tracker.lab.gwnn_paper.frame import (
    estimated_bounds,
    measured_bounds,
    spectrum,
    width_exponent,
)
from marine_tracker.networks.wavelets import wavelet


def test_the_spectrum_is_the_fourier_transform_of_the_wavelet():
    t = np.linspace(-60, 60, 60001)
    for q in (0.3, 1.2):
        for w in (0.05, 0.7, 1.9, -3.3):
            direct = np.trapezoid(wavelet(t, q) * np.sin(w * t), t)
            assert abs(direct) == pytest.approx(abs(spectrum(w, q)), rel=1e-6, abs=1e-9)
    assert spectrum(0.0, 1.2) == 0.0
    assert spectrum(1e5, 1.2) == 0.0


def test_the_published_limit_of_the_spacing_is_that_of_the_estimate():
    low, high = estimated_bounds(0.5, 3.5)
    assert 0 < low < high
    assert estimated_bounds(0.5, 4.0)[0] < 0


@pytest.mark.parametrize('q, b', [(0.5, 0.5), (0.5, 1.0), (1.2, 1.0), (1.2, 3.5), (1.2, 4.0)])
def test_the_frame_operator_lies_within_the_bounds_over_both_signs(q, b):
    low, high = estimated_bounds(q, b, both_signs=True)
    lowest, highest = measured_bounds(q, b)
    slack = 0.002 * high  # of grid, circle and levels left out
    assert low - slack <= lowest < highest <= high + slack


def test_over_positive_frequencies_alone_the_estimate_is_no_bound():
    assert estimated_bounds(1.2, 4.0)[0] > 1.1 * measured_bounds(1.2, 4.0)[0]
    assert estimated_bounds(0.5, 3.5)[1] < measured_bounds(0.5, 3.5)[1]


def test_wavelets_four_apart_are_a_frame_all_the_same():
    """The estimate's A is negative there; a wider circle does not bring the eigenvalue to 0."""
    narrow, wide = (measured_bounds(0.5, 4.0, octaves)[0] for octaves in (4, 5))
    assert 0.5 < wide < 1.1 * narrow


def test_a_frame_sampled_densely_is_tight():
    low, high = estimated_bounds(1.2, 0.5)
    assert high / low < 1.01


def test_the_width_grows_by_octaves_with_the_signals_band():
    """A signal up to four times the wavelets' highest frequency asks for q0 = 2."""
    assert width_exponent((0.5, 8.0), (0.5, 2.0)) == 2
    assert width_exponent((2.0, 2.0), (0.5, 2.0)) == 2
    assert width_exponent((0.5, 2.0), (0.5, 2.0)) == 0
    assert width_exponent((0.01, 0.02), (0.5, 2.0)) == -5
    with pytest.raises(ValueError, match='frequency 0 in eq 23'):
        width_exponent((0.0, 1.0), (0.5, 2.0))
