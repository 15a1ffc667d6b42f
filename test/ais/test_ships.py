import numpy as np
import pytest

from marine_tracker import m1371
from marine_tracker.ais import ships
from marine_tracker.ais.reports import positions
from marine_tracker.ais.ship_motion import COARSE, at
from marine_tracker.ais.ship_table import none
from marine_tracker.geometry import KNOT, NAUTICAL_MILE, unit_vector
from marine_tracker.types import take

MMSI = 219001234


def report(time, east=0.0, north=0.0, speed=5.0, course=0.0, mmsi=MMSI, type_=1, **more):
    """A report of a place on the plane, whose degrees nobody reads, with the place."""
    made = positions(
        np.array([mmsi]),
        np.array([float(time)]),
        np.zeros(1),
        np.zeros(1),
        np.array([float(speed)]),
        np.array([np.radians(course)]),
        type_,
        **more,
    )
    return made, np.array([[float(east), float(north)]])


class Heard:
    """Ships that hear one report after the other."""

    def __init__(self):
        self.ships, self.next = none(), 1

    def __call__(self, time, east=0.0, north=0.0, **given):
        made, place = report(time, east, north, **given)
        self.ships, self.next = ships.hear(self.ships, made, place, self.next)
        return self

    def place(self, time):
        return at(self.ships, time).position[0]


def test_a_ship_goes_on_as_she_said():
    heard = Heard()(10, east=100, north=-50, speed=8, course=90)
    assert heard.place(25) == pytest.approx([220, -50])
    assert heard.place(4) == pytest.approx([52, -50])


def test_a_turn_goes_on_for_a_while_along_its_circle():
    rate = np.radians(1.0)
    heard = Heard()(0, speed=10, course=0, turn=rate)
    radius = 10 / rate
    expected = radius * np.array([1 - np.cos(rate * 20), np.sin(rate * 20)])
    assert heard.place(20) == pytest.approx(expected, abs=0.01)
    end = at(heard.ships, 60.0).velocity[0]
    assert end == pytest.approx(10 * unit_vector(np.radians(30)))  # no longer than half a minute


def test_the_middle_is_found_from_the_antenna_by_heading_else_course_else_it_is_unsure():
    size = np.array([[150.0, 30.0, 20.0, 8.0]])
    by_heading = Heard()(0, speed=5, course=0, heading=np.pi / 2, size=size)
    # 60 m ahead (east) and 6 m to port (north) of the antenna
    assert by_heading.place(0) == pytest.approx([60, 6])
    by_course = Heard()(0, speed=5, course=180, size=size)
    assert by_course.place(0) == pytest.approx([6, -60])
    drifting = Heard()(0, speed=0.1, size=size)
    assert drifting.place(0) == pytest.approx([0, 0])
    spread = [at(h.ships, 0).covariance[0, 0, 0] for h in (by_course, drifting)]
    assert spread[1] - spread[0] == pytest.approx(60**2 + 6**2, rel=0.01)


def spread(heard, time):
    return float(np.sqrt(at(heard.ships, time).covariance[0, 0, 0]))


def test_the_covariance_grows_with_age_class_status_and_poor_accuracy():
    ship = Heard()(0, accurate=True, timed=True, size=np.array([[9.0, 9.0, 2.0, 2.0]]))
    rough = Heard()(0, accurate=False, size=np.array([[9.0, 9.0, 2.0, 2.0]]))
    boat = Heard()(0, type_=18, accurate=True, size=np.array([[9.0, 9.0, 2.0, 2.0]]))
    moored = Heard()(
        0, speed=0.0, status=m1371.MOORED, accurate=True, size=np.array([[9.0, 9.0, 2.0, 2.0]])
    )
    assert spread(ship, 0) < 7 < spread(rough, 0)
    assert spread(ship, 10) < spread(ship, 30) < spread(boat, 30)
    assert spread(moored, 170) < 30 < spread(ship, 170)


def test_the_stated_deviation_holds_for_a_boat_of_class_b_that_bends():
    """Boats that wander as boats do are within their covariance 30 s after each report."""
    random = np.random.default_rng(4)
    off = []
    for _ in range(300):
        step, speed, course = 0.5, 10.0, random.uniform(0, 2 * np.pi)
        heard = Heard()(0, speed=speed, course=np.degrees(course), type_=18, timed=True,
                        size=np.array([[5.0, 5.0, 2.0, 2.0]]))  # fmt: skip
        place = random.normal(0, 10, 2)  # where she truly was
        for _ in range(60):
            course += random.normal(0, 0.04) * np.sqrt(step)
            place = place + step * speed * unit_vector(course)
        moving = at(heard.ships, 30.0)
        miss = place - moving.position[0]
        off.append(miss @ np.linalg.solve(moving.covariance[0, :2, :2], miss))
    assert 0.4 < np.mean(off) < 2.6  # 2 where it is exact


@pytest.mark.parametrize(
    ('given', 'timeout'),
    [
        ({'speed': 18 * KNOT}, 36),
        ({'speed': 5}, 60),
        ({'speed': 0, 'status': m1371.MOORED}, 1080),
        ({'speed': 0.1, 'status': m1371.AT_ANCHOR}, 1080),
        ({'speed': 3, 'type_': 18}, 180),
        ({'speed': 0.3, 'type_': 18}, 1080),
        ({'speed': 6, 'type_': 27}, 1080),
    ],
)
def test_a_ship_is_lost_after_several_missed_reports_of_her_interval(given, timeout):
    heard = Heard()(100, **given)
    assert not ships.pass_time(heard.ships, 100 + timeout - 1).lost[0]
    lost = ships.pass_time(heard.ships, 100 + timeout + 1)
    assert lost.lost[0]
    assert not len(ships.pass_time(lost, 100 + timeout + ships.FORGET_AFTER + 2).id)


def test_every_report_counts_as_life_also_one_without_a_place_or_with_nothing_new():
    heard = Heard()(0, speed=0, status=m1371.MOORED)
    for time in range(180, 4000, 180):
        heard(time, speed=0, status=m1371.MOORED)
        heard.ships = ships.pass_time(heard.ships, time + 179)
        assert not heard.ships.lost[0]
    made, _ = report(4000, type_=5)
    heard.ships, _ = ships.hear(heard.ships, made, np.full((1, 2), np.nan), heard.next)
    assert heard.ships.heard[0] == 4000
    assert heard.ships.time[0] == 3960


def test_one_jump_is_refused_and_a_second_that_agrees_is_the_new_place():
    heard = Heard()(0, speed=6)(10, north=60, speed=6)
    heard(20, east=2500, north=120, speed=6)
    assert heard.ships.position[0] == pytest.approx([0, 60]) and heard.ships.jumps[0] == 1
    heard(30, east=2500, north=180, speed=6, course=10)
    ship = take(heard.ships, slice(0, 1))
    assert ship.position[0] == pytest.approx([2500, 180])
    assert ship.time[0] == ship.begun[0] == 30 and np.degrees(ship.course[0]) == pytest.approx(10)
    assert len(heard.ships.id) == 1 and not ship.double[0]


def test_a_glitch_leaves_the_ship_on_her_way():
    heard = Heard()(0, speed=6)(10, north=60, speed=6)(20, east=9000, speed=6)(
        30, north=180, speed=6
    )
    assert heard.ships.position[0] == pytest.approx([0, 180])


def test_two_senders_of_one_number_are_two_ships_without_a_leap():
    heard = Heard()
    for k in range(6):
        heard(60 * k, north=60 * 4 * k, speed=4)
        heard(60 * k + 30, east=700_000, speed=3, course=90, north=0)
    assert len(heard.ships.id) == 2 and heard.ships.double.all()
    assert set(heard.ships.mmsi.tolist()) == {MMSI}
    assert heard.ships.speed == pytest.approx([4, 3])
    near = heard.ships.position[np.argsort(heard.ships.position[:, 0])]
    assert near[0, 0] == 0 and near[1, 0] == pytest.approx(700_000)
    alone = ships.pass_time(heard(360, north=1440, speed=4)(420, north=1680, speed=4).ships, 421)
    assert not ships.pass_time(alone, 421).double.any() or len(alone.id) == 2
    later = ships.pass_time(heard(600, north=2400, speed=4).ships, 601)
    assert len(later.id) == 1 and not later.double[0]


def test_long_range_reports_count_only_without_better_ones_and_change_no_class():
    heard = Heard()(0, speed=5, type_=18)
    heard(20, east=150, north=260, type_=27, speed=5.6, course=5)
    assert heard.ships.position[0] == pytest.approx([0, 0]) and heard.ships.heard[0] == 20
    assert heard.ships.kind[0] == m1371.CLASS_B
    heard(400, east=150, north=2050, type_=27, speed=5.1, course=5)
    assert heard.ships.position[0] == pytest.approx([150, 2050])
    assert heard.ships.kind[0] == m1371.CLASS_B and heard.ships.coarse[0]
    assert spread(heard, 400) > COARSE
    assert heard.ships.speed[0] == pytest.approx(5.1)
    heard(410, north=2050, type_=18, speed=5)
    assert not heard.ships.coarse[0]


def test_reports_out_of_order_leave_the_newer_place():
    heard = Heard()(20, north=100, speed=5)(14, north=70, speed=5, heard=21.0)
    assert heard.ships.position[0] == pytest.approx([0, 100]) and heard.ships.heard[0] == 21


def test_own_ship_goes_when_her_number_becomes_known():
    heard = Heard()(0)(0, mmsi=219009999, east=500)
    assert ships.pass_time(heard.ships, 1, own=MMSI).mmsi.tolist() == [219009999]


def test_a_ship_without_motion_has_no_vector_and_a_wide_covariance():
    heard = Heard()(0, speed=np.nan)
    moving = at(heard.ships, 20.0)
    assert not moving.told[0] and moving.velocity[0] == pytest.approx([0, 0])
    assert spread(heard, 20) > 100
    still = at(Heard()(0, speed=0.0, course=np.nan).ships, 20.0)
    assert still.told[0]


def test_a_name_that_comes_first_waits_for_the_place():
    made, _ = report(0, type_=5, name='ORCA')
    known, next_id = ships.hear(none(), made, np.full((1, 2), np.nan), 1)
    assert not known.placed[0]
    known, _ = ships.hear(known, *report(8, east=3 * NAUTICAL_MILE), next_id)
    assert known.placed[0] and known.name.tolist() == ['ORCA'] and len(known.id) == 1


def test_numbers_tell_beacons_aircraft_and_aids():
    heard = Heard()(0, mmsi=970010001, status=m1371.ACTIVE)(0, mmsi=992190001, type_=21)
    heard(0, mmsi=111219501, type_=9, speed=70)
    assert heard.ships.kind.tolist() == [m1371.SART, m1371.AID, m1371.AIRCRAFT]


def test_thousands_of_ships_are_bounded():
    count = ships.MOST_SHIPS + 10
    made = positions(
        np.arange(1, count + 1), np.zeros(count), *np.zeros((2, count)), *np.zeros((2, count))
    )
    known, _ = ships.hear(none(), made, np.zeros((count, 2)), 1)
    assert len(known.id) == ships.MOST_SHIPS
