import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters
from marine_tracker.tracking.noise import noise_of
from marine_tracker.types import OwnShip, PolarPlots, Scan


def scan_of(distance, bearing, covariance=None):
    none, still = np.zeros(len(distance)), np.zeros((1, 2))
    plots = PolarPlots(none, distance, bearing, none, covariance=covariance)
    return Scan(0.0, 2.5, plots, OwnShip(np.zeros(1), still, still))


@pytest.mark.parametrize('glint', [0.0, 18.0])
def test_the_variance_of_a_plot_is_the_trace_of_its_covariance(glint):
    """To first order in the bearing's noise, with glint along both axes."""
    distance, bearing = np.array([400.0, 3000.0, 11000.0]), np.array([0.3, 2.0, 5.5])
    scan = scan_of(distance, bearing)
    noise = noise_of(
        TrackerParameters(range_sigma_m=12.0, bearing_sigma_deg=0.3, glint_sigma_m=glint), scan
    )
    covariance = noise.with_glint(noise.locate(scan)).covariance
    trace = np.trace(covariance, axis1=1, axis2=2)
    np.testing.assert_allclose(noise.variance(distance), trace, rtol=1e-3)


def test_the_least_certain_of_plots_that_tell_their_own_noise_is_known():
    told = np.stack([np.diag([4.0, 5.0]), np.diag([90.0, 54.0]), np.diag([1.0, 100.0])])
    distance = np.array([800.0, 900.0, 1000.0])
    noise = noise_of(TrackerParameters(), scan_of(distance, 0 * distance, told))
    assert noise.widest == pytest.approx(12.0)
    assert noise_of(TrackerParameters(), scan_of(distance, 0 * distance)).widest == 0.0
    none = scan_of(np.zeros(0), np.zeros(0), np.zeros((0, 2, 2)))
    assert noise_of(TrackerParameters(), none).widest == 0.0
