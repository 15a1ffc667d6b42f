"""Acknowledgements over DDS: remembered, for a time; and own ship at anchor."""

import pytest

pytest.importorskip('rclpy')

from marine_tracker.nodes import topics

ACTIVE, SEEN, NORMAL = 'active unacknowledged', 'active acknowledged', 'normal'


@pytest.fixture(scope='module')
def meeting(simulated):
    """One ship that meets own ship at 0.25 NM."""
    return simulated([(3.6, 4, 180, 9)], 400)


def raised(here):
    """The name of the danger, once it is raised."""
    here.sail_on(lambda: here.told_of('danger'))
    danger = f'{here.name_of(1)}: danger'
    here.awaits(danger, ACTIVE)
    return danger


def test_an_acknowledgement_for_half_a_minute_ends_with_it(bridge, meeting):
    here = bridge(meeting, acknowledge_for_min=0.5)
    danger = raised(here)
    assert here.ask(topics.ACKNOWLEDGE) == '1 alerts acknowledged'
    here.awaits(danger, SEEN)
    assert here.about(here.alarm(danger))['acknowledged_for_min'] == '0.5'
    here.sail(8)
    assert here.standing() == {danger: SEEN}
    here.sail(6)
    here.awaits(danger, ACTIVE)
    assert here.about(here.alarm(danger))['acknowledged_for_min'] == ''

    # Without a time, of the one target: until the encounter ends.
    assert here.set(acknowledge_for_min=0.0)[0].successful
    here.acknowledge_target(int(here.name_of(1)[2:]))
    here.awaits(danger, SEEN)
    here.sail(25)
    assert here.told_of('danger') == {danger: [ACTIVE, SEEN, ACTIVE, SEEN]}
    (answer,) = here.set(acknowledge_for_min=-1.0)
    assert not answer.successful and 'acknowledge_for_min' in answer.reason


def test_a_danger_that_comes_back_soon_is_acknowledged_already(bridge, meeting):
    here = bridge(meeting)
    danger = raised(here)
    here.ask(topics.ACKNOWLEDGE)
    here.awaits(danger, SEEN)
    for _ in range(2):
        assert here.set(cpa_limit_nm=0.18)[0].successful
        here.sail_on(lambda: here.standing() == {danger: NORMAL})
        assert here.set(cpa_limit_nm=0.5)[0].successful
        here.sail_on(lambda: here.standing() == {danger: SEEN})
    assert here.told_of('danger') == {danger: [ACTIVE, SEEN, NORMAL, SEEN, NORMAL, SEEN]}


def test_at_anchor_only_who_comes_nearer_is_a_danger(bridge, simulated):
    """Own ship drives at 1.5 kn on a ship that lies still; another comes for her."""
    here = bridge(simulated([(0.25, 5, 0, 0), (2, 300, 120, 10)], 500, own_speed=1.5))
    here.sail_on(lambda: len(here.told_of('danger')) == 2)
    still, comes = (f'{here.name_of(ship)}: danger' for ship in (1, 2))
    assert set(here.standing()) == {still, comes}
    here.ask(topics.ACKNOWLEDGE)
    here.wait(lambda: set(here.standing().values()) == {SEEN})
    assert here.set(own_ship_status='anchored')[0].successful
    here.sail(8)
    here.wait(lambda: here.standing() == {still: NORMAL, comes: SEEN})
    here.sail(25)  # a minute later the encounter with the one has ended: at sea it is a new one
    assert here.set(own_ship_status='under_way')[0].successful
    here.sail_on(lambda: here.standing().get(still) == ACTIVE)
    (answer,) = here.set(own_ship_status='moored')
    assert not answer.successful and 'own_ship_status' in answer.reason
