import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from marine_tracker.arpa.swap_risk import swap_risk

ORIGIN = np.zeros(2)
SIZE = 10.6


def ellipse(rng, smallest=10, largest=100):
    """A covariance [2, 2] m^2."""
    angle = rng.uniform(0, np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return turn @ np.diag(rng.uniform(smallest, largest, 2) ** 2) @ turn.T


def circles(distance, *radii):
    """Overlap of two round gates."""
    position = np.array([[1000.0, 0.0], [1000.0, distance]])
    covariance = np.array([np.eye(2) * radius**2 / SIZE for radius in radii])
    return swap_risk(position, covariance, ORIGIN, SIZE)[0]


@pytest.mark.parametrize('radii', [(100, 100), (150, 50)])
def test_round_gates_overlap_when_they_are_nearer_than_their_radii(radii):
    assert (circles(195.0, *radii) < 1).all()
    assert (circles(205.0, *radii) > 1).all()
    assert circles(200.0, *radii) == pytest.approx(1.0, rel=0.02)


@settings(max_examples=80, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_overlap_of_two_gates_agrees_with_points_that_lie_in_both(seed):
    """Two ellipses overlap where the least of the greater of both distances is below 1."""
    rng = np.random.default_rng(seed)
    cov = np.array([ellipse(rng), ellipse(rng)])
    position = np.array([[3000.0, 500.0], [3000.0, 500.0] + rng.uniform(-350, 350, 2)])
    overlap, other = swap_risk(position, cov, ORIGIN, SIZE)
    inverse = np.linalg.inv(SIZE * cov)

    def distances(share):
        """Squared distances of the point where a mixture of both is least."""
        weight = (1 - share) * inverse[0], share * inverse[1]
        point = np.linalg.solve(sum(weight), weight[0] @ position[0] + weight[1] @ position[1])
        return [(point - p) @ m @ (point - p) for p, m in zip(position, inverse)]

    exact = minimize_scalar(
        lambda share: max(distances(share)),
        bounds=(1e-6, 1 - 1e-6),
        method='bounded',
        options={'xatol': 1e-9},
    ).fun
    if exact < 1.5:
        assert (other == [1, 0]).all()
        assert 0.96 * exact - 1e-6 <= overlap[0] == overlap[1] <= exact * (1 + 1e-6)
    else:
        assert (overlap > 1.4).all()


def test_each_track_is_told_its_nearest_rival_and_the_lonely_none():
    position = np.array([[0, 4000.0], [0, 4080.0], [0, 4110.0], [9000, 0.0]])
    overlap, other = swap_risk(position, np.tile(np.eye(2) * 400, (4, 1, 1)), ORIGIN, SIZE)
    assert other.tolist() == [1, 2, 1, -1]
    assert np.isinf(overlap[3]) and (overlap[:3] < 1).all()


def test_across_north_and_round_own_ship():
    position = np.array([[-20, 5000.0], [20, 5000.0], [3, 0.0], [-3, -4.0]])
    overlap, other = swap_risk(position, np.tile(np.eye(2) * 400, (4, 1, 1)), ORIGIN, SIZE)
    assert other.tolist() == [1, 0, 3, 2] and (overlap < 1).all()


def test_a_large_gate_that_holds_a_small_one():
    overlap, other = swap_risk(
        np.array([[0, 2000.0], [0, 2500.0]]),
        np.array([np.eye(2) * 300.0**2, np.eye(2) * 5.0**2]),
        ORIGIN,
        SIZE,
    )
    assert other.tolist() == [1, 0] and (overlap < 0.5).all()


def test_many_tracks_agree_with_every_pair_looked_at():
    rng = np.random.default_rng(4)
    position = rng.uniform(-4000, 4000, (300, 2))
    covariance = np.array([ellipse(rng, 5, 60) for _ in range(300)])
    overlap, _ = swap_risk(position, covariance, ORIGIN, SIZE)
    for one in range(300):
        pairs = [
            swap_risk(position[[one, two]], covariance[[one, two]], ORIGIN, SIZE)[0][0]
            for two in range(one + 1, 300)
            if np.hypot(*(position[one] - position[two])) < 500
        ]
        for value in pairs:
            if value < 1.44:
                assert overlap[one] <= value + 1e-9
    assert 20 < (overlap < 1).sum() < 280


@pytest.mark.parametrize('count', [0, 1])
def test_none_or_one_is_no_risk(count):
    overlap, other = swap_risk(
        np.zeros((count, 2)), np.tile(np.eye(2), (count, 1, 1)), ORIGIN, SIZE
    )
    assert np.isinf(overlap).all() and (other == -1).all()
