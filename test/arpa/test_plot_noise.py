"""The scatter of plots, learned: against known noise, in turns, with gaps, without any."""

import numpy as np
import pytest

from marine_tracker.arpa import plot_noise
from marine_tracker.geometry import polar_to_position, to_range_bearing, unit_vector
from marine_tracker.types import Plots

RANGE, BEARING = 15.0, 0.005  # configured: m, rad


def plots_of(position, time):
    distance, bearing = to_range_bearing(position)
    offset, covariance = polar_to_position(distance, bearing, RANGE, BEARING)
    count = len(position)
    return Plots(
        np.broadcast_to(time, count).astype(float),
        distance,
        bearing,
        np.zeros(count),
        np.zeros((count, 2)),
        position,
        covariance,
    )


def observe(tracks, times, glint=0.0):
    """tracks [scans, N, 2]; the last scatter, covariances, and the product of the stretches."""
    scatter, product = plot_noise.begin(tracks.shape[1]), np.eye(2)
    for position, time in zip(tracks, times):
        scatter, covariance, stretch = plot_noise.observe(scatter, plots_of(position, time), glint)
        product = stretch @ product
    return scatter, covariance, product


def noisy(truth, along, across, rng):
    """Truth [scans, N, 2] with errors along and across the line of sight, m."""
    unit = unit_vector(to_range_bearing(truth)[1])
    side = np.stack([unit[..., 1], -unit[..., 0]], -1)
    errors = rng.standard_normal(truth.shape) * [along, across]
    return truth + errors[..., :1] * unit + errors[..., 1:] * side


def straight(scans, tracks, velocity=(4.0, -6.0)):
    times = np.arange(scans) * 2.7
    return times, np.tile(
        np.array([3000.0, 4000.0]) + times[:, None] * velocity, (tracks, 1, 1)
    ).transpose(1, 0, 2)


@pytest.mark.parametrize(('along', 'across'), [(45.0, 12.0), (15.0, 25.0), (8.0, 60.0)])
def test_scatter_is_learned_along_and_across(along, across):
    """200 tracks, 200 scans: the mean deviation within 10 %, configured 15 m and 25 m or so."""
    times, truth = straight(200, 200, velocity=(0.4, -0.6))
    tracks = noisy(truth, along, across, np.random.default_rng(1))
    _, covariance, _ = observe(tracks, times)
    unit = unit_vector(to_range_bearing(truth[-1])[1])
    side = np.stack([unit[:, 1], -unit[:, 0]], -1)
    found = [
        np.sqrt(np.einsum('ni,nij,nj->n', axis, covariance, axis).mean()) for axis in (unit, side)
    ]
    assert found == pytest.approx([along, across], rel=0.1)


def test_a_turn_is_no_scatter():
    """8 m/s, 2 deg/s, straight after 45 scans: as on a straight course within 5 %."""
    rng = np.random.default_rng(2)
    times, truth = straight(60, 300)
    course = np.radians(np.clip(times - 40, 0, 90) * 2)
    way = np.cumsum(8 * 2.7 * unit_vector(course), 0)
    errors = noisy(truth, 20, 20, rng) - truth
    turning = truth[:1] + way[:, None] + errors
    on = np.trace(observe(truth + errors, times)[1], axis1=1, axis2=2).mean()
    turned = np.trace(observe(turning, times)[1], axis1=1, axis2=2).mean()
    assert turned == pytest.approx(on, rel=0.05)


def test_before_the_third_plot_the_configured_noise_holds():
    times, truth = straight(2, 1)
    scatter, covariance, product = observe(truth, times, glint=20.0)
    expected = plots_of(truth[-1], 0.0).covariance + 400 * np.eye(2)
    np.testing.assert_allclose(covariance, expected)
    np.testing.assert_allclose(product[0], np.eye(2), atol=1e-12)
    assert scatter.plots[0] == plot_noise.BEGIN


def test_plots_that_never_move_leave_a_share_of_the_configured_noise():
    """A moored target of a radar that quantises: no noise seen at all, and still no certainty."""
    position = np.tile(np.array([[[3000.0, 4000.0]]]), (600, 1, 1))
    _, covariance, _ = observe(position, np.arange(600) * 2.7)
    configured = plots_of(position[0], 0.0).covariance
    np.testing.assert_allclose(covariance, plot_noise.SHARE * configured, rtol=0.01)


def test_gaps_and_repeated_times_tell_nothing():
    """A manoeuvre unseen in a gap, or two plots of one moment, are no measure of noise."""
    times, truth = straight(10, 1)
    scatter, _, _ = observe(truth, times)
    away = truth[-1] + [900.0, 900.0]
    late, _, _ = plot_noise.observe(scatter, plots_of(away, times[-1] + 30.0), 0.0)
    np.testing.assert_array_equal(late.ratio, scatter.ratio)
    again, _, _ = plot_noise.observe(late, plots_of(away, times[-1] + 30.0), 0.0)
    after, _, _ = plot_noise.observe(again, plots_of(away, times[-1] + 33.0), 0.0)
    np.testing.assert_array_equal(after.ratio, again.ratio)


def test_one_wrong_plot_counts_little():
    times, truth = straight(80, 1)
    tracks = noisy(truth, 15, 25, np.random.default_rng(3))
    sound = np.trace(observe(tracks, times)[1][0])
    tracks[60] += 2000.0
    wrong = np.trace(observe(tracks, times)[1][0])
    assert wrong < 1.6 * sound


def test_the_stretches_lead_from_the_configured_errors_to_those_found():
    times, truth = straight(40, 3)
    tracks = noisy(truth, 40, 10, np.random.default_rng(4))
    tracks = truth[:1] + (tracks - truth)  # at rest: the line of sight stays
    _, covariance, product = observe(tracks, times)
    configured = plots_of(truth[0], 0.0).covariance
    rebuilt = product @ configured @ product.swapaxes(1, 2)
    np.testing.assert_allclose(rebuilt, covariance, rtol=0.15, atol=20.0)
