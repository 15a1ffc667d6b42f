"""Two radars in one tracker: who sees what, and who fails."""

import numpy as np
import pytest

from marine_tracker.estimators import ESTIMATORS
from marine_tracker.geometry import locate
from marine_tracker.parameters import TrackerParameters
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import late_plots
from marine_tracker.tracking.lifecycle import COASTING
from marine_tracker.tracking.radars import fused, merged
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import Plots

FLEET = np.array([[2000.0, 1500.0], [-1000.0, 3000.0], [500.0, -2500.0], [-4000.0, -300.0]])
COURSES = np.array([[5.0, -3.0], [0.3, 0.1], [-4.0, 6.0], [9.0, 1.0]])
PERIODS = 2.5, 3.2
OWN = [
    {'range_sigma_m': 10.0, 'bearing_sigma_deg': 0.4, 'scan_period_s': PERIODS[0]},
    {'range_sigma_m': 30.0, 'bearing_sigma_deg': 0.8, 'scan_period_s': PERIODS[1]},
]


@pytest.fixture
def fleet(revolution):
    """The scans of both radars over so many seconds; seen(radar, time) masks the targets."""

    def make(seconds, seen=lambda radar, time: None, false=0, seed=1):
        rng = np.random.default_rng(seed)
        return [
            [
                revolution(
                    k,
                    FLEET,
                    COURSES,
                    rng=rng,
                    period=period,
                    bearing0=1.3 * place,
                    seen=seen(place, k * period),
                    false=false,
                    range_sigma=OWN[place]['range_sigma_m'],
                    bearing_sigma=np.radians(OWN[place]['bearing_sigma_deg']),
                )
                for k in range(int(seconds / period))
            ]
            for place, period in enumerate(PERIODS)
        ]

    return make


def parameters(*own, **more):
    return TrackerParameters(**{**fused(own or OWN, ['a', 'b'][: len(own or OWN)]), **more})


def follow(scans, tracker=None):
    """(scan, memory) after each scan."""
    tracker = tracker or Tracker(parameters())
    memory, out = tracker.start(), []
    for scan in scans:
        memory, _ = tracker.step(memory, scan)
        out.append((scan, memory))
    return out


def held(memory):
    return sorted(memory.tracks.number[memory.tracks.number > 0].tolist())


@pytest.mark.parametrize('name', ['cs_kalman', 'imm'])
def test_two_plots_of_one_time_are_their_weighted_mean(name):
    """With the inverse covariances as weights; a filter must not care which way it is told."""
    estimator = ESTIMATORS[name](TrackerParameters(estimator=name))
    rng, count = np.random.default_rng(3), 50

    def plots(position, covariance, time):
        none = np.zeros(count)
        return Plots(
            np.full(count, time), none, none, none, np.zeros((count, 2)), position, covariance
        )

    def covariances():
        root = rng.normal(0, 20, (count, 2, 2))
        return root @ root.swapaxes(1, 2) + 100 * np.eye(2)

    start = plots(rng.uniform(-3000, 3000, (count, 2)), covariances(), 0.0)
    separate = together = estimator.init(start)
    for time in (2.5, 5.0, 9.0):
        (z1, r1), (z2, r2) = (
            (start.position + 5.0 * time + rng.normal(0, 30, (count, 2)), r)
            for r in (covariances(), covariances())
        )
        w1, w2 = np.linalg.inv(r1), np.linalg.inv(r2)
        r = np.linalg.inv(w1 + w2)
        z = (r @ (w1 @ z1[..., None] + w2 @ z2[..., None]))[..., 0]
        rows = np.arange(count)
        separate = estimator.update(separate, plots(z1, r1, time), rows)
        separate = estimator.update(separate, plots(z2, r2, time), rows)
        together = estimator.update(together, plots(z, r, time), rows)
    for one, other in zip(separate, together, strict=True):
        # Of numbers up to 3e3 m.
        assert np.abs(one - other).max() <= 1e-8 * max(1.0, np.abs(other).max())


def test_the_track_knows_all_plots_in_the_order_of_their_times(fleet):
    """After a run of both radars the states are those of the tracks' plots sorted by time."""
    tracker = Tracker(parameters(estimator='imm', glint_sigma_m=0.0))
    memory, taken = tracker.start(), {}
    late = 0
    for scan in merged(*fleet(60)):
        before = {i: t for i, t in zip(memory.tracks.id, memory.tracks.last_time)}
        memory, report = tracker.step(memory, scan)
        p = tracker.radars[scan.radar]
        plots = locate(scan.plots, scan.own_ship, p.range_sigma_m, np.radians(p.bearing_sigma_deg))
        for row in np.flatnonzero(report.plot >= 0):
            id_ = report.tracks.id[row]
            new = len(report.plot) - row <= len(report.begun.time)
            if new:
                place = row - (len(report.plot) - len(report.begun.time))
                taken[id_] = [late_plots.take(report.begun, slice(place, place + 1))]
            late += plots.time[report.plot[row]] < before.get(id_, -np.inf)
            taken[id_].append(late_plots.take(plots, slice(report.plot[row], report.plot[row] + 1)))
    assert held(memory) == [1, 2, 3, 4] and late > 10
    for row, id_ in enumerate(memory.tracks.id):
        first, *rest = taken[id_]
        state = tracker.estimator.init(first)
        for plot in sorted(rest, key=lambda plot: plot.time[0]):
            state = tracker.estimator.update(state, plot, np.arange(1))
        np.testing.assert_allclose(
            memory.tracks.state.mean[row], state.mean[0], rtol=1e-8, atol=1e-8
        )


def test_all_targets_are_confirmed_sooner_than_by_one_radar(fleet):
    a, b = fleet(40)
    both = next(scan.end for scan, memory in follow(merged(a, b)) if len(held(memory)) == 4)
    alone = next(
        scan.end
        for scan, memory in follow(a, Tracker(TrackerParameters(**OWN[0])))
        if len(held(memory)) == 4
    )
    assert both < alone


def test_a_target_that_one_radar_never_sees_is_held_and_does_not_coast(fleet):
    everyone = np.ones(4, bool)
    scans = merged(
        *fleet(
            200, lambda radar, time: everyone if radar == 0 else np.array([True, False, True, True])
        )
    )
    found = [memory for scan, memory in follow(scans) if scan.end > 30]
    assert all(held(memory) == [1, 2, 3, 4] for memory in found)
    # The gate leaves one plot in two hundred out.
    coasts = np.mean([(memory.tracks.status == COASTING).sum() for memory in found]) / 4
    assert coasts < 0.02


def test_a_radar_may_fail_and_return(fleet):
    a, b = fleet(400)
    fails = [scan for scan in b if not 100 < scan.end < 250]
    found = follow(merged(a, fails))
    for scan, memory in found:
        if scan.end > 30:
            assert held(memory) == [1, 2, 3, 4]
    took = [
        memory.tracks.radar == 1 for scan, memory in found if scan.radar == 1 and scan.end > 251
    ]
    assert took[0].all() and np.mean(took) > 0.97  # it joins in again at once


def test_a_target_that_neither_sees_is_lost_when_its_time_is_over(fleet):
    gone = np.array([True, False, True, True])
    scans = merged(*fleet(200, lambda radar, time: gone if time > 100 else None))
    found = follow(scans)
    coasts = next(m for s, m in found if s.end > 108)
    assert (coasts.tracks.status == COASTING).sum() == 1
    assert len(held(found[-1][1])) == 3


def test_beyond_the_range_of_one_radar_the_other_goes_on(fleet):
    own = [OWN[0], {**OWN[1], 'max_range_m': 2800.0}]
    a, b = fleet(120)
    b = [scan._replace(plots=late_plots.take(scan.plots, scan.plots.range < 2800)) for scan in b]
    found = follow(merged(a, b), Tracker(parameters(*own)))
    assert held(found[-1][1]) == [1, 2, 3, 4]


def test_a_late_plot_never_turns_a_tracks_time_back(fleet):
    tracker = Tracker(parameters())
    memory, last = tracker.start(), {}
    for scan in merged(*fleet(60)):
        memory, report = tracker.step(memory, scan)
        for id_, time in zip(report.tracks.id.tolist(), report.time.tolist()):
            assert time >= last.get(id_, -np.inf)
            last[id_] = time


def test_false_plots_of_two_radars_make_no_more_tracks_than_both_alone(fleet):
    nobody = np.zeros(4, bool)
    a, b = fleet(600, lambda radar, time: nobody, false=40)

    def made(scans, p):
        tracker = Tracker(p)
        memory = tracker.start()
        for scan in scans:
            memory, _ = tracker.step(memory, scan)
        return memory.next_number - 1

    alone = sum(made(scans, TrackerParameters(**own)) for scans, own in zip((a, b), OWN))
    # Of Poisson numbers with the same mean, two deviations apart at most.
    together = made(merged(a, b), parameters())
    assert together <= alone + 2 * np.sqrt(2 * alone + 1)


def test_a_scene_is_the_same_for_both_radars():
    x, s = scenario.load('two_radars_x'), scenario.load('two_radars_s')
    for time in (0.0, 400.0, 899.0):
        np.testing.assert_array_equal(x.truth_at(time).position, s.truth_at(time).position)
    first, second = (next(radar.simulate(one, 1))[0] for one in (x, s))
    assert first.end != second.end


def test_another_estimator_takes_the_tracks_of_two_radars_over(fleet):
    scans = list(merged(*fleet(80)))
    before, after = Tracker(parameters(estimator='imm')), Tracker(parameters(estimator='cs_kalman'))
    memory = follow(scans[:30], before)[-1][1]
    memory = after.adopt(memory, before)
    for scan in scans[30:]:
        memory, _ = after.step(memory, scan)
        assert held(memory) == [1, 2, 3, 4]
