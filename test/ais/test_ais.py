"""Ships of AIS through the service: alarms, activation, own ship, silence of the radar."""

import numpy as np
import pytest

from marine_tracker import m1371
from marine_tracker.ais.ais import ACTIVATED, LEFT_OUT, SLEEPING
from marine_tracker.ais.join import BOTH
from marine_tracker.ais.reports import positions
from marine_tracker.arpa import alarm_text, alarms
from marine_tracker.arpa.alerts import ACTIVE_ACKNOWLEDGED, ACTIVE_UNACKNOWLEDGED
from marine_tracker.arpa.cpa import OwnMotion
from marine_tracker.geometry import KNOT, NAUTICAL_MILE, to_range_bearing
from marine_tracker.parameters import AisParameters, ArpaParameters, TrackerParameters
from marine_tracker.service import Service
from marine_tracker.types import OwnShip, PolarPlots, Scan

PERIOD = 3.0
DANGEROUS, FAR, BEACON = 211000001, 211000002, 970211003
ARPA = ArpaParameters(cpa_limit_nm=0.5, own_ship_status='under_way')


class Watch:
    """Own ship goes north at 10 kn; ships report each 9 s; radar sees those that echo."""

    def __init__(self, ais=None, arpa=ARPA):
        self.service = Service(TrackerParameters(), arpa, ais=ais or AisParameters())
        self.memory, self.now, self.scans = self.service.start(), 0.0, 0
        self.ships, self.changes = {}, []
        self.speed = np.array([0.0, 10 * KNOT])
        self.output = None

    def ship(self, mmsi, north, east=0.0, course=180.0, speed=12.0, echo=False, **more):
        way = speed * KNOT * np.array([np.sin(np.radians(course)), np.cos(np.radians(course))])
        start = np.array([east, north]) * NAUTICAL_MILE
        self.ships[mmsi] = [start, way, echo, {'sends': True, **more}]
        return self

    def place(self, mmsi):
        start, way, *_ = self.ships[mmsi]
        return start + self.now * way

    def report(self, mmsi):
        _, way, _, more = self.ships[mmsi]
        speed, course = to_range_bearing(way)
        nothing = np.zeros(1)
        given = {k: v for k, v in more.items() if k not in ('sends', 'place')}
        made = positions(
            np.array([mmsi]), nothing + self.now, nothing, nothing, nothing + speed,
            nothing + course, accurate=True, timed=True, **given,
        )  # fmt: skip
        place = np.full((1, 2), np.nan) if more.get('place') is False else self.place(mmsi)[None]
        self.memory = self.service.hear(self.memory, made, place)

    def step(self, count=1):
        for _ in range(count):
            self.now += PERIOD
            if self.scans % 3 == 0:
                for mmsi, (*_, more) in self.ships.items():
                    if more['sends']:
                        self.report(mmsi)
            self.scans += 1
            own = OwnShip(
                np.array([self.now]), (self.now * self.speed)[None], self.speed[None], np.zeros(1)
            )
            seen = np.array([self.place(m) for m, ship in self.ships.items() if ship[2]])
            range_, bearing = to_range_bearing(seen.reshape(-1, 2) - own.position)
            time = np.full(len(range_), self.now - 1.0)
            scan = Scan(
                self.now - PERIOD, self.now, PolarPlots(time, range_, bearing, 0 * time + 20), own
            )
            self.memory, self.output = self.service.step(self.memory, scan)
            self._note(self.output.picture.changed)
        return self

    def _note(self, changed):
        self.changes += [
            (alarms.NAMES[kind], number, state)
            for kind, number, state in zip(
                changed.kind.tolist(), changed.number.tolist(), changed.state.tolist()
            )
        ]

    def told(self, kind):
        """How often alerts of the kind became active."""
        return sum(
            name == kind and state in (ACTIVE_UNACKNOWLEDGED, ACTIVE_ACKNOWLEDGED)
            for name, _, state in self.changes
        )

    def acknowledge(self):
        found, changed = alarms.acknowledge(self.memory.arpa.alerts, self.now)
        self.memory = self.memory._replace(arpa=self.memory.arpa._replace(alerts=found))
        self._note(changed)

    def shown(self, mmsi):
        ships = self.output.ais
        return int(ships.shown[ships.ships.mmsi == mmsi][0])

    def alert(self, kind):
        alerts = self.output.picture.alerts
        return alerts.kind == alarms.NAMES.index(kind)


def test_a_ship_of_ais_alone_is_a_danger_by_the_limits_of_radar_targets():
    watch = Watch().ship(DANGEROUS, north=3, east=0.1).ship(FAR, north=3, east=6).step(8)
    assert watch.told('AIS danger') == 1
    assert watch.shown(DANGEROUS) == ACTIVATED and watch.shown(FAR) == SLEEPING
    alerts = watch.output.picture.alerts
    text = alarm_text.text(alerts, watch.service.arpa.zones)[watch.alert('AIS danger').argmax()]
    assert text.startswith(f'AIS {DANGEROUS} dangerous: CPA 0.')
    passing = watch.output.ais.approach
    row = (watch.output.ais.ships.mmsi == DANGEROUS).argmax()
    assert passing.cpa[row] / NAUTICAL_MILE == pytest.approx(0.1, abs=0.03)
    assert passing.cpa_sigma[row] > 0


def test_sleeping_ships_are_no_danger_where_the_operator_says_so():
    quiet = AisParameters(ais_sleeping_danger=False, ais_activation='range')
    watch = Watch(quiet).ship(DANGEROUS, north=4, east=0.1).step(8)
    assert watch.told('AIS danger') == 0


def test_a_joined_ship_is_one_target_and_one_alarm_acknowledged_once():
    watch = Watch().ship(DANGEROUS, north=4, east=0.1).step(8)
    assert watch.told('AIS danger') == 1
    watch.acknowledge()
    watch.ships[DANGEROUS][2] = True  # now radar sees her, too
    watch.step(25)
    assert watch.output.ais.joined.state.tolist() == [BOTH]
    alerts = watch.output.picture.alerts
    assert not watch.alert('AIS danger').any()
    assert alerts.state[watch.alert('danger')].tolist() == [ACTIVE_ACKNOWLEDGED]
    number = watch.output.picture.targets.number
    assert alerts.number[watch.alert('danger')].tolist() == number.tolist()


def test_a_joined_ship_whose_echo_is_lost_stays_a_danger_without_a_new_alarm():
    watch = Watch().ship(DANGEROUS, north=4.2, east=0.1, echo=True).step(25)
    assert watch.output.ais.joined.state.tolist() == [BOTH] and watch.told('danger') == 1
    watch.acknowledge()
    before = watch.told('AIS danger')
    watch.ships[DANGEROUS][2] = False
    watch.step(15)
    assert watch.output.ais.joined.state.tolist() != [BOTH]
    assert watch.output.picture.alerts.state[watch.alert('AIS danger')].tolist() == [
        ACTIVE_ACKNOWLEDGED
    ]
    assert watch.told('AIS danger') == before


def test_a_silent_ship_is_told_lost_once_and_the_mark_goes_when_she_is_back():
    watch = Watch(AisParameters(ais_activation='range')).ship(FAR, north=2, east=2).step(6)
    watch.ships[FAR][3]['sends'] = False
    watch.step(28)
    assert watch.told('AIS lost') == 1
    watch.acknowledge()
    watch.ships[FAR][3]['sends'] = True
    watch.step(8)
    assert not watch.alert('AIS lost').any() and watch.told('AIS lost') == 2  # and acknowledged
    quiet = Watch(AisParameters(ais_activation='range', ais_lost_alarm=False))
    quiet.ship(FAR, north=2, east=2).step(6).ships[FAR][3]['sends'] = False
    assert quiet.step(28).told('AIS lost') == 0


def test_a_beacon_alarms_once_while_its_bursts_go_on_also_without_a_place():
    watch = Watch().ship(BEACON, north=8, east=3, speed=0, status=m1371.ACTIVE, place=False)
    watch.step(4)
    assert watch.told('AIS-SART') == 1
    watch.acknowledge()
    watch.step(30)
    assert watch.told('AIS-SART') == 2  # the second: acknowledged
    assert watch.output.picture.alerts.state[watch.alert('AIS-SART')].tolist() == [
        ACTIVE_ACKNOWLEDGED
    ]
    test = Watch().ship(BEACON, north=8, speed=0, status=m1371.TEST).step(4)
    assert test.told('AIS-SART') == 0 and test.told('AIS-SART test') == 1


def test_own_ship_is_no_target_also_when_her_number_is_known_late():
    watch = Watch().ship(DANGEROUS, north=0.05, speed=10, course=0).ship(FAR, 4, 4).step(4)
    assert DANGEROUS in watch.output.ais.ships.mmsi
    own = AisParameters(ais_own_mmsi=DANGEROUS)
    watch.service = Service(TrackerParameters(), ARPA, ais=own)
    watch.step(4)
    assert watch.output.ais.ships.mmsi.tolist() == [FAR]
    assert not watch.alert('AIS danger').any()


def test_the_operator_activates_and_puts_to_sleep():
    watch = Watch(AisParameters(ais_activation='danger')).ship(FAR, north=3, east=6).step(3)
    assert watch.shown(FAR) == SLEEPING
    watch.memory = watch.memory._replace(
        ais=watch.service.ais.activate(watch.memory.ais, FAR, True)
    )
    assert watch.step(3).shown(FAR) == ACTIVATED
    watch.memory = watch.memory._replace(
        ais=watch.service.ais.activate(watch.memory.ais, FAR, False)
    )
    assert watch.step().shown(FAR) == SLEEPING
    with pytest.raises(ValueError, match='123'):
        watch.service.ais.activate(watch.memory.ais, 123, True)


def test_filters_leave_out_sleeping_ships_only_and_capacity_the_farthest():
    parameters = AisParameters(ais_range_nm=5.0, ais_kinds='a', ais_activation='danger')
    watch = Watch(parameters).ship(FAR, north=3, east=6).ship(FAR + 1, north=2, east=3, type_=18)
    watch.ship(DANGEROUS, north=6, east=0.1, speed=25).step(4)
    assert watch.shown(FAR) == LEFT_OUT  # beyond 5 NM
    assert watch.shown(FAR + 1) == LEFT_OUT  # class B
    assert watch.shown(DANGEROUS) == ACTIVATED  # dangerous: never left out
    filtered = Watch(AisParameters(ais_cpa_nm=1.5, ais_activation='danger'))
    filtered.ship(FAR, north=6, east=1.2).ship(FAR + 1, north=6, east=2.3)
    filtered.ship(FAR + 2, north=-2, course=180).ship(FAR + 3, north=-1, course=180)
    filtered.ship(FAR + 4, north=4, speed=np.nan).step(4)
    left = [watch_of for watch_of in range(5) if filtered.shown(FAR + watch_of) == LEFT_OUT]
    assert left == [1, 2]  # passes at 2.3 NM; goes away from 2 NM on. Unknown: never left out
    crowd = Watch(AisParameters(ais_activation='all', ais_max_activated=20, ais_max_sleeping=100))
    for k in range(25):
        crowd.ship(FAR + k, north=3 + k, east=6)
    crowd.step(2)
    assert [crowd.shown(FAR + k) for k in (0, 19, 20, 24)] == [
        ACTIVATED, ACTIVATED, SLEEPING, SLEEPING,
    ]  # fmt: skip
    assert crowd.told('AIS capacity') == 1


def test_a_guard_zone_activates():
    zones = '[{name: ahead, kind: guard, range_nm: [1, 4], bearing_deg: [-30, 30]}]'
    watch = Watch(AisParameters(ais_activation='zones'), ArpaParameters(zones=zones))
    watch.ship(FAR, north=3, east=0.5, course=0, speed=10).ship(FAR + 1, north=-3).step(4)
    assert watch.shown(FAR) == ACTIVATED and watch.shown(FAR + 1) == SLEEPING


def test_ships_go_on_while_radar_is_silent_and_what_was_joined_stays_so_for_a_while():
    watch = Watch().ship(FAR, north=3, east=2, echo=True, speed=8).step(25)
    assert watch.output.ais.joined.state.tolist() == [BOTH]
    own = OwnMotion(watch.now * watch.speed, watch.speed, 0.0, np.zeros((4, 4)))
    memory, ships, _ = watch.service.without_radar(watch.memory, own, watch.now + 10)
    assert ships.joined.state.tolist() == [BOTH]
    assert ships.moving.position[0] == pytest.approx(
        watch.place(FAR) + 10 * watch.ships[FAR][1], abs=3
    )
    later = watch.service.without_radar(memory, own, watch.now + 40)[1]
    assert later.joined.state.tolist() != [BOTH]


def test_without_ais_nothing_of_it_is_there_and_nothing_else_changes():
    watch = Watch()
    watch.ships[1] = [np.array([0.0, 3000.0]), np.zeros(2), True, {'sends': False}]
    watch.step(5)
    assert watch.output.ais is None
    assert not np.isin(watch.output.picture.alerts.kind, alarms.OF_AIS).any()


def test_cpa_of_an_old_report_is_from_her_place_now_within_its_deviation():
    """A boat of class B at 20 kn was heard 27 s ago, as far as 280 m back."""
    watch = Watch(AisParameters(ais_activation='all'))
    watch.ship(FAR, north=2.0, east=-0.8, course=120, speed=20, type_=18).step(1)
    watch.ships[FAR][3]['sends'] = False
    watch.step(9)
    passing, row = watch.output.ais.approach, 0
    offset = watch.place(FAR) - watch.now * watch.speed
    relative = watch.ships[FAR][1] - watch.speed
    cpa = abs(offset[0] * relative[1] - offset[1] * relative[0]) / np.hypot(*relative)
    assert abs(passing.cpa[row] - cpa) < passing.cpa_sigma[row]
    assert 20 < passing.cpa_sigma[row] < 1000
    assert passing.range[row] == pytest.approx(np.hypot(*offset), abs=30)
