"""busy_strait with a pause of the plots, through the screen of scans and the tracker."""

import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import intake, silence
from marine_tracker.tracking.lifecycle import LOST
from marine_tracker.tracking.tracker import Tracker

BEFORE, AFTER, NEAR = 60, 8, 400.0  # scans; m
SLOW = pytest.mark.slow


@pytest.fixture(scope='module')
def strait():
    """Tracker parameters, scans and truths."""
    chosen = scenario.load('busy_strait')
    pairs = [pair for pair, _ in zip(radar.simulate(chosen, 21), range(185))]
    return from_mapping(TrackerParameters, chosen.tracker_parameters()), pairs


def ships(tracker, report, truth):
    """{number: the ship that is nearest, 0 for none}."""
    tracks, found = report.tracks, {}
    place = tracker.extrapolate(tracks, report.time).position
    for row in np.flatnonzero((tracks.number > 0) & (tracks.status != LOST)):
        away = np.hypot(*(truth.position - place[row]).T)
        near = int(truth.target[away.argmin()]) if away.min() < NEAR else 0
        found[int(tracks.number[row])] = near
    return found


def played(strait, pause, wrong=None, screened=True):
    """Before and after a pause, s; wrong: {place of a scan: s ahead}."""
    parameters, pairs = strait
    tracker = Tracker(parameters)
    memory, order = tracker.start(), intake.TimeOrder()
    stop, period = pairs[BEFORE - 1][0].end, parameters.scan_period_s
    before, left = {}, AFTER
    for place, (scan, truth) in enumerate(pairs):
        if stop < scan.end <= stop + pause:
            continue
        if screened:
            ahead = (wrong or {}).get(place, 0.0)
            order, taken, _ = intake.admit_scan(
                order, scan.start + ahead, period, arrival=scan.end, own=scan.end
            )
            if not taken:
                continue
            assert ahead == 0.0 and order.shift == 0.0
        memory, report = tracker.step(memory, scan)
        if scan.end <= stop:
            before = {k: ship for k, ship in ships(tracker, report, truth).items() if ship}
            continue
        left -= 1
        if not left:
            return before, ships(tracker, report, truth)
    raise AssertionError('the scenario is too short')


@pytest.mark.parametrize(
    'pause, share',
    [
        pytest.param(25, 0.95, marks=SLOW),
        (33, 0.90),
        pytest.param(60, 0.90, marks=SLOW),
        pytest.param(120, 0.85, marks=SLOW),
        pytest.param(300, 0.60, marks=SLOW),
    ],
)
def test_after_a_pause_nearly_all_targets_go_on_and_none_under_a_wrong_number(
    strait, monkeypatch, pause, share
):
    before, after = played(strait, pause)
    with monkeypatch.context() as patch:
        patch.setattr(silence, 'LONG_S', np.inf)
        _, bare = played(strait, pause, screened=False)
    assert len(before) >= 38
    assert not [number for number, ship in before.items() if after.get(number, 0) not in (0, ship)]
    kept, most = (
        sum(shown.get(number) == ship for number, ship in before.items()) for shown in (after, bare)
    )
    assert kept >= share * most


def test_single_stamps_ahead_cost_no_target(strait):
    before, after = played(strait, 0.0, {62: 5.0, 64: 11.0, 65: 30.0})
    assert {number: after.get(number) for number in before} == before
