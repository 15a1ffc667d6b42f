import numpy as np

from marine_tracker.video import level, tail


def test_a_shower_beside_a_spiky_sea_has_the_threshold_of_a_shower():
    """The same range, the same level: the one scatters as noise does, the other far more."""
    random = np.random.default_rng(6)
    of, step = level.of_edges(4, np.arange(128, 257, 8) - 128), level.scale(255)
    shape = (2000, 128)
    shower = random.standard_exponential(shape)
    sea = random.standard_exponential(shape) * random.standard_gamma(0.4, shape) / 0.4
    known = tail.start(5)
    free = np.ones((2000, 16), bool)
    for power, scatter in ((shower, 1.0), (sea, 2.2)):
        above = (step * np.log(power)).astype(np.float32)
        kind = tail.class_of(np.full(free.shape, scatter, np.float32))
        for _ in range(12):  # for some revolutions
            known = tail.count(known, above, free, kind, of, 255)
    limits = tail.thresholds(known, 1e-4, 255, 128)
    over = limits.over[tail.class_of(np.array([1.0, 2.2], np.float32)), 90] / step
    asked = np.log(-np.log(1e-4))  # of noise, nepers
    assert abs(over[0] - asked) < 0.5
    assert over[1] > over[0] + 0.5
