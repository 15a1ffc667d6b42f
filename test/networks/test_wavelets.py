import numpy as np
import pytest
from scipy.optimize import brentq

from marine_tracker.networks.wavelets import (
    hidden,
    scaling,
    scaling_slope,
    sigmoid,
    sigmoid_slope,
    slope,
    steepest,
    units,
    wavelet,
    wavelet_slope,
)

T = np.linspace(-12, 12, 2401)
WIDTHS = [0.2, 0.5, 1.2, 3.0]


@pytest.mark.parametrize('q', WIDTHS)
@pytest.mark.parametrize(
    'function, derivative',
    [(sigmoid, sigmoid_slope), (scaling, scaling_slope), (wavelet, wavelet_slope)],
)
def test_slopes_agree_with_finite_differences(function, derivative, q):
    h = 1e-5
    found = (function(T + h, q) - function(T - h, q)) / (2 * h)
    np.testing.assert_allclose(derivative(T, q), found, atol=2e-9 / q**3)


def test_a_wavelet_has_zero_mean_and_a_scaling_function_the_mean_4d():
    t = np.linspace(-60, 60, 200001)
    assert abs(np.trapezoid(wavelet(t, 1.2), t)) < 1e-9
    assert np.trapezoid(scaling(t, 1.2), t) == pytest.approx(4.0)


def test_units_are_the_dilated_and_translated_functions_in_order():
    form = units(2, 5, 1.2, spacing=0.8, groups=2)
    net = np.linspace(-9, 9, 41)[:, None] * np.ones(40)
    expected = []
    for m, function in ((2, scaling), (0, wavelet), (1, wavelet), (2, wavelet)):
        for k in (-2, -1, 0, 1, 2):
            expected.append(2 ** (-m / 2) * function(2.0**-m * net[:, 0] - 0.8 * k, 1.2))
    np.testing.assert_allclose(hidden(form, net)[0], np.tile(np.stack(expected, 1), 2), atol=1e-14)


@pytest.mark.parametrize('q', WIDTHS)
def test_slopes_of_units_agree_with_finite_differences(q):
    form = units(2, 3, q)
    net, h = np.linspace(-9, 9, 301)[:, None] * np.ones(12), 1e-5
    found = (hidden(form, net + h)[0] - hidden(form, net - h)[0]) / (2 * h)
    np.testing.assert_allclose(slope(form, *hidden(form, net)), found, atol=4e-9 / q**3)


@pytest.mark.parametrize('dtype', [np.float32, np.float64])
def test_units_take_any_leading_axes_keep_the_precision_and_vanish_far_out(dtype):
    form = units(1, 3, 0.2, dtype=dtype)
    net = np.random.default_rng(1).normal(size=(4, 2, 9)).astype(dtype)
    value, tanh = hidden(form, net)
    assert value.dtype == slope(form, value, tanh).dtype == dtype
    np.testing.assert_array_equal(value[3, 1], hidden(form, net[3, 1])[0])
    for far in (-1e30, 1e30):
        value, tanh = hidden(form, np.full(9, far, dtype))
        np.testing.assert_array_equal(value, 0.0)
        np.testing.assert_array_equal(slope(form, value, tanh), 0.0)


def test_the_steepest_wavelet_is_as_steep_as_the_sigmoid_at_one_over_q_of_8814():
    """The paper prints 0.9 for atanh(1 / sqrt 2)."""
    found = brentq(lambda ratio: steepest(1 / ratio) * 2 / ratio - 1, 0.5, 1.5)
    assert found == pytest.approx(0.8814, abs=0.0005)
    for q in WIDTHS:
        assert steepest(q) == pytest.approx(np.abs(wavelet_slope(T, q)).max(), rel=1e-6)
        assert steepest(q) == pytest.approx(np.tanh(1 / q) ** 2 / q, rel=1e-9)


def test_the_steepest_point_is_found_off_the_centre_too():
    """With p well beyond d the two bumps of psi part, and psi is flat at 0."""
    t = np.linspace(-20, 20, 400001)
    assert steepest(0.5, 1.0, 4.0) == pytest.approx(
        np.abs(wavelet_slope(t, 0.5, 1.0, 4.0)).max(), rel=1e-7
    )


@pytest.mark.parametrize(
    'arguments, text',
    [
        ((-1, 5, 1.2), 'levels'),
        ((1, 0, 1.2), 'translations'),
        ((1, 5, 0.0), 'width q is 0'),
        ((1, 5, float('nan')), 'width q is nan'),
        ((1, 5, 1.2, 3.6), 'spacing b is 3.6'),
    ],
)
def test_a_wrong_figure_is_named(arguments, text):
    with pytest.raises(ValueError, match=text):
        units(*arguments)
