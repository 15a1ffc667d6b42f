"""Acquisition, alarms and past positions on the tracks of the real tracker."""

import numpy as np
import pytest

from marine_tracker.arpa import acquisition, alarms, alerts, cpa, motion, past_positions, zones
from marine_tracker.arpa.own_motion import own_motion
from marine_tracker.arpa.situation import Limits, look
from marine_tracker.arpa.swap_risk import swap_risk
from marine_tracker.arpa.targets import EVENTS
from marine_tracker.geometry import NAUTICAL_MILE, locate, unit_vector
from marine_tracker.parameters import TrackerParameters
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import meetings
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import take

ZONES = """
  - {name: ring, kind: guard, range_nm: [0.5, 1.0]}
  - {name: quay, kind: exclusion, fixed_to: ground,
     corners_m: [[-4500, -700], [-3000, -700], [-3000, 700], [-4500, 700]]}
"""
TRAFFIC = {
    'duration_s': 720,
    'radar': {
        'max_range_nm': 4,
        'range_sigma_m': 10,
        'bearing_sigma_deg': 0.3,
        'pd_near': 1,
        'pd_far': 1,
    },
    'own_ship': {'course_deg': 0, 'speed_kn': 0},
    'targets': [
        {
            'name': 'collides',
            'start': {'range_nm': 3, 'bearing_deg': 0},
            'course_deg': 180,
            'speed_kn': 20,
        },
        {
            'name': 'leaves',
            'start': {'range_nm': 3.5, 'bearing_deg': 90},
            'course_deg': 90,
            'speed_kn': 15,
        },
        {
            'name': 'vanishes',
            'start': {'range_nm': 2, 'bearing_deg': 200},
            'course_deg': 270,
            'speed_kn': 3,
        },
        {
            'name': 'moored',
            'start': {'range_nm': 2, 'bearing_deg': 270},
            'course_deg': 0,
            'speed_kn': 0,
        },
    ],
}
VANISHED = 300.0  # s


@pytest.fixture(scope='module')
def watch():
    """What an hour's log would hold: (s, event or alarm, state, target's place), and the rest."""
    scene = scenario.build(TRAFFIC, 'traffic')
    tracker = Tracker(TrackerParameters(**scene.tracker_parameters()))
    zone, limits = zones.parse(ZONES), Limits()
    memory, moving, targets = tracker.start(), motion.begin(), acquisition.begin()
    alarm, past = alerts.begin(), past_positions.begin(6, 30.0)
    log, quick, behind = [], [], {}
    for k, (scan, truth) in enumerate(radar.simulate(scene, 1)):
        sunk = truth.position[truth.target == 3][0]
        offset = scan.plots.range[:, None] * unit_vector(scan.plots.bearing)
        if scan.start > VANISHED:
            scan = scan._replace(plots=take(scan.plots, np.hypot(*(offset - sunk).T) > 500))
        now = scan.end
        if k == 0:
            targets = acquisition.acquire(targets, truth.position[truth.target == 1][0], now)
        memory, report = tracker.step(memory, scan)
        plots = locate(
            scan.plots, scan.own_ship, 10.0, np.radians(tracker.parameters.bearing_sigma_deg)
        )
        moving = motion.step(moving, report, plots, motion.MotionSettings())
        shown = motion.at(moving, now)
        own = own_motion(scan.own_ship, now, 0.0)
        situation = look(
            report.tracks,
            report.reason,
            shown.position,
            cpa.approach(shown, own, limits.cpa, limits.tcpa),
            shown.stationary,
            zone,
            own,
            limits,
        )
        targets, events = acquisition.step(
            targets, acquisition.AcquisitionSettings(), situation, now
        )
        gates = swap_risk(
            shown.position,
            shown.covariance[:, :2, :2] + 400 * np.eye(2),
            own.position,
            tracker.gate_size,
        )
        alarm, changed = alarms.step(
            alarm,
            alarms.AlarmSettings(),
            situation,
            targets,
            events,
            zone,
            alarms.Tracking(200, 0, *gates, *meetings.told(report.meetings, report.tracks.id)),
            now,
        )
        past = past_positions.step(
            past, report.tracks.id, report.tracks.first_time, shown, own, now
        )
        log += [(now, EVENTS[kind], '', place) for kind, place in zip(events.kind, events.position)]
        log += [
            (now, alarms.NAMES[kind], alerts.STATES[state], place)
            for kind, state, place in zip(changed.kind, changed.state, changed.position)
        ]
        quick.append(targets.targets.number[targets.targets.acquired == 1].tolist())
        if k == 150:
            behind = {
                name: (
                    past.time,
                    past.position[
                        np.hypot(
                            *(shown.position - truth.position[truth.target == target][0]).T
                        ).argmin()
                    ],
                )
                for name, target in (('collides', 1), ('moored', 4))
            }
        alarm, _ = alarms.acknowledge(alarm, now)
    return log, quick, behind


def times(log, what, state):
    return [now for now, kind, was, _ in log if (kind, was) == (what, state)]


def test_a_click_on_the_first_echo_acquires_before_the_tracker_confirms(watch):
    _, quick, _ = watch
    assert quick[0] == [] and quick[1] == [0]  # pending; in acquisition with two plots
    confirmed = next(k for k, numbers in enumerate(quick) if numbers and numbers[0])
    assert 2 <= confirmed <= 4


def test_the_collision_raises_once_and_ends_after_it(watch):
    (raised,) = times(watch[0], 'danger', 'active unacknowledged')
    (ended,) = times(watch[0], 'danger', 'normal')
    assert raised < 30.0 and 540.0 < ended < 570.0


def test_only_the_ship_that_vanished_is_lost(watch):
    (lost,) = times(watch[0], 'lost target', 'active unacknowledged')
    assert VANISHED < lost < VANISHED + 10 * 60 / 22 + 0.1  # within 10 scans
    (place,) = (
        place
        for _, kind, state, place in watch[0]
        if (kind, state) == ('lost target', 'active unacknowledged')
    )
    expected = 2 * NAUTICAL_MILE * unit_vector(np.radians(200.0)) + [-VANISHED * 3 / 3600 * 1852, 0]
    assert np.hypot(*(place - expected)) < 100
    (left,) = times(watch[0], 'left by range', '')
    assert 110 < left < 150


def test_the_guard_ring_tells_of_each_entry(watch):
    raised = times(watch[0], 'new target', 'active unacknowledged')
    inward, outward = 2 / 20 * 3600, 3.5 / 20 * 3600
    assert raised == pytest.approx([inward, outward], abs=6.0)


def test_what_lies_at_the_quay_is_never_a_target(watch):
    acquired = np.array([place for _, kind, _, place in watch[0] if kind == 'acquired'])
    assert len(acquired) == 3
    assert np.hypot(*(acquired + [2 * NAUTICAL_MILE, 0]).T).min() > 1000


def test_past_positions_are_where_the_ships_were(watch):
    for name, speed in (('collides', 20 * 1852 / 3600), ('moored', 0.0)):
        time, position = watch[2][name]
        assert -np.diff(time) == pytest.approx(30.0)
        start = {'collides': [0, 3], 'moored': [-2, 0]}[name]
        expected = np.multiply(start, NAUTICAL_MILE) - np.outer(time, [0, speed])
        assert np.hypot(*(position - expected).T).max() < 60
