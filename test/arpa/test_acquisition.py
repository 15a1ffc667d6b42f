import numpy as np
import pytest

from marine_tracker.arpa import acquisition
from marine_tracker.arpa.acquisition import (
    AcquisitionSettings,
    acquire,
    begin,
    cancel,
    cancel_all,
    how_acquired,
    step,
)
from marine_tracker.arpa.targets import AUTOMATIC, EVENTS, LETTERS, MANUAL, label
from marine_tracker.tracking.lifecycle import (
    COASTING,
    CONFIRMED,
    LOST,
    MERGED,
    MISSED,
    OUT_OF_RANGE,
    TENTATIVE,
)

RING = '[{name: ring, kind: guard, range_m: [1000, 2000]}]'
QUAY = (
    '[{name: quay, kind: exclusion, fixed_to: ground,'
    ' corners_m: [[-500, -500], [500, -500], [500, 500], [-500, 500]]}]'
)


def told(events):
    """What happened, in words: (event, track) pairs."""
    return [(EVENTS[kind], id) for kind, id in zip(events.kind.tolist(), events.id.tolist())]


def run(scenes, state=None, settings=None, period=3.0, start=0.0):
    """The state and the events after the last scene, `period` s apart."""
    state, events = state or begin(), None
    for k, scene in enumerate(scenes):
        state, events = step(state, settings or AcquisitionSettings(), scene, start + k * period)
    return state, events


def ids(state):
    return state.targets.id.tolist()


def test_every_confirmed_track_is_acquired_by_default(situate):
    scene = situate([[100, 0], [200, 0], [300, 0]], status=[CONFIRMED, TENTATIVE, COASTING])
    state, events = run([scene])
    assert ids(state) == [1, 3] and told(events) == [('acquired', 1), ('acquired', 3)]
    assert state.targets.number.tolist() == [1, 3] and (state.targets.acquired == AUTOMATIC).all()
    state, events = step(state, AcquisitionSettings(), scene, 3.0)
    assert ids(state) == [1, 3] and told(events) == [] and (state.targets.since == 0).all()


def test_in_zones_only_what_enters_a_guard_zone_is_acquired_and_stays_a_target(situate):
    settings = AcquisitionSettings(automatic='zones')
    far, near = [[2500, 0], [-3000, 0]], [[1990, 0], [-3000, 0]]
    state, _ = run([situate(far, zones=RING)], settings=settings)
    assert ids(state) == []
    state, events = run([situate(near, zones=RING)], state, settings)
    assert told(events) == [('acquired', 1)]
    state, events = run([situate([[900, 0], [-3000, 0]], zones=RING)], state, settings)
    assert ids(state) == [1] and told(events) == []


def test_nowhere_acquires_by_hand_only(situate):
    scene = situate([[1500, 0], [0, 1500]], zones=RING)
    settings = AcquisitionSettings(automatic='nowhere')
    state, _ = run([scene], settings=settings)
    assert ids(state) == []
    state, events = run([scene], acquire(state, [10, 1400], 1.0), settings, start=3.0)
    assert told(events) == [('acquired', 2)]
    assert how_acquired(state, np.array([2, 1])).tolist() == [MANUAL, -1]
    assert LETTERS[MANUAL] == 'M'


def test_an_unknown_place_to_acquire_is_an_error_that_names_it(situate):
    with pytest.raises(ValueError, match="'zone'; it must be one of everywhere, zones, nowhere"):
        run([situate([[0, 0]])], settings=AcquisitionSettings(automatic='zone'))


def test_a_click_takes_the_nearest_track_that_is_no_target_yet(situate):
    scene = situate([[0, 0], [0, 40], [0, 100]], status=[CONFIRMED, TENTATIVE, TENTATIVE])
    state, _ = run([scene])
    state, events = run([scene], acquire(state, [0, 5], 1.0), start=3.0)
    assert told(events) == [('acquired', 2)]  # quick entry, though tentative
    assert state.targets.number.tolist() == [1, 0]
    assert label(state.targets.id, state.targets.number) == ['TT01', 'Q2']


def test_two_clicks_take_two_tracks(situate):
    scene = situate([[0, 0], [0, 40]], status=TENTATIVE)
    state = acquire(acquire(begin(), [0, 0], 0.0), [0, 0], 0.0)
    state, _ = run([scene], state)
    assert ids(state) == [1, 2] and not len(state.clicks.since)


def test_a_click_on_a_target_makes_it_one_acquired_by_hand(situate):
    scene = situate([[0, 0]])
    state, _ = run([scene])
    state, _ = run([scene], acquire(state, [0, 5], 1.0))
    assert ids(state) == [1] and state.targets.acquired.tolist() == [MANUAL]


def test_a_target_acquired_before_confirmation_gets_its_number_then(situate):
    state, _ = run([situate([[0, 0]], status=TENTATIVE)], acquire(begin(), [0, 5], 0.0))
    assert state.targets.number.tolist() == [0]
    state, events = run([situate([[0, 0]], number=7)], state, start=3.0)
    assert state.targets.number.tolist() == [7] and told(events) == []
    assert state.targets.acquired.tolist() == [MANUAL] and state.targets.since.tolist() == [0.0]


def test_a_target_that_is_never_confirmed_ends_so(situate):
    state, _ = run([situate([[0, 0]], status=TENTATIVE)], acquire(begin(), [0, 5], 0.0))
    state, events = run([situate([[0, 0]], status=LOST, number=0)], state, start=3.0)
    assert told(events) == [('never confirmed', 1)] and ids(state) == []


def test_a_click_waits_for_a_track_and_takes_it_when_it_comes(situate):
    nobody = situate(np.zeros((0, 2)))
    state, events = run([nobody] * 3, acquire(begin(), [0, 0], 0.0))
    assert told(events) == [] and len(state.clicks.since) == 1
    state, events = run([situate([[0, 499]], status=TENTATIVE)], state, start=9.0)
    assert told(events) == [('acquired', 1)] and not len(state.clicks.since)


def test_a_click_lapses_when_no_track_comes_and_says_so(situate):
    elsewhere = situate([[0, 900]], status=TENTATIVE)
    state, events = run([elsewhere] * 8, acquire(begin(), [10, 20], 0.0))  # 21 s
    assert told(events) == [('no track there', 0)] and events.position.tolist() == [[10, 20]]
    assert not len(state.clicks.since) and not ids(state)
    state, events = run([elsewhere], state, start=24.0)
    assert told(events) == []


@pytest.mark.parametrize(
    ('position', 'message'),
    [([np.nan, 0], 'two finite numbers'), ([1, 2, 3], 'two finite numbers')],
)
def test_a_click_nowhere_is_refused(position, message):
    with pytest.raises(ValueError, match=message):
        acquire(begin(), position, 0.0)


def test_clicks_do_not_pile_up():
    state = begin()
    for _ in range(acquisition.MAX_CLICKS):
        state = acquire(state, [0, 0], 0.0)
    with pytest.raises(ValueError, match='20 clicks are waiting'):
        acquire(state, [0, 0], 0.0)


@pytest.mark.parametrize(
    ('reason', 'expected'),
    [
        (MISSED, 'lost at once'),
        (OUT_OF_RANGE, 'left by range'),
        (MERGED, 'merged into another track'),
    ],
)
def test_a_lost_track_ends_its_target_with_the_reason(situate, reason, expected):
    state, _ = run([situate([[0, 0]])])
    state, events = run([situate([[3, 4]], status=LOST, reason=reason)], state, start=3.0)
    assert told(events) == [(expected, 1)] and ids(state) == []
    assert events.number.tolist() == [1] and events.position.tolist() == [[3, 4]]


def test_a_target_that_was_held_for_some_time_is_lost(situate):
    here = situate([[0, 0]])
    state, _ = run([here] * 14)
    _, events = run([situate([[3, 4]], status=LOST)], state, start=42.0)
    assert told(events) == [('lost', 1)]


def test_a_track_that_was_no_target_ends_without_a_word(situate):
    settings = AcquisitionSettings(automatic='nowhere')
    state, _ = run([situate([[0, 0]])], settings=settings)
    _, events = run([situate([[0, 0]], status=LOST)], state, settings, start=3.0)
    assert told(events) == []


def test_a_target_merged_into_another_track_goes_on_as_that(situate):
    settings = AcquisitionSettings(automatic='nowhere')
    both = situate([[0, 0], [30, 0], [10, 0]], status=[CONFIRMED, CONFIRMED, TENTATIVE])
    state, _ = run([both], acquire(begin(), [0, 0], 0.0), settings)
    assert ids(state) == [1]
    after = situate(
        [[0, 0], [30, 0], [10, 0]],
        status=[LOST, CONFIRMED, TENTATIVE],
        number=[1, 2, 0],
        reason=[MERGED, 0, 0],
    )
    state, events = run([after], state, settings, start=3.0)
    assert ids(state) == [2] and state.targets.acquired.tolist() == [MANUAL]
    assert state.targets.since.tolist() == [0.0]
    assert told(events) == [('merged into another track', 1)]


def test_when_the_tracker_begins_anew_its_targets_are_gone(situate):
    state, _ = run([situate([[0, 0]])])
    state, events = run([situate([[0, 0]], id=[9])], state, start=3.0)
    assert told(events) == [('track gone', 1), ('acquired', 9)] and ids(state) == [9]


# exclusion zones


def test_tracks_in_an_exclusion_zone_are_not_acquired(situate):
    state, _ = run([situate([[0, 0], [600, 0]], zones=QUAY)])
    assert ids(state) == [2]


def test_exclusion_beats_guard(situate):
    ring = '{name: ring, kind: guard, range_m: [0, 9000]}'
    state, _ = run(
        [situate([[0, 0], [600, 0]], zones=f'{QUAY[:-1]}, {ring}]')],
        settings=AcquisitionSettings(automatic='zones'),
    )
    assert ids(state) == [2]


def test_a_target_that_enters_an_exclusion_zone_drops_out_unless_acquired_by_hand(situate):
    state, _ = run([situate([[600, 0], [600, 100]], zones=QUAY)])
    state, _ = run(
        [situate([[600, 0], [600, 100]], zones=QUAY)],
        acquire(cancel(state, 2)[0], [600, 100], 1.0),
        start=3.0,
    )
    assert state.targets.acquired.tolist() == [AUTOMATIC, MANUAL]
    state, events = run([situate([[400, 0], [400, 100]], zones=QUAY)], state, start=6.0)
    assert told(events) == [('entered an exclusion zone', 1)] and ids(state) == [2]


def test_a_target_lost_in_an_exclusion_zone_is_no_loss(situate):
    state, _ = run([situate([[0, 0]], zones=QUAY)], acquire(begin(), [0, 0], 0.0))
    assert ids(state) == [1]
    _, events = run([situate([[0, 0]], zones=QUAY, status=LOST)], state, start=3.0)
    assert told(events) == [('entered an exclusion zone', 1)]


def test_a_target_at_the_border_of_an_exclusion_zone_does_not_come_and_go(situate):
    state, acquired = begin(), 0
    for k in range(60):
        scene = situate([[499 + 2 * (k % 2), 0]], zones=QUAY)
        state, events = step(state, AcquisitionSettings(border=20.0), scene, 3.0 * k)
        acquired += ('acquired', 1) in told(events)
    assert acquired <= 1
    state, events = run([situate([[520, 0]], zones=QUAY)] * 9, state, start=180.0)
    assert ids(state) == [1]  # back, once it has left it for good


# capacity


def test_the_nearest_are_acquired_first(situate):
    position = np.column_stack([1000 + 100 * np.arange(30), np.zeros(30)])
    order = np.random.default_rng(1).permutation(30)
    state, _ = run([situate(position[order])], settings=AcquisitionSettings(capacity=10))
    assert sorted(state.targets.id.tolist()) == sorted((np.argsort(order)[:10] + 1).tolist())
    assert state.waiting == 20


def test_those_that_close_come_before_those_nearer_that_go(situate):
    scene = situate([[3000, 3000], [3000, 0]], velocity=[[-4, -2.5], [8, 0]])
    state, _ = run([scene], settings=AcquisitionSettings(capacity=1))
    assert ids(state) == [1]


def test_a_newcomer_takes_a_place_only_if_it_is_clearly_nearer(situate):
    settings = AcquisitionSettings(capacity=2)
    state, _ = run([situate([[5000, 0], [4000, 0]])], settings=settings)
    state, events = run([situate([[5000, 0], [4000, 0], [4100, 0]])], state, settings, start=3.0)
    assert told(events) == [] and state.waiting == 1
    state, events = run([situate([[5000, 0], [4000, 0], [3900, 0]])], state, settings, start=6.0)
    assert told(events) == [('acquired', 3), ('gave way to a nearer target', 1)]
    for k in range(5):  # and they do not change back
        state, events = run(
            [situate([[5000, 0], [4000, 0], [3900, 0]])], state, settings, start=9.0 + k
        )
        assert told(events) == []


def test_two_tracks_as_near_do_not_take_turns(situate):
    settings, state, swaps = AcquisitionSettings(capacity=1), begin(), 0
    rng = np.random.default_rng(3)
    for k in range(100):
        scene = situate(np.column_stack([3000 + rng.normal(0, 60, 2), np.zeros(2)]))
        state, events = step(state, settings, scene, 3.0 * k)
        swaps += any(what.startswith('gave way') for what, _ in told(events))
    assert swaps == 0


def closing(count, first=3000):
    """Positions and velocities of targets on collision courses, TCPA 5 to 10 minutes."""
    position = np.column_stack([first + 100.0 * np.arange(count), np.zeros(count)])
    return position, -position / 420.0


def test_a_dangerous_track_takes_the_place_of_a_nearer_harmless_one(situate):
    settings = AcquisitionSettings(capacity=1)
    state, _ = run([situate([[1500, 0]])], settings=settings)
    danger, velocity = closing(1, 6000)
    scene = situate(np.vstack([[[1500, 0]], danger]), np.vstack([[[0, 0]], velocity]))
    state, events = run([scene], state, settings, start=3.0)
    assert ids(state) == [2] and ('acquired', 2) in told(events)


def test_a_dangerous_track_need_not_come_much_nearer_than_the_one_that_gives_way(situate):
    settings = AcquisitionSettings(capacity=1)
    state, _ = run([situate([[1000, 0]])], settings=settings)
    scene = situate([[1000, 0], [900, 3000]], [[0, 0], [0, -8]])
    state, _ = run([scene], state, settings, start=3.0)
    assert scene.nearest[1] > 0.8 * scene.nearest[0] and ids(state) == [2]


def test_dangerous_targets_and_those_by_hand_never_give_way(situate):
    settings = AcquisitionSettings(capacity=2)
    danger, velocity = closing(1)
    base = np.vstack([danger, [[9000, 0]]]), np.vstack([velocity, [[0, 0]]])
    state, _ = run([situate(*base)], acquire(begin(), [9000, 0], 0.0), settings)
    assert sorted(ids(state)) == [1, 2]
    more, its = closing(3, 2000)
    scene = situate(np.vstack([base[0], more]), np.vstack([base[1], its]))
    state, events = run([scene], state, settings, start=3.0)
    assert sorted(ids(state)) == [1, 2] and told(events) == [] and state.waiting == 3


def test_a_click_takes_the_place_of_the_farthest_automatic_target(situate):
    settings, scene = AcquisitionSettings(capacity=2), situate([[1000, 0], [2000, 0], [3000, 0]])
    state, _ = run([scene], settings=settings)
    state, events = run([scene], acquire(state, [3000, 0], 1.0), settings, start=3.0)
    assert ids(state) == [1, 3]
    assert told(events) == [('acquired', 3), ('gave way to a nearer target', 2)]


def test_a_click_finds_no_room_among_targets_by_hand(situate):
    settings, scene = (
        AcquisitionSettings(capacity=2, automatic='nowhere', click_radius=100),
        situate([[1000, 0], [2000, 0], [3000, 0]]),
    )
    state = begin()
    for k in (1, 2):
        state = acquire(state, [1000 * k, 0], 0.0)
    state, _ = run([scene], state, settings)
    state, events = run([scene], acquire(state, [3000, 0], 1.0), settings, start=3.0)
    assert told(events) == [('no room', 3)] and ids(state) == [1, 2]


def test_a_smaller_capacity_takes_effect_at_once(situate):
    scene = situate([[1000, 0], [2000, 0], [3000, 0], [4000, 0]])
    state, _ = run([scene])
    state, events = run([scene], state, AcquisitionSettings(capacity=2), start=3.0)
    assert ids(state) == [1, 2] and len(told(events)) == 2


def test_the_capacity_is_never_exceeded_but_by_what_never_gives_way(situate):
    """A busy hour: tracks come, go, close, are clicked."""
    rng, state, settings = np.random.default_rng(5), begin(), AcquisitionSettings(capacity=12)
    for k in range(200):
        count = int(rng.integers(0, 40))
        chosen = np.sort(rng.permutation(60)[:count])
        position = rng.uniform(-6000, 6000, (60, 2))[chosen]
        scene = situate(
            position,
            rng.normal(0, 6, (count, 2)),
            id=chosen + 1,
            status=rng.choice([CONFIRMED, COASTING, LOST], count),
        )
        if k % 4 == 0:
            state = acquire(state, rng.uniform(-6000, 6000, 2), 3.0 * k)
        state, events = step(state, settings, scene, 3.0 * k)
        firm = (state.targets.acquired == MANUAL) | np.isin(
            state.targets.id, scene.id[scene.danger > 0]
        )
        assert len(firm) <= 12 or firm.all()
        alive = scene.id[scene.status != LOST]
        assert np.isin(state.targets.id, alive).all()
        assert len(np.unique(state.targets.id)) == len(state.targets.id)


# cancelling


def test_a_cancelled_target_is_not_acquired_again_by_itself(situate):
    scene = situate([[1000, 0], [2000, 0]])
    state, _ = run([scene])
    state, events = cancel(state, 1)
    assert told(events) == [('cancelled', 1)] and ids(state) == [2]
    state, events = run([scene] * 50, state, start=3.0)
    assert ids(state) == [2]


def test_a_click_acquires_a_cancelled_target_again(situate):
    scene = situate([[1000, 0]])
    state, _ = run([scene])
    state, events = run([scene], acquire(cancel(state, 1)[0], [1000, 0], 1.0), start=3.0)
    assert told(events) == [('acquired', 1)]
    state, _ = run([scene] * 3, state, start=6.0)
    assert ids(state) == [1] and not len(state.barred.id)


def test_a_cancelled_target_is_acquired_when_it_enters_a_guard_zone_anew(situate):
    settings = AcquisitionSettings(automatic='zones', border=20.0)
    inside, out = situate([[1500, 0]], zones=RING), situate([[900, 0]], zones=RING)
    state, _ = run([inside], settings=settings)
    state, _ = cancel(state, 1)
    state, _ = run([inside] * 20, state, settings, start=3.0)
    assert ids(state) == []  # it is still inside
    state, _ = run([out] * 3 + [inside] * 3, state, settings, start=63.0)
    assert ids(state) == []  # out for 9 s only: the border
    state, _ = run([out] * 9 + [inside], state, settings, start=100.0)
    assert ids(state) == [1]


def test_a_target_cancelled_outside_is_acquired_when_it_enters_a_guard_zone(situate):
    inside, out = situate([[1500, 0]], zones=RING), situate([[2500, 0]], zones=RING)
    state, _ = run([out])
    state, _ = cancel(state, 1)
    state, _ = run([out] * 2, state, start=3.0)
    assert ids(state) == []
    state, _ = run([inside], state, start=9.0)
    assert ids(state) == [1]


def test_the_next_track_after_a_cancelled_one_is_acquired(situate):
    state, _ = run([situate([[0, 0]])])
    state, _ = cancel(state, 1)
    state, _ = run([situate([[0, 0]], status=LOST), situate([[0, 0]], id=[2])], state, start=3.0)
    assert ids(state) == [2] and not len(state.barred.id)


def test_cancel_all_takes_targets_in_acquisition_and_clicks_along(situate):
    scene = situate([[0, 0], [9000, 0]], status=[TENTATIVE, CONFIRMED])
    state, _ = run([scene], acquire(acquire(begin(), [0, 0], 0.0), [500, 500], 0.0))
    assert ids(state) == [1, 2] and len(state.clicks.since) == 1
    state, events = cancel_all(state)
    assert told(events) == [('cancelled', 1), ('cancelled', 2)]
    assert ids(state) == [] and not len(state.clicks.since)
    state, _ = run([scene] * 5, state, start=3.0)
    assert ids(state) == []


@pytest.mark.parametrize('number', [0, 2, -1])
def test_cancelling_what_is_not_there_is_an_error_that_names_it(situate, number):
    state, _ = run([situate([[0, 0]], status=TENTATIVE)], acquire(begin(), [0, 0], 0.0))
    with pytest.raises(ValueError, match=f'no target {number} to cancel'):
        cancel(state, number)


def test_nothing_in_the_arguments_is_written_to(situate):
    scene = situate([[0, 0], [600, 0], [1500, 0]], zones=QUAY)
    state, _ = run([scene])
    before = [np.copy(a) for part in state[:3] for a in part] + [np.copy(a) for a in scene]
    step(acquire(cancel(state, 2)[0], [0, 0], 1.0), AcquisitionSettings(capacity=1), scene, 3.0)
    for a, b in zip(before, [a for part in state[:3] for a in part] + list(scene)):
        np.testing.assert_array_equal(a, b)
