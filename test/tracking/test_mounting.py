"""One reference point: plots and own ship are brought to it from where the antennas are."""

import dataclasses

import numpy as np
import pytest

from marine_tracker.geometry import locate, own_ship_at, to_range_bearing, unit_vector, wrap_angle
from marine_tracker.parameters import TrackerParameters
from marine_tracker.tracking.mounting import mounted, needs_heading
from marine_tracker.tracking.radars import radars_of
from marine_tracker.types import OwnShip, PolarPlots, Scan

RATE, SPEED, BEGINS = np.radians(2.5), 7.0, np.radians(300.0)  # rad/s, m/s, rad: a hard turn
AHEAD = [(41.0, 6.5), (0.0, -12.0), (-88.0, 0.0)]  # m ahead and to starboard
TARGETS = np.array([[900.0, 2100.0], [-3300.0, 40.0], [250.0, -700.0]])


def heading(time):
    return BEGINS + RATE * time


def reference(time):
    """Where the reference point is: on a circle, the bow along its way."""
    radius = SPEED / RATE
    return radius * np.stack(
        [np.cos(BEGINS) - np.cos(heading(time)), np.sin(heading(time)) - np.sin(BEGINS)], -1
    )


def place(time, ahead, starboard):
    """A place on board, by complex numbers: east + 1j north, of a bow at exp(1j (pi/2 - h))."""
    bow = np.exp(1j * (np.pi / 2 - heading(np.asarray(time, float))))
    step = (ahead - 1j * starboard) * bow
    return reference(np.asarray(time, float)) + np.stack([step.real, step.imag], -1)


def seen(antenna=(0.0, 0.0), gps=(0.0, 0.0), off=0.0, bow=False, headings=True):
    """A scan of TARGETS in a turn, by an antenna that points `off` rad too far left."""
    time, samples = np.array([20.3, 21.1, 22.4]), np.arange(20.0, 23.01, 0.1)
    range_, bearing = to_range_bearing(TARGETS - place(time, *antenna))
    bearing = bearing - off - bow * heading(time)
    step = 1e-4
    velocity = (place(samples + step, *gps) - place(samples - step, *gps)) / (2 * step)
    own = OwnShip(
        samples,
        place(samples, *gps),
        velocity,
        heading(samples) % (2 * np.pi) if headings else None,
    )
    return Scan(20.0, 23.0, PolarPlots(time, range_, bearing % (2 * np.pi), np.zeros(3)), own)


def placed(scan):
    return locate(scan.plots, scan.measured_from, 1e-6, 1e-9).position


@pytest.mark.parametrize('antenna', AHEAD)
@pytest.mark.parametrize('gps', AHEAD)
def test_plots_and_own_ship_are_where_they_are_in_a_hard_turn(antenna, gps):
    parameters = TrackerParameters(
        antenna_ahead_m=antenna[0],
        antenna_starboard_m=antenna[1],
        gps_ahead_m=gps[0],
        gps_starboard_m=gps[1],
    )
    scan = mounted(seen(antenna, gps), parameters, np.nan)
    assert placed(scan) == pytest.approx(TARGETS, abs=0.02)
    assert scan.own_ship.position == pytest.approx(reference(scan.own_ship.time), abs=0.001)
    middle, velocity = own_ship_at(scan.own_ship, 21.5)
    true = SPEED * unit_vector(heading(21.5))
    assert middle == pytest.approx(reference(21.5), abs=0.02)
    assert velocity == pytest.approx(true, abs=0.02)


def test_without_the_offsets_the_same_plots_lie_aside():
    assert np.hypot(*(placed(seen((-88.0, 0.0))) - TARGETS).T).min() > 50


@pytest.mark.parametrize('off', [-3.5, 171.0])
def test_each_radar_has_its_own_bearing_offset_and_antenna(off):
    radars = radars_of(
        TrackerParameters(
            antenna_ahead_m=5.0,
            radars=f"""
- {{topic: a/radar/plots, bearing_offset_deg: {off}, antenna_ahead_m: -31, bearings: bow}}
- {{topic: b/radar/plots}}""",
        )
    )
    first = seen((-31.0, 0.0), off=np.radians(off), bow=True)
    assert placed(mounted(first, radars[0].parameters, np.nan)) == pytest.approx(TARGETS, abs=0.02)
    second = seen((5.0, 0.0))
    assert placed(mounted(second, radars[1].parameters, np.nan)) == pytest.approx(TARGETS, abs=0.02)


def test_a_heading_that_samples_lack_is_the_one_that_is_given():
    parameters = TrackerParameters(antenna_ahead_m=60.0)
    scan = seen((60.0, 0.0), headings=False)
    found = mounted(scan, parameters, heading(21.5))
    assert placed(found) == pytest.approx(TARGETS, abs=60 * RATE * 1.5)


def test_without_any_heading_nothing_is_moved():
    parameters = TrackerParameters(
        antenna_ahead_m=60.0, gps_starboard_m=4.0, bearing_offset_deg=8.0
    )
    scan = seen(headings=False)
    found = mounted(scan, parameters, np.nan)
    assert found.antenna is None
    assert np.array_equal(found.own_ship.position, scan.own_ship.position)
    turned = wrap_angle(found.plots.bearing - scan.plots.bearing)
    assert np.degrees(turned) == pytest.approx(8.0)  # this needs none
    assert needs_heading([parameters]) and needs_heading([TrackerParameters(bearings='bow')])
    assert not needs_heading([TrackerParameters(bearing_offset_deg=8.0)])


def test_a_radar_on_the_bow_before_any_heading_takes_the_bow_for_north():
    scan = seen(bow=True, headings=False)
    found = mounted(scan, TrackerParameters(bearings='bow'), np.nan)
    assert np.array_equal(found.plots.bearing, scan.plots.bearing)


def test_by_default_a_scan_stays_as_it_is():
    scan = seen()
    assert mounted(scan, TrackerParameters(), 1.0) is scan


@pytest.mark.parametrize('name', ['antenna_ahead_m', 'gps_ahead_m', 'bearing_offset_deg'])
def test_offsets_longer_than_ships_are_refused_by_name(name):
    with pytest.raises(ValueError, match=name):
        dataclasses.replace(TrackerParameters(), **{name: 501.0})
