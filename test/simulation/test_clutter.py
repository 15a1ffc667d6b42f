import numpy as np
import pytest

from marine_tracker.simulation.radar import simulate

SCANS = 440


@pytest.fixture
def false_plots(make_scenario):
    """Counts, ranges and bearings of the false plots of 440 scans."""

    def make(**clutter):
        loaded = make_scenario(
            duration_s=1200,
            clutter=clutter,
            radar={'blind_range_m': 500, 'max_range_m': 10000},
            targets=[{'start': {'range_m': 3000, 'bearing_deg': 0}, 'speed_kn': 0, 'pd': 0}],
        )
        plots = [scan.plots for scan, _ in simulate(loaded, 1)]
        return (
            np.array([len(p.time) for p in plots]),
            np.concatenate([p.range for p in plots]),
            np.concatenate([p.bearing for p in plots]),
        )

    return make


@pytest.mark.parametrize(
    'clutter, mean',
    [
        ({'uniform': 60}, 60),
        ({'sea': 90, 'sea_scale_m': 2000}, 90),
        ({'uniform': 30, 'sea': 25}, 55),
        ({}, 0),
    ],
)
def test_numbers_are_poisson_of_the_stated_mean(false_plots, clutter, mean):
    counts, _, _ = false_plots(**clutter)
    assert counts.mean() == pytest.approx(mean, abs=4.5 * np.sqrt(mean / SCANS))
    # The variance of a Poisson number's sample variance is about 2 mean^2 / SCANS.
    assert counts.var() == pytest.approx(mean, abs=4.5 * mean * np.sqrt(2 / SCANS) + 1e-9)


def test_uniform_plots_are_even_over_the_area(false_plots):
    _, distance, bearing = false_plots(uniform=60)
    area = (distance**2 - 500**2) / (10000**2 - 500**2)
    assert_uniform(area)
    assert_uniform(bearing / (2 * np.pi))


def test_sea_clutter_is_denser_near_own_ship_and_even_in_bearing(false_plots):
    _, distance, bearing = false_plots(sea=60, sea_scale_m=2000)
    assert distance.min() >= 500
    assert distance.max() <= 10000
    assert_uniform(-np.expm1(-(distance - 500) / 2000) / -np.expm1(-9500 / 2000))
    assert_uniform(bearing / (2 * np.pi))
    density, _ = np.histogram(distance, [500, 1500, 3000, 6000, 10000])
    density = density / np.diff(np.square([500, 1500, 3000, 6000, 10000]))
    assert (np.diff(density) < 0).all()


def test_false_plots_are_stamped_when_the_beam_points_at_them(make_scenario):
    loaded = make_scenario(
        clutter={'uniform': 100},
        targets=[{'start': {'range_m': 3000, 'bearing_deg': 0}, 'speed_kn': 0, 'pd': 0}],
    )
    scan, _ = next(simulate(loaded, 1))
    sweep = 2 * np.pi * (scan.plots.time - scan.start) / (scan.end - scan.start)
    assert scan.plots.bearing == pytest.approx(sweep)
    assert scan.plots.amplitude.min() >= 13


def assert_uniform(values):
    """Kolmogorov's distance from the even distribution on [0, 1], exceeded by 1 in 10^6 seeds."""
    values = np.sort(values)
    distance = np.abs(values - (np.arange(len(values)) + 0.5) / len(values)).max()
    assert distance < 2.7 / np.sqrt(len(values))
