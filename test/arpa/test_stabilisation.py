"""What courses and speeds are measured against, and what is told when own ship's sensors fail."""

import dataclasses

import numpy as np
import pytest

from marine_tracker.arpa import alarm_text, alarms
from marine_tracker.arpa.alerts import ACTIVE_UNACKNOWLEDGED
from marine_tracker.arpa.stabilisation import NONE, OwnSensors
from marine_tracker.arpa.view import view
from marine_tracker.geometry import KNOT, on_deck, to_range_bearing, wrap_angle
from marine_tracker.parameters import ArpaParameters, TrackerParameters, from_mapping
from marine_tracker.service import Service
from marine_tracker.simulation import radar, scenario

COURSE, HEADING = np.radians(52.0), np.radians(46.0)  # she crabs: a current sets her to starboard
SPEED = 11.0  # kn, own ship's over ground
MEETS, ANCHORED, ABEAM = 1, 2, 3
ZONES = '[{name: bow, kind: guard, range_nm: [.5, 5], bearing_deg: [350, 20]}]'


@pytest.fixture(scope='module')
def sea():
    """All scans but the last, their memory, and the last scan."""
    built = scenario.build(
        {
            'duration_s': 200,
            'own_ship': {'course_deg': 52, 'speed_kn': SPEED},
            'radar': {'max_range_nm': 6, 'range_sigma_m': 8, 'pd_near': 1, 'pd_far': 1},
            'targets': [
                {'start': {'range_nm': r, 'bearing_deg': b}, 'course_deg': c, 'speed_kn': v}
                for r, b, c, v in ((4, 54, 232, 9), (3, 100, 0, 0), (2, 322, 52, 13))
            ],
        },
        'sea',
    )
    scans, truths = zip(*radar.simulate(built, 11))
    parameters = from_mapping(TrackerParameters, built.tracker_parameters())
    return scans, truths[-1], dataclasses.replace(parameters, estimator='imm')


def sail(sea, arpa=None, moved=lambda scan: scan):
    scans, _, parameters = sea
    service = Service(parameters, arpa or ArpaParameters(zones=ZONES))
    memory = service.start()
    for scan in scans[:-1]:
        memory, _ = service.step(memory, moved(scan), HEADING)
    return memory


@pytest.fixture(scope='module')
def sailed(sea):
    return sail(sea)


@pytest.fixture
def ends(sea, sailed):
    """The last scan as an ARPA with these parameters takes it: its output and what is seen."""

    def end(sensors=None, heading=HEADING, memory=sailed, moved=lambda scan: scan, **parameters):
        service = Service(sea[2], ArpaParameters(zones=ZONES, **parameters))
        known, output = service.step(memory, moved(sea[0][-1]), heading, sensors or OwnSensors())
        seen = view(output.picture, output.report, service.tracker.estimator)
        return known, output.picture, seen

    return end


def row_of(sea, seen, ship):
    truth = sea[1]
    away = np.hypot(*(seen.motion.position - truth.position[truth.target == ship][0]).T)
    assert away.min() < 120
    return int(away.argmin())


LOG = (9.4 * KNOT, -0.7 * KNOT)  # ahead and to starboard
CURRENT = SPEED * KNOT * np.array([np.sin(COURSE), np.cos(COURSE)]) - on_deck(*LOG, HEADING)


@pytest.mark.parametrize(
    'log, wanted, by, drift',
    [
        (LOG, {'stabilisation': 'log'}, 'log', CURRENT),
        (LOG, {'stabilisation': 'log', 'water_speed_kn': 3.0}, 'log', CURRENT),
        (
            (np.nan, np.nan),
            {'stabilisation': 'log', 'water_speed_kn': 8.5},
            'speed by hand',
            CURRENT + on_deck(*LOG, HEADING) - on_deck(8.5 * KNOT, 0.0, HEADING),
        ),
        (
            LOG,
            {'stabilisation': 'hand', 'water_speed_kn': 0.0},
            'speed by hand',
            CURRENT + on_deck(*LOG, HEADING),
        ),
    ],
)
def test_speed_through_the_water_makes_all_motion_that_through_the_water(
    sea, ends, log, wanted, by, drift
):
    _, ground, _ = ends()
    _, picture, seen = ends(OwnSensors(log=log), **wanted)
    assert picture.stabilised.reference == seen.stabilised == 'sea' and picture.stabilised.by == by
    assert picture.stabilised.drift == pytest.approx(drift, abs=0.05)
    moved = ground.motion.velocity - picture.motion.velocity
    assert moved == pytest.approx(np.tile(drift, (3, 1)), abs=0.05)
    at_anchor = row_of(sea, seen, ANCHORED)
    assert seen.approach.speed[at_anchor] == pytest.approx(np.hypot(*drift), abs=0.6)
    for name in ('cpa', 'tcpa', 'relative_course', 'relative_speed', 'bow_range'):
        assert getattr(seen.approach, name) == pytest.approx(
            getattr(ground.approach, name), rel=1e-6, nan_ok=True
        )


@pytest.mark.parametrize('wanted', ['log', 'hand'])
def test_without_any_speed_through_the_water_it_is_over_ground(ends, wanted):
    _, picture, _ = ends(stabilisation=wanted)
    assert picture.stabilised.reference == 'ground' and picture.stabilised.by == 'positions'
    _, picture, _ = ends(OwnSensors(log=LOG), heading=np.nan, stabilisation='log')
    assert picture.stabilised.reference == 'ground'  # a log without a heading tells no direction


def test_a_stationary_target_gives_the_ground_where_own_ship_is_reckoned(sea, ends):
    """Own ship's positions drift off by 2.4 knots, as those of a log in a current do."""
    stream = 2.4 * KNOT * np.array([np.sin(4.0), np.cos(4.0)])

    def reckoned(scan):
        own = scan.own_ship
        return scan._replace(
            own_ship=own._replace(
                position=own.position - stream * own.time[:, None], velocity=own.velocity - stream
            )
        )

    memory = sail(sea, moved=reckoned)
    _, true, here = ends()
    away = OwnSensors(way='log')
    _, adrift, seen = ends(away, memory=memory, moved=reckoned)

    def row(ship):
        """By range: positions are off."""
        return int(
            np.abs(seen.approach.range - here.approach.range[row_of(sea, here, ship)]).argmin()
        )

    assert adrift.stabilised.reference == 'sea' and not seen.reference.any()
    assert seen.approach.speed[row(ANCHORED)] == pytest.approx(2.4 * KNOT, abs=0.7)
    number = int(seen.number[row(ANCHORED)])
    _, picture, seen = ends(away, memory=memory, moved=reckoned, reference_target=number)
    assert picture.stabilised.reference == 'ground'
    assert picture.stabilised.by == f'target TT{number:02d}'
    assert seen.number[seen.reference].tolist() == [number]
    assert seen.approach.speed[row(ANCHORED)] == 0
    for ship, speed in ((MEETS, 9.0), (ABEAM, 13.0)):
        assert seen.approach.speed[row(ship)] == pytest.approx(speed * KNOT, abs=0.9)
    assert picture.own.velocity == pytest.approx(true.own.velocity, abs=0.7)


def test_a_reference_target_that_is_not_there_is_none(ends):
    _, picture, seen = ends(reference_target=77)
    assert picture.stabilised.by == 'positions' and not seen.reference.any()


LOST = OwnSensors(north=False)
NORTH = ('bearing', 'course', 'relative_course')


def test_with_the_heading_lost_only_what_is_relative_is_told(sea, ends):
    _, _, before = ends()
    known, picture, seen = ends(LOST)
    assert picture.stabilised.reference == NONE and picture.stabilised.by == 'no heading'
    for name in (*NORTH, 'speed'):
        assert np.isnan(getattr(seen.approach, name)).all()
        assert np.isnan(getattr(seen.approach, name + '_sigma')).all()
    for name in ('range', 'cpa', 'tcpa', 'bow_range', 'bow_time', 'relative_speed'):
        assert getattr(seen.approach, name) == pytest.approx(
            getattr(before.approach, name), nan_ok=True
        )
    k = row_of(sea, seen, ABEAM)
    truth = sea[1]
    offset = truth.position[truth.target == ABEAM][0] - picture.own.position
    relative = wrap_angle(to_range_bearing(offset)[1] - HEADING - seen.bow[k])
    assert abs(relative) < np.radians(0.7)
    assert before.bow == pytest.approx(seen.bow)


def test_with_the_heading_lost_danger_and_guard_zones_go_on_without_true_bearings(sea, ends):
    fresh = sail(sea, ArpaParameters())  # no zone so far: what lies in it now is new
    known, picture, seen = ends(LOST, memory=fresh)
    alive = known.arpa.alerts
    kinds = alive.kind[alive.state == ACTIVE_UNACKNOWLEDGED].tolist()
    assert alarms.DANGER in kinds and alarms.NEW_TARGET in kinds
    texts = alarm_text.text(alive, Service(sea[2], ArpaParameters(zones=ZONES)).arpa.zones)
    said = [text for text, kind in zip(texts, alive.kind) if kind == alarms.NEW_TARGET]
    assert said and all('NM' in text and 'deg' not in text for text in said)
    assert seen.number[row_of(sea, seen, MEETS)] in alive.number[alive.kind == alarms.NEW_TARGET]


def test_with_the_heading_lost_a_log_still_tells_speeds_but_no_courses(ends):
    _, _, known = ends(OwnSensors(log=LOG), stabilisation='log')
    _, picture, seen = ends(LOST._replace(log=LOG), stabilisation='log')
    assert picture.stabilised.reference == 'sea'
    assert seen.approach.speed == pytest.approx(known.approach.speed)
    assert np.isnan(seen.approach.course).all() and np.isnan(seen.approach.bearing).all()


def test_with_own_ships_way_lost_no_course_or_speed_is_told_and_danger_still_is(sea, ends):
    """Her positions stand still: she must not pass for a ship at anchor."""

    def silent(scan):
        own = scan.own_ship
        return scan._replace(
            own_ship=own._replace(position=0 * own.position, velocity=0 * own.velocity)
        )

    memory = sail(sea, moved=silent)
    way = OwnSensors(way=NONE)
    known, picture, seen = ends(way, memory=memory, moved=silent)
    _, _, before = ends()
    assert picture.stabilised.reference == NONE and picture.stabilised.by == 'no speed'
    assert np.isnan(seen.approach.course).all() and np.isnan(seen.approach.speed).all()
    assert np.isfinite(seen.approach.bearing).all()
    nearest = seen.approach.tcpa[np.argmin(seen.approach.cpa)]
    assert nearest == pytest.approx(before.approach.tcpa[np.argmin(before.approach.cpa)], rel=0.1)
    assert (picture.danger > 0).any() and not seen.harmless.any()
