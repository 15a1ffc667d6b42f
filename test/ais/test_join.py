import numpy as np
import pytest

from marine_tracker import m1371
from marine_tracker.ais import join, pairs, registration, ships
from marine_tracker.ais.join import AIS_ONLY, APART_STATE, BOTH, Seen
from marine_tracker.ais.reports import positions
from marine_tracker.ais.ship_motion import at
from marine_tracker.ais.ship_table import none
from marine_tracker.geometry import to_range_bearing, unit_vector

PERIOD = 3.0


class Sea:
    """Ships on straight ways; a radar with errors sees all, those with AIS report every 9 s."""

    def __init__(self, place, velocity, with_ais, seed=2, errors=(0.0, 0.0), noise=12.0):
        self.place, self.velocity = np.asarray(place, float), np.asarray(velocity, float)
        self.with_ais = np.asarray(with_ais)
        self.random = np.random.default_rng(seed)
        self.errors, self.noise, self.now = errors, noise, 0.0
        self.ships, self.next, self.pairs = none(), 1, pairs.nothing()
        self.registration, self.scan = registration.begin(), 0
        self.shift = np.zeros_like(self.place)  # of what AIS says
        self.gone = np.zeros(len(self.place), bool)  # from the radar
        self.silent = np.zeros(len(self.place), bool)
        self.track = 100 + np.arange(len(self.place))

    def at(self):
        return self.place + self.now * self.velocity

    def step(self, count=1):
        for _ in range(count):
            self.now += PERIOD
            if self.scan % 3 == 0:
                self._report()
            self.scan += 1
            seen = self._seen()
            moving = at(self.ships, self.now)
            self.pairs, self.registration, self.joined = join.step(
                self.pairs, self.registration, self.ships, moving, seen, np.zeros(2), self.now,
                PERIOD,
            )  # fmt: skip
        return self

    def _report(self):
        send = (self.with_ais & ~self.silent).nonzero()[0]
        speed, course = to_range_bearing(self.velocity[send])
        nothing = np.zeros(len(send))
        made = positions(
            1 + send, nothing + self.now, nothing, nothing, speed, course, accurate=True, timed=True
        )
        told = self.at()[send] + self.shift[send] + self.random.normal(0, 4, (len(send), 2))
        self.ships, self.next = ships.hear(self.ships, made, told, self.next)

    def _seen(self):
        rows = (~self.gone).nonzero()[0]
        range_, bearing = to_range_bearing(self.at()[rows])
        range_, bearing = range_ + self.errors[0], bearing + self.errors[1]
        place = range_[:, None] * unit_vector(bearing)
        count = len(rows)
        spread = np.diag([self.noise**2, self.noise**2, 0.09, 0.09])
        yes = np.ones(count, bool)
        return Seen(
            self.track[rows],
            1 + rows,
            place + self.random.normal(0, self.noise, (count, 2)),
            self.velocity[rows] + self.random.normal(0, 0.3, (count, 2)),
            np.broadcast_to(spread, (count, 4, 4)).copy(),
            yes,
            yes,
        )

    def partner(self):
        """Track of each ship that is joined, by MMSI."""
        both = self.joined.state == BOTH
        return dict(zip(self.ships.mmsi[both].tolist(), (self.joined.track[both] - 100).tolist()))

    def state(self, mmsi):
        return int(self.joined.state[self.ships.mmsi == mmsi][0])


def crowd(seed, count=14, **given):
    random = np.random.default_rng(seed)
    place = random.uniform(-9000, 9000, (count, 2))
    velocity = random.uniform(2, 9, count)[:, None] * unit_vector(random.uniform(0, 6.28, count))
    return Sea(place, velocity, np.arange(count) % 3 > 0, seed, **given)


def test_ships_with_ais_are_joined_to_their_own_tracks_and_no_others():
    sea = crowd(5).step(20)
    assert sea.partner() == {1 + k: k for k in range(14) if k % 3}
    assert (sea.joined.probability > 0.9).all()


def test_errors_of_the_radar_are_found_and_taken_out():
    sea = crowd(6, errors=(-40.0, np.radians(-1.6))).step(60)
    assert sea.registration.settled
    assert sea.registration.value[0] == pytest.approx(-40, abs=8)
    assert np.degrees(sea.registration.value[1]) == pytest.approx(-1.6, abs=0.12)
    assert sea.partner() == {1 + k: k for k in range(14) if k % 3}


def test_a_lane_is_not_joined_one_off_though_the_bearing_is():
    lane = np.stack([np.full(12, 5500.0), np.arange(-1500, 2100, 300.0)], 1)
    others = np.array([[-2000, 3000], [1500, -2500], [-4000, -4000], [800, 1800]])
    place = np.concatenate([lane, others])
    velocity = np.concatenate([np.tile([0.0, 6.0], (12, 1)), [[3, 1], [-2, 5], [4, 4], [6, -1]]])
    sea = Sea(place, velocity, np.arange(16) != 4, errors=(30.0, np.radians(2.0))).step(30)
    assert sea.partner() == {1 + k: k for k in range(16) if k != 4}


def test_a_boat_beside_the_ship_stays_a_target_of_her_own():
    # 150 m beside, same motion: a fixed circle about the report would swallow her at this range.
    sea = Sea([[6000, 4000], [6150, 4000]], [[2, 5], [2, 5]], [True, False]).step(30)
    assert sea.partner() == {1: 0}


def test_a_track_far_from_every_ship_is_joined_to_none():
    sea = Sea([[3000, 0], [5000, 0]], [[0, 5], [0, 5]], [True, False])
    sea.gone[0] = True
    sea.step(30)
    assert sea.state(1) == AIS_ONLY and not sea.partner()
    assert sea.joined.probability[0] < 0.1


def test_joined_pairs_stay_through_one_bad_moment():
    sea = crowd(7).step(20)
    before = sea.partner()
    sea.shift[:] = self_shift = np.array([60.0, 0.0])
    sea.step(1)
    sea.shift[:] = 0 * self_shift
    for _ in range(6):
        assert sea.step().partner() == before


def test_ships_that_cross_keep_their_partners():
    sea = Sea([[-450, 2000], [0, 2450]], [[5, 0], [0, -5]], [True, True]).step(60)
    assert sea.partner() == {1: 0, 2: 1}


@pytest.mark.parametrize('walks', [False, True])
def test_a_ship_that_says_another_place_than_her_echo_is_a_mismatch_within_a_minute(walks):
    sea = crowd(8).step(30)
    told = None
    for k in range(20):
        sea.shift[4] = np.array([5.0 * PERIOD * (k + 1), 0]) if walks else np.array([-700.0, 700.0])
        sea.step()
        if sea.state(5) == APART_STATE:
            told = told or PERIOD * (k + 1)
    assert told and told <= 50
    assert sea.joined.track[sea.ships.mmsi == 5][0] == 104
    others = sea.ships.mmsi != 5
    assert (sea.joined.state[others] == BOTH).all()


def test_a_mismatch_ends_when_they_agree_again():
    sea = crowd(9).step(30)
    sea.shift[4] = [900.0, 0]
    assert sea.step(15).state(5) == APART_STATE
    sea.shift[4] = 0
    assert sea.step(20).state(5) == BOTH


def test_a_silent_ship_leaves_her_track_and_joins_again():
    sea = crowd(10).step(30)
    sea.silent[4] = True
    sea.now += 70
    sea.ships = ships.pass_time(sea.ships, sea.now)
    # Others were not heard either in this leap; all report again but one.
    sea.scan = 0
    sea.step(3)
    sea.ships = ships.pass_time(sea.ships, sea.now)
    assert 5 not in sea.step(2).partner()
    sea.silent[4] = False
    assert sea.step(20).partner()[5] == 4


def test_two_places_of_one_number_leave_the_joined_one_joined():
    sea = crowd(11).step(30)
    made = positions(np.array([5]), np.array([0.0]), *np.zeros((4, 1)))
    for _ in range(6):
        now = np.array([sea.now + 1])
        far = made._replace(time=now, heard=now)
        sea.ships, sea.next = ships.hear(sea.ships, far, np.array([[90_000.0, 0.0]]), sea.next)
        sea.step(3)
    assert sea.ships.double.sum() == 2
    assert sea.partner()[5] == 4


def test_who_tells_no_motion_is_joined_by_place_alone():
    sea = Sea([[3000, 2000], [-2500, 800]], [[0, 0], [1, 4]], [True, True])
    sea.step(1)
    sea.ships = sea.ships._replace(
        speed=np.full(2, np.nan), kind=np.full(2, m1371.CLASS_A, np.int8)
    )
    moving = at(sea.ships, sea.now)
    seen = sea._seen()
    known = sea.pairs
    for k in range(30):
        known, _, found = join.step(
            known, registration.begin(), sea.ships, moving, seen, np.zeros(2), sea.now + k, 3.0
        )
    assert found.state[0] == BOTH and found.track[0] == 100


def test_nothing_is_joined_before_there_is_anything():
    seen = Sea([[1000, 0]], [[0, 1]], [False])._seen()
    empty = none()
    known, _, found = join.step(
        pairs.nothing(), registration.begin(), empty, at(empty, 0.0), seen, np.zeros(2), 0.0, 0.0
    )
    assert not len(known.ship) and not len(found.state)
