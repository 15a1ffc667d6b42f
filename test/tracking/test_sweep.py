import numpy as np
import pytest

from marine_tracker.geometry import wrap_angle
from marine_tracker.tracking.sweep import Sweep, sweep_of
from marine_tracker.types import OwnShip, PolarPlots, Scan

PERIOD = 60 / 22
OWN = OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))


def scan_of(start, bearing, time, period=PERIOD):
    count = len(bearing)
    return Scan(
        start,
        start + period,
        PolarPlots(
            np.asarray(time, float),
            np.full(count, 1000.0),
            np.mod(bearing, 2 * np.pi),
            np.zeros(count),
        ),
        OWN,
    )


@pytest.mark.parametrize('bearing0', [0.0, 1.0, 3.2, 6.28, np.pi])
@pytest.mark.parametrize('count', [1, 2, 40])
def test_where_the_beam_started_is_read_off_the_plots(bearing0, count):
    """With the bearing noise of 0.5 deg; the mean of n plots knows it to 4 x 0.5 / sqrt(n)."""
    rng = np.random.default_rng(count)
    turned = rng.uniform(0, 2 * np.pi, count)
    bearing = bearing0 + turned + np.radians(rng.normal(0, 0.5, count))
    sweep = sweep_of(scan_of(100.0, bearing, 100.0 + PERIOD * turned / (2 * np.pi)))
    assert sweep.start == 100.0 and sweep.period == pytest.approx(PERIOD)
    assert abs(wrap_angle(sweep.bearing0 - bearing0)) < np.radians(2.0) / np.sqrt(count)


def test_the_beam_turns_clockwise_once_a_period():
    sweep = Sweep(10.0, 4.0, np.radians(350.0))
    time = sweep.time_at(np.radians([350.0, 80.0, 170.0, 260.0, 349.999]))
    assert time == pytest.approx([10.0, 11.0, 12.0, 13.0, 14.0], abs=1e-4)


def test_every_plot_was_passed_at_its_own_time():
    rng = np.random.default_rng(0)
    turned = rng.uniform(0.01, 2 * np.pi - 0.01, 30)
    time = 5.0 + PERIOD * turned / (2 * np.pi)
    scan = scan_of(5.0, turned + 2.0, time)
    assert sweep_of(scan).time_at(scan.plots.bearing) == pytest.approx(time)


@pytest.mark.parametrize('case', ['no plots', 'one time', 'counter-clockwise', 'random times'])
def test_where_times_do_not_follow_the_beam_the_middle_of_the_scan_counts(case):
    rng = np.random.default_rng(1)
    turned = np.linspace(0, 6, 50)
    time = 5.0 + PERIOD * turned / (2 * np.pi)
    scan = {
        'no plots': lambda: scan_of(5.0, [], []),
        'one time': lambda: scan_of(5.0, turned, np.full(50, 5.0), period=0.0),
        'counter-clockwise': lambda: scan_of(5.0, -turned, time),
        'random times': lambda: scan_of(5.0, turned, 5.0 + PERIOD * rng.random(50)),
    }[case]()
    sweep = sweep_of(scan)
    middle = 0.5 * (scan.start + scan.end)
    assert sweep.period == 0.0
    assert sweep.time_at(np.array([0.0, 2.0, 6.0])) == pytest.approx([middle] * 3)
