"""What the operator sees besides the targets: trial manoeuvre, stabilisation, zones, two radars."""

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from visualization_msgs.msg import MarkerArray

from marine_tracker.arpa.own_path import TrialManoeuvre
from marine_tracker.arpa.trial_manoeuvre import safe_courses, trial_approach
from marine_tracker.geometry import KNOT, NAUTICAL_MILE
from marine_tracker.nodes import topics
from marine_tracker.nodes.tracker_node import TrackerNode

SHIPS = [(3, 4, 180, 10), (2, 90, 0, 10), (2, 300, 0, 0)]
SCAN_S = 60 / 22
TRIAL = {
    'trial_course_deg': 60.0,
    'trial_speed_kn': 12.0,
    'trial_delay_min': 1.0,
    'trial_turn_rate_deg_min': 60.0,
    'trial_acceleration_mps2': 0.02,
}


@pytest.fixture(scope='module')
def sea(simulated):
    """One ship that meets own ship, at 0.2 NM; one that goes along with her; one at anchor."""
    return simulated(SHIPS, 300)


def test_a_trial_shows_what_would_come_of_it_and_changes_nothing(bridge, sea, core):
    here = bridge(sea, **TRIAL)
    plain = here.listen(DiagnosticArray, topics.TRIAL, topics.latched())
    here.sail(30)
    assert not len(plain)
    assert here.trial(True) == 'trial manoeuvre on; see the topic trial'
    begun = here.last.end
    here.sail(10)
    here.wait(lambda: len(plain) == 10)
    *_, picture = core(here.scans[:40], 0.0, here.tracker)
    entry, *entries = plain[-1].status
    assert (entry.name, entry.message) == ('T', 'TRIAL')
    told = here.about(entry)
    assert (told['course_deg'], told['speed_kn'], told['stabilised']) == ('060.0', '12.0', 'ground')
    left = 60 - (here.last.end - begun)
    assert float(told['countdown_min']) == pytest.approx(left / 60, abs=0.051)
    trial = TrialManoeuvre(np.radians(60), 12 * KNOT, left, np.radians(1.0), 0.02)
    safe = safe_courses(picture.motion, picture.own, trial, 0.5 * NAUTICAL_MILE, 720.0)
    sectors = np.array(
        [
            [float(end) for end in sector.split('-')]
            for sector in told['safe_courses_deg'].split(', ')
        ]
    )
    assert sectors == pytest.approx(np.degrees(safe.sectors), abs=0.5) and len(sectors)
    found = trial_approach(picture.motion, picture.own, trial, 0.5 * NAUTICAL_MILE, 720.0)
    assert [row.name for row in entries] == list(here.rows())
    for row, cpa, tcpa, danger in zip(entries, found.cpa, found.tcpa, found.danger_probability):
        values = here.about(row)
        assert row.message == 'TRIAL'
        assert float(values['cpa_nm']) == pytest.approx(cpa / NAUTICAL_MILE, abs=0.002)
        assert float(values['tcpa_min']) == pytest.approx(tcpa / 60, abs=0.06)
        assert float(values['danger_probability']) == pytest.approx(danger, abs=0.02)
        assert (row.level == DiagnosticStatus.ERROR) == (
            cpa < 0.5 * NAUTICAL_MILE and 0 <= tcpa < 720 or danger >= 0.5
        )

    # The real picture is the core's, which knows of no trial.
    for row, cpa, tcpa in zip(here.rows().values(), picture.approach.cpa, picture.approach.tcpa):
        assert float(row['cpa_nm']) == pytest.approx(cpa / NAUTICAL_MILE, abs=0.002)
        assert row['tcpa_min'] == '' or float(row['tcpa_min']) == pytest.approx(tcpa / 60, abs=0.06)
    assert here.standing() == {f'{here.name_of(1)}: danger': 'active unacknowledged'}
    meeting = next(row for row in entries if row.name == here.name_of(1))
    assert meeting.level == DiagnosticStatus.OK  # that course clears it

    # Live: another course; due, it counts down no further; off, the topic is empty.
    assert here.set(trial_course_deg=0.0)[0].successful
    here.sail(15)
    here.wait(lambda: len(plain) == 25)
    entry, *entries = plain[-1].status
    assert here.about(entry)['countdown_min'] == '0.0'
    assert here.about(entry)['course_deg'] == '000.0'
    meeting = next(row for row in entries if row.name == here.name_of(1))
    assert meeting.level == DiagnosticStatus.ERROR
    assert here.trial(False) == 'trial manoeuvre off'
    here.wait(lambda: len(plain) == 26)
    here.sail(3)
    assert len(plain) == 26 and not plain[-1].status
    assert not here.tracker.failures.counts


def test_a_trial_may_be_on_before_the_first_scan_and_without_own_ship(bridge, sea):
    here = bridge(sea, **TRIAL)
    trial = here.listen(DiagnosticArray, topics.TRIAL, topics.latched())
    here.trial(True)
    here.send(here.scans[:1])
    here.wait(lambda: len(trial) == 1)
    (entry,) = trial[0].status  # own ship was never heard
    assert entry.level == DiagnosticStatus.WARN and 'heading unknown' in entry.message
    trial.messages.clear()
    here._played = 1
    here.sail(8)
    here.wait(lambda: len(trial) == 8)
    assert len(trial[-1].status) == 1 + len(here.rows()) == 4
    countdown = [
        float(here.about(message.status[0])['countdown_min']) for message in trial.messages
    ]
    assert countdown == sorted(countdown, reverse=True) and countdown[-1] == pytest.approx(
        1 - 9 * SCAN_S / 60, abs=0.06
    )
    assert not here.tracker.failures.counts


def test_a_current_makes_courses_and_speeds_those_through_the_water(bridge, sea):
    here = bridge(sea)
    here.sail_on(lambda: any(row['motion'] == 'at rest' for row in here.rows().values()), 90)
    meets, anchored = here.name_of(1), here.name_of(3)
    ground = here.rows()
    assert ground[meets]['stabilised'] == 'ground' and ground[anchored]['motion'] == 'at rest'
    assert (ground[anchored]['speed_kn'], ground[anchored]['course_deg']) == ('0.0', '')
    # 3 kn to the north: who meets makes 13 kn through the water, the anchored one 3 kn south.
    assert here.set(current_set_deg=0.0, current_drift_kn=3.0)[0].successful
    here.sail(1)
    sea_ = here.rows()
    assert {row['stabilised'] for row in sea_.values()} == {'sea'}
    assert float(sea_[meets]['speed_kn']) == pytest.approx(13.0, abs=0.3)
    assert float(sea_[anchored]['speed_kn']) == pytest.approx(3.0, abs=0.05)
    assert sea_[anchored]['course_deg'] == '180.0' and sea_[anchored]['motion'] == 'at rest'
    for key, off in (('cpa_nm', 0.02), ('tcpa_min', 0.15), ('relative_speed_kn', 0.3)):
        assert float(sea_[meets][key]) == pytest.approx(float(ground[meets][key]), abs=off), key
    assert not here.set(current_drift_kn=30.0)[0].successful


def ends(markers, namespace):
    marker = next(marker for marker in markers[-1].markers if marker.ns == namespace)
    return np.array([(p.x, p.y) for p in marker.points]).reshape(-1, 2, 2)


def test_vectors_are_true_or_relative_and_zones_are_drawn(bridge, sea):
    here = bridge(sea, cpa_limit_nm=0.01)
    markers = here.listen(MarkerArray, topics.MARKERS)
    here.sail(25)
    here.wait(lambda: len(markers) == 25)
    north = np.array([0, 10 * KNOT])
    order = np.argsort([here.name_of(ship) for ship in (1, 2, 3)])
    true = np.array([-north, north, [0, 0]])[order]
    vectors = ends(markers, 'vectors')
    assert vectors[:, 0] == pytest.approx(
        np.array([here.place(ship) for ship in (1, 2, 3)])[order], abs=40
    )
    assert np.diff(vectors, axis=1)[:, 0] == pytest.approx(360 * true, abs=200)
    assert not len(ends(markers, 'guard_zones')) and not len(ends(markers, 'exclusion_zones'))

    here.set(
        vectors='relative',
        vector_time_min=3.0,
        zones='[{name: ring, kind: guard, '
        'range_m: [900, 1000]}, {name: quay, kind: exclusion, fixed_to: ground, '
        'corners_m: [[9000, 0], [9100, 0], [9100, 100]]}]',
    )
    here.sail(1)
    here.wait(lambda: len(markers) == 26)
    assert np.diff(ends(markers, 'vectors'), axis=1)[:, 0] == pytest.approx(
        180 * (true - north), abs=100
    )
    own = np.array([0, 10 * KNOT * here.last.end])
    away = np.hypot(*(ends(markers, 'guard_zones') - own).reshape(-1, 2).T)
    assert set(np.round(away, -1)) == {900, 1000}
    corners = {
        tuple(corner) for side in ends(markers, 'exclusion_zones').tolist() for corner in side
    }
    assert corners == {(9000, 0), (9100, 0), (9100, 100)}
    assert not here.tracker.failures.counts


def test_two_radars_have_their_own_targets_alarms_and_commands(bridge, sea):
    bow, stern = bridge(sea, namespace='bow'), bridge(sea, namespace='stern', cpa_limit_nm=0.01)
    for here in (bow, stern):
        here.sail(12)
    danger = f'{bow.name_of(1)}: danger'
    assert bow.standing() == {danger: 'active unacknowledged'} and not len(stern.alarms)
    assert {entry.hardware_id for entry in (*bow.targets[-1].status, *bow.alarms[-1].status)} == {
        'bow/tracker'
    }
    assert stern.ask(topics.CANCEL_ALL) == '3 targets cancelled'
    for here, count in ((bow, 3), (stern, 0)):
        here.sail(1)
        assert len(here.rows()) == count
    assert stern.ask(topics.ACKNOWLEDGE) == '0 alerts acknowledged'
    assert bow.standing() == {danger: 'active unacknowledged'}
    assert bow.ask(topics.ACKNOWLEDGE) == '1 alerts acknowledged'


def test_a_wrong_zones_text_stops_the_start(graph):
    with pytest.raises(ValueError, match='zone quay: kind is'):
        graph.make(TrackerNode, zones='[{name: quay, kind: wall, range_nm: [1, 2]}]')
