"""Sectors of a revolution give what whole revolutions give."""

from itertools import islice

import numpy as np
import pytest

from marine_tracker.geometry import wrap_angle
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.service import service_for
from marine_tracker.simulation import radar, scenario, sectors
from marine_tracker.tracking import sectors as parts_of
from marine_tracker.tracking.gate import Pairs
from marine_tracker.tracking.mounting import mounted
from marine_tracker.tracking.radars import fused, merged
from marine_tracker.tracking.sweep import sweep_of
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import Sector, take

STRAIT = 'busy_strait'


def scene(name, count, seed=4):
    """The scans of a shipped scenario, and its tracker parameters."""
    loaded = scenario.load(name)
    scans = [scan for scan, _ in islice(radar.simulate(loaded, seed), count)]
    return scans, {**loaded.tracker_parameters(), 'estimator': 'imm'}


@pytest.fixture(scope='module')
def strait():
    return scene(STRAIT, 60)


def confirmed(tracker, memory, time):
    """Position and velocity [N, 4] of the confirmed tracks, sorted."""
    tracks = take(memory.tracks, memory.tracks.number > 0)
    now = tracker.extrapolate(tracks, time)
    rows = np.concatenate([now.position, now.velocity], 1)
    return rows[np.lexsort(rows.T)]


@pytest.mark.parametrize('count', [3, 16, 29])
def test_tracks_are_those_of_whole_revolutions_within_rounding(strait, count):
    scans, values = strait
    tracker = Tracker(from_mapping(TrackerParameters, values))
    whole = parts = tracker.start()
    for scan in scans:
        whole, _ = tracker.step(whole, scan)
        for part in sectors.cut(scan, count):
            parts, _ = tracker.step(parts, part)
    time = scans[-1].end
    expected, found = (confirmed(tracker, memory, time) for memory in (whole, parts))
    assert len(expected) == len(found) == 40
    assert found == pytest.approx(expected, abs=1e-6)
    clutter = [memory.radars[0].known.clutter for memory in (whole, parts)]
    assert clutter[0].scans == clutter[1].scans


def test_a_track_is_judged_once_a_revolution_and_only_when_it_is_swept(strait):
    scans, values = strait
    tracker = Tracker(from_mapping(TrackerParameters, values))
    memory = tracker.start()
    judged, late = [], []
    for scan in scans:
        for part in sectors.cut(scan, 16):
            memory, report = tracker.step(memory, part)
            old = report.tracks.age > 10
            judged.append(report.tracks.id[old])
            late += ((part.end - report.time[old]) / (scan.end - scan.start)).tolist()
            assert (report.time <= part.end).all()
    ids, times = np.unique(np.concatenate(judged), return_counts=True)
    assert times.max() <= 60 - 10 + 1
    assert np.percentile(late, 99) < 1 / 8
    alive = memory.tracks
    assert (alive.age <= 61).all() and (alive.age.max() >= 59)


def test_a_target_without_plots_misses_once_a_revolution(revolution):
    tracker = Tracker(TrackerParameters(estimator='imm', range_sigma_m=10, bearing_sigma_deg=0.3))
    memory = tracker.start()
    at, way = [[2500.0, 1400.0], [-900.0, 3100.0]], [[-4.0, 3.0], [6.0, 0.0]]
    rng = np.random.default_rng(8)
    for k in range(12):
        seen = np.array([True, k < 9])
        for part in sectors.cut(revolution(k, at, way, rng=rng, seen=seen), 7):
            memory, _ = tracker.step(memory, part)
    history = memory.tracks.history & 0b1111
    assert sorted(history.tolist()) == [0b1000, 0b1111]


def test_a_lost_message_counts_no_miss(revolution):
    tracker = Tracker(TrackerParameters(estimator='imm', range_sigma_m=10, bearing_sigma_deg=0.3))
    memory = tracker.start()
    rng = np.random.default_rng(3)
    for k in range(12):
        parts = sectors.cut(revolution(k, [[2500.0, 1000.0]], [[-4.0, 3.0]], rng=rng), 12)
        lost = 2 if k == 10 else -1  # the one with the target, at a bearing of 66 degrees
        for place, part in enumerate(parts):
            if place != lost:
                memory, _ = tracker.step(memory, part)
    assert memory.tracks.history.tolist() == [0b11111111111]
    assert memory.tracks.number.tolist() == [1]


def test_targets_and_alarms_come_once_a_revolution_and_are_the_same(strait):
    scans, values = strait
    service = service_for(values)
    whole = parts = service.start()
    for scan in scans:
        whole, expected = service.step(whole, scan)
        outputs = []
        for part in sectors.cut(scan, 16):
            parts, _, output = service.take(parts, part)
            outputs.append(output)
        assert outputs[:-1] == [None] * 15
    found = outputs[-1]
    assert found.picture.time == expected.picture.time == scans[-1].end
    assert len(found.picture.targets.id) == len(expected.picture.targets.id)
    positions = [out.picture.motion.position for out in (found, expected)]
    apart = np.linalg.norm(positions[0][:, None] - positions[1], axis=2)
    assert np.median(apart.min(1)) < 1e-6 and (apart.min(1) < 1).mean() > 0.95
    ids = found.report.tracks.id
    assert (np.diff(ids) > 0).all()
    hit = found.report.plot >= 0
    assert np.hypot(*(found.report.scan.plots.range[found.report.plot[hit]], 0)).max() < 12 * 1852


def test_sectors_of_a_scene_with_extents_are_put_together_first():
    scans, values = scene('hulls', 12)
    service = service_for(values, extent='random_matrix')
    whole = parts = service.start()
    for scan in scans:
        whole, expected = service.step(whole, scan)
        for part in sectors.cut(scan, 8):
            parts, done, output = service.take(parts, part)
            assert (done is None) == (output is None)
    assert output.report.tracks.id.tolist() == expected.report.tracks.id.tolist()
    assert output.estimate.position == pytest.approx(expected.estimate.position, abs=1e-6)
    assert output.shapes.length == pytest.approx(expected.shapes.length, nan_ok=True)


def test_a_sector_is_refused_where_a_revolution_is_wanted(strait):
    scans, values = strait
    service = service_for(values)
    with pytest.raises(ValueError, match='the scan is a sector'):
        service.step(service.start(), sectors.cut(scans[0], 4)[1])


def test_one_radar_in_sectors_beside_another_keeps_the_tracks():
    loaded = [scenario.load(f'two_radars_{which}') for which in 'xs']
    values = {
        **loaded[0].tracker_parameters(),
        **fused([one.tracker_parameters() for one in loaded], ['x', 's']),
        'estimator': 'imm',
    }
    runs = [
        [scan for scan, _ in islice(radar.simulate(one, 3 + k), 60) if scan.end <= 150]
        for k, one in enumerate(loaded)
    ]
    service = service_for(values)
    cut = [part for scan in runs[0] for part in sectors.cut(scan, 16)]
    memory = service.start()
    for scan in merged(cut, runs[1]):
        memory, _, output = service.take(memory, scan)
    numbers = memory.tracker.tracks.number
    now = scan.end
    truth = loaded[0].truth_at(now).position
    shown = service.tracker.extrapolate(take(memory.tracker.tracks, numbers > 0), now).position
    apart = np.linalg.norm(truth[:, None] - shown, axis=2)
    assert (apart.min(1) < 150).all()
    assert len(shown) <= len(truth) + 1


def test_a_sector_of_a_radar_mounted_askew_is_turned_like_its_plots(strait):
    scan = sectors.cut(strait[0][0], 16)[5]
    radar_parameters = TrackerParameters(bearing_offset_deg=12.0)
    turned = mounted(scan, radar_parameters, float('nan'))
    shift = wrap_angle(turned.plots.bearing - scan.plots.bearing)
    assert shift == pytest.approx(np.radians(12))
    assert turned.sector == pytest.approx(
        Sector(scan.sector.bearing + np.radians(12), scan.sector.angle)
    )


def test_a_track_with_a_wide_gate_is_judged_soon_after_the_beam(strait):
    """Whatever its gate, from the middle of it to the end of a sector a track waits so long."""
    part = sectors.cut(strait[0][0], 16)[8]
    period = 16 * (part.end - part.start)
    passed = part.end - period * np.array([0.01, 0.04, 0.05, 0.2])
    nothing = np.zeros(0, np.int64)
    pairs = Pairs(nothing, nothing, np.zeros(0), np.zeros(0))
    seen = parts_of.Windows(pairs, passed, passed + 0.3 * period)
    pool = take(part.plots, slice(0))
    waiting = parts_of.begin(part)
    found = parts_of.decide(waiting, seen, part, pool, sweep_of(part), 0)
    assert found.tracks.tolist() == [False, False, True, True]
