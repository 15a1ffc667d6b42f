"""A danger that was acknowledged: remembered, ended, become worse, acknowledged for a time."""

import numpy as np
import pytest

from marine_tracker.arpa import acquisition, alarms, alerts, zones
from marine_tracker.arpa.alarms import AlarmSettings, Tracking
from marine_tracker.arpa.alerts import (
    ACTIVE_ACKNOWLEDGED,
    ACTIVE_UNACKNOWLEDGED,
    NORMAL,
    RECTIFIED_UNACKNOWLEDGED,
)
from marine_tracker.arpa.situation import Limits

PERIOD = 2.5
LIMITS = Limits(cpa=1200.0, tcpa=900.0)
SPEED = 8.0
NOWHERE = zones.parse('')
RAISED, SEEN, OVER = ACTIVE_UNACKNOWLEDGED, ACTIVE_ACKNOWLEDGED, RECTIFIED_UNACKNOWLEDGED


class Encounter:
    """One ship that own ship, at rest, sees; its states of danger, change by change."""

    def __init__(self, situate):
        self.situate, self.now = situate, 0.0
        self.settings = AlarmSettings(limits=LIMITS)
        self.acquisition, self.alerts = acquisition.begin(), alerts.begin()
        self.states = []

    def meet(self, cpa, seconds, tcpa=500.0, **about):
        """For so long the ship comes from ahead, to pass at `cpa` m in `tcpa` s, at each scan."""
        return self.sail([[cpa, SPEED * tcpa]], [[0.0, -SPEED]], seconds, **about)

    def sail(self, position, velocity, seconds, **about):
        """For so long the ship is there; True while its danger shows after all."""
        for _ in range(int(np.ceil(seconds / PERIOD))):
            self.now += PERIOD
            scene = self.situate(position, velocity, zones=NOWHERE, limits=LIMITS, **about)
            self.acquisition, events = acquisition.step(
                self.acquisition, acquisition.AcquisitionSettings(brief=0.0), scene, self.now
            )
            count = len(scene.id)
            self.alerts, changed = alarms.step(
                self.alerts,
                self.settings,
                scene,
                self.acquisition,
                events,
                NOWHERE,
                Tracking(50, 0, *(np.full(count, value) for value in (np.inf, -1, 0.0, -1))),
                self.now,
            )
            self.states += changed.state[changed.kind == alarms.DANGER].tolist()
        return self

    def acknowledge(self, minutes=0.0, **which):
        self.alerts, changed = alarms.acknowledge(
            self.alerts, self.now, duration=60 * minutes, **which
        )
        self.states += changed.state.tolist()
        return self


@pytest.fixture
def encounter(situate):
    return Encounter(situate)


@pytest.fixture
def acknowledged(encounter):
    """Raised at a CPA of 1,000 m, limit 1,200, and acknowledged."""
    return encounter.meet(1000.0, 12).acknowledge().meet(1000.0, 5)


def test_a_cpa_to_and_fro_about_the_limit_sounds_once(acknowledged):
    for _ in range(8):
        acknowledged.meet(1500.0, 25).meet(1050.0, 25)
    assert acknowledged.states.count(RAISED) == 1
    assert acknowledged.states == [RAISED, SEEN] + [NORMAL, SEEN] * 8


def test_what_was_acknowledged_as_over_is_remembered_too(encounter):
    encounter.meet(1000.0, 12).meet(1500.0, 25).acknowledge().meet(1000.0, 25)
    assert encounter.states == [RAISED, OVER, NORMAL, SEEN]


def test_a_danger_that_nobody_acknowledged_sounds_again(encounter):
    encounter.meet(1000.0, 12).meet(1500.0, 25).meet(1000.0, 25)
    assert encounter.states == [RAISED, OVER, RAISED]


@pytest.mark.parametrize(
    'away',
    [{'cpa': 2100.0}, {'cpa': 1000.0, 'tcpa': 1500.0}, {'cpa': 1000.0, 'tcpa': -400.0}],
    ids=['far off', 'late', 'past'],
)
def test_an_encounter_that_has_clearly_ended_is_a_new_one_when_it_comes_back(acknowledged, away):
    acknowledged.meet(seconds=85, **away).meet(1000.0, 12)
    assert acknowledged.states == [RAISED, SEEN, NORMAL, RAISED]


def test_it_has_not_clearly_ended_before_a_minute_or_within_one_and_a_half_limits(acknowledged):
    acknowledged.meet(2100.0, 60).meet(1000.0, 12)
    acknowledged.meet(1600.0, 200).meet(1000.0, 12)
    assert acknowledged.states.count(RAISED) == 1


def test_a_track_that_ends_ends_its_encounter(acknowledged):
    acknowledged.sail(np.zeros((0, 2)), None, 10).meet(1000.0, 12)
    assert acknowledged.states == [RAISED, SEEN, NORMAL, RAISED]


def test_it_sounds_again_when_the_cpa_falls_by_half_the_limit(acknowledged):
    """From 1,000 m: not at 430 m, at 370 m after a quarter of a minute."""
    acknowledged.meet(430.0, 60).meet(370.0, 12)
    assert acknowledged.states == [RAISED, SEEN]
    acknowledged.meet(370.0, 8)
    assert acknowledged.states == [RAISED, SEEN, RAISED]
    acknowledged.acknowledge().meet(20.0, 90)
    assert acknowledged.states == [RAISED, SEEN, RAISED, SEEN]


def test_a_danger_at_the_limit_is_worse_below_half_of_it(situate):
    """Acknowledged at 1,190 m, limit 1,200: no news at 640 m, but at 560 m."""
    one = Encounter(situate).meet(1190.0, 12).acknowledge()
    one.meet(1190.0, 5).meet(640.0, 60)
    assert one.states == [RAISED, SEEN]
    assert one.meet(560.0, 20).states == [RAISED, SEEN, RAISED]


def test_it_sounds_again_when_the_ship_comes_far_sooner_than_expected(acknowledged):
    """Expected in 500 s: in 300 is no news, in 200 it is, a quarter of the limit being 225 s."""
    acknowledged.meet(1000.0, 40, tcpa=300.0)
    assert acknowledged.states == [RAISED, SEEN]
    acknowledged.meet(1000.0, 20, tcpa=200.0)
    assert acknowledged.states == [RAISED, SEEN, RAISED]


def test_a_guess_that_was_acknowledged_may_come_out_as_anything(encounter):
    """A velocity known to 1 m/s, 500 s ahead: the CPA is taken when it is known."""
    encounter.meet(1100.0, 12, sigma=(50.0, 1.0)).acknowledge()
    encounter.meet(900.0, 12, sigma=(50.0, 1.0)).meet(100.0, 120)
    assert encounter.states == [RAISED, SEEN]


def test_ships_in_company_sound_once_and_again_when_one_comes_back(acknowledged):
    """Abeam at 1,100 m with next to no relative motion, to and fro; then straight for own ship."""
    for _ in range(6):
        acknowledged.sail([[1100.0, 40.0]], [[0.0, -0.6]], 40)
        acknowledged.sail([[1100.0, -40.0]], [[0.0, -0.6]], 90)
    assert acknowledged.states.count(RAISED) == 1
    acknowledged.sail([[1100.0, -40.0]], [[-4.0, 0.2]], 25)
    assert acknowledged.states[-1] == RAISED


def test_at_anchor_the_encounter_with_a_ship_that_stops_has_ended(acknowledged):
    acknowledged.meet(1000.0, 85, harmless=True).meet(1000.0, 12)
    assert acknowledged.states == [RAISED, SEEN, NORMAL, RAISED]


def test_an_acknowledgement_for_a_time_ends_with_it(encounter):
    encounter.meet(1000.0, 12).acknowledge(minutes=4).meet(1000.0, 225)
    assert encounter.states == [RAISED, SEEN]
    encounter.meet(1000.0, 20)
    assert encounter.states == [RAISED, SEEN, RAISED]


def test_an_acknowledgement_for_a_time_does_not_outlive_the_danger(encounter):
    encounter.meet(1000.0, 12).acknowledge(minutes=4).meet(1700.0, 300).meet(1000.0, 12)
    assert encounter.states == [RAISED, SEEN, NORMAL, RAISED]


def test_a_target_that_is_named_may_be_acknowledged_for_longer(encounter):
    encounter.meet(1000.0, 12).acknowledge(minutes=2).meet(1000.0, 60)
    encounter.acknowledge(minutes=9, number=1).meet(1000.0, 300)
    assert encounter.states == [RAISED, SEEN]
    encounter.acknowledge(minutes=0.1).meet(1000.0, 30)  # of all: what is acknowledged stays
    assert encounter.states == [RAISED, SEEN]


def test_an_alarm_of_a_sensor_that_stays_silent_comes_back_after_its_time():
    settings, missing = AlarmSettings(), alarms.Silence(60.0, 0.0, (0.0,))
    found, _ = alarms.watch(alerts.begin(), settings, missing, 0.0)
    found, _ = alarms.acknowledge(found, 1.0, duration=90.0)
    told = []
    for now in np.arange(2.0, 120.0, 1.0):
        found, changed = alarms.watch(found, settings, missing, now)
        told += [(now, state) for state in changed.state.tolist()]
    assert told == [(91.0, RAISED)]


def test_a_cancelled_target_is_forgotten(acknowledged):
    acknowledged.meet(1500.0, 25)
    found, _ = alerts.dismiss(acknowledged.alerts, np.array([1]), acknowledged.now)
    assert not len(found.kind)
