"""Commands to a running tracker: which tracks are targets."""

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from marine_tracker.arpa.acquisition import MAX_CLICKS
from marine_tracker.estimators import ESTIMATORS
from marine_tracker.nodes import topics
from marine_tracker.nodes.operator import REFUSED

SHIPS = [(3, 4, 180, 10), (2, 90, 0, 10), (2, 180, 180, 5)]


@pytest.fixture(scope='module')
def sea(simulated):
    """One ship that meets own ship, at 0.2 NM; one that goes along with her; one that leaves."""
    return simulated(SHIPS, 400)


def acquired(bridge):
    return {name: row['acquired'] for name, row in bridge.rows().items()}


def test_points_are_acquired_in_both_frames_and_from_both_topics(bridge, sea):
    here = bridge(sea, acquisition='nowhere', click_radius_m=300.0)
    here.sail(8)
    assert here.rows() == {} and not len(here.alarms)
    here.click(*here.place(1))
    here.sail(1)
    first = here.name_of(1)
    assert acquired(here) == {first: 'M'}
    here.click(*here.place(3), topic=topics.CLICKED_POINT)
    here.sail(1)
    assert len(acquired(here)) == 2 and here.name_of(3) in acquired(here)
    # 2 NM to starboard of own ship, who goes north: x is ahead, y to port.
    here.click(0.0, -2 * 1852.0, frame='base_link')
    here.sail(1)
    assert set(acquired(here)) == {here.name_of(ship) for ship in (1, 2, 3)}
    assert set(acquired(here).values()) == {'M'} and not here.refused()
    # Only what was acquired raises alarms; the tracks are there all the time.
    here.sail(4)
    assert here.standing() == {f'{first}: danger': 'active unacknowledged'}


def test_what_cannot_be_acquired_is_refused_and_counted(bridge, sea):
    here = bridge(sea, acquisition='nowhere', click_wait_s=5.0)
    diagnostics = here.listen(DiagnosticArray, topics.DIAGNOSTICS)
    here.click(1000.0, 0.0, frame='base_link')  # own ship was not heard yet
    here.click(0.0, 0.0, frame='odom')
    here.click(np.nan, 0.0)
    here.sail(8)
    assert here.refused() == 3
    for _ in range(MAX_CLICKS):
        here.click(-5000.0, -5000.0)
    here.click(-5000.0, -5000.0)
    assert here.refused() == 4
    # Where nothing comes up in time, the click lapses, and that is said.
    here.sail(1)
    assert here.refused() == 4
    here.sail(2)
    assert here.refused() == 4 + MAX_CLICKS
    assert here.rows() == {} and not here.tracker.failures.counts

    here.wait(
        lambda: any(
            here.about(entry).get(REFUSED) == str(4 + MAX_CLICKS)
            for message in diagnostics.messages
            for entry in message.status
        )
    )


def test_a_click_before_the_first_echo_is_answered_when_it_comes(bridge, sea):
    here = bridge(sea, acquisition='nowhere')
    here.sail(1)
    here.click(*here.place(2))
    here.sail(1)
    ((name, row),) = here.rows().items()
    assert name.startswith('Q') and row['acquired'] == 'M'
    assert (row['status'], row['level']) == ('ACQUIRING', DiagnosticStatus.OK)
    here.sail_on(lambda: name not in here.rows())
    ((name, row),) = here.rows().items()
    assert name == here.name_of(2) and name.startswith('TT')
    assert (row['status'], row['acquired']) == ('TRACKING', 'M')


def test_only_guard_zones_acquire_when_told_so(bridge, sea):
    here = bridge(
        sea,
        acquisition='zones',
        cpa_limit_nm=0.01,
        zones='[{name: ring, kind: guard, range_nm: [2.4, 2.8]}]',
    )
    here.sail(8)
    assert here.rows() == {}
    here.sail(8)  # after 36 s the first is nearer than 2.8 NM
    ((name, row),) = here.rows().items()
    assert name == here.name_of(1) and row['acquired'] == 'A'
    here.set(acquisition='everywhere')
    here.sail(1)
    assert len(here.rows()) == 3
    here.set(acquisition='nowhere')
    here.sail(1)
    assert len(here.rows()) == 3  # who is a target stays one
    (answer,) = here.set(acquisition='sometimes')
    assert not answer.successful and 'everywhere, zones, nowhere' in answer.reason


def test_targets_are_cancelled_and_come_back_by_a_click(bridge, sea):
    here = bridge(sea)
    here.sail_on(lambda: here.told_of('danger'))
    name = here.name_of(1)
    others = set(here.rows()) - {name}
    here.cancel(int(name[2:]))
    here.awaits(f'{name}: danger', 'normal')  # at once, and for good
    here.sail(10)
    assert set(here.rows()) == others and not here.refused()
    assert set(here.standing().values()) == {'normal'}
    for number in (int(name[2:]), 99, 0):
        here.cancel(number)
    here.wait(lambda: here.refused() == 3)
    assert here.ask(topics.CANCEL_ALL) == '2 targets cancelled'
    here.sail(3)
    assert here.rows() == {} and here.ask(topics.CANCEL_ALL) == '0 targets cancelled'
    here.click(*here.place(1))
    here.sail(3)
    assert acquired(here) == {name: 'M'}  # the number it had
    assert here.standing() == {f'{name}: danger': 'active unacknowledged'}
    assert not here.tracker.failures.counts


def test_nothing_is_lost_by_another_estimator(bridge, sea):
    here = bridge(sea)
    here.sail_on(lambda: here.told_of('danger'))
    danger = f'{here.name_of(1)}: danger'
    here.click(*here.place(2))
    here.sail(1)
    here.ask(topics.ACKNOWLEDGE)
    here.awaits(danger, 'active acknowledged')
    before, ships = (
        acquired(here),
        {name: here.name_of(ship) for ship, name in enumerate(('meets', 'beside', 'leaves'), 1)},
    )
    assert before == {ships['meets']: 'A', ships['beside']: 'M', ships['leaves']: 'A'}
    for name in ESTIMATORS:
        assert here.set(estimator=name, vessel_class='ship')[0].successful
        here.sail(4)
        assert acquired(here) == before
        assert {row['status'] for row in here.rows().values()} == {'TRACKING'}
        assert {row['estimator'] for row in here.rows().values()} == {name}
        assert [here.name_of(ship) for ship in (1, 2, 3)] == list(ships.values())
        assert here.standing() == {danger: 'active acknowledged'}
    assert here.told_of('danger') == {danger: ['active unacknowledged', 'active acknowledged']}
    assert not here.tracker.failures.counts
