import numpy as np
import pytest
from scipy.stats import multivariate_normal

from marine_tracker.tracking import existence
from marine_tracker.tracking.gate import Pairs


def one_pair(off, spread):
    """A pair with the innovation off [2] of covariance spread [2, 2]."""
    nis = off @ np.linalg.solve(spread, off)
    return nis, np.linalg.slogdet(spread)[1]


@pytest.mark.parametrize('seed', range(10))
def test_a_scan_is_weighed_as_bayes_would(seed):
    """One track, alone, with three plots in its gate: against all that may have happened."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(2, 2)) * 30
    spread = root @ root.T + 20 * np.eye(2)
    off = rng.normal(0, 20, (3, 2))
    columns = np.array([one_pair(z, spread) for z in off]).T
    pairs = Pairs(np.zeros(3, np.int64), np.arange(3), *columns)
    density = 10 ** rng.uniform(-6, -3, 3)
    detected, gate = 0.7, 0.98
    ratio = existence.ratio(
        pairs, np.array([1]), existence.likelihood(pairs, density), np.array([detected]), gate, 3
    )
    # Missed, or outside the gate; or one of the three is the target's, and not one of clutter.
    expected = 1 - detected * gate
    for z, clutter in zip(off, density):
        expected += detected * multivariate_normal([0, 0], spread).pdf(z) / clutter
    assert ratio == pytest.approx([expected])
    before = rng.uniform(0.05, 0.95)
    survived = before * existence.SURVIVAL
    after = existence.after(np.array([before]), ratio, np.array([True]))
    assert after == pytest.approx([survived * expected / (survived * expected + 1 - survived)])


def test_a_plot_that_another_track_took_does_not_count():
    nis, log_det = np.full(3, 1.0), np.full(3, 6.0)
    pairs = Pairs(np.array([0, 1, 1]), np.array([0, 0, 1]), nis, log_det)
    likelihood = existence.likelihood(pairs, np.full(2, 1e-5))
    detected = np.full(2, 0.8)
    found = existence.ratio(pairs, np.array([0, -1]), likelihood, detected, 0.99, 2)
    assert found[0] == found[1]  # each has one plot to itself
    alone = existence.ratio(pairs, np.array([0, 1]), likelihood, detected, 0.99, 2)
    assert alone == pytest.approx(found)


def test_where_the_radar_cannot_see_nothing_changes():
    before = np.array([0.2, 0.9])
    found = existence.after(before, np.array([0.1, 0.1]), np.array([False, True]))
    assert found[0] == 0.2 and found[1] < 0.9
