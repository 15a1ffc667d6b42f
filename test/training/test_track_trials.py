"""Estimators over many tracks at once, and ratios of their errors."""

import numpy as np

from marine_tracker.training import track_trials


def test_a_ratio_and_its_interval():
    """Two estimators with errors of known size: 0.8, known to 1 / sqrt(4 * 400 * 50)."""
    rng = np.random.default_rng(10)
    one, other = (np.square(rng.normal(0, s, (400, 50, 2))).sum(2) for s in (0.8, 1.0))
    found = track_trials.ratio(one, other, np.ones((400, 50), bool), rng)
    assert found.low < 0.8 < found.high
    assert found.high - found.low < 0.03
