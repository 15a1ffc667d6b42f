"""The whole way of the ARPA, on the tracks of the real tracker."""

import numpy as np
import pytest

from marine_tracker.arpa import alarms
from marine_tracker.arpa.arpa import Arpa
from marine_tracker.arpa.situation import DANGEROUS
from marine_tracker.estimators import ESTIMATORS
from marine_tracker.geometry import KNOT, NAUTICAL_MILE
from marine_tracker.parameters import ArpaParameters, TrackerParameters, from_mapping
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking.lifecycle import LOST
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import take

HEADING = 0.0
MEETS, BESIDE, ANCHORED = 1, 2, 3
SHIPS = {MEETS: (3, 4, 180, 10), BESIDE: (2, 90, 0, 10), ANCHORED: (2, 300, 0, 0)}


def simulate(ships, seconds, own_speed=10, seed=1, pd=1):
    """Scans and truths of ships (range NM, bearing deg, course deg, speed kn), and the tracker's
    parameters."""
    built = scenario.build(
        {
            'duration_s': seconds,
            'own_ship': {'course_deg': 0, 'speed_kn': own_speed},
            'radar': {
                'max_range_nm': 6,
                'range_sigma_m': 10,
                'bearing_sigma_deg': 0.3,
                'pd_near': pd,
                'pd_far': pd,
            },
            'targets': [
                {
                    'start': {'range_nm': away, 'bearing_deg': bearing},
                    'speed_kn': speed,
                    'course_deg': course,
                }
                for away, bearing, course, speed in ships
            ],
        },
        'sea',
    )
    scans, truths = zip(*radar.simulate(built, seed))
    return scans, truths, from_mapping(TrackerParameters, built.tracker_parameters())


@pytest.fixture(scope='module')
def sea():
    return simulate(SHIPS.values(), 270)


@pytest.fixture(scope='module')
def last_picture(sea):
    *_, (_, _, picture) = run(sea)
    return picture


def run(sea, parameters=None, heading=HEADING, fallen=False):
    """Report, memory and picture after each scan."""
    scans, _, tracker_parameters = sea
    tracker = Tracker(tracker_parameters)
    arpa = Arpa(parameters or ArpaParameters(), tracker_parameters)
    tracked, memory = tracker.start(), arpa.start()
    for scan in scans:
        tracked, report = tracker.step(tracked, scan)
        memory, picture = arpa.step(memory, scan, report, heading, fallen)
        yield report, memory, picture


def row_at(picture, truth, ship):
    away = np.hypot(*(picture.motion.position - truth.position[truth.target == ship][0]).T)
    assert away.min() < 100
    return int(away.argmin())


def test_what_is_told_of_the_targets_is_true(sea):
    scans, truths, _ = sea
    *_, (report, _, picture) = run(sea)
    assert picture.time == scans[-1].end
    assert picture.own.velocity == pytest.approx([0, 10 * KNOT], abs=0.05)
    assert picture.targets.number.tolist() == [1, 2, 3]
    assert report.tracks.id[picture.row].tolist() == picture.targets.id.tolist()
    rows = {ship: row_at(picture, truths[-1], ship) for ship in SHIPS}
    assert sorted(rows.values()) == [0, 1, 2]
    approach, meets = picture.approach, rows[MEETS]
    assert approach.cpa[meets] / NAUTICAL_MILE == pytest.approx(
        3 * np.sin(np.radians(4)), abs=3 * approach.cpa_sigma[meets] / NAUTICAL_MILE
    )
    assert approach.tcpa[meets] == pytest.approx(
        3 * np.cos(np.radians(4)) / 20 * 3600 - picture.time, abs=5
    )
    assert picture.danger[meets] == DANGEROUS
    assert approach.relative_speed[rows[BESIDE]] < 0.3
    assert picture.motion.stationary[rows[ANCHORED]] and not picture.harmless.any()
    assert not picture.motion.velocity[rows[ANCHORED]].any()
    assert not picture.swapped.any()


def test_a_step_leaves_its_inputs_as_they_are_and_repeats_to_the_byte(sea):
    scans, _, parameters = sea
    tracker, arpa = Tracker(parameters), Arpa(ArpaParameters(), parameters)
    *_, (_, memory, _) = run((scans[:20], None, parameters))
    tracked = tracker.start()
    for scan in scans[:21]:
        tracked, report = tracker.step(tracked, scan)

    def flat(thing):
        return sum(map(flat, thing), []) if isinstance(thing, tuple) else [np.array(thing)]

    before = flat(memory)
    first, second = (flat(arpa.step(memory, scans[20], report, HEADING)) for _ in range(2))
    for one, other in ((before, flat(memory)), (first, second)):
        assert all(a.tobytes() == b.tobytes() for a, b in zip(one, other, strict=True))


def test_a_lost_target_stands_in_the_picture_once_more(sea):
    scans, truths, parameters = sea
    silent = [
        scan
        if k < 60
        else scan._replace(plots=take(scan.plots, np.zeros(len(scan.plots.time), bool)))
        for k, scan in enumerate(scans[:80])
    ]
    pictures = [(report, picture) for report, _, picture in run((silent, truths, parameters))]
    last = {}  # scan in which each target stood last, and where
    for k, (report, picture) in enumerate(pictures):
        gone = report.tracks.status[picture.row] == LOST
        for number, at, lost in zip(picture.targets.number, picture.motion.position, gone):
            assert number not in last or not last[number][2]  # once more, and never again
            last[number] = k, at, lost
    assert set(last) == {1, 2, 3} and all(lost for _, _, lost in last.values())
    assert all(60 < k <= 71 for k, _, _ in last.values())
    alerts = pictures[max(k for k, _, _ in last.values())][1].alerts
    lost = alerts.kind == alarms.LOST_TARGET
    assert set(alerts.number[lost]) == {1, 2, 3}
    for number, position in zip(alerts.number[lost], alerts.position[lost]):
        assert position == pytest.approx(last[number][1])


def test_another_arpa_goes_on_from_the_memory(sea):
    scans, _, parameters = sea
    *_, (_, memory, _) = run((scans[:30], None, parameters))
    tracker = Tracker(parameters)
    tracked = tracker.start()
    for scan in scans[:31]:
        tracked, report = tracker.step(tracked, scan)
    other = Arpa(
        ArpaParameters(cpa_limit_nm=0.01, max_targets=2, acquisition='nowhere'), parameters
    )
    after, picture = other.step(memory, scans[30], report, HEADING)
    assert len(picture.targets.id) == 2 and set(picture.targets.id) < set(
        memory.acquisition.targets.id
    )
    assert (picture.danger != DANGEROUS).all()
    assert alarms.CAPACITY in after.alerts.kind


def test_a_current_changes_courses_and_speeds_but_not_how_near_they_come(sea):
    *_, (_, _, ground) = run(sea)
    *_, (_, _, water) = run(sea, ArpaParameters(current_set_deg=90.0, current_drift_kn=4.0))
    for name in (
        'cpa',
        'tcpa',
        'relative_course',
        'relative_speed',
        'danger_probability',
        'cpa_sigma',
        'bow_range',
    ):
        assert getattr(water.approach, name) == pytest.approx(
            getattr(ground.approach, name), rel=1e-9, abs=1e-9, nan_ok=True
        )
    drift = [4 * KNOT, 0]
    assert ground.motion.velocity - water.motion.velocity == pytest.approx(np.tile(drift, (3, 1)))
    assert ground.own.velocity - water.own.velocity == pytest.approx(drift)
    assert water.stabilised.reference == 'sea'
    assert ground.stabilised.reference == 'ground'


def test_only_targets_that_have_fallen_back_count(sea):
    """Of tracks that are no targets nobody wants to know."""
    fallen = [memory.alerts for _, memory, _ in run(sea, fallen=True)]
    assert alarms.FALLBACK in fallen[-1].kind
    row = fallen[-1].kind == alarms.FALLBACK
    assert fallen[-1].values[row, :2].tolist() == [[3.0, 3.0]]
    nowhere = [
        memory.alerts
        for _, memory, _ in run(sea, ArpaParameters(acquisition='nowhere'), fallen=True)
    ]
    assert not len(nowhere[-1].kind)


def test_without_a_heading_everything_goes_on_but_the_bow():
    crossing = simulate([(3, 45, 270, 14)], 100)
    *_, (_, _, known) = run(crossing)
    *_, (_, _, blind) = run(crossing, heading=np.nan)
    # She has 2.12 NM to go at 14 kn until she crosses, own ship as much at 10.
    assert known.approach.bow_time + known.time == pytest.approx(2.121 / 14 * 3600, abs=20)
    assert known.approach.bow_range / NAUTICAL_MILE == pytest.approx(2.121 * (1 - 10 / 14), abs=0.1)
    assert np.isnan(blind.approach.bow_range).all()
    for name in ('range', 'bearing', 'course', 'speed', 'cpa', 'danger_probability'):
        assert np.array_equal(getattr(known.approach, name), getattr(blind.approach, name))


def test_ships_at_anchor_raise_no_danger_in_an_own_ship_at_anchor():
    """Of 48 ships at 0.2 to 4 NM for 3 minutes; without the rule one in ten did."""
    rng, raised, resting = np.random.default_rng(5), 0, 0
    for seed in range(4):
        ships = [
            (away, bearing, 0, 0)
            for away, bearing in zip(
                rng.uniform(0.2, 4, 12).tolist(), np.arange(0.0, 360.0, 30.0).tolist()
            )
        ]
        for _, _, picture in run(simulate(ships, 180, own_speed=0, seed=seed, pd=0.9)):
            raised += (picture.changed.kind == alarms.DANGER).sum()
        resting += picture.harmless.sum()
    assert raised == 0 and resting == 48


def test_a_ship_that_comes_for_an_anchored_own_ship_raises_it_within_a_minute():
    for seed, speed in enumerate((3, 6, 12, 20)):
        bearing = 80.0 * seed
        ship = speed / 6, bearing, (bearing + 180) % 360, speed
        times = [
            picture.time
            for _, _, picture in run(simulate([ship], 120, own_speed=0, seed=seed, pd=0.9))
            if alarms.DANGER in picture.changed.kind
        ]
        assert times and times[0] < 60


@pytest.mark.parametrize('estimator', sorted(ESTIMATORS))
def test_motion_and_approach_hardly_depend_on_the_estimator(sea, last_picture, estimator):
    """They have a memory of their own; only which plots are a track's is the estimator's."""
    scans, truths, parameters = sea
    values = {field: getattr(parameters, field) for field in parameters.__dataclass_fields__}
    one = last_picture
    *_, (_, _, other) = run(
        (scans, truths, TrackerParameters(**{**values, 'estimator': estimator}))
    )
    assert np.array_equal(one.targets.number, other.targets.number)
    for name in ('range', 'bearing', 'speed', 'relative_speed', 'cpa'):
        off = getattr(one.approach, name) - getattr(other.approach, name)
        assert (np.abs(off) <= 0.5 * getattr(one.approach, name + '_sigma')).all(), name


def test_tracks_whose_first_plots_went_by_unseen_are_taken_up(sea):
    """A scan that failed half-way leaves the tracker's tracks without a motion: for one plot."""
    scans, _, parameters = sea
    tracker, arpa = Tracker(parameters), Arpa(ArpaParameters(), parameters)
    tracked, memory = tracker.start(), arpa.start()
    for k, scan in enumerate(scans[:60]):
        tracked, report = tracker.step(tracked, scan)
        if k >= 20:
            memory, picture = arpa.step(memory, scan, report, HEADING)
    assert picture.targets.number.tolist() == [1, 2, 3]
    assert np.isfinite(picture.motion.velocity).all()
    nothing = scans[60]._replace(
        plots=take(scans[60].plots, np.zeros(len(scans[60].plots.time), bool))
    )
    tracked, report = tracker.step(tracked, nothing)
    _, picture = arpa.step(arpa.start(), nothing, report, HEADING)
    assert len(picture.targets.id) == 3 and np.isnan(picture.approach.cpa).all()
    assert not picture.danger.any()


def test_wrong_zones_are_refused(sea):
    with pytest.raises(ValueError, match='zones, line 1 is not YAML'):
        Arpa(ArpaParameters(zones='{'), sea[2])
