"""Where no spoke came nothing was swept: no echo, and no miss for the tracks there."""

import numpy as np
import pytest

from marine_tracker.parameters import TrackerParameters, VideoParameters
from marine_tracker.tracking.lifecycle import COASTING, LOST
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import Sweep, take
from marine_tracker.video import gaps
from marine_tracker.video.chain import Chain

BEAM = np.radians(2.4)


def sweep_of(spokes):
    """The same spokes as a radar sends them, own ship heading north."""
    count = len(spokes.time)
    reach = spokes.range_step * spokes.strength.shape[1]
    return Sweep(spokes.time, spokes.bearing, np.zeros(count), reach, spokes.strength)


def through(pictures, spokes, parts=7, **parameters):
    """The scans of the spokes."""
    chain = Chain(VideoParameters(beam_width_deg=2.4, pulse_length_m=30.0, **parameters))
    memory, scans = chain.start(), []
    sweep, size = sweep_of(spokes), -(-len(spokes.time) // parts)
    for first in range(0, len(spokes.time), size):
        part = take(sweep, slice(first, first + size))
        memory, done = chain.step(memory, part, spokes.own_ship)
        scans += done.scans
    _, done = chain.end(memory, spokes.own_ship)
    return scans + done.scans


def without(spokes, first, last, period=2.5):
    """The spokes without those between two bearings, deg, of the second revolution on."""
    turned = np.degrees(2 * np.pi * (spokes.time / period - 1))
    keep = (turned < first) | (turned > last)
    columns = (spokes.time, spokes.bearing, spokes.range_step, spokes.strength)
    return type(spokes)(*(column[keep] for column in columns), spokes.own_ship)


@pytest.mark.parametrize(('first', 'last'), [(71, 128), (341, 383), (185, 191)])
def test_a_gap_is_told_where_it_is_however_the_spokes_come(pictures, first, last):
    whole = pictures.turned(pictures.make([(2100.0, 100.0, 30.0)], spokes=720, samples=300), 4)
    for parts in (3, 31):
        scans = through(pictures, without(whole, first, last), parts)
        told = [scan.unswept for scan in scans if scan.unswept is not None]
        found = np.concatenate(told)
        begin, angle = np.degrees(found[0, 0]), np.degrees(found[:, 1].sum())
        assert (begin - first + 180) % 360 - 180 == pytest.approx(-1.2, abs=1.0)
        assert angle == pytest.approx(last - first + 2.4, abs=1.5)


def test_spokes_without_gaps_tell_none_and_a_blank_sector_is_one(pictures):
    whole = pictures.turned(pictures.make([], spokes=720, samples=300), 3)
    assert all(scan.unswept is None for scan in through(pictures, whole))
    (first, angle), *_ = through(pictures, whole, blank_sectors='205-231')[1].unswept
    assert np.degrees([first, angle]) == pytest.approx([203.8, 28.4], abs=1.0)


def test_a_gap_at_the_end_of_a_scan_goes_on_in_the_next():
    known = gaps.start()._replace(found=np.array([[4.0, 6.0, 1.0, 0.8]]))
    known, inside = gaps.taken(known, 5.5)
    assert inside == pytest.approx(np.array([[1.0, 0.6]]))
    known, inside = gaps.taken(known, 8.0)
    assert inside == pytest.approx(np.array([[1.6, 0.2]]))
    assert gaps.taken(known, 99.0)[1] is None


@pytest.mark.parametrize('blind', [False, True])
def test_a_track_in_a_gap_counts_no_miss_and_lives(pictures, blind):
    """Two still ships; the spokes at one of them are missing in nine of ten revolutions, or come
    and are empty there."""
    seen = pictures.make([(1500.0, 40.0, 30.0), (1900.0, 220.0, 30.0)], spokes=720, samples=300)
    empty = pictures.make([(1500.0, 40.0, 30.0)], spokes=720, samples=300, seed=8)
    whole = pictures.turned(seen, 17)
    late = (whole.time >= 15.0) & (np.abs(whole.bearing - np.radians(220.0)) < 0.3)
    late &= whole.time < 15.0 + 9 * 2.5
    if blind:
        keep = ~late
        columns = (whole.time, whole.bearing, whole.range_step, whole.strength)
        spokes = type(whole)(*(column[keep] for column in columns), whole.own_ship)
    else:
        strength = np.where(late[:, None], np.tile(empty.strength, (17, 1)), whole.strength)
        spokes = whole._replace(strength=strength)
    tracker = Tracker(
        TrackerParameters(range_sigma_m=9.0, bearing_sigma_deg=0.4, estimator='cs_kalman')
    )
    memory, lost, coasted = tracker.start(), 0, 0
    for scan in through(pictures, spokes, 40):
        memory, report = tracker.step(memory, scan)
        south = (report.tracks.number > 0) & (np.abs(report.tracks.bearing - 3.84) < 0.2)
        lost += int((report.tracks.status[south] == LOST).sum())
        coasted += int((report.tracks.status[south] == COASTING).sum())
    assert coasted >= 4  # a track of six plots is not sure yet
    assert lost == (0 if blind else 1)
