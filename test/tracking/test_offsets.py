"""What is wrong with a radar: offsets of range and bearing, and how late its plots are."""

import dataclasses

import numpy as np
import pytest

from marine_tracker.geometry import locate, own_ship_at, to_range_bearing, unit_vector
from marine_tracker.parameters import TrackerParameters
from marine_tracker.service import service_for
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import offsets, places
from marine_tracker.types import OwnShip, PolarPlots, Scan

PERIOD, SIGMA_M, SIGMA = 2.5, 4.0, float(np.radians(0.35))
OFF = np.array([11.0, np.radians(-0.9), 0.7])  # m, rad, s
NONE = np.zeros((0, 2))
P = TrackerParameters(range_sigma_m=SIGMA_M, bearing_sigma_deg=0.35, scan_period_s=PERIOD)


def way(seconds, speed, turning, heading0=0.6):
    """Own ship every half second: steady, or in turns of a minute to and fro."""
    time = np.arange(-5.0, seconds + 5.0, 0.5)
    heading = heading0 + (1.1 * np.sin(2 * np.pi * time / 110) if turning else 0 * time)
    velocity = speed * unit_vector(heading)
    position = np.cumsum(np.append([[0, 0]], 0.5 * velocity[:-1], 0), 0)
    return OwnShip(time, position, velocity, heading)


def followed(speed, turning, seconds=300, off=OFF, marks=NONE, seed=1, bow=False):
    """The memory after so many seconds among eighteen marks."""
    rng = np.random.default_rng(seed)
    own = way(seconds, speed, turning)
    stands = rng.uniform([-900, -1200], [1500, 1800], (18, 2))
    p = dataclasses.replace(P, bearings='bow' if bow else 'north')
    memory = offsets.begin()
    number = np.arange(1, 19)
    there = places.empty()
    for k in range(int(seconds / PERIOD)):
        stamp = k * PERIOD + np.sort(rng.uniform(0, PERIOD, len(stands)))
        away = stands - own_ship_at(own, stamp - off[2])[0]
        range_, bearing = to_range_bearing(away)
        range_ = range_ + off[0] + rng.normal(0, SIGMA_M, len(stands))
        bearing = bearing + off[1] + rng.normal(0, SIGMA, len(stands))
        if bow:  # told from the bow, made true by the heading of the stamp
            heading = np.interp(stamp, own.time, own.heading)
            bearing += heading - np.interp(stamp - off[2], own.time, own.heading)
        seen = rng.random(len(stands)) < 0.8
        polar = PolarPlots(stamp, range_, np.mod(bearing, 2 * np.pi), 0 * stamp)
        scan = Scan(k * PERIOD, (k + 1) * PERIOD, polar, own)
        plots = locate(polar, own, SIGMA_M, SIGMA)
        if not k:
            there = places.Places(
                *(np.zeros((18,) + column.shape[1:], column.dtype) for column in there)
            )._replace(position=plots.position, variance=np.full(18, 300.0), number=number.copy())
        there = there._replace(position=there.position + 0.1 * (plots.position - there.position))
        told = plots.range, plots.bearing, plots.origin, offsets.rates(scan, stamp, p)
        told = tuple(column[seen] for column in told)
        variance = np.full(seen.sum(), 300.0)
        memory = offsets.learn(memory, there, plots.position[seen], variance, told, p, marks)
    return memory, stands


@pytest.mark.parametrize(('bow', 'seed'), [(False, 1), (True, 2), (False, 3)])
def test_a_ship_that_turns_finds_all_three_in_five_minutes(bow, seed):
    found = offsets.estimate(followed(6.0, True, seed=seed, bow=bow)[0])
    assert found.known.all()
    assert found.value[0] == pytest.approx(OFF[0], abs=5)
    assert np.degrees(found.value[1] - OFF[1]) == pytest.approx(0, abs=0.1)
    assert found.value[2] == pytest.approx(OFF[2], abs=0.1)


def test_on_a_steady_course_the_lag_is_not_told_but_the_offsets_are():
    memory, _ = followed(6.0, False)
    found = offsets.estimate(memory)
    assert found.known.tolist() == [True, True, False]
    assert found.value[0] == pytest.approx(OFF[0], abs=5)
    assert np.degrees(found.value[1] - OFF[1]) == pytest.approx(0, abs=0.1)
    told = offsets.in_words(memory)
    assert told['plot lag_s'] == offsets.NOT_KNOWN
    assert float(told['bearing offset_deg'].split()[0]) == pytest.approx(-0.9, abs=0.1)


def test_a_ship_at_rest_knows_nothing_unless_positions_of_marks_are_known():
    memory, stands = followed(0.0, False)
    assert not offsets.estimate(memory).known.any()
    found = offsets.estimate(followed(0.0, False, marks=stands[:4])[0])
    assert found.known.tolist() == [True, True, False]
    assert found.value[0] == pytest.approx(OFF[0], abs=3)
    assert np.degrees(found.value[1] - OFF[1]) == pytest.approx(0, abs=0.1)


def test_a_good_radar_is_found_to_be_good():
    found = offsets.estimate(followed(6.0, True, off=np.zeros(3))[0])
    assert found.known.all()
    assert (np.abs(found.value) < 4 * found.sigma).all()


def test_the_deviations_are_those_of_the_estimates():
    every = [offsets.estimate(followed(7.0, True, 120, seed=k)[0]) for k in range(8)]
    ratio = np.array([(one.value - OFF) / one.sigma for one in every])
    # 24 values of at most unit variance (the scatter is less than assumed): 3 is beyond .999.
    assert 0.2 < np.sqrt((ratio**2).mean()) < 1.5


def test_reports_of_ships_that_pass_show_the_offsets_from_a_shore():
    """As AIS would: where each ship is told to be, with its motion and its deviation."""
    rng, memory = np.random.default_rng(4), offsets.begin()
    start, velocity = rng.uniform(-2000, 2000, (6, 2)), rng.uniform(-8, 8, (6, 2))
    for k in range(60):
        time = k * PERIOD + np.zeros(6)
        told = start + time[:, None] * velocity + rng.normal(0, 8.0, (6, 2))
        range_, bearing = to_range_bearing(start + (time - OFF[2])[:, None] * velocity)
        distance, expected = to_range_bearing(told)
        along = told / distance[:, None]
        across = np.stack([along[:, 1], -along[:, 0]], 1)
        rate = [(velocity * along).sum(1), (velocity * across).sum(1) / distance]
        off = [
            range_ + OFF[0] + rng.normal(0, SIGMA_M, 6) - distance,
            np.mod(bearing + OFF[1] + rng.normal(0, SIGMA, 6) - expected + np.pi, 2 * np.pi)
            - np.pi,
        ]
        covariance = np.zeros((6, 2, 2))
        covariance[:, 0, 0] = SIGMA_M**2 + 8.0**2
        covariance[:, 1, 1] = SIGMA**2 + (8.0 / distance) ** 2
        seen = offsets.Compared(np.stack(off, 1), np.stack(rate, 1), covariance)
        memory = offsets.refer(memory, seen)
    found = offsets.estimate(memory)
    assert found.known[:2].all()
    assert (np.abs(found.value - OFF) < 3.5 * found.sigma).all()
    assert np.degrees(found.value[1] - OFF[1]) == pytest.approx(0, abs=0.1)


def test_a_mark_that_is_gone_keeps_what_it_told():
    memory, _ = followed(6.0, True)
    before = offsets.estimate(memory)
    none = tuple(np.zeros((0,) + shape) for shape in ((), (), (2,), (3,)))
    after = offsets.learn(memory, places.empty(), NONE, np.zeros(0), none, P, NONE)
    assert not len(after.marks.number)
    assert offsets.estimate(after).value == pytest.approx(before.value, rel=1e-3)


SCENE = {
    'duration_s': 300,
    'radar': {
        'rotation_rpm': 24,
        'max_range_m': 2500,
        'range_sigma_m': 4,
        'bearing_sigma_deg': 0.3,
        'pd_near': 0.95,
    },
    'own_ship': {
        'course_deg': 40,
        'speed_kn': 12,
        'legs': [{'straight': {'duration_s': 20}}]
        + [{'turn': {'rate_deg_per_s': 2.5, 'angle_deg': a}} for a in (110, -160, 170, -140)],
    },
    'reflectors': [
        {'corners_m': [[-300, -500], [1100, -400]], 'spacing_m': 90, 'pd': 0.9},
        {'places_m': [[700, 500], [200, 700], [1300, 400], [-300, 500]], 'pd': 0.9},
    ],
    'targets': [{'start': {'north_m': 900, 'east_m': 1500}, 'course_deg': 300, 'speed_kn': 8}],
}


@pytest.mark.parametrize('applied', [False, True])
def test_a_tracker_takes_off_what_it_knows_when_asked(applied):
    scene = scenario.build(SCENE, 'wrong')
    service = service_for(scene.tracker_parameters(), estimator='imm', correct_plots=applied)
    memory, apart = service.start(), []
    for scan, truth in radar.simulate(scene, 3):
        wrong = scan.plots._replace(
            range=scan.plots.range + 20.0,
            bearing=np.mod(scan.plots.bearing + np.radians(1.5), 2 * np.pi),
        )
        memory, done = service.track(memory, scan._replace(plots=wrong))
        ship = truth.position[0]
        apart.append(np.linalg.norm(done.estimate.position - ship, axis=1).min(initial=500.0))
    off = memory.tracker.radars[0].offsets
    found = offsets.estimate(off)
    assert found.known[:2].all()
    assert found.value[0] == pytest.approx(20, abs=5)
    assert np.degrees(found.value[1]) == pytest.approx(1.5, abs=0.1)
    assert off.applied.any() == applied
    late = float(np.median(apart[-6:]))
    assert late < 15 if applied else late > 25


def test_what_is_no_list_of_positions_is_named():
    assert offsets.marks_of('[[10, -20], [3.5, 4]]').tolist() == [[-20, 10], [4, 3.5]]
    assert offsets.marks_of('').shape == (0, 2)
    for wrong in ('[1, 2, 3]', '[[1, x]]', '{a: 1}', '7'):
        with pytest.raises(ValueError, match='parameter known_marks is '):
            offsets.marks_of(wrong)
