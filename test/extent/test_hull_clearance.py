import numpy as np
import pytest

from marine_tracker.extent.hull_clearance import hull_clearance

BOX = np.array([[-10.0, 100], [10, 100], [10, -100], [-10, -100]])  # 200 m, north-south


def clearance(position, velocity, outline=BOX):
    return hull_clearance(outline[None], np.array([position], float), np.array([velocity], float))[
        0
    ]


@pytest.mark.parametrize(
    'position, velocity, expected',
    [
        ((500, 0), (0, 5), 490),  # abeam and drawing ahead: her side is nearest now
        ((500, -1000), (0, 5), 490),  # will pass to the east
        ((0, 1000), (5, 0), 900),  # her stern is nearest now, and she goes away sideways
        ((-1000, 150), (5, 0), 50),  # crosses ahead: passes with her stern 50 m off
        ((-1000, 90), (5, 0), 0),  # runs us down
        ((0, 1000), (0, -5), 0),  # head-on
        ((0, 1000), (0, 5), 900),  # opening
        ((5, 20), (0, 0), 0),  # we lie within her
        ((300, 0), (0, 0), 290),
    ],
)  # at rest together
def test_clearance_of_a_box(position, velocity, expected):
    assert clearance(position, velocity) == pytest.approx(expected, abs=1.0)


def test_clearance_is_the_least_distance_in_time():
    """Against a clock that ticks: positions every tenth of a second, points every metre."""
    rng = np.random.default_rng(1)
    turn = np.linspace(0, 2 * np.pi, 36, endpoint=False)
    outline = np.stack([30 * np.cos(turn), 110 * np.sin(turn)], -1)
    fine = np.linspace(0, 2 * np.pi, 700)
    edge = np.stack([30 * np.cos(fine), 110 * np.sin(fine)], -1)
    for _ in range(40):
        position, velocity = rng.uniform(-900, 900, 2), rng.normal(0, 6, 2)
        if np.hypot(*position) < 150:
            continue
        ahead = position + np.arange(0, 400, 0.1)[:, None] * velocity
        least = min(np.hypot(*(edge + at).T).min() for at in ahead[::5])
        inside = ((ahead / [30, 110]) ** 2).sum(1).min() < 1
        found = clearance(position, velocity, outline)
        assert found == pytest.approx(0 if inside else least, abs=4)


def test_no_motion_known_no_clearance():
    assert np.isnan(clearance((np.nan, np.nan), (np.nan, np.nan)))


def test_no_targets_no_clearance():
    assert hull_clearance(np.empty((0, 36, 2)), np.empty((0, 2)), np.empty((0, 2))).shape == (0,)
