import numpy as np
import pytest

from marine_tracker.estimators.polar_motion import to_ground, to_polar


@pytest.fixture
def mean():
    rng = np.random.default_rng(1)
    return np.concatenate([rng.uniform(-9000, 9000, (40, 2)), rng.uniform(-20, 20, (40, 2))], 1)


ORIGIN = np.tile([300.0, -200.0], (40, 1))


def test_there_and_back_nothing_changes(mean):
    polar, by_mean = to_polar(mean, ORIGIN)
    again, by_polar = to_ground(polar, ORIGIN)
    np.testing.assert_allclose(again, mean, atol=1e-9)
    np.testing.assert_allclose(by_mean @ by_polar, np.tile(np.eye(4), (40, 1, 1)), atol=1e-9)


def test_rates_are_what_range_and_bearing_change_by(mean):
    polar, _ = to_polar(mean, ORIGIN)
    step = 1e-3
    ahead, behind = (
        to_polar(mean + np.c_[s * mean[:, 2:], np.zeros((40, 2))], ORIGIN)[0] for s in (step, -step)
    )
    np.testing.assert_allclose((ahead - behind)[:, 0] / (2 * step), polar[:, 1], atol=1e-5)
    turned = np.angle(np.exp(1j * (ahead - behind)[:, 2]))
    np.testing.assert_allclose(turned / (2 * step), polar[:, 3], atol=1e-9)


@pytest.mark.parametrize('column', range(4))
def test_derivatives_are_those_of_small_differences(mean, column):
    size = 1e-3
    moved = mean.copy()
    moved[:, column] += size
    one, by_mean = to_polar(mean, ORIGIN)
    two, _ = to_polar(moved, ORIGIN)
    apart = two - one
    apart[:, 2] = np.angle(np.exp(1j * apart[:, 2]))
    np.testing.assert_allclose(apart / size, by_mean[:, :, column], rtol=1e-3, atol=1e-6)


def test_a_target_on_own_ship_has_no_endless_bearing_rate():
    polar, by_mean = to_polar(np.array([[300.0, -200.0, 5.0, 5.0]]), ORIGIN[:1])
    assert np.isfinite(polar).all() and np.isfinite(by_mean).all()
