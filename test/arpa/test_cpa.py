"""CPA and all that goes with it: known answers, symmetries, and deviations against Monte Carlo."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from marine_tracker.arpa.cpa import Approach, OwnMotion, approach, bow_crossing, cpa_of
from marine_tracker.arpa.motion import Motion
from marine_tracker.geometry import KNOT, NAUTICAL_MILE, unit_vector, wrap_angle

AT_REST = OwnMotion(np.zeros(2), np.zeros(2), 0.0, np.zeros((4, 4)))
LIMITS = 0.5 * NAUTICAL_MILE, 720.0
EXACT = np.zeros((4, 4))
SAMPLES = 10000


def motion_of(position, velocity, covariance=EXACT):
    position, velocity = np.atleast_2d(position).astype(float), np.atleast_2d(velocity)
    count = len(position)
    covariance = np.broadcast_to(covariance, (count, 4, 4))
    return Motion(
        position,
        velocity.astype(float),
        covariance,
        np.zeros(count, int),
        np.zeros(count),
        np.ones(count, bool),
        np.zeros(count, bool),
    )


def own_ship(position=(0.0, 0.0), course_deg=0.0, speed=0.0, covariance=EXACT):
    course = np.radians(course_deg)
    return OwnMotion(np.array(position, float), speed * unit_vector(course), course, covariance)


def polar(distance, bearing_deg):
    return distance * unit_vector(np.radians(bearing_deg))


@pytest.mark.parametrize(
    ('range_', 'bearing', 'speed', 'course', 'cpa', 'tcpa'),
    [(3.0, 45, 20, 0, 2.1, -6.4), (2.0, 120, 5, 120, 0.0, -24.0), (7.0, 270, 100, 120, 3.5, 3.64)],
)
def test_the_self_test_of_a_commercial_arpa(range_, bearing, speed, course, cpa, tcpa):
    """To the digits it prints, but for its last TCPA, 3.5: 7 NM cos 30 deg at 100 kn take 3.64."""
    found = approach(
        motion_of(polar(range_ * NAUTICAL_MILE, bearing), polar(speed * KNOT, course)),
        AT_REST,
        *LIMITS,
    )
    assert found.cpa[0] / NAUTICAL_MILE == pytest.approx(cpa, abs=0.05)
    assert found.tcpa[0] / 60 == pytest.approx(tcpa, abs=0.05)


@pytest.mark.parametrize(
    ('own', 'target', 'true', 'relative', 'cpa', 'tcpa'),
    [
        ((0, 10), (8, 0), (180, 10), (180, 20), 0, 24),
        ((0, 10), (1, 0), (45, 14.142), (90, 10), 1, 0),
        ((0, 5), (8, 45), (237.121, 16.84), (225, 20), 0, 24),
        ((0, 25), (8, 45), (307.516, 17.83), (225, 20), 0, 24),
    ],
)
def test_the_scenarios_of_the_standard(own, target, true, relative, cpa, tcpa):
    found = approach(
        motion_of(polar(target[0] * NAUTICAL_MILE, target[1]), polar(true[1] * KNOT, true[0])),
        own_ship((0, 0), own[0], own[1] * KNOT),
        *LIMITS,
    )
    assert found.range[0] / NAUTICAL_MILE == pytest.approx(target[0])
    assert np.degrees(found.bearing[0]) == pytest.approx(target[1], abs=1e-6)
    assert np.degrees(found.course[0]) == pytest.approx(true[0], abs=1e-3)
    assert found.speed[0] / KNOT == pytest.approx(true[1], abs=1e-3)
    assert np.degrees(found.relative_course[0]) == pytest.approx(relative[0], abs=0.05)
    assert found.relative_speed[0] / KNOT == pytest.approx(relative[1], abs=0.01)
    assert found.cpa[0] / NAUTICAL_MILE == pytest.approx(cpa, abs=0.01)
    assert found.tcpa[0] / 60 == pytest.approx(tcpa, abs=0.02)


@pytest.mark.parametrize(
    ('position', 'velocity', 'cpa', 'tcpa'),
    [
        ((0, 1000), (0, -5), 0, 200),  # head-on
        ((0, 1000), (0, 5), 0, -200),  # receding
        ((500, 1000), (0, -5), 500, 200),  # passing on a parallel course
        ((1000, 1000), (-5, 0), 1000, 200),  # crossing ahead
        ((300, 400), (4, -3), 500, 0),
    ],
)  # at its CPA now
def test_plain_geometry(position, velocity, cpa, tcpa):
    found = cpa_of(np.array(position, float), np.array(velocity, float))
    assert found == (pytest.approx(cpa, abs=1e-9), pytest.approx(tcpa, abs=1e-9))


def test_ships_in_company_have_no_tcpa_and_are_no_danger():
    """Own ship at rest beside an anchored ship, and two ships on one course at one speed."""
    company = approach(
        motion_of([[300, 0], [300, 0]], [[0, 8], [0, 7.8]]), own_ship((0, 0), 0, 8), *LIMITS
    )
    anchored = approach(motion_of([300, 0], [0, 0]), AT_REST, *LIMITS)
    for found in (company, anchored):
        assert np.isnan(found.tcpa).all() and np.isnan(found.bow_time).all()
        assert (found.danger_probability == 0).all()
    assert anchored.cpa[0] == pytest.approx(300)
    assert company.cpa[0] == pytest.approx(300)
    assert cpa_of(np.array([3.0, 4.0]), np.zeros(2))[0] == 5


def test_bow_crossings():
    own = own_ship((100, 100), 0, 5)
    # Bound west ahead, west astern, off to the east, and along own ship's keel line.
    found = approach(
        motion_of(
            [[1100, 2100], [1100, -100], [1100, 2100], [100, 2100]],
            [[-10, 5], [-10, 5], [10, 5], [0, 0]],
        ),
        own,
        *LIMITS,
    )
    assert found.bow_range == pytest.approx([2000, np.nan, np.nan, np.nan], nan_ok=True)
    assert found.bow_time == pytest.approx([100, np.nan, np.nan, np.nan], nan_ok=True)
    # A bow that points elsewhere than the ship goes: the line of the heading counts.
    yawing = approach(
        motion_of([1100, 2100], [-10, 5]), own._replace(heading=-np.arctan(0.5)), *LIMITS
    )
    assert yawing.bow_time[0] == pytest.approx(200)
    assert yawing.bow_range[0] == pytest.approx(np.hypot(1000, 2000))


def test_without_a_heading_only_the_bow_crossing_is_unknown():
    target = motion_of([1100, 2100], [-10, 5])
    blind = approach(target, own_ship((100, 100), 0, 5)._replace(heading=np.nan), *LIMITS)
    known = approach(target, own_ship((100, 100), 0, 5), *LIMITS)
    assert np.isnan(blind.bow_range[0]) and np.isnan(blind.bow_time[0])
    assert blind.cpa == known.cpa and blind.danger_probability == known.danger_probability


coordinate = st.floats(-2e4, 2e4, allow_nan=False)
speed = st.floats(-20, 20, allow_nan=False)
states = st.tuples(coordinate, coordinate, speed, speed).map(np.array)


def relative(of, to):
    state = np.subtract(of, to)
    return state[:2], state[2:]


def moving(of, to):
    return np.hypot(*relative(of, to)[1]) > 0.1


@settings(max_examples=60, deadline=None)
@given(states, states, st.floats(-7, 7), st.floats(-600, 600), speed, speed)
def test_symmetries_of_the_cpa(one, other, angle, later, east, north):
    if not moving(one, other):
        return
    position, velocity = relative(one, other)
    cpa, tcpa = cpa_of(position, velocity)

    def same(position, velocity, cpa=cpa, tcpa=tcpa):
        found = cpa_of(np.asarray(position), np.asarray(velocity))
        assert found[0] == pytest.approx(cpa, abs=1e-6 + 1e-9 * np.hypot(*position))
        assert found[1] == pytest.approx(tcpa, rel=1e-9, abs=1e-6)

    same(*relative(other, one))  # roles swapped
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    same(turn @ position, turn @ velocity)  # the chart turned
    same(position * [-1, 1], velocity * [-1, 1])  # mirrored
    current = np.array([0, 0, east, north])
    same(*relative(one + current, other + current))  # both in a current
    same(position + later * velocity, velocity, tcpa=tcpa - later)  # later
    at_cpa = position + tcpa * velocity
    assert np.hypot(*at_cpa) == pytest.approx(cpa, abs=1e-5 + 1e-7 * abs(tcpa))
    assert np.hypot(*position) >= cpa - 1e-6


@settings(max_examples=25, deadline=None)
@given(states, states, st.floats(1, 300), st.floats(0.01, 2), st.floats(0, 6.3))
def test_symmetries_of_the_whole_approach(one, other, place, way, angle):
    """Turned, mirrored or moved, an encounter has the same deviations and the same danger."""
    if not moving(one, other):
        return
    covariance = np.diag([place, 2 * place, way, 0.5 * way]) ** 2
    covariance[0, 2] = covariance[2, 0] = 0.6 * place * way
    slow = np.hypot(*relative(one, other)[1]) < 6 * way  # there TCPA has no variance
    names = [
        name
        for name in Approach._fields
        if 'course' not in name
        and 'bearing' not in name
        and not name.startswith('bow')
        and not (slow and name == 'tcpa_sigma')
    ]

    def of(one, other, spread, heading=0.0):
        own = OwnMotion(other[:2], other[2:], heading, EXACT)
        found = approach(motion_of(one[:2], one[2:], spread), own, *LIMITS)
        return np.array([getattr(found, name)[0] for name in names])

    first = of(one, other, covariance)
    turn = np.kron(np.eye(2), [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    mirror = np.diag([-1.0, 1, -1, 1])
    shift = np.array([1e4, -2e4, 0, 0])
    for second in (
        of(turn @ one, turn @ other, turn @ covariance @ turn.T),
        of(mirror @ one, mirror @ other, mirror @ covariance @ mirror),
        of(one + shift, other + shift, covariance),
    ):
        np.testing.assert_allclose(second, first, rtol=0.03, atol=2e-3)


def encounters(rng, count):
    """Random targets that may come close: [N, 4] and covariances [N, 4, 4]."""
    bearing, distance = rng.uniform(0, 2 * np.pi, count), np.exp(rng.uniform(5.5, 9.5, count))
    position = distance[:, None] * unit_vector(bearing)
    velocity = (
        rng.uniform(-3, 12, count)[:, None] * -unit_vector(bearing)
        + rng.normal(0, 1, (count, 2)) * np.exp(rng.uniform(-2, 1.5, count))[:, None]
    )
    place, way = rng.uniform(5, 90, (count, 2)), rng.uniform(0.05, 1.0, (count, 2))
    way[:, 1] = way[:, 0] * rng.uniform(0.35, 1.0, count)
    spread = np.zeros((count, 4, 4))
    for i in range(2):
        spread[:, i, i], spread[:, i + 2, i + 2] = place[:, i] ** 2, way[:, i] ** 2
        both = rng.uniform(0, 0.9, count) * place[:, i] * way[:, i]
        spread[:, i, i + 2] = spread[:, i + 2, i] = both
    angle = rng.uniform(0, np.pi, count)
    turn = np.zeros((count, 4, 4))
    for i in (0, 2):
        turn[:, i, i] = turn[:, i + 1, i + 1] = np.cos(angle)
        turn[:, i, i + 1], turn[:, i + 1, i] = np.sin(angle), -np.sin(angle)
    return np.hstack([position, velocity]), turn @ spread @ turn.swapaxes(1, 2)


@pytest.fixture(scope='module')
def drawn():
    """Encounters as shown, and what they may really be: [N, 4] and [N, S, 4]."""
    rng = np.random.default_rng(11)
    shown, covariance = encounters(rng, 200)
    noise = rng.standard_normal((200, SAMPLES, 4)) @ np.linalg.cholesky(covariance).swapaxes(1, 2)
    found = approach(motion_of(shown[:, :2], shown[:, 2:], covariance), AT_REST, *LIMITS)
    return shown, covariance, shown[:, None] + noise, found


def length(vectors):
    return np.hypot(vectors[..., 0], vectors[..., 1])


def rms(values):
    return np.sqrt(np.mean(np.square(values), 1))


def test_deviations_are_those_of_monte_carlo(drawn):
    """Within 10 %, near as without: with 10,000 draws the ratio's own deviation is below 2 %.

    CPA, range, speed and the angles for every encounter, even where the error is as large as the
    value (errors up to three times as long as wide); TCPA and bow crossing, whose exact variance
    is infinite, where the relative speed is more than 6 deviations.
    """
    shown, covariance, truth, found = drawn
    position, velocity = truth[..., :2], truth[..., 2:]
    cpa, tcpa = cpa_of(position, velocity)
    compass = [np.arctan2(of[..., 0], of[..., 1]) for of in (position, velocity)]
    errors = {
        'range': length(position) - found.range[:, None],
        'speed': length(velocity) - found.speed[:, None],
        'relative_speed': length(velocity) - found.relative_speed[:, None],
        'bearing': wrap_angle(compass[0] - found.bearing[:, None]),
        'course': wrap_angle(compass[1] - found.course[:, None]),
        'relative_course': wrap_angle(compass[1] - found.relative_course[:, None]),
        'cpa': cpa - found.cpa[:, None],
    }
    for name, error in errors.items():
        ratio = getattr(found, f'{name}_sigma') / rms(error)
        assert (np.abs(ratio - 1) < 0.1).all(), (name, ratio.min(), ratio.max())
    fast = found.relative_speed > 6 * np.sqrt(np.trace(covariance[:, 2:, 2:], axis1=1, axis2=2))
    crossing = fast & np.isfinite(found.bow_time) & (found.bow_time_sigma < 0.15 * found.bow_time)
    assert fast.sum() > 30 and crossing.sum() > 5
    bow_range, bow_time = bow_crossing(position, velocity, 0.0)
    for name, error, rows in (
        ('tcpa', tcpa - found.tcpa[:, None], fast),
        ('bow_time', bow_time - found.bow_time[:, None], crossing),
        ('bow_range', bow_range - found.bow_range[:, None], crossing),
    ):
        ratio = getattr(found, f'{name}_sigma')[rows] / rms(error[rows])
        assert (np.abs(ratio - 1) < 0.1).all(), (name, ratio.min(), ratio.max())


def test_the_danger_probability_is_that_of_monte_carlo(drawn):
    """Within .025 for each; the frequency's own deviation is at most .005."""
    _, _, truth, found = drawn
    cpa, tcpa = cpa_of(truth[..., :2], truth[..., 2:])
    frequency = ((cpa < LIMITS[0]) & (tcpa >= 0) & (tcpa < LIMITS[1])).mean(1)
    still = np.isnan(found.tcpa)
    off = np.abs(found.danger_probability - frequency)[~still]
    assert off.max() < 0.025
    assert off.mean() < 0.004
    assert ((frequency > 0.1) & (frequency < 0.9)).sum() > 15  # else it is no test


def test_danger_comes_as_often_as_it_is_told():
    """Reliability: 20,000 encounters, one truth each; every tenth of the scale within 3.5 sigma."""
    rng = np.random.default_rng(3)
    shown, covariance = encounters(rng, 20000)
    noise = (np.linalg.cholesky(covariance) @ rng.standard_normal((20000, 4, 1)))[..., 0]
    truth = shown + noise
    told = approach(
        motion_of(shown[:, :2], shown[:, 2:], covariance), AT_REST, *LIMITS
    ).danger_probability
    cpa, tcpa = cpa_of(truth[:, :2], truth[:, 2:])
    danger = (cpa < LIMITS[0]) & (tcpa >= 0) & (tcpa < LIMITS[1])
    for low in np.arange(0.05, 1, 0.1):
        rows = (told >= low) & (told < low + 0.1)
        sigma = np.sqrt(told[rows].mean() * (1 - told[rows].mean()) / rows.sum())
        assert rows.sum() > 150
        assert abs(danger[rows].mean() - told[rows].mean()) < 3.5 * sigma + 0.005


def test_a_cpa_of_nothing_is_not_certain():
    """Head-on: the CPA shown is 0, its deviation that of the miss distance."""
    covariance = np.diag([20.0, 20.0, 0.3, 0.3]) ** 2
    found = approach(motion_of([0, 5000], [0, -10], covariance), AT_REST, *LIMITS)
    assert found.cpa[0] == 0
    assert found.cpa_sigma[0] == pytest.approx(np.hypot(20, 0.03 * 5000), rel=0.01)
    assert found.tcpa_sigma[0] == pytest.approx(np.hypot(2, 500 * 0.03), rel=0.01)


def test_own_ships_errors_count_for_what_is_relative_only():
    covariance = np.diag([10.0, 10.0, 0.1, 0.1]) ** 2
    target = motion_of([3000, 3000], [-8, 0], covariance)
    sure = approach(target, own_ship((0, 0), 0, 5), *LIMITS)
    unsure = approach(target, own_ship((0, 0), 0, 5, np.diag([0, 0, 1.0, 1.0])), *LIMITS)
    assert unsure.speed_sigma == sure.speed_sigma and unsure.range_sigma == sure.range_sigma
    assert unsure.relative_speed_sigma[0] == pytest.approx(np.sqrt(1.01), rel=0.01)
    assert unsure.cpa_sigma[0] > 5 * sure.cpa_sigma[0]


def test_targets_without_a_plot_are_unknown_and_do_not_disturb_others():
    motion = motion_of([[3000, 3000], [np.nan, np.nan]], [[-8, 0], [np.nan, np.nan]])
    both = approach(motion, AT_REST, *LIMITS)
    alone = approach(motion_of([3000, 3000], [-8, 0]), AT_REST, *LIMITS)
    for name in Approach._fields:
        assert getattr(both, name)[0] == pytest.approx(getattr(alone, name)[0], nan_ok=True)
    assert np.isnan(both.range[1]) and np.isnan(both.cpa[1]) and both.danger_probability[1] == 0
    none = approach(motion_of(np.zeros((0, 2)), np.zeros((0, 2))), AT_REST, *LIMITS)
    assert none.cpa.shape == (0,)


@pytest.mark.parametrize(
    ('cpa', 'tcpa', 'named'),
    [
        (0, 720, 'cpa_limit is 0 m'),
        (-1, 720, 'cpa_limit is -1 m'),
        (926, 0, 'tcpa_limit is 0 s'),
        (926, np.inf, 'tcpa_limit is inf s'),
        (np.nan, 720, 'cpa_limit is nan m'),
    ],
)
def test_limits_that_make_no_sense_are_refused(cpa, tcpa, named):
    with pytest.raises(ValueError, match=named):
        approach(motion_of([3000, 3000], [-8, 0]), AT_REST, cpa, tcpa)
