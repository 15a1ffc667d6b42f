"""Plots beside vessels that told AIS: the errors of the radar, and who has a plot."""

import numpy as np
import pytest

from marine_tracker.geometry import to_range_bearing
from marine_tracker.lab.video import matched
from marine_tracker.types import PolarPlots


@pytest.mark.parametrize(('range_off', 'bearing_off'), [(-163.0, 1.7), (88.0, -0.6)])
def test_the_errors_of_a_radar_and_those_who_have_a_plot_are_found(range_off, bearing_off):
    random = np.random.default_rng(4)
    position = random.uniform(-14_000, 14_000, (60, 2))
    velocity = np.where(np.arange(60)[:, None] < 25, random.uniform(2, 5, (60, 2)), 0.0)
    vessels = matched.Vessels(random.uniform(-9, 0, 60), position, velocity)
    seen = random.random(60) < 0.7
    scans = []
    for time in (0.0, 2.5, 5.0):
        range_, bearing = to_range_bearing(vessels.at(time)[seen])
        chance = random.uniform((800, 0), (19_000, 2 * np.pi), (30, 2))
        range_ = np.append(range_ + range_off + random.normal(0, 20, len(range_)), chance[:, 0])
        bearing = np.append(bearing + np.radians(bearing_off), chance[:, 1]) % (2 * np.pi)
        scans.append(PolarPlots(np.full(len(range_), time), range_, bearing, 0 * range_))
    found = matched.match(vessels, scans)
    assert found.range == pytest.approx(range_off, abs=15)
    assert np.degrees(found.bearing) == pytest.approx(bearing_off, abs=0.1)
    assert found.near[seen].all() and (found.near & ~seen).sum() <= 4
    assert found.moving.sum() == 25 and found.by_chance < 3


def test_the_vessels_of_a_recording_are_read(recordings):
    vessels = matched.read(recordings / 'radar_video' / 'navico_halo_harbour.nmea')
    assert len(vessels.time) == 101
    assert (np.hypot(*vessels.velocity.T) > matched.MOVING).sum() == 37


def test_a_file_without_own_ship_is_refused(tmp_path):
    file = tmp_path / 'x.nmea'
    file.write_text('0.1 $GPHDT,7.0,T*0C\n')
    with pytest.raises(ValueError, match='no position of own ship'):
        matched.read(file)
