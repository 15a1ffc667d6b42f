import numpy as np
import pytest

from marine_tracker.tracking import detection_map


def taught(rng, scans, chance, range_, bearing, known=None):
    """The map after scans of ten targets near one place, seen with this chance."""
    known = detection_map.empty() if known is None else known
    for _ in range(scans):
        about = range_ * rng.uniform(0.95, 1.05, 10), bearing + rng.uniform(-0.05, 0.05, 10)
        known = detection_map.learn(known, *about, rng.random(10) < chance)
    return known


def at(known, range_, bearing, prior=0.8):
    return detection_map.probability(known, np.array([range_]), np.array([bearing]), prior)[0]


def test_nothing_known_is_the_prior():
    assert at(detection_map.empty(), 3000.0, 1.0, 0.7) == pytest.approx(0.7)


def test_how_targets_show_is_learnt_where_they_are():
    rng = np.random.default_rng(1)
    known = taught(rng, 200, 0.55, 3500.0, 1.0)
    assert at(known, 3400.0, 1.02) == pytest.approx(0.55, abs=0.08)  # of some 400 looks
    assert at(known, 3500.0, 4.0) == at(known, 900.0, 1.0) == pytest.approx(0.8)


def test_what_has_changed_is_forgotten():
    rng = np.random.default_rng(2)
    known = taught(rng, 200, 0.5, 800.0, 6.1)
    known = taught(rng, 300, 0.95, 800.0, 6.1, known)
    assert at(known, 800.0, 6.1) == pytest.approx(0.95, abs=0.05)


def test_a_few_looks_tell_little():
    known = detection_map.learn(
        detection_map.empty(), np.array([500.0]), np.array([2.0]), np.array([False])
    )
    assert at(known, 500.0, 2.0) == pytest.approx(0.8 * 30 / 31)
