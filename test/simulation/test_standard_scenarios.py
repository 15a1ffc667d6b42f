import numpy as np
import pytest

from marine_tracker.geometry import KNOT, NAUTICAL_MILE, to_range_bearing
from marine_tracker.simulation import scenario, standard_scenarios
from marine_tracker.simulation.standard_scenarios import IMAZU, a823, judged_at

# Resolution A.823(19): own course/speed, target range/bearing, relative and true course/speed.
GIVEN = {
    1: (0, 10, 8, 0, 180, 20, 180, 10),
    2: (0, 10, 1, 0, 90, 10, 45, 14.142),
    3: (0, 5, 8, 45, 225, 20, 237.121, 16.84),
    4: (0, 25, 8, 45, 225, 20, 307.516, 17.83),
}


@pytest.mark.parametrize('number', GIVEN)
@pytest.mark.parametrize(('after', 'turn'), [(180, 0), (60, 0), (20, 45), (60, -45)])
def test_the_imo_targets_are_where_they_should_be_when_judged(number, after, turn):
    moment = judged_at(after, turn)
    loaded = scenario.build(a823(number, after, turn), 'made')
    truth, own = loaded.truth_at(moment), loaded.own_ship_at(moment)
    distance, bearing = to_range_bearing(truth.position[0] - own.position[0])
    found = [own.velocity[0], truth.velocity[0] - own.velocity[0], truth.velocity[0]]
    (own_speed, own_course), (speed, course), (true_speed, true_course) = map(
        to_range_bearing, found
    )
    assert [
        np.degrees(own_course) % 360,
        own_speed / KNOT,
        distance / NAUTICAL_MILE,
        np.degrees(bearing + 1e-12) % 360,
        np.degrees(course),
        speed / KNOT,
        np.degrees(true_course),
        true_speed / KNOT,
    ] == pytest.approx(GIVEN[number], abs=2e-3)
    assert loaded.fleet.length[0] == 200 and loaded.radar.sensor_errors == 'imo'


@pytest.mark.parametrize('turn', [45, -45])
def test_own_ship_turns_in_one_minute_after_three_steady_ones(turn):
    loaded = scenario.build(a823(3, 20, turn), 'made')
    end = judged_at(0, turn)

    def course(time):
        return np.degrees(np.arctan2(*loaded.own_ship_at(time).velocity[0]))

    assert [course(t) for t in (0, end - 60, end - 30, end, judged_at(20, turn))] == pytest.approx(
        [-turn, -turn, -turn / 2, 0, 0], abs=1e-6
    )
    assert 180 < end - 60 < 183
    assert 0 <= end + 20 - judged_at(20, turn) < loaded.radar.scan_period


def test_judging_happens_at_the_end_of_a_revolution_a_whole_time_after_the_first_plot():
    period = 60 / 22
    assert judged_at(60) == pytest.approx(23 * period)
    assert judged_at(180) == pytest.approx(67 * period)


@pytest.mark.parametrize('number', range(1, 23))
def test_imazus_ships_all_meet_at_the_origin(number):
    loaded = scenario.load(f'imazu_{number:02d}')
    start, own = loaded.truth_at(0), loaded.own_ship_at([0, loaded.duration])
    assert own.position / NAUTICAL_MILE == pytest.approx(np.array([[0, -6], [0, 0]]), abs=1e-9)
    assert own.velocity[:, 0] == pytest.approx(0)
    assert loaded.truth_at(loaded.duration).position == pytest.approx(0, abs=1e-5)
    own_speed = own.velocity[0, 1]
    for text, velocity in zip(IMAZU[number - 1], start.velocity, strict=True):
        speed, course = to_range_bearing(velocity)
        slow = str(text).endswith('s')
        assert speed == pytest.approx(own_speed * (0.7 if slow else 1))
        assert np.degrees(course) == pytest.approx(float(str(text).rstrip('s')) % 360, abs=1e-9)


def test_imazus_encounters_are_those_published():
    assert [len(case) for case in IMAZU] == 4 * [1] + 7 * [2] + 11 * [3]
    assert IMAZU[14] == IMAZU[21] == ('0s', -45, -90)
    assert IMAZU[17] == (-135, -15, -30)


def test_standard_scenarios_are_shipped_like_files():
    names = scenario.shipped()
    assert set(standard_scenarios.STANDARD) <= set(names) and names == sorted(set(names))
    assert scenario.load('imo_2').name == 'imo_2'
    with pytest.raises(ValueError, match=r'no scenario imazu_2; did you mean imazu_\d\d\?'):
        scenario.load('imazu_2')
