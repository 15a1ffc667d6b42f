import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from marine_tracker.arpa import acquisition, alarms, alerts, sounding, zones
from marine_tracker.arpa.alarm_text import parts, text
from marine_tracker.arpa.alarms import NAMES, AlarmSettings, Silence, Tracking
from marine_tracker.arpa.alerts import STATES
from marine_tracker.arpa.situation import Limits
from marine_tracker.geometry import KNOT, NAUTICAL_MILE
from marine_tracker.tracking.lifecycle import (
    COASTING,
    CONFIRMED,
    LOST,
    MERGED,
    MISSED,
    OUT_OF_RANGE,
    TENTATIVE,
)

PERIOD = 3.0
LIMITS = Limits(cpa=0.5 * NAUTICAL_MILE, tcpa=720.0)
RING = '{name: ring, kind: guard, range_m: [1000, 2000]}'
INNER = '{name: inner, kind: guard, range_m: [0, 1500]}'
UNACKNOWLEDGED, ACKNOWLEDGED, RECTIFIED = STATES[1:4]
NORMAL = STATES[0]


class Bridge:
    """Acquisition and alarms of one ship, scan by scan."""

    def __init__(self, situate, zone_text='', acquiring=None, **alarm_settings):
        self.situate, self.now = situate, -PERIOD
        self.zones = zones.parse(zone_text)
        self.acquiring = acquiring or acquisition.AcquisitionSettings(brief=0.0)
        self.settings = AlarmSettings(**alarm_settings)
        self.acquisition, self.alerts = acquisition.begin(), alerts.begin()

    def scan(
        self,
        position,
        velocity=None,
        fallen=0,
        overlap=None,
        other=None,
        swapped=0.0,
        rival=None,
        **about,
    ):
        """What changed in one scan: [(kind, target number, state)], sorted."""
        self.now += PERIOD
        scene = self.situate(position, velocity, zones=self.zones, limits=LIMITS, **about)
        self.acquisition, events = acquisition.step(
            self.acquisition, self.acquiring, scene, self.now
        )
        count = len(scene.id)
        tracking = Tracking(
            self.acquiring.capacity,
            fallen,
            np.full(count, np.inf) if overlap is None else np.asarray(overlap, float),
            np.full(count, -1) if other is None else np.asarray(other),
            np.broadcast_to(np.asarray(swapped, float), count),
            np.full(count, -1) if rival is None else np.asarray(rival),
        )
        self.alerts, changed = alarms.step(
            self.alerts,
            self.settings,
            scene,
            self.acquisition,
            events,
            self.zones,
            tracking,
            self.now,
        )
        return self.told(changed)

    def sensors(self, heading=0.0, position=0.0, plots=0.0, **rest):
        self.now += PERIOD
        self.alerts, changed = alarms.watch(
            self.alerts, self.settings, Silence(heading, position, (plots,), **rest), self.now
        )
        return self.told(changed)

    def acknowledge(self, **which):
        self.alerts, changed = alarms.acknowledge(self.alerts, self.now, **which)
        return self.told(changed)

    def silence(self):
        self.alerts, changed = sounding.silence(self.alerts, self.now)
        return self.told(changed)

    def cancel(self, number):
        self.acquisition, events = acquisition.cancel(self.acquisition, number)
        self.alerts, changed = alerts.dismiss(self.alerts, events.id, self.now)
        return self.told(changed)

    def told(self, changed):
        self.text = text(changed, self.zones)
        return sorted(
            (NAMES[kind], number, STATES[state])
            for kind, number, state in zip(
                changed.kind.tolist(), changed.number.tolist(), changed.state.tolist()
            )
        )

    def standing(self):
        return [
            (NAMES[kind], STATES[state])
            for kind, state in zip(self.alerts.kind.tolist(), self.alerts.state.tolist())
            if state
        ]


@pytest.fixture
def bridge(situate):
    def make(*arguments, **named):
        return Bridge(situate, *arguments, **named)

    return make


def course(position, velocity, scans):
    """Positions of a target on a straight course, one scan after the other."""
    return [np.array([position]) + PERIOD * k * np.array([velocity]) for k in range(scans)]


# danger


def test_a_target_that_passes_close_raises_once_and_ends_when_it_has_passed(bridge):
    one, speed = bridge(), 20 * KNOT
    told = []
    for position in course([300.0, 1000 * speed], [0.0, -speed], 400):
        told += [(one.now, *change) for change in one.scan(position, [[0.0, -speed]])]
        if len(told) == 1 and one.standing() == [('danger', UNACKNOWLEDGED)]:
            one.acknowledge(kind=alarms.DANGER, number=1)
    (raised, *what), (ended, *then) = told
    assert what == ['danger', 1, UNACKNOWLEDGED] and then == ['danger', 1, NORMAL]
    assert 280 <= raised <= 280 + 5 + 2 * PERIOD  # TCPA 720 s at 280 s
    assert 1000 <= ended <= 1000 + 15 + 2 * PERIOD  # CPA at 1000 s


def test_an_unacknowledged_danger_that_is_over_waits_to_be_acknowledged(bridge):
    one = bridge()
    for _ in range(4):
        one.scan([[0.0, 2000.0]], [[0.0, -5.0]])
    assert one.standing() == [('danger', UNACKNOWLEDGED)]
    for _ in range(8):
        one.scan([[0.0, 2000.0]], [[0.0, 5.0]])
    assert one.standing() == [('danger', RECTIFIED)]
    assert one.acknowledge() == [('danger', 1, NORMAL)] and one.standing() == []
    assert one.acknowledge() == []


def test_a_cpa_that_wavers_about_the_limit_does_not_chatter(bridge):
    rng, one, changes = np.random.default_rng(2), bridge(), []
    for _ in range(300):
        cpa = LIMITS.cpa * rng.normal(1.0, 0.03)
        changes += one.scan([[cpa, 3000.0]], [[0.0, -8.0]])
    assert changes == [('danger', 1, UNACKNOWLEDGED)]


def test_one_scan_of_danger_by_noise_raises_nothing(bridge):
    one = bridge()
    for k in range(60):
        cpa = 200.0 if k % 5 == 0 else 3000.0
        assert one.scan([[cpa, 3000.0]], [[0.0, -8.0]]) == []


def test_a_track_that_does_not_show_again_raises_no_danger(bridge):
    one = bridge()
    assert one.scan([[0.0, 2000.0]], [[0.0, -5.0]]) == []
    for _ in range(7):
        assert one.scan([[0.0, 2000.0]], [[0.0, -5.0]], status=COASTING) == []
    assert one.scan([[0.0, 2000.0]], [[0.0, -5.0]]) == [('danger', 1, UNACKNOWLEDGED)]
    for _ in range(7):  # but a danger stays one while it coasts
        assert one.scan([[0.0, 2000.0]], [[0.0, -5.0]], status=COASTING) == []


def test_all_dangers_are_told_not_only_the_first(bridge):
    one = bridge()
    position = np.column_stack([np.zeros(5), 2000.0 + 500 * np.arange(5)])
    for _ in range(3):
        told = one.scan(position, np.tile([0.0, -8.0], (5, 1)))
    assert told == [('danger', number, UNACKNOWLEDGED) for number in range(1, 6)]
    assert one.acknowledge(number=3) == [('danger', 3, ACKNOWLEDGED)]
    assert len(one.acknowledge()) == 4 and one.acknowledge() == []


def test_at_anchor_among_anchored_ships_no_alarm_nags(bridge):
    rng, one = np.random.default_rng(3), bridge()
    position = rng.uniform(-500, 500, (20, 2))
    for _ in range(100):
        assert one.scan(position, rng.normal(0, 0.3, (20, 2)), harmless=True) == []


def test_when_own_ship_comes_to_rest_its_dangers_end(bridge):
    one = bridge()
    for _ in range(4):
        one.scan([[0.0, 900.0]], own_velocity=[0.0, 5.0])
    assert one.acknowledge() == [('danger', 1, ACKNOWLEDGED)]
    told = [one.scan([[0.0, 900.0]], harmless=True) for _ in range(6)]
    assert sum(told, []) == [('danger', 1, NORMAL)]


def test_a_target_in_acquisition_and_a_track_that_is_no_target_raise_no_danger(bridge):
    one = bridge(acquiring=acquisition.AcquisitionSettings(automatic='nowhere'))
    one.acquisition = acquisition.acquire(one.acquisition, [0.0, 2000.0], 0.0)
    for _ in range(5):
        assert (
            one.scan(
                [[0.0, 2000.0], [0.0, 3000.0]], [[0.0, -8.0]] * 2, status=[TENTATIVE, CONFIRMED]
            )
            == []
        )
    assert one.acquisition.targets.id.tolist() == [1]


# lost target


def test_a_lost_target_raises_with_its_last_position(bridge):
    one = bridge()
    one.scan([[3000.0, 4000.0]])
    assert one.scan([[3000.0, 4000.0]], status=COASTING) == []
    assert one.scan([[3030.0, 4040.0]], status=LOST) == [('lost target', 1, UNACKNOWLEDGED)]
    assert one.text == ['TT01 lost, last at 2.73 NM, 036.9 deg']
    assert one.alerts.position.tolist() == [[3030.0, 4040.0]]
    for _ in range(10):
        assert one.scan(np.zeros((0, 2))) == []
    assert one.acknowledge() == [('lost target', 1, NORMAL)] and one.standing() == []


def test_a_dangerous_target_that_is_lost_tells_both(bridge):
    one = bridge()
    for _ in range(4):
        one.scan([[0.0, 2000.0]], [[0.0, -5.0]])
    assert one.scan([[0.0, 2000.0]], [[0.0, -5.0]], status=LOST) == [
        ('danger', 1, RECTIFIED),
        ('lost target', 1, UNACKNOWLEDGED),
    ]


@pytest.mark.parametrize(
    ('scans', 'expected'), [(13, []), (14, [('lost target', 1, UNACKNOWLEDGED)])]
)
def test_a_target_lost_soon_after_it_was_acquired_raises_nothing(bridge, scans, expected):
    one = bridge(acquiring=acquisition.AcquisitionSettings(brief=40.0))
    for _ in range(scans):  # 39 s and 42 s until it is lost
        one.scan([[3000.0, 4000.0]])
    assert one.scan([[3000.0, 4000.0]], status=LOST) == expected


def test_a_target_acquired_by_hand_raises_however_soon_it_is_lost(bridge):
    one = bridge(acquiring=acquisition.AcquisitionSettings(brief=40.0))
    one.acquisition = acquisition.acquire(one.acquisition, [3000.0, 4000.0], 0.0)
    one.scan([[3000.0, 4000.0]])
    assert one.scan([[3000.0, 4000.0]], status=LOST) == [('lost target', 1, UNACKNOWLEDGED)]


@pytest.mark.parametrize('reason', [OUT_OF_RANGE, MERGED])
def test_no_lost_alarm_for_what_left_by_range_or_was_merged(bridge, reason):
    one = bridge()
    one.scan([[3000.0, 4000.0]])
    assert one.scan([[3000.0, 4000.0]], status=LOST, reason=[reason]) == []


def test_no_lost_alarm_in_an_exclusion_zone(bridge):
    one = bridge('[{name: e, kind: exclusion, range_m: [0, 1000]}]')
    one.scan([[1500.0, 0.0]])
    assert one.scan([[900.0, 0.0]], status=LOST, reason=[MISSED]) == []


def test_no_lost_alarm_for_a_cancelled_target(bridge):
    one = bridge()
    one.scan([[1500.0, 0.0]])
    assert one.cancel(1) == []
    assert one.scan([[1500.0, 0.0]], status=LOST, reason=[MISSED]) == []


def test_a_cancelled_target_takes_its_alerts_along(bridge):
    one = bridge()
    for _ in range(4):
        one.scan([[0.0, 2000.0]], [[0.0, -5.0]])
    assert one.cancel(1) == [('danger', 1, NORMAL)]
    assert sum([one.scan([[0.0, 2000.0]], [[0.0, -5.0]]) for _ in range(5)], []) == []


def test_a_target_that_comes_back_is_a_new_one_and_can_be_lost_again(bridge):
    one = bridge()
    one.scan([[1500.0, 0.0]])
    one.scan([[1500.0, 0.0]], status=LOST)
    one.acknowledge()
    assert one.scan([[1500.0, 0.0]], id=[2]) == []
    assert one.scan([[1500.0, 0.0]], id=[2], status=LOST) == [('lost target', 2, UNACKNOWLEDGED)]


# new target


def test_a_target_that_enters_a_guard_zone_raises_though_it_was_tracked_before(bridge):
    one = bridge(f'[{RING}]')
    assert one.scan([[2500.0, 0.0]]) == []
    assert one.scan([[1990.0, 0.0]]) == [('new target', 1, UNACKNOWLEDGED)]
    assert one.text == ['TT01 in guard zone ring, at 1.07 NM, 090.0 deg']
    assert one.scan([[1980.0, 0.0]]) == []


def test_a_target_first_detected_inside_raises(bridge):
    one = bridge(f'[{RING}]')
    assert one.scan([[1500.0, 0.0]], status=TENTATIVE) == []
    assert one.scan([[1500.0, 0.0]]) == [('new target', 1, UNACKNOWLEDGED)]


def test_a_track_in_a_guard_zone_raises_where_nothing_is_acquired(bridge):
    one = bridge(f'[{RING}]', acquisition.AcquisitionSettings(automatic='nowhere'))
    assert one.scan([[1500.0, 0.0]]) == [('new target', 1, UNACKNOWLEDGED)]


def test_a_target_at_the_border_of_a_guard_zone_does_not_chatter(bridge):
    one, changes = bridge(f'[{RING}]'), []
    for k in range(100):
        changes += one.scan([[2000.0 + 20 * (-1) ** (k // 2), 0.0]])
    assert changes == [('new target', 1, UNACKNOWLEDGED)]


def test_each_entry_raises_once_more(bridge):
    one, raised = bridge(f'[{RING}]'), 0
    for k in range(60):
        changes = one.scan([[1500.0 if k % 20 < 10 else 2500.0, 0.0]])
        raised += ('new target', 1, UNACKNOWLEDGED) in changes
        one.acknowledge()
    assert raised == 3


def test_after_a_hundred_that_came_and_were_lost_the_next_one_raises(bridge):
    one, raised = bridge(f'[{RING}]'), 0
    for k in range(1, 103):
        who = {'id': [k], 'number': [k]}
        one.scan([[2500.0, 0.0]], **who)
        raised += ('new target', k, UNACKNOWLEDGED) in one.scan([[1700.0, 0.0]], **who)
        if k % 2:
            one.acknowledge()
        one.scan([[1700.0, 0.0]], status=LOST, **who)
    assert raised == 102


def test_each_of_two_zones_raises(bridge):
    one = bridge(f'[{RING}, {INNER}]')
    assert len(one.scan([[1900.0, 0.0]])) == 1
    assert one.scan([[1400.0, 0.0]]) == [('new target', 1, UNACKNOWLEDGED)]
    assert one.text[0].startswith('TT01 in guard zone inner')


def test_zones_that_change_while_running(bridge):
    one = bridge(f'[{RING}]')
    one.scan([[1400.0, 0.0]])
    one.acknowledge()
    one.zones = zones.parse(f'[{INNER}]')
    assert one.scan([[1400.0, 0.0]]) == [
        ('new target', 1, UNACKNOWLEDGED),
        ('new target', 1, NORMAL),
    ]
    one.zones = zones.parse('')
    assert one.scan([[1400.0, 0.0]]) == [('new target', 1, RECTIFIED)]
    assert one.text == ['TT01 in guard zone no longer set, at 0.76 NM, 090.0 deg']


def test_cancelled_and_excluded_tracks_are_no_new_targets(bridge):
    one = bridge(f'[{RING}, {{name: e, kind: exclusion, range_m: [1500, 1600]}}]')
    assert one.scan([[1550.0, 0.0]]) == []
    one.scan([[1700.0, 0.0], [900.0, 0.0]])
    assert one.cancel(1) == [('new target', 1, NORMAL)]
    assert one.scan([[1700.0, 0.0], [900.0, 0.0]]) == []


# capacity, fallback, swap risk, sensors


def test_capacity_warns_at_nine_tenths_and_when_full(bridge):
    one = bridge(acquiring=acquisition.AcquisitionSettings(capacity=20))

    def crowd(count):
        return one.scan(np.column_stack([5000.0 + 300 * np.arange(count), np.zeros(count)]))

    assert crowd(17) == []
    assert crowd(18) == [('near capacity', 0, ACKNOWLEDGED)]  # a caution
    assert one.text == ['18 targets, 20 may be']
    assert crowd(23) == [('capacity', 0, UNACKNOWLEDGED)]
    assert one.text == ['20 targets, as many as may be; 3 more are not acquired']
    one.acknowledge()
    told = [crowd(10) for _ in range(7)]
    assert sum(told, []) == [('capacity', 0, NORMAL), ('near capacity', 0, NORMAL)]


def test_fallback_of_many_is_told_of_one_among_many_not(bridge):
    one, far = bridge(), np.column_stack([5000.0 + 300 * np.arange(10), np.zeros(10)])
    assert one.scan(far) == []
    assert one.scan(far, fallen=4) == []
    assert one.scan(far, fallen=5) == [('fallback', 0, ACKNOWLEDGED)]
    assert one.text == ['5 of 10 targets have fallen back from their filter']
    assert sum([one.scan(far, fallen=1) for _ in range(7)], []) == [('fallback', 0, NORMAL)]


def test_swap_risk_names_both_targets(bridge):
    one, pair = bridge(), [[5000.0, 0.0], [5040.0, 0.0]]
    assert one.scan(pair, overlap=[0.5, 0.5], other=[1, 0]) == [
        ('swap risk', 1, ACKNOWLEDGED),
        ('swap risk', 2, ACKNOWLEDGED),
    ]
    assert one.text[0] == 'TT01 may be swapped with TT02, at 2.70 NM, 090.0 deg'
    for _ in range(10):
        assert one.scan(pair, overlap=[1.2, 1.2], other=[1, 0]) == []
    assert len(sum([one.scan(pair, overlap=[2, 2], other=[1, 0]) for _ in range(7)], [])) == 2


def test_a_probable_swap_is_told_after_the_gates_have_parted(bridge):
    one, far = bridge(), [[5000.0, 0.0], [5000.0, 900.0], [2000.0, 100.0]]
    assert one.scan(far, swapped=[0.04, 0.04, 0.0], rival=[1, 0, -1]) == []
    assert one.scan(far, swapped=[0.3, 0.3, 0.0], rival=[1, 0, -1]) == [
        ('swap risk', 1, ACKNOWLEDGED),
        ('swap risk', 2, ACKNOWLEDGED),
    ]
    assert one.text[1].startswith('TT02 may be swapped with TT01')
    assert len(sum([one.scan(far) for _ in range(7)], [])) == 2


def test_a_lost_heading_says_that_bearings_are_relative(bridge):
    one = bridge()
    assert one.sensors(heading=12.4, bow_only=True)
    assert one.text == ['no heading for 12 s: relative bearings only']


@pytest.mark.parametrize('name', ['heading', 'position', 'plots', 'log'])
def test_a_sensor_that_falls_silent(bridge, name):
    one = bridge()
    assert one.sensors(**{name: 9.9}) == []
    assert one.sensors(**{name: 10.1}) == [(f'{name} missing', 0, UNACKNOWLEDGED)]
    assert one.text == [f'no {name} for 10 s']
    assert one.sensors(**{name: 13.0}) == []
    assert one.scan([[100.0, 0.0]]) == []  # a scan leaves it alone
    one.acknowledge()
    told = [one.sensors() for _ in range(7)]
    assert sum(told, []) == [(f'{name} missing', 0, NORMAL)]


def test_a_sensor_never_heard(bridge):
    one = bridge()
    one.sensors(heading=np.inf)
    assert one.text == ['no heading so far']


# words


def test_a_danger_tells_its_values(bridge):
    one = bridge()
    for _ in range(3):
        one.scan([[0.2 * NAUTICAL_MILE, 3 * NAUTICAL_MILE]], [[0.0, -30 * KNOT]])
    assert one.text == [
        'TT01 dangerous: CPA 0.20 NM in 6.0 min, probability 100 %, then at 3.01 NM, 003.8 deg'
    ]


def test_every_kind_has_words_a_priority_and_a_rule():
    count = len(NAMES)
    assert len(alarms.PRIORITY) == len(alarms.rules(AlarmSettings())) == count
    kinds = np.arange(count)
    every = alerts.Alerts(
        kinds.astype(np.int8),
        0 * kinds,
        kinds,
        kinds,
        0 * kinds.astype(np.int8),
        0.0 * kinds,
        0.0 * kinds,
        np.zeros((count, 2)),
        np.full((count, alerts.VALUES), 1.0),
        np.full(count, np.nan),
        np.full((count, 2), np.nan),
        kinds + 1,
        *np.zeros((3, count)),
        0 * kinds,
    )
    assert len(set(text(every, zones.parse('')))) == count
    unknown = every._replace(values=np.full((count, alerts.VALUES), np.inf))
    assert all(
        text(unknown._replace(kind=np.full(count, kind, np.int8)), zones.parse(''))
        for kind in (alarms.HEADING_MISSING, alarms.PLOTS_MISSING)
    )


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_whatever_happens_every_change_follows_from_the_state_before(situate, seed):
    """Random traffic, operator and sensors: changes are the differences, no alert is twofold."""
    rng = np.random.default_rng(seed)
    one = Bridge(situate, f'[{RING}, {INNER}]', acquisition.AcquisitionSettings(capacity=6))
    before, where = {}, rng.uniform(-2500, 2500, (15, 2))
    for _ in range(30):
        chosen = np.sort(rng.permutation(15)[: rng.integers(0, 12)])
        kept = one.alerts
        what = rng.integers(5)
        if what == 0:
            told = one.acknowledge()
        elif what == 4:
            told = one.silence()
        elif what == 1 and (one.acquisition.targets.number > 0).any():
            told = one.cancel(int(one.acquisition.targets.number.max()))
        elif what == 2:
            told = one.sensors(heading=rng.uniform(0, 20), plots=rng.uniform(0, 20))
        else:
            told = one.scan(
                where[chosen] + rng.normal(0, 50, (len(chosen), 2)),
                rng.normal(0, 8, (len(chosen), 2)),
                id=chosen + 1,
                status=rng.choice([CONFIRMED, COASTING, LOST], len(chosen)),
            )
        keys = list(zip(one.alerts.kind.tolist(), one.alerts.zone.tolist(), one.alerts.id.tolist()))
        assert len(set(keys)) == len(keys)
        assert (
            len(set(one.alerts.instance.tolist())) == len(keys) and (one.alerts.instance > 0).all()
        )
        after = {key: state for key, state in zip(keys, one.alerts.state.tolist()) if state}
        differences = {key for key in {*before, *after} if before.get(key) != after.get(key)}
        assert len(told) == len(differences), (kept, one.alerts)
        before = after


def test_plots_missing_of_two_radars_are_two_alerts_that_name_them(bridge):
    here = bridge()
    here.alerts, changed = alarms.watch(
        here.alerts, here.settings, Silence(0.0, 0.0, (0.0, 20.0)), 100.0
    )
    assert text(changed, zones.parse(''), ['X band', 'S band']) == [
        'no plots of radar S band for 20 s'
    ]
    here.alerts, changed = alarms.watch(
        here.alerts, here.settings, Silence(0.0, 0.0, (20.0, 30.0)), 110.0
    )
    assert parts(changed, zones.parse(''), ['X band', 'S band']) == ['X band']
