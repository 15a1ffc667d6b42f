import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import doppler
from marine_tracker.tracking.gate import Pairs
from marine_tracker.tracking.lifecycle import CONFIRMED
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import Extrapolation, Plots, take

SIGMA, REACH = 0.2, 3.0


def plots_at(position, radial_speed, time=0.0):
    position = np.asarray(position, float)
    count = len(position)
    none = np.zeros(count)
    return Plots(
        none + time,
        np.hypot(*position.T),
        np.arctan2(*position.T),
        none,
        np.zeros((count, 2)),
        position,
        np.tile(np.eye(2), (count, 1, 1)),
        np.asarray(radial_speed, float),
    )


def tracks(position, velocity, sigma):
    covariance = np.tile(np.diag([1.0, 1.0, sigma**2, sigma**2]), (len(position), 1, 1))
    return Extrapolation(
        np.zeros(len(position)),
        np.asarray(position, float),
        np.asarray(velocity, float),
        covariance,
    )


NO_TRACKS = tracks(np.zeros((0, 2)), np.zeros((0, 2)), 1.0)
NO_PLOTS = plots_at(np.zeros((0, 2)), [])


def agrees(track, plot, ahead, lone, plots, max_speed=10.0):
    """Which of the pairs (track, plot) radial speeds leave."""
    pairs = Pairs(np.array(track), np.array(plot), np.zeros(len(track)), np.zeros(len(track)))
    limits = doppler.Limits(SIGMA, max_speed, REACH)
    left, shares = doppler.agreeing(pairs, ahead, lone, plots, limits)
    kept = set(zip(left.track.tolist(), left.plot.tolist()))
    of_tracks = [pair in kept for pair in zip(track, plot) if pair[0] < len(ahead.time)]
    assert shares.tracks == (sum(of_tracks) + 1) / (len(of_tracks) + 1)
    assert shares.lone == (len(kept) - sum(of_tracks) + 1) / (len(track) - len(of_tracks) + 1)
    assert len(left.track) == len(left.nis) == len(left.log_det) == len(kept)
    return [pair in kept for pair in zip(track, plot)]


@pytest.mark.parametrize(
    'place, speed, passes',
    [
        ((1000, 0), 5.0, True),  # east of the radar, the eastward speed is what leaves
        ((1000, 0), 5.0 + 0.66, True),
        ((1000, 0), 5.0 + 0.70, False),  # 3 sqrt(0.2^2 + 0.1^2)
        ((1000, 0), 5.0 - 0.70, False),
        ((1000, 0), -5.0, False),
        ((0, 1000), -2.0, True),
        ((0, 1000), 5.0, False),  # north of it, the northward one
        ((1000, 0), np.nan, True),
    ],
)
def test_a_plot_must_leave_as_fast_as_its_track_goes_that_way(place, speed, passes):
    ahead = tracks([place], [(5.0, -2.0)], 0.1)
    assert agrees([0], [0], ahead, NO_PLOTS, plots_at([place], [speed])) == [passes]


@pytest.mark.parametrize(
    'before, now, step, passes',
    [
        (4.0, 4.8, 1e-6, True),
        (4.0, 4.9, 1e-6, False),  # 3 sqrt 2 0.2 = 0.849
        (4.0, 5.8, 10.0, True),
        (4.0, 5.9, 10.0, False),  # and 10^2 / 1000 in each second
        (np.nan, 9.0, 1e-6, True),
        (4.0, np.nan, 1e-6, True),
    ],
)
def test_two_plots_of_a_new_target_leave_alike(before, now, step, passes):
    lone = plots_at([(0, 1000.0)], [before])
    plots = plots_at([(0, 1000.0)], [now], step)
    assert agrees([0], [0], NO_TRACKS, lone, plots) == [passes]


def test_lone_plots_that_told_nothing_rule_nothing_out():
    lone = plots_at([(0, 1000.0)], [0.0])._replace(radial_speed=None)
    assert agrees([0], [0], NO_TRACKS, lone, plots_at([(0, 1000.0)], [9.0])) == [True]


def test_tracks_and_lone_plots_are_told_apart_in_one_call():
    ahead = tracks([(1000, 0)], [(5.0, 0.0)], 0.1)
    lone = plots_at([(0, 1000.0)], [-3.0])
    plots = plots_at([(1000, 0), (0, 1000.0)], [5.0, -3.0])
    fit = agrees([0, 0, 1, 1], [0, 1, 0, 1], ahead, lone, plots, max_speed=0.01)
    assert fit == [True, False, False, True]


@pytest.fixture(scope='module')
def hf_scans():
    return [pair for pair in radar.simulate(scenario.load('hf_radar'), 3)][:30]


@pytest.mark.parametrize('estimator', ['alpha_beta', 'imm'])
def test_doppler_keeps_clutter_from_becoming_targets(hf_scans, estimator):
    """450 false plots a scan of the HF radar: every ship held and hardly a false track, fewer than
    the same plots give where they count for the filter only."""
    told_of = scenario.load('hf_radar').tracker_parameters()

    def run(told):
        tracker = Tracker(TrackerParameters(estimator=estimator, doppler_gate=told, **told_of))
        memory = tracker.start()
        for scan, _ in hf_scans:
            memory, report = tracker.step(memory, scan)
        alive = take(report.tracks, report.tracks.status == CONFIRMED)
        truth = hf_scans[-1][1]
        now = tracker.extrapolate(alive, truth.time[0])
        apart = np.linalg.norm(now.position[:, None] - truth.position, axis=-1)
        return len(alive.id), (apart.min(0, initial=np.inf) < 6000).sum()

    with_, held = run(True)
    without, _ = run(False)
    assert held >= 4 and with_ <= held + 1
    assert without > with_
