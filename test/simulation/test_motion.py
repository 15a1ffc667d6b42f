import numpy as np
import pytest

from marine_tracker.simulation import motion
from marine_tracker.simulation.motion import SpeedChange, Straight, Turn, Wave

EVERY_LEG = (
    Straight(100.0),
    Turn(np.radians(-200), radius=300.0),
    SpeedChange(12.0, duration=80.0),
    Straight(30.0),
    Turn(np.radians(75), rate=np.radians(0.7)),
    SpeedChange(4.0, acceleration=0.05),
    Straight(None),
)


def place(way, times, duration=2000.0):
    times = np.atleast_1d(np.asarray(times, dtype=float))
    paths = motion.table([way], duration)
    return motion.locate_ships(paths, np.zeros(len(times), int), times)


def test_straight_leg_follows_its_course():
    position, velocity = place(motion.sail((100.0, -50.0), np.radians(30), 8.0), [0.0, 10.0])
    assert position == pytest.approx(np.array([[100, -50], [140, -50 + 80 * np.cos(np.pi / 6)]]))
    assert velocity[1] == pytest.approx(8 * np.array([0.5, np.cos(np.pi / 6)]))


def test_turn_to_starboard_stays_on_its_circle_and_ends_on_the_new_course():
    way = motion.sail((0.0, 0.0), 0.0, 5.0, [Turn(np.pi / 2, radius=200.0)])
    duration = 200 * np.pi / 2 / 5
    position, velocity = place(way, np.linspace(0, duration, 50))
    assert np.hypot(*(position - [200.0, 0.0]).T) == pytest.approx(np.full(50, 200.0))
    assert position[-1] == pytest.approx([200.0, 200.0])
    assert velocity[-1] == pytest.approx([5.0, 0.0], abs=1e-9)


def test_turn_to_port_by_rate_takes_angle_over_rate():
    way = motion.sail((0.0, 0.0), 0.0, 5.0, [Turn(np.radians(-90), rate=np.radians(1.5))])
    assert way[1].start == pytest.approx(60.0)
    position, velocity = place(way, [60.0, 70.0])
    radius = 5 / np.radians(1.5)
    assert position[0] == pytest.approx([-radius, radius])
    assert position[1] == pytest.approx([-radius - 50, radius])


def test_speed_change_by_duration_and_by_acceleration_are_the_same_leg():
    by_duration = motion.sail((0.0, 0.0), 0.0, 4.0, [SpeedChange(10.0, duration=60.0)])
    by_acceleration = motion.sail((0.0, 0.0), 0.0, 4.0, [SpeedChange(10.0, acceleration=0.1)])
    for way in (by_duration, by_acceleration):
        position, velocity = place(way, [60.0, 70.0])
        assert position[:, 1] == pytest.approx([7 * 60, 7 * 60 + 100])
        assert velocity[:, 1] == pytest.approx([10, 10])


def test_speed_wave_has_the_stated_speed_at_all_times_turns_included():
    way = motion.sail(
        (0.0, 0.0), 1.0, 9.26, [Straight(300.0), Turn(0.87, radius=200.0)], Wave(1.03, 1000.0)
    )
    times = np.linspace(0, 1500, 301)
    _, velocity = place(way, times)
    assert np.hypot(*velocity.T) == pytest.approx(9.26 + 1.03 * np.sin(2 * np.pi * times / 1000))


def test_turn_with_a_speed_wave_ends_after_its_arc():
    way = motion.sail(
        (0.0, 0.0), 0.0, 2.0, [Turn(np.pi, radius=300.0), Straight(None)], Wave(1.5, 60.0)
    )
    position, velocity = place(way, [way[1].start])
    assert position[0] == pytest.approx([600.0, 0.0], abs=1e-6)
    assert np.arctan2(*velocity[0]) == pytest.approx(np.pi)


@pytest.mark.parametrize('wave', [None, Wave(2.0, 90.0)])
def test_velocity_is_the_derivative_of_position_and_position_has_no_jumps(wave):
    way = motion.sail((10.0, 20.0), 0.4, 7.0, EVERY_LEG, wave)
    assert len(way) == len(EVERY_LEG)
    times = np.linspace(1, 1200, 4001)
    joints = np.array([piece.start for piece in way])
    times = times[np.abs(times[:, None] - joints).min(1) > 0.01]
    step = 1e-3
    before, after = place(way, times - step)[0], place(way, times + step)[0]
    _, velocity = place(way, times)
    assert (after - before) / (2 * step) == pytest.approx(velocity, abs=1e-6)
    assert place(way, joints[1:] - 1e-9)[0] == pytest.approx(place(way, joints[1:])[0], abs=1e-6)


def test_ships_in_one_table_do_not_mix():
    ways = [
        motion.sail((0.0, 0.0), 0.0, 5.0, EVERY_LEG),
        motion.sail((9.0, 9.0), 2.0, 3.0),
        motion.sail((0.0, 0.0), -1.0, 6.0, EVERY_LEG[3:]),
    ]
    paths = motion.table(ways, 600.0)
    times = np.array([0.0, 37.0, 599.0, 600.0, 603.0])
    for ship, way in enumerate(ways):
        together = motion.locate_ships(paths, np.full(5, ship), times)
        assert np.array_equal(together, place(way, times, 600.0))


def test_two_dimensional_questions_are_answered_in_their_shape():
    paths = motion.table([motion.sail((0.0, 0.0), 0.0, 5.0), motion.sail((1.0, 0.0), 0.0, 2.0)], 60)
    ship, time = np.array([[0], [1]]), np.array([[0.0, 1.0, 2.0]])
    position, velocity = motion.locate_ships(paths, ship, time)
    assert position.shape == velocity.shape == (2, 3, 2)
    assert position[1, 2] == pytest.approx([1.0, 4.0])


@pytest.mark.parametrize(
    'legs, wave, text',
    [
        ([Straight(None), Turn(1.0, radius=100.0)], None, r'legs\[0\]\.straight has no duration_s'),
        (
            [SpeedChange(0.0, duration=9.0), Turn(1.0, radius=100.0)],
            None,
            r'legs\[1\]\.turn .*cannot',
        ),
        ([SpeedChange(1.0, duration=9.0)], Wave(2.0, 60.0), r'legs\[0\]\.speed ends at 1 m/s'),
        ([Turn(1.0, radius=2.0)], None, r'legs\[0\]\.turn has a radius of 2 m; .* 143 deg/s'),
        (
            [SpeedChange(30.0, duration=1.0)],
            None,
            r'legs\[0\]\.speed changes by 25 m/s each second',
        ),
        ([], Wave(6.0, 60.0), 'speed_wave has an amplitude of 6 m/s'),
    ],
)
def test_impossible_legs_are_refused(legs, wave, text):
    with pytest.raises(ValueError, match=text):
        motion.sail((0.0, 0.0), 0.0, 5.0, legs, wave)
