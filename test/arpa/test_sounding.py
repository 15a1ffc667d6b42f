"""When alerts sound: silenced for half a minute, warnings again after five."""

import numpy as np
import pytest

from marine_tracker.arpa import alarms, alert_list, alerts, sounding
from marine_tracker.arpa.alerts import (
    ACTIVE_ACKNOWLEDGED,
    ACTIVE_SILENCED,
    ACTIVE_UNACKNOWLEDGED,
    NORMAL,
    RECTIFIED_UNACKNOWLEDGED,
    STATES,
)
from marine_tracker.types import append, take

WELL = alarms.Silence(0.0, 0.0, (0.0,))


class Watch:
    """Sensors that fail and come back, second by second, and an operator."""

    def __init__(self, **settings):
        self.alerts, self.now = alerts.begin(), 1000.0
        self.settings = alarms.AlarmSettings(**settings)
        self.history = alerts.begin()
        self.changes = []

    def after(self, seconds, **failed):
        """The changes in the next seconds: [(name, s from then, state, sounds)]."""
        told = []
        for k in range(1, seconds + 1):
            self.now += 1.0
            self.alerts, changed = alarms.watch(
                self.alerts, self.settings, WELL._replace(**failed), self.now
            )
            told += self._told(changed, k)
        return told

    def silence(self):
        self.alerts, changed = sounding.silence(self.alerts, self.now)
        return self._told(changed)

    def acknowledge(self, **which):
        self.alerts, changed = alarms.acknowledge(self.alerts, self.now, **which)
        return self._told(changed)

    def danger(self, level=alerts.ON, id=7, rule=None):
        """A cause of danger of one target at this moment."""
        one = np.array([id])
        causes = alerts.Causes(
            one, one + 20, np.array([level]), np.zeros((1, 2)), np.full((1, alerts.VALUES), 1.0)
        )
        its = (self.alerts.kind == alarms.DANGER) & (self.alerts.id == id)
        found, changed = alerts.advance(
            take(self.alerts, its),
            alarms.DANGER,
            0,
            causes,
            rule or alerts.Rule(),
            self.now,
            50 + id,
        )
        self.alerts = append(take(self.alerts, ~its), found)
        return self._told(changed)

    def _told(self, changed, when=0):
        self.history = alert_list.settled(self.history, changed)
        return [
            (alarms.NAMES[kind], when, STATES[state], sounds)
            for kind, state, sounds in zip(
                changed.kind.tolist(), changed.state.tolist(), changed.sounds.tolist()
            )
        ]


A, S, N = (STATES[k] for k in (ACTIVE_UNACKNOWLEDGED, ACTIVE_SILENCED, ACTIVE_ACKNOWLEDGED))
U, V = STATES[RECTIFIED_UNACKNOWLEDGED], STATES[NORMAL]


def test_what_is_silenced_sounds_again_after_half_a_minute():
    here = Watch()
    here.danger()
    here.after(9)
    assert here.silence() == [('danger', 0, S, 1)]
    assert here.silence() == []
    assert here.after(60) == [('danger', 30, A, 2)]
    here.silence()
    assert here.after(31) == [('danger', 30, A, 3)]


def test_a_new_alert_sounds_while_others_are_silenced():
    here = Watch()
    here.danger(id=3)
    here.silence()
    assert here.danger(id=4) == [('danger', 0, A, 1)]
    assert sorted(here.alerts.state.tolist()) == [ACTIVE_UNACKNOWLEDGED, ACTIVE_SILENCED]


@pytest.mark.parametrize('silenced_after', [0, 20])
def test_a_silenced_alert_can_be_acknowledged_and_then_stays_so(silenced_after):
    here = Watch()
    here.danger()
    here.after(silenced_after)
    here.silence()
    assert here.acknowledge() == [('danger', 0, N, 1)]
    assert here.after(400) == [] and here.silence() == []


def test_a_silenced_alert_without_a_cause_waits_to_be_acknowledged_and_is_silent():
    here = Watch()
    here.danger()
    here.silence()
    here.now += 5
    assert here.danger(alerts.OFF) == [('danger', 0, U, 1)]
    assert here.after(100) == [] and here.silence() == []
    assert here.danger() == [('danger', 0, A, 2)]


def test_a_warning_sounds_again_after_five_minutes_until_it_is_acknowledged():
    here = Watch()
    told = here.after(700, heading=20.0)
    assert told == [('heading missing', k, A, n) for k, n in ((1, 1), (301, 2), (601, 3))]
    here.acknowledge()
    assert here.after(700, heading=20.0) == []


def test_silence_delays_a_warning_by_no_more_than_its_half_minute():
    here = Watch()
    here.after(298, heading=20.0)
    here.silence()
    told = here.after(330, heading=20.0)
    assert told == [('heading missing', 30, A, 2), ('heading missing', 330, A, 3)]


def test_a_caution_is_silent_and_an_alarm_is_not_told_again():
    here = Watch()
    here.danger()
    here.danger(id=8, rule=alerts.Rule(caution=True))
    assert here.after(900) == []
    assert here.silence() == [('danger', 0, S, 1)]
    assert here.alerts.sounds[here.alerts.id == 8].tolist() == [0]


def test_alerts_have_instances_that_no_other_has_and_that_stay():
    here = Watch()
    here.after(1, heading=20.0)
    here.after(1, heading=20.0, position=30.0)
    here.after(5, heading=20.0, position=30.0, log=40.0)
    assert here.alerts.instance.tolist() == [1, 2, 3] and (here.alerts.raised > 0).all()
    assert here.acknowledge(instance=2) == [('position missing', 0, N, 1)]
    assert here.after(30, heading=20.0, log=40.0) == [('position missing', 15 + 1, V, 1)]
    here.after(1, heading=20.0, log=40.0, speed_off=3.0)
    assert here.alerts.instance.tolist() == [1, 3, 4]
    with pytest.raises(ValueError, match='no alert of instance 2'):
        here.acknowledge(instance=2)


def test_the_list_is_by_priority_then_by_state_then_the_newest_first():
    here = Watch()
    here.after(2, position=20.0)  # 1, an old warning
    here.after(2, position=20.0, heading=20.0)  # 2, a newer one
    here.danger(id=1)
    here.acknowledge(number=21)  # 51, an acknowledged alarm
    here.now += 1
    here.danger(id=2)
    here.silence()  # 52, silenced, with the warnings
    here.now += 1
    here.danger(id=3)  # 53, sounds
    here.danger(id=4)
    here.danger(alerts.OFF, id=4)  # 54, rectified
    here.after(1, position=20.0, heading=20.0, log=20.0)  # 55, a warning that sounds
    shown = alert_list.in_order(here.alerts, alarms.RANK)
    assert shown.instance.tolist() == [53, 52, 54, 51, 55, 2, 1]


def test_settled_alerts_are_remembered_with_their_times_the_last_hundred_of_them():
    here = Watch(end_after=0.0)
    here.after(5, heading=20.0)
    here.acknowledge()
    here.after(1)
    row = take(here.history, slice(-1, None))
    assert alarms.NAMES[row.kind[0]] == 'heading missing'
    assert (row.raised[0], row.seen[0], row.since[0]) == (1001.0, 1005.0, 1006.0)
    for id in range(1, 140):
        here.danger(id=id)
        here.now += 1
        here.danger(alerts.OFF, id=id)
        here.acknowledge(number=20 + id)
    assert here.history.id.tolist() == list(range(40, 140))
    assert np.isfinite(here.history.seen).all()


def test_the_next_time_an_alert_is_raised_nothing_is_left_of_the_last():
    here = Watch(end_after=0.0)
    here.danger(rule=alerts.Rule(remembered=True))
    here.alerts, _ = alarms.acknowledge(here.alerts, here.now)
    here.now += 10
    here.danger(alerts.OFF, rule=alerts.Rule(remembered=True))
    (row,) = here.alerts.state.tolist()
    assert row == NORMAL  # remembered, in case it comes back
    here.now += 10
    here.danger(rule=alerts.Rule(remembered=True))
    assert here.alerts.state.tolist() == [ACTIVE_ACKNOWLEDGED]
    assert here.alerts.raised.tolist() == [1020.0] and np.isnan(here.alerts.seen).all()


def test_every_kind_has_a_category_and_an_identifier_of_its_own():
    assert len(alarms.CATEGORY) == len(alarms.IDENTIFIER) == len(alarms.NAMES)
    assert len(set(alarms.IDENTIFIER)) == len(alarms.NAMES) and min(alarms.IDENTIFIER) >= 10000
    told = dict(zip(alarms.NAMES, alarms.CATEGORY))
    assert told['danger'] == 'A' and told['heading missing'] == 'B'
