"""Alarms of a running tracker, each through its life: raised, acknowledged, rectified, normal."""

import time

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from marine_tracker.geometry import own_ship_at
from marine_tracker.nodes import convert, topics

ACTIVE, SEEN, RECTIFIED, NORMAL = (
    'active unacknowledged',
    'active acknowledged',
    'rectified unacknowledged',
    'normal',
)
MEETING, BESIDE, LEAVING = (3, 4, 180, 10), (2, 90, 0, 10), (2, 180, 180, 5)
RING = '[{name: ring, kind: guard, range_nm: [2.5, 2.8], bearing_deg: [315, 045]}]'


@pytest.fixture(scope='module')
def sea(simulated):
    """One ship that meets own ship, at 0.2 NM; one that goes along with her; one that leaves."""
    return simulated([MEETING, BESIDE, LEAVING], 700)


def test_a_danger_is_raised_acknowledged_and_over(bridge, sea):
    here = bridge(sea)
    here.sail(3)
    assert here.told_of('danger') == {}  # a guess yet
    scans = 3 + here.sail_on(lambda: here.told_of('danger'))
    assert scans * 60 / 22 < 40
    name = here.name_of(1)
    danger, number = f'{name}: danger', int(name[2:])
    assert here.standing() == {danger: ACTIVE}
    entry, target = here.alarm(danger), here.rows()[name]
    assert entry.level == target['level'] == DiagnosticStatus.ERROR
    assert {row['level'] for other, row in here.rows().items() if other != name} == {
        DiagnosticStatus.OK
    }
    about = here.about(entry)
    assert (about['kind'], about['priority'], about['target'], about['in_state_s']) == (
        'danger',
        'alarm',
        name,
        '0',
    )
    assert np.hypot(*(here.place(1) - [float(about['east_m']), float(about['north_m'])])) < 100
    assert entry.message.startswith(f'{name} dangerous: CPA 0.')
    assert convert.nanoseconds(here.alarms[-1].header.stamp) == here.stamp(here.last.end)

    assert here.ask(topics.ACKNOWLEDGE) == '1 alerts acknowledged'
    here.awaits(danger, SEEN)
    here.sail(20)
    assert here.standing() == {danger: SEEN} and here.rows()[name]['level'] == target['level']

    # Live limits: at the next scan the danger is none, 15 s later that is sure.
    assert here.set(cpa_limit_nm=0.05)[0].successful
    here.sail(5)
    assert here.standing() == {danger: SEEN}
    here.sail(2)
    here.awaits(danger, NORMAL)
    assert here.rows()[name]['level'] == DiagnosticStatus.OK

    # Raised again, by the other limit, once the encounter has clearly ended; by its number
    # acknowledged.
    assert here.set(cpa_limit_nm=0.5, tcpa_limit_min=1.0)[0].successful
    here.sail(30)
    assert here.standing() == {danger: NORMAL}
    assert here.set(tcpa_limit_min=12.0)[0].successful
    here.sail(3)
    here.awaits(danger, ACTIVE)
    here.acknowledge_target(number)
    here.awaits(danger, SEEN)

    # Over before anybody looked: it still wants to be acknowledged.
    here.set(cpa_limit_nm=0.05)
    here.sail(7)
    here.awaits(danger, NORMAL)
    here.sail(26)
    here.set(cpa_limit_nm=0.5)
    here.sail(3)
    here.awaits(danger, ACTIVE)
    here.set(cpa_limit_nm=0.05)
    here.sail(7)
    here.awaits(danger, RECTIFIED)
    assert here.ask(topics.ACKNOWLEDGE) == '1 alerts acknowledged'
    here.awaits(danger, NORMAL)
    assert here.told_of('danger') == {
        danger: [ACTIVE, SEEN, NORMAL, ACTIVE, SEEN, NORMAL, ACTIVE, RECTIFIED, NORMAL]
    }
    assert not here.tracker.failures.counts and not here.refused()


def test_what_cannot_be_acknowledged_is_refused(bridge, sea):
    here = bridge(sea)
    here.sail(5)
    here.acknowledge_target(77)
    here.wait(lambda: here.refused() == 1)
    here.sail_on(lambda: here.told_of('danger'))
    here.acknowledge_target(int(here.name_of(2)[2:]))  # a target, but without an alarm
    here.wait(lambda: here.refused() == 2)
    assert here.ask(topics.ACKNOWLEDGE) == '1 alerts acknowledged'
    assert here.ask(topics.ACKNOWLEDGE) == '0 alerts acknowledged'


def test_a_lost_target_is_told_with_its_last_position(bridge, sea):
    here = bridge(sea, cpa_limit_nm=0.01)
    here.sail(25)
    name = here.name_of(2)
    lost = f'{name}: lost target'
    here.without(2, 10)
    here.awaits(lost, ACTIVE)
    entry = here.alarm(lost)
    about = here.about(entry)
    assert about['priority'] == 'warning' and entry.level == DiagnosticStatus.WARN
    told = [
        row for message in here.targets.messages for row in message.status if row.message == 'LOST'
    ]
    assert [row.name for row in told] == [name] and here.about(told[0])['reason'] != ''
    place = [float(about['east_m']), float(about['north_m'])]
    assert np.hypot(*(here.place(2) - place)) < 150  # it went on as before
    # A loss is over when it is acknowledged, not by itself.
    here.without(2, 20)
    assert here.standing() == {lost: ACTIVE}
    here.acknowledge_target(int(name[2:]))
    here.awaits(lost, NORMAL)
    assert name not in here.rows()


def test_a_guard_zone_tells_who_enters_and_who_was_there_and_may_change(bridge, sea):
    here = bridge(sea, zones=RING, cpa_limit_nm=0.01)
    here.sail(6)
    ships = [here.name_of(ship) for ship in (1, 2, 3)]
    meeting = f'{ships[0]}: new target in ring'
    assert here.told_of('new target') == {}
    # 3 NM off and 20 kn nearer: at 2.8 NM after 36 s, at 2.5 after 90.
    here.sail(10)
    here.awaits(meeting, ACTIVE)
    assert 'in guard zone ring' in here.alarm(meeting).message
    assert here.about(here.alarm(meeting))['zone'] == 'ring'
    here.ask(topics.ACKNOWLEDGE)
    here.awaits(meeting, SEEN)

    # A wrong text is refused with its reason, and nothing changes.
    for text, reason in (('[{name: x, kind: gard}]', 'kind'), ('{', 'YAML'), ('7', 'list')):
        (answer,) = here.set(zones=text)
        assert not answer.successful and reason in answer.reason
        assert here.tracker.get_parameter('zones').value == RING
    here.sail(1)
    assert here.standing() == {meeting: SEEN}

    # A new zone around a target that is there already speaks at the next scan.
    assert here.set(
        zones=RING[:-1] + ', {name: beam, kind: guard, range_nm: [1.8, 2.2], '
        'bearing_deg: [45, 135]}]'
    )[0].successful
    here.sail(1)
    beam = f'{ships[1]}: new target in beam'
    here.awaits(beam, ACTIVE)
    here.sail(30)  # the other has left the ring by now
    assert here.told_of('new target') == {meeting: [ACTIVE, SEEN, NORMAL], beam: [ACTIVE]}
    # Without the zone there is no cause.
    assert here.set(zones='')[0].successful
    here.sail(8)
    here.awaits(f'{ships[1]}: new target', RECTIFIED)


def test_nothing_in_an_exclusion_zone_is_a_target(bridge, sea):
    here = bridge(sea, cpa_limit_nm=0.01)
    here.sail(6)
    assert len(here.rows()) == 3
    assert here.set(
        zones='[{name: beam, kind: exclusion, range_nm: [1.5, 2.5], bearing_deg: [60, 120]}]'
    )[0].successful
    here.sail(1)
    assert here.name_of(2) is None and len(here.rows()) == 2
    here.without(2, 10)  # nor does its loss raise an alarm
    assert not len(here.alarms)


def test_when_there_are_as_many_targets_as_may_be_that_is_told(bridge, sea):
    here = bridge(sea, cpa_limit_nm=0.01, max_targets=3)
    here.sail(8)
    assert here.standing() == {'capacity': ACTIVE, 'near capacity': SEEN}
    assert here.alarm('capacity').message == (
        '3 targets, as many as may be; 0 more are not acquired'
    )
    name = here.name_of(3)
    assert here.set(max_targets=2)[0].successful
    here.sail(1)
    assert len(here.rows()) == 2 and name not in here.rows()  # who leaves gives way
    assert here.set(max_targets=200)[0].successful
    here.sail(8)
    assert len(here.rows()) == 3
    here.awaits('capacity', RECTIFIED)
    here.ask(topics.ACKNOWLEDGE)
    here.awaits('capacity', NORMAL)
    assert here.told_of('near capacity') == {'near capacity': [SEEN, NORMAL]}


def test_silent_sensors_are_told_one_by_one(bridge, sea):
    here = bridge(sea, sensor_timeout_s=0.5, cpa_limit_nm=0.01, scan_period_s=0.2)
    missing = [f'{sensor} missing' for sensor in ('heading', 'position', 'plots')]
    here.wait(lambda: all(here.standing().get(name) == ACTIVE for name in missing))
    assert {entry.level for entry in here.alarms[-1].status} == {DiagnosticStatus.WARN}
    for sensor in ('heading', 'position', 'plots'):
        assert here.alarm(f'{sensor} missing').message.startswith(f'no {sensor} for ')
    here.ask(topics.ACKNOWLEDGE)

    # Plots, and a position without an orientation: only the heading is missing then.
    heading, position, plots = missing
    pause = 0.05  # the sensors are looked at every second, and the scene has 250 scans

    def without_heading():
        time.sleep(pause)
        here._played += 1
        end = here.last.end
        blind = here.odometry(here.stamp(end), *own_ship_at(here.last.own_ship, end))
        blind.pose.pose.orientation.w = blind.pose.pose.orientation.z = 0.0
        here.own_ship.publish(blind)
        here.send([here.last])
        return {name: here.standing().get(name) for name in missing} == {
            heading: SEEN,
            position: NORMAL,
            plots: NORMAL,
        }

    here.wait(without_heading)

    def with_everything():
        time.sleep(pause)
        here.sail(1)
        return here.standing().get(heading) == NORMAL

    here.wait(with_everything)
    # Silence again; the stamp goes on with the wall, or the age would be below 0.
    here.wait(lambda: here.standing().get(plots) == ACTIVE)
    ages = [
        float(here.about(entry)['in_state_s'])
        for message in here.alarms.messages
        for entry in message.status
    ]
    assert min(ages) >= 0


def test_an_antenna_slower_than_the_timeout_is_not_missed(bridge, sea):
    here = bridge(sea, sensor_timeout_s=0.5, scan_period_s=1.2)
    for _ in range(3):
        here.sail(1)
        time.sleep(1.2)  # the sensors are looked at every second
    assert here.told_of('plots missing') == {}
    here.awaits('plots missing', ACTIVE)  # three revolutions later


def test_who_may_be_taken_for_another_is_told_while_it_lasts(bridge, simulated):
    here = bridge(simulated([(2, 90, 0, 10), (2.2, 90, 330, 10)], 300), cpa_limit_nm=0.01)
    here.sail(12)
    risks = {f'{here.name_of(ship, 100)}: swap risk' for ship in (1, 2)}
    assert len(risks) == 2 and here.told_of('swap risk') == {}
    here.sail_on(lambda: set(here.standing()) == risks)  # they come as near as 95 m
    assert all(0 <= float(row['swap_risk'] or 0) <= 0.5 for row in here.rows().values())
    assert {entry.level for entry in here.alarms[-1].status} == {DiagnosticStatus.WARN}
    here.sail_on(lambda: set(here.standing().values()) == {NORMAL})
    assert all(float(row['swap_risk'] or 0) < 0.05 for row in here.rows().values())
    assert here.told_of('swap risk') == dict.fromkeys(risks, [SEEN, NORMAL])  # a caution


def test_who_lies_at_anchor_is_not_nagged_of_those_who_do_too(bridge, simulated):
    here = bridge(simulated([(0.2, 30, 0, 0), (0.4, 200, 0, 0), (1.5, 90, 0, 0)], 400, own_speed=0))
    here.sail(140)
    assert [row['motion'] for row in here.rows().values()] == ['at rest'] * 3
    assert {row['speed_kn'] for row in here.rows().values()} == {'0.0'}
    assert here.told_of('danger') == {}


def test_who_comes_late_gets_targets_and_alarms(bridge, sea, node_helpers):
    here = bridge(sea)
    here.sail_on(lambda: here.told_of('danger'))
    _, listener = node_helpers
    late = {
        topic: listener(here.other, DiagnosticArray, topic, topics.latched())
        for topic in (topics.TARGETS, topics.ALARMS)
    }
    here.wait(lambda: all(len(ears) for ears in late.values()))
    assert late[topics.TARGETS][-1] == here.targets[-1]
    assert late[topics.ALARMS][-1] == here.alarms[-1]


def test_a_failure_in_a_scan_costs_no_target_and_no_alarm(bridge, sea, monkeypatch):
    here = bridge(sea)
    here.sail_on(lambda: here.told_of('danger'))
    before, standing = list(here.rows()), here.standing()

    def fail(*_):
        raise RuntimeError('on purpose')

    with monkeypatch.context() as patch:
        patch.setattr(here.tracker._operator.service.arpa, 'step', fail)
        here.radar.publish(
            convert.plots_to_cloud(
                here.scans[here._played], here.stamp(here.scans[here._played].start)
            )
        )
        here.wait(lambda: here.tracker.failures.counts.total() == 1)
    here._played += 1
    here.sail(5)
    assert list(here.rows()) == before and here.standing() == standing
    assert here.tracker.failures.counts.total() == 1
