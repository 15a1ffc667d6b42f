"""Places where plots always are, and the ships among them."""

import numpy as np
import pytest

from marine_tracker.service import service_for
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import at_rest, places, steady
from marine_tracker.tracking.lifecycle import COASTING, CONFIRMED, LOST, STATIONARY

SIGMA = 5.0  # m
PERIOD = 2.5  # s


VIEW = places.View(np.zeros(2), 0.0, 5000.0)


def learnt(revolutions, position, velocity=(0.0, 0.0), pd=0.7, sigma=SIGMA, seed=3):
    """The map after so many revolutions of one thing at position + velocity t."""
    rng = np.random.default_rng(seed)
    known = places.empty()
    for k in range(revolutions):
        time = k * PERIOD
        at = np.array(position) + time * np.array(velocity) + rng.normal(0, sigma, 2)
        plots = np.array([at]) if rng.random() < pd else np.zeros((0, 2))
        count = len(plots)
        known = places.learn(known, plots, np.full(count, sigma**2), np.full(count, time), VIEW)
    return known


def test_a_place_is_established_after_fifteen_revolutions_and_lies_where_its_plots_are():
    assert not learnt(12, [300.0, -120.0]).established.any()
    known = learnt(60, [300.0, -120.0])
    assert known.established.sum() == 1
    (row,) = known.established.nonzero()[0]
    assert known.position[row] == pytest.approx([300, -120], abs=3)  # of 40 plots of 5 m
    assert known.share[row] == pytest.approx(0.7, abs=0.2)


@pytest.mark.parametrize('speed', [1.5, 3.0, 8.0])
@pytest.mark.parametrize('sigma', [4.0, 20.0, 60.0])
def test_what_moves_never_becomes_a_place_however_coarse_its_plots_are(speed, sigma):
    for k in range(5, 120, 5):
        known = learnt(k, [900.0, 0.0], [speed, 0.0], pd=0.95, sigma=sigma)
        assert not known.established.any()


def test_what_gives_a_plot_now_and_then_is_no_place():
    assert not learnt(200, [50.0, 70.0], pd=0.12).established.any()


def test_a_place_is_forgotten_once_its_plots_stay_away():
    known = learnt(60, [10.0, 10.0], pd=0.9)
    nothing = np.zeros(0)
    for k in range(150):
        if k == 30:
            assert known.established.any()
        known = places.learn(known, np.zeros((0, 2)), nothing, nothing, VIEW)
    assert not len(known.share)


def test_a_place_out_of_sight_is_kept():
    known = learnt(60, [10.0, 10.0], pd=0.9)
    nothing = np.zeros(0)
    for _ in range(150):
        known = places.learn(known, np.zeros((0, 2)), nothing, nothing, VIEW._replace(near=20.0))
    assert known.established.any()


def sea(revolutions, per_gate, mark=None, pd=0.9, sigma=20.0, seed=1):
    """The map after so many revolutions of even clutter, with a mean of plots in each gate, and
    maybe of a mark."""
    rng = np.random.default_rng(seed)
    gate = np.pi * places.GATE * (sigma**2 + places.WANDER**2)
    known = places.empty()
    for k in range(revolutions):
        plots = rng.uniform(-600, 600, (rng.poisson(per_gate * 1200**2 / gate), 2))
        if mark is not None and rng.random() < pd:
            plots = np.append(plots, [mark + rng.normal(0, sigma, 2)], 0)
        count = len(plots)
        known = places.learn(
            known, plots, np.full(count, sigma**2), np.full(count, k * PERIOD), VIEW
        )
    return known


@pytest.mark.parametrize('per_gate', [0.05, 0.4, 0.8])
def test_clutter_makes_no_places_however_dense_it_is(per_gate):
    known = sea(150, per_gate)
    # An hour over a whole picture holds a few hundred times as many tries: e^7 is a thousand.
    assert places.surplus(known).max() < places.SURE - 7
    assert not known.established.any()
    often = (known.share >= places.BECOMES) & (known.plots >= places.LEAST_PLOTS)
    assert often.any() == (per_gate > 0.05)  # a share alone would have made places


@pytest.mark.parametrize('per_gate', [0.05, 0.25])
def test_a_mark_among_clutter_is_a_place(per_gate):
    known = sea(90, per_gate, mark=np.array([120.0, -310.0]))
    assert known.established.sum() == 1
    assert known.position[known.established][0] == pytest.approx([120, -310], abs=20)


def test_a_mark_that_is_gone_ends_though_clutter_goes_on_at_its_place():
    known = sea(60, 0.25, mark=np.array([120.0, -310.0]))
    assert known.established.any()
    rng = np.random.default_rng(9)
    gate = np.pi * places.GATE * (20.0**2 + places.WANDER**2)
    for k in range(60, 260):
        plots = rng.uniform(-600, 600, (rng.poisson(0.25 * 1200**2 / gate), 2))
        count = len(plots)
        known = places.learn(known, plots, np.full(count, 400.0), np.full(count, k * PERIOD), VIEW)
    assert not known.established.any()


class Harbour:
    """A scene followed: per scan the live targets, stationary tracks and objects."""

    def __init__(self, scene, seed, **parameters):
        self.scene = scene
        parameters = {'estimator': 'imm', 'stationary_places': True, **parameters}
        service = service_for(scene.tracker_parameters(), **parameters)
        memory = service.start()
        self.truth, self.tracks, self.place, self.shown, self.alerts = [], [], [], [], []
        for scan, truth in radar.simulate(scene, seed):
            memory, output = service.step(memory, scan)
            self.truth.append(truth)
            self.tracks.append(output.report.tracks)
            self.place.append(output.estimate.position)
            self.shown.append(output.picture.fixed.shown)
            self.alerts.append(output.picture.alerts)
        self.moving = memory.tracker.ground.moving

    def number_at(self, k, ship, within=30.0):
        """Number and status of what is shown at a ship (0 for none) after scan k."""
        at = self.truth[k].position[self.truth[k].target == ship][0]
        tracks, shown = self.tracks[k], self.shown[k]
        live = (tracks.number > 0) & np.isin(tracks.status, (CONFIRMED, COASTING))
        apart = np.linalg.norm(self.place[k][live] - at, axis=1)
        if len(apart) and apart.min() < within:
            return int(tracks.number[live][apart.argmin()]), CONFIRMED
        apart = np.linalg.norm(shown.position - at, axis=1)
        if len(apart) and apart.min() < within:
            return int(shown.number[apart.argmin()]), STATIONARY
        return 0, LOST

    def numbers(self, k):
        """Numbers of the live targets after scan k."""
        tracks = self.tracks[k]
        return tracks.number[np.isin(tracks.status, (CONFIRMED, COASTING)) & (tracks.number > 0)]


RADAR = {
    'rotation_rpm': 24,
    'max_range_m': 1500,
    'range_sigma_m': 4,
    'bearing_sigma_deg': 0.4,
    'range_resolution_m': 8,
    'beam_width_deg': 1,
    'pd_near': 0.95,
    'pd_far': 0.9,
}


def scene(make_scenario, *targets, **more):
    """Quays 500 m apart, own ship at rest between them, and these targets."""
    quays = [
        {'corners_m': [[-500, -240], [700, -250]], 'spacing_m': 40, 'pd': [0.4, 0.95]},
        {'corners_m': [[-500, 260], [700, 230]], 'spacing_m': 40, 'pd': [0.4, 0.95]},
    ]
    values = {
        'duration_s': 400,
        'radar': RADAR,
        'clutter': {'uniform': 4},
        'tracker': {'vessel_class': 'small_craft', 'max_target_speed_kn': 30},
        'reflectors': quays,
        'targets': list(targets),
    }
    return make_scenario(**{**values, **more})


@pytest.fixture
def make_scenario(tmp_path):
    """Builds a scenario from its keys."""
    return lambda **values: scenario.build(values, 'quays')


LEAVES = {
    'name': 'leaves her berth',
    'start': {'north_m': 120, 'east_m': 205},
    'course_deg': 255,
    'speed_kn': 0,
    'legs': [{'straight': {'duration_s': 220}}, {'speed': {'to_kn': 6, 'duration_s': 20}}],
}
STOPS = {
    'name': 'goes alongside',
    'start': {'north_m': 450, 'east_m': 40},
    'course_deg': 215,
    'speed_kn': 6,
    'legs': [{'straight': {'duration_s': 95}}, {'speed': {'to_kn': 0, 'duration_s': 40}}],
}
ANCHORED = {'name': 'at anchor', 'start': {'north_m': -300, 'east_m': 20}, 'speed_kn': 0, 'pd': 0.6}


@pytest.fixture(scope='module', params=[2, 5])
def harbour(request):
    made = scene(lambda **values: scenario.build(values, 'quays'), LEAVES, STOPS, ANCHORED)
    return Harbour(made, request.param)


def test_quays_are_stationary_objects_and_only_ships_are_targets(harbour):
    late = range(100, 160)
    assert np.mean([len(harbour.numbers(k)) for k in late]) < 6  # of three ships
    assert 40 < np.mean([len(harbour.shown[k].number) for k in late]) < 75  # of 62 points


def test_a_stationary_object_keeps_its_number(harbour):
    before, after = harbour.shown[80], harbour.shown[159]
    apart = np.linalg.norm(before.position[:, None] - after.position, axis=2)
    near = apart.min(1) < 15
    same = before.number[near] == after.number[apart.argmin(1)[near]]
    assert near.mean() > 0.9 and same.mean() > 0.95
    given = {number for shown in harbour.shown for number in shown.number.tolist()}
    assert len(given) < 80  # 62 points, and what lies between them


def test_a_ship_that_leaves_her_berth_keeps_her_number(harbour):
    number, _ = harbour.number_at(80, 1)
    assert number
    for k in range(110, 150):
        assert harbour.number_at(k, 1)[0] in (number, 0)
    assert harbour.number_at(150, 1) == (number, CONFIRMED)


def test_a_ship_that_goes_alongside_stays_one_target(harbour):
    numbers = [harbour.number_at(k, 2, within=20.0) for k in range(30, 160)]
    assert all(status == CONFIRMED for _, status in numbers)
    assert len({number for number, _ in numbers}) == 1


def test_an_anchored_ship_that_is_seen_six_times_in_ten_never_vanishes(harbour):
    numbers = [harbour.number_at(k, 3)[0] for k in range(30, 160)]
    assert all(numbers) and len(set(numbers)) == 1


def test_without_learning_every_quay_is_a_target():
    made = scene(lambda **values: scenario.build(values, 'quays'), ANCHORED, duration_s=200)
    known = Harbour(made, 2, stationary_places=False)
    assert len(known.numbers(79)) > 30 and not len(known.shown[79].number)


def test_one_warning_tells_of_the_quay_ahead_and_a_lone_ship_at_anchor_has_an_alarm_of_her_own():
    from marine_tracker.arpa import alarms

    ahead = {
        'name': 'at anchor ahead',
        'start': {'north_m': 1300, 'east_m': 5},
        'speed_kn': 0,
        'pd': 0.6,
    }
    pier = {'corners_m': [[150, -150], [150, 150]], 'spacing_m': 30, 'pd': 0.8}
    made = scene(
        lambda **values: scenario.build(values, 'quays'),
        ahead,
        reflectors=[pier],
        radar={**RADAR, 'max_range_m': 2500},
        own_ship={'start': {'north_m': -600, 'east_m': 0}, 'course_deg': 0, 'speed_kn': 5},
        duration_s=250,
    )
    known = Harbour(made, 4)
    seen = known.alerts[90]
    assert (seen.kind == alarms.STATIONARY_DANGER).sum() == 1
    number, _ = known.number_at(90, 1)
    assert number in seen.number[seen.kind == alarms.DANGER].tolist()
    assert len(known.shown[90].number) >= 8


def test_shown_places_are_those_without_a_target():
    ids = np.arange(3)
    known = learnt(60, [300.0, -120.0], pd=0.9)
    named, following = at_rest.name(known, 7)
    assert following == 8 and named.number[named.established].tolist() == [7]
    anchors = at_rest.Anchors(
        ids,
        np.zeros((3, 2)),
        np.ones(3),
        ids,
        ids > 0,
        np.array([7, 2, 3]),
        ids > 5,
        steady.begin(np.zeros((3, 2)), np.zeros(3)),
    )
    ground = at_rest.Ground(named, anchors, 60)
    assert at_rest.shown(ground).number.tolist() == [7]
    targets = ground._replace(anchors=anchors._replace(target=ids == 0))
    assert not len(at_rest.shown(targets).number)
